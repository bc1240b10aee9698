//! A number of a file as an exact decimal, and how far its last place reaches.

use jurist_algebra::number::{Integer, Rational, to_scientific};
use std::cmp::Ordering;
use std::fmt;

/// Longer numbers are refused, and so are decimal points farther away.
const MAX_PLACES: i64 = 1000;

/// Plain notation is used up to so many digits before the point, and so many zeros behind it.
const PLAIN: std::ops::RangeInclusive<i64> = -4..=16;

/// A finite number: `digits * 10^exponent`, with the digits that stand in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Number {
    negative: bool,
    /// Without leading zeros; empty for zero.
    digits: String,
    exponent: i64,
    known: Known,
}

/// What the number was in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Known {
    /// An integer type, or a number that nobody rounded.
    Exactly,
    /// A decimal.
    Decimal,
    /// A binary number `mantissa * 2^unit`: a step in its last place is `2^unit`.
    Binary { mantissa: u64, unit: i32 },
}

/// Why a text is no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unread {
    /// Infinite, or not a number.
    NotFinite,
    /// Too many digits, or an exponent that is too large.
    TooLong,
    /// Something else.
    NotANumber,
}

impl Number {
    pub const fn zero() -> Number {
        Number { negative: false, digits: String::new(), exponent: 0, known: Known::Exactly }
    }

    /// An exact one of an identity matrix.
    pub fn one() -> Number {
        Number::integer(1)
    }

    pub fn integer(value: i128) -> Number {
        if value == 0 {
            return Number::zero();
        }
        let digits = value.unsigned_abs().to_string();
        Number { negative: value < 0, digits, exponent: 0, known: Known::Exactly }
    }

    /// The shortest decimal that reads back to the same double; `None` of one that is not finite.
    pub fn double(bits: u64) -> Option<Number> {
        let value = f64::from_bits(bits);
        value.is_finite().then_some(())?;
        let (fraction, biased) = (bits & ((1 << 52) - 1), (bits >> 52 & 0x7ff) as i32);
        let (mantissa, unit) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        Number::binary(&format!("{value:e}"), mantissa, unit)
    }

    /// The shortest decimal that reads back to the same number of single precision.
    pub fn single(bits: u32) -> Option<Number> {
        let value = f32::from_bits(bits);
        value.is_finite().then_some(())?;
        let (fraction, biased) = (u64::from(bits & ((1 << 23) - 1)), (bits >> 23 & 0xff) as i32);
        let (mantissa, unit) = if biased == 0 { (fraction, -149) } else { (fraction | 1 << 23, biased - 150) };
        Number::binary(&format!("{value:e}"), mantissa, unit)
    }

    fn binary(text: &str, mantissa: u64, unit: i32) -> Option<Number> {
        let number = Number::decimal(text).ok()?;
        Some(Number { known: Known::Binary { mantissa, unit }, ..number })
    }

    /// A decimal with the digits that are written: `-12.50e-3`, `.5`, `5.`, `1d3`.
    pub fn decimal(text: &str) -> Result<Number, Unread> {
        let lower = text.to_ascii_lowercase();
        let (negative, rest) = match lower.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, lower.strip_prefix('+').unwrap_or(&lower)),
        };
        if ["nan", "inf", "infinity"].contains(&rest) {
            return Err(Unread::NotFinite);
        }
        let (mantissa, power) = rest.split_once(['e', 'd']).map_or((rest, None), |(m, p)| (m, Some(p)));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let are_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
        if !are_digits(whole) || !are_digits(fraction) || whole.len() + fraction.len() == 0 {
            return Err(Unread::NotANumber);
        }
        let power = match power {
            None => 0,
            Some(power) => {
                let unsigned = power.strip_prefix(['+', '-']).unwrap_or(power);
                if unsigned.is_empty() || !are_digits(unsigned) {
                    return Err(Unread::NotANumber);
                }
                power.parse::<i64>().map_err(|_| Unread::TooLong)?
            }
        };
        let all = format!("{whole}{fraction}");
        let digits = all.trim_start_matches('0');
        if digits.is_empty() {
            return Ok(Number { negative: false, known: Known::Decimal, ..Number::zero() });
        }
        let places = digits.len() as i64;
        let exponent = power.checked_sub(fraction.len() as i64).ok_or(Unread::TooLong)?;
        if places > MAX_PLACES || !(-MAX_PLACES..=MAX_PLACES).contains(&exponent) {
            return Err(Unread::TooLong);
        }
        Ok(Number { negative, digits: digits.to_owned(), exponent, known: Known::Decimal })
    }

    /// Its sign.
    pub fn sign(&self) -> Ordering {
        match (self.digits.is_empty(), self.negative) {
            (true, _) => Ordering::Equal,
            (false, true) => Ordering::Less,
            (false, false) => Ordering::Greater,
        }
    }

    pub fn is_binary(&self) -> bool {
        matches!(self.known, Known::Binary { .. })
    }

    /// Whether it is an integer all of whose digits stand in the file: such a number is taken for exact.
    pub fn is_exact(&self) -> bool {
        match self.known {
            Known::Exactly => true,
            Known::Binary { mantissa, unit } => {
                mantissa == 0 || unit <= 0 && mantissa.trailing_zeros() >= unit.unsigned_abs()
            }
            Known::Decimal => self.digits.is_empty() || self.exponent <= 0 && self.zeros_behind_point(),
        }
    }

    fn zeros_behind_point(&self) -> bool {
        let zeros = self.digits.len() - self.digits.trim_end_matches('0').len();
        zeros as i64 >= -self.exponent
    }

    /// Half a unit in its last place as a decimal, `None` of an exact number. Around a binary number this holds every number that is
    /// rounded to it: the distance of its decimal is added, and the sum is rounded up.
    pub fn half_unit(&self) -> Option<String> {
        if self.is_exact() {
            return None;
        }
        match self.known {
            Known::Binary { mantissa, unit } => {
                let two = Rational::from(2);
                let value = Rational::from(&Integer::from(mantissa)) * two.pow(i64::from(unit))?;
                let half = two.pow(i64::from(unit) - 1)?;
                let reach = half + (value - self.magnitude()?).abs();
                // Three digits are off by less than a hundredth.
                Some(to_scientific(&(reach * Rational::from(101).checked_div(&Rational::from(100))?), 3))
            }
            _ => Some(
                Number { negative: false, digits: "5".to_owned(), exponent: self.exponent - 1, ..self.clone() }
                    .to_string(),
            ),
        }
    }

    fn magnitude(&self) -> Option<Rational> {
        Some(Rational::from(&Integer::from_decimal(&self.digits)?) * Rational::from(10).pow(self.exponent)?)
    }
}

/// As a number of a model file.
impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.digits.is_empty() {
            return f.write_str("0");
        }
        let sign = if self.negative { "-" } else { "" };
        let is_whole = self.exponent < 0 && self.zeros_behind_point();
        let kept = if is_whole { self.digits.len() - self.exponent.unsigned_abs() as usize } else { self.digits.len() };
        let digits = &self.digits[..kept];
        let exponent = if is_whole { 0 } else { self.exponent };
        let point = digits.len() as i64 + exponent;
        if !PLAIN.contains(&point) {
            let (first, rest) = digits.split_at(1);
            let dot = if rest.is_empty() { "" } else { "." };
            return write!(f, "{sign}{first}{dot}{rest}e{}", point - 1);
        }
        let zeros = |count: i64| "0".repeat(count.unsigned_abs() as usize);
        match (exponent, point) {
            (0.., _) => write!(f, "{sign}{digits}{}", zeros(exponent)),
            (_, 1..) => {
                let (whole, fraction) = digits.split_at(point as usize);
                write!(f, "{sign}{whole}.{fraction}")
            }
            _ => write!(f, "{sign}0.{}{digits}", zeros(point)),
        }
    }
}

#[cfg(test)]
mod tests;
