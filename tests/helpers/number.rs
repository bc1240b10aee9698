//! Exact numbers, briefly.

use jurist_algebra::number::{Rational, parse_number};

/// The number that a text says.
pub fn number(text: &str) -> Rational {
    parse_number(text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

/// A quotient of two machine integers.
pub fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator.into(), denominator.into())
}
