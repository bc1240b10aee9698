//! Whether a family of loops is stable at all points of a box, or at none, where no root crosses in it.

use super::requirement_boxes::OverPoints;
use crate::stability::boxes::{Family, corners};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;

/// So many corners of a box are looked at before a proof is tried.
const MOST_CORNERS: usize = 16;

/// Whether all points of a box are stable, or none is, where no root crosses in it; `is_stable` tells it of the middle. More cells of frequency and
/// parameters are not looked at.
///
/// # Errors
/// When the budget runs out.
pub(super) fn same_count(
    family: &impl Family,
    sides: &[[Rational; 2]],
    (cells, budget): (usize, &Budget),
    is_stable: impl FnOnce(&[Rational]) -> Result<Option<bool>, Exhausted>,
) -> Result<OverPoints, Exhausted> {
    let open = OverPoints::Open { middle: None };
    let middle: Vec<Rational> = sides.iter().map(|[low, high]| low.midpoint(high)).collect();
    let Some((signs, scale)) = budget.enter(|| family.signs_at(&middle))? else { return Ok(open) };
    let differs = || {
        let is_stable = family.is_stable_at(&middle);
        corners(sides).take(MOST_CORNERS).any(|corner| family.is_stable_at(&corner) != is_stable)
    };
    // Where a boundary is in the box, a corner often tells at once.
    if budget.enter(differs)? {
        return Ok(open);
    }
    if !budget.enter(|| family.has_no_crossing(sides, (&signs, scale), cells, budget))?? {
        return Ok(open);
    }
    Ok(match is_stable(&middle)? {
        Some(true) => OverPoints::All,
        Some(false) => OverPoints::None,
        None => open,
    })
}
