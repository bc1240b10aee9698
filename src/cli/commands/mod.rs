//! The commands, one file each.

pub(super) mod analyze;
pub(super) mod charpoly;
pub(super) mod completions;
pub(super) mod explain;
pub(super) mod intervals;
pub(super) mod jury;
pub(super) mod main_job;
pub(super) mod verdict;

use super::arguments::{Arguments, Command, RunOptions};
use super::command_line::CommandLine;
use super::progress::Reporter;
use super::status::Outcome;
use crate::limits::Budget;
use std::sync::Arc;

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
}

impl<'a> Context<'a> {
    pub fn new(line: &'a CommandLine, options: &RunOptions) -> Self {
        let reporter = Reporter::new(options);
        let budget = reporter.budget(options);
        Context { line, reporter, budget, quiet: options.quiet }
    }
}

impl Arguments {
    /// The options that say how long to work and how much to say.
    pub fn run_options(&self) -> &RunOptions {
        const NONE: &RunOptions = &RunOptions { timeout: None, quiet: false, verbose: false };
        match &self.command {
            None => &self.main_job.output.run,
            Some(Command::Analyze(options)) => &options.output.run,
            Some(Command::Intervals(options)) => &options.output.run,
            Some(Command::Verdict(options)) => &options.output.run,
            Some(Command::Charpoly(options)) => &options.output.run,
            Some(Command::Jury(options)) => &options.output.run,
            Some(Command::Explain(_) | Command::Completions(_)) => NONE,
        }
    }
}

/// Runs the command that the arguments name.
pub(super) fn run(arguments: &Arguments, context: &Context) -> Outcome {
    match &arguments.command {
        None => main_job::run(&arguments.main_job, context),
        Some(Command::Analyze(options)) => analyze::run(options, context),
        Some(Command::Intervals(options)) => intervals::run(options, context),
        Some(Command::Verdict(options)) => verdict::run(options, context),
        Some(Command::Charpoly(options)) => charpoly::run(options, context),
        Some(Command::Jury(options)) => jury::run(options, context),
        Some(Command::Explain(options)) => explain::run(options),
        Some(Command::Completions(options)) => completions::run(options),
    }
}
