//! Literals of C as exact decimals.

use super::refused;
use super::token::{Kind, Token};
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::error::{Diagnostic, Span};

/// A number with the digits that are written.
#[derive(Clone, Debug)]
pub(super) struct Number {
    /// As a number of a model file.
    pub text: String,
    pub value: Rational,
    pub span: Span,
}

impl Number {
    /// What C puts where nothing is written.
    pub fn zero(span: Span) -> Number {
        Number { text: "0".into(), value: Rational::ZERO, span }
    }

    /// Signs and a literal.
    pub fn of(tokens: &[Token<'_>]) -> Result<Number, Diagnostic> {
        let signs = tokens.iter().take_while(|token| token.is("-") || token.is("+")).count();
        let span = whole(tokens);
        let [literal] = &tokens[signs..] else {
            return Err(refused("this is no literal number")
                .at(span, "an expression")
                .help("write the decimal number itself: nothing is computed here"));
        };
        if literal.kind != Kind::Number {
            return Err(refused(format!("'{}' is no literal number", shown(literal.text)))
                .at(literal.span, "")
                .help("write the decimal number itself: names and macros are not looked up"));
        }
        let unsigned = decimal(literal.text).map_err(|why| refused(why).at(literal.span, ""))?;
        let value = parse_number(&unsigned).map_err(|error| refused(error.to_string()).at(literal.span, ""))?;
        let is_negative = tokens[..signs].iter().filter(|token| token.is("-")).count() % 2 == 1;
        if is_negative && !value.is_zero() {
            return Ok(Number { text: format!("-{unsigned}"), value: -value, span });
        }
        Ok(Number { text: unsigned, value, span })
    }

    /// A whole number of at most `most`.
    pub fn whole(&self, what: &str, least: i64, most: i64) -> Result<i64, Diagnostic> {
        let number = self.value.is_integer().then(|| self.value.numerator().to_i64()).flatten();
        number.filter(|number| (least..=most).contains(number)).ok_or_else(|| {
            refused(format!("{what} is no whole number from {least} to {most}")).at(self.span, "out of range")
        })
    }
}

/// From the first token to the last.
pub(super) fn whole(tokens: &[Token<'_>]) -> Span {
    match (tokens.first(), tokens.last()) {
        (Some(first), Some(last)) => Span::new(first.span.start, last.span.end),
        _ => Span::default(),
    }
}

/// A text for a message.
pub(super) fn shown(text: &str) -> String {
    text.chars().take(40).collect()
}

/// `1.e+03f` as `1e3`, say: the same digits in the notation of model files.
fn decimal(text: &str) -> Result<String, String> {
    let no_number = || Err(format!("'{}' is no decimal number", shown(text)));
    let lower = text.to_ascii_lowercase();
    if lower.starts_with("0x") || lower.starts_with("0b") {
        return no_number();
    }
    let is_whole = !lower.contains(['.', 'e']);
    let suffixes: &[char] = if is_whole { &['u', 'l'] } else { &['f', 'l'] };
    let plain = lower.trim_end_matches(suffixes);
    let (mantissa, power) = plain.split_once('e').map_or((plain, None), |(m, p)| (m, Some(p)));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let are_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let power_digits = power.map(|power| power.strip_prefix(['+', '-']).unwrap_or(power));
    let is_power = power_digits.is_none_or(|power| !power.is_empty() && are_digits(power));
    if !(are_digits(whole) && are_digits(fraction) && whole.len() + fraction.len() > 0 && is_power) {
        return no_number();
    }
    if is_whole && whole.len() > 1 && whole.starts_with('0') {
        return Err(format!("'{}' is an octal number in C", shown(text)));
    }
    let whole = whole.trim_start_matches('0');
    let mut out = if whole.is_empty() { "0".to_owned() } else { whole.to_owned() };
    if !fraction.is_empty() {
        out = format!("{out}.{fraction}");
    }
    if let Some(power) = power {
        let digits = power_digits.unwrap_or_default().trim_start_matches('0');
        let sign = if power.starts_with('-') { "-" } else { "" };
        if !digits.is_empty() {
            out = format!("{out}e{sign}{digits}");
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn literals_keep_their_digits() {
        let of = |text: &str| decimal(text).unwrap_or_else(|why| why);
        assert_eq!(of("1.000000e-03"), "1.000000e-3");
        assert_eq!(
            (of("1.e+03f"), of(".5F"), of("007.50L"), of("12ul")),
            ("1e3".into(), "0.5".into(), "7.50".into(), "12".into())
        );
        assert_eq!((of("0e0"), of("0"), of("0.")), ("0".into(), "0".into(), "0".into()));
        for wrong in ["0x10", "1e", "1f", "1.2.3", "010", "1e5x", "0b1"] {
            assert!(decimal(wrong).is_err(), "{wrong}");
        }
    }
}
