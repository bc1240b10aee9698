//! Numbers in statements. A short fraction stands as it is. Any other number is a decimal of twelve digits. Three dots stand behind digits that are
//! cut off. The sentence makes plain in which direction an end is rounded.

use super::number::{Q, Z};
use num_traits::{Signed, Zero};

/// So many digits of a decimal are written, more where ends of a set would look the same.
pub(super) const DIGITS: i64 = 12;

/// No more are written.
const MOST_DIGITS: i64 = 3072;

/// An enclosure that tells fewer digits is written by its ends.
const FEW: i64 = 3;

/// Fractions that take no more characters are written as such.
const SHORT: usize = 12;

/// A whole number with at most so many characters is written in full.
const WHOLE: usize = 15;

/// Decimals from one to the other power of ten have no exponent.
const PLAIN: std::ops::Range<i64> = -5..12;

/// A number: its fraction if that is short; its decimal; or the first digits of that and three dots.
pub(super) fn exact(q: &Q) -> String {
    exact_to(q, DIGITS)
}

fn exact_to(q: &Q, digits: i64) -> String {
    let fraction = q.to_string();
    if fraction.len() <= SHORT || q.is_integer() && fraction.len() <= WHOLE {
        return fraction;
    }
    decimal(q, digits)
}

/// Names with their values.
pub(super) fn values<'v>(set: impl Iterator<Item = (&'v String, &'v Q)>) -> String {
    set.map(|(name, value)| format!("{name} = {}", exact(value))).collect::<Vec<_>>().join(", ")
}

/// `, with` these values; nothing where there are none.
pub(super) fn with_values(set: &[(String, Q)]) -> String {
    match set {
        [] => String::new(),
        set => format!(", with {}", values(set.iter().map(|(name, value)| (name, value)))),
    }
}

/// An end of a set, to so many digits: a short fraction has its decimal behind it.
pub(super) fn with_decimal(q: &Q, digits: i64) -> String {
    let shown = exact_to(q, digits);
    if shown.contains('/') { format!("{shown} ({})", decimal(q, digits)) } else { shown }
}

/// The digits that tell the ends of a set apart, ascending and each between two numbers: those that are always written, unless two neighbours look the same.
pub(super) fn digits_apart(ends: &[[Q; 2]]) -> i64 {
    let are_apart = |[a, b]: &[Q; 2], [c, d]: &[Q; 2]| [a, b] != [c, d] && b <= c;
    let mut digits = DIGITS;
    while digits <= MOST_DIGITS {
        let texts: Vec<_> = ends.iter().map(|[low, high]| told(low, high, digits)).collect();
        if !(1..ends.len()).any(|i| texts[i - 1] == texts[i] && are_apart(&ends[i - 1], &ends[i])) {
            return digits;
        }
        digits *= 2;
    }
    DIGITS
}

/// The digits of an end without what says nothing more: dots, and zeros at the end.
fn told(low: &Q, high: &Q, digits: i64) -> String {
    let text = match low == high {
        true if low.is_zero() => "0".to_owned(),
        true => decimal(low, digits),
        false => shared_digits(low, high, digits),
    };
    let text = text.replace("...", "");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, ""));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{mantissa}e{power}")
}

/// The decimal of a number other than 0, or the first digits of it and three dots.
fn decimal(q: &Q, digits: i64) -> String {
    let power = exponent(q) - digits + 1;
    let digits = over_power(&q.abs(), power);
    let sign = if q.is_negative() { "-" } else { "" };
    let dots = if digits.is_integer() { "" } else { "..." };
    format!("{sign}{}", layout(&digits.floor().to_integer(), power, dots))
}

/// The ends of an interval, which is not made wider.
pub(super) fn inward(low: &Q, high: &Q) -> [String; 2] {
    [rounded(low, exponent(low), true), rounded(high, exponent(high), false)]
}

/// The ends of an enclosure, which is not made narrower: both with as many decimals.
pub(super) fn outward(low: &Q, high: &Q) -> [String; 2] {
    let power = exponent(low).max(exponent(high));
    [rounded(low, power, false), rounded(high, power, true)]
}

/// A number inside of an open interval: the first digits that all numbers in it have, so many at most, and three dots; where these are few, the interval.
pub(super) fn shared_digits(low: &Q, high: &Q, digits: i64) -> String {
    let (sign, near, far) = if high <= &Q::zero() { ("-", -high, -low) } else { ("", low.clone(), high.clone()) };
    if near > Q::zero() {
        let leading = exponent(&near);
        for count in (FEW..=digits).rev() {
            let power = leading - count + 1;
            let digits = over_power(&near, power).floor();
            // Zeros would stand in the place of digits that are not known.
            if power > 0 && PLAIN.contains(&leading) {
                break;
            }
            if over_power(&far, power) <= &digits + Q::from(Z::from(1)) {
                return format!("{sign}{}", layout(&digits.to_integer(), power, "..."));
            }
        }
    }
    let [a, b] = outward(low, high);
    format!("[a number between {a} and {b}]")
}

/// A number, or a decimal that is not below, or not above it.
fn rounded(q: &Q, leading: i64, up: bool) -> String {
    let fraction = q.to_string();
    if fraction.len() <= SHORT || q.is_integer() && fraction.len() <= WHOLE {
        return fraction;
    }
    let power = leading - DIGITS + 1;
    let digits = over_power(q, power);
    let digits = if up { digits.ceil() } else { digits.floor() }.to_integer();
    let sign = if digits.is_negative() { "-" } else { "" };
    format!("{sign}{}", layout(&digits.abs(), power, ""))
}

/// The power of ten of the leading digit. Zero has the least power.
fn exponent(q: &Q) -> i64 {
    if q.is_zero() {
        return i64::MIN / 2;
    }
    let length = |n: &Z| n.abs().to_string().len() as i64;
    let about = length(q.numer()) - length(q.denom());
    if over_power(&q.abs(), about) < Q::from(Z::from(1)) { about - 1 } else { about }
}

fn over_power(q: &Q, power: i64) -> Q {
    let ten = Q::from(Z::from(10).pow(power.unsigned_abs() as u32));
    if power >= 0 { q / ten } else { q * ten }
}

/// A whole number that is not negative times a power of ten, with something behind its digits.
fn layout(digits: &Z, power: i64, dots: &str) -> String {
    if digits.is_zero() {
        return "0".into();
    }
    let all = digits.to_string();
    let leading = all.len() as i64 + power - 1;
    let digits = if dots.is_empty() { all.trim_end_matches('0') } else { &all };
    if !PLAIN.contains(&leading) {
        let point = if digits.len() > 1 { "." } else { "" };
        return format!("{}{point}{}{dots}e{leading}", &digits[..1], &digits[1..]);
    }
    if leading < 0 {
        return format!("0.{}{digits}{dots}", "0".repeat((-leading - 1) as usize));
    }
    let whole = leading as usize + 1;
    match digits.len() > whole {
        true => format!("{}.{}{dots}", &digits[..whole], &digits[whole..]),
        false => format!("{digits}{}{dots}", "0".repeat(whole - digits.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn q(text: &str) -> Q {
        super::super::number::rational(text).unwrap()
    }

    #[test]
    fn short_fractions_have_their_decimals() {
        let cases = [
            ("156/7", "156/7 (22.2857142857...)"),
            ("3/5", "3/5 (0.6)"),
            ("-1/3", "-1/3 (-0.333333333333...)"),
            ("6", "6"),
        ];
        for (number, shown) in cases {
            assert_eq!(with_decimal(&number.parse().unwrap(), DIGITS), shown);
        }
        assert_eq!(with_decimal(&Q::zero(), DIGITS), "0");
    }

    #[test]
    fn ends_that_would_look_the_same_have_more_digits() {
        let end = |text: &str| [q(text), q(text)];
        let near = "1000000000000000000000000000001/1000000000000000000000000000000";
        assert_eq!(digits_apart(&[end("1"), end(near)]), 48);
        assert_eq!(with_decimal(&q(near), 48), "1.000000000000000000000000000001");
        assert_eq!(digits_apart(&[end("1"), end("1"), end("2")]), DIGITS);
        // Enclosures that tell no more digits.
        let wide = |low: &str| [q(low), q("1415/1000")];
        assert_eq!(digits_apart(&[wide("1414/1000"), wide("14141/10000")]), DIGITS);
    }

    #[test]
    fn numbers_are_short_exact_or_marked() {
        for (number, words) in [
            ("8/3", "8/3"),
            ("-1/10000", "-1/10000"),
            ("123456789012345", "123456789012345"),
            ("100000000000000000000", "1e20"),
            ("1234567890123456789", "1.23456789012...e18"),
            ("-1/1048576000", "-9.53674316406...e-10"),
            ("1453635/2097152", "0.693147182464..."),
            ("-100000001/100000000", "-1.00000001"),
            ("1234567890123456/10", "1.23456789012...e14"),
            ("1234567890123/10", "123456789012..."),
            ("0", "0"),
        ] {
            assert_eq!(exact(&q(number)), words);
        }
    }

    #[test]
    fn enclosures_are_the_digits_that_they_tell() {
        for (low, high, words) in [
            ("1414213562373/1000000000000", "1414213562374/1000000000000", "1.41421356237..."),
            ("-1414213562374/1000000000000", "-1414213562373/1000000000000", "-1.41421356237..."),
            ("1414213/1000000", "1414214/1000000", "1.414213..."),
            ("1/3000000000000", "10001/30000000000000000", "3.333...e-13"),
            ("199/100", "2", "1.99..."),
            ("345", "346", "345..."),
            ("34500", "34600", "[a number between 34500 and 34600]"),
            ("34500000000000", "34600000000000", "3.45...e13"),
            ("99/100", "101/100", "[a number between 99/100 and 101/100]"),
            ("0", "1/1000", "[a number between 0 and 1/1000]"),
            ("-1", "1", "[a number between -1 and 1]"),
        ] {
            assert_eq!(shared_digits(&q(low), &q(high), DIGITS), words);
        }
    }

    #[test]
    fn ends_are_rounded_the_way_that_is_true() {
        let (low, high) = (q("20000000000001/30000000000000"), q("20000000000001/10000000000000"));
        assert_eq!(inward(&low, &high), ["0.666666666667", "2"]);
        assert_eq!(outward(&low, &high), ["0.66666666666", "2.00000000001"]);
        assert_eq!(outward(&-high, &-low), ["-2.00000000001", "-0.66666666666"]);
        assert_eq!(outward(&q("0"), &q("1/3000000000000")), ["0", "3.33333333334e-13"]);
    }
}
