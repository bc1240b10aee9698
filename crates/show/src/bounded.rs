//! Decimals that are not on the wrong side of the number they stand for.

use jurist_algebra::number::{Rational, parse_number, to_decimal, to_scientific};

/// A decimal of so many digits that is not above the number.
///
/// ```
/// use jurist_show::bounded::at_most;
/// assert_eq!(at_most(&"2/3".parse().unwrap(), 3), "0.666");
/// assert_eq!(at_most(&"-1/3".parse().unwrap(), 3), "-0.334");
/// ```
pub fn at_most(value: &Rational, digits: usize) -> String {
    bounded(value, digits, false)
}

/// A decimal of so many digits that is not below the number.
///
/// ```
/// use jurist_show::bounded::at_least;
/// assert_eq!(at_least(&"1/3".parse().unwrap(), 3), "0.334");
/// assert_eq!(at_least(&"1/2".parse().unwrap(), 3), "0.5");
/// ```
pub fn at_least(value: &Rational, digits: usize) -> String {
    bounded(value, digits, true)
}

fn bounded(value: &Rational, digits: usize, upward: bool) -> String {
    let nearest = to_decimal(value, digits);
    let read = |text: &str| parse_number(text).unwrap_or_default();
    let rounded = read(&nearest);
    let is_right = if upward { rounded >= *value } else { rounded <= *value };
    if is_right {
        return nearest;
    }
    // One unit of the last digit: the exponent of the leading one less the digits behind it.
    let scientific = to_scientific(&rounded, digits);
    let exponent: i64 = scientific.rsplit_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let unit = Rational::from(10).pow(exponent + 1 - digits as i64).unwrap_or_default();
    to_decimal(&if upward { rounded + unit } else { rounded - unit }, digits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_on_their_side_and_within_one_unit() {
        for (p, q) in
            [(1i64, 3i64), (2, 3), (-1, 7), (999_999, 1_000_000), (1, 3_000_000), (10_000_001, 3), (5, 1), (-3, 8)]
        {
            let value = Rational::new(p.into(), q.into());
            for digits in 1..9 {
                let (low, high) = (at_most(&value, digits), at_least(&value, digits));
                let (low, high) = (parse_number(&low).unwrap(), parse_number(&high).unwrap());
                assert!(low <= value && value <= high, "{value} to {digits}");
                let size = value.abs().max(Rational::new(1.into(), 10_000_000_000i64.into()));
                let unit = &size * &Rational::from(10).pow(1 - digits as i64).unwrap();
                assert!(&high - &low <= &unit * &Rational::from(2), "{value} to {digits}");
            }
        }
    }
}
