//! For which values of one parameter a discrete loop bears a delay. The delay is a number of whole samples, and each number makes another loop; or it is
//! dead time behind a hold.

use super::RequiredSet;
use super::borne_set::ascending;
use super::cells::{inside_of, outward, parts_beside, required_parts};
use super::delay_boxes::DelayAsked;
use super::requirement::{Requirement, Rule};
use super::sampled_delay::{Counted, SampledLoop};
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::{Range, Shape, StableInterval, StableSet, UndecidedBracket, symbolic_stable_set};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use std::slice::from_ref;
use std::sync::Arc;

impl Problem {
    /// The parts of the stable set in which the delay margin of a discrete loop is what is required.
    ///
    /// # Errors
    /// As [`SampledLoop::of`].
    pub(super) fn bearing_samples(
        self: &Arc<Self>,
        requirement: &Requirement,
        stable: &StableSet,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        let Rule::DeadTime(least) = requirement.rule() else { unreachable!("a delay margin") };
        let parameter = &self.free()[0];
        let first = stable.intervals().first().map(|interval| interval.bare().sample(budget)).transpose()?;
        let near = parameter.nominal.clone().or(first).unwrap_or(Rational::ONE);
        let cut = requirement.cut(self, at)?;
        let sampled = SampledLoop::of(DelayAsked { problem: self, least, cut: &cut, near: from_ref(&near) }, budget)?;
        let Counted::Whole(samples) = sampled.counted else {
            return self.without_region().required_in_boxes(from_ref(requirement), stable, at, budget);
        };
        let names = [parameter.name.clone()];
        let own = |m| self.symbolic_polynomial(&sampled.with_samples(&names, m), &sampled.opened.symbols);
        let loops = (1..=samples).map(own).collect::<Result<Vec<_>, _>>()?;
        let mut found = RequiredSet { undecided: stable.undecided().to_vec(), ..RequiredSet::default() };
        for interval in stable.intervals() {
            let domain = Range::between(outward(&interval.lower, true), outward(&interval.upper, false));
            let set = |p| symbolic_stable_set(p, &domain, Shape::UnitDisc, budget);
            let sets = loops.iter().map(set).collect::<Result<Vec<_>, _>>()?;
            stable_with_each(requirement, interval, &sets, &mut found, budget)?;
        }
        found.sort();
        Ok(found)
    }
}

/// The parts of a stable interval in which the loop is stable with each number of samples, by the sets of these.
fn stable_with_each(
    requirement: &Requirement,
    interval: &StableInterval,
    sets: &[StableSet],
    found: &mut RequiredSet,
    budget: &Budget,
) -> Result<(), Error> {
    let ends = sets.iter().flat_map(StableSet::intervals).flat_map(|i| [&i.lower, &i.upper]).flatten();
    let values = ascending(ends.map(|end| (end.value.clone(), false)).collect(), budget)?;
    let values: Vec<Real> = values.into_iter().map(|(value, _)| value).collect();
    let why = format!("where {} begins or ceases to be met", requirement.name());
    let open = |b: &UndecidedBracket| UndecidedBracket::new(b.lower.clone(), b.upper.clone(), why.as_str());
    let mut brackets: Vec<UndecidedBracket> = sets.iter().flat_map(StableSet::undecided).map(open).collect();
    brackets.sort_by(|a, b| (&a.lower, &a.upper).cmp(&(&b.lower, &b.upper)));
    let unmet = |value: &Rational| {
        let is_met = sets.iter().all(|set| set.contains(value));
        Ok(if is_met { Vec::new() } else { vec![requirement.name()] })
    };
    parts_beside(interval, brackets, found, |part| {
        let inside = inside_of(part, &values, budget)?;
        // A root is on the circle there.
        required_parts(part, &inside, unmet, |_, _| Ok(false), budget)
    })
}
