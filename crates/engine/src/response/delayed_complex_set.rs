//! For which values of one parameter a complex loop with dead time meets requirements on margins.

use super::candidates::Candidates;
use super::cells::{around, edge, outward};
use super::delayed_affine::DelayedAffine;
use super::enclosed::{greater, within};
use super::open_loop::OpenLoop;
use super::opened::OpenedLoop;
use super::over_symbols::{left_open, where_changed};
use super::requirement::Requirement;
use super::{RequiredEnd, RequiredInterval, RequiredSet};
use crate::coverage::refusals::COMPLEX_REQUIRED_WITH_DELAY;
use crate::error::Error;
use crate::model::Cut;
use crate::problem::Problem;
use crate::stability::{StableSet, UndecidedBracket};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::real::Real;
use std::sync::Arc;

/// Values count as one where their enclosures with so many bits overlap, as those that a real loop has at two frequencies where it is seen from a frame.
const BITS: u64 = 256;

/// Several values that enclosures do not tell apart: the least and the greatest of them.
struct Tie {
    least: Real,
    greatest: Real,
}

impl Problem {
    /// The parts of the stable set in which requirements on margins at one cut are met.
    ///
    /// # Errors
    /// `E-complex` where the open loop is no quotient `N/D exp(-tau s)` with the parameter to the first power in `N` and `D`; [`Error::Stopped`].
    pub(super) fn required_of_delayed_complex(
        self: &Arc<Self>,
        requirements: &[Requirement],
        stable: &StableSet,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        let refused = || Error::from(COMPLEX_REQUIRED_WITH_DELAY.diagnostic(&[]));
        let cut = requirements[0].cut(self, at)?;
        let opened = OpenedLoop::of(self, cut.clone(), budget)?;
        let (quotient, _) = opened.any_quotient(MultiPoly::clone, budget)?;
        let family = match budget.enter(|| DelayedAffine::of(&quotient, &opened.symbols))? {
            Ok(Some(family)) => family,
            Ok(None) | Err(Error::Refused(_)) => return Err(refused()),
            Err(stopped) => return Err(stopped),
        };
        budget.step("boundaries of the requirements");
        let mut found = RequiredSet { undecided: stable.undecided().to_vec(), ..RequiredSet::default() };
        for interval in stable.intervals() {
            let [Some(lower), Some(upper)] = [outward(&interval.lower, true), outward(&interval.upper, false)] else {
                found.undecided.push(left_open(interval, requirements));
                continue;
            };
            let most = lower.abs().max(upper.abs());
            let (mut candidates, mut ties) = (Candidates::default(), Vec::new());
            for requirement in requirements {
                let values = match family.values(requirement.rule(), &most, budget) {
                    // At frequencies that enclosures do not tell apart.
                    Err(stopped) if stopped.stop.is_precision() && budget.check().is_ok() => {
                        let [lower, upper] = [&lower, &upper].map(|end| Some(end.clone()));
                        candidates.add(requirement, interval, (Vec::new(), vec![(lower, upper)]), budget)?;
                        continue;
                    }
                    values => values?.ok_or_else(refused)?,
                };
                let (values, own) = budget.enter(|| merged(values))?;
                ties.extend(own);
                candidates.add(requirement, interval, (values, Vec::new()), budget)?;
            }
            let unmet = |value: &Rational| self.unmet_at(value, (&cut, &family), requirements, budget);
            let mut parts = RequiredSet::default();
            super::cells::parts_beside(interval, candidates.brackets(), &mut parts, |part| {
                candidates.cells(part, requirements, unmet, budget)
            })?;
            found.undecided.append(&mut parts.undecided);
            for part in parts.intervals {
                beside_ties(part, &ties, requirements, &mut found);
            }
        }
        found.sort();
        Ok(found)
    }

    /// The names of what is not met at a stable value.
    fn unmet_at(
        &self,
        value: &Rational,
        (cut, family): (&Cut, &DelayedAffine),
        requirements: &[Requirement],
        budget: &Budget,
    ) -> Result<Vec<&'static str>, Error> {
        let problem = self.with_value(value);
        let open_loop = OpenLoop::of_cut(&problem, cut.clone(), budget)?;
        let mut unmet = Vec::new();
        for requirement in requirements {
            let is_met = match family.keeps_to(requirement.rule(), value, budget) {
                Ok(Some(is_met)) => is_met,
                Err(stopped) if !stopped.stop.is_precision() => return Err(stopped.into()),
                _ => problem.has_margin(&open_loop, requirement, budget)?,
            };
            if !is_met {
                unmet.push(requirement.name());
            }
        }
        Ok(unmet)
    }
}

/// Values with those as one that enclosures do not tell apart: the least of them.
fn merged(values: Vec<(Real, bool)>) -> (Vec<(Real, bool)>, Vec<Tie>) {
    let mut all: Vec<_> = values.into_iter().map(|(value, touches)| (within(&value, BITS), value, touches)).collect();
    all.sort_by(|a, b| a.0.lower().cmp(b.0.lower()));
    let (mut out, mut ties): (Vec<(Real, bool)>, Vec<Tie>) = (Vec::new(), Vec::new());
    let mut reach: Option<Rational> = None;
    for (enclosure, value, touches) in all {
        match out.last_mut().filter(|_| reach.as_ref().is_some_and(|reach| reach >= enclosure.lower())) {
            Some((least, known)) => {
                let before = match ties.last() {
                    Some(tie) if tie.least.is_same(least) => ties.pop().expect("it is there"),
                    _ => Tie { least: least.clone(), greatest: least.clone() },
                };
                let greatest = greater(before.greatest, value.clone());
                *least = greater(least.negated(), value.negated()).negated();
                *known |= touches;
                ties.push(Tie { least: least.clone(), greatest });
            }
            None => out.push((value, touches)),
        }
        reach = Some(reach.map_or(enclosure.upper().clone(), |reach| reach.max(enclosure.upper().clone())));
    }
    (out, ties)
}

/// A part that begins at several values begins at the greatest of them. Between them nothing is told.
fn beside_ties(mut part: RequiredInterval, ties: &[Tie], requirements: &[Requirement], found: &mut RequiredSet) {
    for tie in ties {
        if let Some(RequiredEnd::Requirement { value, .. }) = &mut part.lower
            && value.is_same(&tie.least)
        {
            *value = tie.greatest.clone();
        }
        let is_end = |end: &Option<RequiredEnd>, other: &Real| end.as_ref().is_some_and(|e| e.value().is_same(other));
        if is_end(&part.lower, &tie.greatest) || is_end(&part.upper, &tie.least) {
            continue;
        }
        let (Some(low), Some(high)) = around(&tie.least) else { continue };
        let is_above = part.lower.as_ref().is_none_or(|end| end.value().compare_rational(&low).is_lt());
        let is_below = part.upper.as_ref().is_none_or(|end| end.value().compare_rational(&high).is_gt());
        if is_above && is_below {
            let [lower, upper] = [&low, &high].map(|x| Some(RequiredEnd::Stability(edge(x))));
            found.intervals.push(RequiredInterval { lower: part.lower.take(), upper: lower });
            found.undecided.push(UndecidedBracket::new(Some(low), Some(high), where_changed(requirements)));
            part.lower = upper;
        }
    }
    found.intervals.push(part);
}
