//! `jurist map`: the stable region in two parameters.

use super::Context;
use crate::analysis::{Decision, map};
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::input::{known_names, load, settings};
use crate::cli::status::{Outcome, Status};
use crate::report::{map_json, map_text};
use clap::Args;
use std::slice::from_ref;

/// Options of `jurist map`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The first parameter: a parameter, or a constant given as a number
    #[arg(short = 'x', value_name = "NAME")]
    pub x: String,
    /// The second parameter
    #[arg(short = 'y', value_name = "NAME")]
    pub y: String,
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
    for (option, name) in [("-x", &options.x), ("-y", &options.y)] {
        known_names(context, &model, option, from_ref(name))?;
    }
    let answer = match map(&model, &settings, [&options.x, &options.y], &context.budget) {
        Ok(answer) => answer,
        Err(failure) => return context.undecided(&options.output, "jurist/map/1", "regions", failure),
    };
    context.warn(None, &answer.warnings);
    let digits = options.output.digits() as usize;
    context.answer(&options.output, || map_text(&answer, digits), || map_json(&answer, digits))?;
    Ok(match &answer.map {
        Decision::Decided(_) => Status::Holds,
        Decision::Undecided { budget, reached } => context.say_undecided(budget, reached),
    })
}
