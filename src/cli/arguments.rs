//! What the command line looks like: commands and options.

#[cfg(feature = "cli")]
use super::commands;
use super::commands::Command;
use clap::{Args, Parser};
use std::ffi::OsString;
use std::time::Duration;

/// The whole command line.
#[derive(Parser, Debug)]
#[command(
    name = "jurist",
    version,
    about = "For which parameter values is this control loop stable? Exactly.",
    long_about = "For which parameter values is this control loop stable? Exactly.\n\n\
        Every number of a model is exact, and every limit is an algebraic number that is printed to any number of \
        digits. Without a command: the main job on the built-in drive, a chopper-fed DC motor with cascaded \
        controllers.",
    // Not the name of the file that was started.
    bin_name = "jurist",
    after_help = "MODEL is a TOML file, '-' for standard input, or one line; left out, it is the built-in drive.\n\
        A line is an open loop with unity negative feedback, 'K*10/(s*(s+1)*(s+2))', or a characteristic\n\
        polynomial, 'z^2 + z + 1/2' or '... = 0'. Without a command: its stable set.\n\n\
        Exit status: 0 answered, or it holds; 1 answered, and it does not hold (verdict); 2 bad usage or bad \
        model;\n3 undecided within the given budget; 4 certificate rejected.",
    args_conflicts_with_subcommands = true,
    disable_help_subcommand = true,
    infer_long_args = false
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[cfg(feature = "cli")]
    #[command(flatten)]
    pub main_job: commands::main_job::Options,
}

/// What the causes of ends mean.
pub(super) const CAUSES: &str = "Causes of an end: z=1, z=-1, s=0, complex pair, complex root: roots reach the boundary of stability there; infinity: the \
    degree is lost; pole: the model is undefined there (a division by zero, a block that loses its order, a loop that is \
    not well posed); domain: the parameter's domain ends. Several are joined by '+'.";

/// How the model is read: what stands before and behind the plant of a loop in one line, and what other files say.
#[derive(Args, Debug, Default, Clone, PartialEq)]
pub(super) struct ReadingOptions {
    /// MODEL is one line: a zero-order hold with the sample time T, a number or an expression, stands in front of the plant
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub hold: Option<String>,
    /// MODEL is one line: the plant has a dead time D, in units of time
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    pub delay: Option<String>,
    /// Writes the model with the numbers that it takes from other files (`from`) in their place: what a certificate is about
    #[cfg(feature = "cli")]
    #[arg(long, value_name = "FILE")]
    pub resolved: Option<OsString>,
}

/// The model and what is changed about it.
#[derive(Args, Debug, Default)]
pub(super) struct ModelOptions {
    /// A model file, '-' for standard input, or a loop in one line such as 'K/(s*(s + 1))'; left out: the built-in drive
    #[arg(value_name = "MODEL")]
    pub model: Option<OsString>,
    #[command(flatten)]
    pub line: ReadingOptions,
    /// Gives a parameter or constant another value, exactly: 545, 1e-4, 1/3 [repeatable]
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Replaces a parameter's domain, its ends excluded; either side may be left out [repeatable]
    #[arg(long, value_name = "NAME=LO..HI")]
    pub domain: Vec<String>,
}

/// The region that the roots are asked to lie in.
#[derive(Args, Debug, Default)]
pub(super) struct RegionOptions {
    /// Asks for all |z| < R instead of |z| < 1 (discrete time)
    #[arg(long, value_name = "R", allow_hyphen_values = true, conflicts_with = "decay")]
    pub radius: Option<String>,
    /// Asks for all Re s < -S instead of Re s < 0 (continuous time)
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    pub decay: Option<String>,
}

/// What every command is given that decides: a model, a region, and the form of the answer.
#[derive(Args, Debug, Default)]
pub(super) struct DecisionOptions {
    #[command(flatten)]
    pub model: ModelOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub explain: ExplainOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// What is said beside the answer.
#[derive(Args, Debug, Default)]
pub(super) struct ExplainOptions {
    /// Also says how the question is decided: coefficients, order, method, and what is presupposed
    #[arg(long)]
    pub explain: bool,
}

/// How the answer is written.
#[derive(Args, Debug, Default)]
pub(super) struct OutputOptions {
    /// Significant digits of decimal numbers [default: 12]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub digits: Option<u32>,
    /// Writes JSON
    #[arg(long)]
    pub json: bool,
    /// Writes to a file; its ending chooses the format
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

/// Where a picture goes, and the numbers behind it.
#[derive(Args, Debug)]
pub(super) struct PictureOptions {
    /// Writes JSON: the numbers behind the picture, in floating point, and what is certain about it
    #[arg(long)]
    pub json: bool,
    /// Writes the picture to a file: .svg, .png, .pdf, or the data: .csv, .json
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    /// Also writes the data, beside the picture
    #[arg(long)]
    pub csv: bool,
}

impl OutputOptions {
    /// The digits asked for, or the default.
    pub fn digits(&self) -> u32 {
        self.digits.unwrap_or(DEFAULT_DIGITS)
    }
}

/// Significant digits where `--digits` is not given.
pub(super) const DEFAULT_DIGITS: u32 = 12;

/// How long to work and how much to say meanwhile.
#[derive(Args, Debug, Default)]
pub(super) struct RunOptions {
    /// Gives up after this time, with exit status 3
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub timeout: Option<Duration>,
    /// Gives up after so much counted work, with exit status 3
    #[arg(long, value_name = "UNITS")]
    pub work: Option<u64>,
    /// Gives up rather than use more megabytes of memory, with exit status 3 [default: 800]
    #[arg(long, value_name = "MB", allow_negative_numbers = true, value_parser = megabytes)]
    pub memory: Option<u64>,
    /// Works on so many threads; the answer is the same for any number [default: those of the machine]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// No warnings, no progress
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Tells on standard error what is being done
    #[arg(short, long)]
    pub verbose: bool,
}

/// Bytes that may be in use where `--memory` is not given: a process that counts so many needs less than a gigabyte.
const DEFAULT_MEMORY: u64 = 800 * MEGABYTE;

const MEGABYTE: u64 = 1_000_000;

impl RunOptions {
    /// The bytes that may be in use.
    pub fn memory(&self) -> u64 {
        self.memory.unwrap_or(DEFAULT_MEMORY)
    }
}

/// A number of megabytes, in bytes.
fn megabytes(text: &str) -> Result<u64, String> {
    let megabytes: u64 = text.parse().map_err(|_| "a whole number of megabytes is expected, such as 800".to_owned())?;
    // More than can be counted is as good as no limit.
    Ok(megabytes.saturating_mul(MEGABYTE))
}

/// A duration that is not negative, in decimal notation.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| "a number of seconds is expected, such as 10 or 0.5".to_owned())?;
    if seconds.is_nan() || seconds < 0.0 {
        return Err("a time is not negative".to_owned());
    }
    // Longer than the clock can count is as good as for ever.
    Ok(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definitions_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn memory() {
        assert_eq!(megabytes("0"), Ok(0));
        assert_eq!(megabytes("800"), Ok(DEFAULT_MEMORY));
        assert_eq!(megabytes("18446744073709551615"), Ok(u64::MAX));
        assert!(megabytes("-1").is_err() && megabytes("1.5").is_err() && megabytes("").is_err());
    }

    #[test]
    fn times() {
        assert_eq!(seconds("0"), Ok(Duration::ZERO));
        assert_eq!(seconds("0.5"), Ok(Duration::from_millis(500)));
        assert_eq!(seconds("1e300"), Ok(Duration::MAX));
        assert_eq!(seconds("inf"), Ok(Duration::MAX));
        assert!(seconds("-1").is_err());
        assert!(seconds("nan").is_err());
        assert!(seconds("").is_err());
    }
}
