//! `jurist verdict`: one point.

use super::Context;
use crate::analysis::{Verdict, verdict};
use crate::certificate::emit::verdict_certificate;
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::input::{load, settings};
use crate::cli::output::write_answer;
use crate::cli::status::{Outcome, Status};
use crate::report::{verdict_json, verdict_text};
use clap::Args;
use std::ffi::OsString;

/// Options of `jurist verdict`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    /// Writes a certificate that 'jurist verify' re-checks
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file; the status is 1 for anything but stable.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    context.check_output(&options.output)?;
    let model = load(options.model.model.as_ref(), context)?;
    let settings = settings(context, &model, &options.model, &options.region)?;
    let answer = match verdict(&model, &settings, &context.budget) {
        Ok(answer) => answer,
        Err(failure) => return context.undecided(&options.output, "jurist/verdict/1", "verdict", failure),
    };
    context.warn(None, &answer.warnings);
    if let Some(file) = &options.certificate {
        write_answer(&verdict_certificate(&model, &settings, &answer, &context.budget)?, Some(file))?;
    }
    context.answer(&options.output, || verdict_text(&answer), || verdict_json(&answer))?;
    Ok(if answer.verdict == Verdict::Stable { Status::Holds } else { Status::DoesNotHold })
}
