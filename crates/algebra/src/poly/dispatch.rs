//! Where the integers, as coefficients, choose among the algorithms: above both the definitions and the fast ways, so
//! that neither needs the other.

use super::modular::kronecker::{KRONECKER_MIN_LENGTH, convolve_kronecker, convolve_schoolbook};
use super::modular::{gcd, gcd_by_values, multimodular_resultant};
use super::{Domain, Poly};
use crate::number::Integer;
use std::cmp::Ordering;

impl Domain for Integer {
    fn zero() -> Self {
        Integer::ZERO
    }
    fn one() -> Self {
        Integer::ONE
    }
    fn from_integer(n: &Integer) -> Self {
        n.clone()
    }
    fn is_zero(&self) -> bool {
        self.is_zero()
    }
    fn is_one(&self) -> bool {
        self.is_one()
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn negated(&self) -> Self {
        -self
    }
    fn div_exact(&self, divisor: &Self) -> Option<Self> {
        (!divisor.is_zero() && self.divisible_by(divisor)).then(|| Integer::div_exact(self, divisor))
    }
    fn gcd(&self, other: &Self) -> Self {
        Integer::gcd(self, other)
    }
    fn needs_negation(&self) -> bool {
        self.sign() == Ordering::Less
    }
    fn add_times(&mut self, a: &Self, b: &Self) {
        self.add_mul_assign(a, b);
    }
    fn sub_times(&mut self, a: &Self, b: &Self) {
        self.sub_mul_assign(a, b);
    }
    fn power(&self, exponent: u64) -> Self {
        self.pow(exponent)
    }
    fn convolve(a: &[Self], b: &[Self]) -> Vec<Self> {
        if a.len().min(b.len()) < KRONECKER_MIN_LENGTH { convolve_schoolbook(a, b) } else { convolve_kronecker(a, b) }
    }
    fn primitive_gcd_fast(a: &Poly<Self>, b: &Poly<Self>) -> Option<Poly<Self>> {
        gcd::primitive_gcd(a, b)
    }
    fn primitive_gcd_over_polynomials_fast(a: &Poly<Poly<Self>>, b: &Poly<Poly<Self>>) -> Option<Poly<Poly<Self>>> {
        gcd_by_values::primitive_gcd(a, b)
    }
    fn resultant_fast(a: &Poly<Self>, n: usize, b: &Poly<Self>, m: usize) -> Option<Self> {
        multimodular_resultant::over_integers(a, n, b, m)
    }
    fn resultant_over_polynomials_fast(
        a: &Poly<Poly<Self>>,
        n: usize,
        b: &Poly<Poly<Self>>,
        m: usize,
    ) -> Option<Poly<Self>> {
        multimodular_resultant::over_univariate(a, n, b, m)
    }
}
