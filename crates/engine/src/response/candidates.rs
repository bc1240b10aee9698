//! Values of a parameter at which requirements may begin or cease to be met.

use super::RequiredInterval;
use super::cells::{Unmet, around, required_parts};
use super::requirement::{Requirement, Rule};
use crate::error::Error;
use crate::stability::{Bracket, StableInterval, UndecidedBracket, told_apart};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;

/// A value at which a requirement may begin or cease to be met.
struct Candidate {
    value: Real,
    /// The names of the requirements for which a crossing may appear there at once.
    touches: Vec<&'static str>,
}

/// Those in a stable interval, ascending, and where there may be others.
#[derive(Default)]
pub(super) struct Candidates {
    all: Vec<Candidate>,
    undecided: Vec<UndecidedBracket>,
}

impl Candidates {
    /// Adds the values of a requirement that are inside of an interval, ascending, each with whether a crossing may appear there at once, and brackets that
    /// may have others.
    pub fn add(
        &mut self,
        requirement: &Requirement,
        interval: &StableInterval,
        (values, mut open): (Vec<(Real, bool)>, Vec<Bracket>),
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        let mut list = Vec::new();
        for (value, is_touch) in values {
            match interval.bare().has_inside(&value, budget) {
                Ok(true) => list.push((value, is_touch)),
                Ok(false) => {}
                Err(stopped) if stopped.stop.is_precision() => open.push(around(&value)),
                Err(stopped) => return Err(stopped),
            }
        }
        let known = self.all.iter().map(|c| c.value.clone()).collect();
        let new = list.iter().map(|(value, _)| value.clone()).collect();
        let values = told_apart(known, new, &mut open, budget)?;
        self.all = values
            .into_iter()
            .map(|value| {
                let mut touches: Vec<&'static str> =
                    self.all.iter().filter(|c| c.value.is_same(&value)).flat_map(|c| c.touches.clone()).collect();
                if list.iter().any(|(x, is_touch)| *is_touch && x.is_same(&value)) {
                    touches.push(requirement.name());
                }
                Candidate { value, touches }
            })
            .collect();
        let why = format!("where {} begins or ceases to be met", requirement.name());
        self.undecided.extend(open.into_iter().map(|(lo, hi)| UndecidedBracket::new(lo, hi, why.clone())));
        Ok(())
    }

    /// The brackets, ascending.
    pub fn brackets(&self) -> Vec<UndecidedBracket> {
        let mut all = self.undecided.clone();
        all.sort_by(|a, b| (&a.lower, &a.upper).cmp(&(&b.lower, &b.upper)));
        all
    }

    /// The parts of an interval in which all requirements are met. `unmet` names the requirements that a stable value does not meet.
    pub fn cells(
        &self,
        interval: &StableInterval,
        requirements: &[Requirement],
        unmet: impl Fn(&Rational) -> Result<Unmet, Error>,
        budget: &Budget,
    ) -> Result<Vec<RequiredInterval>, Error> {
        let bare = interval.bare();
        let mut inside: Vec<&Candidate> = Vec::new();
        for c in &self.all {
            if bare.has_inside(&c.value, budget)? {
                inside.push(c);
            }
        }
        let values: Vec<Real> = inside.iter().map(|c| c.value.clone()).collect();
        let is_closed = |i: usize, names: &[&'static str]| {
            let asks_at_ends =
                |name| requirements.iter().any(|r| r.name() == name && matches!(r.rule(), Rule::Factors(_)));
            let bound = |name: &'static str| asks_at_ends(name) || inside[i].touches.contains(&name);
            Ok(!names.iter().any(|name| bound(name)))
        };
        required_parts(interval, &values, unmet, is_closed, budget)
    }
}
