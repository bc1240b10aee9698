//! What limits the regions of a map, and what the map says on a line through it.

use super::answers::{Decision, Intervals};
use super::frequency::{Frequency, frequency};
use super::{Map, OneParameter};
use crate::stability::plane::{Limit, multi_value, region_limits, vanishing_boundary};
use crate::stability::{AlgebraicInterval, AtPoint, End, Region, StableSet, end_at, stable_set};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction, RealAlgebraic, UniPoly};

/// An extreme value of a region, with the frequency of the complex pair that limits it there.
#[derive(Clone, Debug)]
pub struct MapLimit {
    /// The value, its causes and its place.
    pub limit: Limit,
    /// The frequency, for a complex pair at one point.
    pub frequency: Option<Frequency>,
}

/// The extreme values of a region; `None` where it is unbounded.
#[derive(Clone, Debug)]
pub struct RegionExtent {
    /// The least and the greatest value of either parameter.
    pub ends: [[Option<MapLimit>; 2]; 2],
}

impl Map {
    /// What limits each region, places and frequencies to about so many digits; none while undecided.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn limits(&self, digits: usize, budget: &Budget) -> Result<Vec<RegionExtent>, Exhausted> {
        let (Decision::Decided(map), Some(p)) = (&self.map, &self.polynomial) else { return Ok(Vec::new()) };
        let domain = [self.axes[0].domain.clone(), self.axes[1].domain.clone()];
        let found = region_limits(map, p, &domain, self.region, digits, budget)?;
        // log2(10) < 10/3
        let bits = (digits as u64 + 2) * 10 / 3 + 8;
        let extent = |r: crate::stability::plane::RegionLimits| RegionExtent {
            ends: [r.x, r.y].map(|ends| ends.map(|end| end.map(|limit| self.with_frequency(limit, bits)))),
        };
        Ok(found.into_iter().map(extent).collect())
    }

    fn with_frequency(&self, limit: Limit, bits: u64) -> MapLimit {
        let frequency = limit.half_size_root.as_ref().map(|root| {
            let (angle, rate) = match self.region {
                Region::LeftHalfPlane => (None, Some(root.neg().sqrt(bits + 8))),
                Region::UnitDisc => {
                    let half = Enclosure::from_rational(Rational::dyadic(&jurist_algebra::number::Integer::ONE, 1));
                    let angle = root.mul(&half, 4 * bits + 64).acos(bits + 8);
                    let step = limit.at.first().and_then(|at| self.sample_time_on(at, 4 * bits + 64));
                    let rate = step.and_then(|t| angle.div(&t, bits + 8));
                    (Some(angle), rate)
                }
            };
            let two_pi = Enclosure::pi(bits + 8).mul(&Enclosure::from_rational(Rational::from(2)), bits + 8);
            let hertz = rate.as_ref().and_then(|w| w.div(&two_pi, bits));
            Frequency { angle, radians_per_second: rate, hertz }
        });
        MapLimit { limit, frequency }
    }

    /// The sample time on a box, if it is positive there.
    fn sample_time_on(&self, [x, y]: &[Enclosure; 2], bits: u64) -> Option<Enclosure> {
        let step = self.sample_time.as_ref()?;
        let value = |f: &MultiPoly| multi_value(f, x, y, bits);
        let step = value(step.numerator()).div(&value(step.denominator()), bits)?;
        step.lower().sign().is_gt().then_some(step)
    }

    /// Why the loop is stable at no point of the plane: `undefined`, or the name of the boundary polynomial
    /// that vanishes identically. `None` where that is not so.
    pub fn never_stable_cause(&self) -> Option<&'static str> {
        let Decision::Decided(map) = &self.map else { return None };
        if !map.never_stable {
            return None;
        }
        let Some(p) = &self.polynomial else { return Some("undefined") };
        let cause = vanishing_boundary(p, self.region, &Budget::unlimited());
        cause.ok().flatten().map(crate::stability::Cause::name)
    }

    /// The question that is left when one of the parameters (0 for `x`, 1 for `y`) has a value.
    pub fn on_line(&self, fixed: usize, value: &Rational) -> OneParameter {
        let (fixed_axis, axis) = (&self.axes[fixed], &self.axes[1 - fixed]);
        let polynomial =
            self.polynomial.as_ref().and_then(|p| if fixed == 0 { p.at_x(value) } else { p.swapped().at_x(value) });
        let mut set = self.set.clone();
        set.push((fixed_axis.name.clone(), value.clone()));
        OneParameter {
            title: self.title.clone(),
            time: self.time,
            parameter: axis.name.clone(),
            unit: axis.unit.clone(),
            nominal: axis.nominal.clone(),
            set,
            domain: axis.domain.clone(),
            region: self.region,
            radius: self.radius.clone(),
            decay: self.decay.clone(),
            polynomial,
            sample_time: self.sample_time.as_ref().and_then(|t| on_line(t, fixed, value)),
            warnings: Vec::new(),
        }
    }

    /// What happens on the wall of a stable cell: branch `number`, counted from 0 from below, over a rational `x`
    /// inside a strip; with the frequency of its complex pair to about `bits`.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn wall(
        &self,
        x: &Rational,
        number: usize,
        bits: u64,
        budget: &Budget,
    ) -> Result<Option<(End, Option<Frequency>)>, Exhausted> {
        let Decision::Decided(map) = &self.map else { return Ok(None) };
        let question = self.on_line(0, x);
        let branches = map.branches(x, &self.axes[1].domain, budget)?;
        let (Some(p), Some((value, _))) = (&question.polynomial, branches.get(number)) else { return Ok(None) };
        let end = end_at(p, value, &question.domain, self.region, &budget.silent())?;
        Ok(end.map(|end| {
            let frequency = frequency(&end, &question, bits);
            (end, frequency)
        }))
    }

    /// The cells on the vertical line at a rational `x`, from below, also where it is a wall between strips: whether
    /// the loop is stable, and how many roots are outside. `None` where a curve contains the line.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn fibre(&self, x: &Rational, budget: &Budget) -> Result<Option<Vec<(bool, usize)>>, Exhausted> {
        let (Decision::Decided(map), Some(p)) = (&self.map, &self.polynomial) else { return Ok(None) };
        if map.curves.iter().any(|c| c.polynomial.substitute(0, x).0.is_zero()) {
            return Ok(None);
        }
        let domain = &self.axes[1].domain;
        let mut ends: Vec<Option<RealAlgebraic>> = vec![domain.lower.clone().map(RealAlgebraic::from_rational)];
        for (value, _) in map.branches(x, domain, budget)? {
            // Branches of several curves may meet on a wall.
            if !ends.last().is_some_and(|last| last.as_ref().is_some_and(|l| l.compare(&value).is_eq())) {
                ends.push(Some(value));
            }
        }
        ends.push(domain.upper.clone().map(RealAlgebraic::from_rational));
        let mut cells = Vec::with_capacity(ends.len());
        for pair in ends.windows(2) {
            budget.check()?;
            let cell = AlgebraicInterval { lower: pair[0].clone(), upper: pair[1].clone() };
            cells.push(match p.at(x, &cell.sample(), self.region) {
                AtPoint::Defined { count, infinite } => {
                    (infinite == 0 && count.inside == p.formal_degree(), count.outside + infinite)
                }
                AtPoint::Undefined | AtPoint::Zero => (false, p.formal_degree()),
            });
        }
        Ok(Some(cells))
    }

    /// The exact stable set on a line through the map: one parameter has a value, also that of a wall
    /// between strips.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn slice(&self, fixed: usize, value: &Rational, budget: &Budget) -> Result<Intervals, Exhausted> {
        let question = self.on_line(fixed, value);
        let set = match question.polynomial.as_ref().filter(|_| self.axes[fixed].domain.contains(value)) {
            None => StableSet::default(),
            Some(p) => stable_set(p, &question.domain, question.region, budget)?,
        };
        Ok(Intervals { question, stable: Decision::Decided(set) })
    }
}

/// Numerator and denominator at a value of one variable, in the other; `None` where the latter vanishes.
fn on_line(f: &RationalFunction, fixed: usize, value: &Rational) -> Option<(UniPoly, UniPoly)> {
    let side = |p: &MultiPoly| {
        let (p, scale) = p.substitute(fixed, value);
        (p.to_univariate(1 - fixed).expect("one variable is left"), scale)
    };
    let ((numerator, n), (denominator, d)) = (side(f.numerator()), side(f.denominator()));
    let pair = (numerator.scaled(&d), denominator.scaled(&n));
    (!pair.1.is_zero()).then_some(pair)
}
