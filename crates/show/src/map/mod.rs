//! The stable region in two parameters, for people.

mod body;
mod boxes;
mod required;
mod text;

pub use body::{body_rows, body_sentences};
pub use boxes::{for_all_text, map_boxes_text};
pub use text::map_text;
pub(super) use text::never_stable_text;

use jurist_algebra::real::Real;
use jurist_engine::problem::Free;
use jurist_engine::stability::plane::StabilityMap;
use jurist_engine::stability::{Cause, Causes};

/// The name of a wall between strips that is no end of the domain and no part of a curve: branches meet,
/// end or run to infinity there.
const CRITICAL_POINT: &str = "critical point";

/// Why a strip ends at a value of `x`: the domain, lines that are parts of curves (given by the numbers of these), or a critical
/// point.
pub(super) fn wall_cause(map: &StabilityMap, axis: &Free, value: &Real, lines: &[usize]) -> String {
    let mut causes = Causes::default();
    for cause in lines.iter().flat_map(|&k| map.curves[k].causes.iter()) {
        causes.insert(cause);
    }
    let exact = value.exact();
    if exact.is_some() && (exact == axis.domain.lower || exact == axis.domain.upper) {
        causes.insert(Cause::Domain);
    }
    if causes.iter().next().is_none() { CRITICAL_POINT.to_owned() } else { causes.to_string() }
}
