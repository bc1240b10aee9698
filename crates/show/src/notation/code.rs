//! What the notations for programming languages share.

use jurist_algebra::number::{Rational, to_decimal};

/// Names that a language accepts, each different: other characters become `_`, and what is reserved
/// gets one at its end.
pub(super) fn identifiers(names: &[String], reserved: &[&str]) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for name in names {
        let mut id: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        if !id.starts_with(|c: char| c.is_ascii_alphabetic()) {
            id.insert(0, 'p');
        }
        while reserved.contains(&id.as_str()) || out.contains(&id) {
            id.push('_');
        }
        out.push(id);
    }
    out
}

/// Numerator and denominator as literals of binary floating point, or one decimal literal where they
/// are out of its range.
pub(super) enum FloatLiteral {
    Fraction(String, String),
    Decimal(String),
}

/// Integers above this many bits are no longer safely in the range of binary floating point.
const SAFE_BITS: u64 = 1000;

/// Digits that determine a binary floating point number.
const SUFFICIENT_DIGITS: usize = 17;

impl FloatLiteral {
    pub fn new(value: &Rational, digits: Option<usize>) -> Self {
        let (numerator, denominator) = (value.numerator(), value.denominator());
        match digits {
            Some(digits) => FloatLiteral::Decimal(to_decimal(value, digits)),
            None if numerator.bit_length().max(denominator.bit_length()) > SAFE_BITS => {
                FloatLiteral::Decimal(to_decimal(value, SUFFICIENT_DIGITS))
            }
            None => FloatLiteral::Fraction(numerator.to_string(), denominator.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_valid_and_distinct() {
        let names = ["lambda", "ω", "é", "K_pwm", "_x", "lambda_"].map(String::from);
        assert_eq!(identifiers(&names, &["lambda"]), ["lambda_", "p_", "p__", "K_pwm", "p_x", "lambda__"]);
    }
}
