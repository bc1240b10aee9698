//! The sign of a long polynomial's value at a long number, where few of the value's digits tell it.

use super::UniPoly;
use crate::limits::checkpoint;
use crate::number::{Integer, Sign};

/// Digits that are kept, in bits.
const BITS: u64 = 192;

/// The exact value is computed at once where it has fewer bits than this.
const SHORT: u64 = 1 << 13;

/// A number within `error 2^exponent` of `mantissa 2^exponent`.
struct Rounded {
    mantissa: Integer,
    exponent: i64,
    error: Integer,
}

impl Rounded {
    /// No more than [`BITS`] bits; what is dropped goes into the error.
    fn shortened(mut self) -> Rounded {
        let bits = self.mantissa.bit_length().max(self.error.bit_length());
        if let Some(drop) = bits.checked_sub(BITS).filter(|&d| d > 0) {
            self.mantissa = &self.mantissa >> drop;
            self.error = (&self.error >> drop) + Integer::from(2);
            self.exponent += drop as i64;
        }
        self
    }

    /// The same number with a lower exponent.
    fn lowered(&self, exponent: i64) -> Rounded {
        let shift = (self.exponent - exponent) as u64;
        Rounded { mantissa: &self.mantissa << shift, exponent, error: &self.error << shift }
    }

    fn times(&self, x: &Rounded) -> Rounded {
        let mut error = &self.error * (x.mantissa.abs() + &x.error);
        error.add_mul_assign(&self.mantissa.abs(), &x.error);
        Rounded { mantissa: &self.mantissa * &x.mantissa, exponent: self.exponent + x.exponent, error }.shortened()
    }

    fn plus(self, c: &Integer) -> Rounded {
        if c.is_zero() {
            return self;
        }
        let c = Rounded { mantissa: c.clone(), exponent: 0, error: Integer::ZERO }.shortened();
        if self.mantissa.is_zero() && self.error.is_zero() {
            return c;
        }
        let top = |r: &Rounded| r.exponent + r.mantissa.bit_length().max(r.error.bit_length()) as i64;
        let (high, low) = if top(&self) >= top(&c) { (self, c) } else { (c, self) };
        // What is far below the last digit is an error of one.
        if top(&low) + 2 < high.exponent {
            return Rounded { error: high.error + Integer::ONE, ..high };
        }
        let exponent = high.exponent.min(low.exponent);
        let (high, low) = (high.lowered(exponent), low.lowered(exponent));
        let sum = Rounded { mantissa: high.mantissa + low.mantissa, exponent, error: high.error + low.error };
        sum.shortened()
    }
}

/// The sign of `p(a/q)`, `q > 0`; `None` where the value is short anyway, or too near to zero to be told.
///
/// Horner's rule on numbers of a fixed length with a bound of the error: `O(n)` operations on them.
pub(super) fn sign_by_rounding(p: &UniPoly, a: &Integer, q: &Integer) -> Option<Sign> {
    let degree = p.coeffs().len() as u64;
    if degree * a.bit_length().max(q.bit_length()) < SHORT {
        return None;
    }
    checkpoint(32 * degree);
    let shift = (BITS + q.bit_length()).saturating_sub(a.bit_length());
    let x = Rounded { mantissa: (a << shift).div_mod_floor(q).0, exponent: -(shift as i64), error: Integer::ONE }
        .shortened();
    let zero = Rounded { mantissa: Integer::ZERO, exponent: 0, error: Integer::ZERO };
    let value = p.coeffs().iter().rev().fold(zero, |value, c| value.times(&x).plus(c));
    (value.mantissa.abs() > value.error).then(|| value.mantissa.sign())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Rational;

    /// Against the exact value, at numbers near to roots and far from them.
    #[test]
    fn the_sign_is_that_of_the_value() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state >> 11
        };
        let (mut told, mut all) = (0, 0);
        for round in 0..400u64 {
            let degree = 20 + next() % 60;
            let size = 1 + next() % 900;
            let coefficient = |k: u64, bits: u64| {
                let value = (Integer::from(k | 1).pow(3)) << (bits % size);
                if k.is_multiple_of(2) { value } else { -value }
            };
            let mut p = UniPoly::new((0..=degree).map(|_| coefficient(next(), next())).collect());
            let q = Integer::from(next() | 1).pow(4 + round % 5);
            let a = Integer::from(next()).pow(4 + round % 5) - Integer::from(next());
            if round.is_multiple_of(3) {
                // A root within 1/q^2 of a/q, or at it.
                let near = UniPoly::new(vec![-(&a * &q) + Integer::from((round % 2) as i64), &q * &q]);
                p = crate::poly::Domain::times(&p, &near);
            }
            let exact = p.eval_rational(&Rational::new(a.clone(), q.clone())).sign();
            all += 1;
            if let Some(sign) = sign_by_rounding(&p, &a, &q) {
                assert_eq!(sign, exact, "round {round}");
                told += 1;
            }
        }
        assert!(told * 2 > all, "{told} of {all}");
    }
}
