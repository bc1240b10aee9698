//! What is seen of all points of a box.

use super::family::Family;
use super::parts::{corners, middle};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;

/// So many corners of a box are looked at before a proof is tried.
pub(super) const MOST_CORNERS: usize = 16;

/// What is seen of the points of a box, but for a set without volume.
///
/// ```
/// use jurist_stability::boxes::BoxLook;
/// assert_ne!(BoxLook::Stable, BoxLook::Open(0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxLook {
    /// Every point is stable.
    Stable,
    /// No point is.
    Unstable,
    /// Neither is seen; halves along this side may show more.
    Open(usize),
}

/// Whether all points of a box are stable, or none is, where no root crosses in it; `is_stable` tells it of the middle. `None` where that is not seen
/// with so many cells of frequency and parameters.
///
/// Cost: a count at the middle and at some corners, and that of the proof.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn same_count(
    family: &impl Family,
    sides: &[[Rational; 2]],
    (cells, budget): (usize, &Budget),
    is_stable: impl FnOnce(&[Rational]) -> Result<Option<bool>, Exhausted>,
) -> Result<Option<bool>, Exhausted> {
    let middle = middle(sides);
    let Some((signs, scale)) = budget.enter(|| family.signs_at(&middle))? else { return Ok(None) };
    let differs = || {
        let is_stable = family.is_stable_at(&middle);
        corners(sides).take(MOST_CORNERS).any(|corner| family.is_stable_at(&corner) != is_stable)
    };
    // Where a boundary is in the box, a corner often tells at once.
    if budget.enter(differs)? {
        return Ok(None);
    }
    if !budget.enter(|| family.has_no_crossing(sides, (&signs, scale), cells, budget))?? {
        return Ok(None);
    }
    is_stable(&middle)
}
