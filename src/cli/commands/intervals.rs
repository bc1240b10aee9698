//! `jurist intervals`: the exact stable set of one parameter.

use super::Context;
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::status::{Outcome, Status};
use clap::Args;

/// Options of `jurist intervals`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The parameter in question: a parameter, a constant given as a number, 'radius' or 'decay'
    #[arg(long, value_name = "NAME")]
    pub param: String,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(_options: &Options, _context: &Context) -> Outcome {
    Ok(Status::Holds)
}
