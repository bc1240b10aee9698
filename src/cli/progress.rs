//! What is being done: remembered for an undecided answer, shown on a terminal.

use crate::cli::arguments::RunOptions;
use crate::cli::captured;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use jurist_algebra::limits::{Budget, Progress};
use std::io::IsTerminal;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Steps shorter than this are not shown.
const PATIENCE: Duration = Duration::from_millis(400);

/// Listens to the library's steps.
pub(super) struct Reporter {
    state: Mutex<State>,
    bar: Option<ProgressBar>,
    verbose: bool,
    begun: Instant,
}

#[derive(Default)]
struct State {
    step: String,
    done: u64,
    total: u64,
}

impl Reporter {
    /// A listener that draws only if standard error is a terminal.
    pub fn new(options: &RunOptions) -> Arc<Self> {
        let listens = captured::budget().is_none() && std::io::stderr().is_terminal();
        let drawn = listens && !options.quiet && !options.verbose;
        let bar = drawn.then(|| ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()));
        Arc::new(Reporter { state: Mutex::default(), bar, verbose: options.verbose, begun: Instant::now() })
    }

    /// The budget that the options grant, telling this listener how far it is.
    pub fn budget(self: &Arc<Self>, options: &RunOptions) -> Budget {
        let mut budget = options.timeout.map_or_else(Budget::unlimited, Budget::with_timeout);
        budget = budget.within_memory(options.memory());
        // Where nothing ends it, work is counted only for who wants to know.
        if let Some(units) = options.work.or(options.verbose.then_some(u64::MAX)) {
            budget = budget.within_work(units);
        }
        budget.reporting_to(Arc::clone(self) as Arc<dyn Progress>)
    }

    /// The time since the program began.
    pub fn elapsed(&self) -> Duration {
        self.begun.elapsed()
    }

    /// Takes the progress bar off the terminal.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// Tells with `--verbose` how much work was counted: the same number on every machine.
    pub fn tell_work(&self, budget: &Budget) {
        if let Some(units) = budget.work_done().filter(|_| self.verbose) {
            super::output::note(&format!("{units} units of work"));
        }
    }

    /// Writes something while the progress bar is off the terminal.
    pub fn aside<T>(&self, write: impl FnOnce() -> T) -> T {
        match &self.bar {
            Some(bar) => bar.suspend(write),
            None => write(),
        }
    }

    fn draw(&self, state: &State) {
        let Some(bar) = &self.bar else { return };
        if self.begun.elapsed() < PATIENCE {
            return;
        }
        if bar.is_hidden() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        // A bar says how much is done; where that is not known, none is drawn.
        let template = if state.total > 0 {
            "{spinner} {msg} {wide_bar} {percent}% {elapsed}"
        } else {
            "{spinner} {msg} {elapsed}"
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(state.step.clone());
        bar.set_length(state.total);
        bar.set_position(state.done);
    }
}

impl Progress for Reporter {
    fn step(&self, name: &str) {
        if let Ok(mut state) = self.state.lock() {
            *state = State { step: name.to_owned(), ..State::default() };
            self.draw(&state);
        }
        if self.verbose {
            super::output::note(&format!("{:8.3} s  {name}", self.begun.elapsed().as_secs_f64()));
        }
    }

    fn advance(&self, done: u64, total: u64) {
        if let Ok(mut state) = self.state.lock() {
            (state.done, state.total) = (done, total);
            self.draw(&state);
        }
    }
}
