//! What is seen of all points of a box of a loop with dead time.

use super::delayed::DelayedFunction;
use super::delayed_prove::range_of;
use super::look::{BoxLook, MOST_CORNERS, same_count};
use super::moving_look::Everywhere;
use super::parts::{corners, middle};
use crate::AtPoint;
use crate::plane::boxes::{BoxMap, BoxVerdict, Seen, Window, subdivided};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// Parts of frequency and parameters after which a box is rather halved.
const PARTS: usize = 24;

impl DelayedFunction {
    /// Whether all points of a box are stable, or none is, or along which side to halve it.
    pub(super) fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<BoxLook, Exhausted> {
        Ok(match self.everywhere(sides, budget)? {
            Some(Everywhere::Outside(0)) => BoxLook::Stable,
            Some(_) => BoxLook::Unstable,
            None => {
                let side = self.side_without_meaning(sides).unwrap_or_else(|| self.steepest_side_approximate(sides));
                BoxLook::Open(side)
            }
        })
    }

    /// What is the same at all points of a box, but for a set without volume; `None` where that is not seen.
    ///
    /// Cost: counts at the middle and some corners; where they are the same, parts of frequency and parameters.
    fn everywhere(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<Option<Everywhere>, Exhausted> {
        if budget.enter(|| self.has_no_meaning_in(sides))? {
            return Ok(Some(Everywhere::Meaningless));
        }
        let is_same = || {
            let own = self.right_of_axis(&middle(sides))?;
            let mut corners = corners(sides).take(MOST_CORNERS);
            corners.all(|corner| self.right_of_axis(&corner) == Some(own)).then_some(own)
        };
        // Further roots cross where a loop is not stable: a proof that they do not takes long to fail.
        let Some(own) = budget.enter(is_same)? else { return Ok(None) };
        let is_seen = same_count(self, sides, (PARTS, budget), |_| Ok(Some(true)))?;
        Ok(is_seen.map(|_| Everywhere::Outside(own)))
    }

    /// Cuts a window of the first two parameters into boxes until the share of the undecided area is at most `goal` (0 to 1); the others are
    /// constants between these bounds.
    ///
    /// Cost: a look at each box.
    pub fn boxes(&self, window: &Window, constants: &[[Rational; 2]], goal: &Rational, budget: &Budget) -> BoxMap {
        subdivided(window, goal, budget, |place, _: Option<&()>| {
            let Window { x, y } = place.window(window);
            let sides: Vec<[Rational; 2]> = [x, y].into_iter().chain(constants.iter().cloned()).collect();
            let seen = match self.everywhere(&sides, budget)? {
                Some(Everywhere::Outside(0)) => Seen::Decided(BoxVerdict::Stable),
                Some(Everywhere::Outside(outside)) => Seen::Decided(BoxVerdict::Unstable { outside: Some(outside) }),
                Some(Everywhere::Meaningless) => Seen::Decided(BoxVerdict::Unstable { outside: None }),
                None => Seen::Cut(place.wider()),
            };
            Ok((seen, None))
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
