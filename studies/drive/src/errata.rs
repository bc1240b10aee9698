//! Printed digits against exact values.

use super::printed::Printed;
use jurist_algebra::number::{Integer, Rational, parse_number};

/// How a printed number relates to the exact one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Match {
    /// The exact value rounds to the printed digits (a tie may go either way).
    Rounded,
    /// The exact value was cut after the printed digits where rounding gives others.
    Cut,
    /// The digits differ from both.
    WrongDigits,
    /// The digits are right, the sign is not: in the text as we have it.
    WrongSign,
}

impl Match {
    /// In words, for a table.
    pub fn words(self) -> &'static str {
        match self {
            Match::Rounded => "equal to the last printed digit",
            Match::Cut => "cut, not rounded",
            Match::WrongDigits => "wrong in the last digits",
            Match::WrongSign => "wrong sign in the text as we have it",
        }
    }
}

/// A printed number with what it should be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comparison {
    /// What is printed, and where.
    pub printed: Printed,
    /// The exact value.
    pub exact: Rational,
    /// How they relate.
    pub outcome: Match,
}

/// The unit of the last printed digit.
fn last_digit_unit(digits: &str) -> Rational {
    let (mantissa, exponent) = digits.split_once('e').unwrap_or((digits, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i64);
    let exponent = exponent.parse::<i64>().unwrap_or(0) - decimals;
    Rational::from(Integer::from(10)).pow(exponent).unwrap_or(Rational::ONE)
}

/// Compares printed digits with an exact value, at the number of digits printed.
///
/// ```
/// use jurist_algebra::number::parse_number;
/// use jurist_drive::{Match, compare};
/// let exact = |text| parse_number(text).unwrap();
/// assert_eq!(compare("5956.43571", &exact("5956.4357176")), Some(Match::Cut));
/// assert_eq!(compare("5956.43572", &exact("5956.4357176")), Some(Match::Rounded));
/// assert_eq!(compare("26420.0562", &exact("26420.0561010")), Some(Match::WrongDigits));
/// assert_eq!(compare("1.5", &exact("-1.5")), Some(Match::WrongSign));
/// assert_eq!(compare("no number", &exact("1")), None);
/// ```
pub fn compare(digits: &str, exact: &Rational) -> Option<Match> {
    let printed = parse_number(digits).ok()?;
    let unit = last_digit_unit(digits);
    let half = &unit * &Rational::new(1.into(), 2.into());
    let rounds = |value: &Rational| (&printed - value).abs() <= half;
    if rounds(exact) {
        return Some(Match::Rounded);
    }
    if rounds(&-exact) {
        return Some(Match::WrongSign);
    }
    let cut = printed.sign() == exact.sign() && printed.abs() <= exact.abs() && (exact - &printed).abs() < unit;
    Some(if cut { Match::Cut } else { Match::WrongDigits })
}

/// Compares every printed number with `exact(power of z, power of the parameter)`.
pub fn compare_all(printed: &[Printed], exact: impl Fn(usize, usize) -> Rational) -> Vec<Comparison> {
    let one = |p: &Printed| {
        let exact = exact(p.power_of_z, p.power_of_parameter);
        compare(p.digits, &exact).map(|outcome| Comparison { printed: *p, exact, outcome })
    };
    printed.iter().filter_map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::super::printed::{EQUATION_23, EQUATION_37, LIST_AFTER_36};
    use super::*;
    use jurist_algebra::limits::Budget;
    use jurist_engine::model::Loop;

    /// Coefficients of the drive in one parameter.
    fn drive(parameter: &str) -> impl Fn(usize, usize) -> Rational {
        let p = crate::tables::polynomial(&Loop::drive(), parameter, &Budget::unlimited()).unwrap();
        move |z, k| super::super::coefficient(&p, z, k)
    }

    #[test]
    fn the_errata_are_those_known() {
        let slips = |printed, exact: &dyn Fn(usize, usize) -> Rational| -> Vec<(usize, usize, Match)> {
            let all = compare_all(printed, exact);
            let wrong = all.into_iter().filter(|c| c.outcome != Match::Rounded);
            wrong.map(|c| (c.printed.power_of_z, c.printed.power_of_parameter, c.outcome)).collect()
        };
        assert_eq!(slips(EQUATION_23, &drive("K_pwm")), []);
        assert_eq!(slips(LIST_AFTER_36, &drive("K_pwm")), [(1, 1, Match::WrongSign)]);
        assert_eq!(
            slips(EQUATION_37, &drive("T")),
            [
                (0, 4, Match::Cut),
                (1, 2, Match::WrongDigits),
                (1, 3, Match::WrongDigits),
                (2, 1, Match::Cut),
                (2, 4, Match::Cut),
                (3, 3, Match::WrongDigits),
                (4, 1, Match::Cut),
            ]
        );
    }
}
