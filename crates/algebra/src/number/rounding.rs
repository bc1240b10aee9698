//! Rounding to a number of significant bits: what [`Enclosure`](super::Enclosure) computes its ends with.
//!
//! Ends are dyadic nearly always: products and sums of such numbers are integers and shifts, and a common divisor
//! is looked for nowhere.

use super::{Integer, Rational};
use std::cmp::Ordering;

/// `floor(r 2^s)` for a shift of either sign.
pub(super) fn scaled_floor(r: &Rational, s: i64) -> Integer {
    let (n, d) = r.parts();
    if let Some(k) = power_of_two(d) {
        let shift = s - k as i64;
        return if shift >= 0 { n << shift as u64 } else { n >> shift.unsigned_abs() };
    }
    if s >= 0 { (n << s as u64).div_mod_floor(d).0 } else { n.div_mod_floor(&(d << s.unsigned_abs())).0 }
}

/// `n 2^-s` for a shift of either sign.
pub(super) fn unscaled(n: &Integer, s: i64) -> Rational {
    if s >= 0 { Rational::dyadic(n, s as u64) } else { Rational::from(n << s.unsigned_abs()) }
}

/// `floor(log2 |r|)` of a number that is not zero.
pub(super) fn binary_exponent(r: &Rational) -> i64 {
    let (n, d) = r.parts();
    quotient_exponent(n, d)
}

/// `floor(log2 |n/d|)` of a number that is not zero.
///
/// The bit lengths alone tell it but for one, and differently for 4/3 and 3/2: with them the rounding
/// grid would depend on the quotient, and a smaller number could be rounded to a larger one.
fn quotient_exponent(n: &Integer, d: &Integer) -> i64 {
    let n = n.abs();
    let e = n.bit_length() as i64 - d.bit_length() as i64;
    let reaches = if e >= 0 { n >= d << e.unsigned_abs() } else { n << e.unsigned_abs() >= *d };
    if reaches { e } else { e - 1 }
}

/// The largest number of `bits` significant bits (at least one) that is not above `r`; monotone.
pub(super) fn round_down(r: &Rational, bits: u64) -> Rational {
    let (n, d) = r.parts();
    match power_of_two(d) {
        Some(k) => round_dyadic_down(n, k, bits),
        None => round_quotient_down(n, d, bits),
    }
}

/// `k` of `d = 2^k`.
fn power_of_two(d: &Integer) -> Option<u64> {
    let k = d.bit_length() - 1;
    (d.trailing_zeros() == Some(k)).then_some(k)
}

/// [`round_down`] of `n / 2^k`, by a shift.
fn round_dyadic_down(n: &Integer, k: u64, bits: u64) -> Rational {
    match n.bit_length().checked_sub(bits.max(1)) {
        None | Some(0) => Rational::dyadic(n, k),
        // A floor, for numbers below zero too.
        Some(drop) => unscaled(&(n >> drop), k as i64 - drop as i64),
    }
}

/// [`round_down`] of `n / d` for `d > 0`, in lowest terms or not.
fn round_quotient_down(n: &Integer, d: &Integer, bits: u64) -> Rational {
    if n.is_zero() {
        return Rational::ZERO;
    }
    let s = bits.max(1) as i64 - 1 - quotient_exponent(n, d);
    let floor = if s >= 0 { (n << s as u64).div_mod_floor(d).0 } else { n.div_mod_floor(&(d << s.unsigned_abs())).0 };
    unscaled(&floor, s)
}

/// [`round_down`] of `a + b`.
pub(super) fn sum_down(a: &Rational, b: &Rational, bits: u64) -> Rational {
    let ((n, d), (m, e)) = (a.parts(), b.parts());
    let (Some(k), Some(l)) = (power_of_two(d), power_of_two(e)) else { return round_down(&(a + b), bits) };
    let common = k.max(l);
    let scaled = |n: &Integer, k: u64| n << (common - k);
    let sum = match k.cmp(&l) {
        Ordering::Equal => n + m,
        Ordering::Less => scaled(n, k) + m,
        Ordering::Greater => scaled(m, l) + n,
    };
    round_dyadic_down(&sum, common, bits)
}

/// [`round_down`] of `a b`.
pub(super) fn product_down(a: &Rational, b: &Rational, bits: u64) -> Rational {
    let ((n, d), (m, e)) = (a.parts(), b.parts());
    match (power_of_two(d), power_of_two(e)) {
        (Some(k), Some(l)) => round_dyadic_down(&(n * m), k + l, bits),
        _ => round_quotient_down(&(n * m), &(d * e), bits),
    }
}

/// [`round_up`] of `a b`.
pub(super) fn product_up(a: &Rational, b: &Rational, bits: u64) -> Rational {
    -product_down(&-a, b, bits)
}

/// [`round_down`] of `a / b` for `b > 0`.
pub(super) fn quotient_down(a: &Rational, b: &Rational, bits: u64) -> Rational {
    let ((n, d), (m, e)) = (a.parts(), b.parts());
    round_quotient_down(&(n * e), &(d * m), bits)
}

pub(super) fn round_up(r: &Rational, bits: u64) -> Rational {
    -round_down(&-r, bits)
}

#[cfg(test)]
mod tests {
    use super::super::Enclosure;
    use super::*;
    use proptest::prelude::*;

    fn rational() -> impl Strategy<Value = Rational> {
        let part = any::<i128>().prop_map(Integer::from);
        let small = (-9i64..10).prop_map(Integer::from);
        let numerator = prop_oneof![part, small];
        let dyadic = (numerator.clone(), 0u64..200).prop_map(|(n, k)| Rational::dyadic(&n, k));
        let any_other = (numerator, 1u64..1000).prop_map(|(n, d)| Rational::new(n, Integer::from(d)));
        prop_oneof![3 => dyadic, 1 => any_other]
    }

    fn interval() -> impl Strategy<Value = Enclosure> {
        (rational(), rational()).prop_map(|(a, b)| Enclosure::new(a.clone().min(b.clone()), a.max(b)))
    }

    /// `floor(r 2^s) / 2^s` with `2^(bits - 1) <= |r 2^s| < 2^bits`, by division and trial.
    fn reference(r: &Rational, bits: u64) -> Rational {
        let (low, high) = (Rational::from(&Integer::ONE << (bits - 1)), Rational::from(&Integer::ONE << bits));
        let two = Rational::from(2);
        let (mut scaled, mut scale) = (r.clone(), Rational::ONE);
        while !scaled.is_zero() && scaled.abs() < low {
            (scaled, scale) = (&scaled * &two, &scale * &two);
        }
        while scaled.abs() >= high {
            (scaled, scale) = (scaled.checked_div(&two).unwrap(), scale.checked_div(&two).unwrap());
        }
        Rational::from(scaled.floor()).checked_div(&scale).unwrap()
    }

    fn reference_around(numbers: &[Rational], bits: u64) -> Enclosure {
        let lo = numbers.iter().min().unwrap();
        let hi = numbers.iter().max().unwrap();
        Enclosure::new(reference(lo, bits), -reference(&-hi, bits))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn interval_arithmetic_is_the_exact_one_rounded_once(x in interval(), y in interval(), bits in 1u64..90) {
            let pairs = |f: &dyn Fn(&Rational, &Rational) -> Rational| {
                let (a, b, c, d) = (x.lower(), x.upper(), y.lower(), y.upper());
                reference_around(&[f(a, c), f(a, d), f(b, c), f(b, d)], bits)
            };
            prop_assert_eq!(x.rounded(bits), reference_around(&[x.lower().clone(), x.upper().clone()], bits));
            prop_assert_eq!(x.mul(&y, bits), pairs(&|a, b| a * b));
            prop_assert_eq!(x.add(&y, bits), pairs(&|a, b| a + b));
            prop_assert_eq!(x.sub(&y, bits), pairs(&|a, b| a - b));
            match x.div(&y, bits) {
                Some(quotient) => prop_assert_eq!(quotient, pairs(&|a, b| a.checked_div(b).unwrap())),
                None => prop_assert!(y.contains(&Rational::ZERO)),
            }
        }
    }
}
