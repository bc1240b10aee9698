//! A loop in one parameter whose exponentials of matrices stay whole: enclosures are all that is known of the coefficients of its
//! characteristic polynomial.
//!
//! The matrix is `A + K B`. The rank of `B` bounds the degree of `D(z; K)` in `K`, so the polynomials at a few whole `K` have all
//! coefficients. `D(z; 0)` is the product of the polynomials of the parts that `A` decouples into. Parts that are rational, and the
//! roots at 1 that integrators bring, are exact factors: so `D(1; 0) = 0` is an identity where the loop drifts without feedback.

mod assembled;
mod at_one;
mod exact_zeros;
mod in_boxes;
mod nodes;
mod origin;
mod part;
mod quotient;
mod steady_state;

use super::{Bound, Problem, Region};
use crate::error::Error;
use crate::model::{ClosedLoop, InNumbers, Samples, beside, in_powers, quotient_at};
use crate::stability::{EnclosedLoop, Shape, SymbolicPolynomial};
pub(crate) use in_boxes::OpenedByValues;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use part::Part;
pub(super) use part::quotient;
pub(crate) use quotient::EnclosedQuotient;
use std::sync::Arc;
pub(super) use steady_state::steady_state;

/// Work that exact polynomials over the constants of a held loop may be before enclosures of coefficients are asked: a tenth of a second.
const WORK_BEFORE: u64 = 10_000_000;

/// The same of a loop with several rates, whose polynomials have many times the degree in the constants: at ten rates the drive takes 0.04 s by
/// enclosures and ten times as long by exact polynomials.
const WORK_BEFORE_AT_RATES: u64 = 1_000_000;

/// Work of an answer by enclosures, before exact polynomials are asked again.
const WORK_OF_ENCLOSURES: u64 = 2_000_000_000;

/// The degree in the parameter, over a hyperperiod, up to which polynomials are looked at.
const MOST_LIFTED_POWERS: usize = 64;

/// Bits with which parts without the parameter are counted, and all divisors are to be seen different from 0.
const BITS: u64 = 512;

impl Problem {
    /// The parts of the loop that the one free parameter acts on, with enclosed coefficients; an empty list where the others are stable
    /// and there is none. `None` where the loop is not of this form: where it is given by a polynomial, without holds, in a region
    /// with a free bound, or the parameter is inside of functions, in a divisor, or not linear in the matrix.
    ///
    /// Cost: ranks of matrices over symbols; enclosures of the matrix and of as many characteristic polynomials as the degree in the
    /// parameter.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    pub(crate) fn enclosed_parts(&self, budget: &Budget) -> Result<Option<EnclosedParts>, Error> {
        Ok(self.enclosed_with_order(budget)?.map(|(parts, _)| parts))
    }

    /// The whole loop with enclosed coefficients, where the parameter acts on all of it, or none is free; `None` as in [`Problem::enclosed_parts`].
    ///
    /// # Errors
    /// As [`Problem::enclosed_parts`].
    pub(crate) fn enclosed_whole(&self, budget: &Budget) -> Result<Option<SymbolicPolynomial>, Error> {
        if self.free().is_empty() {
            return self.enclosed_at_values(budget);
        }
        let Some((EnclosedParts::Parts(mut parts), order)) = self.enclosed_with_order(budget)? else { return Ok(None) };
        let whole = parts.pop().filter(|p| p.formal_degree() == order);
        Ok(whole.map(|p| match self.parameter().nominal.clone() {
            Some(usual) => p.with_usual_value(usual),
            None => p,
        }))
    }

    /// The whole loop where all names have values.
    fn enclosed_at_values(&self, budget: &Budget) -> Result<Option<SymbolicPolynomial>, Error> {
        let Region::Disc(Bound::Number(radius)) = self.region() else { return Ok(None) };
        let found = budget.enter(|| self.model().closed_loop_in_numbers(&[], self.set(), budget))??;
        let is_held = |found: &InNumbers| found.symbols.has_flows() && !found.closed_loop.is_complex;
        let Some(found) = found.filter(is_held) else { return Ok(None) };
        budget.step("coefficients by enclosures");
        Ok(budget.enter(|| {
            let ClosedLoop { a, poles, .. } = found.closed_loop;
            let values = found.symbols.enclosed(BITS)?;
            are_nonzero(poles.iter().chain(a.entries().iter().map(RationalFunction::denominator)), 0, &values)?;
            let nothing = RationalMatrix::zeros(a.rows(), a.rows());
            Some(Arc::new(Part::linear(&Arc::new(found.symbols), a, nothing)?).polynomial(radius))
        })?)
    }

    /// The parts, and the order of the loop.
    fn enclosed_with_order(&self, budget: &Budget) -> Result<Option<(EnclosedParts, usize)>, Error> {
        let [free] = self.free() else { return Ok(None) };
        let radius = match self.region() {
            Region::Disc(Bound::Number(radius)) => radius,
            _ => return Ok(None),
        };
        if !self.positive().is_empty() {
            return Ok(None);
        }
        if self.model().hyperperiod() > 1
            && radius.is_one()
            && let Some(found) = self.lifted_parts(&free.name, budget)?
        {
            return Ok(Some(found));
        }
        let kept = [free.name.clone()];
        let found = budget.enter(|| self.model().closed_loop_in_numbers(&kept, self.set(), budget))??;
        let Some(found) = found.filter(|found| found.symbols.has_flows()) else { return Ok(None) };
        budget.step("coefficients by enclosures");
        let order = found.closed_loop.a.rows();
        Ok(budget.enter(|| Some((EnclosedParts::of(&found, radius)?, order)))?)
    }
}

impl Problem {
    /// The same of a loop with several rates: the map over a hyperperiod at as many whole values
    /// of the parameter as the degree asks for, each by products of matrices of numbers. `None` where the degree is large.
    fn lifted_parts(&self, name: &str, budget: &Budget) -> Result<Option<(EnclosedParts, usize)>, Error> {
        let Some(samples) = self.model().samples_in(name, self.set(), budget)? else { return Ok(None) };
        let degree = samples.parts.iter().map(|part| part.degree).max().unwrap_or(0);
        if degree > MOST_LIFTED_POWERS || !samples.symbols.has_flows() {
            return Ok(None);
        }
        budget.step("coefficients by enclosures");
        // What is exact is read off the loop without the parameter.
        let given: Vec<_> = self.set().iter().cloned().chain([(name.to_owned(), Rational::ZERO)]).collect();
        match budget.enter(|| self.model().closed_loop_in_numbers(&[], &given, budget))? {
            Ok(Some(at_zero)) => {
                let order = at_zero.closed_loop.a.rows();
                let found = budget.enter(|| EnclosedParts::lifted(samples, at_zero, budget))??;
                Ok(found.map(|parts| (parts, order)))
            }
            Err(stopped @ Error::Stopped(_)) => Err(stopped),
            Ok(None) | Err(_) => Ok(None),
        }
    }
}

/// What is known of the parts of a loop.
pub(crate) enum EnclosedParts {
    /// A part without the parameter is not stable.
    Unstable,
    /// All parts without the parameter are stable; these are the others.
    Parts(Vec<SymbolicPolynomial>),
}

impl EnclosedParts {
    fn of(found: &InNumbers, radius: &Rational) -> Option<EnclosedParts> {
        let symbols = Arc::new(found.symbols.without_kept()?);
        let values = symbols.enclosed(BITS)?;
        let a = &found.closed_loop.a;
        let divisors = found.closed_loop.poles.iter().chain(a.entries().iter().map(RationalFunction::denominator));
        are_nonzero(divisors, 1, &values)?;
        let split = a.entries().iter().map(in_powers).collect::<Option<Vec<_>>>()?;
        let n = a.rows();
        let [constant, linear] = [0, 1].map(|k| RationalMatrix::from_fn(n, n, |i, j| split[i * n + j][k].clone()));
        let mut parts = Vec::new();
        for block in a.decoupled_parts() {
            let part = Part::linear(&symbols, constant.principal(&block), linear.principal(&block))?;
            if part.degree > 0 {
                parts.push(Arc::new(part).polynomial(radius));
                continue;
            }
            if !is_stable(&part, &values, radius)? {
                return Some(EnclosedParts::Unstable);
            }
        }
        Some(EnclosedParts::Parts(parts))
    }
}

impl EnclosedParts {
    /// From the samples, and the loop over a hyperperiod at `K = 0`. `None` where a divisor may be zero.
    fn lifted(samples: Samples, at_zero: InNumbers, budget: &Budget) -> Result<Option<EnclosedParts>, Exhausted> {
        let ClosedLoop { a, poles, .. } = &at_zero.closed_loop;
        let divisors = poles.iter().chain(a.entries().iter().map(RationalFunction::denominator));
        let in_samples = samples.patterns.iter().flatten().flat_map(RationalMatrix::entries);
        let in_samples = in_samples.map(RationalFunction::denominator);
        let [values, of_samples] = [&at_zero.symbols, &samples.symbols].map(|symbols| symbols.enclosed(BITS));
        let (Some(values), Some(of_samples)) = (values, of_samples) else { return Ok(None) };
        if are_nonzero(divisors, 0, &values).and(are_nonzero(in_samples, 0, &of_samples)).is_none() {
            return Ok(None);
        }
        let (symbols, samples) = (Arc::new(at_zero.symbols), Arc::new(samples));
        let mut found = Vec::new();
        for of in &samples.parts {
            let part = Part::lifted(&symbols, a.principal(&of.states), &samples, of, budget)?;
            if part.degree > 0 {
                let Some(end) = part.unstable_beyond(BITS) else { return Ok(None) };
                found.push(Arc::new(part).polynomial(&Rational::ONE).unstable_beyond(end));
                continue;
            }
            match is_stable(&part, &values, &Rational::ONE) {
                Some(true) => {}
                Some(false) => return Ok(Some(EnclosedParts::Unstable)),
                None => return Ok(None),
            }
        }
        Ok(Some(EnclosedParts::Parts(found)))
    }
}

/// Whether a part without the parameter is stable; `None` where that does not show.
fn is_stable(part: &Part, values: &[Ball], radius: &Rational) -> Option<bool> {
    if part.has_root_at_one() && *radius <= Rational::ONE {
        return Some(false);
    }
    let polynomial = in_disc(part.at_zero(values, BITS)?, radius);
    let count = EnclosedLoop::of(&polynomial, Shape::UnitDisc)?.count;
    Some(count.inside + 1 == polynomial.len())
}

/// `Some` if enclosures show that no divisor is zero. The first `kept` variables of a divisor are names, symbols follow.
fn are_nonzero<'p>(divisors: impl Iterator<Item = &'p MultiPoly>, kept: usize, values: &[Ball]) -> Option<()> {
    for divisor in divisors.filter(|p| !p.is_one()) {
        let value = quotient_at(&beside(&divisor.clone().into(), kept)?, values, BITS)?;
        value.sign().filter(|sign| !sign.is_eq())?;
    }
    Some(())
}

/// Asks exact polynomials first, within a share of the budget. Where their share of work, or the memory, runs out, it asks enclosures of the
/// coefficients. Where enclosures do not tell the answer, it asks exact polynomials with the whole budget.
///
/// # Errors
/// Those of the answers; [`Error::Stopped`] when the budget runs out.
pub(crate) fn exact_or_enclosed<T>(
    budget: &Budget,
    exact: impl Fn(&Budget) -> Result<T, Error>,
    enclosed: impl FnOnce(&Budget) -> Result<Option<T>, Error>,
) -> Result<T, Error> {
    exact_within(WORK_BEFORE, budget, exact, enclosed)
}

impl Problem {
    /// The same for this loop: less work goes into exact polynomials where it has several rates.
    ///
    /// # Errors
    /// As [`exact_or_enclosed`].
    pub(crate) fn exact_or_enclosed<T>(
        &self,
        budget: &Budget,
        exact: impl Fn(&Budget) -> Result<T, Error>,
        enclosed: impl FnOnce(&Budget) -> Result<Option<T>, Error>,
    ) -> Result<T, Error> {
        let work = if self.model().hyperperiod() > 1 { WORK_BEFORE_AT_RATES } else { WORK_BEFORE };
        exact_within(work, budget, exact, enclosed)
    }
}

fn exact_within<T>(
    work: u64,
    budget: &Budget,
    exact: impl Fn(&Budget) -> Result<T, Error>,
    enclosed: impl FnOnce(&Budget) -> Result<Option<T>, Error>,
) -> Result<T, Error> {
    match exact(&budget.clone().within_work(work)) {
        // Only the share of this attempt is used up, and the memory that it took is free again.
        Err(Error::Stopped(stopped)) if is_too_long(&stopped) && budget.check().is_ok() => {}
        answer => return answer,
    }
    enclosed_or_exact(budget, enclosed, exact)
}

/// The same where exact polynomials are known to be long.
///
/// # Errors
/// As [`exact_or_enclosed`].
pub(crate) fn enclosed_or_exact<T>(
    budget: &Budget,
    enclosed: impl FnOnce(&Budget) -> Result<Option<T>, Error>,
    exact: impl Fn(&Budget) -> Result<T, Error>,
) -> Result<T, Error> {
    match enclosed(&budget.clone().within_work(WORK_OF_ENCLOSURES)) {
        Ok(Some(answer)) => return Ok(answer),
        Ok(None) => {}
        Err(Error::Stopped(stopped)) if stopped.stop.is_precision() => {}
        Err(Error::Stopped(stopped)) if is_too_long(&stopped) && budget.check().is_ok() => {}
        // What enclosures refuse, such as a dead time that moves within a sample, exact polynomials may answer.
        Err(Error::Refused(_)) => {}
        Err(error) => return Err(error),
    }
    exact(budget)
}

/// True if work or memory ran out, not time.
fn is_too_long(stopped: &Exhausted) -> bool {
    matches!(stopped.stop, Stop::Work(_) | Stop::Memory(_))
}

/// `D(r z)`.
fn in_disc(polynomial: Vec<Ball>, radius: &Rational) -> Vec<Ball> {
    let power = |(k, c): (usize, Ball)| {
        let bits = c.bits();
        c.mul(&Ball::from_rational(radius, bits).power(k as u64))
    };
    polynomial.into_iter().enumerate().map(power).collect()
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_boxes;
#[cfg(test)]
mod tests_rates;
