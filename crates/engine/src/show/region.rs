//! The boundary of the region asked for, by its true points.
//!
//! A radius or decay rate is put into the polynomial, so that the engine always sees the unit circle or the
//! imaginary axis and names causes after these. People are told where the roots of their own loop are.

use super::layout::short;
use crate::analysis::{DECAY, Map, OneParameter, RADIUS};
use crate::model::Time;
use crate::stability::{Cause, Causes};
use jurist_algebra::number::Rational;

/// How a region's number is written.
type Write = fn(&Rational) -> String;

/// `R` of `|z| < R`, or `-S` of `Re s < -S`; `None` for the unit disc and the left half plane.
fn edge(question: &OneParameter, write: Write) -> Option<String> {
    match (question.time, &question.radius, &question.decay) {
        (Time::Discrete, Some(r), _) => Some(write(r)),
        (Time::Continuous, _, Some(s)) => Some(write(&-s)),
        (Time::Discrete, None, _) if question.parameter == RADIUS => Some(RADIUS.to_owned()),
        (Time::Continuous, _, None) if question.parameter == DECAY => Some(format!("-{DECAY}")),
        _ => None,
    }
}

/// `all |z| < 0.9`, `all Re s < -2`; `None` where no smaller region is asked for.
pub fn goal(question: &OneParameter) -> Option<String> {
    let edge = edge(question, short)?;
    Some(match question.time {
        Time::Discrete => format!("all |z| < {edge}"),
        Time::Continuous => format!("all Re s < {edge}"),
    })
}

/// The goal of a question at a point.
pub fn point_goal(radius: Option<&Rational>, decay: Option<&Rational>) -> Option<String> {
    let radius = radius.map(|r| format!("all |z| < {}", short(r)));
    radius.or_else(|| decay.map(|s| format!("all Re s < {}", short(&-s))))
}

/// The causes with the points where the loop's own roots are: `z=0.9` and not `z=1` for `--radius 0.9`.
pub fn causes_text(causes: &Causes, question: &OneParameter) -> String {
    named(causes, question, short)
}

/// The same with exact numbers; `None` where the names of the causes are the true points.
pub fn exact_boundary(causes: &Causes, question: &OneParameter) -> Option<String> {
    edge(question, Rational::to_string)?;
    Some(named(causes, question, Rational::to_string))
}

fn named(causes: &Causes, question: &OneParameter, write: Write) -> String {
    let Some(edge) = edge(question, write) else { return causes.to_string() };
    named_at(causes, question.time, &edge)
}

/// What a map asks of its points: `stable`, or what a radius or a decay rate asks for.
pub fn map_goal(answer: &Map) -> String {
    point_goal(answer.radius.as_ref(), answer.decay.as_ref()).unwrap_or_else(|| "stable".to_owned())
}

/// The radius of the disc, or the real part of the line, that bounds the region of a map.
pub fn map_edge(answer: &Map) -> Option<String> {
    answer.radius.as_ref().map(short).or_else(|| answer.decay.as_ref().map(|s| short(&-s)))
}

/// [`causes_text`] of a map.
pub fn map_causes_text(causes: &Causes, answer: &Map) -> String {
    map_edge(answer).map_or_else(|| causes.to_string(), |edge| named_at(causes, answer.time, &edge))
}

fn named_at(causes: &Causes, time: Time, edge: &str) -> String {
    let name = |cause| match (cause, time) {
        (Cause::RootAtOne, _) => format!("z={edge}"),
        (Cause::RootAtMinusOne, _) => format!("z=-{edge}"),
        (Cause::RootAtZero, _) => format!("s={edge}"),
        (Cause::ComplexPair, Time::Discrete) => format!("{cause} on |z|={edge}"),
        (Cause::ComplexPair, Time::Continuous) => format!("{cause} on Re s={edge}"),
        (Cause::DegreeLost | Cause::Pole | Cause::Domain, _) => cause.to_string(),
    };
    causes.iter().map(name).collect::<Vec<_>>().join("+")
}
