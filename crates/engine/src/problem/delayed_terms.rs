//! The characteristic function of a loop with dead time in several parameters, sorted by its dead times.

use super::beside_dead_time::{Constants, refused_in_delay};
use super::delayed::cleared;
use super::resolved::Problem;
use crate::coverage::refusals::DECAY;
use crate::error::Error;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use std::borrow::Cow;

/// Dead times with the coefficients of the powers of `s`, and what must not vanish.
pub(super) struct DelayedTerms<T> {
    pub terms: Vec<(T, Vec<MultiPoly>)>,
    pub poles: Vec<MultiPoly>,
}

/// A characteristic polynomial over delays.
pub(super) struct OverDelays<'a> {
    /// In the free names, the constants, and the delays.
    pub polynomial: Cow<'a, CharacteristicPolynomial>,
    /// The variables that stand for delays, with the dead times.
    pub delays: Vec<(usize, RationalFunction)>,
    /// Bounds of the constants that are not rational.
    pub constants: Vec<[Rational; 2]>,
}

impl Problem {
    /// The characteristic polynomial of a loop with dead time; `None` for any other loop, and where it is undefined for all values.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for a decay rate, which cannot be asked of `what`, and for functions of a free name
    /// beside dead time.
    pub(super) fn over_delays(&self, what: &str, budget: &Budget) -> Result<Option<OverDelays<'_>>, Error> {
        let found = self.over_delays_in_region(budget)?;
        if found.is_some() && self.region().bound() != super::Region::of(self.time()).bound() {
            return Err(DECAY.diagnostic(&[("what", what)]).into());
        }
        Ok(found)
    }

    /// The same whatever decay rate is asked for: powers of `s` are counted from there, and a delay has one more factor, `exp(decay tau)`.
    ///
    /// # Errors
    /// As [`Problem::over_delays`], but for the decay rate.
    pub(super) fn over_delays_in_region(&self, budget: &Budget) -> Result<Option<OverDelays<'_>>, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let symbols = algebra.symbols();
        let delays = symbols.delays();
        let Some(polynomial) = algebra.polynomial().filter(|_| !delays.is_empty()) else { return Ok(None) };
        let constants = Constants::of(symbols, 0)?;
        if constants.are_in(&delays, 0) {
            return Err(refused_in_delay());
        }
        if constants.is_empty() {
            return Ok(Some(OverDelays { polynomial: Cow::Borrowed(polynomial), delays, constants: Vec::new() }));
        }
        budget.enter(|| {
            let place = |variable: usize| constants.place(variable, symbols.first(), &delays);
            let moved = |f: &RationalFunction| f.map_variables(place).expect("variables stay apart");
            let polynomial = CharacteristicPolynomial {
                coefficients: polynomial.coefficients.iter().map(moved).collect(),
                poles: polynomial.poles.iter().map(|p| p.map_variables(place)).collect(),
                ..polynomial.clone()
            };
            let delays = delays.iter().map(|(variable, time)| (place(*variable), moved(time))).collect();
            Ok(Some(OverDelays { polynomial: Cow::Owned(polynomial), delays, constants: constants.bounds() }))
        })?
    }
}

impl<T: Clone + Default + PartialEq> DelayedTerms<T> {
    /// Sorts the terms of a polynomial in so many parameters; `time_of` is the dead time of a variable that stands for a delay, and
    /// `add` adds one so many times to a sum.
    ///
    /// # Errors
    /// `E-dead-time` where the loop divides by a delay.
    pub fn of<'t>(
        polynomial: &CharacteristicPolynomial,
        parameters: usize,
        time_of: impl Fn(usize) -> Option<&'t T>,
        add: impl Fn(&mut T, &T, u32),
    ) -> Result<DelayedTerms<T>, Error>
    where
        T: 't,
    {
        let (scaled, common) = cleared(&polynomial.coefficients, |v| time_of(v).is_some())?;
        let mut terms: Vec<(T, Vec<MultiPoly>)> = Vec::new();
        for (j, f) in scaled.iter().enumerate() {
            for (monomial, c) in f.numerator().terms() {
                let mut total = T::default();
                let mut own = vec![0u32; parameters];
                for (variable, &e) in monomial.exponents().iter().enumerate().filter(|(_, e)| **e > 0) {
                    match time_of(variable) {
                        Some(time) => add(&mut total, time, e),
                        None => own[variable] += e,
                    }
                }
                let at = terms.iter().position(|(time, _)| *time == total).unwrap_or_else(|| {
                    terms.push((total, vec![MultiPoly::zero(); scaled.len()]));
                    terms.len() - 1
                });
                terms[at].1[j] = terms[at].1[j].plus(&MultiPoly::from_terms([(own, c.clone())]));
            }
        }
        // What contains a delay is an operator, and has no zeros among the parameters.
        let is_pole = |p: &&MultiPoly| !p.is_constant() && p.variables().iter().all(|v| *v < parameters);
        let mut poles: Vec<MultiPoly> = polynomial.poles.iter().filter(is_pole).cloned().collect();
        poles.extend((!common.is_constant()).then_some(common));
        Ok(DelayedTerms { terms, poles })
    }
}

/// Adds a dead time some times to a sum.
pub(super) fn add_times(sum: &mut RationalFunction, time: &RationalFunction, times: u32) {
    *sum = &*sum + &(time * &RationalFunction::from(Rational::from(i64::from(times))));
}
