//! The delay margin over boxes: the loop with dead time at the cut, which is one parameter more.
//!
//! A loop has a delay margin of a time at least where it is stable with all less dead time at the cut. So a box is refuted by one dead time with which
//! no point of it is stable.

use super::opened::OpenedLoop;
use super::requirement_boxes::OverPoints;
use super::same_count::same_count;
use crate::error::Error;
use crate::model::Cut;
use crate::problem::{OverDeadTime, Problem};
use crate::stability::boxes::{DelayedFunction, Family, corners};
use crate::stability::{AtPoint, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// Shares of the greatest dead time with which a loop may be unstable, from the longest to the shortest.
const SHARES: [(i64, i64); 12] =
    [(1, 1), (7, 8), (3, 4), (5, 8), (1, 2), (3, 8), (1, 4), (1, 8), (1, 16), (1, 32), (1, 64), (1, 128)];

/// A dead time with which a loop is unstable is made longer so much.
const LONGER: [(i64, i64); 4] = [(3, 2), (1, 1), (2, 1), (3, 1)];

/// The dead times from zero to the greatest are not cut into more parts.
const MOST_PARTS: usize = 12;

/// Cells of frequency and parameters after which a box is rather halved: with one dead time, and with a range of them.
const CELLS: [usize; 2] = [64, 12];

/// So many corners of a box are looked at before a proof is tried.
const MOST_CORNERS: usize = 8;

/// A least delay margin over boxes.
pub(crate) struct DelayBoxes {
    open: OverDeadTime,
    near: Vec<Rational>,
    /// The loop in its parameters, the dead time at the cut being the last one.
    with_any: DelayedFunction,
    /// The loop with all of the dead time.
    with_all: DelayedFunction,
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
        let (denominator, numerator) = (quotient.denominator, quotient.numerator);
        let open = OverDeadTime { denominator, numerator, undefined, delays, parameters: near.len() };
        let usual: Vec<Rational> = near.iter().chain([least]).cloned().collect();
        let families = budget.enter(|| -> Result<_, Error> {
            let with_any = open.closed(&RationalFunction::variable(near.len()), &usual)?;
            Ok((with_any, open.closed(&least.clone().into(), near)?))
        })??;
        let (Some(with_any), Some(with_all)) = families else { return Ok(None) };
        Ok(Some(DelayBoxes { open, near: near.to_vec(), with_any, with_all, least: least.clone() }))
    }

    /// The loop in its parameters, the dead time at the cut being one more: a stable point has the delay margin where it is stable with all up to the least.
    pub fn with_any(&self) -> &DelayedFunction {
        &self.with_any
    }

    /// Whether all stable points of a closed box have the delay margin, or no point has it.
    ///
    /// Cost: that of a few dozen boxes with one parameter more.
    ///
    /// # Errors
    /// When the budget runs out.
    pub fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<OverPoints, Exhausted> {
        let with_all = with(&self.with_all, sides, CELLS[0], budget)?;
        if with_all == OverPoints::None {
            return Ok(OverPoints::None);
        }
        let middle: Vec<Rational> = sides.iter().map(|[low, high]| low.midpoint(high)).collect();
        let times = self.times_without_stability(&middle, budget)?;
        for time in times.iter().filter(|time| **time != self.least) {
            let family = budget.enter(|| self.open.closed(&time.clone().into(), &self.near))?;
            if let Ok(Some(family)) = family
                && with(&family, sides, CELLS[0], budget)? == OverPoints::None
            {
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
            let all: Vec<[Rational; 2]> = sides.iter().cloned().chain([times.clone()]).collect();
            match with(&self.with_any, &all, CELLS[1], budget)? {
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

    fn is_stable(&self, point: &[Rational], time: &Rational) -> Option<bool> {
        let point: Vec<Rational> = point.iter().chain([time]).cloned().collect();
        told(&self.with_any, &point)
    }
}

/// Whether all points of a box are stable, or none is.
fn with(
    family: &DelayedFunction,
    sides: &[[Rational; 2]],
    cells: usize,
    budget: &Budget,
) -> Result<OverPoints, Exhausted> {
    let right = |point: &[Rational]| match family.count(point) {
        Some(AtPoint::Delayed { on: 0, right }) => right,
        _ => None,
    };
    let is_same = || {
        let middle: Vec<Rational> = sides.iter().map(|[low, high]| low.midpoint(high)).collect();
        right(&middle).is_some_and(|own| corners(sides).take(MOST_CORNERS).all(|corner| right(&corner) == Some(own)))
    };
    // Further roots cross where a loop is not stable: a proof that they do not takes long to fail.
    if !budget.enter(is_same)? {
        return Ok(OverPoints::Open { middle: None });
    }
    same_count(family, sides, (cells, budget), |point| budget.enter(|| told(family, point)))
}

/// Whether a point is stable; `None` where one walk along the imaginary axis does not tell.
fn told(family: &DelayedFunction, point: &[Rational]) -> Option<bool> {
    match family.count(point) {
        Some(AtPoint::Delayed { on: 0, right: Some(right) }) => Some(right == 0),
        _ => None,
    }
}
