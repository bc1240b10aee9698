//! `jurist export`: the loop as a script of another program.

use super::{Context, Runs};
use crate::cli::arguments::{ModelOptions, RegionOptions, RunOptions};
use crate::cli::destinations::Files;
use crate::cli::export::{Script, Target, matlab, python_control};
use crate::cli::input::{load, question};
use crate::cli::output::finish_answer;
use crate::cli::status::{Error, Outcome, Status};
use clap::{Args, ValueEnum};
use std::ffi::OsString;

/// Options of `jurist export`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The program that reads the script
    #[arg(long, value_enum)]
    pub to: Program,
    /// Writes to a file
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

/// The programs that scripts are written for.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum Program {
    /// A Python file for the package 'control', version 0.10
    PythonControl,
    /// A file for MATLAB's Control System Toolbox, which Octave's package 'control' reads as well
    Matlab,
}

impl Program {
    fn target(self) -> &'static dyn Target {
        match self {
            Program::PythonControl => &python_control::PythonControl,
            Program::Matlab => &matlab::Matlab,
        }
    }
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        let problem = question(context, &model, &self.model, &RegionOptions::default())?.problem()?;
        context.warn(None, problem.warnings());
        let target = self.to.target();
        let script = Script::of(&problem, target, &context.budget)?;
        context.reporter.finish();
        finish_answer(&script.text(target), self.output.as_ref())?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model.model, &self.output);
        Ok(())
    }
}
