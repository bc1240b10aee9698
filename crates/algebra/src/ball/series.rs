//! Truncated power series whose coefficients are balls: values of functions near a point, or, with balls as wide as an
//! interval, bounds of their derivatives on it.

use super::{Ball, exp};
use crate::limits::checkpoint;
use crate::number::Integer;

/// `c_0 + c_1 x + ... + c_(n-1) x^(n-1)`, everything from `x^n` on left out.
///
/// ```
/// use jurist_algebra::ball::{Ball, Series};
/// use jurist_algebra::number::Rational;
/// // exp(1 + x) to three terms: e, e, e/2
/// let point = Series::linear(&Ball::from_integer(&1.into(), 64), &Ball::from_integer(&1.into(), 64), 3);
/// let e = point.exp();
/// let twice = e.coefficients()[2].scaled(&2.into());
/// assert!(twice.intersection(&e.coefficients()[0]).is_some());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Series {
    coefficients: Vec<Ball>,
}

impl Series {
    /// From all coefficients, at least one.
    ///
    /// # Panics
    /// When there is none.
    pub fn new(coefficients: Vec<Ball>) -> Series {
        assert!(!coefficients.is_empty(), "a series has a constant term");
        Series { coefficients }
    }

    /// A constant with so many terms.
    pub fn constant(c: &Ball, terms: usize) -> Series {
        let mut coefficients = vec![Ball::zero(c.bits()); terms];
        coefficients[0] = c.clone();
        Series { coefficients }
    }

    /// `c + r x` with so many terms.
    pub fn linear(c: &Ball, r: &Ball, terms: usize) -> Series {
        let mut out = Series::constant(c, terms);
        if terms > 1 {
            out.coefficients[1] = r.clone();
        }
        out
    }

    /// The coefficients from the constant term up.
    pub fn coefficients(&self) -> &[Ball] {
        &self.coefficients
    }

    /// The number of terms.
    pub fn terms(&self) -> usize {
        self.coefficients.len()
    }

    pub(super) fn bits(&self) -> u64 {
        self.coefficients[0].bits()
    }

    pub(super) fn map(&self, f: impl Fn(&Ball) -> Ball) -> Series {
        Series { coefficients: self.coefficients.iter().map(f).collect() }
    }

    fn with(&self, other: &Series, f: impl Fn(&Ball, &Ball) -> Ball) -> Series {
        Series { coefficients: self.coefficients.iter().zip(&other.coefficients).map(|(a, b)| f(a, b)).collect() }
    }

    /// The sum.
    pub fn add(&self, other: &Series) -> Series {
        self.with(other, Ball::add)
    }

    /// The difference.
    pub fn sub(&self, other: &Series) -> Series {
        self.with(other, Ball::sub)
    }

    /// The negative.
    pub fn neg(&self) -> Series {
        self.map(Ball::neg)
    }

    /// The product with an integer.
    pub fn scaled(&self, n: &Integer) -> Series {
        self.map(|c| c.scaled(n))
    }

    /// The product: `n^2 / 2` products of balls.
    pub fn mul(&self, other: &Series) -> Series {
        let n = self.terms();
        checkpoint(n as u64);
        let coefficient = |k: usize| {
            Ball::sum_of_products((0..=k).map(|j| (&self.coefficients[j], &other.coefficients[k - j])), self.bits())
        };
        Series { coefficients: (0..n).map(coefficient).collect() }
    }

    /// The quotient; `None` where the divisor's constant term may be zero.
    pub fn div(&self, other: &Series) -> Option<Series> {
        let mut out: Vec<Ball> = Vec::with_capacity(self.terms());
        for k in 0..self.terms() {
            let mut rest = self.coefficients[k].clone();
            for (j, q) in out.iter().enumerate() {
                rest = rest.sub(&q.mul(&other.coefficients[k - j]));
            }
            out.push(rest.div(&other.coefficients[0])?);
        }
        Some(Series { coefficients: out })
    }

    /// The square root; `None` where the constant term may not be positive.
    pub fn sqrt(&self) -> Option<Series> {
        let first = self.coefficients[0].sqrt().filter(|r| r.sign().is_some_and(|s| s.is_gt()))?;
        let divisor = first.add(&first);
        let mut out = vec![first];
        for k in 1..self.terms() {
            let mut rest = self.coefficients[k].clone();
            for j in 1..k {
                rest = rest.sub(&out[j].mul(&out[k - j]));
            }
            out.push(rest.div(&divisor)?);
        }
        Some(Series { coefficients: out })
    }

    /// The exponential: with `y' = x' y`, one coefficient after the other.
    pub fn exp(&self) -> Series {
        let mut out = vec![exp(&self.coefficients[0])];
        for k in 1..self.terms() {
            let mut sum = Ball::zero(self.bits());
            for j in 1..=k {
                sum = sum.add(&self.coefficients[j].scaled(&Integer::from(j as u64)).mul(&out[k - j]));
            }
            out.push(sum.divided_by(k as u64));
        }
        Series { coefficients: out }
    }

    /// The power with a natural exponent.
    pub fn power(&self, exponent: u64) -> Series {
        let one = Ball::from_integer(&Integer::ONE, self.bits());
        let mut out = Series::constant(&one, self.terms());
        let (mut base, mut rest) = (self.clone(), exponent);
        while rest > 0 {
            if rest % 2 == 1 {
                out = out.mul(&base);
            }
            rest /= 2;
            if rest > 0 {
                base = base.mul(&base);
            }
        }
        out
    }

    /// The sum of the greatest absolute values of the coefficients: a norm in which a product is at most the product.
    pub(super) fn norm_units(&self) -> Integer {
        self.coefficients.iter().fold(Integer::ZERO, |sum, c| sum + c.magnitude_units())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::parse_number;

    fn at(text: &str, radius: &str, terms: usize) -> Series {
        let ball = |t: &str| Ball::from_rational(&parse_number(t).unwrap(), 128);
        Series::linear(&ball(text), &ball(radius), terms)
    }

    #[test]
    fn quotients_roots_and_powers_undo_products() {
        let (a, b) = (at("3/2", "1/3", 8), at("7/5", "-1/4", 8).power(3));
        let same = |x: &Series, y: &Series| {
            x.coefficients()
                .iter()
                .zip(y.coefficients())
                .all(|(a, b)| a.intersection(b).is_some() && a.union(b).width_units().bit_length() < 20)
        };
        assert!(same(&a.mul(&b).div(&b).unwrap(), &a));
        let root = b.sqrt().unwrap();
        assert!(same(&root.mul(&root), &b));
        assert!(same(&a.exp().mul(&a.neg().exp()), &a.power(0)));
        assert!(at("0", "1", 3).div(&at("0", "1", 3)).is_none());
    }
}
