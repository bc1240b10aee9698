//! `jurist intervals`: the exact stable set of one parameter.

use super::Context;
use crate::analysis::{DECAY, Decision, RADIUS, intervals};
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::input::{known_names, load, settings};
use crate::cli::status::{Outcome, Status};
use crate::report::{intervals_json, intervals_text};
use clap::Args;
use std::slice::from_ref;

/// Options of `jurist intervals`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The parameter in question: a parameter, a constant given as a number, 'radius' or 'decay'
    #[arg(long, value_name = "NAME")]
    pub param: String,
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
    if options.param != RADIUS && options.param != DECAY {
        known_names(context, &model, "--param", from_ref(&options.param))?;
    }
    let answer = match intervals(&model, &settings, &options.param, &context.budget) {
        Ok(answer) => answer,
        Err(failure) => return context.undecided(&options.output, "jurist/intervals/1", "stable", failure),
    };
    context.warn(None, &answer.question.warnings);
    let digits = options.output.digits() as usize;
    context.answer(&options.output, || intervals_text(&answer, digits), || intervals_json(&answer, digits))?;
    Ok(match &answer.stable {
        Decision::Decided(_) => Status::Holds,
        Decision::Undecided { budget, reached } => context.say_undecided(budget, reached),
    })
}
