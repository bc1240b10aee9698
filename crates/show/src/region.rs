//! The boundary of the region asked for, by its true points.
//!
//! A radius or decay rate is put into the polynomial, so that the engine always sees the unit circle or the
//! imaginary axis and names causes after these. People are told where the roots of their own loop are.

use super::layout::short;
use jurist_algebra::number::Rational;
use jurist_engine::model::Time;
use jurist_engine::problem::{Bound, DECAY, Problem, RADIUS, Region};
use jurist_engine::stability::{Cause, Causes};

/// How a region's number is written.
type Write = fn(&Rational) -> String;

/// `R` of `|z| < R`, or `-S` of `Re s < -S`; `None` for the unit disc and the left half plane.
fn edge(problem: &Problem, write: Write) -> Option<String> {
    match problem.region() {
        Region::Disc(Bound::Free) => Some(RADIUS.to_owned()),
        Region::HalfPlane(Bound::Free) => Some(format!("-{DECAY}")),
        region => region.radius().map(write).or_else(|| region.decay().map(|s| write(&-s))),
    }
}

/// `all |z| < 0.9`, `all Re s < -2`; `None` where no smaller region is asked for.
pub fn goal(problem: &Problem) -> Option<String> {
    let edge = edge(problem, short)?;
    Some(match problem.time() {
        Time::Discrete => format!("all |z| < {edge}"),
        Time::Continuous => format!("all Re s < {edge}"),
    })
}

/// The causes with the points where the loop's own roots are: `z=0.9` and not `z=1` for `--radius 0.9`.
pub fn causes_text(causes: &Causes, problem: &Problem) -> String {
    named(causes, problem, short)
}

/// The same with exact numbers; `None` where the names of the causes are the true points.
pub fn exact_boundary(causes: &Causes, problem: &Problem) -> Option<String> {
    edge(problem, Rational::to_string)?;
    Some(named(causes, problem, Rational::to_string))
}

fn named(causes: &Causes, problem: &Problem, write: Write) -> String {
    let Some(edge) = edge(problem, write) else { return causes.to_string() };
    named_at(causes, problem.time(), &edge)
}

/// What is asked of a point: `stable`, or what a radius or a decay rate asks for.
pub fn goal_or_stable(problem: &Problem) -> String {
    goal(problem).unwrap_or_else(|| "stable".to_owned())
}

/// The radius of the disc, or the real part of the line, that bounds a region smaller than that of plain stability.
pub fn boundary_point(problem: &Problem) -> Option<String> {
    edge(problem, short)
}

fn named_at(causes: &Causes, time: Time, edge: &str) -> String {
    let name = |cause| match (cause, time) {
        (Cause::RootAtOne, _) => format!("z={edge}"),
        (Cause::RootAtMinusOne, _) => format!("z=-{edge}"),
        (Cause::RootAtZero, _) => format!("s={edge}"),
        (Cause::ComplexPair | Cause::ComplexRoot, Time::Discrete) => format!("{cause} on |z|={edge}"),
        (Cause::ComplexPair | Cause::ComplexRoot, Time::Continuous) => format!("{cause} on Re s={edge}"),
        (
            Cause::DegreeLost
            | Cause::Neutral
            | Cause::Pole
            | Cause::SquareRoot
            | Cause::Duty
            | Cause::Domain
            | Cause::Undecided,
            _,
        ) => cause.to_string(),
    };
    causes.iter().map(name).collect::<Vec<_>>().join("+")
}
