//! `jurist completions`: completion scripts.

use super::{Context, Runs};
use crate::cli::arguments::Arguments;
use crate::cli::output::write_answer;
use crate::cli::status::{Outcome, Status};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Options of `jurist completions`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    pub shell: Shell,
}

impl Runs for Options {
    fn run(&self, _: &Context) -> Outcome {
        run(self)
    }
}

/// Prints the script.
fn run(options: &Options) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut Arguments::command(), "jurist", &mut script);
    write_answer(&String::from_utf8_lossy(&script), None)?;
    Ok(Status::Holds)
}
