//! Numbers of 62 binary digits, for the search alone: what is found with them is tested exactly afterwards.

use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::UniPoly;

/// Binary digits of a mantissa.
const DIGITS: u32 = 62;

/// `mantissa 2^exponent`, rounded after each operation; the mantissa of a number that is not zero has all its digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rough {
    mantissa: i64,
    exponent: i64,
}

impl Rough {
    fn new(mantissa: i128, exponent: i64) -> Rough {
        let bits = i128::BITS - mantissa.unsigned_abs().leading_zeros();
        let (mantissa, exponent) = match bits {
            0 => (0, i64::MIN / 4),
            _ if bits > DIGITS => (mantissa >> (bits - DIGITS), exponent + i64::from(bits - DIGITS)),
            _ => (mantissa << (DIGITS - bits), exponent - i64::from(DIGITS - bits)),
        };
        Rough { mantissa: mantissa as i64, exponent }
    }

    pub fn of(x: &Integer) -> Rough {
        let shift = x.bit_length().saturating_sub(u64::from(DIGITS));
        let magnitude = &x.abs() >> shift;
        let digits = magnitude.as_limbs().first().copied().unwrap_or(0) as i128;
        Rough::new(if x.is_negative() { -digits } else { digits }, shift as i64)
    }

    pub fn of_rational(x: &Rational) -> Rough {
        let (above, below) = (Rough::of(&x.numerator()), Rough::of(&x.denominator()));
        let quotient = (i128::from(above.mantissa) << DIGITS) / i128::from(below.mantissa);
        Rough::new(quotient, above.exponent - below.exponent - i64::from(DIGITS))
    }

    pub fn is_positive(self) -> bool {
        self.mantissa > 0
    }

    fn times(self, other: Rough) -> Rough {
        Rough::new(i128::from(self.mantissa) * i128::from(other.mantissa), self.exponent + other.exponent)
    }

    fn plus(self, other: Rough) -> Rough {
        let (large, small) = if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let apart = large.exponent - small.exponent;
        if small.mantissa == 0 || apart > i64::from(DIGITS) + 1 {
            return large;
        }
        Rough::new((i128::from(large.mantissa) << apart) + i128::from(small.mantissa), small.exponent)
    }

    fn negated(self) -> Rough {
        Rough { mantissa: -self.mantissa, ..self }
    }
}

/// A polynomial with rounded coefficients.
pub(super) struct RoughPoly(Vec<Rough>);

impl RoughPoly {
    pub fn of(p: &UniPoly) -> RoughPoly {
        RoughPoly(p.coeffs().iter().map(Rough::of).collect())
    }

    pub fn at(&self, t: Rough) -> Rough {
        self.0.iter().rev().fold(Rough::new(0, 0), |sum, &c| sum.times(t).plus(c))
    }
}

/// Whether the first column of Routh's table has one sign, by and large.
pub(super) fn is_roughly_hurwitz(coefficients: &[Rough]) -> bool {
    let Some(last) = coefficients.last() else { return false };
    let signed: Vec<Rough> =
        coefficients.iter().rev().map(|c| if last.is_positive() { *c } else { c.negated() }).collect();
    let mut above: Vec<Rough> = signed.iter().step_by(2).copied().collect();
    let mut row: Vec<Rough> = signed.iter().skip(1).step_by(2).copied().collect();
    if !above[0].is_positive() {
        return false;
    }
    while let Some(&first) = row.first() {
        if !first.is_positive() {
            return false;
        }
        let next = |j: usize| {
            let other = row.get(j + 1).map_or(Rough::new(0, 0), |&c| above[0].times(c));
            first.times(above[j + 1]).plus(other.negated())
        };
        let below: Vec<Rough> = (0..above.len() - 1).map(next).collect();
        (above, row) = (row, below);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::is_hurwitz_routh;
    use proptest::prelude::*;

    #[test]
    fn numbers_keep_their_digits() {
        let third = Rough::of_rational(&Rational::new(1.into(), 3.into()));
        let sum = third.plus(third).plus(third);
        let off = sum.plus(Rough::of(&Integer::ONE).negated());
        assert!(off.mantissa == 0 || off.exponent < -110, "{off:?}");
        let p = UniPoly::from_i64(&[-6, 1, 1]);
        let at = |t: i64| RoughPoly::of(&p).at(Rough::of(&Integer::from(t)));
        assert!(at(3).is_positive() && !at(2).is_positive() && !at(1).is_positive());
    }

    proptest! {
        #[test]
        fn small_polynomials_are_told_as_exactly(c in prop::collection::vec(-9i64..30, 1..=5)) {
            let p = UniPoly::from_i64(&c);
            prop_assume!(c.last() != Some(&0));
            let rough: Vec<Rough> = p.coeffs().iter().map(Rough::of).collect();
            prop_assert_eq!(is_roughly_hurwitz(&rough), is_hurwitz_routh(&p));
        }
    }
}
