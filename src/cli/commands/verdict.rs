//! `jurist verdict`: one point.

use super::Context;
use crate::cli::arguments::DecisionOptions;
use crate::cli::input::decision;
use crate::cli::output::write_answer;
use crate::cli::status::{Outcome, Status};
use crate::cli::written::check_certificate;
use clap::Args;
use jurist_engine::analysis::{Point, Verdict, verdict};
use jurist_engine::prove::emit::verdict_certificate;
use jurist_engine::show::{verdict_json, verdict_text};
use std::ffi::OsString;

/// Options of `jurist verdict`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub decision: DecisionOptions,
    /// Writes a certificate that 'jurist verify' re-checks
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
}

/// The document's name.
const SCHEMA: &str = "jurist/verdict/1";

/// Answers on standard output or in a file; the status is 1 for anything but stable.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let output = &options.decision.output;
    let (model, settings) = decision(&options.decision, context)?;
    let point = Point::of(&model, &settings, &[])?;
    context.know_point(output, SCHEMA, "verdict", point.clone())?;
    let answer = match verdict(&model, &settings, &context.budget) {
        Ok(answer) => answer,
        Err(failure) => {
            return context.undecided_at_point(output, SCHEMA, "verdict", failure, &point);
        }
    };
    context.warn(None, &answer.warnings);
    let mut written = None;
    if let Some(file) = &options.certificate {
        let certificate = verdict_certificate(&model, &settings, &answer, &context.budget)?;
        write_answer(&certificate, Some(file))?;
        written = Some((certificate, file));
    }
    context.answer(output, || verdict_text(&answer), || verdict_json(&answer))?;
    if let Some((text, file)) = written {
        check_certificate(context, &output.run, &model.source().text, &text, file);
    }
    Ok(if answer.verdict == Verdict::Stable { Status::Holds } else { Status::DoesNotHold })
}
