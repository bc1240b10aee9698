//! Correctly rounded decimal printing.

use super::{Integer, Rational};
use std::cmp::Ordering;

/// A number rounded to a fixed count of significant digits, ties to even.
struct Rounded {
    negative: bool,
    /// The digits, the first not zero (a single `0` for zero).
    digits: String,
    /// The power of ten of the first digit.
    exponent: i64,
    /// Whether rounding changed nothing.
    exact: bool,
    /// Whether the number itself, before rounding, is of a magnitude that is written plainly.
    plain: bool,
}

/// `floor(log10(v))` for a positive rational, found from the bit lengths and then made exact.
fn decimal_exponent(v: &Rational) -> i64 {
    let bits = v.numerator().bit_length() as i64 - v.denominator().bit_length() as i64;
    let mut e = (bits * 30_103).div_euclid(100_000);
    while power_of_ten(e) > *v {
        e -= 1;
    }
    while power_of_ten(e + 1) <= *v {
        e += 1;
    }
    e
}

fn power_of_ten(e: i64) -> Rational {
    Rational::from(10).pow(e).expect("ten is not zero")
}

fn round(value: &Rational, digits: usize) -> Rounded {
    let digits = digits.max(1);
    let negative = value.is_negative();
    if value.is_zero() {
        return Rounded { negative, digits: "0".into(), exponent: 0, exact: true, plain: true };
    }
    let magnitude = value.abs();
    let mut exponent = decimal_exponent(&magnitude);
    let plain = (-6..15).contains(&exponent);
    let scaled = magnitude * power_of_ten(digits as i64 - 1 - exponent);
    let floor = scaled.floor();
    let twice_rest = (&scaled - Rational::from(&floor)) * Rational::from(2);
    let up = match twice_rest.cmp(&Rational::ONE) {
        Ordering::Less => false,
        Ordering::Greater => true,
        Ordering::Equal => !floor.is_even(),
    };
    let mut text = if up { floor + Integer::ONE } else { floor }.to_string();
    if text.len() > digits {
        text.pop();
        exponent += 1;
    }
    Rounded { negative, digits: text, exponent, exact: twice_rest.is_zero(), plain }
}

impl Rounded {
    fn drop_trailing_zeros(&mut self) {
        let kept = self.digits.trim_end_matches('0').len().max(1);
        self.digits.truncate(kept);
    }

    fn print(&self) -> String {
        if self.plain { self.plain() } else { self.scientific() }
    }

    fn plain(&self) -> String {
        let sign = if self.negative { "-" } else { "" };
        let digits = &self.digits;
        if self.exponent < 0 {
            let zeros = "0".repeat((-self.exponent - 1) as usize);
            return format!("{sign}0.{zeros}{digits}");
        }
        let whole = self.exponent as usize + 1;
        if digits.len() <= whole {
            format!("{sign}{digits}{}", "0".repeat(whole - digits.len()))
        } else {
            format!("{sign}{}.{}", &digits[..whole], &digits[whole..])
        }
    }

    fn scientific(&self) -> String {
        let sign = if self.negative { "-" } else { "" };
        let (first, rest) = self.digits.split_at(1);
        let point = if rest.is_empty() { "" } else { "." };
        format!("{sign}{first}{point}{rest}e{}", self.exponent)
    }
}

/// The number rounded to so many significant digits, ties to even: plain notation for magnitudes
/// from `1e-6` to below `1e15`, else like `1.25e-7`. Where the digits are the whole number, trailing
/// zeros are dropped.
///
/// Cost: a power of ten and a division of numbers as long as the value and the digits, and the conversion of the
/// quotient to decimal.
///
/// ```
/// use jurist_algebra::number::{parse_number, to_decimal};
/// assert_eq!(to_decimal(&parse_number("1/3").unwrap(), 5), "0.33333");
/// assert_eq!(to_decimal(&parse_number("2.5").unwrap(), 12), "2.5");
/// assert_eq!(to_decimal(&parse_number("125e-9").unwrap(), 2), "1.2e-7");
/// ```
pub fn to_decimal(value: &Rational, digits: usize) -> String {
    let mut rounded = round(value, digits);
    if rounded.exact {
        rounded.drop_trailing_zeros();
    }
    rounded.print()
}

/// The same in scientific notation whatever the magnitude, all digits kept.
pub fn to_scientific(value: &Rational, digits: usize) -> String {
    round(value, digits).scientific()
}

/// The decimal that every number of `[lo, hi]` rounds to, if there is one. With different ends the
/// number is not known exactly, so all digits are printed; a number that is known exactly has no trailing
/// zeros, whether it was rounded or not.
pub fn enclosed_decimal(lo: &Rational, hi: &Rational, digits: usize) -> Option<String> {
    if lo == hi {
        let mut rounded = round(lo, digits);
        rounded.drop_trailing_zeros();
        return Some(rounded.print());
    }
    let (low, high) = (round(lo, digits).print(), round(hi, digits).print());
    (low == high).then_some(low)
}

#[cfg(test)]
mod tests {
    use super::super::parse_number;
    use super::*;

    fn dec(text: &str, digits: usize) -> String {
        to_decimal(&parse_number(text).unwrap(), digits)
    }

    #[test]
    fn notation_and_rounding() {
        for (text, digits, printed) in [
            ("0", 12, "0"),
            ("-0.5", 12, "-0.5"),
            ("2/3", 3, "0.667"),
            ("1e-6", 12, "0.000001"),
            ("0.99999e-6", 12, "9.9999e-7"),
            ("0.9999999e-6", 3, "1.00e-6"),
            ("999999999999999", 20, "999999999999999"),
            ("1e15", 12, "1e15"),
            ("999999999999999.9", 3, "1000000000000000"),
            ("9.995", 3, "10.0"),
            ("0.125", 2, "0.12"),
            ("0.375", 2, "0.38"),
            ("-2.5", 1, "-2"),
            ("3.5", 1, "4"),
            ("1200", 2, "1200"),
            ("1250", 2, "1200"),
            ("123456", 3, "123000"),
            ("1/7", 0, "0.1"),
        ] {
            assert_eq!(dec(text, digits), printed, "{text} to {digits}");
        }
    }

    #[test]
    fn an_enclosure_prints_only_what_is_certain() {
        let n = |t: &str| parse_number(t).unwrap();
        assert_eq!(enclosed_decimal(&n("0.1999999"), &n("0.2000001"), 3), Some("0.200".into()));
        assert_eq!(enclosed_decimal(&n("0.12499"), &n("0.12501"), 2), None);
        assert_eq!(enclosed_decimal(&n("0.25"), &n("0.25"), 9), Some("0.25".into()));
        assert_eq!(enclosed_decimal(&n("0.10000001"), &n("0.10000001"), 3), Some("0.1".into()));
    }
}
