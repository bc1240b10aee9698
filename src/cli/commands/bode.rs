//! `jurist bode`: modulus and phase of the open loop over frequency.

use super::{Context, Runs, frequency_response};
use crate::cli::destinations::Files;
use crate::cli::status::{Error, Outcome};
use clap::Args;

/// Options of `jurist bode`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub picture: frequency_response::Options,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        frequency_response::run(&self.picture, frequency_response::BODE, context)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.picture(&self.picture.model.model, &self.picture.picture)
    }
}
