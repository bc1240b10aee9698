//! `jurist analyze`: the verdict at nominal and the stable set of each parameter.

use super::Context;
use crate::cli::arguments::DecisionOptions;
use crate::cli::input::decision;
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_engine::analysis::{Analysis, Decision, Point, analyze, asked};
use jurist_engine::show::json::to_text;
use jurist_engine::show::{analysis_json, analysis_text};

/// Options of `jurist analyze`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub decision: DecisionOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let output = &options.decision.output;
    let (model, settings) = decision(&options.decision, context)?;
    let digits = output.digits() as usize;
    let names = model.parameters().iter().map(|p| p.name.as_str()).filter(|name| !settings.set.contains_key(*name));
    let questions: Vec<_> = names.filter_map(|name| asked(&model, &settings, name).ok()).collect();
    let point = Point::of(&model, &settings, &[]).ok();
    context.know(output, move |wants_json, budget, reached| {
        let answer = Analysis::undecided(point, questions, &budget, &reached);
        Some(if wants_json { to_text(&analysis_json(&answer, digits)) } else { analysis_text(&answer, digits) })
    })?;
    let answer = analyze(&model, &settings, &context.budget)?;
    context.warn(None, &answer.warnings);
    context.answer(output, || analysis_text(&answer, digits), || analysis_json(&answer, digits))?;
    if let Some(Decision::Undecided { budget, reached }) = &answer.verdict {
        return Ok(context.say_undecided(budget, reached));
    }
    for intervals in &answer.intervals {
        if let Decision::Undecided { budget, reached } = &intervals.stable {
            return Ok(context.say_undecided(budget, reached));
        }
    }
    Ok(Status::Holds)
}
