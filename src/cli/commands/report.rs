//! `jurist report`: one page about one's own loop.

use super::map::ranges;
use super::{Context, Runs};
use crate::certified::{certify_intervals, certify_verdict};
use crate::cli::arguments::{DEFAULT_DIGITS, ModelOptions, RegionOptions, RunOptions};
use crate::cli::destinations::Files;
use crate::cli::input::{load, question};
use crate::cli::output::{ending, finish_answer, unknown_ending};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::share;
use clap::Args;
use jurist_algebra::limits::Budget;
use jurist_check::{Limits, check};
use jurist_draw::report::{ReportRequest, loop_report};
use jurist_engine::answer::Answer;
use jurist_engine::stability::StableSet;
use jurist_tune::answer::TuneAnswer;
use std::ffi::OsString;

/// Options of `jurist report`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Where the loop is cut for margins and the Bode diagram: a signal, a block (at its input), or a parameter (the loop's gain)
    /// [default: what [require] says, else the error of a single loop]
    #[arg(long, value_name = "SIGNAL")]
    pub at: Option<String>,
    /// Adds what holds for all values of a name, ends included: the values of each parameter, and how much of each margin [repeatable]
    #[arg(long = "for-all", value_name = "NAME=LO..HI")]
    pub for_all: Vec<String>,
    /// The page, an .html file; '-' is standard output
    #[arg(short, long, value_name = "FILE", default_value = "report.html")]
    pub output: OsString,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let file = &self.output;
        if file != "-" && !matches!(ending(file).as_deref(), Some("html" | "htm")) {
            return Err(unknown_ending(file, &["html"]).into());
        }
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        let question = question(context, &model, &self.model, &RegionOptions::default())?;
        let for_all = ranges(&self.for_all, &[], &model, context)?;
        let limits = self.run.timeout.map_or_else(Limits::default, Limits::within);
        let checker = |certificate: &str| {
            check(&model.source().text, certificate, &limits).map(|_| ()).map_err(|rejection| rejection.to_string())
        };
        let name = self.model.model.as_ref().map(|path| path.to_string_lossy().into_owned());
        let certifier = |answer: &Answer<StableSet>, budget: &Budget| {
            let certified = certify_intervals(answer, budget)?;
            let name = &answer.problem().parameter().name;
            let share = certified.window.as_ref().map(|window| share(name, window, &certified.proved));
            Ok((certified.text, share))
        };
        let best = |budget: &Budget| -> Result<String, jurist_engine::error::Error> {
            let answer = TuneAnswer::of_model(&question, budget)?;
            // The heading of the report is its first line already.
            Ok(answer
                .text(DEFAULT_DIGITS as usize)
                .split_once('\n')
                .map(|(_, rest)| rest.to_owned())
                .unwrap_or_default())
        };
        let request = ReportRequest {
            file: name.as_deref(),
            at: self.at.as_deref(),
            certify: Some(&certifier),
            certify_verdict: Some(&certify_verdict),
            check: Some(&checker),
            for_all: &for_all,
            best: model.tuning().is_some().then_some(&best),
        };
        let report = loop_report(&question, &request, &context.budget);
        context.reporter.finish();
        finish_answer(&report.html, Some(file))?;
        Ok(report.stopped.as_ref().map_or(Status::Holds, |stopped| context.say_undecided(stopped)))
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.inputs.extend(self.model.model.iter().map(|model| ("the model", model.as_os_str())));
        files.answer(Some(&self.output));
        Ok(())
    }
}
