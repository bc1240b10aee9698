//! Taylor models on parts of their polydisc.

use super::super::solutions::Scaled;
use super::super::{Along, Ball, Elementary, Enclosed};
use super::{MultiTaylorModel, middle_and_radius};
use crate::number::{Integer, Rational};

impl MultiTaylorModel {
    /// The middle and the reach of a model that is a line but for rounding; `None` of any other function.
    pub fn as_line(&self) -> Option<(Rational, Rational)> {
        let last = self.monomials.starts.get(2).copied().unwrap_or(self.coefficients.len());
        let is_line = self.coefficients[last.min(self.coefficients.len())..].iter().all(Integer::is_zero);
        let number = |units: &Integer| Rational::dyadic(units, self.bits);
        is_line.then(|| (number(&self.coefficients[0]), number(&self.around())))
    }

    /// The line in one variable that the polynomial is.
    pub(super) fn in_one_variable(&self) -> Option<Along> {
        let mut others = (1..self.coefficients.len()).filter(|&k| !self.coefficients[k].is_zero());
        let place = others.next();
        let is_line = others.next().is_none() && place.is_none_or(|k| k < self.monomials.starts[2]);
        let exactly = |c: &Integer| Ball::from_units(c.clone(), c.clone(), self.bits);
        is_line.then(|| Along {
            first: exactly(&self.coefficients[0]),
            slope: place.map_or_else(|| Ball::zero(self.bits), |k| exactly(&self.coefficients[k])),
            variable: place.map(|k| k - 1),
            terms: self.monomials.degree + 1,
            rest: self.rest.clone(),
        })
    }

    /// The sum of coefficients times powers of one variable; powers beyond the degree are left out.
    pub(super) fn with_powers(&self, variable: Option<usize>, coefficients: &[Ball]) -> MultiTaylorModel {
        let mut out = self.nothing();
        for (place, exponents) in self.monomials.exponents.iter().enumerate() {
            let power: u32 = exponents.iter().sum();
            let is_own = power == 0 || variable.is_some_and(|i| exponents[i] == power);
            if let Some(c) = coefficients.get(power as usize).filter(|_| is_own) {
                let (middle, radius) = middle_and_radius(c);
                out.coefficients[place] = middle;
                out.rest += &radius;
            }
        }
        for c in coefficients.iter().skip(self.monomials.degree + 1) {
            out.rest += &c.magnitude_units();
        }
        out
    }

    /// The same function of lines within the polydisc, which may be in other variables.
    ///
    /// Cost: as many products with a line as there are coefficients.
    ///
    /// # Panics
    /// Unless there is a line for each variable, with the bits of this function.
    pub fn along(&self, lines: &[MultiTaylorModel]) -> MultiTaylorModel {
        let terms: Vec<(&[u32], &Integer)> = self.terms().filter(|(_, c)| !c.is_zero()).collect();
        let mut out = horner(&terms, lines, &lines[0]);
        // What is left out is no larger there.
        out.rest += &self.rest;
        out
    }

    /// The value where each coordinate is -1, 0 or 1.
    pub fn at_corner(&self, coordinates: &[i8]) -> Ball {
        let sum = self.terms().fold(Integer::ZERO, |sum, (e, c)| {
            let mut powers = coordinates.iter().zip(e).filter(|(_, e)| **e > 0);
            match powers.clone().any(|(u, _)| *u == 0) {
                true => sum,
                false if powers.by_ref().filter(|(u, e)| **u < 0 && **e % 2 == 1).count() % 2 == 1 => sum - c,
                false => sum + c,
            }
        });
        Ball::from_units(&sum - &self.rest, &sum + &self.rest, self.bits)
    }

    /// With other bits after the point.
    pub fn with_bits(&self, bits: u64) -> MultiTaylorModel {
        self.rescaled(bits, 0)
    }

    /// The number of bits after the point.
    pub fn value_bits(&self) -> u64 {
        self.bits
    }

    /// The difference from a number.
    pub fn less(&self, number: &Ball) -> MultiTaylorModel {
        self.sub(&self.constant(number))
    }

    /// Times a power of two.
    pub fn shifted(&self, exponent: i64) -> MultiTaylorModel {
        self.rescaled(self.bits, exponent)
    }
}

/// The sum of terms in the first so many lines.
fn horner(terms: &[(&[u32], &Integer)], lines: &[MultiTaylorModel], like: &MultiTaylorModel) -> MultiTaylorModel {
    let Some((last, others)) = lines.split_last() else {
        let sum = terms.iter().fold(Integer::ZERO, |sum, (_, c)| sum + *c);
        return like.constant(&Ball::from_units(sum.clone(), sum, like.bits));
    };
    let power = |e: &[u32]| e[others.len()];
    let highest = terms.iter().map(|(e, _)| power(e)).max().unwrap_or(0);
    (0..=highest).rev().fold(like.nothing(), |sum, k| {
        let own: Vec<(&[u32], &Integer)> = terms.iter().filter(|(e, _)| power(e) == k).copied().collect();
        let sum = if sum.is_nothing() { sum } else { last.mul(&sum) };
        if own.is_empty() { sum } else { sum.add(&horner(&own, others, like)) }
    })
}
