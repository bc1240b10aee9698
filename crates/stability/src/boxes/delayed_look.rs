//! What is seen of all points of a box of a loop with dead time.

use super::delayed::DelayedFunction;
use super::delayed_prove::range_of;
use super::look::{BoxLook, MOST_CORNERS, same_count};
use super::parts::{corners, middle};
use crate::AtPoint;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// Parts of frequency and parameters after which a box is rather halved.
const PARTS: usize = 24;

impl DelayedFunction {
    /// Whether all points of a box are stable, or none is, or along which side to halve it.
    ///
    /// Cost: counts at the middle and some corners; where they are the same, parts of frequency and parameters.
    pub(super) fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<BoxLook, Exhausted> {
        if budget.enter(|| self.has_no_meaning_in(sides))? {
            return Ok(BoxLook::Unstable);
        }
        let open =
            BoxLook::Open(self.side_without_meaning(sides).unwrap_or_else(|| self.steepest_side_approximate(sides)));
        let is_same = || {
            let own = self.right_of_axis(&middle(sides))?;
            let mut corners = corners(sides).take(MOST_CORNERS);
            corners.all(|corner| self.right_of_axis(&corner) == Some(own)).then_some(own)
        };
        // Further roots cross where a loop is not stable: a proof that they do not takes long to fail.
        let Some(own) = budget.enter(is_same)? else { return Ok(open) };
        Ok(match same_count(self, sides, (PARTS, budget), |_| Ok(Some(own == 0)))? {
            Some(true) => BoxLook::Stable,
            Some(false) => BoxLook::Unstable,
            None => open,
        })
    }

    /// The number of roots right of the axis at a point without a root on it; `None` where one walk along the axis does not tell.
    fn right_of_axis(&self, point: &[Rational]) -> Option<usize> {
        match self.counted_at(point)? {
            AtPoint::Delayed { on: 0, right } => right,
            _ => None,
        }
    }

    /// Whether a dead time is seen to be negative in a box, but for a set without volume.
    fn has_no_meaning_in(&self, sides: &[[Rational; 2]]) -> bool {
        self.times.iter().any(|time| {
            !time.is_zero() && Self::range_of_time(time, sides).is_some_and(|[_, most]| !most.sign().is_gt())
        })
    }

    /// The widest side of a dead time that is not seen to be positive.
    fn side_without_meaning(&self, sides: &[[Rational; 2]]) -> Option<usize> {
        let is_vague =
            |time: &&RationalFunction| Self::range_of_time(time, sides).is_none_or(|[least, _]| least.is_negative());
        let width = |i: usize| &sides[i][1] - &sides[i][0];
        let own = self.times.iter().filter(is_vague).flat_map(RationalFunction::variables);
        own.filter(|&i| !width(i).is_zero()).max_by(|&i, &j| width(i).cmp(&width(j)).then(j.cmp(&i)))
    }

    /// Numbers with the signs of bounds of a dead time; `None` where its denominator may vanish.
    fn range_of_time(time: &RationalFunction, sides: &[[Rational; 2]]) -> Option<[Rational; 2]> {
        let ([least, most], [low, high]) = (range_of(time.numerator(), sides), range_of(time.denominator(), sides));
        match (low.sign().is_gt(), high.is_negative()) {
            (true, _) => Some([least, most]),
            (_, true) => Some([-most, -least]),
            _ => None,
        }
    }

    /// The side that moves those roots most that are nearest to the axis, in floating point.
    fn steepest_side_approximate(&self, sides: &[[Rational; 2]]) -> usize {
        let middle: Vec<f64> = middle(sides).iter().map(Rational::to_f64_approximate).collect();
        let moved = self.rounded.motion_approximate(&middle, self.rounded.nearest_approximate(&middle));
        let by = |i: usize| (moved[i] * (&sides[i][1] - &sides[i][0]).to_f64_approximate()).abs();
        (0..sides.len()).max_by(|&i, &j| by(i).total_cmp(&by(j)).then(j.cmp(&i))).unwrap_or(0)
    }
}
