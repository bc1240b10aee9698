//! The shortest decimal between two numbers.

use jurist_algebra::number::{Integer, Rational};

/// More digits are not tried.
const MOST_DIGITS: u32 = 40;

/// The decimal with the fewest significant digits in a closed interval, of these the one that is nearest to a number in it; `None` where 40 digits are
/// not enough.
///
/// Cost: a division for each number of digits.
///
/// ```
/// use jurist_algebra::number::parse_number;
/// use jurist_tune::decimals::shortest;
/// let number = |text| parse_number(text).unwrap();
/// assert_eq!(shortest(&number("1.2219"), &number("1.2481"), &number("1.247")), Some(number("1.24")));
/// assert_eq!(shortest(&number("-3"), &number("0.5"), &number("0.1")), Some(number("0")));
/// assert_eq!(shortest(&number("97"), &number("104"), &number("103")), Some(number("100")));
/// ```
pub fn shortest(low: &Rational, high: &Rational, near: &Rational) -> Option<Rational> {
    if !low.sign().is_gt() && !high.is_negative() {
        return Some(Rational::ZERO);
    }
    let greatest = low.abs().max(high.abs());
    let first = first_power(&greatest);
    for digits in 0..=i64::from(MOST_DIGITS) {
        let unit = power(first - digits);
        let steps = near.checked_div(&unit)?;
        let below = steps.floor();
        let candidates = (-1..=2).map(|k| Rational::from(&below + &Integer::from(k)) * &unit);
        let distance = |x: &Rational| (x - near).abs();
        let inside = candidates.filter(|x| x >= low && x <= high);
        if let Some(best) = inside.min_by(|a, b| distance(a).cmp(&distance(b))) {
            return Some(best);
        }
    }
    None
}

/// A power of ten.
pub(crate) fn power(k: i64) -> Rational {
    Rational::from(10).pow(k).expect("ten is not zero")
}

/// The least power of ten above a positive number, as its exponent.
pub(crate) fn first_power(x: &Rational) -> i64 {
    let mut first = 0;
    while power(first) <= *x {
        first += 1;
    }
    while power(first - 1) > *x {
        first -= 1;
    }
    first
}

/// A number of so many significant digits that is not above a number, or not below it.
pub(crate) fn on_side(x: &Rational, digits: i64, is_below: bool) -> Rational {
    if x.is_zero() {
        return Rational::ZERO;
    }
    let unit = power(first_power(&x.abs()) - digits);
    let steps = x.checked_div(&unit).expect("a power of ten is not zero");
    Rational::from(if is_below { steps.floor() } else { steps.ceil() }) * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn significant(x: &Rational) -> usize {
        let text = jurist_algebra::number::to_decimal(x, 60);
        let digits: String = text.chars().filter(char::is_ascii_digit).collect();
        digits.trim_start_matches('0').trim_end_matches('0').len()
    }

    #[test]
    fn a_number_is_rounded_to_one_side() {
        let third = Rational::new(2.into(), 3.into());
        let text = |x: &Rational, is_below| jurist_algebra::number::to_decimal(&on_side(x, 3, is_below), 10);
        assert_eq!([text(&third, true), text(&third, false)], ["0.666", "0.667"]);
        assert_eq!([text(&-third.clone(), true), text(&Rational::from(180), true)], ["-0.667", "180"]);
        assert_eq!(text(&Rational::new(17_999.into(), 100.into()), true), "179");
    }

    proptest! {
        #[test]
        #[ignore = "long: CI runs it"]
        fn no_shorter_decimal_is_inside(low in -5000_i64..5000, width in 1_i64..2000, place in 0_i64..=100) {
            let thousandth = |x: i64| Rational::new(x.into(), 1000.into());
            let (low, high) = (thousandth(low), thousandth(low + width));
            let near = &low + &((&high - &low) * Rational::new(place.into(), 100.into()));
            let found = shortest(&low, &high, &near).expect("a decimal of thousandths is an end");
            prop_assert!(found >= low && found <= high);
            // By brute force: all multiples of powers of ten.
            for exponent in -3..=1_i64 {
                let unit = Rational::from(10).pow(exponent).unwrap();
                let from = low.checked_div(&unit).unwrap().ceil();
                let mut k = Rational::from(from) * &unit;
                while k <= high {
                    prop_assert!(significant(&k) >= significant(&found), "{k} is shorter than {found}");
                    k = &k + &unit;
                }
            }
        }
    }
}
