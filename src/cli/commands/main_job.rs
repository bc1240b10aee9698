//! `jurist`: the main job on the built-in drive.

use super::Context;
use crate::cli::arguments::OutputOptions;
use crate::cli::status::{Outcome, Status};
use clap::Args;

/// Options of `jurist` without a command.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(_options: &Options, _context: &Context) -> Outcome {
    Ok(Status::Holds)
}
