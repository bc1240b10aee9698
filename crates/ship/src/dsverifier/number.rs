//! A number of a C file, as the decimal that is written there.

use super::fields::Reader;
use super::refused;
use super::token::{Kind, Token};
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::error::{Diagnostic, Span};

/// Longer numbers are refused, and so are exponents beyond it: a `double` of C ends at 308.
const MAX_PLACES: usize = 1000;

/// Parentheses and casts around a number.
const MAX_DEPTH: usize = 16;

/// A number: its value, and how it is written in a model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Number {
    /// The value of the decimal, exactly.
    pub value: Rational,
    /// The decimal, for a model file.
    pub text: String,
    /// Where it stands in the C file.
    pub span: Span,
}

impl Number {
    /// The zero that C puts where a list is shorter than its size.
    pub(super) fn zero(span: Span) -> Number {
        Number { value: Rational::ZERO, text: "0".into(), span }
    }
}

/// The next number: `-1.5e-3f`, `(double) 2`, `(-0.5)`.
pub(super) fn number(reader: &mut Reader<'_, '_>) -> Result<Number, Diagnostic> {
    let (mut is_negative, mut parentheses, mut first): (bool, usize, Option<Span>) = (false, 0, None);
    for _ in 0..MAX_DEPTH {
        let token = reader.next()?;
        let start = *first.get_or_insert(token.span);
        match token.kind {
            Kind::Sign if token.is("-") => is_negative = !is_negative,
            Kind::Sign if token.is("+") => {}
            Kind::Sign if token.is("(") => parentheses += usize::from(!is_cast(reader)),
            Kind::Number => {
                let mut number = literal(token, is_negative)?;
                number.span = start.to(token.span);
                for _ in 0..parentheses {
                    let close = reader.next()?;
                    if !close.is(")") {
                        return Err(not_a_number(close));
                    }
                }
                return Ok(number);
            }
            _ => return Err(not_a_number(token)),
        }
    }
    let span = first.unwrap_or_default();
    Err(refused("a number in too many parentheses").at(span, "begins here"))
}

fn not_a_number(token: Token<'_>) -> Diagnostic {
    let shown: String = token.text.chars().take(40).collect();
    let error = refused(format!("'{shown}' where a number is expected")).at(token.span, "no number");
    error.help("names and expressions are not read: let a compiler read the file first (gcc -E), or write the number")
}

/// Passes the rest of `(double)` behind its parenthesis, if it is that.
fn is_cast(reader: &mut Reader<'_, '_>) -> bool {
    let types = ["double", "float", "int", "long", "short", "unsigned", "signed", "char"];
    let rest = reader.tokens.get(reader.at..).unwrap_or_default();
    let words = rest.iter().take_while(|token| types.iter().any(|name| token.is(name))).count();
    if words > 0 && rest.get(words).is_some_and(|token| token.is(")")) {
        reader.at += words + 1;
        return true;
    }
    false
}

/// A decimal literal of C: its suffix says in which precision the compiler keeps it, and is left out.
fn literal(token: Token<'_>, is_negative: bool) -> Result<Number, Diagnostic> {
    let wrong = |message: &str, help: &str| refused(message).at(token.span, "not read").help(help);
    if token.text.len() > MAX_PLACES {
        return Err(wrong("a number with too many digits", "a thousand characters are read"));
    }
    let lower = token.text.to_ascii_lowercase();
    if lower.starts_with("0x") || lower.starts_with("0b") {
        return Err(wrong("a hexadecimal or binary number", "write it as a decimal number"));
    }
    let plain = lower.trim_end_matches(['f', 'l', 'u']);
    let decimal = (lower.len() - plain.len() <= 3).then(|| parts(plain)).flatten();
    let Some((whole, fraction, exponent)) = decimal else {
        return Err(wrong(&format!("'{}' is no decimal number", token.text), "for example 0.5, -1.25e-3, 2.0f"));
    };
    if fraction.is_none() && exponent.is_none() && whole.len() > 1 && whole.starts_with('0') {
        return Err(wrong("C reads a number that begins with 0 in base 8", "leave out the zeros in front of it"));
    }
    if exponent.is_some_and(|e| e.trim_start_matches(['+', '-']).parse::<usize>().map_or(true, |e| e > MAX_PLACES)) {
        return Err(wrong("an exponent beyond 1000", "no number of C is that large or that small"));
    }
    let text = written(is_negative, whole, fraction, exponent);
    let value = parse_number(&text).map_err(|error| wrong(&error.to_string(), "for example 0.5, -1.25e-3, 2.0f"))?;
    // An integer of a model file has 64 bits.
    let text = if fraction.is_none() && exponent.is_none() && whole.len() > 18 { format!("\"{text}\"") } else { text };
    Ok(Number { value, text, span: token.span })
}

/// Digits before the point, behind it, and the exponent.
fn parts(text: &str) -> Option<(&str, Option<&str>, Option<&str>)> {
    let (mantissa, exponent) = text.split_once('e').map_or((text, None), |(m, e)| (m, Some(e)));
    let (whole, fraction) = mantissa.split_once('.').map_or((mantissa, None), |(w, f)| (w, Some(f)));
    let are_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let digits = exponent.map(|e| e.strip_prefix(['+', '-']).unwrap_or(e));
    let is_decimal = are_digits(whole) && are_digits(fraction.unwrap_or("")) && digits.is_none_or(are_digits);
    let has_digits = whole.len() + fraction.map_or(0, str::len) > 0 && digits.is_none_or(|e| !e.is_empty());
    (is_decimal && has_digits).then_some((whole, fraction, exponent))
}

/// As a model file has it: a digit on both sides of the point, no zeros in front.
fn written(is_negative: bool, whole: &str, fraction: Option<&str>, exponent: Option<&str>) -> String {
    let digits = |text: &str| if text.is_empty() { "0".to_owned() } else { text.to_owned() };
    let mut out = String::from(if is_negative { "-" } else { "" });
    out += &digits(whole.trim_start_matches('0'));
    if let Some(fraction) = fraction {
        out += ".";
        out += &digits(fraction);
    }
    if let Some(exponent) = exponent {
        out += "e";
        out += exponent.strip_prefix('+').unwrap_or(exponent);
    }
    out
}
