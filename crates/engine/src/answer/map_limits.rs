//! What limits the regions of a map, and what the map says on a line through it.

use super::{Answer, Frequency, Map};
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::plane::{Limit, PlanePolynomial, region_limits};
use crate::stability::{AtPoint, End, RealInterval, Shape, StableSet, end_at};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// An extreme value of a region, with the frequency of the complex pair that limits it there.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("a").nominal("0"))
///     .parameter(ParameterBuilder::new("b").nominal("0"))
///     .characteristic("z^2 + a*z + b")
///     .build()?;
/// let answer = model.ask().free("a").free("b").map(6, &Budget::unlimited())?;
/// let causes: Vec<String> = answer.value().all_limits().map(|end| end.limit.causes.to_string()).collect();
/// assert_eq!(causes.len(), 4); // the least and the greatest a and b
/// assert!(causes.iter().all(|names| !names.is_empty()));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MapLimit {
    /// The value, its causes and its place.
    pub limit: Limit,
    /// The frequency, for a complex pair at one point; `None` of a complex loop.
    pub frequency: Option<Frequency>,
}

/// The extreme values of a region; `None` where it is unbounded.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::MapLimit;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("a").nominal("0"))
///     .parameter(ParameterBuilder::new("b").nominal("0"))
///     .characteristic("z^2 + a*z + b")
///     .build()?;
/// let answer = model.ask().free("a").free("b").map(6, &Budget::unlimited())?;
/// let [_, [least_b, greatest_b]] = &answer.value().limits()[0].ends;
/// let value = |end: &Option<MapLimit>| end.as_ref().unwrap().limit.value.decimal(6);
/// assert_eq!((value(least_b), value(greatest_b)), ("-1".to_owned(), "1".to_owned()));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RegionExtent {
    /// The least and the greatest value of either parameter.
    pub ends: [[Option<MapLimit>; 2]; 2],
}

impl Problem {
    fn with_frequency(&self, p: &PlanePolynomial, limit: Limit, bits: u64) -> MapLimit {
        // On which side of the real axis a complex loop's root is does not show here.
        let root = limit.half_size_root.as_ref().filter(|_| !self.is_complex());
        let frequency = root.map(|root| match self.shape() {
            Shape::LeftHalfPlane => Frequency::new(None, None, Some(root.neg().sqrt(bits + 8)), bits),
            Shape::UnitDisc => {
                let half = Enclosure::from_rational(Rational::dyadic(&Integer::ONE, 1));
                let angle = root.mul(&half, 4 * bits + 64).acos(bits + 8);
                let step = limit.at.first().and_then(|at| self.sample_time_on(p, at, 4 * bits + 64));
                Frequency::new(Some(angle), step.as_ref(), None, bits)
            }
        });
        MapLimit { limit, frequency }
    }

    /// The sample time on a box, if it is positive there.
    fn sample_time_on(&self, p: &PlanePolynomial, [x, y]: &[Enclosure; 2], bits: u64) -> Option<Enclosure> {
        let step = self.evaluated()?.sample_time()?;
        let value = |f: &MultiPoly| p.enclose(f, x, y, bits);
        let step = value(step.numerator()).div(&value(step.denominator()), bits)?;
        step.lower().sign().is_gt().then_some(step)
    }
}

impl Answer<Map> {
    /// What limits each region, places and frequencies to about so many digits.
    pub(super) fn region_extents(&self, digits: usize, budget: &Budget) -> Result<Vec<RegionExtent>, Exhausted> {
        let problem = &self.problem;
        let Ok(Some(p)) = problem.plane_over_symbols(budget) else { return Ok(Vec::new()) };
        let found = region_limits(&self.value.decomposition, p, &problem.domains(), problem.shape(), digits, budget)?;
        // log2(10) < 10/3
        let bits = (digits as u64 + 2) * 10 / 3 + 8;
        let extent = |r: crate::stability::plane::RegionLimits| RegionExtent {
            ends: [r.x, r.y].map(|ends| ends.map(|end| end.map(|limit| problem.with_frequency(p, limit, bits)))),
        };
        Ok(found.into_iter().map(extent).collect())
    }

    /// What happens on the wall of a stable cell: branch `number`, counted from 0 from below, over a rational `x`
    /// inside a strip; with the frequency of its complex pair to about `bits`.
    ///
    /// Cost: the zeros of the boundary curves on one line are isolated, and one resultant tells what happens at the
    /// wall.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    pub fn wall(
        &self,
        x: &Rational,
        number: usize,
        bits: u64,
        budget: &Budget,
    ) -> Result<Option<(End, Option<Frequency>)>, Error> {
        budget.enter(|| {
            if self.is_over_symbols(budget)? {
                return self.wall_over_symbols(x, number, bits, budget);
            }
            let line = self.problem.line(0, x, budget)?;
            let domain = &line.parameter().domain;
            let branches = self.value.decomposition.branches(x, domain, budget)?;
            let (Some(p), Some((value, _))) = (line.parametric(budget)?, branches.get(number)) else { return Ok(None) };
            let Some(value) = value.algebraic() else { return Ok(None) };
            let Some(end) = end_at(p, value, domain, line.shape(), &budget.silent())? else { return Ok(None) };
            let end = line.with_side(end, budget)?;
            let frequency = line.frequency(&end, bits);
            Ok(Some((end, frequency)))
        })?
    }

    /// Whether the loop has symbols; the curves may have none all the same.
    fn is_over_symbols(&self, budget: &Budget) -> Result<bool, Error> {
        Ok(!self.problem.algebra_over_symbols(budget)?.symbols().is_empty())
    }

    /// The same where the loop has symbols: the wall is an end of the stable set on the line.
    fn wall_over_symbols(
        &self,
        x: &Rational,
        number: usize,
        bits: u64,
        budget: &Budget,
    ) -> Result<Option<(End, Option<Frequency>)>, Error> {
        let map = &self.value.decomposition;
        let domain = &self.problem.free()[1].domain;
        let Some(strip) = map.strips.iter().find(|s| s.x.contains(x)) else { return Ok(None) };
        let is_stable = |k: usize| strip.cells.get(k).is_some_and(|cell| cell.stable);
        let (cell, side) = match [is_stable(number), is_stable(number + 1)] {
            [true, false] => (number, 1),
            [false, true] => (number + 1, 0),
            _ => return Ok(None),
        };
        let branches = map.branches(x, domain, budget)?;
        let value = |k: Option<usize>, edge: &Option<Rational>| {
            let branch = k.and_then(|k| branches.get(k)).map(|b| b.0.clone());
            branch.or_else(|| edge.clone().map(Real::from))
        };
        let inside =
            RealInterval { lower: value(cell.checked_sub(1), &domain.lower), upper: value(Some(cell), &domain.upper) };
        let inside = inside.sample(budget)?;
        let line = self.slice(0, x, budget)?;
        let around = line.value().intervals().iter().find(|i| i.contains(&inside));
        let end = around.and_then(|i| [&i.lower, &i.upper][side].clone());
        Ok(end.map(|end| {
            let frequency = line.problem().frequency(&end, bits);
            (end, frequency)
        }))
    }

    /// The cells on the vertical line at a rational `x`, from below, also where it is a wall between strips: whether
    /// the loop is stable, and how many roots are outside. `None` where a curve contains the line, and of a loop over symbols, where
    /// equal branches are not recognised on a wall.
    ///
    /// Cost: the zeros of the boundary curves on one line are isolated, and one root count is made for each cell
    /// between them.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    pub fn fibre(&self, x: &Rational, budget: &Budget) -> Result<Option<Vec<(bool, usize)>>, Error> {
        budget.enter(|| {
            let map = &self.value.decomposition;
            if self.is_over_symbols(budget)? {
                return Ok(None);
            }
            let Some(p) = self.problem.plane(budget)? else { return Ok(None) };
            if map.curves.iter().any(|c| c.polynomial.substitute(0, x).0.is_zero()) {
                return Ok(None);
            }
            let domain = &self.problem.free()[1].domain;
            let mut ends: Vec<Option<Real>> = vec![domain.lower.clone().map(Real::from)];
            for (value, _) in map.branches(x, domain, budget)? {
                // Branches of several curves may meet on a wall.
                if !ends.last().is_some_and(|last| last.as_ref().is_some_and(|l| l.is_same(&value))) {
                    ends.push(Some(value));
                }
            }
            ends.push(domain.upper.clone().map(Real::from));
            let mut cells = Vec::with_capacity(ends.len());
            for pair in ends.windows(2) {
                budget.check()?;
                let cell = RealInterval { lower: pair[0].clone(), upper: pair[1].clone() };
                cells.push(match p.at(x, &cell.sample(budget)?, self.problem.shape()) {
                    AtPoint::Defined { count, infinite } => {
                        (infinite == 0 && count.inside == p.formal_degree(), count.outside + infinite)
                    }
                    AtPoint::Undefined | AtPoint::Zero | AtPoint::Delayed { .. } => (false, p.formal_degree()),
                });
            }
            Ok(Some(cells))
        })?
    }

    /// The exact stable set on a line through the map: one parameter (0 for `x`) has a value, also that of a wall between
    /// strips.
    ///
    /// Cost: that of [`Problem::stable_set`] on the line; the model is not evaluated again.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    pub fn slice(&self, fixed: usize, value: &Rational, budget: &Budget) -> Result<Answer<StableSet>, Error> {
        budget.enter(|| {
            let line = Arc::new(self.problem.on_line(fixed, value, budget)?);
            if !self.problem.free()[fixed].domain.contains(value) {
                return Ok(Answer::new(line, StableSet::default()));
            }
            line.stable_set(budget)
        })?
    }
}
