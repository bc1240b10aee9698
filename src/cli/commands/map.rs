//! `jurist map`: the stable region in two parameters.

use super::map_body;
use super::map_boxes::{self, MethodOptions};
use super::{Context, Runs, decided};
use crate::certified::certify_boxes;
use crate::cli::arguments::{ExplainOptions, ModelOptions, OutputOptions, RegionOptions};
use crate::cli::assignments::{AxisRequest, axis, in_line};
use crate::cli::destinations::Files;
use crate::cli::input::{known_name, load, question};
use crate::cli::output::{ending, note, unknown_ending, write_answer};
use crate::cli::picture::{WRITES, pdf, png, write};
use crate::cli::requirements::RequirementOptions;
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::{certified, certify, check_certificate};
use clap::Args;
use jurist_algebra::limits::Exhausted;
use jurist_draw::figures::map::{MapContents, WindowRequest, choose_windows, trace_map};
use jurist_draw::page::map_page;
#[cfg(feature = "cli")]
use jurist_drive::published_limits;
use jurist_engine::answer::{Answer, BoxRequest, Map, MapBoxes, MapMethod, MapOrBoxes};
use jurist_engine::coverage::Asked;
use jurist_engine::error::{Code, Diagnostic, Error as EngineError};
use jurist_engine::model::{Model, Time};
use jurist_engine::problem::{DECAY, Problem, Question, RADIUS};
use jurist_engine::response::{AllOf, MapForAll, Requirement, Requirements};
use jurist_prove::Certificate;
use jurist_show::{Document, Text};
use jurist_show::{documents, map_boxes_text, map_text};
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;

/// Digits to which places and frequencies are enclosed, at least and at most.
pub(super) const LIMIT_DIGITS: (usize, usize) = (10, 20);

/// The part of what is left of the time that a certificate of boxes may take, so that some is left to check it.
const CERTIFICATE: (u32, u32) = (1, 2);

/// Width and height of the picture, and of the one that a page shows on a telephone.
pub(super) const WIDE: (f64, f64) = (860.0, 600.0);
pub(super) const NARROW: (f64, f64) = (400.0, 470.0);

/// Options of `jurist map`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The first parameter: a parameter, a constant given as a number, 'radius' or 'decay'; with the picture's window
    #[arg(short = 'x', value_name = "NAME[=LO..HI]", allow_hyphen_values = true)]
    pub x: String,
    /// The second parameter
    #[arg(short = 'y', value_name = "NAME[=LO..HI]", allow_hyphen_values = true)]
    pub y: String,
    /// A third parameter: the map at each of N values from LO to HI, both included
    #[arg(short = 'z', value_name = "NAME=LO..HI:N", allow_hyphen_values = true)]
    pub z: Option<String>,
    /// The points that are good for all values of another name in a range, both ends included; by boxes (can be given again)
    #[arg(long = "for-all", value_name = "NAME=LO..HI", conflicts_with = "z")]
    pub for_all: Vec<String>,
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
    /// Writes a certificate of the map that 'jurist verify' re-checks; of boxes as many as it can see
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
    #[command(flatten)]
    pub method: MethodOptions,
    #[command(flatten)]
    pub require: RequirementOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub explain: ExplainOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// What is written where a picture is asked for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Picture {
    Svg,
    Png,
    Pdf,
    Page,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let picture = picture_of(self)?;
        let axes = [("-x", &self.x), ("-y", &self.y)];
        let [x, y] = axes.map(|(option, text)| axis(context.line, option, text));
        let requests = [x?, y?];
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        let mut question = question(context, &model, &self.model, &self.region)?;
        for request in &requests {
            if ![RADIUS, DECAY].contains(&request.name.as_str()) {
                known_name(context, &model, &request.name, request.name_span)?;
            }
            question = question.free(&request.name);
        }
        if let Some(z) = &self.z {
            return map_body::run(z, self, &requests, picture, (&model, question), context);
        }
        let all = ranges(&self.for_all, &requests.each_ref().map(|axis| axis.name.as_str()), &model, context)?;
        let free = freed(&question, all.iter().map(|all| &all.name));
        let asked = self.require.asked_each(&model, free, &self.region, context)?.0;
        let question = asked.region.clone().into_iter().fold(question, Question::within);
        let boxes = self.method.request(&requests, context)?;
        if !all.is_empty() {
            let asked = MapForAll::new(all).with_requirements(asked.list, asked.at);
            let found = match map_boxes::for_all(&asked, question, (&boxes, self.method.method()), context)? {
                Ok(found) => found,
                Err(stopped) => return Ok(context.say_undecided(&stopped)),
            };
            return of_boxes(&found, self, &model, context);
        }
        let mut method = self.method.method();
        let problem = question.plane_problem()?;
        if self.certificate.is_some() {
            method = self.method.method_certified(&problem, &asked, &context.budget)?;
        }
        context.explain(&self.explain, &self.output, &problem, asked_by(method, &asked.list, problem.time()))?;
        let digits = self.output.digits() as usize;
        let places = digits.clamp(LIMIT_DIGITS.0, LIMIT_DIGITS.1);
        let answer = match decided(required(&problem, method, &boxes, places, &asked, context))? {
            Ok(MapOrBoxes::Exact(answer)) => *answer,
            Ok(MapOrBoxes::Boxes(found)) => {
                context.warn(None, problem.warnings());
                if let Some(line) = map_boxes::window_note(&found, &boxes) {
                    note(&line);
                }
                return of_boxes(&found, self, &model, context);
            }
            Err(stopped) => {
                let is_by_boxes = problem.ends_in_boxes(method, &boxes);
                let status = undecided(&problem, &stopped, (picture, is_by_boxes), self, context)?;
                // Boxes decide no requirements.
                let boxes_may_help = self.certificate.is_none() && asked.is_empty();
                if let Some(hint) = self.method.hint(&boxes).filter(|_| boxes_may_help) {
                    note(&hint);
                }
                return Ok(status);
            }
        };
        of_exact_map(&answer, (picture, &requests), self, &model, context)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model.model, &self.output.output);
        files.outputs.extend(self.certificate.iter().map(|file| ("the certificate", file.clone())));
        Ok(())
    }
}

/// The values of other names for all of which something is asked.
pub(super) fn ranges(texts: &[String], free: &[&str], model: &Model, context: &Context) -> Result<Vec<AllOf>, Error> {
    let mut all: Vec<AllOf> = Vec::new();
    for text in texts {
        let request = axis(context.line, "--for-all", text)?;
        known_name(context, model, &request.name, request.name_span)?;
        let wrong = |message: String, label: &str| {
            let error = Diagnostic::error(Code::OptionValue, message).at(request.name_span, label);
            in_line(context.line, vec![error.help("for example '--for-all L=0..5e-3', both ends included")])
        };
        if all.iter().any(|known| known.name == request.name) {
            return Err(wrong(format!("'{}' is given two ranges", request.name), "a second range").into());
        }
        if free.contains(&request.name.as_str()) {
            return Err(wrong(format!("'{}' is what is asked about", request.name), "another name has a range").into());
        }
        let (Some(least), Some(greatest)) = (&request.lower, &request.upper) else {
            return Err(wrong("'--for-all' expects NAME=LO..HI".to_owned(), "its range needs two ends").into());
        };
        all.extend(AllOf::new(&request.name, least.clone(), greatest.clone()));
    }
    Ok(all)
}

/// A question in which these names are free: what is required may not depend on a name whose values are all of a range.
pub(super) fn freed<'a>(question: &Question, names: impl IntoIterator<Item = &'a String>) -> Question {
    names.into_iter().fold(question.clone(), |question, name| question.without_value(name).free(name))
}

/// How a map is asked for.
fn asked_by(method: MapMethod, requirements: &[Requirement], time: Time) -> Asked {
    match method {
        MapMethod::Boxes if requirements.is_empty() => Asked::BoxMap,
        MapMethod::Boxes => Asked::BoxMapWithRequirements,
        MapMethod::Exact if requirements.is_empty() => Asked::ExactMap,
        _ => requirements.iter().fold(Asked::Map, |question, r| question.with_requirement(r, time)),
    }
}

/// What is known of a map that the budget did not allow.
fn undecided(
    problem: &Arc<Problem>,
    stopped: &Exhausted,
    (picture, is_by_boxes): (Option<Picture>, bool),
    options: &Options,
    context: &Context,
) -> Outcome {
    let (output, digits) = (&options.output, options.output.digits() as usize);
    match (picture, is_by_boxes) {
        // There is nothing to draw.
        (Some(_), _) => Ok(context.say_undecided(stopped)),
        (None, true) => {
            let text = || Some(map_boxes_text(problem, Err(stopped), digits));
            context.undecided(output, stopped, text, || documents::MapBoxes::new(problem, Err(stopped)))
        }
        (None, false) => {
            let text = || Some(map_text(problem, Err(stopped), digits));
            context.undecided(output, stopped, text, || documents::Map::new(problem, Err(stopped), digits))
        }
    }
}

/// An exact map: drawn, or its regions and limits.
fn of_exact_map(
    answer: &Answer<Map>,
    (picture, requests): (Option<Picture>, &[AxisRequest; 2]),
    options: &Options,
    model: &Model,
    context: &Context,
) -> Outcome {
    let digits = options.output.digits() as usize;
    context.warn(None, answer.problem().warnings());
    if let Err(stopped) = &answer.value().limits {
        note(&format!("the regions are decided, what limits them is not: {stopped}"));
    }
    match picture {
        Some(kind) if WRITES => {
            let windows = windows(options, requests);
            context.budget.enter(|| draw(answer, kind, windows, options, context))??;
        }
        _ => context.answer(&options.output, || answer.text(digits), || answer.json(digits))?,
    }
    let (run, text) = (&options.output.run, &model.source().text);
    certify(context, run, text, &options.certificate, || answer.certificate(&context.budget))?;
    Ok(Status::Holds)
}

/// The answer by boxes, with a certificate where a file for it is asked for.
fn of_boxes(found: &Answer<MapBoxes>, options: &Options, model: &Model, context: &Context) -> Outcome {
    let make = || certify_boxes(found, &context.budget.share(CERTIFICATE.0, CERTIFICATE.1));
    let certificate = certified(context, &options.certificate, make);
    if let Ok(Some((certified, file))) = &certificate {
        write_answer(&certified.text, Some(file))?;
        note(&map_boxes::shares(certified));
    }
    let status = map_boxes::answer(found, &options.output, context)?;
    if let Some((certified, file)) = &certificate? {
        check_certificate(context, &options.output.run, &model.source().text, &certified.text, file);
    }
    Ok(status)
}

/// The map, with the regions in which requirements are met.
fn required(
    problem: &Arc<Problem>,
    method: MapMethod,
    boxes: &BoxRequest,
    digits: usize,
    asked: &Requirements,
    context: &Context,
) -> Result<MapOrBoxes, EngineError> {
    if !asked.list.is_empty() {
        // That is said before the map is made.
        let ring = problem.map_ring(&context.budget)?;
        for requirement in &asked.list {
            let coverage = Asked::Map.with_requirement(requirement, problem.time()).over(ring);
            // What is answered in part is asked.
            match coverage.refusal().filter(|_| coverage.method().is_none()) {
                Some(refusal) if refusal.is_complete() => return Err(refusal.diagnostic(&[]).into()),
                // What a loop is asked depends on its ring.
                Some(refusal) if refusal.help.contains("{known}") => drop(problem.algebra(&context.budget)?),
                _ => {}
            }
        }
    }
    let required = (asked.list.as_slice(), asked.at.as_deref());
    problem.required_map_by((method, boxes), required, digits, &context.budget)
}

/// The kind of picture that the output file's ending asks for, if it asks for one.
fn picture_of(options: &Options) -> Result<Option<Picture>, Error> {
    let Some(file) = options.output.output.as_ref().filter(|f| *f != "-" && !options.output.json) else {
        return Ok(None);
    };
    match ending(file).as_deref() {
        Some("svg") if WRITES => Ok(Some(Picture::Svg)),
        Some("png") if WRITES => Ok(Some(Picture::Png)),
        Some("pdf") if WRITES => Ok(Some(Picture::Pdf)),
        Some("html" | "htm") if WRITES => Ok(Some(Picture::Page)),
        Some("txt" | "json") | None => Ok(None),
        Some(_) => Err(unknown_ending(file, &["txt", "json", "svg", "png", "pdf", "html"]).into()),
    }
}

pub(super) fn windows(options: &Options, requests: &[AxisRequest; 2]) -> [WindowRequest; 2] {
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

/// Draws the picture to the file.
fn draw(
    answer: &Answer<Map>,
    kind: Picture,
    requests: [WindowRequest; 2],
    options: &Options,
    context: &Context,
) -> Result<(), Error> {
    let Some(file) = &options.output.output else { return Ok(()) };
    let built_in = options.model.model.is_none();
    let published = if built_in { published_limits(answer.problem()) } else { Vec::new() };
    let windows = choose_windows(answer, &published, &requests);
    let trace = trace_map(answer, windows, &context.budget)?;
    let contents = MapContents::new(answer, &trace, published, &context.budget)?;
    let wide = contents.draw(WIDE.0, WIDE.1, kind != Picture::Page);
    let bytes = match kind {
        Picture::Svg => wide.figure.svg().into_bytes(),
        Picture::Png => png(&wide.figure)?,
        Picture::Pdf => pdf(&wide.figure)?,
        Picture::Page => {
            let narrow = contents.draw(NARROW.0, NARROW.1, false);
            let text = answer.text(options.output.digits() as usize);
            map_page(answer, &contents, &[wide, narrow], &text, &context.budget)?.into_bytes()
        }
    };
    context.reporter.finish();
    write(Path::new(file), &bytes)
}

/// Without the study of the drive there is nothing to compare with.
#[cfg(not(feature = "cli"))]
fn published_limits(_: &Problem) -> Vec<(f64, f64)> {
    Vec::new()
}
