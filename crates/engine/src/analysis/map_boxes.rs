//! The stable region in two parameters by boxes, and the choice between that and the exact decomposition.

use super::map::map_question;
use super::{Decision, Failure, Map, Settings};
use crate::error::Diagnostic;
use crate::model::Loop;
use crate::stability::Range;
use crate::stability::plane::boxes::{BoxMap, Window, stability_boxes};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// The part of the time that boxes may take, so that some is left to write them.
const SUBDIVISION: (u32, u32) = (9, 10);

/// How a map is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum MapMethod {
    /// The exact decomposition of the whole domain.
    Exact,
    /// Boxes of a window, proved stable, proved unstable or left undecided.
    Boxes,
    /// The exact decomposition; boxes when it is not finished after half of a limited time and the
    /// window is bounded.
    #[default]
    Auto,
}

/// What the boxes are to cover, and how well.
#[derive(Clone, Debug)]
pub struct BoxRequest {
    /// Of either parameter; the domain is the window where an end is left out.
    pub windows: [Range; 2],
    /// The share of the window's area that may stay undecided.
    pub undecided: Rational,
}

/// A window of two parameters cut into boxes.
#[derive(Clone, Debug)]
pub struct MapBoxes {
    /// The question; its exact decomposition is not decided.
    pub question: Map,
    /// The share of the window's area that was allowed to stay undecided.
    pub goal: Rational,
    /// The boxes; undecided when not even the boundary polynomials were found in time.
    pub boxes: Decision<BoxMap>,
}

/// A map by either method.
#[derive(Clone, Debug)]
pub enum MapAnswer {
    /// The exact decomposition, or that it is undecided.
    Exact(Box<Map>),
    /// Boxes.
    Boxes(Box<MapBoxes>),
}

/// The stable region in the plane of two parameters by a method of choice.
///
/// # Errors
/// [`Failure`] when the question is refused, among others for boxes of a window that is not bounded.
pub fn map_by(
    lp: &Loop,
    settings: &Settings,
    names: [&str; 2],
    method: MapMethod,
    request: &BoxRequest,
    budget: &Budget,
) -> Result<MapAnswer, Failure> {
    let (mut question, exhausted) = map_question(lp, settings, names, budget)?;
    let window = window_of(&question, request);
    if let Some(exhausted) = exhausted {
        question.map = Decision::from_result(Err(exhausted), budget);
        return Ok(MapAnswer::Exact(Box::new(question)));
    }
    let window = match (method, window) {
        (MapMethod::Boxes, Err(refusal)) => return Err(refusal),
        (MapMethod::Exact, _) | (MapMethod::Auto, Err(_)) => None,
        (_, Ok(window)) => Some(window),
    };
    if method != MapMethod::Boxes {
        let part = if window.is_some() { budget.share(1, 2) } else { budget.clone() };
        question.map = question.decomposed(&part);
    }
    match (window, &question.map, &question.polynomial) {
        (Some(window), Decision::Undecided { .. }, Some(p)) => {
            let boxes = stability_boxes(
                p,
                &window,
                question.region,
                &request.undecided,
                &budget.share(SUBDIVISION.0, SUBDIVISION.1),
            );
            let boxes = Decision::from_result(boxes, budget);
            Ok(MapAnswer::Boxes(Box::new(MapBoxes { question, goal: request.undecided.clone(), boxes })))
        }
        (Some(_), Decision::Undecided { .. }, None) => {
            // Undefined everywhere: that needs no boxes.
            question.map = question.decomposed(budget);
            Ok(MapAnswer::Exact(Box::new(question)))
        }
        _ => Ok(MapAnswer::Exact(Box::new(question))),
    }
}

/// The part of the domain that the boxes are to cover.
fn window_of(question: &Map, request: &BoxRequest) -> Result<Window, Failure> {
    let side = |k: usize| {
        let (domain, wanted) = (&question.axes[k].domain, &request.windows[k]);
        let lower = wanted.lower.clone().max(domain.lower.clone());
        let upper = match (&wanted.upper, &domain.upper) {
            (Some(a), Some(b)) => Some(a.min(b).clone()),
            (a, b) => a.clone().or_else(|| b.clone()),
        };
        Range::between(lower, upper)
    };
    let sides = [side(0), side(1)];
    for (range, axis) in sides.iter().zip(&question.axes) {
        if range.lower.is_none() || range.upper.is_none() {
            return Err(Diagnostic::error("E-usage", format!("boxes need a window of '{}' with two ends", axis.name))
                .help(format!("say which values are to be covered, such as '-x {}=0..1'", axis.name))
                .into());
        }
        if range.is_empty() {
            return Err(Diagnostic::error(
                "E-empty-domain",
                format!("the window of '{}' is outside its domain", axis.name),
            )
            .help("boxes cover the part of the window that is in the domain")
            .into());
        }
    }
    Ok(Window::new(&sides[0], &sides[1]).expect("both sides are bounded and not empty"))
}
