//! `jurist map -z`: the stable region in three parameters, by exact maps at values of the third.

use super::Context;
use super::map::{LIMIT_DIGITS, NARROW, Options, Picture, WIDE, windows};
use super::map_boxes::MethodName;
use crate::cli::assignments::{AxisRequest, SlicesRequest, in_line, slices};
use crate::cli::input::known_name;
use crate::cli::output::note;
use crate::cli::picture::{WRITES, pdf, png, write};
use crate::cli::requirements::warn_of_ignored;
use crate::cli::status::{Error, Outcome, Status};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_draw::figures::map::{MapContents, MapTrace, common_windows, small_multiples, trace_map};
use jurist_draw::page::body_page;
use jurist_engine::answer::{Answer, Body};
use jurist_engine::coverage::Asked;
use jurist_engine::error::{Code, Diagnostic, Span};
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use jurist_show::{Document, Text};
use std::path::Path;

/// The ends of stability in the third parameter are narrowed to this part of its range.
const NARROW_TO: u32 = 1000;

/// Answers on standard output or in a file.
pub(super) fn run(
    z: &str,
    options: &Options,
    axes: &[AxisRequest; 2],
    picture: Option<Picture>,
    (model, question): (&Model, Question),
    context: &Context,
) -> Outcome {
    if options.certificate.is_some() {
        let message = "maps at several values of a third parameter have no certificate";
        let error = Diagnostic::error(Code::NoCertificate, message);
        return Err(error.help("ask for the map at one value: '--set NAME=VALUE' in the place of '-z'").into());
    }
    let request = slices(context.line, "-z", z)?;
    known_name(context, model, request.values.name(), request.name_span)?;
    fits(options)?;
    warn_of_ignored(model, context);
    let problem =
        question.clone().body_problem(&request.values).map_err(|error| pointed(error, &request, axes, context))?;
    let digits = options.output.digits() as usize;
    let places = digits.clamp(LIMIT_DIGITS.0, LIMIT_DIGITS.1);
    let narrow = request.values.width() / Rational::from(NARROW_TO);
    let answer = question.body(&request.values, &narrow, places, &context.budget);
    let answer = answer.map_err(|error| pointed(error, &request, axes, context))?;
    context.warn(None, problem.warnings());
    context.explain(&options.explain, &options.output, answer.problem(), Asked::Slices)?;
    let body = answer.value();
    let limits = body.slices.iter().filter_map(|slice| slice.map.as_ref().ok()?.value().limits.as_ref().err());
    if let Some(stopped) = limits.clone().next() {
        let count = limits.count();
        note(&format!("the regions are decided; what limits those of {count} slices is not: {stopped}"));
    }
    let open = body.open_slices().count();
    let stopped = body.stopped().map(|stopped| match open {
        0 => stopped.clone(),
        _ => Exhausted::new(
            stopped.stop.clone(),
            format!("{} of {} slices", body.slices.len() - open, body.slices.len()),
        ),
    });
    let output = &options.output;
    match (picture, stopped) {
        (Some(kind), stopped) if WRITES && open < body.slices.len() => {
            context.budget.enter(|| draw(&answer, kind, options, axes, context))??;
            Ok(stopped.map_or(Status::Holds, |stopped| context.say_undecided(&stopped)))
        }
        (Some(_), Some(stopped)) => Ok(context.say_undecided(&stopped)),
        (_, Some(stopped)) => context.undecided(output, &stopped, || Some(answer.text(digits)), || answer.json(digits)),
        (_, None) => {
            context.answer(output, || answer.text(digits), || answer.json(digits))?;
            Ok(Status::Holds)
        }
    }
}

/// Slices are exact, and of stability alone.
fn fits(options: &Options) -> Result<(), Error> {
    if options.method.method == MethodName::Boxes {
        let error = Diagnostic::error(Code::Usage, "the slices of '-z' are exact maps, and boxes are asked for");
        let help = "leave out '--method boxes', or '-z' and give its parameter one value with '--set'";
        return Err(error.help(help).into());
    }
    if let (Some(option), Some(refusal)) = (options.require.first(), Asked::SlicesWithRequirements.never()) {
        return Err(refusal.diagnostic(&[("option", &option)]).into());
    }
    Ok(())
}

/// What is wrong with the slices, with its place in the command line.
fn pointed(error: Error, request: &SlicesRequest, axes: &[AxisRequest; 2], context: &Context) -> Error {
    let Error::Refused(refused) = &error else { return error };
    let at =
        |span: Span, label: &str| in_line(context.line, vec![refused.diagnostics()[0].clone().at(span, label)]).into();
    match refused.code() {
        Code::Usage => {
            let third = axes.iter().any(|axis| axis.name == request.values.name());
            at(if third { request.name_span } else { axes[1].name_span }, "asked for a second time")
        }
        // What points into the model says where it is.
        Code::Function | Code::DeadTime if refused.diagnostics()[0].primary.is_none() => {
            at(request.range_span, "slices are asked for here")
        }
        Code::Value => at(request.range_span, "not inside the domain"),
        _ => error,
    }
}

/// Draws the picture to the file.
fn draw(
    answer: &Answer<Body>,
    kind: Picture,
    options: &Options,
    axes: &[AxisRequest; 2],
    context: &Context,
) -> Result<(), Error> {
    let Some(file) = &options.output.output else { return Ok(()) };
    let maps: Vec<_> = answer.value().slices.iter().map(|slice| slice.map.as_ref().ok()).collect();
    let known: Vec<_> = maps.iter().copied().flatten().collect();
    let windows = common_windows(&known, &[], &windows(options, axes));
    let traces: Vec<Option<MapTrace>> = maps
        .iter()
        .map(|map| map.map(|map| trace_map(map, windows.clone(), &context.budget)).transpose())
        .collect::<Result<_, _>>()?;
    let contents = |(map, trace)| MapContents::new(map, trace, Vec::new(), &context.budget);
    let contents: Vec<Option<MapContents<'_>>> = maps
        .iter()
        .zip(&traces)
        .map(|(map, trace)| map.zip(trace.as_ref()).map(contents).transpose())
        .collect::<Result<_, _>>()?;
    let picture = || small_multiples(answer, &contents);
    let bytes = match kind {
        Picture::Svg => picture().svg().into_bytes(),
        Picture::Png => png(&picture())?,
        Picture::Pdf => pdf(&picture())?,
        Picture::Page => {
            let digits = options.output.digits() as usize;
            body_page(answer, &contents, [WIDE, NARROW], digits, &context.budget)?.into_bytes()
        }
    };
    context.reporter.finish();
    write(Path::new(file), &bytes)
}
