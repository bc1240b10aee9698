//! `jurist report`: one page about one's own loop.

use super::Context;
use crate::cli::arguments::{ModelOptions, RegionOptions, RunOptions};
use crate::cli::input::{load, question};
use crate::cli::output::{ending, note, unknown_ending, write_answer};
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_check::{Limits, check};
use jurist_draw::report::loop_report;
use std::ffi::OsString;

/// Options of `jurist report`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The page, an .html file; '-' is standard output
    #[arg(short, long, value_name = "FILE", default_value = "report.html")]
    pub output: OsString,
    #[command(flatten)]
    pub run: RunOptions,
}

/// Writes the page; the status is 3 where the budget ended a part of it.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let file = &options.output;
    if file != "-" && !matches!(ending(file).as_deref(), Some("html" | "htm")) {
        return Err(unknown_ending(file, &["html"]).into());
    }
    let model = load(options.model.model.as_ref(), context)?;
    let question = question(context, &model, &options.model, &RegionOptions::default())?;
    let limits = options.run.timeout.map_or_else(Limits::default, Limits::within);
    let checker = |certificate: &str| {
        check(&model.source().text, certificate, &limits).map(|_| ()).map_err(|rejection| rejection.to_string())
    };
    let name = options.model.model.as_ref().map(|path| path.to_string_lossy().into_owned());
    let report = loop_report(&question, name.as_deref(), Some(&checker), &context.budget);
    context.reporter.finish();
    write_answer(&report.html, Some(file))?;
    if file != "-" && !context.quiet {
        note(&format!("wrote {}", file.to_string_lossy()));
    }
    Ok(match &report.stopped {
        Some(stopped) => context.say_undecided(stopped),
        None => Status::Holds,
    })
}
