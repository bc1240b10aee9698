//! A dead time at the cut of continuous loops, over boxes.

use super::delay_boxes::{DelayAsked, DelayFamily, DelayedLoops, Delays, shares_of};
use super::opened::OpenedLoop;
use super::requirement_boxes::OverPoints;
use crate::coverage::refusals::DELAY_BESIDE;
use crate::error::Error;
use crate::problem::OverDeadTime;
use crate::stability::AtPoint;
use crate::stability::boxes::{DelayedFunction, Family, corners, same_count};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// So many corners of a box are looked at before a proof is tried.
const MOST_CORNERS: usize = 8;

/// Continuous loops with dead time at the cut.
pub(crate) struct ContinuousDelay {
    open: OverDeadTime,
    near: Vec<Rational>,
    /// The loop in its parameters, the dead time at the cut being the last one.
    with_any: DelayedFunction,
    /// The loop with all of the dead time.
    with_all: DelayedFunction,
    /// Positive where the modulus of the open loop is above one in the limit of high frequencies; `None` where dead times are in that limit.
    above: Option<MultiPoly>,
    least: Rational,
}

/// Cells of frequency and constants at a point.
const CELLS_AT_POINT: usize = 64;

/// Bits of sums over a box.
const BITS: u64 = 64;

impl ContinuousDelay {
    /// `None` for a loop that vanishes identically.
    ///
    /// # Errors
    /// As [`OpenedLoop::of`] and [`OpenedLoop::quotient`]; `E-require` beside functions of a free name.
    pub fn of(asked: DelayAsked<'_>, budget: &Budget) -> Result<Option<ContinuousDelay>, Error> {
        let DelayAsked { problem, least, cut, near } = asked;
        let opened = OpenedLoop::of(problem, cut.clone(), budget)?;
        let (quotient, undefined) = opened.quotient(MultiPoly::clone, budget)?;
        let parts = [&quotient.denominator, &quotient.numerator];
        let open = budget.enter(|| OverDeadTime::new(parts, &undefined, &opened.symbols))?;
        let open = open.ok_or_else(|| DELAY_BESIDE.diagnostic(&[]))?;
        let above = open.above_at_highest();
        let usual: Vec<Rational> = near.iter().chain([least]).cloned().collect();
        let families = budget.enter(|| -> Result<_, Error> {
            let with_any = open.closed(&RationalFunction::variable(near.len()), &usual)?;
            Ok((with_any, open.closed(&least.clone().into(), near)?))
        })??;
        let (Some(with_any), Some(with_all)) = families else { return Ok(None) };
        Ok(Some(ContinuousDelay { open, near: near.to_vec(), with_any, with_all, above, least: least.clone() }))
    }

    /// A box of the parameters with that of the dead time, if it is one of them, and with those of the constants.
    fn beside(&self, sides: &[[Rational; 2]], delay: Option<[Rational; 2]>) -> Vec<[Rational; 2]> {
        sides.iter().cloned().chain(delay).chain(self.open.constants().iter().cloned()).collect()
    }

    /// The loop in its parameters and the dead time.
    pub fn family(&self) -> DelayFamily<'_> {
        let delays = Some([Rational::ZERO, self.least.clone()]);
        DelayFamily { loops: DelayedLoops::Delayed(&self.with_any), delays, constants: self.open.constants() }
    }
}

impl Delays for ContinuousDelay {
    fn tried(&self) -> Vec<Rational> {
        shares_of(&self.least)
    }

    fn ranges(&self) -> Vec<[Rational; 2]> {
        vec![[Rational::ZERO, self.least.clone()]]
    }

    fn is_delay(&self, _: &Rational) -> bool {
        true
    }

    fn bears_none(&self, sides: &[[Rational; 2]]) -> bool {
        self.above.as_ref().is_some_and(|above| over_box(above, &self.beside(sides, None)).lower().sign().is_gt())
    }

    fn at(&self, point: &[Rational], delay: &Rational, budget: &Budget) -> Result<Option<bool>, Exhausted> {
        if self.open.constants().is_empty() {
            let point: Vec<Rational> = point.iter().chain([delay]).cloned().collect();
            return budget.enter(|| told(&self.with_any, &point));
        }
        let sides: Vec<[Rational; 2]> = point.iter().map(|x| [x.clone(), x.clone()]).collect();
        let all = self.beside(&sides, Some([delay.clone(), delay.clone()]));
        Ok(match with(&self.with_any, &all, CELLS_AT_POINT, budget)? {
            OverPoints::All => Some(true),
            OverPoints::None => Some(false),
            OverPoints::Open { .. } => None,
        })
    }

    fn over(
        &self,
        sides: &[[Rational; 2]],
        delays: &[Rational; 2],
        cells: usize,
        budget: &Budget,
    ) -> Result<OverPoints, Exhausted> {
        let [low, high] = delays;
        if low < high {
            return with(&self.with_any, &self.beside(sides, Some(delays.clone())), cells, budget);
        }
        let sides = self.beside(sides, None);
        if *low == self.least {
            return with(&self.with_all, &sides, cells, budget);
        }
        match budget.enter(|| self.open.closed(&low.clone().into(), &self.near))? {
            Ok(Some(family)) => with(&family, &sides, cells, budget),
            _ => Ok(OverPoints::Open { middle: None }),
        }
    }
}

/// A range of the values of a polynomial over a box.
fn over_box(p: &MultiPoly, sides: &[[Rational; 2]]) -> Enclosure {
    let sides: Vec<Enclosure> = sides.iter().map(|[low, high]| Enclosure::new(low.clone(), high.clone())).collect();
    p.terms().iter().fold(Enclosure::from_rational(Rational::ZERO), |sum, (monomial, c)| {
        let powers = monomial.exponents().iter().zip(&sides);
        let factors = powers.flat_map(|(&e, side)| std::iter::repeat_n(side, e as usize));
        let c = Enclosure::from_rational(c.clone().into());
        sum.add(&factors.fold(c, |product, side| product.mul(side, BITS)), BITS)
    })
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
    let is_stable = |point: &[Rational]| budget.enter(|| told(family, point));
    Ok(OverPoints::of(same_count(family, sides, (cells, budget), is_stable)?))
}

/// Whether a point is stable; `None` where one walk along the imaginary axis does not tell.
fn told(family: &DelayedFunction, point: &[Rational]) -> Option<bool> {
    match family.count(point) {
        Some(AtPoint::Delayed { on: 0, right: Some(right) }) => Some(right == 0),
        _ => None,
    }
}
