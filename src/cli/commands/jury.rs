//! `jurist jury`: the classical table and its conditions.

use super::{Context, Runs, decided};
use crate::cli::arguments::DecisionOptions;
use crate::cli::destinations::Files;
use crate::cli::input::{decision, known_names};
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_engine::coverage::Asked;
use jurist_engine::problem::{DECAY, RADIUS};
use jurist_show::documents::{JuryAtPoint, JuryInParameter};
use jurist_show::table_text;
use jurist_show::{Document, Text};
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

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.decision.output;
        let (model, question) = decision(&self.decision, context)?;
        let digits = output.digits() as usize;
        let Some(param) = &self.param else {
            let problem = question.problem()?;
            context.explain(&self.decision.explain, output, &problem, Asked::Jury)?;
            let answer = match decided(problem.point_table(&context.budget))? {
                Ok(answer) => answer,
                Err(stopped) => {
                    return context.undecided(output, &stopped, || None, || JuryAtPoint::new(&problem, Err(&stopped)));
                }
            };
            context.warn(None, problem.warnings());
            context.answer(output, || answer.text(digits), || answer.json(digits))?;
            return Ok(Status::Holds);
        };
        if param != RADIUS && param != DECAY {
            known_names(context, &model, "--param", from_ref(param))?;
        }
        let problem = question.free(param).problem()?;
        context.explain(&self.decision.explain, output, &problem, Asked::JuryInParameter)?;
        let answer = match decided(problem.parametric_table(&context.budget))? {
            Ok(answer) => answer,
            Err(stopped) => {
                let known = Err(&stopped);
                let text = || Some(table_text(&problem, known, digits));
                return context.undecided(output, &stopped, text, || JuryInParameter::new(&problem, known, digits));
            }
        };
        context.warn(None, problem.warnings());
        context.answer(output, || answer.text(digits), || answer.json(digits))?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.decision.model.model, &self.decision.output.output);
        Ok(())
    }
}
