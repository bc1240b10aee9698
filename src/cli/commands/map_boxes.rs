//! Options of `jurist map` that choose the method, and its answer by boxes.

use super::{Context, decided};
use crate::certified::{CertifiedBoxes, judge, refuse_required};
use crate::cli::arguments::OutputOptions;
use crate::cli::assignments::{AxisRequest, in_line, plain_number};
use crate::cli::output::ending;
use crate::cli::picture::{WRITES, pdf, png, write};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::percent_below;
use clap::{Args, ValueEnum};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::Rational;
use jurist_draw::figures::map::boxes_figure;
use jurist_draw::page::map_boxes_page;
use jurist_engine::answer::{Answer, BoxRequest, MapBoxes, MapMethod};
use jurist_engine::error::{Code, Diagnostic, Error as EngineError};
use jurist_engine::problem::{Problem, Question};
use jurist_engine::response::{MapForAll, Requirements};
use jurist_engine::stability::Range;
use jurist_engine::stability::plane::boxes::Window;
use jurist_show::{Document, Text};
use std::path::Path;

/// How the map is made.
#[derive(Args, Debug)]
pub(in crate::cli) struct MethodOptions {
    /// The exact decomposition, boxes of the window of -x and -y, or boxes after half of the --timeout
    #[arg(long, value_enum, default_value_t)]
    pub method: MethodName,
    /// The share of the window that boxes may leave undecided [default: 0.01]
    #[arg(long, value_name = "SHARE")]
    pub undecided: Option<String>,
}

/// See [`MapMethod`].
#[derive(ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::cli) enum MethodName {
    /// The exact decomposition of the whole domain
    Exact,
    /// Boxes of the window, each proved stable, proved unstable or undecided
    Boxes,
    /// The exact decomposition; boxes when half of the --timeout is over and the window is bounded
    #[default]
    Auto,
}

impl MethodOptions {
    /// The method of the analysis.
    pub fn method(&self) -> MapMethod {
        match self.method {
            MethodName::Exact => MapMethod::Exact,
            MethodName::Boxes => MapMethod::Boxes,
            MethodName::Auto => MapMethod::Auto,
        }
    }

    /// The method of a map with a certificate: boxes where the exact map has none, unless that is asked for.
    pub fn method_certified(
        &self,
        problem: &Problem,
        asked: &Requirements,
        budget: &Budget,
    ) -> Result<MapMethod, Error> {
        if !asked.list.is_empty() {
            return match self.method {
                MethodName::Exact => {
                    Err(Diagnostic::error(Code::NoCertificate, "regions that meet requirements are certified by boxes")
                        .help("leave out '--method exact'")
                        .into())
                }
                MethodName::Boxes | MethodName::Auto => {
                    refuse_required(problem, asked, budget)?;
                    Ok(MapMethod::Boxes)
                }
            };
        }
        let exact = jurist_prove::refuse_map_certificate(problem, budget);
        match (self.method, exact) {
            (MethodName::Exact, Err(refusal)) => Err(refusal),
            (MethodName::Exact, Ok(())) => Ok(MapMethod::Exact),
            (MethodName::Auto, Ok(())) => Ok(MapMethod::Auto),
            (MethodName::Boxes, _) | (MethodName::Auto, Err(EngineError::Refused(_))) => {
                // Any window will do to see whether the checkers read the model.
                let side = Range::between(Some(Rational::ZERO), Some(Rational::ONE));
                judge(problem, &Window::new(&side, &side).expect("not empty"), budget)?;
                Ok(MapMethod::Boxes)
            }
            (MethodName::Auto, Err(stopped)) => Err(stopped),
        }
    }

    /// What may help when the exact map is not finished in time.
    pub fn hint(&self, request: &BoxRequest) -> Option<String> {
        let bounded = request.windows.iter().all(|w| w.lower.is_some() && w.upper.is_some());
        (self.method == MethodName::Auto && !bounded).then(|| {
            "help: give both axes a window, '-x NAME=LO..HI -y NAME=LO..HI': boxes of it are decided where the exact map \
             takes too long"
                .to_owned()
        })
    }

    /// What boxes are to cover.
    pub fn request(&self, axes: &[AxisRequest; 2], context: &Context) -> Result<BoxRequest, Error> {
        let undecided = match &self.undecided {
            None => Rational::from(1) / Rational::from(100),
            Some(text) => {
                let share = plain_number(context.line, "--undecided", text)?;
                if !share.sign().is_gt() || share > Rational::ONE {
                    let span = context.line.option_value("--undecided", text).span;
                    let error = Diagnostic::error(Code::OptionValue, "the undecided share is not between 0 and 1")
                        .at(span, "a share of the window's area, such as 0.01");
                    return Err(in_line(context.line, vec![error]).into());
                }
                share
            }
        };
        let range = |a: &AxisRequest| Range::between(a.lower.clone(), a.upper.clone());
        Ok(BoxRequest::new([range(&axes[0]), range(&axes[1])], undecided))
    }
}

/// That nobody said what the boxes are to cover, and how to.
pub(super) fn window_note(found: &Answer<MapBoxes>, request: &BoxRequest) -> Option<String> {
    let axes = found.problem().axes().into_iter().zip(&request.windows).zip(["-x", "-y"]);
    let open = axes.filter(|((axis, wanted), _)| {
        let ends = [(&wanted.lower, &axis.domain.lower), (&wanted.upper, &axis.domain.upper)];
        ends.into_iter().any(|(wanted, domain)| wanted.is_none() && domain.is_none())
    });
    let options: Vec<String> = open.map(|((axis, _), option)| format!("{option} {}=LO..HI", axis.name)).collect();
    let text = "note: the boxes are around the nominal point; what they cover is chosen by";
    (!options.is_empty()).then(|| format!("{text} '{}'", options.join(" ")))
}

/// The map for all values of other names.
pub(super) fn for_all(
    asked: &MapForAll,
    question: Question,
    (request, method): (&BoxRequest, MapMethod),
    context: &Context,
) -> Result<Result<Answer<MapBoxes>, Exhausted>, Error> {
    if method == MapMethod::Exact {
        let error = Diagnostic::error(Code::Usage, "a map for all values of other names is made of boxes");
        return Err(error.help("leave out '--method exact'").into());
    }
    let found = decided(asked.boxes(question, request, &context.budget))?;
    if let Ok(found) = &found {
        context.warn(None, found.problem().warnings());
    }
    Ok(found)
}

/// Width and height of the picture.
const SIZE: (f64, f64) = (860.0, 600.0);

/// Writes the answer by boxes, as a picture where the output file's ending asks for one.
pub(super) fn answer(boxes: &Answer<MapBoxes>, output: &OutputOptions, context: &Context) -> Outcome {
    let digits = output.digits() as usize;
    let file = output.output.as_ref().filter(|_| !output.json);
    let kind = file.and_then(|f| ending(f)).filter(|e| ["svg", "png", "pdf", "html", "htm"].contains(&e.as_str()));
    if WRITES && let (Some(file), Some(kind)) = (file, kind) {
        let figure = boxes_figure(boxes, SIZE.0, SIZE.1);
        context.reporter.finish();
        let bytes = match kind.as_str() {
            "svg" => figure.svg().into_bytes(),
            "png" => png(&figure)?,
            "pdf" => pdf(&figure)?,
            _ => map_boxes_page(boxes, &figure, digits).into_bytes(),
        };
        write(Path::new(file), &bytes)?;
        return Ok(match boxes.value().stopped() {
            None => Status::Holds,
            Some(stop) => context.say_undecided(&stopped_at(stop)),
        });
    }
    match boxes.value().stopped() {
        None => {
            context.answer(output, || boxes.text(digits), || boxes.json(digits))?;
            Ok(Status::Holds)
        }
        Some(stop) => context.undecided(output, &stopped_at(stop), || Some(boxes.text(digits)), || boxes.json(digits)),
    }
}

/// The subdivision ended before its goal.
fn stopped_at(stop: &Stop) -> Exhausted {
    Exhausted::new(stop.clone(), "subdividing the window")
}

/// How much of the window the certificate speaks of.
pub(super) fn shares(certified: &CertifiedBoxes) -> String {
    let percent = |share: &Rational| percent_below(share, 1);
    let sum = &certified.stable + &certified.unstable;
    format!(
        "note: the certificate proves {} % of the window, {} % stable and {} % not; it says nothing of the rest",
        percent(&sum),
        percent(&certified.stable),
        percent(&certified.unstable)
    )
}
