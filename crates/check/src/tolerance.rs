//! Tolerances of a model: read, so that a text which breaks their rules is refused, and of no influence on what is proved.

use super::clock::Clock;
use super::expression::number;
use super::number::Q;
use super::toml::Toml;
use num_traits::{Signed, Zero};

/// Refuses what is no tolerance: a width, a share such as `10%`, two bounds, or a range.
pub(super) fn tolerance(value: &Toml, clock: &Clock) -> Result<(), String> {
    match value {
        Toml::Text(text) => match text.split_once("..") {
            Some((low, high)) => between(low, high, clock),
            None => not_negative(&bound(text, clock)?.0),
        },
        Toml::Number(_) => not_negative(&number(value, clock)?),
        Toml::List(items) => match items.as_slice() {
            [low, high] => between(low.expression()?, high.expression()?, clock),
            _ => Err("a tolerance has two bounds".into()),
        },
        Toml::Table(entries) => {
            let end = |key: &str| number(value.get(key).ok_or("a tolerance has no 'low' or 'high'")?, clock);
            match entries.len() {
                2 if end("low")? <= end("high")? => Ok(()),
                _ => Err("a tolerance is from 'low' to 'high'".into()),
            }
        }
        Toml::Boolean | Toml::Other => Err("a tolerance is expected".into()),
    }
}

/// Shares around zero, or values in order.
fn between(low: &str, high: &str, clock: &Clock) -> Result<(), String> {
    let ((low, is_share), (high, too)) = (bound(low, clock)?, bound(high, clock)?);
    let is_right = if is_share { !low.is_positive() && !high.is_negative() } else { low <= high };
    if is_share == too && is_right { Ok(()) } else { Err("the bounds of a tolerance do not go together".into()) }
}

/// A number and whether it is a share.
fn bound(text: &str, clock: &Clock) -> Result<(Q, bool), String> {
    let text = text.trim();
    let (digits, is_share) = text.strip_suffix('%').map_or((text, false), |digits| (digits.trim_end(), true));
    let plain = digits.strip_prefix(['+', '-']).unwrap_or(digits);
    let known = |c: char| c.is_ascii_digit() || "._eE/+-".contains(c);
    let signs = plain.match_indices(['+', '-']).all(|(at, _)| plain[..at].ends_with(['e', 'E']));
    if plain.is_empty() || !plain.chars().all(known) || !signs || plain.matches('/').count() > 1 {
        return Err("a bound of a tolerance is not a number".into());
    }
    let value = number(&Toml::Text(plain.to_owned()), clock)?;
    Ok((if digits.starts_with('-') { -value } else { value }, is_share))
}

fn not_negative(value: &Q) -> Result<(), String> {
    if *value < Q::zero() { Err("a tolerance is negative".into()) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toml::read;
    use std::time::Duration;

    #[test]
    fn every_notation_is_known_and_nothing_else() {
        let clock = Clock::new(Duration::MAX);
        let accepts = |text: &str| tolerance(read(&format!("t = {text}")).unwrap().get("t").unwrap(), &clock).is_ok();
        for text in [
            "'10%'",
            "0.01",
            "'1/100'",
            "['-20%', '+30%']",
            "'-20%..+30%'",
            "'1..2'",
            "[1, 2]",
            "{ low = 0.4, high = '7/10' }",
        ] {
            assert!(accepts(text), "{text}");
        }
        for text in [
            "''",
            "'%'",
            "-1",
            "'-10%'",
            "'10%..20%'",
            "'2..1'",
            "[1]",
            "['1', '2%']",
            "{ low = 1 }",
            "true",
            "'1+1'",
            "{ low = 2, high = 1 }",
        ] {
            assert!(!accepts(text), "{text}");
        }
    }
}
