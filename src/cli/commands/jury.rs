//! `jurist jury`: the classical table and its conditions.

use super::Context;
use crate::cli::arguments::DecisionOptions;
use crate::cli::input::{decision, known_names};
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_engine::analysis::{DECAY, Decision, Point, RADIUS, TableAnswer, asked, parametric_table, point_table};
use jurist_engine::show::json::to_text;
use jurist_engine::show::{point_table_json, point_table_text, table_json, table_text};
use std::slice::from_ref;

/// Options of `jurist jury`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// Keeps this parameter: polynomial entries, and the solution set of each condition
    #[arg(long, value_name = "NAME")]
    pub param: Option<String>,
    #[command(flatten)]
    pub decision: DecisionOptions,
}

/// The document's name.
const SCHEMA: &str = "jurist/jury/1";

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let output = &options.decision.output;
    let (model, settings) = decision(&options.decision, context)?;
    let digits = output.digits() as usize;
    let Some(param) = &options.param else {
        let point = Point::of(&model, &settings, &[])?;
        context.know_point(output, SCHEMA, "rows", point.clone())?;
        let answer = match point_table(&model, &settings, &context.budget) {
            Ok(answer) => answer,
            Err(failure) => {
                return context.undecided_at_point(output, SCHEMA, "rows", failure, &point);
            }
        };
        context.warn(None, &answer.warnings);
        context.answer(output, || point_table_text(&answer, digits), || point_table_json(&answer))?;
        return Ok(Status::Holds);
    };
    if param != RADIUS && param != DECAY {
        known_names(context, &model, "--param", from_ref(param))?;
    }
    let question = asked(&model, &settings, param)?;
    context.know(output, move |wants_json, budget, reached| {
        let stable = Decision::Undecided { budget: budget.clone(), reached: reached.clone() };
        let answer = TableAnswer { question, stable, test: Decision::Undecided { budget, reached } };
        Some(if wants_json { to_text(&table_json(&answer, digits)) } else { table_text(&answer, digits) })
    })?;
    let answer = parametric_table(&model, &settings, param, &context.budget)?;
    context.warn(None, &answer.question.warnings);
    context.answer(output, || table_text(&answer, digits), || table_json(&answer, digits))?;
    Ok(match (&answer.test, &answer.stable) {
        (Decision::Undecided { budget, reached }, _) | (_, Decision::Undecided { budget, reached }) => {
            context.say_undecided(budget, reached)
        }
        _ => Status::Holds,
    })
}
