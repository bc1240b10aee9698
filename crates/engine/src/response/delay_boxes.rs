//! The delay margin over boxes: the loop with dead time at the cut, which is one parameter more.
//!
//! A loop has a delay margin of a time at least where it is stable with all less dead time at the cut. So a box is refuted by one dead time with which
//! no point of it is stable.

use super::opened::OpenedLoop;
use super::requirement_boxes::OverPoints;
use super::same_count::same_count;
use crate::error::Error;
use crate::model::Cut;
use crate::problem::{Problem, closed_over_dead_time};
use crate::stability::boxes::{DelayedFunction, Family};
use crate::stability::{AtPoint, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::MultiPoly;

/// Shares of the greatest dead time with which a loop may be unstable, from the longest to the shortest.
const SHARES: [(i64, i64); 12] =
    [(1, 1), (7, 8), (3, 4), (5, 8), (1, 2), (3, 8), (1, 4), (1, 8), (1, 16), (1, 32), (1, 64), (1, 128)];

/// A dead time with which a loop is unstable is made longer so much.
const LONGER: [(i64, i64); 4] = [(3, 2), (1, 1), (2, 1), (3, 1)];

/// The dead times from zero to the greatest are not cut into more parts.
const MOST_PARTS: usize = 24;

/// A least delay margin over boxes.
pub(super) struct DelayBoxes {
    /// The loop in its parameters, the dead time at the cut being the last one.
    family: DelayedFunction,
    least: Rational,
}

impl DelayBoxes {
    /// `None` in discrete time, beside functions other than dead times, and for a loop that vanishes identically.
    ///
    /// # Errors
    /// As [`OpenedLoop::of`] and [`OpenedLoop::quotient`].
    pub fn of(
        problem: &Problem,
        least: &Rational,
        cut: Cut,
        near: &[Rational],
        budget: &Budget,
    ) -> Result<Option<DelayBoxes>, Error> {
        if problem.shape() == Shape::UnitDisc {
            return Ok(None);
        }
        let opened = OpenedLoop::of(problem, cut, budget)?;
        let delays = opened.symbols.delays();
        if opened.symbols.iter().count() > delays.len() {
            return Ok(None);
        }
        let (quotient, undefined) = opened.quotient(MultiPoly::clone, budget)?;
        let usual: Vec<Rational> = near.iter().chain([least]).cloned().collect();
        let parts = [&quotient.denominator, &quotient.numerator];
        let family = budget.enter(|| closed_over_dead_time(parts, &undefined, &delays, &usual))??;
        Ok(family.map(|family| DelayBoxes { family, least: least.clone() }))
    }

    /// Whether all stable points of a closed box have the delay margin, or no point has it.
    ///
    /// Cost: that of a few dozen boxes with one parameter more.
    ///
    /// # Errors
    /// When the budget runs out.
    pub fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<OverPoints, Exhausted> {
        let with_all = self.with(sides, [self.least.clone(), self.least.clone()], budget)?;
        if with_all == OverPoints::None {
            return Ok(OverPoints::None);
        }
        let middle: Vec<Rational> = sides.iter().map(|[low, high]| low.midpoint(high)).collect();
        let times = self.times_without_stability(&middle, budget)?;
        for time in times.iter().filter(|time| **time != self.least) {
            if self.with(sides, [time.clone(), time.clone()], budget)? == OverPoints::None {
                return Ok(OverPoints::None);
            }
        }
        if !times.is_empty() {
            return Ok(OverPoints::Open { middle: Some(false) });
        }
        if with_all == OverPoints::All && self.is_stable_with_less(sides, budget)? {
            return Ok(OverPoints::All);
        }
        Ok(OverPoints::Open { middle: None })
    }

    /// Dead times up to the greatest with which a point is not stable: one that is near to the least such one, and longer ones. With a longer one further
    /// roots may cross somewhere in a box, with a shorter one the first root may.
    fn times_without_stability(&self, point: &[Rational], budget: &Budget) -> Result<Vec<Rational>, Exhausted> {
        let share = |(above, below): (i64, i64)| Rational::new(above.into(), below.into());
        let is_lost = |time: &Rational| budget.enter(|| self.is_stable(point, time) == Some(false));
        let mut shortest = None;
        for part in SHARES {
            let time = &self.least * &share(part);
            match (is_lost(&time)?, &shortest) {
                (true, _) => shortest = Some(time),
                (false, Some(_)) => break,
                (false, None) => {}
            }
        }
        let Some(shortest) = shortest else { return Ok(Vec::new()) };
        let mut out = Vec::new();
        for part in LONGER {
            let time = &shortest * &share(part);
            if time <= self.least && is_lost(&time)? {
                out.push(time);
            }
        }
        Ok(out)
    }

    /// Whether all points are stable with all dead times from zero to the greatest; `false` where that is not seen.
    fn is_stable_with_less(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<bool, Exhausted> {
        let mut open = vec![[Rational::ZERO, self.least.clone()]];
        let mut looked = 0;
        while let Some(times) = open.pop() {
            looked += 1;
            match self.with(sides, times.clone(), budget)? {
                OverPoints::All => {}
                OverPoints::Open { .. } if looked < MOST_PARTS => {
                    let [low, high] = times;
                    let middle = low.midpoint(&high);
                    open.extend([[low, middle.clone()], [middle, high]]);
                }
                _ => return Ok(false),
            }
        }
        Ok(true)
    }

    /// Whether all points are stable with all dead times of a range, or none is with any.
    fn with(&self, sides: &[[Rational; 2]], times: [Rational; 2], budget: &Budget) -> Result<OverPoints, Exhausted> {
        let all: Vec<[Rational; 2]> = sides.iter().cloned().chain([times]).collect();
        same_count(&self.family, &all, budget, |point| budget.enter(|| told(&self.family, point)))
    }

    fn is_stable(&self, point: &[Rational], time: &Rational) -> Option<bool> {
        let point: Vec<Rational> = point.iter().chain([time]).cloned().collect();
        told(&self.family, &point)
    }
}

/// Whether a point is stable; `None` where one walk along the imaginary axis does not tell.
fn told(family: &DelayedFunction, point: &[Rational]) -> Option<bool> {
    match family.count(point) {
        Some(AtPoint::Delayed { on: 0, right: Some(right) }) => Some(right == 0),
        _ => None,
    }
}
