//! The exact stable set of one parameter.

use super::{Answer, Verdict};
use crate::error::Error;
use crate::problem::{Ask, EnclosedParts, Problem, Question, Region, enclosed_or_exact};
use crate::stability::boxes::open_parts;
use crate::stability::{Cause, End, Range, StableSet, UndecidedBracket, stable_set, stable_set_of_parts};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// A parameter without bounds is looked at by values so many octaves below and above its nominal value.
const OCTAVES_BELOW: i64 = 4;
const OCTAVES_ABOVE: i64 = 3;

/// Work of exact polynomials where values leave something open: less than a second.
const WORK_OF_EXACT: u64 = 60_000_000;

/// Why values beside these octaves are not looked at.
const NOT_LOOKED_AT: &str =
    "not looked at, as of so long a loop nothing but values is known: give bounds of the domain";

impl Question {
    /// For which values of the one free parameter the loop is stable, all others at their set or nominal values.
    ///
    /// Cost: that of [`Problem::stable_set`].
    ///
    /// ```
    /// use jurist_algebra::limits::{Budget, Stop};
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
    /// let lower = answer.value().intervals()[0].lower.as_ref().unwrap();
    /// assert_eq!(lower.value.decimal(10), "0.03810053335");
    /// ```
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`], or stopped.
    ///
    /// # Panics
    /// Unless one name is free.
    pub fn stable_set(self, budget: &Budget) -> Result<Answer<StableSet>, Error> {
        Problem::stable_set(&self.problem()?, budget)
    }
}

impl Problem {
    /// The exact stable set of the one free parameter. A loop that is undefined for all values is stable nowhere.
    ///
    /// Cost: that of [`Problem::algebra`], once, and of [`stable_set`](crate::stability::stable_set).
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] as [`Problem::symbolic`].
    ///
    /// # Panics
    /// Unless one parameter is free.
    pub fn stable_set(self: &Arc<Self>, budget: &Budget) -> Result<Answer<StableSet>, Error> {
        let mut answer = self.stable_set_inside(budget)?;
        for end in self.parameter().closed_ends() {
            if self.is_stable_at(end, budget)? {
                let set = std::mem::take(&mut answer.value);
                answer.value = set.with_value(End::new(end.clone(), Cause::Domain.into(), None));
            }
        }
        let free = self.parameter();
        for (bound, _) in [&free.domain.lower, &free.domain.upper].into_iter().zip(free.is_duty).filter(|(_, is)| *is) {
            let is_there = |end: &&mut End| end.causes.contains(Cause::Domain) && end.value.exact() == *bound;
            for end in answer.value.ends_mut().filter(is_there) {
                end.causes.remove(Cause::Domain);
                end.causes.insert(Cause::Duty);
            }
        }
        Ok(answer)
    }

    /// Whether the loop is stable at a value of the one free parameter; it is not where it is undefined or has no meaning.
    fn is_stable_at(&self, value: &Rational, budget: &Budget) -> Result<bool, Error> {
        let question = self.model().ask().set_all(self.set().iter().cloned()).within(self.region().clone());
        let problem = match question.set(&self.parameter().name, value.clone()).problem() {
            Ok(problem) => problem,
            Err(Error::Refused(_) | Error::Undefined(_)) => return Ok(false),
            Err(stopped) => return Err(stopped),
        };
        match problem.verdict(budget) {
            Ok(verdict) => Ok(verdict.value().verdict == Verdict::Stable),
            Err(Error::Refused(_) | Error::Undefined(_)) => Ok(false),
            Err(stopped) => Err(stopped),
        }
    }

    /// The stable set inside of the domain.
    fn stable_set_inside(self: &Arc<Self>, budget: &Budget) -> Result<Answer<StableSet>, Error> {
        let answer = self.stable_set_by_boundaries(budget)?;
        Ok(Answer { value: self.with_sides(answer.value, budget)?, problem: answer.problem })
    }

    /// The same, ends named by the boundary functions.
    fn stable_set_by_boundaries(self: &Arc<Self>, budget: &Budget) -> Result<Answer<StableSet>, Error> {
        budget.enter(|| {
            if !self.model().has_holds() {
                return self.stable_set_by_algebra(budget);
            }
            let exact = |budget: &Budget| self.stable_set_by_algebra(budget);
            let enclosed = |budget: &Budget| {
                let set = self.stable_set_by_enclosures(budget)?;
                Ok(set.map(|set| Answer::new(Arc::clone(self), set)))
            };
            // Exact polynomials that were seen to be long are not tried twice.
            if self.is_long(budget)? {
                enclosed_or_exact(budget, enclosed, exact)
            } else {
                self.exact_or_enclosed(budget, exact, enclosed)
            }
        })?
    }

    /// The stable set of a loop behind holds from enclosures of its coefficients; `None` where the loop is not of that form.
    fn stable_set_by_enclosures(self: &Arc<Self>, budget: &Budget) -> Result<Option<StableSet>, Error> {
        let parts = match self.enclosed_parts(budget)? {
            Some(EnclosedParts::Parts(parts)) => parts,
            Some(EnclosedParts::Unstable) => return Ok(Some(StableSet::from_intervals(Vec::new(), Vec::new()))),
            None => return self.stable_set_by_values(budget),
        };
        Ok(Some(stable_set_of_parts(&parts, &self.parameter().domain, self.shape(), budget)?))
    }

    /// The same where the parameter is inside of functions: its values are all that is known of the coefficients.
    ///
    /// Boxes of one side show where no root comes to the boundary, and its functions have their zeros in what is left.
    fn stable_set_by_values(self: &Arc<Self>, budget: &Budget) -> Result<Option<StableSet>, Error> {
        let of = self.in_boxes(budget)?;
        if Arc::ptr_eq(self, &of) {
            return Ok(None);
        }
        let (Some(p), Some(family)) = (of.symbolic(budget)?, of.moving_family(budget)?) else { return Ok(None) };
        let domain = &self.parameter().domain;
        let Some([from, to]) = self.bounds_of_values() else { return Ok(None) };
        let open = open_parts(&family, [&from, &to], budget)?;
        let range = Range::between(Some(from.clone()), Some(to.clone()));
        let found = stable_set_of_parts(&[p.with_open_parts(open)], &range, self.shape(), budget)?;
        let is_whole = domain.lower.as_ref() == Some(&from) && domain.upper.as_ref() == Some(&to);
        if is_whole && found.undecided().is_empty() {
            return Ok(Some(found));
        }
        // What values do not tell exact polynomials may.
        match self.stable_set_by_algebra(&budget.clone().within_work(WORK_OF_EXACT)) {
            Ok(answer) => return Ok(Some(answer.into_value())),
            Err(Error::Stopped(stopped)) if !stopped.stop.is_precision() && budget.check().is_ok() => {}
            Err(error) => return Err(error),
        }
        let nothing = || StableSet::from_intervals(Vec::new(), Vec::new());
        let beside = |lower: Option<Rational>, upper: Option<Rational>| {
            let is_empty = lower == upper && lower.is_some();
            let part = (!is_empty).then(|| UndecidedBracket::new(lower, upper, NOT_LOOKED_AT));
            StableSet::from_intervals(Vec::new(), part.into_iter().collect())
        };
        let before =
            if domain.lower.as_ref() == Some(&from) { nothing() } else { beside(domain.lower.clone(), Some(from)) };
        let after = if domain.upper.as_ref() == Some(&to) { nothing() } else { beside(Some(to), domain.upper.clone()) };
        Ok(Some(before.followed_by(found, None).followed_by(after, None)))
    }

    /// The interval in which values of functions decide: the domain of the parameter, or some octaves around its nominal value. An end at 0 is left out:
    /// roots may come together there, as they do at a sample time of 0, and values do not tell how. `None` where there is no such interval.
    fn bounds_of_values(&self) -> Option<[Rational; 2]> {
        let free = self.parameter();
        let near = |bits: i64| {
            let scale = free.nominal.clone().filter(|x| x.sign().is_gt())?;
            Some(&scale * &Rational::from(2).pow(bits)?)
        };
        let is_bound = |x: &&Rational| !x.is_zero();
        let lower = free.domain.lower.as_ref().filter(is_bound).cloned();
        let upper = free.domain.upper.as_ref().filter(is_bound).cloned();
        let to = upper.or_else(|| near(OCTAVES_ABOVE))?;
        let from = lower.or_else(|| near(-OCTAVES_BELOW))?;
        (from < to).then_some([from, to])
    }

    /// The stable set by exact polynomials.
    fn stable_set_by_algebra(self: &Arc<Self>, budget: &Budget) -> Result<Answer<StableSet>, Error> {
        budget.enter(|| {
            if let Err(refused @ Error::Refused(_)) = self.algebra_over_symbols(budget) {
                // A dead time may vary against its sample time.
                return match self.stable_set_by_samples(budget) {
                    Ok(Some(set)) => Ok(Answer::new(Arc::clone(self), set)),
                    Err(Error::Stopped(stopped)) => Err(Error::Stopped(stopped)),
                    _ => Err(refused),
                };
            }
            if let Some(delayed) = self.delayed_functions(budget)? {
                let set = super::dead_time::stable_set_beside_functions(self.parameter(), &delayed, budget)?;
                return Ok(Answer::new(Arc::clone(self), set));
            }
            if let Some(delayed) = self.delayed(budget)? {
                let set = match self.stable_set_of_complex_gain(delayed, budget)? {
                    Some(set) => set,
                    None => super::dead_time::stable_set_with_dead_time(self.parameter(), delayed, budget)?,
                };
                return Ok(Answer::new(Arc::clone(self), set));
            }
            if !self.algebra_over_symbols(budget)?.symbols().is_empty() {
                let domain = &self.parameter().domain;
                let set = match self.symbolic(budget)? {
                    None => StableSet::from_intervals(Vec::new(), Vec::new()),
                    Some(p) => {
                        let parts = self.in_parts(&p, self.algebra_over_symbols(budget)?, budget)?;
                        stable_set_of_parts(&parts, domain, self.shape(), budget)?
                    }
                };
                return Ok(Answer::new(Arc::clone(self), own_causes(set, self)));
            }
            let set = match self.parametric(budget)? {
                None => StableSet::default(),
                Some(p) => own_causes(stable_set(p, &self.parameter().domain, self.shape(), budget)?, self),
            };
            Ok(Answer::new(Arc::clone(self), set))
        })?
    }
}

/// `D(r z)` is a constant at `r = 0`: that is of the substitution's making, no root of the loop is lost.
fn own_causes(mut set: StableSet, problem: &Problem) -> StableSet {
    if problem.region().is_free() && matches!(problem.region(), Region::Disc(_)) {
        for end in set.ends_mut().filter(|end| end.value.sign().is_eq()) {
            end.causes.remove(Cause::DegreeLost);
        }
    }
    set
}

#[cfg(test)]
mod tests;
