//! Rational numbers of any size.

use super::Integer;
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A rational number in lowest terms with a positive denominator.
///
/// An operation costs one or two greatest common divisors of numbers as long as the parts.
///
/// ```
/// use jurist_algebra::number::{Integer, Rational};
/// let a = Rational::new(Integer::from(46), Integer::from(1000));
/// assert_eq!(a.to_string(), "23/500");
/// assert_eq!((&a + &a).to_string(), "23/250");
/// ```
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Rational {
    numerator: Integer,
    denominator: Integer,
}

impl Rational {
    /// Zero.
    pub const ZERO: Rational = Rational { numerator: Integer::ZERO, denominator: Integer::ONE };
    /// One.
    pub const ONE: Rational = Rational { numerator: Integer::ONE, denominator: Integer::ONE };

    /// The quotient of two integers.
    ///
    /// # Panics
    /// When `denominator` is zero.
    pub fn new(numerator: Integer, denominator: Integer) -> Rational {
        assert!(!denominator.is_zero(), "a denominator is not zero");
        if denominator.is_one() {
            return Rational { numerator, denominator };
        }
        let g = numerator.gcd(&denominator);
        let (numerator, denominator) = (divided(numerator, &g), divided(denominator, &g));
        Rational::with_sign(numerator, denominator)
    }

    /// From coprime parts.
    fn with_sign(numerator: Integer, denominator: Integer) -> Rational {
        if denominator.is_negative() {
            Rational { numerator: -numerator, denominator: -denominator }
        } else {
            Rational { numerator, denominator }
        }
    }

    /// `numerator / 2^bits`.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// assert_eq!(Rational::dyadic(&6.into(), 2).to_string(), "3/2");
    /// ```
    pub fn dyadic(numerator: &Integer, bits: u64) -> Rational {
        let twos = numerator.trailing_zeros().map_or(bits, |zeros| zeros.min(bits));
        Rational { numerator: numerator >> twos, denominator: &Integer::ONE << (bits - twos) }
    }

    /// The value of a floating-point number, exactly; `None` when it is infinite or not a number.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// assert_eq!(Rational::from_f64(0.1).unwrap().to_string(), "3602879701896397/36028797018963968");
    /// assert_eq!(Rational::from_f64(-3.0), Some((-3).into()));
    /// assert_eq!(Rational::from_f64(f64::NAN), None);
    /// ```
    pub fn from_f64(value: f64) -> Option<Rational> {
        const FRACTION: u32 = f64::MANTISSA_DIGITS - 1;
        let bits = value.abs().to_bits();
        let exponent = (bits >> FRACTION) as i64;
        let fraction = bits & ((1 << FRACTION) - 1);
        // Subnormal numbers have no leading one, and the exponent of the least normal ones.
        let magnitude = if exponent == 0 { fraction } else { fraction | 1 << FRACTION };
        let shift = exponent.max(1) - 1075;
        let integer = Integer::from(magnitude);
        let integer = if value < 0.0 { -integer } else { integer };
        value.is_finite().then(|| match u64::try_from(shift) {
            Ok(up) => Rational::from(integer << up),
            Err(_) => Rational::dyadic(&integer, shift.unsigned_abs()),
        })
    }

    /// The numerator, with the sign.
    pub fn numerator(&self) -> Integer {
        self.numerator.clone()
    }

    /// The denominator, positive.
    pub fn denominator(&self) -> Integer {
        self.denominator.clone()
    }

    /// Numerator and denominator, to look at.
    pub(super) fn parts(&self) -> (&Integer, &Integer) {
        (&self.numerator, &self.denominator)
    }

    /// Whether this is 0.
    pub fn is_zero(&self) -> bool {
        self.numerator.is_zero()
    }

    /// Whether this is 1.
    pub fn is_one(&self) -> bool {
        self.numerator.is_one() && self.denominator.is_one()
    }

    /// Whether the denominator is 1.
    pub fn is_integer(&self) -> bool {
        self.denominator.is_one()
    }

    /// The sign.
    pub fn sign(&self) -> Ordering {
        self.numerator.sign()
    }

    /// Whether this is below zero.
    pub fn is_negative(&self) -> bool {
        self.numerator.is_negative()
    }

    /// The magnitude.
    pub fn abs(&self) -> Rational {
        Rational { numerator: self.numerator.abs(), denominator: self.denominator.clone() }
    }

    /// `1 / self`; `None` for 0.
    pub fn recip(&self) -> Option<Rational> {
        (!self.is_zero()).then(|| Rational::with_sign(self.denominator.clone(), self.numerator.clone()))
    }

    /// The power; `0^0 = 1`; `None` for 0 to a negative power.
    pub fn pow(&self, exponent: i64) -> Option<Rational> {
        let n = exponent.unsigned_abs();
        let power = Rational { numerator: self.numerator.pow(n), denominator: self.denominator.pow(n) };
        if exponent < 0 { power.recip() } else { Some(power) }
    }

    /// The quotient; `None` when `other` is 0.
    pub fn checked_div(&self, other: &Rational) -> Option<Rational> {
        (!other.is_zero()).then(|| self / other)
    }

    /// The greatest integer that is not above this.
    ///
    /// ```
    /// use jurist_algebra::number::{Integer, parse_number};
    /// assert_eq!(parse_number("-7/2").unwrap().floor(), Integer::from(-4));
    /// ```
    pub fn floor(&self) -> Integer {
        if self.is_integer() { self.numerator.clone() } else { self.numerator.div_mod_floor(&self.denominator).0 }
    }

    /// The least integer that is not below this.
    pub fn ceil(&self) -> Integer {
        if self.is_integer() { self.numerator.clone() } else { self.floor() + Integer::ONE }
    }

    /// The mean of two numbers.
    pub fn midpoint(&self, other: &Rational) -> Rational {
        let sum = self + other;
        if sum.numerator.is_even() {
            Rational { numerator: sum.numerator >> 1, denominator: sum.denominator }
        } else {
            Rational { numerator: sum.numerator, denominator: sum.denominator << 1 }
        }
    }

    /// The nearest `f64`, infinite beyond its range: for pictures, never for decisions.
    pub fn to_f64_approximate(&self) -> f64 {
        if self.is_integer() {
            return self.numerator.to_f64_approximate();
        }
        let (n, d) = (self.numerator.bit_length() as i64, self.denominator.bit_length() as i64);
        // A quotient of 64 or 65 bits (fewer below the least normal number) and one bit for what is cut off.
        let shift = (64 - (n - d)).min(1074 + 1);
        let up = |x: &Integer, by: i64| x << by.max(0).unsigned_abs();
        let (q, rest) = up(&self.numerator.abs(), shift).div_mod_floor(&up(&self.denominator, -shift));
        let sticky = (q << 1) + if rest.is_zero() { Integer::ZERO } else { Integer::ONE };
        // Scaling by powers of two is exact: the rounding is done, or there are no more bits than fit.
        let mut magnitude = sticky.to_f64_approximate();
        let mut exponent = -(shift + 1);
        while exponent != 0 && magnitude.is_finite() && magnitude != 0.0 {
            let step = exponent.clamp(-1000, 1000);
            magnitude *= 2f64.powi(step as i32);
            exponent -= step;
        }
        if self.is_negative() { -magnitude } else { magnitude }
    }

    /// Sum or difference ([Henrici1956](crate::bibliography#henrici1956)): only factors common to both denominators can
    /// cancel.
    fn sum(&self, other: &Rational, subtract: bool) -> Rational {
        let combine = |a: &Integer, b: &Integer| if subtract { a - b } else { a + b };
        let (a, b, c, d) = (&self.numerator, &self.denominator, &other.numerator, &other.denominator);
        match (b.is_one(), d.is_one()) {
            (true, true) => return Rational { numerator: combine(a, c), denominator: Integer::ONE },
            (true, false) => return Rational { numerator: combine(&(a * d), c), denominator: d.clone() },
            (false, true) => return Rational { numerator: combine(a, &(c * b)), denominator: b.clone() },
            (false, false) => {}
        }
        let g = b.gcd(d);
        if g.is_one() {
            return Rational { numerator: combine(&(a * d), &(c * b)), denominator: b * d };
        }
        let (b_rest, d_rest) = (b.div_exact(&g), d.div_exact(&g));
        let numerator = combine(&(a * &d_rest), &(c * &b_rest));
        let common = numerator.gcd(&g);
        let denominator = if common.is_one() { b_rest * d } else { b_rest * d.div_exact(&common) };
        Rational { numerator: divided(numerator, &common), denominator }
    }

    /// The product of `a / b` and `c / d`, both in lowest terms; the sign may be in either part of the second.
    fn product(a: &Integer, b: &Integer, c: &Integer, d: &Integer) -> Rational {
        if b.is_one() && d.is_one() {
            return Rational { numerator: a * c, denominator: Integer::ONE };
        }
        let cancelled = |n: &Integer, d: &Integer| {
            let g = if d.is_one() { Integer::ONE } else { n.gcd(d) };
            if g.is_one() { None } else { Some((n.div_exact(&g), d.div_exact(&g))) }
        };
        let (first, second) = (cancelled(a, d), cancelled(c, b));
        let (a, d) = first.as_ref().map_or((a, d), |(a, d)| (a, d));
        let (c, b) = second.as_ref().map_or((c, b), |(c, b)| (c, b));
        Rational::with_sign(a * c, b * d)
    }
}

fn divided(n: Integer, g: &Integer) -> Integer {
    if g.is_one() { n } else { n.div_exact(g) }
}

impl Default for Rational {
    fn default() -> Self {
        Rational::ZERO
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        let (a, b, c, d) = (&self.numerator, &self.denominator, &other.numerator, &other.denominator);
        if b == d {
            return a.cmp(c);
        }
        let sign = a.sign();
        if sign != c.sign() || sign.is_eq() {
            return sign.cmp(&c.sign());
        }
        // 2^(k - 1) < |x| < 2^(k + 1) for k the difference of the bit lengths.
        let size = |n: &Integer, d: &Integer| n.bit_length() as i64 - d.bit_length() as i64;
        let (left, right) = (size(a, b), size(c, d));
        if left.abs_diff(right) > 1 {
            let order = left.cmp(&right);
            return if sign.is_lt() { order.reverse() } else { order };
        }
        (a * d).cmp(&(c * b))
    }
}

impl From<Integer> for Rational {
    fn from(value: Integer) -> Self {
        Rational { numerator: value, denominator: Integer::ONE }
    }
}

impl From<&Integer> for Rational {
    fn from(value: &Integer) -> Self {
        Rational { numerator: value.clone(), denominator: Integer::ONE }
    }
}

macro_rules! from_primitive {
    ($($t:ty),*) => {$(
        impl From<$t> for Rational {
            fn from(value: $t) -> Self {
                Rational::from(Integer::from(value))
            }
        }
    )*};
}
from_primitive!(i32, i64, u32, u64, usize);

macro_rules! operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident| $value:expr) => {
        impl $trait for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                let ($a, $b) = (self, other);
                $value
            }
        }
        impl $trait for Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                $trait::$method(&self, &other)
            }
        }
        impl $trait<&Rational> for Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                $trait::$method(&self, other)
            }
        }
        impl $trait<Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                $trait::$method(self, &other)
            }
        }
    };
}
operator!(Add, add, |a, b| a.sum(b, false));
operator!(Sub, sub, |a, b| a.sum(b, true));
operator!(Mul, mul, |a, b| Rational::product(&a.numerator, &a.denominator, &b.numerator, &b.denominator));
operator!(Div, div, |a, b| {
    assert!(!b.is_zero(), "division by zero");
    Rational::product(&a.numerator, &a.denominator, &b.denominator, &b.numerator)
});

macro_rules! assign {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait<&Rational> for Rational {
            fn $method(&mut self, other: &Rational) {
                *self = &*self $operator other;
            }
        }
        impl $trait for Rational {
            fn $method(&mut self, other: Rational) {
                *self = &*self $operator &other;
            }
        }
    };
}
assign!(AddAssign, add_assign, +);
assign!(SubAssign, sub_assign, -);
assign!(MulAssign, mul_assign, *);

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational { numerator: -self.numerator, denominator: self.denominator }
    }
}

impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        Rational { numerator: -&self.numerator, denominator: self.denominator.clone() }
    }
}

impl fmt::Display for Rational {
    /// `p/q`, integers without `/1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_integer() {
            return fmt::Display::fmt(&self.numerator, f);
        }
        write!(f, "{}/{}", self.numerator, self.denominator)
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fractions() -> Vec<Rational> {
        let mut out = Vec::new();
        for n in -12i64..=12 {
            for d in 1i64..=12 {
                out.push(Rational::new(n.into(), d.into()));
            }
        }
        out.push(Rational::new(Integer::from(7).pow(80), Integer::from(6).pow(90)));
        out.push(-Rational::new(Integer::from(6).pow(70), Integer::from(7).pow(30)));
        out
    }

    /// Against the definitions by cross products, and lowest terms by the divisor of the parts.
    #[test]
    fn operations_are_those_of_fractions_in_lowest_terms() {
        let all = fractions();
        let lowest = |x: &Rational| x.denominator.sign().is_gt() && x.numerator.gcd(&x.denominator).is_one();
        for x in &all {
            for y in &all {
                let (a, b, c, d) = (&x.numerator, &x.denominator, &y.numerator, &y.denominator);
                let equal =
                    |z: Rational, n: Integer, q: Integer| lowest(&z) && &z.numerator * &q == &n * &z.denominator;
                assert!(equal(x + y, &(a * d) + &(c * b), b * d), "{x} + {y}");
                assert!(equal(x - y, &(a * d) - &(c * b), b * d), "{x} - {y}");
                assert!(equal(x * y, a * c, b * d), "{x} * {y}");
                assert!(equal(x.midpoint(y), &(a * d) + &(c * b), &(b * d) << 1), "mean of {x} and {y}");
                assert_eq!(x.cmp(y), (a * d).cmp(&(c * b)), "{x} and {y}");
                match x.checked_div(y) {
                    Some(z) => assert!(equal(z, a * d, b * c), "{x} / {y}"),
                    None => assert!(y.is_zero()),
                }
            }
            assert!(Rational::from(x.floor()) <= *x && *x < Rational::from(x.floor()) + Rational::ONE);
            assert_eq!(x.ceil(), -(-x).floor());
        }
    }

    #[test]
    fn floating_point_numbers_come_back() {
        let mut numbers =
            vec![0.0, 1.5, f64::MAX, f64::MIN_POSITIVE, f64::from_bits(1), f64::from_bits(0xf_ffff_ffff_ffff)];
        let mut state = 1u64;
        for _ in 0..2000 {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            numbers.push(f64::from_bits(state));
        }
        for x in numbers {
            match Rational::from_f64(x) {
                Some(exact) => {
                    assert_eq!(exact.to_f64_approximate(), x, "{x:e}");
                    // Numbers between this and the next round to one of the two.
                    let third = Rational::new(Integer::ONE, Integer::from(3));
                    let next = Rational::from_f64(x.next_up());
                    if let Some(next) = next {
                        let between = &exact + &(&(&next - &exact) * &third);
                        assert_eq!(between.to_f64_approximate(), x, "above {x:e}");
                    }
                }
                None => assert!(!x.is_finite()),
            }
        }
        assert_eq!(Rational::new(Integer::ONE, Integer::from(10)).to_f64_approximate(), 0.1);
        let tiny = Rational::ONE.checked_div(&Rational::from(Integer::from(10).pow(400)));
        assert_eq!(tiny.map(|x| x.to_f64_approximate()), Some(0.0));
        assert_eq!(Rational::new(Integer::from(10).pow(400), Integer::from(3)).to_f64_approximate(), f64::INFINITY);
    }
}
