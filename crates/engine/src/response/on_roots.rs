//! Requirements on the roots of the closed loop, whatever its coefficients are made of.

use super::cells::{Unmet, inside_of, outward, parts_beside, required_parts};
use super::damped::changes;
use super::requirement::{Requirement, Rule};
use super::spiral::OnSpiral;
use super::{RequiredInterval, RequiredSet};
use crate::error::Error;
use crate::stability::{
    AtPoint, Bracket, Range, Shape, StableInterval, StableSet, SymbolicPolynomial, UndecidedBracket,
};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;

/// A requirement on the roots of a closed loop in one parameter, or none.
pub(super) enum OnRoots {
    /// The roots are inside of the spiral of a damping.
    Spiral(OnSpiral),
    /// The roots of another polynomial are inside of the region of stability.
    Region {
        polynomial: SymbolicPolynomial,
        shape: Shape,
        /// True if a root on the boundary is allowed.
        closed: bool,
    },
}

impl OnRoots {
    /// `None` of a requirement that is not about roots, and of a loop of which only enclosures are known.
    pub fn of(requirement: &Requirement, p: &SymbolicPolynomial, shape: Shape) -> Option<OnRoots> {
        Some(match requirement.rule() {
            Rule::Sector(least) if shape == Shape::UnitDisc => OnRoots::Spiral(OnSpiral::of(p, least)?),
            Rule::Sector(least) => OnRoots::Region { polynomial: p.in_sector(least), shape, closed: true },
            // No root has a transcendental modulus, so none is on the circle.
            Rule::Modulus { exponent } => {
                OnRoots::Region { polynomial: p.scaled_by_exponential(exponent), shape, closed: false }
            }
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
            OnRoots::Region { polynomial, shape, closed } => match polynomial.at(value, *shape, budget)? {
                AtPoint::Defined { count, infinite: 0 } => count.outside + if *closed { 0 } else { count.on } == 0,
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
        let mut found = RequiredSet { intervals: Vec::new(), undecided: stable.undecided().to_vec() };
        for interval in stable.intervals() {
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
        for end in set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
            let is_new = values.last().is_none_or(|last| !last.is_same(&end.value));
            if is_new && end.causes.is_limit() && interval.bare().has_inside(&end.value, budget)? {
                values.push(end.value.clone());
            }
        }
        Ok((values, set.undecided().iter().map(|b| (b.lower.clone(), b.upper.clone())).collect()))
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

/// Values, and where there may be others.
pub(super) type Changes = (Vec<Real>, Vec<Bracket>);
