//! `jurist jury`: the classical table and its conditions.

use super::Context;
use crate::analysis::{DECAY, Decision, RADIUS, parametric_table, point_table};
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::input::{known_names, load, settings};
use crate::cli::status::{Outcome, Status};
use crate::report::{point_table_json, point_table_text, table_json, table_text};
use clap::Args;
use std::slice::from_ref;

/// Options of `jurist jury`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Keeps this parameter: polynomial entries, and the solution set of each condition
    #[arg(long, value_name = "NAME")]
    pub param: Option<String>,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// The document's name.
const SCHEMA: &str = "jurist/jury/1";

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    context.check_output(&options.output)?;
    let model = load(options.model.model.as_ref(), context)?;
    let settings = settings(context, &model, &options.model, &options.region)?;
    let digits = options.output.digits() as usize;
    let Some(param) = &options.param else {
        let answer = match point_table(&model, &settings, &context.budget) {
            Ok(answer) => answer,
            Err(failure) => return context.undecided(&options.output, SCHEMA, "rows", failure),
        };
        context.warn(None, &answer.warnings);
        context.answer(&options.output, || point_table_text(&answer, digits), || point_table_json(&answer))?;
        return Ok(Status::Holds);
    };
    if param != RADIUS && param != DECAY {
        known_names(context, &model, "--param", from_ref(param))?;
    }
    let answer = match parametric_table(&model, &settings, param, &context.budget) {
        Ok(answer) => answer,
        Err(failure) => return context.undecided(&options.output, SCHEMA, "rows", failure),
    };
    context.warn(None, &answer.question.warnings);
    context.answer(&options.output, || table_text(&answer, digits), || table_json(&answer, digits))?;
    Ok(match (&answer.test, &answer.stable) {
        (Decision::Undecided { budget, reached }, _) | (_, Decision::Undecided { budget, reached }) => {
            context.say_undecided(budget, reached)
        }
        _ => Status::Holds,
    })
}
