//! Exact numbers from text.

use num_bigint::BigInt;
use num_rational::Ratio;
use num_traits::Zero;

pub(super) type Z = BigInt;
pub(super) type Q = Ratio<BigInt>;

/// Numbers with more digits than this are refused.
pub(super) const MAX_DIGITS: usize = 100_000;

/// An integer as certificates write it: an optional minus sign and digits.
pub(super) fn integer(text: &str) -> Result<Z, String> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return Err(format!("'{}' is not an integer", shorten(text)));
    }
    if digits.len() > MAX_DIGITS {
        return Err(format!("a number has more than {MAX_DIGITS} digits"));
    }
    text.parse().map_err(|_| format!("'{}' is not an integer", shorten(text)))
}

/// A rational number as certificates write it: an integer, or two joined by `/`, the second positive.
pub(super) fn rational(text: &str) -> Result<Q, String> {
    match text.split_once('/') {
        None => Ok(Q::from(integer(text)?)),
        Some((numerator, denominator)) => {
            let (n, d) = (integer(numerator)?, integer(denominator)?);
            if denominator.starts_with('-') || d.is_zero() {
                return Err(format!("'{}' has no positive denominator", shorten(text)));
            }
            Ok(Q::new(n, d))
        }
    }
}

/// A decimal literal of a model, such as `46e-3`, without sign.
pub(super) fn decimal(text: &str) -> Result<Q, String> {
    let wrong = || format!("'{}' is not a number", shorten(text));
    let (mantissa, exponent) = match text.find(['e', 'E']) {
        Some(i) => (&text[..i], text[i + 1..].parse::<i64>().map_err(|_| wrong())?),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    let exponent = exponent.saturating_sub(fraction.len() as i64);
    if digits.len() > MAX_DIGITS || exponent.unsigned_abs() > MAX_DIGITS as u64 {
        return Err(format!("a number has more than {MAX_DIGITS} digits"));
    }
    let value = integer(&digits).map_err(|_| wrong())?;
    let power = Z::from(10).pow(exponent.unsigned_abs() as u32);
    Ok(if exponent < 0 { Q::new(value, power) } else { Q::from(value * power) })
}

/// Text for a message, not longer than a line.
pub(super) fn shorten(text: &str) -> String {
    let mut short: String = text.chars().take(40).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}

/// Integer power of a rational number; lowest terms stay lowest.
pub(super) fn power(base: &Q, exponent: u32) -> Q {
    Q::new_raw(base.numer().pow(exponent), base.denom().pow(exponent))
}
