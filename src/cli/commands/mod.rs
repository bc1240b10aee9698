//! The commands, one file each.

pub(super) mod analyze;
pub(super) mod charpoly;
pub(super) mod check;
#[cfg(feature = "cli")]
pub(super) mod completions;
#[cfg(feature = "cli")]
pub(super) mod explain;
pub(super) mod frequency_response;
pub(super) mod intervals;
pub(super) mod jury;
pub(super) mod locus;
#[cfg(feature = "cli")]
pub(super) mod main_job;
pub(super) mod map;
mod map_body;
mod map_boxes;
pub(super) mod margins;
pub(super) mod new;
pub(super) mod norm;
#[cfg(feature = "cli")]
pub(super) mod page;
#[cfg(feature = "cli")]
pub(super) mod paper;
#[cfg(feature = "cli")]
pub(super) mod report;
#[cfg(feature = "cli")]
pub(super) mod simulate;
#[cfg(feature = "cli")]
pub(super) mod sweep;
pub(super) mod tolerance;
pub(super) mod verdict;
pub(super) mod verify;

use super::arguments::{Arguments, Command, ExplainOptions, OutputOptions, RunOptions};
use super::captured;
use super::command_line::CommandLine;
use super::output::{ending, finish_answer, unknown_ending, write_answer};
use super::progress::Reporter;
use super::show;
use super::status::{Error, Outcome, Status};
use jurist_algebra::limits::{Budget, Exhausted, apart};
use jurist_engine::coverage::Asked;
use jurist_engine::error::{Diagnostic, Diagnostics, Source};
use jurist_engine::problem::Problem;
use jurist_engine::show::documents::to_text;
use jurist_engine::show::plan_text;
use serde::Serialize;
use std::sync::{Arc, Mutex, PoisonError};

/// What every command is given besides its options.
pub(super) struct Context<'a> {
    /// The command line, for errors to point into.
    pub line: &'a CommandLine,
    /// Who is told how far the work is.
    pub reporter: Arc<Reporter>,
    /// How long the work may take.
    pub budget: Budget,
    /// Whether warnings are left out.
    pub quiet: bool,
    /// How questions are decided, where that is asked for.
    explained: Mutex<String>,
}

impl<'a> Context<'a> {
    pub fn new(line: &'a CommandLine, arguments: &Arguments) -> Self {
        let options = arguments.run_options();
        if let Some(threads) = options.threads {
            // A pool that exists already keeps its size: that changes the time, no answer.
            let _ = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
        }
        let reporter = Reporter::new(options);
        let budget = captured::budget().unwrap_or_else(|| reporter.budget(options));
        Context { line, reporter, budget, quiet: options.quiet, explained: Mutex::default() }
    }

    /// Whether what is written is handed over to another program.
    pub fn is_captured(&self) -> bool {
        captured::budget().is_some()
    }

    /// Shows warnings, unless they are not wanted.
    pub fn warn(&self, source: Option<&Arc<Source>>, warnings: &[Diagnostic]) {
        if !self.quiet && !warnings.is_empty() && !captured::warn(source, warnings) {
            show(&Diagnostics::new(source.cloned(), warnings.to_vec()));
        }
    }

    /// Keeps how a question is decided for the answer, where that is asked for; of a refused question it is written at once.
    pub fn explain(
        &self,
        wanted: &ExplainOptions,
        output: &OutputOptions,
        problem: &Problem,
        asked: Asked,
    ) -> Result<(), Error> {
        // What refuses or stops this does so with the question.
        let Some(plan) = wanted.explain.then(|| problem.explain(asked, &self.budget).ok()).flatten() else {
            return Ok(());
        };
        let text = plan_text(problem);
        match plan.coverage.method() {
            None if !self.wants_json(output)? => write_answer(&text, None),
            _ => {
                self.explained.lock().unwrap_or_else(PoisonError::into_inner).push_str(&text);
                Ok(())
            }
        }
    }

    fn taken_explanation(&self) -> String {
        std::mem::take(&mut *self.explained.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Writes an answer in the form that the options ask for.
    pub fn answer<D: Serialize>(
        &self,
        options: &OutputOptions,
        text: impl FnOnce() -> String,
        document: impl FnOnce() -> D,
    ) -> Result<(), Error> {
        let wants_json = self.wants_json(options)?;
        let explained = self.taken_explanation();
        let answer = self.budget.enter(|| if wants_json { to_text(&document()) } else { text() + &explained })?;
        self.reporter.finish();
        finish_answer(&answer, options.output.as_ref())
    }

    /// Whether JSON is asked for, by the option or by the file's ending.
    fn wants_json(&self, options: &OutputOptions) -> Result<bool, Error> {
        let Some(file) = options.output.as_ref().filter(|_| !options.json) else { return Ok(options.json) };
        match ending(file).as_deref() {
            Some("json") => Ok(true),
            Some("txt") | None => Ok(false),
            Some(_) => Err(unknown_ending(file, &["txt", "json"]).into()),
        }
    }

    /// Refuses a file ending before any work is done.
    pub fn check_output(&self, options: &OutputOptions) -> Result<(), Error> {
        self.wants_json(options).map(|_| ())
    }

    /// Writes what is known of an answer that the budget did not allow, and says so on standard error.
    pub fn undecided<D: Serialize>(
        &self,
        options: &OutputOptions,
        stopped: &Exhausted,
        text: impl FnOnce() -> Option<String>,
        document: impl FnOnce() -> D,
    ) -> Outcome {
        let wants_json = self.wants_json(options)?;
        // The budget is over: what is known is written all the same.
        let explained = Some(self.taken_explanation()).filter(|text| !text.is_empty());
        let text = || match (text(), explained) {
            (None, explained) => explained,
            (Some(text), explained) => Some(text + &explained.unwrap_or_default()),
        };
        let known = apart(|| if wants_json { Some(to_text(&document())) } else { text() });
        if let Some(known) = known {
            finish_answer(&known, options.output.as_ref())?;
        }
        Ok(self.say_undecided(stopped))
    }

    /// Says on standard error that there is no answer.
    pub fn say_undecided(&self, stopped: &Exhausted) -> Status {
        self.reporter.finish();
        super::output::note(&format!("undecided: {stopped}"));
        Status::Undecided
    }
}

/// What stopped the work; any other reason for having no answer is passed on.
pub(super) fn decided<T>(result: Result<T, Error>) -> Result<Result<T, Exhausted>, Error> {
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(failure) => failure.stopped().map(Err),
    }
}

impl Arguments {
    /// The options that say how long to work and how much to say.
    pub fn run_options(&self) -> &RunOptions {
        const NONE: &RunOptions =
            &RunOptions { timeout: None, work: None, memory: None, threads: None, quiet: false, verbose: false };
        match &self.command {
            #[cfg(feature = "cli")]
            None => &self.main_job.output.run,
            Some(Command::Analyze(options)) => &options.decision.output.run,
            Some(Command::Intervals(options)) => &options.decision.output.run,
            Some(Command::Verdict(options)) => &options.decision.output.run,
            Some(Command::Charpoly(options)) => &options.output.run,
            Some(Command::Jury(options)) => &options.decision.output.run,
            Some(Command::Map(options)) => &options.output.run,
            Some(Command::Locus(options)) => &options.run,
            Some(Command::Margins(options)) => &options.output.run,
            Some(Command::Bode(options) | Command::Nyquist(options)) => &options.run,
            Some(Command::Norm(options)) => &options.output.run,
            #[cfg(feature = "cli")]
            Some(Command::Simulate(options)) => &options.run,
            #[cfg(feature = "cli")]
            Some(Command::Sweep(options)) => &options.run,
            #[cfg(feature = "cli")]
            Some(Command::Paper(options)) => &options.run,
            #[cfg(feature = "cli")]
            Some(Command::Report(options)) => &options.run,
            Some(Command::Tolerance(options)) => &options.decision.output.run,
            Some(Command::Verify(options)) => &options.run,
            Some(Command::Check(options)) => &options.run,
            #[cfg(feature = "cli")]
            Some(Command::Completions(_) | Command::Explain(_)) => NONE,
            #[cfg(not(feature = "cli"))]
            None => NONE,
            Some(Command::New(_)) => NONE,
            #[cfg(feature = "cli")]
            Some(Command::Page(options)) => &options.run,
        }
    }
}

#[cfg(all(feature = "cli", not(target_family = "wasm")))]
impl Arguments {
    /// How the program ends where the budget allows no answer.
    pub fn without_answer(&self) -> Status {
        match &self.command {
            Some(Command::Verify(_)) => Status::Rejected,
            _ => Status::Undecided,
        }
    }
}

/// Runs the command that the arguments name.
pub(super) fn run(arguments: &Arguments, context: &Context) -> Outcome {
    match &arguments.command {
        #[cfg(feature = "cli")]
        None => main_job::run(&arguments.main_job, context),
        #[cfg(not(feature = "cli"))]
        None => Err(Diagnostic::error(jurist_engine::error::Code::Usage, "a command is missing").into()),
        Some(Command::Analyze(options)) => analyze::run(options, context),
        Some(Command::Intervals(options)) => intervals::run(options, context),
        Some(Command::Verdict(options)) => verdict::run(options, context),
        Some(Command::Charpoly(options)) => charpoly::run(options, context),
        Some(Command::Jury(options)) => jury::run(options, context),
        Some(Command::Map(options)) => map::run(options, context),
        Some(Command::Locus(options)) => locus::run(options, context),
        Some(Command::Margins(options)) => margins::run(options, context),
        Some(Command::Bode(options)) => frequency_response::run(options, frequency_response::BODE, context),
        Some(Command::Nyquist(options)) => frequency_response::run(options, frequency_response::NYQUIST, context),
        Some(Command::Norm(options)) => norm::run(options, context),
        #[cfg(feature = "cli")]
        Some(Command::Simulate(options)) => simulate::run(options, context),
        #[cfg(feature = "cli")]
        Some(Command::Sweep(options)) => sweep::run(options, context),
        #[cfg(feature = "cli")]
        Some(Command::Paper(options)) => paper::run(options, context),
        #[cfg(feature = "cli")]
        Some(Command::Report(options)) => report::run(options, context),
        Some(Command::Tolerance(options)) => tolerance::run(options, context),
        Some(Command::Verify(options)) => verify::run(options, context),
        Some(Command::Check(options)) => check::run(options, context),
        Some(Command::New(options)) => new::run(options),
        #[cfg(feature = "cli")]
        Some(Command::Page(options)) => page::run(options, context),
        #[cfg(feature = "cli")]
        Some(Command::Explain(options)) => explain::run(options),
        #[cfg(feature = "cli")]
        Some(Command::Completions(options)) => completions::run(options),
    }
}
