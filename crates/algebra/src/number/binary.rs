//! Numbers as binary floating point holds them (IEEE 754), by exact arithmetic.

use super::{Integer, Rational};
use std::cmp::Ordering;

/// A format of binary floating point.
///
/// ```
/// use jurist_algebra::number::{BinaryFormat, Rational};
/// let tenth = Rational::new(1.into(), 10.into());
/// assert_eq!(BinaryFormat::Single.nearest(&tenth).unwrap().to_string(), "13421773/134217728");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinaryFormat {
    /// 32 bits: 24 significant ones.
    Single,
    /// 64 bits: 53 significant ones.
    Double,
}

impl BinaryFormat {
    /// The nearest number of the format, of two equally near ones the one with an even last bit, as compilers convert literals;
    /// `None` where that is infinite.
    ///
    /// Cost: one division.
    pub fn nearest(self, value: &Rational) -> Option<Rational> {
        let (precision, least, greatest) = self.limits();
        if value.is_zero() {
            return Some(Rational::ZERO);
        }
        let size = value.abs();
        // 2^(exponent - 1) < size < 2^(exponent + 1).
        let exponent = size.numerator().bit_length() as i64 - size.denominator().bit_length() as i64;
        let power = |k: i64| Rational::from(2).pow(k).expect("two is not zero");
        let exponent = if size < power(exponent) { exponent - 1 } else { exponent };
        let unit = power((exponent + 1 - precision).max(least));
        let rounded = Rational::from(nearest_even(&size.checked_div(&unit)?)) * unit;
        let signed = if value.is_negative() { -&rounded } else { rounded.clone() };
        (rounded < power(greatest)).then_some(signed)
    }
}

impl BinaryFormat {
    /// Digits of the significand, and the exponents of the least number and of the first one that is too large.
    fn limits(self) -> (i64, i64, i64) {
        match self {
            BinaryFormat::Single => (24, -149, 128),
            BinaryFormat::Double => (53, -1074, 1024),
        }
    }

    /// The bits that stand for a number of the format, as an integer; `None` for other numbers.
    ///
    /// Cost: one division.
    ///
    /// ```
    /// use jurist_algebra::number::{BinaryFormat, Rational};
    /// let half = Rational::new((-1).into(), 2.into());
    /// assert_eq!(BinaryFormat::Single.pattern(&half), Some(0xbf00_0000_u32.into()));
    /// ```
    pub fn pattern(self, value: &Rational) -> Option<Integer> {
        if self.nearest(value).as_ref() != Some(value) {
            return None;
        }
        let (precision, least, greatest) = self.limits();
        let size = value.abs();
        // The least number of units below the normal ones; else the exponent counts from there.
        let mut exponent = 0;
        let power = |k: i64| Rational::from(2).pow(k).expect("two is not zero");
        let mut significand = size.checked_div(&power(least))?.floor();
        if significand >= Integer::ONE << (precision as u64 - 1) {
            let shift = significand.bit_length() as i64 - precision;
            significand = size.checked_div(&power(least + shift))?.floor() - (Integer::ONE << (precision as u64 - 1));
            exponent = shift + 1;
        }
        let bits = Integer::from(exponent) << (precision as u64 - 1);
        let sign_place = precision as u64 - 1 + Integer::from(2 * greatest - 1).bit_length();
        let sign = if value.is_negative() { Integer::ONE << sign_place } else { Integer::ZERO };
        Some(sign + bits + significand)
    }
}

/// The nearest integer to a number that is not negative, of two the even one.
fn nearest_even(value: &Rational) -> Integer {
    let floor = value.floor();
    let rest = value - &Rational::from(floor.clone());
    let up = match rest.cmp(&Rational::new(1.into(), 2.into())) {
        Ordering::Less => false,
        Ordering::Equal => !floor.is_even(),
        Ordering::Greater => true,
    };
    if up { floor + Integer::ONE } else { floor }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::parse_number;
    use proptest::prelude::*;

    fn check(text: &str) {
        let value = parse_number(text).unwrap();
        let single: f32 = text.parse().unwrap();
        let double: f64 = text.parse().unwrap();
        let exact = |x: f64| x.is_finite().then(|| Rational::from_f64(x).unwrap());
        assert_eq!(BinaryFormat::Single.nearest(&value), exact(single.into()), "{text}");
        assert_eq!(BinaryFormat::Double.nearest(&value), exact(double), "{text}");
        if let (Some(single_value), Some(double_value)) = (exact(single.into()), exact(double)) {
            let zero = |bits: u64, is_zero: bool| Integer::from(if is_zero { 0 } else { bits });
            let bits = zero(single.to_bits().into(), single == 0.0);
            assert_eq!(BinaryFormat::Single.pattern(&single_value), Some(bits), "{text}");
            assert_eq!(
                BinaryFormat::Double.pattern(&double_value),
                Some(zero(double.to_bits(), double == 0.0)),
                "{text}"
            );
        }
    }

    #[test]
    fn literals_are_those_of_the_standard_library() {
        for text in [
            "0",
            "1",
            "-0.1",
            "16777217",
            "16777219",
            "9007199254740993",
            "9007199254740995",
            "3.4028235e38",
            "3.4028236e38",
            "1e39",
            "1e-45",
            "7e-46",
            "1e-46",
            "1.4e-45",
            "2.1019476964872256e-45",
            "1.7976931348623157e308",
            "1.7976931348623159e308",
            "5e-324",
            "2.4703282292062327e-324",
            "2.4703282292062328e-324",
            "1.1754943e-38",
        ] {
            check(text);
        }
    }

    proptest! {
        #[test]
        fn random_literals_are_those_of_the_standard_library(digits in "[1-9][0-9]{0,24}", exponent in -340i32..320, minus: bool) {
            check(&format!("{}{digits}e{exponent}", if minus { "-" } else { "" }));
        }
    }
}
