//! `jurist jury`: the classical table and its conditions.

use super::Context;
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::status::{Outcome, Status};
use clap::Args;

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

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(_options: &Options, _context: &Context) -> Outcome {
    Ok(Status::Holds)
}
