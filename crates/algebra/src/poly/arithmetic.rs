//! Sums, products and the operators; polynomials over a domain form a domain.

use super::{Domain, Poly};
use crate::number::Integer;
use std::ops::{Add, Mul, Neg, Sub};

impl<R: Domain> Domain for Poly<R> {
    fn zero() -> Self {
        Poly::new(Vec::new())
    }
    fn one() -> Self {
        Poly::constant(R::one())
    }
    fn from_integer(n: &Integer) -> Self {
        Poly::constant(R::from_integer(n))
    }
    fn is_zero(&self) -> bool {
        self.coeffs().is_empty()
    }
    fn is_one(&self) -> bool {
        matches!(self.coeffs(), [c] if c.is_one())
    }
    fn plus(&self, other: &Self) -> Self {
        let (long, short) = if self.coeffs().len() >= other.coeffs().len() { (self, other) } else { (other, self) };
        let mut coeffs = long.coeffs().to_vec();
        for (a, b) in coeffs.iter_mut().zip(short.coeffs()) {
            *a = a.plus(b);
        }
        Poly::new(coeffs)
    }
    fn minus(&self, other: &Self) -> Self {
        let n = self.coeffs().len().max(other.coeffs().len());
        let term = |k: usize| match (self.coeffs().get(k), other.coeffs().get(k)) {
            (Some(a), Some(b)) => a.minus(b),
            (Some(a), None) => a.clone(),
            (None, Some(b)) => b.negated(),
            (None, None) => R::zero(),
        };
        Poly::new((0..n).map(term).collect())
    }
    fn times(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Poly::zero();
        }
        Poly::new(R::convolve(self.coeffs(), other.coeffs()))
    }
    fn negated(&self) -> Self {
        self.map(R::negated)
    }
    fn div_exact(&self, divisor: &Self) -> Option<Self> {
        self.div_exact_poly(divisor)
    }
    fn gcd(&self, other: &Self) -> Self {
        super::gcd::gcd(self, other)
    }
    fn needs_negation(&self) -> bool {
        self.leading().is_some_and(R::needs_negation)
    }
    fn primitive_gcd_fast(a: &Poly<Self>, b: &Poly<Self>) -> Option<Poly<Self>> {
        R::primitive_gcd_over_polynomials_fast(a, b)
    }
    fn resultant_fast(a: &Poly<Self>, n: usize, b: &Poly<Self>, m: usize) -> Option<Self> {
        R::resultant_over_polynomials_fast(a, n, b, m)
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $with:ident) => {
        impl<R: Domain> $trait for &Poly<R> {
            type Output = Poly<R>;
            fn $method(self, other: &Poly<R>) -> Poly<R> {
                self.$with(other)
            }
        }
        impl<R: Domain> $trait for Poly<R> {
            type Output = Poly<R>;
            fn $method(self, other: Poly<R>) -> Poly<R> {
                (&self).$with(&other)
            }
        }
    };
}
operator!(Add, add, plus);
operator!(Sub, sub, minus);
operator!(Mul, mul, times);

impl<R: Domain> Neg for &Poly<R> {
    type Output = Poly<R>;
    fn neg(self) -> Poly<R> {
        self.negated()
    }
}
