//! Real numbers between two integers over a power of two: interval arithmetic in fixed point, rounded outwards.
//!
//! All balls of a computation have the same number of bits after the point. Sums are exact; a product is rounded by one
//! unit in its last place at either end. Where an end cannot be known well enough, the whole computation is done again with
//! more bits.

mod bezout;
mod characteristic;
mod elementary;
mod exponential;
mod flow;
mod functions;
mod implicit;
mod multi_taylor_model;
mod series;
mod short_model;
mod solutions;
mod taylor_model;

pub use bezout::{
    Enclosed, common_root, determinant_enclosed, enclosed_resultant, enclosed_resultant_by_minors, hybrid_bezout,
};
pub use characteristic::characteristic_polynomial;
pub use elementary::{Along, Elementary};
pub use exponential::{BallMatrix, exponential, exponential_of_rationals};
pub(crate) use flow::exponential_along;
pub use functions::{cos_sin, exp, tan};
pub use multi_taylor_model::MultiTaylorModel;
pub use series::Series;
pub use short_model::{Known, ShortModel, short_resultant};
pub use solutions::fundamental_solutions;
pub use taylor_model::TaylorModel;

use crate::limits::checkpoint;
use crate::number::{Enclosure, Integer, Rational, Sign};

/// A closed interval with ends `lo 2^-bits` and `hi 2^-bits` that holds a real number.
///
/// ```
/// use jurist_algebra::ball::Ball;
/// use jurist_algebra::number::Rational;
/// let third = Ball::from_rational(&"1/3".parse().unwrap(), 64);
/// let one = third.mul(&Ball::from_integer(&3.into(), 64));
/// assert!(one.contains(&Rational::ONE) && one.sign().is_some());
/// assert!(one.sub(&Ball::from_integer(&1.into(), 64)).sign().is_none());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ball {
    lo: Integer,
    hi: Integer,
    bits: u64,
}

impl Ball {
    /// Zero.
    pub fn zero(bits: u64) -> Ball {
        Ball { lo: Integer::ZERO, hi: Integer::ZERO, bits }
    }

    /// An integer.
    pub fn from_integer(n: &Integer, bits: u64) -> Ball {
        let n = n << bits;
        Ball { lo: n.clone(), hi: n, bits }
    }

    /// A rational number, rounded outwards.
    pub fn from_rational(x: &Rational, bits: u64) -> Ball {
        Ball::between(x, x, bits)
    }

    /// The smallest ball that holds both numbers, the smaller one first.
    pub fn between(lo: &Rational, hi: &Rational, bits: u64) -> Ball {
        let floor = |x: &Rational| (x.numerator() << bits).div_mod_floor(&x.denominator()).0;
        Ball { lo: floor(lo), hi: -floor(&-hi), bits }
    }

    /// An enclosure, rounded outwards.
    pub fn from_enclosure(x: &Enclosure, bits: u64) -> Ball {
        Ball::between(x.lower(), x.upper(), bits)
    }

    /// From the ends in units of `2^-bits`.
    ///
    /// # Panics
    /// When `lo > hi`.
    pub fn from_units(lo: Integer, hi: Integer, bits: u64) -> Ball {
        assert!(lo <= hi, "the ends of a ball are in order");
        Ball { lo, hi, bits }
    }

    /// The number of bits after the point.
    pub fn bits(&self) -> u64 {
        self.bits
    }

    /// The lower end.
    pub fn lower(&self) -> Rational {
        Rational::dyadic(&self.lo, self.bits)
    }

    /// The upper end.
    pub fn upper(&self) -> Rational {
        Rational::dyadic(&self.hi, self.bits)
    }

    /// Both ends.
    pub fn to_enclosure(&self) -> Enclosure {
        Enclosure::new(self.lower(), self.upper())
    }

    /// A number in the middle, in units of `2^-bits`.
    pub fn middle_units(&self) -> Integer {
        (&self.lo + &self.hi) >> 1
    }

    /// The width in units of `2^-bits`.
    pub fn width_units(&self) -> Integer {
        &self.hi - &self.lo
    }

    /// The greatest absolute value in units of `2^-bits`.
    pub fn magnitude_units(&self) -> Integer {
        self.lo.abs().max(self.hi.abs())
    }

    /// The least absolute value in units of `2^-bits`.
    pub fn least_magnitude_units(&self) -> Integer {
        if self.contains_zero() { Integer::ZERO } else { self.lo.abs().min(self.hi.abs()) }
    }

    /// Whether a number is inside.
    pub fn contains(&self, x: &Rational) -> bool {
        self.lower() <= *x && *x <= self.upper()
    }

    /// Whether zero is inside.
    pub fn contains_zero(&self) -> bool {
        !self.lo.sign().is_gt() && !self.hi.is_negative()
    }

    /// Whether the number is zero for certain.
    pub fn is_zero(&self) -> bool {
        self.lo.is_zero() && self.hi.is_zero()
    }

    /// The sign, where all numbers of the ball have the same.
    pub fn sign(&self) -> Option<Sign> {
        if self.lo.sign().is_gt() {
            Some(Sign::Greater)
        } else if self.hi.is_negative() {
            Some(Sign::Less)
        } else if self.is_zero() {
            Some(Sign::Equal)
        } else {
            None
        }
    }

    /// The ball that holds both.
    pub fn union(&self, other: &Ball) -> Ball {
        debug_assert_eq!(self.bits, other.bits);
        let lo = (&self.lo).min(&other.lo).clone();
        let hi = (&self.hi).max(&other.hi).clone();
        Ball { lo, hi, bits: self.bits }
    }

    /// What both have in common; `None` where that is nothing.
    pub fn intersection(&self, other: &Ball) -> Option<Ball> {
        debug_assert_eq!(self.bits, other.bits);
        let lo = (&self.lo).max(&other.lo).clone();
        let hi = (&self.hi).min(&other.hi).clone();
        (lo <= hi).then_some(Ball { lo, hi, bits: self.bits })
    }

    /// With so many units more at either end.
    pub fn widened(&self, units: &Integer) -> Ball {
        Ball { lo: &self.lo - units, hi: &self.hi + units, bits: self.bits }
    }

    /// With another number of bits after the point, rounded outwards.
    pub fn with_bits(&self, bits: u64) -> Ball {
        if bits >= self.bits {
            let more = bits - self.bits;
            return Ball { lo: &self.lo << more, hi: &self.hi << more, bits };
        }
        let fewer = self.bits - bits;
        Ball { lo: &self.lo >> fewer, hi: -(&-&self.hi >> fewer), bits }
    }

    /// The sum, exactly.
    pub fn add(&self, other: &Ball) -> Ball {
        debug_assert_eq!(self.bits, other.bits);
        Ball { lo: &self.lo + &other.lo, hi: &self.hi + &other.hi, bits: self.bits }
    }

    /// The difference, exactly.
    pub fn sub(&self, other: &Ball) -> Ball {
        debug_assert_eq!(self.bits, other.bits);
        Ball { lo: &self.lo - &other.hi, hi: &self.hi - &other.lo, bits: self.bits }
    }

    /// The negative.
    pub fn neg(&self) -> Ball {
        Ball { lo: -&self.hi, hi: -&self.lo, bits: self.bits }
    }

    /// The factors of the ends of the product; `None` where both balls have numbers of both signs.
    fn factors<'b>(&'b self, other: &'b Ball) -> Option<[(&'b Integer, &'b Integer); 2]> {
        checkpoint(4 + (self.hi.bit_length() + other.hi.bit_length()) / 64);
        let (a, b, c, d) = (&self.lo, &self.hi, &other.lo, &other.hi);
        Some(match (a.is_negative(), b.sign().is_gt(), c.is_negative(), d.sign().is_gt()) {
            (false, _, false, _) => [(a, c), (b, d)],
            (false, _, true, false) => [(b, c), (a, d)],
            (false, _, true, true) => [(b, c), (b, d)],
            (true, false, false, _) => [(a, d), (b, c)],
            (true, false, true, false) => [(b, d), (a, c)],
            (true, false, true, true) => [(a, d), (a, c)],
            (true, true, false, _) => [(a, d), (b, d)],
            (true, true, true, false) => [(b, c), (a, c)],
            (true, true, true, true) => return None,
        })
    }

    /// The ends of the product in units of `2^-(2 bits)`.
    fn product_ends(&self, other: &Ball) -> (Integer, Integer) {
        match self.factors(other) {
            Some([(a, b), (c, d)]) => (a * b, c * d),
            None => {
                let (a, b, c, d) = (&self.lo, &self.hi, &other.lo, &other.hi);
                ((a * d).min(b * c), (a * c).max(b * d))
            }
        }
    }

    /// The sum of products of as many pairs, rounded once.
    fn sum_of_products<'b>(pairs: impl Iterator<Item = (&'b Ball, &'b Ball)>, bits: u64) -> Ball {
        let (mut lo, mut hi) = (Integer::ZERO, Integer::ZERO);
        for (a, b) in pairs.filter(|(a, b)| !a.is_zero() && !b.is_zero()) {
            if let Some([below, above]) = a.factors(b) {
                lo.add_mul_assign(below.0, below.1);
                hi.add_mul_assign(above.0, above.1);
            } else {
                let (below, above) = a.product_ends(b);
                lo += &below;
                hi += &above;
            }
        }
        Ball { lo: lo >> bits, hi: -(-hi >> bits), bits }
    }

    /// The product.
    pub fn mul(&self, other: &Ball) -> Ball {
        debug_assert_eq!(self.bits, other.bits);
        let (lo, hi) = self.product_ends(other);
        Ball { lo: lo >> self.bits, hi: -(-hi >> self.bits), bits: self.bits }
    }

    /// The square, which is not negative.
    pub fn square(&self) -> Ball {
        let (least, most) = (self.least_magnitude_units(), self.magnitude_units());
        Ball { lo: (&least * &least) >> self.bits, hi: -(-(&most * &most) >> self.bits), bits: self.bits }
    }

    /// The product with an integer, exactly.
    pub fn scaled(&self, n: &Integer) -> Ball {
        let (a, b) = (&self.lo * n, &self.hi * n);
        if n.is_negative() { Ball { lo: b, hi: a, bits: self.bits } } else { Ball { lo: a, hi: b, bits: self.bits } }
    }

    /// The product with a power of two, rounded outwards where the exponent is negative.
    pub fn shifted(&self, exponent: i64) -> Ball {
        let by = exponent.unsigned_abs();
        if exponent >= 0 {
            Ball { lo: &self.lo << by, hi: &self.hi << by, bits: self.bits }
        } else {
            Ball { lo: &self.lo >> by, hi: -(&-&self.hi >> by), bits: self.bits }
        }
    }

    /// The quotient; `None` where the divisor contains zero.
    pub fn div(&self, other: &Ball) -> Option<Ball> {
        debug_assert_eq!(self.bits, other.bits);
        let (divisor, dividend) = match other.sign()? {
            Sign::Greater => (other.clone(), self.clone()),
            Sign::Less => (other.neg(), self.neg()),
            Sign::Equal => return None,
        };
        checkpoint(8 + self.hi.bit_length() / 16);
        // A negative end is least over the smallest divisor, a positive one over the greatest.
        let below = if dividend.lo.is_negative() { &divisor.lo } else { &divisor.hi };
        let above = if dividend.hi.is_negative() { &divisor.hi } else { &divisor.lo };
        let lo = (&dividend.lo << self.bits).div_mod_floor(below).0;
        let hi = -(-&dividend.hi << self.bits).div_mod_floor(above).0;
        Some(Ball { lo, hi, bits: self.bits })
    }

    /// The quotient by a positive integer.
    ///
    /// # Panics
    /// When `n` is zero.
    pub fn divided_by(&self, n: u64) -> Ball {
        let n = Integer::from(n);
        Ball { lo: self.lo.div_mod_floor(&n).0, hi: -(-&self.hi).div_mod_floor(&n).0, bits: self.bits }
    }

    /// The power with a natural exponent, by squaring.
    pub fn power(&self, exponent: u64) -> Ball {
        let mut out = Ball::from_integer(&Integer::ONE, self.bits);
        let (mut base, mut rest) = (self.clone(), exponent);
        while rest > 0 {
            if rest % 2 == 1 {
                out = out.mul(&base);
            }
            rest /= 2;
            if rest > 0 {
                base = base.square();
            }
        }
        out
    }

    /// The square root of the part that is not negative; `None` where there is none.
    pub fn sqrt(&self) -> Option<Ball> {
        if self.hi.is_negative() {
            return None;
        }
        let floor = |n: &Integer| (n << self.bits).sqrt_floor();
        let lo = if self.lo.is_negative() { Integer::ZERO } else { floor(&self.lo) };
        let hi = floor(&self.hi);
        let hi = if &hi * &hi == &self.hi << self.bits { hi } else { hi + Integer::ONE };
        Some(Ball { lo, hi, bits: self.bits })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(lo: i64, hi: i64) -> Ball {
        Ball::from_units(lo.into(), hi.into(), 3)
    }

    #[test]
    fn products_quotients_and_roots_hold_those_of_all_pairs() {
        let ends = [-9i64, -8, -3, 0, 1, 5, 8, 17];
        let balls: Vec<Ball> =
            ends.iter().flat_map(|&a| ends.iter().filter(move |&&b| a <= b).map(move |&b| ball(a, b))).collect();
        let points = |b: &Ball| [b.lower(), b.lower().midpoint(&b.upper()), b.upper()];
        for a in &balls {
            for b in &balls {
                let (product, quotient) = (a.mul(b), a.div(b));
                assert_eq!(quotient.is_none(), b.contains_zero());
                for x in points(a) {
                    for y in points(b) {
                        assert!(product.contains(&(&x * &y)), "{a:?} {b:?}");
                        assert!(quotient.as_ref().is_none_or(|q| q.contains(&(&x / &y))), "{a:?} {b:?}");
                    }
                    assert!(a.square().contains(&(&x * &x)) && a.power(3).contains(&(&(&x * &x) * &x)));
                    assert!(a.divided_by(3).contains(&(&x / &Rational::from(3))));
                    assert!(a.with_bits(1).contains(&x) && a.shifted(-2).contains(&(&x / &Rational::from(4))));
                }
                // No wider than the outermost of the four products, rounded.
                let corners = [0, 2].map(|i| [0, 2].map(|j| &points(a)[i] * &points(b)[j]));
                let all = corners.concat();
                assert!(product.lower() > all.iter().min().unwrap() - &Rational::dyadic(&Integer::ONE, 3));
                assert!(product.upper() < all.iter().max().unwrap() + &Rational::dyadic(&Integer::ONE, 3));
            }
            match a.sqrt() {
                None => assert!(a.upper().is_negative()),
                Some(root) => assert!(&root.upper() * &root.upper() >= a.upper()),
            }
        }
    }

    #[test]
    fn signs_are_certain_or_not_known() {
        assert_eq!(ball(1, 2).sign(), Some(Sign::Greater));
        assert_eq!(ball(-2, -1).sign(), Some(Sign::Less));
        assert_eq!(ball(0, 0).sign(), Some(Sign::Equal));
        assert_eq!((ball(0, 1).sign(), ball(-1, 1).sign()), (None, None));
        assert_eq!(ball(0, 4).intersection(&ball(5, 6)), None);
        assert_eq!(ball(0, 4).union(&ball(5, 6)), ball(0, 6));
    }
}
