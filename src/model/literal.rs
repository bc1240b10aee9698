//! Decimal literals in expressions.

use crate::number::{Integer, Rational};

/// Powers of ten beyond this are refused: their digits alone would fill memory.
const MAX_DECIMAL_EXPONENT: i64 = 1_000_000;

/// The length of the decimal literal at the start of `text`; 0 if there is none.
///
/// Digits may be grouped by single underscores; there is a digit on each side of the point.
pub(super) fn scan(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let mut end = from;
        while bytes.get(end).is_some_and(u8::is_ascii_digit)
            || (end > from
                && bytes.get(end) == Some(&b'_')
                && bytes[end - 1] != b'_'
                && bytes.get(end + 1).is_some_and(u8::is_ascii_digit))
        {
            end += 1;
        }
        end
    };
    let mut end = digits(0);
    if end == 0 {
        return 0;
    }
    if bytes.get(end) == Some(&b'.') && digits(end + 1) > end + 1 {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}

/// The exact value of a literal that [`scan`] accepts whole; `None` if its power of ten is
/// beyond what is accepted.
pub(super) fn value(literal: &str) -> Option<Rational> {
    let plain: String = literal.chars().filter(|&c| c != '_').collect();
    let (mantissa, exponent) = plain.split_once(['e', 'E']).unwrap_or((&plain, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = Integer::from_decimal(&format!("{whole}{fraction}"))?;
    let exponent = Integer::from_decimal(exponent)? - Integer::from(fraction.len());
    if digits.is_zero() {
        return Some(Rational::ZERO);
    }
    let exponent = exponent.to_i64().filter(|e| e.abs() <= MAX_DECIMAL_EXPONENT + 64_000_000)?;
    if exponent > MAX_DECIMAL_EXPONENT || exponent + (fraction.len() as i64) < -MAX_DECIMAL_EXPONENT {
        return None;
    }
    let power = Integer::from(10).pow(exponent.unsigned_abs());
    Some(if exponent < 0 { Rational::new(digits, power) } else { Rational::from(digits * power) })
}
