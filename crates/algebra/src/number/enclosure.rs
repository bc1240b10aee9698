//! Certified enclosures: intervals with dyadic ends, rounded outwards.
//!
//! Frequencies and decibels need pi, arc cosine, square root and logarithm. Each operation returns
//! an interval that contains every value of the exact operation on the operands, and gets narrower as
//! the number of bits grows.

use super::rounding::{
    binary_exponent, product_down, product_up, quotient_down, round_down, round_up, scaled_floor, sum_down, unscaled,
};
use super::{Integer, Rational, enclosed_decimal};
use crate::limits::{checkpoint, doubling};
use std::sync::OnceLock;

/// A closed interval that is known to contain a real number.
///
/// ```
/// use jurist_algebra::number::{Enclosure, Rational};
/// let root = Enclosure::from_rational(Rational::from(2)).sqrt(64);
/// assert!(root.lower() < root.upper());
/// assert_eq!(root.decimal(10).unwrap(), "1.414213562");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Enclosure {
    lo: Rational,
    hi: Rational,
}

impl Enclosure {
    /// The interval between two numbers.
    ///
    /// # Panics
    /// When `lo > hi`.
    pub fn new(lo: Rational, hi: Rational) -> Self {
        assert!(lo <= hi, "the ends of an enclosure are in order");
        Enclosure { lo, hi }
    }

    /// A number that is known exactly.
    pub fn from_rational(value: Rational) -> Self {
        Enclosure { lo: value.clone(), hi: value }
    }

    /// The lower end.
    pub fn lower(&self) -> &Rational {
        &self.lo
    }

    /// The upper end.
    pub fn upper(&self) -> &Rational {
        &self.hi
    }

    /// Whether a number lies in the interval.
    pub fn contains(&self, value: &Rational) -> bool {
        self.lo <= *value && *value <= self.hi
    }

    /// The decimal that all numbers of the interval round to, if there is one.
    pub fn decimal(&self, digits: usize) -> Option<String> {
        enclosed_decimal(&self.lo, &self.hi, digits)
    }

    /// Ends of `bits` significant bits around this one.
    pub fn rounded(&self, bits: u64) -> Enclosure {
        Enclosure { lo: round_down(&self.lo, bits), hi: round_up(&self.hi, bits) }
    }

    /// The sum.
    pub fn add(&self, other: &Enclosure, bits: u64) -> Enclosure {
        Enclosure { lo: sum_down(&self.lo, &other.lo, bits), hi: -sum_down(&-&self.hi, &-&other.hi, bits) }
    }

    /// The difference.
    pub fn sub(&self, other: &Enclosure, bits: u64) -> Enclosure {
        self.add(&other.neg(), bits)
    }

    /// The negative.
    pub fn neg(&self) -> Enclosure {
        Enclosure { lo: -&self.hi, hi: -&self.lo }
    }

    /// The product.
    pub fn mul(&self, other: &Enclosure, bits: u64) -> Enclosure {
        if self.hi.is_negative() {
            return self.neg().mul(other, bits).neg();
        }
        if other.lo.is_negative() && !self.lo.is_negative() {
            // The other one has the sign to choose by: either below zero or on both sides of it.
            let lo = product_down(&self.hi, &other.lo, bits);
            let factor = if other.hi.is_negative() { &self.lo } else { &self.hi };
            return Enclosure { lo, hi: product_up(factor, &other.hi, bits) };
        }
        if !self.lo.is_negative() {
            let lo = product_down(&self.lo, &other.lo, bits);
            return Enclosure { lo, hi: product_up(&self.hi, &other.hi, bits) };
        }
        // This one is on both sides of zero.
        if !other.lo.is_negative() {
            let lo = product_down(&self.lo, &other.hi, bits);
            return Enclosure { lo, hi: product_up(&self.hi, &other.hi, bits) };
        }
        let lo = product_down(&self.lo, &other.hi, bits).min(product_down(&self.hi, &other.lo, bits));
        let hi = product_up(&self.lo, &other.lo, bits).max(product_up(&self.hi, &other.hi, bits));
        Enclosure { lo, hi }
    }

    /// The quotient; `None` when the divisor contains zero.
    pub fn div(&self, other: &Enclosure, bits: u64) -> Option<Enclosure> {
        if other.hi.is_negative() {
            return self.neg().div(&other.neg(), bits);
        }
        if other.lo.is_negative() || other.lo.is_zero() {
            return None;
        }
        let below = if self.lo.is_negative() { &other.lo } else { &other.hi };
        let above = if self.hi.is_negative() { &other.hi } else { &other.lo };
        let (lo, hi) = (quotient_down(&self.lo, below, bits), -quotient_down(&-&self.hi, above, bits));
        Some(Enclosure { lo, hi })
    }

    /// The square root of the non-negative part.
    ///
    /// Cost: two integer square roots of about `2 bits` bits.
    ///
    /// # Panics
    /// When the whole interval is negative.
    pub fn sqrt(&self, bits: u64) -> Enclosure {
        assert!(!self.hi.is_negative(), "the square root of a negative number");
        let lo = if self.lo.is_negative() { Rational::ZERO } else { sqrt_down(&self.lo, bits) };
        let hi = sqrt_down(&self.hi, bits);
        let up = if &hi * &hi == self.hi { hi } else { hi + sqrt_ulp(&self.hi, bits) };
        Enclosure { lo, hi: up }
    }

    /// pi, by Machin's formula `pi/4 = 4 atan(1/5) - atan(1/239)`.
    ///
    /// Cost: `O(bits)` products and divisions of `bits` bits; what most questions ask for is computed once.
    pub fn pi(bits: u64) -> Enclosure {
        static KEPT: OnceLock<Enclosure> = OnceLock::new();
        if bits > KEPT_PI_BITS {
            return pi_by_machin(bits);
        }
        KEPT.get_or_init(|| pi_by_machin(KEPT_PI_BITS)).rounded(bits)
    }

    /// The arc tangent, which is increasing.
    pub fn atan(&self, bits: u64) -> Enclosure {
        Enclosure { lo: atan_point(&self.lo, bits).lo, hi: atan_point(&self.hi, bits).hi }
    }

    /// The arc cosine of the part in `[-1, 1]`, by `acos(x) = 2 atan(sqrt((1 - x)/(1 + x)))`, which
    /// keeps its relative accuracy near `x = 1`.
    ///
    /// Cost: that of a square root and an arc tangent for each end.
    ///
    /// # Panics
    /// When no part of the interval lies in `[-1, 1]`.
    pub fn acos(&self, bits: u64) -> Enclosure {
        let one = Rational::ONE;
        assert!(self.lo <= one && self.hi >= -&one, "the arc cosine of a number beyond [-1, 1]");
        Enclosure { lo: acos_point(&self.hi, bits).lo, hi: acos_point(&self.lo, bits).hi }
    }

    /// The natural logarithm of a positive interval, by `ln m = 2 artanh((m - 1)/(m + 1))` after powers
    /// of two are split off; `None` when the interval is not positive.
    pub fn ln(&self, bits: u64) -> Option<Enclosure> {
        let positive = |r: &Rational| !r.is_negative() && !r.is_zero();
        positive(&self.lo).then(|| Enclosure { lo: ln_point(&self.lo, bits).lo, hi: ln_point(&self.hi, bits).hi })
    }
}

/// Bits of pi that are kept: with those in between, enough for about 100 digits.
const KEPT_PI_BITS: u64 = 512;

fn pi_by_machin(bits: u64) -> Enclosure {
    let term = |n: i64, factor: i64| {
        let x = Rational::new(Integer::ONE, Integer::from(n));
        atan_series(&Enclosure::from_rational(x), bits + 8)
            .mul(&Enclosure::from_rational(Rational::from(factor)), bits + 8)
    };
    term(5, 16).sub(&term(239, 4), bits)
}

/// Calls `enclose` with more and more bits until all numbers of the enclosure round to the same
/// decimal; `None` if that does not happen by 64 times the digits asked for (the value is then a tie or
/// exactly representable, which a transcendental number never is).
pub fn to_decimal_refining(digits: usize, mut enclose: impl FnMut(u64) -> Option<Enclosure>) -> Option<String> {
    for bits in doubling(4 * digits as u64 + 32).take(6) {
        if let Some(text) = enclose(bits)?.decimal(digits) {
            return Some(text);
        }
    }
    None
}

/// The shift `k` of the square root's last bit: the root has `bits + 1` significant bits.
fn sqrt_shift(r: &Rational, bits: u64) -> i64 {
    bits as i64 - binary_exponent(r).div_euclid(2)
}

fn sqrt_down(r: &Rational, bits: u64) -> Rational {
    if r.is_zero() {
        return Rational::ZERO;
    }
    let k = sqrt_shift(r, bits);
    unscaled(&scaled_floor(r, 2 * k).sqrt_floor(), k)
}

fn sqrt_ulp(r: &Rational, bits: u64) -> Rational {
    if r.is_zero() { Rational::ZERO } else { unscaled(&Integer::ONE, sqrt_shift(r, bits)) }
}

/// `sum (-1)^k x^(2k+1)/(2k+1)` for `0 <= x <= 1/4`: an alternating series with falling terms, so the
/// first term left out bounds the rest.
fn atan_series(x: &Enclosure, bits: u64) -> Enclosure {
    odd_series(x, bits, true)
}

/// The series of arc tangent (`alternating`) or area tangent for `0 < x <= 1/2`, in fixed point.
///
/// All numbers are integers over `2^s`, rounded down. In units of `2^-s` the square is short by at most
/// `2 x + 1 <= 3`, by induction a power by at most `e/4 + 3/2 + 1 <= 4`, so a term by at most 3, and both
/// functions climb by at most `4/3` of the width of `x`. An alternating series leaves less than the first
/// term left out, the other one less than `1/(1 - x^2)` times it, which is below twice it.
fn odd_series(x: &Enclosure, bits: u64, alternating: bool) -> Enclosure {
    let working = bits + 16 + u64::from(u64::BITS - bits.leading_zeros());
    let s = u64::try_from(working as i64 - binary_exponent(&x.lo)).expect("x is at most one half");
    let start = scaled_floor(&x.lo, s as i64);
    let width = scaled_floor(&(&x.hi - &x.lo), s as i64) + Integer::ONE;
    let square = &(&start * &start) >> s;
    let (mut power, mut sum) = (start.clone(), start);
    let mut k = 1i64;
    let last = loop {
        checkpoint(16);
        power = &(&power * &square) >> s;
        let term = power.div_mod_floor(&Integer::from(2 * k + 1)).0;
        if term.is_zero() {
            break k;
        }
        sum = if alternating && k % 2 == 1 { sum - &term } else { sum + &term };
        k += 1;
    };
    // The start, the terms, and what is left out: the first of it is below 4 units.
    let error = Integer::from(1 + 3 * last + 8);
    let climb = (&width + &width) + &error;
    Enclosure { lo: Rational::dyadic(&(&sum - &error), s), hi: Rational::dyadic(&(sum + climb), s) }.rounded(bits)
}

fn atan_point(x: &Rational, bits: u64) -> Enclosure {
    if x.is_negative() {
        return atan_point(&-x, bits).neg();
    }
    if x.is_zero() {
        return Enclosure::from_rational(Rational::ZERO);
    }
    let working = bits + 16;
    let one = Enclosure::from_rational(Rational::ONE);
    if *x > Rational::ONE {
        let inverse = x.recip().expect("above one");
        let half_pi =
            Enclosure::pi(working).mul(&Enclosure::from_rational(Rational::dyadic(&Integer::ONE, 1)), working);
        return half_pi.sub(&atan_point(&inverse, working), bits);
    }
    // atan(x) = 2 atan(x / (1 + sqrt(1 + x^2))) until the series converges by four bits a term.
    let mut reduced = Enclosure::from_rational(x.clone()).rounded(working);
    let mut doublings = 0u64;
    while reduced.hi > Rational::dyadic(&Integer::ONE, 2) {
        let root = one.add(&reduced.mul(&reduced, working), working).sqrt(working);
        reduced = reduced.div(&one.add(&root, working), working).expect("above one");
        doublings += 1;
    }
    let factor = Rational::from(&Integer::ONE << doublings);
    atan_series(&reduced, working).mul(&Enclosure::from_rational(factor), bits)
}

fn acos_point(x: &Rational, bits: u64) -> Enclosure {
    let one = Rational::ONE;
    if *x >= one {
        return Enclosure::from_rational(Rational::ZERO);
    }
    if *x <= -&one {
        return Enclosure::pi(bits);
    }
    let working = bits + 8;
    let tangent = Enclosure::from_rational((&one - x) / (&one + x)).sqrt(working);
    tangent.atan(working).mul(&Enclosure::from_rational(Rational::from(2)), bits)
}

fn ln_point(x: &Rational, bits: u64) -> Enclosure {
    if x.is_one() {
        return Enclosure::from_rational(Rational::ZERO);
    }
    let working = bits + 16;
    // x = m 2^k with m in (2/3, 4/3]: x is kept as it is when it is near one, where the logarithm is small.
    let mut k = 0i64;
    let mut m = x.clone();
    let three = Rational::from(3);
    let bound = |r: &Rational, n: i64| (r * &three).cmp(&Rational::from(n));
    if bound(&m, 4).is_gt() || bound(&m, 2).is_le() {
        k = m.numerator().bit_length() as i64 - m.denominator().bit_length() as i64;
        m = &m * &Rational::from(2).pow(-k).expect("two is not zero");
        while bound(&m, 4).is_gt() {
            m = m / Rational::from(2);
            k += 1;
        }
        while bound(&m, 2).is_le() {
            m *= Rational::from(2);
            k -= 1;
        }
    }
    let artanh = |t: Rational| {
        let negative = t.is_negative();
        let series = odd_series(&Enclosure::from_rational(t.abs()), working, false);
        let doubled = series.mul(&Enclosure::from_rational(Rational::from(2)), working);
        if negative { doubled.neg() } else { doubled }
    };
    let fraction = if m.is_one() {
        Enclosure::from_rational(Rational::ZERO)
    } else {
        artanh((&m - Rational::ONE) / (&m + Rational::ONE))
    };
    if k == 0 {
        return fraction.rounded(bits);
    }
    let ln2 = artanh(Rational::new(Integer::ONE, Integer::from(3)));
    ln2.mul(&Enclosure::from_rational(Rational::from(k)), working).add(&fraction, bits)
}

#[cfg(test)]
mod tests {
    use super::super::parse_number;
    use super::*;

    fn at(text: &str) -> Enclosure {
        Enclosure::from_rational(parse_number(text).unwrap())
    }

    #[test]
    fn known_digits() {
        assert_eq!(
            Enclosure::pi(400).decimal(100).unwrap(),
            "3.141592653589793238462643383279502884197169399375105820974944592307816406286208998628034825342117068"
        );
        assert_eq!(at("2").ln(200).unwrap().decimal(40).unwrap(), "0.6931471805599453094172321214581765680755");
        assert_eq!(at("10").ln(200).unwrap().decimal(40).unwrap(), "2.302585092994045684017991454684364207601");
        assert_eq!(at("1/2").acos(200).decimal(40).unwrap(), "1.047197551196597746154214461093167628066");
        assert_eq!(at("-1").acos(100).decimal(20).unwrap(), "3.1415926535897932385");
        assert_eq!(at("1").acos(100), at("0"));
        assert_eq!(at("1").atan(100).decimal(20).unwrap(), "0.78539816339744830962");
        // acos(1 - e) = sqrt(2e) (1 + e/12 + 3 e^2/160 + ...), e = 5e-20.
        assert_eq!(at("0.99999999999999999995").acos(200).decimal(20).unwrap(), "3.1622776601683793320e-10");
        assert_eq!(at("1.0000000001").ln(120).unwrap().decimal(20).unwrap(), "9.9999999995000000000e-11");
    }

    #[test]
    fn exact_roots_stay_exact() {
        assert_eq!(at("9/4").sqrt(64), at("3/2"));
        assert_eq!(at("0").sqrt(64), at("0"));
        assert!(at("2").sqrt(64).lower() < at("2").sqrt(64).upper());
    }

    #[test]
    fn logarithms_add() {
        for (a, b) in [("3/7", "22/5"), ("1e30", "7e-9"), ("0.999", "1.001"), ("4/3", "2/3")] {
            let (x, y) = (at(a).ln(120).unwrap(), at(b).ln(120).unwrap());
            let product = Enclosure::from_rational(at(a).lower() * at(b).lower()).ln(120).unwrap();
            let sum = x.add(&y, 120);
            assert!(sum.lower() <= product.upper() && product.lower() <= sum.upper());
            let width = sum.upper() - sum.lower();
            assert!(width < Rational::dyadic(&Integer::ONE, 100));
        }
        assert!(at("-1").ln(50).is_none());
    }

    /// The reference, rounded at every step: the terms left out of the area tangent are at
    /// most `1/(1 - x^2)` times the first of them, which is below twice it for `x <= 1/2`.
    fn odd_series_in_intervals(x: &Enclosure, bits: u64, alternating: bool) -> Enclosure {
        let working = bits + 16;
        let square = x.mul(x, working);
        let mut power = x.rounded(working);
        let mut sum = power.clone();
        let mut k = 1i64;
        loop {
            power = power.mul(&square, working);
            let term = power
                .div(&Enclosure::from_rational(Rational::from(2 * k + 1)), working)
                .expect("an odd number is not zero");
            let size = term.hi.clone();
            let threshold = &sum.lo * &Rational::dyadic(&Integer::ONE, working);
            if size <= threshold {
                let (below, above) = match (alternating, k % 2 == 1) {
                    (true, true) => (size, Rational::ZERO),
                    (true, false) => (Rational::ZERO, size),
                    (false, _) => (Rational::ZERO, &size + &size),
                };
                return Enclosure { lo: &sum.lo - below, hi: &sum.hi + above }.rounded(bits);
            }
            sum = if alternating && k % 2 == 1 { sum.sub(&term, working) } else { sum.add(&term, working) };
            k += 1;
        }
    }

    #[test]
    fn series_in_fixed_point_agree_with_the_reference() {
        let xs = ["1/2", "1/3", "1/4", "0.2", "1/239", "0.4999", "1e-9", "3e-40", "0.123456789"];
        for (i, lo) in xs.iter().enumerate() {
            for bits in [2, 20, 64, 200, 700] {
                for spread in [0u64, 30, 90] {
                    let lo = parse_number(lo).unwrap();
                    let hi =
                        if spread == 0 { lo.clone() } else { &lo + &(&lo * &Rational::dyadic(&Integer::ONE, spread)) };
                    let x = Enclosure::new(lo, hi.min(Rational::dyadic(&Integer::ONE, 1)));
                    for alternating in [true, false] {
                        let fast = odd_series(&x, bits, alternating);
                        let reference = |x: &Rational| {
                            odd_series_in_intervals(&Enclosure::from_rational(x.clone()), bits + 60, alternating)
                        };
                        let (at_lo, at_hi) = (reference(&x.lo), reference(&x.hi));
                        assert!(fast.lo <= at_lo.lo && at_hi.hi <= fast.hi, "{i} {bits} {spread}");
                        let slack = Rational::dyadic(&Integer::from(4), bits) * &at_hi.hi;
                        let climb = Rational::from(2) * (&x.hi - &x.lo);
                        assert!(&fast.hi - &fast.lo <= slack + climb, "{i} {bits} {spread}");
                    }
                }
            }
        }
    }
}
