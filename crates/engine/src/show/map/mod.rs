//! The stable region in two parameters, for people.

mod body;
mod boxes;
mod required;
mod text;

pub use boxes::map_boxes_text;
pub use text::map_text;

use crate::problem::Free;
use crate::stability::plane::{Curve, StabilityMap};
use crate::stability::{Cause, Causes};
use jurist_algebra::poly::RealAlgebraic;

/// The name of a wall between strips that is no end of the domain and no part of a curve: branches meet,
/// end or run to infinity there.
const CRITICAL_POINT: &str = "critical point";

/// Why a strip ends at a value of `x`: the domain, lines that are parts of curves, or a critical point.
pub(super) fn wall_cause(map: &StabilityMap, axis: &Free, value: &RealAlgebraic) -> String {
    let mut causes = Causes::default();
    for cause in map.curves.iter().filter(|c| contains_line(c, value)).flat_map(|c| c.causes.iter()) {
        causes.insert(cause);
    }
    let exact = value.exact();
    if exact.is_some() && (exact == axis.domain.lower || exact == axis.domain.upper) {
        causes.insert(Cause::Domain);
    }
    if causes.iter().next().is_none() { CRITICAL_POINT.to_owned() } else { causes.to_string() }
}

/// Whether a curve is the line at a value of `x`, or several lines of which it is one.
fn contains_line(curve: &Curve, value: &RealAlgebraic) -> bool {
    curve.polynomial.degree_in(1) == 0
        && curve.polynomial.to_univariate(0).is_some_and(|line| value.sign_of(&line).is_eq())
}
