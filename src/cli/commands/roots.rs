//! `jurist roots`: where the roots of the closed loop are.

use super::{Context, Runs, decided};
use crate::cli::arguments::{ExplainOptions, ModelOptions, OutputOptions, RegionOptions};
use crate::cli::destinations::Files;
use crate::cli::input::{load, question};
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_engine::answer::RIGHTMOST;
use jurist_engine::coverage::Asked;
use jurist_show::documents::Roots;
use jurist_show::{Document, Text};

/// Options of `jurist roots`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Of a loop with dead time, which has infinitely many roots: how many of the rightmost are listed, a pair being one
    #[arg(long, value_name = "N", default_value_t = RIGHTMOST as u16, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub rightmost: u16,
    #[command(flatten)]
    pub explain: ExplainOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.output;
        context.check_output(output)?;
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        let digits = output.digits() as usize;
        let problem = question(context, &model, &self.model, &RegionOptions::default())?.problem()?;
        context.explain(&self.explain, output, &problem, Asked::Roots)?;
        let answer = match decided(problem.rightmost_roots(self.rightmost.into(), digits, &context.budget))? {
            Ok(answer) => answer,
            Err(stopped) => {
                return context.undecided(output, &stopped, || None, || Roots::new(&problem, Err(&stopped), digits));
            }
        };
        context.warn(None, problem.warnings());
        context.answer(output, || answer.text(digits), || answer.json(digits))?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model.model, &self.output.output);
        Ok(())
    }
}
