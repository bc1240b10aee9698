//! Integers of any size.

use super::huge;
use crate::limits::{checkpoint, claim, is_limited};
use malachite_base::num::arithmetic::traits::{
    Abs, AddMulAssign, DivExact, DivMod, DivisibleBy, FloorRoot, FloorSqrt, Gcd, Lcm, Parity, Pow, Sign as _,
    SubMulAssign,
};
use malachite_base::num::conversion::traits::RoundingFrom;
use malachite_base::num::logic::traits::SignificantBits;
use malachite_base::rounding_modes::RoundingMode;
use malachite_nz::integer::Integer as Inner;
use malachite_nz::natural::Natural;
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Mul, MulAssign, Neg, Shl, Shr, Sub, SubAssign};

/// Operands of at least so many limbs count as work of their own; loops count operations on smaller ones.
const COUNTED_LIMBS: u64 = 64;

#[inline]
fn limbs_of(x: &Inner) -> u64 {
    x.unsigned_abs_ref().limb_count()
}

/// Whether one of two operands is so large that an operation counts as work of its own.
#[inline]
fn is_counted(a: &Inner, b: &Inner) -> bool {
    limbs_of(a) | limbs_of(b) >= COUNTED_LIMBS
}

/// Counts a product; whether it is to be done in pieces.
#[cold]
fn counted_product(a: &Inner, b: &Inner) -> bool {
    let (n, m) = (limbs_of(a), limbs_of(b));
    claim(8 * (n + m));
    let huge = n.min(m) > 1 && 64 * n.max(m) > huge::PRODUCT_BITS && is_limited();
    if !huge {
        checkpoint(huge::work_of_product(n, m));
    }
    huge
}

/// Counts a quotient; whether it is to be done in pieces.
#[cold]
fn counted_quotient(a: &Inner, b: &Inner) -> bool {
    let (n, m) = (limbs_of(a), limbs_of(b));
    let huge = m > 1 && 64 * n > huge::PRODUCT_BITS && is_limited();
    if !huge {
        checkpoint(2 * huge::work_of_product(n.saturating_sub(m) + 1, m));
    }
    huge
}

#[cold]
fn counted_sum(a: &Inner, b: &Inner) {
    checkpoint((limbs_of(a) + limbs_of(b)) / 32);
}

/// In pieces.
fn product(a: &Inner, b: &Inner) -> Inner {
    let magnitude = huge::product(a.unsigned_abs_ref(), b.unsigned_abs_ref(), huge::PRODUCT_BITS);
    Inner::from_sign_and_abs((*a < 0) == (*b < 0), magnitude)
}

/// Quotient rounded towards zero and remainder with the sign of the dividend, in pieces.
fn div_rem(a: &Inner, b: &Inner) -> (Inner, Inner) {
    let (q, r) = huge::div_rem(a.unsigned_abs_ref(), b.unsigned_abs_ref(), huge::PRODUCT_BITS);
    (Inner::from_sign_and_abs((*a < 0) == (*b < 0), q), Inner::from_sign_and_abs(*a >= 0, r))
}

/// An integer of any size; values below 2^64 in magnitude do not allocate.
///
/// ```
/// use jurist_algebra::number::Integer;
/// let n = Integer::from(6) * Integer::from(-7);
/// assert_eq!(n.to_string(), "-42");
/// assert_eq!(n.gcd(&Integer::from(28)), Integer::from(14));
/// ```
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Integer(pub(super) Inner);

impl Integer {
    /// Zero.
    pub const ZERO: Integer = Integer(<Inner as malachite_base::num::basic::traits::Zero>::ZERO);
    /// One.
    pub const ONE: Integer = Integer(<Inner as malachite_base::num::basic::traits::One>::ONE);

    /// Whether this is 0.
    pub fn is_zero(&self) -> bool {
        self.0 == 0u32
    }

    /// Whether this is 1.
    pub fn is_one(&self) -> bool {
        self.0 == 1u32
    }

    /// The sign.
    pub fn sign(&self) -> Ordering {
        self.0.sign()
    }

    /// Whether this is below zero.
    pub fn is_negative(&self) -> bool {
        self.sign() == Ordering::Less
    }

    /// Whether 2 divides this.
    pub fn is_even(&self) -> bool {
        (&self.0).even()
    }

    /// The magnitude.
    pub fn abs(&self) -> Integer {
        Integer((&self.0).abs())
    }

    /// The non-negative greatest common divisor; `gcd(0, 0) = 0`.
    pub fn gcd(&self, other: &Integer) -> Integer {
        let (a, b) = (self.0.unsigned_abs_ref(), other.0.unsigned_abs_ref());
        if is_counted(&self.0, &other.0) {
            let (n, m) = (a.limb_count(), b.limb_count());
            if 64 * n.max(m) > huge::GCD_BITS && n.min(m) > 0 && is_limited() {
                return Integer(Inner::from(huge::gcd(a, b, huge::GCD_BITS)));
            }
            checkpoint(huge::work_of_gcd(n, m));
        }
        // One of the two is a power of two where numbers are dyadic, as ends of enclosures are.
        for (x, y) in [(self, other), (other, self)] {
            if let (Some(power), Some(zeros)) = (y.trailing_zeros(), x.trailing_zeros())
                && power + 1 == y.bit_length()
            {
                return Integer::ONE << power.min(zeros);
            }
        }
        Integer(Inner::from(a.gcd(b)))
    }

    /// The non-negative least common multiple; 0 if either is 0.
    pub fn lcm(&self, other: &Integer) -> Integer {
        if is_counted(&self.0, &other.0) {
            let g = self.gcd(other);
            return if g.is_zero() { g } else { (self.div_exact(&g) * other).abs() };
        }
        Integer(Inner::from(self.0.unsigned_abs_ref().lcm(other.0.unsigned_abs_ref())))
    }

    /// The quotient by a divisor; the result is unspecified when `other` does not divide `self`.
    ///
    /// # Panics
    /// When `other` is zero.
    pub fn div_exact(&self, other: &Integer) -> Integer {
        if is_counted(&self.0, &other.0) && counted_quotient(&self.0, &other.0) {
            return Integer(div_rem(&self.0, &other.0).0);
        }
        Integer((&self.0).div_exact(&other.0))
    }

    /// Whether `other` divides this; 0 is divisible by everything, only 0 is divisible by 0.
    pub fn divisible_by(&self, other: &Integer) -> bool {
        if is_counted(&self.0, &other.0) && counted_quotient(&self.0, &other.0) {
            return div_rem(&self.0, &other.0).1 == 0;
        }
        (&self.0).divisible_by(&other.0)
    }

    /// Quotient rounded towards minus infinity and the remainder, which has the divisor's sign.
    ///
    /// # Panics
    /// When `other` is zero.
    pub fn div_mod_floor(&self, other: &Integer) -> (Integer, Integer) {
        if is_counted(&self.0, &other.0) && counted_quotient(&self.0, &other.0) {
            let (q, r) = div_rem(&self.0, &other.0);
            let up = r != 0 && (r < 0) != (other.0 < 0);
            return if up { (Integer(q) - Integer::ONE, Integer(r + &other.0)) } else { (Integer(q), Integer(r)) };
        }
        let (q, r) = (&self.0).div_mod(&other.0);
        (Integer(q), Integer(r))
    }

    /// The power; `0^0 = 1`.
    pub fn pow(&self, exponent: u64) -> Integer {
        let bits = self.bit_length().saturating_mul(exponent);
        if bits >= 64 * COUNTED_LIMBS && self.bit_length() > 1 {
            claim(bits / 8);
            if bits > huge::PRODUCT_BITS && is_limited() {
                let magnitude = huge::power(self.0.unsigned_abs_ref(), exponent, huge::PRODUCT_BITS);
                return Integer(Inner::from_sign_and_abs(!self.is_negative() || exponent.is_multiple_of(2), magnitude));
            }
            checkpoint(huge::work_of_product(bits / 64, bits / 64));
        }
        Integer((&self.0).pow(exponent))
    }

    /// Number of bits of the magnitude; 0 for 0.
    pub fn bit_length(&self) -> u64 {
        self.0.significant_bits()
    }

    /// How often 2 divides this; `None` for 0.
    pub fn trailing_zeros(&self) -> Option<u64> {
        self.0.trailing_zeros()
    }

    /// The greatest integer whose square is at most this.
    ///
    /// # Panics
    /// When this is negative.
    pub fn sqrt_floor(&self) -> Integer {
        Integer((&self.0).floor_sqrt())
    }

    /// The greatest integer whose power with this positive exponent is at most this.
    ///
    /// # Panics
    /// When this is negative or the exponent is 0.
    pub fn root_floor(&self, exponent: u64) -> Integer {
        assert!(!self.is_negative(), "the root of a negative number");
        Integer((&self.0).floor_root(exponent))
    }

    /// `self += a * b` without an intermediate copy.
    pub fn add_mul_assign(&mut self, a: &Integer, b: &Integer) {
        if is_counted(&a.0, &b.0) && counted_product(&a.0, &b.0) {
            self.0 += product(&a.0, &b.0);
            return;
        }
        self.0.add_mul_assign(&a.0, &b.0);
    }

    /// `self -= a * b` without an intermediate copy.
    pub fn sub_mul_assign(&mut self, a: &Integer, b: &Integer) {
        if is_counted(&a.0, &b.0) && counted_product(&a.0, &b.0) {
            self.0 -= product(&a.0, &b.0);
            return;
        }
        self.0.sub_mul_assign(&a.0, &b.0);
    }

    /// The residue in `0..modulus`.
    ///
    /// # Panics
    /// When `modulus` is zero.
    pub fn mod_u64(&self, modulus: u64) -> u64 {
        // A division of 128 bits for each limb.
        if limbs_of(&self.0) >= COUNTED_LIMBS / 4 {
            checkpoint(2 * limbs_of(&self.0));
        }
        let modulus_wide = u128::from(modulus);
        let step = |r: u64, limb: &u64| ((u128::from(r) << 64 | u128::from(*limb)) % modulus_wide) as u64;
        let residue = self.as_limbs().iter().rev().fold(0, step);
        if self.is_negative() && residue != 0 { modulus - residue } else { residue }
    }

    /// The magnitude's 64-bit limbs, least significant first; empty for 0.
    pub fn limbs(&self) -> Vec<u64> {
        self.0.unsigned_abs_ref().to_limbs_asc()
    }

    /// The magnitude's 64-bit limbs in place, least significant first.
    pub fn as_limbs(&self) -> &[u64] {
        self.0.unsigned_abs_ref().as_limbs_asc()
    }

    /// The integer with these 64-bit limbs in two's complement, least significant first.
    pub fn from_twos_complement(limbs: &[u64]) -> Integer {
        Integer(Inner::from_twos_complement_limbs_asc(limbs))
    }

    /// The non-negative integer with these 64-bit limbs, least significant first.
    pub fn from_limbs(limbs: Vec<u64>) -> Integer {
        Integer(Inner::from(Natural::from_owned_limbs_asc(limbs)))
    }

    /// The value as `i64`, if it fits.
    pub fn to_i64(&self) -> Option<i64> {
        i64::try_from(&self.0).ok()
    }

    /// The value as `i128`, if it fits.
    pub fn to_i128(&self) -> Option<i128> {
        i128::try_from(&self.0).ok()
    }

    /// The nearest `f64`, infinite beyond its range: for pictures, never for decisions.
    pub fn to_f64_approximate(&self) -> f64 {
        f64::rounding_from(&self.0, RoundingMode::Nearest).0
    }

    /// Digits in base ten, with a minus sign if negative. An optional sign and at least one digit
    /// are expected, nothing else.
    pub fn from_decimal(text: &str) -> Option<Integer> {
        let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
        if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return None;
        }
        let magnitude = if 4 * digits.len() as u64 > huge::DIGITS_BITS && is_limited() {
            Inner::from(huge::from_digits(digits, huge::DIGITS_BITS))
        } else {
            digits.parse().ok()?
        };
        Some(Integer(if text.starts_with('-') { -magnitude } else { magnitude }))
    }
}

macro_rules! from_primitive {
    ($($t:ty),*) => {$(
        impl From<$t> for Integer {
            fn from(value: $t) -> Self {
                Integer(Inner::from(value))
            }
        }
    )*};
}
from_primitive!(i32, i64, i128, u32, u64, u128, usize);

macro_rules! binary {
    ($trait:ident, $method:ident, $assign_trait:ident, $assign:ident, $in_pieces:expr) => {
        impl $trait for Integer {
            type Output = Integer;
            fn $method(self, other: Integer) -> Integer {
                if is_counted(&self.0, &other.0)
                    && let Some(value) = $in_pieces(&self.0, &other.0)
                {
                    return Integer(value);
                }
                Integer($trait::$method(self.0, other.0))
            }
        }
        impl $trait<&Integer> for Integer {
            type Output = Integer;
            fn $method(self, other: &Integer) -> Integer {
                if is_counted(&self.0, &other.0)
                    && let Some(value) = $in_pieces(&self.0, &other.0)
                {
                    return Integer(value);
                }
                Integer($trait::$method(self.0, &other.0))
            }
        }
        impl $trait<Integer> for &Integer {
            type Output = Integer;
            fn $method(self, other: Integer) -> Integer {
                if is_counted(&self.0, &other.0)
                    && let Some(value) = $in_pieces(&self.0, &other.0)
                {
                    return Integer(value);
                }
                Integer($trait::$method(&self.0, other.0))
            }
        }
        impl $trait for &Integer {
            type Output = Integer;
            fn $method(self, other: &Integer) -> Integer {
                if is_counted(&self.0, &other.0)
                    && let Some(value) = $in_pieces(&self.0, &other.0)
                {
                    return Integer(value);
                }
                Integer($trait::$method(&self.0, &other.0))
            }
        }
        impl $assign_trait<&Integer> for Integer {
            fn $assign(&mut self, other: &Integer) {
                if is_counted(&self.0, &other.0)
                    && let Some(value) = $in_pieces(&self.0, &other.0)
                {
                    self.0 = value;
                    return;
                }
                $assign_trait::$assign(&mut self.0, &other.0);
            }
        }
        impl $assign_trait for Integer {
            fn $assign(&mut self, other: Integer) {
                if is_counted(&self.0, &other.0)
                    && let Some(value) = $in_pieces(&self.0, &other.0)
                {
                    self.0 = value;
                    return;
                }
                $assign_trait::$assign(&mut self.0, other.0);
            }
        }
    };
}

/// Sums are done at once.
fn no_pieces(a: &Inner, b: &Inner) -> Option<Inner> {
    counted_sum(a, b);
    None
}

fn product_in_pieces(a: &Inner, b: &Inner) -> Option<Inner> {
    counted_product(a, b).then(|| product(a, b))
}

binary!(Add, add, AddAssign, add_assign, no_pieces);
binary!(Sub, sub, SubAssign, sub_assign, no_pieces);
binary!(Mul, mul, MulAssign, mul_assign, product_in_pieces);

impl Neg for Integer {
    type Output = Integer;
    fn neg(self) -> Integer {
        Integer(-self.0)
    }
}

impl Neg for &Integer {
    type Output = Integer;
    fn neg(self) -> Integer {
        Integer(-&self.0)
    }
}

impl Shl<u64> for &Integer {
    type Output = Integer;
    /// Multiplication by `2^bits`.
    fn shl(self, bits: u64) -> Integer {
        Integer(&self.0 << bits)
    }
}

impl Shr<u64> for &Integer {
    type Output = Integer;
    /// Division by `2^bits`, rounded towards minus infinity.
    fn shr(self, bits: u64) -> Integer {
        Integer(&self.0 >> bits)
    }
}

impl Shl<u64> for Integer {
    type Output = Integer;
    fn shl(self, bits: u64) -> Integer {
        Integer(self.0 << bits)
    }
}

impl Shr<u64> for Integer {
    type Output = Integer;
    fn shr(self, bits: u64) -> Integer {
        Integer(self.0 >> bits)
    }
}

impl fmt::Display for Integer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.bit_length() > huge::DIGITS_BITS && is_limited() {
            let digits = huge::to_digits(self.0.unsigned_abs_ref(), huge::DIGITS_BITS);
            return f.pad_integral(!self.is_negative(), "", &digits);
        }
        fmt::Display::fmt(&self.0, f)
    }
}

impl fmt::Debug for Integer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}
