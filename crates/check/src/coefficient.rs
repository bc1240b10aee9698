//! What the check asks of polynomials in the parameter, be their coefficients integers or polynomials in symbols.

use super::clock::Clock;
use super::multivariate::Multi;
use super::number::{Q, Z};
use super::roots::{is_hurwitz, is_schur};
use super::univariate::Uni;

/// A polynomial in any number of parameters.
pub(super) trait Ring: Clone + PartialEq {
    fn zero(&self) -> Self;
    fn is_zero(&self) -> bool;
    fn plus(&self, other: &Self) -> Self;
    fn add(&mut self, other: &Self) {
        *self = self.plus(other);
    }
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self, clock: &Clock) -> Result<Self, String>;
    fn scaled(&self, factor: &Z) -> Self;
    /// Whether it is not zero for every value of the parameters, for certain.
    fn is_nonzero(&self, clock: &Clock) -> Result<bool, String>;
}

/// A polynomial in the parameter over an ordered ring. What cannot be told is an error: nothing is ever guessed.
pub(super) trait Coefficient: Ring {
    /// The degree in the parameter, 0 for zero.
    fn degree(&self) -> usize;
    /// Whether it is a number other than zero for certain.
    fn is_unit(&self, clock: &Clock) -> Result<bool, String>;
    /// Whether it is zero at a rational number.
    fn vanishes_at(&self, value: &Q, clock: &Clock) -> Result<bool, String>;
    /// The quotient of an exact division.
    fn divided(&self, divisor: &Self, clock: &Clock) -> Result<Option<Self>, String>;
    /// A greatest common divisor, where it is looked for.
    fn common(&self, _: &Self, _: &Clock) -> Result<Option<Self>, String> {
        Ok(None)
    }
    /// Descartes' bound, as [`Uni::descartes`].
    fn descartes(&self, a: Option<&Q>, b: Option<&Q>, clock: &Clock) -> Result<Option<usize>, String>;
    /// Whether a polynomial with these coefficients has its full degree at a value of the parameter, and all roots inside.
    fn is_stable_at(coefficients: &[Self], value: &Q, discrete: bool, clock: &Clock) -> Result<bool, String>;
}

impl Ring for Uni {
    fn zero(&self) -> Self {
        Uni::default()
    }

    fn is_zero(&self) -> bool {
        Uni::is_zero(self)
    }

    fn plus(&self, other: &Self) -> Self {
        Uni::plus(self, other)
    }

    fn minus(&self, other: &Self) -> Self {
        Uni::minus(self, other)
    }

    fn times(&self, other: &Self, clock: &Clock) -> Result<Self, String> {
        Uni::product(self, other, clock)
    }

    fn scaled(&self, factor: &Z) -> Self {
        Uni::scaled(self, factor)
    }

    fn is_nonzero(&self, _: &Clock) -> Result<bool, String> {
        Ok(!Uni::is_zero(self))
    }
}

impl Ring for Multi {
    fn zero(&self) -> Self {
        Multi::default()
    }

    fn is_zero(&self) -> bool {
        Multi::is_zero(self)
    }

    fn plus(&self, other: &Self) -> Self {
        Multi::plus(self, other)
    }

    fn add(&mut self, other: &Self) {
        self.add_all(other);
    }

    fn minus(&self, other: &Self) -> Self {
        Multi::minus(self, other)
    }

    fn times(&self, other: &Self, clock: &Clock) -> Result<Self, String> {
        Multi::times(self, other, clock)
    }

    fn scaled(&self, factor: &Z) -> Self {
        Multi::scaled(self, factor)
    }

    fn is_nonzero(&self, _: &Clock) -> Result<bool, String> {
        Ok(!Multi::is_zero(self))
    }
}

impl Coefficient for Uni {
    fn degree(&self) -> usize {
        Uni::degree(self)
    }

    fn is_unit(&self, _: &Clock) -> Result<bool, String> {
        Ok(self.0.len() == 1)
    }

    fn vanishes_at(&self, value: &Q, clock: &Clock) -> Result<bool, String> {
        Uni::vanishes_at(self, value, clock)
    }

    fn divided(&self, divisor: &Self, clock: &Clock) -> Result<Option<Self>, String> {
        Uni::divided(self, divisor, clock)
    }

    fn common(&self, other: &Self, clock: &Clock) -> Result<Option<Self>, String> {
        self.gcd(other, clock).map(Some)
    }

    fn descartes(&self, a: Option<&Q>, b: Option<&Q>, clock: &Clock) -> Result<Option<usize>, String> {
        Uni::descartes(self, a, b, clock)
    }

    fn is_stable_at(coefficients: &[Self], value: &Q, discrete: bool, clock: &Clock) -> Result<bool, String> {
        let polynomial = at_point(coefficients, value, clock)?;
        if polynomial.0.len() != coefficients.len() {
            return Err("the sample loses degree".into());
        }
        if discrete { is_schur(&polynomial, clock) } else { is_hurwitz(&polynomial, clock) }
    }
}

/// A positive multiple of the polynomial at a value of the parameter.
pub(super) fn at_point(coefficients: &[Uni], sample: &Q, clock: &Clock) -> Result<Uni, String> {
    // All values over the denominator of the sample to the power of the highest degree.
    let degree = coefficients.iter().map(Uni::degree).max().unwrap_or(0);
    let scaled =
        |c: &Uni| Ok(c.numerator_at(sample, clock)? * num_traits::pow(sample.denom().clone(), degree - c.degree()));
    Ok(Uni::new(coefficients.iter().map(scaled).collect::<Result<_, String>>()?))
}
