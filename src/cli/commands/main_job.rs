//! `jurist`: the main job on the built-in drive.

use super::{Context, Runs, decided};
use crate::cli::arguments::OutputOptions;
use crate::cli::destinations::Files;
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_drive::{main_job, main_job_json, main_job_text, main_job_undecided};
use jurist_engine::model::Model;

/// Options of `jurist` without a command.
#[derive(Args, Debug, Default)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub output: OutputOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        context.check_output(&self.output)?;
        let job = match decided(main_job(&Model::drive(), &context.budget))? {
            Ok(job) => job,
            Err(stopped) => {
                return context.undecided(&self.output, &stopped, || None, || main_job_undecided(&stopped));
            }
        };
        let digits = self.output.digits() as usize;
        context.answer(&self.output, || main_job_text(&job, digits), || main_job_json(&job, digits))?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.answer(self.output.output.as_ref());
        Ok(())
    }
}
