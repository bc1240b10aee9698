//! One literal of C: a sign, perhaps parentheses, a number with its suffix.

use jurist_algebra::number::{BinaryFormat, Integer, Rational, parse_number};

/// A number as it is written, and how a compiler holds it.
#[derive(Debug, PartialEq)]
pub(super) struct Literal<'t> {
    pub written: &'t str,
    pub value: Rational,
    pub format: Format,
}

/// The format of a literal, by its suffix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    Integer,
    Binary(BinaryFormat),
    LongDouble,
}

/// Longer literals are refused.
const MAX_LENGTH: usize = 1000;

/// The literal that a text is, and nothing beside.
pub(super) fn literal(text: &str) -> Result<Literal<'_>, String> {
    let mut inner = text.trim();
    let mut negative = false;
    loop {
        if let Some(rest) = inner.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
            inner = rest.trim();
        } else if let Some(rest) = inner.strip_prefix('-').filter(|rest| !rest.starts_with('-')) {
            negative = !negative;
            inner = rest.trim();
        } else if let Some(rest) = inner.strip_prefix('+').filter(|rest| !rest.starts_with('+')) {
            inner = rest.trim();
        } else {
            break;
        }
    }
    if inner.is_empty() {
        return Err("there is no number".to_owned());
    }
    let shown: String = text.trim().chars().take(40).collect();
    if inner.len() > MAX_LENGTH {
        return Err("the literal is too long".to_owned());
    }
    if !inner.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        let is_name = inner.chars().all(|c| c.is_alphanumeric() || c == '_');
        return Err(match is_name {
            true => format!("'{inner}' is another name, not a literal"),
            false => format!("'{shown}' is not one literal: formulas, casts and calls are not evaluated here"),
        });
    }
    let (value, format) = number(inner).ok_or_else(|| match is_octal(inner) {
        true => format!("'{inner}' is octal in C, which is hardly meant: write it in decimal"),
        false => format!("'{shown}' is not one literal: formulas, casts and calls are not evaluated here"),
    })?;
    if format == Format::Integer && value >= Rational::from(&Integer::ONE << 64) {
        return Err(format!("{shown} is larger than any integer of C"));
    }
    if negative && format == Format::Integer && is_unsigned(inner, &value) {
        return Err(format!("in {shown} the number is unsigned: its negative wraps to a large positive one in C"));
    }
    Ok(Literal { written: text.trim(), value: if negative { -value } else { value }, format })
}

/// Whether a whole number without a sign may be unsigned: by its suffix, and in another base than ten where an `int` is too small.
fn is_unsigned(text: &str, value: &Rational) -> bool {
    let is_decimal =
        !text.starts_with("0x") && !text.starts_with("0X") && !text.starts_with("0b") && !text.starts_with("0B");
    let has_suffix = text.trim_end_matches(['l', 'L', 'z', 'Z']).ends_with(['u', 'U']);
    has_suffix || text.contains(['u', 'U']) || !is_decimal && *value > Rational::from(i64::from(i32::MAX))
}

fn is_octal(text: &str) -> bool {
    let digits = text.trim_end_matches(['u', 'U', 'l', 'L']);
    digits.len() > 1 && digits.starts_with('0') && digits.bytes().all(|b| b.is_ascii_digit())
}

/// The value of a literal without a sign.
fn number(text: &str) -> Option<(Rational, Format)> {
    // Digits may be parted since C23 and C++14.
    let plain: String = text.chars().filter(|c| *c != '\'').collect();
    if text.starts_with('\'') || text.ends_with('\'') || text.contains("''") || is_octal(&plain) {
        return None;
    }
    let lower = plain.to_ascii_lowercase();
    if let Some(digits) = lower.strip_prefix("0x") {
        return hexadecimal(digits);
    }
    if let Some(digits) = lower.strip_prefix("0b") {
        return Some((whole(integer_digits(digits)?, 2)?, Format::Integer));
    }
    let is_float = lower.contains(['.', 'e']);
    let body = if is_float { lower.trim_end_matches(['f', 'l']) } else { integer_digits(&lower)? };
    let format = if is_float { of_suffix(&lower[body.len()..])? } else { Format::Integer };
    let (mantissa, exponent) = body.split_once('e').map_or((body, None), |(m, e)| (m, Some(e)));
    let (before, after) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let is_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let has_exponent = exponent.is_none_or(|e| {
        let digits = e.strip_prefix(['+', '-']).unwrap_or(e);
        !digits.is_empty() && is_digits(digits)
    });
    if !is_digits(before) || !is_digits(after) || before.len() + after.len() == 0 || !has_exponent {
        return None;
    }
    let zero = |digits: &str| if digits.is_empty() { "0".to_owned() } else { digits.to_owned() };
    let decimal = format!("{}.{}e{}", zero(before), zero(after), exponent.unwrap_or("0"));
    Some((parse_number(&decimal).ok()?, format))
}

/// The digits of a whole number without a suffix that C knows.
fn integer_digits(text: &str) -> Option<&str> {
    let digits = text.trim_end_matches(['u', 'l', 'z']);
    let suffix = &text[digits.len()..];
    ["", "u", "l", "ul", "lu", "ll", "ull", "llu", "z", "uz", "zu"].contains(&suffix).then_some(digits)
}

fn of_suffix(suffix: &str) -> Option<Format> {
    Some(match suffix {
        "f" => Format::Binary(BinaryFormat::Single),
        "" => Format::Binary(BinaryFormat::Double),
        "l" => Format::LongDouble,
        _ => return None,
    })
}

/// Behind `0x`: a whole number, or one with a binary exponent.
fn hexadecimal(text: &str) -> Option<(Rational, Format)> {
    let Some((mantissa, exponent)) = text.split_once('p') else {
        return Some((whole(integer_digits(text)?, 16)?, Format::Integer));
    };
    let digits = exponent.trim_end_matches(['f', 'l']);
    let format = of_suffix(&exponent[digits.len()..])?;
    let (before, after) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent: i64 = digits.parse().ok().filter(|e: &i64| e.abs() < 20_000)?;
    let scale = Rational::from(2).pow(exponent - 4 * i64::try_from(after.len()).ok()?)?;
    Some((whole(&format!("{before}{after}"), 16)? * scale, format))
}

fn whole(digits: &str, base: u32) -> Option<Rational> {
    if digits.is_empty() {
        return None;
    }
    let value = digits.chars().try_fold(Integer::ZERO, |value, c| {
        Some(value * Integer::from(i64::from(base)) + Integer::from(i64::from(c.to_digit(base)?)))
    })?;
    Some(Rational::from(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_are_those_of_a_compiler() {
        use Format::{Binary, Integer, LongDouble};
        for (text, value, format) in [
            ("1.5f", "3/2", Binary(BinaryFormat::Single)),
            ("(-1.5F)", "-3/2", Binary(BinaryFormat::Single)),
            ("- ( 1.5 )", "-3/2", Binary(BinaryFormat::Double)),
            ("((.5))", "1/2", Binary(BinaryFormat::Double)),
            ("5.", "5", Binary(BinaryFormat::Double)),
            ("1e-3", "1/1000", Binary(BinaryFormat::Double)),
            ("1E+3L", "1000", LongDouble),
            ("42", "42", Integer),
            ("42UL", "42", Integer),
            ("0", "0", Integer),
            ("0x1F", "31", Integer),
            ("0xFFul", "255", Integer),
            ("0b101", "5", Integer),
            ("0x1.8p1f", "3", Binary(BinaryFormat::Single)),
            ("0x1p-2", "1/4", Binary(BinaryFormat::Double)),
            ("1'000'000", "1000000", Integer),
        ] {
            let read = literal(text).unwrap_or_else(|why| panic!("{text}: {why}"));
            assert_eq!((read.value.to_string().as_str(), read.format), (value, format), "{text}");
        }
    }

    #[test]
    fn everything_else_is_refused() {
        for text in [
            "",
            "()",
            "1 + 2",
            "(float)1.5",
            "GAIN",
            "2*GAIN",
            "f(1)",
            "017",
            "1.5ff",
            "1f",
            "1.5fl",
            "1e",
            "1e+",
            ".",
            "0x",
            "0xG",
            "1.5.2",
            "--1",
            "1u.5",
            "5z5",
            "\"1\"",
            "1.0f,",
            "(1)+(2)",
            "0x1.8",
            "1''0",
            "é",
        ] {
            assert!(literal(text).is_err(), "{text}");
        }
    }
}
