//! Proptest generators of numbers, with the values that break arithmetic weighted in.

use super::{Integer, Rational};
use proptest::collection::vec;
use proptest::prelude::*;

/// Integers from -20 to 20: many zeros, ones and coincidences.
pub fn small_integer() -> impl Strategy<Value = Integer> {
    (-20i64..=20).prop_map(Integer::from)
}

/// Integers within 2 of `±2^k` for `k` at the edges of machine words: 31 to 33, 63 to 65, 127 to 129
/// bits and some more.
pub fn word_edge_integer() -> impl Strategy<Value = Integer> {
    let exponent = prop::sample::select(vec![31u64, 32, 33, 52, 53, 63, 64, 65, 127, 128, 129, 192, 256]);
    (exponent, -2i64..=2, any::<bool>()).prop_map(|(k, offset, negative)| {
        let n = (&Integer::ONE << k) + Integer::from(offset);
        if negative { -n } else { n }
    })
}

/// Integers of up to `limbs` words of 64 bits, either sign; words of only zeros and only ones are common.
pub fn big_integer(limbs: usize) -> impl Strategy<Value = Integer> {
    let limb = prop_oneof![4 => any::<u64>(), 1 => Just(0u64), 1 => Just(u64::MAX)];
    (vec(limb, 0..=limbs), any::<bool>()).prop_map(|(limbs, negative)| {
        let n = Integer::from_limbs(limbs);
        if negative { -n } else { n }
    })
}

/// Integers of exactly 500 decimal digits, either sign.
pub fn integer_of_500_digits() -> impl Strategy<Value = Integer> {
    (1u8..=9, vec(0u8..=9, 499), any::<bool>()).prop_map(|(first, rest, negative)| {
        let mut text = String::with_capacity(501);
        if negative {
            text.push('-');
        }
        text.extend(std::iter::once(first).chain(rest).map(|d| char::from(b'0' + d)));
        Integer::from_decimal(&text).expect("a sign and 500 digits")
    })
}

/// Integers of every kind, small ones most often.
pub fn integer() -> impl Strategy<Value = Integer> {
    prop_oneof![
        6 => small_integer(),
        3 => word_edge_integer(),
        3 => big_integer(6),
        1 => integer_of_500_digits(),
    ]
}

/// Integers of every kind but 0.
pub fn nonzero_integer() -> impl Strategy<Value = Integer> {
    integer().prop_map(|n| if n.is_zero() { Integer::ONE } else { n })
}

/// Quotients of two integers from -20 to 20.
pub fn small_rational() -> impl Strategy<Value = Rational> {
    (small_integer(), 1i64..=20).prop_map(|(n, d)| Rational::new(n, Integer::from(d)))
}

/// Rationals of every kind: small quotients, integers, quotients of large integers, decimals, powers of
/// two and of ten, neighbours of 0 and ±1 as close as 1e-40, and numbers half-way between two decimals.
pub fn rational() -> impl Strategy<Value = Rational> {
    let ten = |e: i64| Rational::from(10).pow(e).expect("ten is not zero");
    let two = |e: i64| Rational::from(2).pow(e).expect("two is not zero");
    prop_oneof![
        5 => small_rational(),
        1 => integer().prop_map(Rational::from),
        3 => (integer(), nonzero_integer()).prop_map(|(n, d)| Rational::new(n, d)),
        2 => (any::<i64>(), -40i64..40).prop_map(move |(n, e)| Rational::from(n) * ten(e)),
        1 => (-200i64..200).prop_map(two),
        1 => (-60i64..60).prop_map(ten),
        1 => (-1i64..=1, 1i64..=40, any::<bool>()).prop_map(move |(n, e, above)| {
            let nearby = ten(-e);
            Rational::from(n) + if above { nearby } else { -nearby }
        }),
        1 => (-9999i64..9999, -20i64..20).prop_map(move |(n, e)| Rational::from(10 * n + 5) * ten(e)),
    ]
}

/// Rationals of every kind but 0.
pub fn nonzero_rational() -> impl Strategy<Value = Rational> {
    rational().prop_map(|v| if v.is_zero() { Rational::ONE } else { v })
}
