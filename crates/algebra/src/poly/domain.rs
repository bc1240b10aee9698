//! What polynomial algorithms ask of their coefficients.

use super::Poly;
use crate::limits::checkpoint;
use crate::number::{Integer, Rational};
use std::fmt::Debug;

/// An integral domain with greatest common divisors and exact division.
///
/// The integers, the rationals, and polynomials over a `Domain` are domains, so the same
/// algorithms serve numbers and symbolic parameters. Methods take references because coefficients
/// may be large.
///
/// ```
/// use jurist_algebra::number::{Integer, Rational};
/// use jurist_algebra::poly::{Domain, UniPoly};
/// fn sum_of_squares<R: Domain>(items: &[R]) -> R {
///     items.iter().fold(R::zero(), |sum, x| sum.plus(&x.times(x)))
/// }
/// assert_eq!(sum_of_squares(&[Integer::from(3), Integer::from(4)]), Integer::from(25));
/// assert_eq!(sum_of_squares(&[Rational::from(1), Rational::from(2)]), Rational::from(5));
/// assert_eq!(sum_of_squares(&[UniPoly::x(), UniPoly::one()]), UniPoly::from_i64(&[1, 0, 1]));
/// ```
pub trait Domain: Clone + PartialEq + Debug + Send + Sync + 'static {
    /// The neutral element of addition.
    fn zero() -> Self;
    /// The neutral element of multiplication.
    fn one() -> Self;
    /// The image of an integer.
    fn from_integer(n: &Integer) -> Self;
    /// Whether this is zero.
    fn is_zero(&self) -> bool;
    /// Whether this is one.
    fn is_one(&self) -> bool;
    /// `self + other`.
    fn plus(&self, other: &Self) -> Self;
    /// `self - other`.
    fn minus(&self, other: &Self) -> Self;
    /// `self * other`.
    fn times(&self, other: &Self) -> Self;
    /// `-self`.
    fn negated(&self) -> Self;
    /// The quotient, or `None` when `divisor` is zero or does not divide `self`.
    fn div_exact(&self, divisor: &Self) -> Option<Self>;
    /// A greatest common divisor, normalised so that [`Domain::needs_negation`] is false.
    fn gcd(&self, other: &Self) -> Self;
    /// Whether the normalised associate is `-self` (over the integers: whether `self < 0`).
    fn needs_negation(&self) -> bool;

    /// `self += a * b`.
    fn add_times(&mut self, a: &Self, b: &Self) {
        *self = self.plus(&a.times(b));
    }

    /// `self -= a * b`.
    fn sub_times(&mut self, a: &Self, b: &Self) {
        *self = self.minus(&a.times(b));
    }

    /// The power; `0^0 = 1`.
    fn power(&self, exponent: u64) -> Self {
        let mut result = Self::one();
        let mut base = self.clone();
        let mut e = exponent;
        while e > 0 {
            if e & 1 == 1 {
                result = result.times(&base);
            }
            e >>= 1;
            if e > 0 {
                base = base.times(&base);
            }
        }
        result
    }

    /// The coefficients of a product of two non-zero polynomials given by their coefficients.
    ///
    /// A hook for domains that know a faster way than the schoolbook's `O(n m)` products.
    fn convolve(a: &[Self], b: &[Self]) -> Vec<Self> {
        let mut out = vec![Self::zero(); a.len() + b.len() - 1];
        for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
            checkpoint(4 * b.len() as u64);
            for (j, y) in b.iter().enumerate() {
                out[i + j].add_times(x, y);
            }
        }
        out
    }

    /// A greatest common divisor of two non-zero primitive polynomials, up to a unit, or `None` where the subresultant
    /// sequence is expected to be the fastest.
    fn primitive_gcd_fast(_a: &Poly<Self>, _b: &Poly<Self>) -> Option<Poly<Self>> {
        None
    }

    /// [`Domain::primitive_gcd_fast`] for polynomials over this domain as coefficients.
    fn primitive_gcd_over_polynomials_fast(_a: &Poly<Poly<Self>>, _b: &Poly<Poly<Self>>) -> Option<Poly<Poly<Self>>> {
        None
    }

    /// The resultant of two polynomials for formal degrees that are not below the degrees, or `None`
    /// where the subresultant sequence is expected to be the fastest.
    fn resultant_fast(_a: &Poly<Self>, _n: usize, _b: &Poly<Self>, _m: usize) -> Option<Self> {
        None
    }

    /// [`Domain::resultant_fast`] for polynomials over this domain as coefficients.
    fn resultant_over_polynomials_fast(
        _a: &Poly<Poly<Self>>,
        _n: usize,
        _b: &Poly<Poly<Self>>,
        _m: usize,
    ) -> Option<Poly<Self>> {
        None
    }
}

impl Domain for Rational {
    fn zero() -> Self {
        Rational::ZERO
    }
    fn one() -> Self {
        Rational::ONE
    }
    fn from_integer(n: &Integer) -> Self {
        Rational::from(n)
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
        self.checked_div(divisor)
    }
    /// Every non-zero rational is a unit: 1, or 0 when both are 0.
    fn gcd(&self, other: &Self) -> Self {
        if self.is_zero() && other.is_zero() { Rational::ZERO } else { Rational::ONE }
    }
    fn needs_negation(&self) -> bool {
        self.is_negative()
    }
}
