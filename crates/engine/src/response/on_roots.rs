//! Requirements on the roots of the closed loop, whatever its coefficients are made of.

use super::cells::{Unmet, around, inside_of, outward, parts_beside, required_parts};
use super::damped::changes;
use super::required_set::not_decided;
use super::requirement::{Requirement, Rule};
use super::spiral::OnSpiral;
use super::{RequiredInterval, RequiredSet};
use crate::error::Error;
use crate::stability::{
    AtPoint, Bracket, Cause, Range, Shape, StableInterval, StableSet, SymbolicPolynomial, UndecidedBracket,
};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_algebra::symbols::merged;

/// A requirement on the roots of a closed loop in one parameter, or none.
pub(super) enum OnRoots {
    /// The roots are inside of the spiral of a damping.
    Spiral(OnSpiral),
    /// The roots of another polynomial are inside of the region of stability or on its boundary.
    Region { polynomial: SymbolicPolynomial, shape: Shape },
}

impl OnRoots {
    /// Brings the requirement's region back to the disc or the half plane, or makes a spiral of it. Returns `None` if the requirement
    /// is not about roots, or if the coefficients of the loop are known by enclosures alone.
    pub fn of(requirement: &Requirement, p: &SymbolicPolynomial, shape: Shape) -> Option<OnRoots> {
        Some(match requirement.rule() {
            Rule::Sector(least) if shape == Shape::UnitDisc => OnRoots::Spiral(OnSpiral::of(p, least)?),
            Rule::Sector(least) => OnRoots::Region { polynomial: p.in_sector(least), shape },
            Rule::Modulus { exponent } => OnRoots::Region { polynomial: p.scaled_by_exponential(exponent), shape },
            _ => return None,
        })
    }

    /// True if a loop that is stable at a value of the parameter meets the requirement there.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where a root is not told from the boundary.
    pub fn is_met_at(&self, value: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        Ok(match self {
            OnRoots::Spiral(p) => p.count_at(value, budget)? == p.degree(),
            OnRoots::Region { polynomial, shape } => match polynomial.at(value, *shape, budget)? {
                AtPoint::Defined { count, infinite: 0 } => count.outside == 0,
                _ => false,
            },
        })
    }

    /// The parts of a stable set in which the requirement is met.
    ///
    /// # Errors
    /// As [`OnRoots::is_met_at`].
    pub fn required_set(
        &self,
        requirement: &Requirement,
        stable: &StableSet,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        let mut found = RequiredSet { undecided: stable.undecided().to_vec(), ..RequiredSet::default() };
        for interval in stable.intervals() {
            if self.has_roots_on_boundary_throughout(interval, budget)? {
                return Err(not_decided(requirement));
            }
            let (values, open) = self.changes(interval, budget)?;
            let why = format!("where {} begins or ceases to be met", requirement.name());
            let open =
                open.into_iter().map(|(lower, upper)| UndecidedBracket::new(lower, upper, why.clone())).collect();
            let cells = |part: &StableInterval| self.cells(requirement, part, &values, budget);
            parts_beside(interval, open, &mut found, cells)?;
        }
        found.sort();
        Ok(found)
    }

    /// True if roots of the other polynomial are on the boundary at several values. Then they may be there at all values, and the boundary
    /// functions may vanish identically. One value without a root on the boundary proves that they do not.
    fn has_roots_on_boundary_throughout(&self, interval: &StableInterval, budget: &Budget) -> Result<bool, Exhausted> {
        let OnRoots::Region { polynomial, shape } = self else { return Ok(false) };
        let mut below = interval.bare();
        for _ in 0..SAMPLES {
            let sample = below.sample(budget)?;
            match polynomial.at(&sample, *shape, budget)? {
                AtPoint::Defined { count, .. } if count.on > 0 => below.upper = Some(sample.into()),
                _ => return Ok(false),
            }
        }
        Ok(true)
    }

    /// The values strictly inside of a stable interval at which the requirement may begin or cease to be met, ascending, and where there may
    /// be others.
    fn changes(&self, interval: &StableInterval, budget: &Budget) -> Result<Changes, Exhausted> {
        let OnRoots::Region { polynomial, shape, .. } = self else {
            let OnRoots::Spiral(p) = self else { unreachable!("one of two") };
            return changes(p, interval, budget);
        };
        let range = Range::between(outward(&interval.lower, true), outward(&interval.upper, false));
        let set = polynomial.stable_set(&range, *shape, budget)?;
        let mut values: Vec<Real> = Vec::new();
        let mut open: Vec<Bracket> = set.undecided().iter().map(|b| (b.lower.clone(), b.upper.clone())).collect();
        for end in set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
            let is_new = values.last().is_none_or(|last| !last.is_same(&end.value));
            if !is_new || !end.causes.is_limit() || ENDS_OF_STABILITY.iter().any(|cause| end.causes.contains(*cause)) {
                continue;
            }
            match interval.bare().has_inside(&end.value, budget) {
                Ok(true) => values.push(end.value.clone()),
                Ok(false) => {}
                Err(stopped) if stopped.stop.is_precision() => open.push(around(&end.value)),
                Err(stopped) => return Err(stopped),
            }
        }
        // At other zeros of the boundary roots touch it; a rational one is decided by itself.
        let mut touched = Vec::new();
        for zero in set.cells().iter().flat_map(|cells| &cells.zeros).filter(|zero| zero.exact().is_some()) {
            if interval.bare().has_inside(zero, budget)? {
                touched.push(zero.clone());
            }
        }
        Ok((merged(values, touched, budget)?, open))
    }

    fn cells(
        &self,
        requirement: &Requirement,
        interval: &StableInterval,
        values: &[Real],
        budget: &Budget,
    ) -> Result<Vec<RequiredInterval>, Error> {
        let inside = inside_of(interval, values, budget)?;
        let unmet = |value: &Rational| -> Result<Unmet, Error> {
            Ok(if self.is_met_at(value, budget)? { Vec::new() } else { vec![requirement.name()] })
        };
        required_parts(interval, &inside, unmet, |_, _| Ok(true), budget)
    }
}

/// At these the loop itself is not stable: no stable interval has them inside. (A root at 0 is at the sector's vertex.)
const ENDS_OF_STABILITY: [Cause; 4] = [Cause::RootAtZero, Cause::DegreeLost, Cause::Pole, Cause::SquareRoot];

/// So many values with a root on the boundary are no coincidence.
const SAMPLES: usize = 3;

/// Values, and where there may be others.
pub(super) type Changes = (Vec<Real>, Vec<Bracket>);
