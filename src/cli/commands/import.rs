//! `jurist import`: a model file from a state-space system of another program, or from a loop of DSVerifier.

use super::{Context, Runs};
use crate::cli::arguments::RunOptions;
use crate::cli::assignments::{in_line, plain_number};
use crate::cli::destinations::Files;
use crate::cli::import::{DsOptions, Form, Time, Words, assemble, in_file, is_c, model, read, read_c};
use crate::cli::input::{Wanted, read_bytes};
use crate::cli::output::{finish_answer, note};
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_engine::error::{Code, Diagnostic, Diagnostics};
use std::cmp::Ordering;
use std::ffi::OsString;
use std::path::Path;

/// Options of `jurist import`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// A file with the matrices A, B, C, D: .mat (MATLAB up to -v7, SciPy), .npz (NumPy), .json, .csv, or .mo (OpenModelica's
    /// linearize); or a .c file of DSVerifier; '-' for standard input
    #[arg(value_name = "FILE")]
    pub file: OsString,
    /// The sample time of the matrices, 0 for continuous time; left out: that of the file. Nothing is made discrete by it
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub sample_time: Option<String>,
    /// Closes no loop: the inputs of the system are those of the model
    #[arg(long)]
    pub open: bool,
    /// Gives each entry that is no integer half a unit in its last place as a tolerance, for 'jurist tolerance'
    #[arg(long)]
    pub last_place: bool,
    #[command(flatten)]
    pub of_c: DsOptions,
    /// How the coefficients of a C file of DSVerifier are rounded [default: floor]
    #[arg(long, value_name = "MODE")]
    pub round: Option<String>,
    /// Writes the loop of a C file of DSVerifier with the coefficients that DSVerifier stores
    #[arg(long)]
    pub stored: bool,
    /// Writes the model to a file
    #[arg(short, long, value_name = "MODEL")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

/// What is said where the file cannot be read.
const SYSTEM: Wanted = Wanted {
    noun: "system",
    help: "FILE is a .mat, .npz, .json, .csv or .mo file with the matrices A, B, C, D, a .c file of DSVerifier, or '-' for standard input",
};

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let time = self.sample_time.as_ref().map(|text| sample_time(text, context)).transpose()?;
        let (name, bytes) = read_bytes(&self.file, &SYSTEM, context)?;
        context.budget.step("reading the system");
        let file = Path::new(&name).file_name().map_or(name.clone(), |file| file.to_string_lossy().into_owned());
        let is_c = is_c(&name, &bytes);
        refuse_options(self, is_c, context)?;
        if is_c {
            let words = Words { round: self.round.as_deref(), realisation: None };
            let (read, writing) = read_c((&name, &bytes), &self.of_c, words, context)?;
            let read = if self.stored { read.stored(writing.rounding)? } else { read };
            let text = read.model(&file, &writing)?;
            context.reporter.finish();
            finish_answer(&text, self.output.as_ref())?;
            return Ok(Status::Holds);
        }
        let (variables, source) = read(&name, &bytes)?;
        let system = assemble(variables, time).map_err(|error| match source {
            Some(source) => Diagnostics::from(error).in_source(&source),
            None => in_file(&name, error).into(),
        })?;
        let (text, remarks) = model(&system, &file, Form { open: self.open, last_place: self.last_place });
        for remark in remarks.iter().filter(|_| !context.quiet) {
            note(&format!("note: {remark}"));
        }
        context.reporter.finish();
        finish_answer(&text, self.output.as_ref())?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.inputs.push(("the system", self.file.as_os_str()));
        files.answer(self.output.as_ref());
        Ok(())
    }
}

/// Options of matrices go with matrices, those of DSVerifier with its files.
fn refuse_options(options: &Options, is_c: bool, context: &Context) -> Result<(), Error> {
    let of_matrices = [
        ("--sample-time", options.sample_time.is_some()),
        ("--open", options.open),
        ("--last-place", options.last_place),
    ];
    let of_c = [
        (options.of_c.given().unwrap_or_default(), options.of_c.given().is_some()),
        ("--round", options.round.is_some()),
        ("--stored", options.stored),
    ];
    let (wrong, goes) = match is_c {
        true => (of_matrices.iter().find(|(_, is_given)| *is_given), "goes with matrices, not with a C file"),
        false => (of_c.iter().find(|(_, is_given)| *is_given), "goes with a C file of DSVerifier, not with matrices"),
    };
    match wrong {
        Some((option, _)) => {
            let error = Diagnostic::error(Code::Usage, format!("{option} {goes}")).help("leave it out");
            Err(in_line(context.line, vec![error]).into())
        }
        None => Ok(()),
    }
}

/// The sample time that the command line gives, as a model file has it.
fn sample_time(text: &str, context: &Context) -> Result<Time, Error> {
    let value = plain_number(context.line, "--sample-time", text)?;
    match value.sign() {
        Ordering::Equal => Ok(Time::Continuous),
        Ordering::Greater => Ok(Time::Discrete(Some(format!("\"{}\"", text.trim().trim_start_matches('+'))))),
        Ordering::Less => {
            let place = context.line.option_value("--sample-time", text);
            let error = Diagnostic::error(Code::OptionValue, "a sample time is not negative").at(place.span, "");
            Err(in_line(context.line, vec![error.help("a positive number, or 0 for continuous time")]).into())
        }
    }
}
