//! `jurist verify`: re-checks a certificate.

use super::{Context, Runs};
use crate::cli::arguments::{ReadingOptions, RunOptions};
use crate::cli::destinations::Files;
use crate::cli::input::{CERTIFICATE, model_text, read_text};
use crate::cli::output::{note, write_answer};
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_check::format::MAX_TEXT;
use jurist_check::{Limits, Names, check, is_for_another_text, report};
use jurist_engine::error::{Code, Diagnostic, Source};
use jurist_engine::model::Reference;
use std::ffi::{OsStr, OsString};

/// Options of `jurist verify`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// The model that the statement is about: a file, '-' for standard input, or a loop in one line
    #[arg(value_name = "MODEL")]
    pub model: OsString,
    /// What '--certificate FILE' of verdict, intervals, map, tolerance, tune or ship has written
    #[arg(value_name = "CERTIFICATE")]
    pub certificate: OsString,
    #[command(flatten)]
    pub line: ReadingOptions,
    #[command(flatten)]
    pub run: RunOptions,
}

/// The name of a file for people.
fn shown(name: &OsStr) -> String {
    if name == "-" { "standard input".into() } else { name.to_string_lossy().into_owned() }
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let model = model_text(&self.model, &self.line, context, MAX_TEXT as u64)?;
        let certificate = read_text(context, &self.certificate, MAX_TEXT as u64, &CERTIFICATE)?;
        if let (Ok(first), Ok(second)) = (&model, &certificate)
            && is_certificate(first)
            && !is_certificate(second)
        {
            let error = Diagnostic::error(Code::Usage, "the first file is a certificate, and the second one is none");
            return Err(error.help("the model comes first: jurist verify MODEL CERTIFICATE").into());
        }
        let limits = self.run.timeout.map_or_else(Limits::default, Limits::within);
        let result = match (&model, &certificate) {
            (Ok(model), Ok(certificate)) => {
                let [of_model, of_certificate] = [&self.model, &self.certificate].map(|name| shown(name));
                let names = Names { model: &of_model, certificate: &of_certificate };
                let proved = check(model, certificate, &limits).map_err(|rejection| rejection.to_string());
                proved.map(|proved| report(&proved, model, certificate, names))
            }
            (Err(reason), _) | (_, Err(reason)) => Err(format!("the certificate is rejected: {reason}")),
        };
        context.reporter.finish();
        match result {
            Ok(said) => {
                write_answer(&said, None)?;
                Ok(Status::Holds)
            }
            Err(reason) => {
                note(&reason);
                if let (Ok(model), Ok(certificate)) = (&model, &certificate)
                    && is_for_another_text(model, certificate)
                {
                    note("the certificate was written for another text of a model: is it that of this file?");
                }
                let refers = |text: &str| Reference::all(&Source::new("", text)).is_ok_and(|found| !found.is_empty());
                if model.is_ok_and(|text| refers(&text)) {
                    note(
                        "the model takes numbers from other files: the certificate is about the copy that '--resolved FILE' wrote",
                    );
                }
                Ok(Status::Rejected)
            }
        }
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.inputs = vec![("the model", &self.model), ("the certificate", &self.certificate)];
        files.answer(None);
        Ok(())
    }

    fn without_answer(&self) -> Status {
        Status::Rejected
    }
}

/// Whether a text begins as a certificate does, whatever it proves.
fn is_certificate(text: &str) -> bool {
    text.trim_start().starts_with('{') && text.contains("jurist/certificate/")
}
