//! `jurist analyze`: the verdict at nominal and the stable set of each parameter.

use super::{Context, Runs};
use crate::cli::arguments::DecisionOptions;
use crate::cli::destinations::Files;
use crate::cli::input::decision;
use crate::cli::requirements::warn_of_ignored;
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_engine::coverage::Asked;
use jurist_show::{Document, Text};

/// Options of `jurist analyze`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub decision: DecisionOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.decision.output;
        let digits = output.digits() as usize;
        let (model, question) = decision(&self.decision, context)?;
        warn_of_ignored(&model, context);
        let answer = question.analyze(&context.budget)?;
        let points = answer.verdict.iter().map(|(problem, _)| (problem, Asked::Verdict));
        for (problem, asked) in points.chain(answer.sets.iter().map(|(problem, _)| (problem, Asked::Intervals))) {
            context.explain(&self.decision.explain, output, problem, asked)?;
        }
        // Remarks on the question are the same for all its parts.
        let first =
            answer.verdict.as_ref().map(|(problem, _)| problem).or(answer.sets.first().map(|(problem, _)| problem));
        if let Some(problem) = first {
            context.warn(None, problem.warnings());
        }
        if let Some(stopped) = answer.stopped() {
            return context.undecided(output, stopped, || Some(answer.text(digits)), || answer.json(digits));
        }
        context.answer(output, || answer.text(digits), || answer.json(digits))?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.decision.model.model, &self.decision.output.output);
        Ok(())
    }
}
