//! `jurist import`: a model file from a state-space system of another program, or from a loop of DSVerifier.

use super::{Context, Runs};
use crate::cli::arguments::RunOptions;
use crate::cli::assignments::{in_line, plain_number};
use crate::cli::destinations::Files;
use crate::cli::import::dsverifier::{self, ReadingWord};
use crate::cli::import::{Form, Time, assemble, in_file, model, read};
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
    /// linearize); or .c, a loop of DSVerifier; '-' for standard input
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
    /// How the lists of a .c file are read: falling powers of z (the last entry is the constant), or powers of 1/z (the first
    /// is) [default: z]
    #[arg(long, value_enum, value_name = "POWERS")]
    pub reading: Option<ReadingWord>,
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
        run(self, context)
    }

    fn run_options(&self) -> &RunOptions {
        &self.run
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.inputs.push(("the system", self.file.as_os_str()));
        files.answer(self.output.as_ref());
        Ok(())
    }
}

/// Writes the model to standard output or to a file.
fn run(options: &Options, context: &Context) -> Outcome {
    let time = options.sample_time.as_ref().map(|text| sample_time(text, context)).transpose()?;
    let (name, bytes) = read_bytes(&options.file, &SYSTEM, context)?;
    context.budget.step("reading the system");
    if dsverifier::is_named(&name, &bytes) {
        return of_dsverifier(options, &name, &bytes, context);
    }
    if options.reading.is_some() {
        let error = Diagnostic::error(Code::Usage, "--reading goes with a .c file of DSVerifier, not with matrices");
        return Err(error.help("leave it out").into());
    }
    let (variables, source) = read(&name, &bytes)?;
    let system = assemble(variables, time).map_err(|error| match source {
        Some(source) => Diagnostics::from(error).in_source(&source),
        None => in_file(&name, error).into(),
    })?;
    let file = Path::new(&name).file_name().map_or(name.clone(), |file| file.to_string_lossy().into_owned());
    let (text, remarks) = model(&system, &file, Form { open: options.open, last_place: options.last_place });
    for remark in remarks.iter().filter(|_| !context.quiet) {
        note(&format!("note: {remark}"));
    }
    context.reporter.finish();
    finish_answer(&text, options.output.as_ref())?;
    Ok(Status::Holds)
}

/// Writes the model of a loop of DSVerifier, which is closed and has its sample time.
fn of_dsverifier(options: &Options, name: &str, bytes: &[u8], context: &Context) -> Outcome {
    let given = [
        ("--sample-time", options.sample_time.is_some()),
        ("--open", options.open),
        ("--last-place", options.last_place),
    ];
    if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
        let error =
            Diagnostic::error(Code::Usage, format!("{option} goes with matrices, not with a .c file of DSVerifier"));
        return Err(error.help("leave it out").into());
    }
    let found = dsverifier::read(name, bytes, options.reading)?;
    for remark in found.remarks.iter().filter(|_| !context.quiet) {
        note(&format!("note: {remark}"));
    }
    context.reporter.finish();
    finish_answer(&found.model, options.output.as_ref())?;
    Ok(Status::Holds)
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
