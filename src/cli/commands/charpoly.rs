//! `jurist charpoly`: the characteristic polynomial.

use super::Context;
use crate::cli::arguments::{ModelOptions, OutputOptions};
use crate::cli::status::{Outcome, Status};
use clap::{Args, ValueEnum};

/// Options of `jurist charpoly`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Keeps a parameter as a symbol [repeatable; default: every parameter that is not set]
    #[arg(long, value_name = "NAME")]
    pub keep: Vec<String>,
    /// How it is written
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// As 1 + NAME num/den, for a root locus in NAME
    #[arg(long, value_name = "NAME", conflicts_with = "transfer")]
    pub root_locus_form: Option<String>,
    /// The closed-loop transfer function from an input to an output
    #[arg(long, num_args = 2, value_names = ["INPUT", "OUTPUT"])]
    pub transfer: Option<Vec<String>>,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(_options: &Options, _context: &Context) -> Outcome {
    Ok(Status::Holds)
}

/// The notations a polynomial is written in.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum Format {
    /// For people
    Text,
    /// For programs
    Json,
    /// A row per coefficient and monomial
    Csv,
    /// Aligned equations
    Latex,
    /// A coefficient vector, highest power first
    Matlab,
    /// A list of fractions, lowest power first
    Python,
    /// An array of fractions, lowest power first
    Rust,
}
