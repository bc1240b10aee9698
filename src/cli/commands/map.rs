//! `jurist map`: the stable region in two parameters.

use super::Context;
use super::map_boxes::{self, MethodOptions};
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::assignments::{AxisRequest, axis};
use crate::cli::input::{known_name, load, settings};
use crate::cli::output::{ending, note, unknown_ending};
use crate::cli::picture::{png, write};
use crate::cli::status::{Failure, Outcome, Status};
use clap::Args;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_draw::figures::map::{MapContents, WindowRequest, choose_windows, trace_map};
use jurist_draw::page::map_page;
use jurist_drive::published_limits;
use jurist_engine::analysis::{Decision, Intervals, Map, MapAnswer, RegionExtent, Settings, map_by};
use jurist_engine::show::{map_json, map_text};
use std::path::Path;

/// Digits to which places and frequencies are enclosed, at least and at most.
const LIMIT_DIGITS: (usize, usize) = (10, 20);

/// Width and height of the picture, and of the one that a page shows on a telephone.
const WIDE: (f64, f64) = (860.0, 600.0);
const NARROW: (f64, f64) = (400.0, 470.0);

/// Options of `jurist map`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The first parameter: a parameter, or a constant given as a number; with the picture's window
    #[arg(short = 'x', value_name = "NAME[=LO..HI]", allow_hyphen_values = true)]
    pub x: String,
    /// The second parameter
    #[arg(short = 'y', value_name = "NAME[=LO..HI]", allow_hyphen_values = true)]
    pub y: String,
    /// Draws x on a logarithmic axis [default: for positive ranges of two decades and more]
    #[arg(long, conflicts_with = "linear_x")]
    pub log_x: bool,
    /// Draws y on a logarithmic axis
    #[arg(long, conflicts_with = "linear_y")]
    pub log_y: bool,
    /// Draws x on a linear axis
    #[arg(long)]
    pub linear_x: bool,
    /// Draws y on a linear axis
    #[arg(long)]
    pub linear_y: bool,
    #[command(flatten)]
    pub method: MethodOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// What is written where a picture is asked for.
#[derive(Clone, Copy, PartialEq)]
enum Picture {
    Svg,
    Png,
    Page,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let picture = picture_of(options)?;
    let axes = [("-x", &options.x), ("-y", &options.y)];
    let [x, y] = axes.map(|(option, text)| axis(context.line, option, text));
    let requests = [x?, y?];
    let model = load(options.model.model.as_ref(), context)?;
    let settings = settings(context, &model, &options.model, &options.region)?;
    for request in &requests {
        known_name(context, &model, &request.name, request.name_span)?;
    }
    let boxes = options.method.request(&requests, context)?;
    let names = [requests[0].name.as_str(), requests[1].name.as_str()];
    let answer = match map_by(&model, &settings, names, options.method.method(), &boxes, &context.budget) {
        Ok(MapAnswer::Exact(answer)) => *answer,
        Ok(MapAnswer::Boxes(boxes)) => {
            context.warn(None, &boxes.question.warnings);
            return map_boxes::answer(&boxes, &options.output, context);
        }
        Err(failure) => return context.undecided(&options.output, "jurist/map/1", "regions", failure),
    };
    context.warn(None, &answer.warnings);
    let digits = options.output.digits() as usize;
    let limits = answer.limits(digits.clamp(LIMIT_DIGITS.0, LIMIT_DIGITS.1), &context.budget);
    let limits = limits.unwrap_or_else(|exhausted| {
        note(&format!("the regions are decided, what limits them is not: {exhausted}"));
        Vec::new()
    });
    let slices = nominal_slices(&answer, &context.budget);
    let shown = Shown { answer: &answer, limits: &limits, slices: &slices, digits };
    match picture {
        Some(kind) if answer.map.decided().is_some() => {
            let built_in = options.model.model.is_none();
            if let Err(exhausted) =
                draw(&shown, kind, windows(options, &requests), built_in, &settings, options, context)?
            {
                return Ok(context.say_undecided(&exhausted.budget, &context.budget.reached()));
            }
        }
        Some(_) => {}
        None => context.answer(
            &options.output,
            || map_text(&answer, &limits, &slices, digits),
            || map_json(&answer, &limits, digits),
        )?,
    }
    Ok(match &answer.map {
        Decision::Decided(_) => Status::Holds,
        Decision::Undecided { budget, reached } => {
            let status = context.say_undecided(budget, reached);
            if let Some(hint) = options.method.hint(&boxes) {
                note(&hint);
            }
            status
        }
    })
}

/// The answer with what is said beside it.
struct Shown<'a> {
    answer: &'a Map,
    limits: &'a [RegionExtent],
    slices: &'a [Intervals],
    digits: usize,
}

/// The kind of picture that the output file's ending asks for, if it asks for one.
fn picture_of(options: &Options) -> Result<Option<Picture>, Failure> {
    let Some(file) = options.output.output.as_ref().filter(|f| *f != "-" && !options.output.json) else {
        return Ok(None);
    };
    match ending(file).as_deref() {
        Some("svg") => Ok(Some(Picture::Svg)),
        Some("png") => Ok(Some(Picture::Png)),
        Some("html" | "htm") => Ok(Some(Picture::Page)),
        Some("txt" | "json") | None => Ok(None),
        Some(_) => Err(unknown_ending(file, &["txt", "json", "svg", "png", "html"]).into()),
    }
}

fn windows(options: &Options, requests: &[AxisRequest; 2]) -> [WindowRequest; 2] {
    let scale = |log: bool, linear: bool| (log || linear).then_some(log);
    let request = |axis: &AxisRequest, logarithmic| WindowRequest {
        lower: axis.lower.clone(),
        upper: axis.upper.clone(),
        logarithmic,
    };
    [
        request(&requests[0], scale(options.log_x, options.linear_x)),
        request(&requests[1], scale(options.log_y, options.linear_y)),
    ]
}

/// Draws the picture to the file; the inner error says that the budget ran out.
fn draw(
    shown: &Shown<'_>,
    kind: Picture,
    requests: [WindowRequest; 2],
    built_in: bool,
    settings: &Settings,
    options: &Options,
    context: &Context,
) -> Result<Result<(), Exhausted>, Failure> {
    let Some(file) = &options.output.output else { return Ok(Ok(())) };
    let published = if built_in { published_limits(shown.answer, settings) } else { Vec::new() };
    let windows = choose_windows(shown.answer, shown.limits, shown.slices, &published, &requests);
    let trace = match trace_map(shown.answer, windows, &context.budget) {
        Ok(trace) => trace,
        Err(exhausted) => return Ok(Err(exhausted)),
    };
    let contents = match MapContents::new(shown.answer, &trace, shown.slices, shown.limits, published, &context.budget)
    {
        Ok(Some(contents)) => contents,
        Ok(None) => return Ok(Ok(())),
        Err(exhausted) => return Ok(Err(exhausted)),
    };
    context.reporter.finish();
    let wide = contents.draw(WIDE.0, WIDE.1, kind != Picture::Page);
    let path = Path::new(file);
    match kind {
        Picture::Svg => write(path, wide.figure.svg().as_bytes())?,
        Picture::Png => write(path, &png(&wide.figure)?)?,
        Picture::Page => {
            let narrow = contents.draw(NARROW.0, NARROW.1, false);
            let text = map_text(shown.answer, shown.limits, shown.slices, shown.digits);
            write(path, map_page(shown.answer, &contents, &trace, &[wide, narrow], &text).as_bytes())?;
        }
    }
    Ok(Ok(()))
}

/// The stable sets on the two lines through the nominal point, as far as the budget allows.
fn nominal_slices(answer: &Map, budget: &Budget) -> Vec<Intervals> {
    let on = |fixed: usize| answer.axes[fixed].nominal.as_ref().and_then(|v| answer.slice(fixed, v, budget).ok());
    [on(0), on(1)].into_iter().flatten().collect()
}
