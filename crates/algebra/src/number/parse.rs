//! Exact reading of numbers as people write them.

use super::{Integer, Rational};
use std::fmt;

/// The largest magnitude of a decimal exponent that is accepted: `1e100000` has a third of a million bits.
pub const MAX_DECIMAL_EXPONENT: i64 = 100_000;

/// The largest number of characters of one number that is accepted.
pub const MAX_LITERAL_LENGTH: usize = 4_000_000;

/// What is wrong with the text of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ParseNumberErrorKind {
    /// There is no text.
    Empty,
    /// A character that does not belong to a number; an underscore has to stand between digits.
    UnexpectedCharacter,
    /// A digit is missing, for instance after `1e`.
    MissingDigits,
    /// The magnitude of the exponent is above [`MAX_DECIMAL_EXPONENT`].
    ExponentTooLarge,
    /// More characters than [`MAX_LITERAL_LENGTH`].
    TooLong,
    /// The part behind `/` is zero.
    DivisionByZero,
}

/// Why a text is not a number, and where.
///
/// ```
/// use jurist_algebra::number::{ParseNumberErrorKind, parse_number};
/// let error = parse_number("12x").unwrap_err();
/// assert_eq!((error.kind, error.offset), (ParseNumberErrorKind::UnexpectedCharacter, 2));
/// assert_eq!(error.to_string(), "character 3 does not belong to a number");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ParseNumberError {
    /// What is wrong.
    pub kind: ParseNumberErrorKind,
    /// The byte at which it was noticed.
    pub offset: usize,
}

impl fmt::Display for ParseNumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use ParseNumberErrorKind as K;
        match self.kind {
            K::Empty => f.write_str("a number is missing"),
            K::UnexpectedCharacter => write!(f, "character {} does not belong to a number", self.offset + 1),
            K::MissingDigits => write!(f, "a digit is missing at character {}", self.offset + 1),
            K::ExponentTooLarge => write!(f, "the exponent is beyond {MAX_DECIMAL_EXPONENT}"),
            K::TooLong => write!(f, "the number is longer than {MAX_LITERAL_LENGTH} characters"),
            K::DivisionByZero => f.write_str("the denominator is zero"),
        }
    }
}

impl std::error::Error for ParseNumberError {}

/// Reads a signed decimal or a fraction of two: `0.046`, `46e-3`, `.5`, `-1/3`, `1_000`, `+2`, `1.5/0.3`.
///
/// Blanks around the number and around `/` are allowed. The value is exact.
///
/// Cost: the conversion of the digits to binary, and of a fraction one greatest common divisor.
///
/// ```
/// use jurist_algebra::number::parse_number;
/// assert_eq!(parse_number("46e-3").unwrap().to_string(), "23/500");
/// assert_eq!(parse_number("-1/3").unwrap().to_string(), "-1/3");
/// assert!(parse_number("1__0").is_err());
/// ```
///
/// # Errors
/// [`ParseNumberError`] with the place in the text.
pub fn parse_number(text: &str) -> Result<Rational, ParseNumberError> {
    if text.len() > MAX_LITERAL_LENGTH {
        return Err(ParseNumberError { kind: ParseNumberErrorKind::TooLong, offset: 0 });
    }
    match text.find('/') {
        None => parse_signed(text, 0),
        Some(slash) => {
            let numerator = parse_signed(&text[..slash], 0)?;
            let denominator = parse_signed(&text[slash + 1..], slash + 1)?;
            numerator
                .checked_div(&denominator)
                .ok_or(ParseNumberError { kind: ParseNumberErrorKind::DivisionByZero, offset: slash + 1 })
        }
    }
}

fn parse_signed(text: &str, base: usize) -> Result<Rational, ParseNumberError> {
    let start = text.len() - text.trim_start().len();
    let trimmed = text.trim();
    let (negative, skip) = match trimmed.as_bytes().first() {
        Some(b'-') => (true, 1),
        Some(b'+') => (false, 1),
        _ => (false, 0),
    };
    let value = parse_decimal_literal(&trimmed[skip..]).map_err(|e| {
        let kind = if skip == 1 && e.kind == ParseNumberErrorKind::Empty {
            ParseNumberErrorKind::MissingDigits
        } else {
            e.kind
        };
        ParseNumberError { kind, offset: base + start + skip + e.offset }
    })?;
    Ok(if negative { -value } else { value })
}

/// How many bytes at the start of the text form an unsigned decimal number; 0 if none does.
///
/// An `e` that no digits follow is not part of the number, so `2e` begins with the number `2`.
pub fn scan_decimal_literal(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut i: usize| {
        while i < bytes.len()
            && (bytes[i].is_ascii_digit()
                || (bytes[i] == b'_'
                    && i > 0
                    && bytes[i - 1].is_ascii_digit()
                    && bytes.get(i + 1).is_some_and(u8::is_ascii_digit)))
        {
            i += 1;
        }
        i
    };
    let mut end = digits(0);
    let whole = end;
    if bytes.get(end) == Some(&b'.') {
        let after = digits(end + 1);
        if after > end + 1 || whole > 0 {
            end = after;
        }
    }
    if end == 0 {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let after = digits(end + 1 + sign);
        if after > end + 1 + sign {
            end = after;
        }
    }
    end
}

/// Reads an unsigned decimal number: digits, optionally a point and an exponent, with underscores
/// between digits.
///
/// # Errors
/// [`ParseNumberError`] with the place in the text.
pub fn parse_decimal_literal(text: &str) -> Result<Rational, ParseNumberError> {
    let error = |kind, offset| Err(ParseNumberError { kind, offset });
    if text.is_empty() {
        return error(ParseNumberErrorKind::Empty, 0);
    }
    if text.len() > MAX_LITERAL_LENGTH {
        return error(ParseNumberErrorKind::TooLong, 0);
    }
    let end = scan_decimal_literal(text);
    if end < text.len() {
        let missing =
            matches!(text.as_bytes()[end], b'e' | b'E') && text[end + 1..].trim_start_matches(['+', '-']).is_empty();
        let kind =
            if missing { ParseNumberErrorKind::MissingDigits } else { ParseNumberErrorKind::UnexpectedCharacter };
        return error(kind, if missing { text.len() } else { end });
    }
    let (mantissa, exponent) = match text.find(['e', 'E']) {
        None => (text, 0),
        Some(e) => {
            let digits: String = text[e + 1..].chars().filter(|c| *c != '_').collect();
            let significant = digits.trim_start_matches(['+', '-']).trim_start_matches('0');
            let magnitude = if significant.is_empty() { Some(0) } else { significant.parse::<i64>().ok() };
            match magnitude.filter(|m| *m <= MAX_DECIMAL_EXPONENT) {
                Some(m) => (&text[..e], if digits.starts_with('-') { -m } else { m }),
                None => return error(ParseNumberErrorKind::ExponentTooLarge, e + 1),
            }
        }
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: String = whole.chars().chain(fraction.chars()).filter(|c| *c != '_').collect();
    let places = fraction.bytes().filter(u8::is_ascii_digit).count() as i64;
    let Some(number) = Integer::from_decimal(&digits) else {
        return error(ParseNumberErrorKind::MissingDigits, 0);
    };
    let shift = exponent - places;
    let power = Integer::from(10).pow(shift.unsigned_abs());
    Ok(if shift >= 0 { Rational::from(number * power) } else { Rational::new(number, power) })
}

impl std::str::FromStr for Rational {
    type Err = ParseNumberError;
    /// As [`parse_number`].
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        parse_number(text)
    }
}

impl std::str::FromStr for Integer {
    type Err = ParseNumberError;
    /// An optional sign and digits, nothing else.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Integer::from_decimal(text).ok_or_else(|| {
            let start = usize::from(text.starts_with(['+', '-']));
            let (kind, offset) = match text[start..].bytes().position(|b| !b.is_ascii_digit()) {
                Some(i) => (ParseNumberErrorKind::UnexpectedCharacter, start + i),
                None if text.is_empty() => (ParseNumberErrorKind::Empty, 0),
                None => (ParseNumberErrorKind::MissingDigits, start),
            };
            ParseNumberError { kind, offset }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_of_numbers() {
        for (text, value) in [
            ("0.046", "23/500"),
            ("46e-3", "23/500"),
            (".5", "1/2"),
            ("5.", "5"),
            ("-1/3", "-1/3"),
            ("1_000", "1000"),
            ("+2", "2"),
            ("1.5/0.3", "5"),
            ("1E+2", "100"),
            (" 7 / -14 ", "-1/2"),
            ("0e99999", "0"),
            ("00012", "12"),
        ] {
            assert_eq!(parse_number(text).unwrap().to_string(), value, "{text}");
        }
        assert_eq!(parse_number("1e400").unwrap().numerator().to_string().len(), 401);
    }

    #[test]
    fn what_is_not_a_number() {
        use ParseNumberErrorKind as K;
        for (text, kind, offset) in [
            ("", K::Empty, 0),
            ("-", K::MissingDigits, 1),
            (".", K::UnexpectedCharacter, 0),
            ("1__0", K::UnexpectedCharacter, 1),
            ("1_", K::UnexpectedCharacter, 1),
            ("_1", K::UnexpectedCharacter, 0),
            ("1e", K::MissingDigits, 2),
            ("1e+", K::MissingDigits, 3),
            ("1e100001", K::ExponentTooLarge, 2),
            ("1e99999999999999999999", K::ExponentTooLarge, 2),
            ("1/0", K::DivisionByZero, 2),
            ("1/", K::Empty, 2),
            ("--1", K::UnexpectedCharacter, 1),
            ("0x10", K::UnexpectedCharacter, 1),
            ("1 2", K::UnexpectedCharacter, 1),
            ("inf", K::UnexpectedCharacter, 0),
        ] {
            assert_eq!(parse_number(text), Err(ParseNumberError { kind, offset }), "{text}");
        }
    }

    #[test]
    fn integers_from_text() {
        use ParseNumberErrorKind as K;
        assert_eq!("-12".parse(), Ok(Integer::from(-12)));
        for (text, kind, offset) in [("", K::Empty, 0), ("+", K::MissingDigits, 1), ("12.5", K::UnexpectedCharacter, 2)]
        {
            assert_eq!(text.parse::<Integer>(), Err(ParseNumberError { kind, offset }));
        }
    }
}
