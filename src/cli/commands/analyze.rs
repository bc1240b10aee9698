//! `jurist analyze`: the verdict at nominal and the stable set of each parameter.

use super::Context;
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::status::{Outcome, Status};
use clap::Args;

/// Options of `jurist analyze`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(_options: &Options, _context: &Context) -> Outcome {
    Ok(Status::Holds)
}
