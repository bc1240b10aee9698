//! The commands, one file each.

pub(super) mod analyze;
pub(super) mod bode;
pub(super) mod charpoly;
pub(super) mod check;
#[cfg(feature = "cli")]
pub(super) mod completions;
#[cfg(feature = "cli")]
pub(super) mod explain;
#[cfg(feature = "cli")]
pub(super) mod export;
mod frequency_response;
#[cfg(feature = "cli")]
pub(super) mod import;
pub(super) mod intervals;
pub(super) mod jury;
#[cfg(feature = "cli")]
pub(super) mod lock;
pub(super) mod locus;
#[cfg(feature = "cli")]
pub(super) mod main_job;
pub(super) mod map;
mod map_body;
mod map_boxes;
pub(super) mod margins;
pub(super) mod new;
pub(super) mod norm;
pub(super) mod nyquist;
#[cfg(feature = "cli")]
pub(super) mod page;
#[cfg(feature = "cli")]
pub(super) mod paper;
#[cfg(feature = "cli")]
pub(super) mod report;
pub(super) mod roots;
#[cfg(feature = "cli")]
pub(super) mod ship;
#[cfg(feature = "cli")]
pub(super) mod simulate;
#[cfg(feature = "cli")]
pub(super) mod sweep;
#[cfg(feature = "cli")]
pub(super) mod test;
pub(super) mod tolerance;
pub(super) mod tune;
pub(super) mod verdict;
pub(super) mod verify;

use super::arguments::{Arguments, CAUSES, ExplainOptions, OutputOptions, RunOptions};
use super::captured;
use super::command_line::CommandLine;
use super::destinations::Files;
use super::output::{ending, finish_answer, unknown_ending, write_answer};
use super::progress::Reporter;
use super::show;
use super::status::{Error, Outcome, Status};
use clap::Subcommand;
use jurist_algebra::limits::{Budget, Exhausted, apart};
use jurist_engine::coverage::Asked;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Source};
use jurist_engine::problem::Problem;
use jurist_show::documents::to_text;
use jurist_show::plan_text;
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering};
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
    /// Whether the model takes numbers from other files and is not written with them.
    has_references: AtomicBool,
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
        Context {
            line,
            reporter,
            budget,
            quiet: options.quiet,
            explained: Mutex::default(),
            has_references: AtomicBool::new(false),
        }
    }

    /// Notes that the model takes numbers from other files and is not written with them.
    #[cfg(feature = "cli")]
    pub fn note_references(&self) {
        self.has_references.store(true, Ordering::Relaxed);
    }

    /// Refuses a certificate about a text that nobody has.
    pub fn check_certifiable(&self) -> Result<(), Error> {
        if !self.has_references.load(Ordering::Relaxed) {
            return Ok(());
        }
        let message = "a certificate is about the model's text, and this one takes numbers from other files";
        let error = Diagnostic::error(Code::NoCertificate, message);
        Err(error
            .help("add --resolved FILE: it writes the model with these numbers, which the certificate is about then")
            .into())
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
        if !wanted.explain {
            return Ok(());
        }
        // What refuses this does so with the question. An answer may need no characteristic polynomial: it is not lost for its explanation.
        let plan = match problem.explain(asked, &self.budget.clone().within_work(WORK_OF_EXPLANATIONS)) {
            Ok(plan) => plan,
            Err(Error::Stopped(_)) => {
                self.explained.lock().unwrap_or_else(PoisonError::into_inner).push_str(LONG_POLYNOMIAL);
                return Ok(());
            }
            Err(_) => return Ok(()),
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

/// Work that the explanation of a question may be.
const WORK_OF_EXPLANATIONS: u64 = 100_000_000;

/// The explanation of a loop whose characteristic polynomial over all constants is long.
const LONG_POLYNOMIAL: &str = "
how it is decided
    The characteristic polynomial over all constants is too long to be shown. Roots at a point are counted from enclosures of the loop's matrix,
    and limits in a gain are found from enclosures of the polynomial's coefficients, where these decide; else exact algebra is asked.
";

/// A command: what its options make it do.
pub(super) trait Runs {
    /// Runs it.
    fn run(&self, context: &Context) -> Outcome;

    /// Adds the files that it reads and writes.
    fn files<'a>(&'a self, _: &mut Files<'a>) -> Result<(), Error> {
        Ok(())
    }

    /// True of commands that write folders: they name the first page themselves.
    fn writes_a_folder(&self) -> bool {
        false
    }

    /// How the program ends where the budget allows no answer.
    #[cfg_attr(not(all(feature = "cli", not(target_family = "wasm"))), allow(dead_code))]
    fn without_answer(&self) -> Status {
        Status::Undecided
    }
}

/// Makes the commands of a list: a variant with the options of its module, and what runs it; in brackets, where these say how long to work and how
/// much to say; `in` names the feature that a command needs.
macro_rules! commands {
    ($($(#[$attribute:meta])* $module:ident: $name:ident$(($($run:ident).+))? $(in $feature:literal)?;)+) => {
        /// The commands. Each has its file here.
        #[derive(Subcommand, Debug)]
        pub(super) enum Command {
            $($(#[cfg(feature = $feature)])? $(#[$attribute])* $name($module::Options),)+
        }

        impl Command {
            /// What its options make it do.
            fn options(&self) -> &dyn Runs {
                match self {
                    $($(#[cfg(feature = $feature)])? Command::$name(options) => options,)+
                }
            }

            fn run_options(&self) -> Option<&RunOptions> {
                match self {
                    $($(#[cfg(feature = $feature)])? Command::$name(_options) => None$(.or(Some(&_options.$($run).+)))?,)+
                }
            }
        }
    };
}

commands! {
    /// Verdict at the nominal point, and the stable set of each parameter
    analyze: Analyze(decision.output.run);
    /// The exact stable set of one parameter
    #[command(after_help = CAUSES)]
    intervals: Intervals(decision.output.run);
    /// One point: stable, marginal, unstable or undefined, with the exact number of roots
    verdict: Verdict(decision.output.run);
    /// The roots of the closed loop (poles) with certified digits, their damping and natural frequency
    roots: Roots(output.run);
    /// The characteristic polynomial, symbolic in the kept parameters
    charpoly: Charpoly(output.run);
    /// The Jury table (Routh table in continuous time) and its conditions
    jury: Jury(decision.output.run);
    /// The stable region in two parameters, every cell decided exactly
    map: Map(output.run);
    /// Root locus of one parameter, with the exact crossings on it
    locus: Locus(run);
    /// Gain, phase, delay, modulus and disk margins of the loop cut at a signal, exactly, and all crossings
    margins: Margins(output.run);
    /// Magnitude and phase of the open loop over frequency, with the exact crossings marked
    bode: Bode(picture.run);
    /// The curve of the open loop around -1, with the exact crossings and margins marked
    nyquist: Nyquist(picture.run);
    /// The peak gain (H-infinity norm) of a closed-loop transfer function, exactly
    norm: Norm(output.run);
    /// Time response, of the sampled loop or of the switched circuit
    simulate: Simulate(run) in "cli";
    /// The same question at many points, on all cores; resumable
    sweep: Sweep(run) in "cli";
    /// Stable for every value within tolerances: proof or counterexample, and how far they can grow
    tolerance: Tolerance(decision.output.run);
    /// The best gains within what is required, exactly or in a bracket; or that no gains meet it
    tune: Tune(output.run);
    /// The controller as it is stored and run: rounded coefficients, every rounding, fewest bits, ranges of signals
    ship: Ship(output.run) in "cli";
    /// One page about one's own loop: verdict, limits and causes, margins, what moves them, worst corner, figures
    report: Report(run) in "cli";
    /// The built-in drive's paper once more, as one HTML report with figures
    paper: Paper(run) in "cli";
    /// The page for the browser, with everything it computes with, as a folder of files
    page: Page(run) in "cli";
    /// Tries what models are expected to be: [[expect]], [require], locked limits
    test: Test(run) in "cli";
    /// Holds the limits of a model fast, for 'jurist test'
    lock: Lock(run) in "cli";
    /// Re-checks a certificate against a model, with code that shares nothing with the engine
    #[command(
        mut_arg("timeout", |timeout| timeout.help("Rejects the certificate after this time, with exit status 4")),
        mut_arg("memory", |memory| memory.help("Rejects the certificate rather than use more megabytes, with exit status 4 [default: 800]")),
        mut_arg("work", |work| work.hide(true))
    )]
    verify: Verify(run);
    /// Only reads a model: every mistake with its place
    check: Check(run);
    /// The loop as a script of another program: python-control, or MATLAB and Octave
    export: Export(run) in "cli";
    /// A commented model file to begin with
    new: New;
    /// A model file from a state-space system of MATLAB, SciPy, NumPy or OpenModelica, or a loop of DSVerifier
    import: Import(run) in "cli";
    /// What an error code or a word of the answers means
    explain: Explain in "cli";
    /// A completion script for a shell
    completions: Completions in "cli";
}

/// What is done without a command where there is no program.
#[cfg(not(feature = "cli"))]
struct Nothing;

#[cfg(not(feature = "cli"))]
impl Runs for Nothing {
    fn run(&self, _: &Context) -> Outcome {
        Err(Diagnostic::error(jurist_engine::error::Code::Usage, "a command is missing").into())
    }
}

impl Arguments {
    /// What is asked for.
    pub fn asked(&self) -> &dyn Runs {
        match &self.command {
            Some(command) => command.options(),
            #[cfg(feature = "cli")]
            None => &self.main_job,
            #[cfg(not(feature = "cli"))]
            None => &Nothing,
        }
    }

    /// The options that say how long to work and how much to say.
    pub fn run_options(&self) -> &RunOptions {
        const NONE: &RunOptions =
            &RunOptions { timeout: None, work: None, memory: None, threads: None, quiet: false, verbose: false };
        match &self.command {
            Some(command) => command.run_options().unwrap_or(NONE),
            #[cfg(feature = "cli")]
            None => &self.main_job.output.run,
            #[cfg(not(feature = "cli"))]
            None => NONE,
        }
    }
}
