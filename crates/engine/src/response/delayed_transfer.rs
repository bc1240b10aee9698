//! Transfer functions with dead time in more than a factor of the numerator.

use super::complex_poly::ComplexPoly;
use super::delayed_factors::DelayedFactors;
use super::delayed_peak::{DelayedQuotient, frequencies_of};
use super::ground::{Constants, Integers};
use super::parts::without_denominators;
use super::{Extreme, Frequencies};
use crate::error::Error;
use crate::model::Symbols;
use crate::problem::{BaseDelay, base_delay};
use crate::stability::dead_time::FamilyLoop;
use crate::stability::{Range, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};

/// Two polynomials in `s` and `exp(-tau s)`: the coefficients of `exp(-tau s)^k` at `[k]`, polynomials in constants.
pub(super) struct DelayedTransfer {
    tau: Rational,
    parts: [Vec<ComplexPoly<MultiPoly>>; 2],
    ground: Constants,
}

impl DelayedTransfer {
    /// From the real and the imaginary parts of the coefficients of powers of `s`, those of the denominator first, in which symbols are constants and
    /// exponentials of dead times.
    ///
    /// # Errors
    /// [`Error::Refused`] for dead times that are not multiples of one.
    pub fn new(lists: [Vec<RationalFunction>; 4], symbols: &Symbols) -> Result<DelayedTransfer, Error> {
        let delays = symbols.delays();
        let (BaseDelay::Number(tau), powers) = base_delay(&delays)? else { unreachable!("no name is free") };
        let multiple = |variable: usize| {
            delays.iter().position(|(v, _)| *v - symbols.first() == variable).map_or(0, |i| powers[i])
        };
        let [below_re, below_im, re, im] = without_denominators(lists).map(|p| by_powers(&p, multiple));
        let parts = [joined(below_re, below_im), joined(re, im)];
        Ok(DelayedTransfer { tau, parts, ground: Constants::beside_delays(symbols)? })
    }

    /// The frequencies that are looked at.
    pub fn frequencies(&self) -> Frequencies {
        frequencies_of(self.parts.iter().flatten())
    }

    /// The factors `k` in a range for which the denominator plus `k` times the numerator is stable, as [`DelayedFactors::stable_set`]; `None` where the numerator has
    /// more than one power of the exponential. The family is that sum.
    ///
    /// # Errors
    /// As [`DelayedFactors::stable_set`].
    pub fn stable_factors(
        &self,
        family: FamilyLoop,
        range: &Range,
        poles: &[UniPoly],
        budget: &Budget,
    ) -> Result<Option<StableSet>, Error> {
        let is_first = |parts: &[ComplexPoly<MultiPoly>]| parts.first().is_some_and(|p| !p.is_zero());
        let powers: Vec<usize> = (0..self.parts[1].len()).filter(|&k| !self.parts[1][k].is_zero()).collect();
        let [power] = powers[..] else { return Ok(None) };
        if !is_first(&self.parts[0]) {
            return Ok(None);
        }
        let tau = || self.tau.clone();
        let found = match self.in_numbers() {
            Some([open, mut back]) => {
                let back = (back.swap_remove(power), power);
                DelayedFactors::new(&Integers, tau(), open, back, family).stable_set(range, poles, budget)
            }
            None => {
                let [open, back] = &self.parts;
                let back = (back[power].clone(), power);
                DelayedFactors::new(&self.ground, tau(), open.clone(), back, family).stable_set(range, poles, budget)
            }
        };
        found.map(Some)
    }

    /// The parts where all coefficients are numbers.
    fn in_numbers(&self) -> Option<[Vec<ComplexPoly<Integer>>; 2]> {
        let number = |c: &MultiPoly| c.as_constant();
        let numbers = |p: &Poly<MultiPoly>| p.coeffs().iter().map(number).collect::<Option<_>>().map(Poly::new);
        let both = |p: &ComplexPoly<MultiPoly>| Some(ComplexPoly { re: numbers(&p.re)?, im: numbers(&p.im)? });
        let all = |parts: &Vec<ComplexPoly<MultiPoly>>| parts.iter().map(both).collect::<Option<Vec<_>>>();
        Some([all(&self.parts[0])?, all(&self.parts[1])?])
    }

    /// The extreme of the square of the modulus, as [`DelayedQuotient::peak`].
    ///
    /// # Errors
    /// As [`DelayedQuotient::peak`].
    pub fn peak(&self, budget: &Budget) -> Result<Extreme, Exhausted> {
        let [below, above] = &self.parts;
        match self.in_numbers() {
            Some([below, above]) => DelayedQuotient::new(&Integers, self.tau.clone(), above, below).peak(budget),
            None => DelayedQuotient::new(&self.ground, self.tau.clone(), above.clone(), below.clone()).peak(budget),
        }
    }
}

/// Real and imaginary parts as complex polynomials.
fn joined<R: Domain>(mut re: Vec<Poly<R>>, mut im: Vec<Poly<R>>) -> Vec<ComplexPoly<R>> {
    let count = re.len().max(im.len());
    re.resize_with(count, Poly::zero);
    im.resize_with(count, Poly::zero);
    re.into_iter().zip(im).map(|(re, im)| ComplexPoly { re, im }).collect()
}

/// The coefficients of each power of `exp(-tau s)`; `multiple` is the power that a variable stands for.
fn by_powers(p: &Poly<MultiPoly>, multiple: impl Fn(usize) -> usize) -> Vec<Poly<MultiPoly>> {
    let mut parts = vec![Poly::zero()];
    for (j, c) in p.coeffs().iter().enumerate() {
        for (monomial, c) in c.terms() {
            let (mut k, mut own) = (0, monomial.exponents().to_vec());
            for (variable, e) in own.iter_mut().enumerate().filter(|(variable, _)| multiple(*variable) > 0) {
                k += multiple(variable) * std::mem::take(e) as usize;
            }
            while parts.len() <= k {
                parts.push(Poly::zero());
            }
            let term = MultiPoly::from_terms([(own, c.clone())]);
            parts[k] = parts[k].plus(&Poly::monomial(term, j));
        }
    }
    parts
}
