//! `jurist analyze`: the verdict at nominal and the stable set of each parameter.

use super::Context;
use crate::analysis::{Decision, analyze};
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::input::{load, settings};
use crate::cli::status::{Outcome, Status};
use crate::report::{analysis_json, analysis_text};
use clap::Args;

/// Options of `jurist analyze`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    context.check_output(&options.output)?;
    let model = load(options.model.model.as_ref(), context)?;
    let settings = settings(context, &model, &options.model, &options.region)?;
    let answer = match analyze(&model, &settings, &context.budget) {
        Ok(answer) => answer,
        Err(failure) => return context.undecided(&options.output, "jurist/analyze/1", "parameters", failure),
    };
    let warnings = match (&answer.verdict, answer.intervals.first()) {
        (Some(verdict), _) => verdict.warnings.as_slice(),
        (None, Some(first)) => first.question.warnings.as_slice(),
        (None, None) => &[],
    };
    context.warn(None, warnings);
    let digits = options.output.digits() as usize;
    context.answer(&options.output, || analysis_text(&answer, digits), || analysis_json(&answer, digits))?;
    for intervals in &answer.intervals {
        if let Decision::Undecided { budget, reached } = &intervals.stable {
            return Ok(context.say_undecided(budget, reached));
        }
    }
    Ok(Status::Holds)
}
