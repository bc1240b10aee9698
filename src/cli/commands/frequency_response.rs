//! `jurist bode`, `jurist nyquist`: pictures of the open loop over frequency.

use super::Context;
use crate::cli::arguments::{ModelOptions, PictureOptions, RegionOptions, RunOptions};
use crate::cli::input::{load, question};
use crate::cli::picture::{Picture, deliver, wanted};
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_algebra::number::Rational;
use jurist_draw::document::frequency_response_json;
use jurist_draw::figures::{Figure, FrequencyResponse, bode, frequency_response, nyquist};
use jurist_engine::answer::Answer;
use jurist_engine::response::Margins;
use jurist_show::documents::to_text;

/// Options of both.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Where the loop is cut: a signal, a block (at its input), or a parameter (the loop's gain) [default: what
    /// [require] says, else the error of a single loop]
    #[arg(long, value_name = "SIGNAL")]
    pub at: Option<String>,
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub run: RunOptions,
}

/// Which picture.
type Draw = fn(&Answer<Margins>, &FrequencyResponse) -> Figure;

/// Modulus and phase.
pub(in crate::cli) const BODE: Draw = bode;

/// The curve around -1.
pub(in crate::cli) const NYQUIST: Draw = nyquist;

/// Draws to a file or on the terminal.
pub(in crate::cli) fn run(options: &Options, draw: Draw, context: &Context) -> Outcome {
    let kind = wanted(&options.picture)?;
    let model = load(options.model.model.as_ref(), &options.model.line, context)?;
    let question = question(context, &model, &options.model, &RegionOptions::default())?;
    let answer = question.margins(options.at.as_deref(), &Rational::ZERO, &context.budget)?;
    context.warn(None, answer.problem().warnings());
    let response = frequency_response(answer.value(), &context.budget)?;
    let figure = context.budget.enter(|| draw(&answer, &response))?;
    context.reporter.finish();
    let table = || response.to_csv();
    let document = || to_text(&frequency_response_json(&answer, &response));
    let out = Picture { figure: &figure, csv: &table, json: &document, csv_beside: options.picture.csv };
    deliver(&out, kind, options.picture.output.as_ref())?;
    Ok(Status::Holds)
}
