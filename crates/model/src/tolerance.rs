//! How far a value may be from its nominal one.

use jurist_algebra::number::{Rational, parse_number};
use std::fmt;

/// A tolerance as it is written: a share of the nominal value, or a range.
///
/// ```
/// use jurist_model::Tolerance;
/// let tolerance: Tolerance = "-20%..+30%".parse()?;
/// assert_eq!(tolerance.widths(&10.into())?, [2.into(), 3.into()]);
/// assert_eq!("1/2".parse::<Tolerance>()?.widths(&10.into())?[0].to_string(), "1/2");
/// assert_eq!("9..12".parse::<Tolerance>()?.widths(&10.into())?, [1.into(), 2.into()]);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Tolerance {
    /// So much of the nominal value's magnitude below and above it: `10%`, `-20%..+30%`.
    Share {
        /// Below, as a share.
        below: Rational,
        /// Above, as a share.
        above: Rational,
    },
    /// So much below and above the nominal value, in its unit: `0.01`.
    Width(Rational),
    /// From one value to another: `0.4..0.7`.
    Range {
        /// The least value.
        low: Rational,
        /// The greatest value.
        high: Rational,
    },
}

impl Tolerance {
    /// From a lower and an upper bound, both shares or both values.
    pub(super) fn between(low: &str, high: &str) -> Result<Tolerance, String> {
        match (percent(low)?, percent(high)?) {
            ((low, true), (high, true)) => Tolerance::Share { below: -low, above: high }.checked(),
            ((low, false), (high, false)) => Tolerance::Range { low, high }.checked(),
            _ => Err("one bound is a share in % and the other is not".to_owned()),
        }
    }

    /// Refuses widths that are negative.
    pub(super) fn checked(self) -> Result<Tolerance, String> {
        let wrong = match &self {
            Tolerance::Share { below, above } => below.is_negative() || above.is_negative(),
            Tolerance::Width(width) => width.is_negative(),
            Tolerance::Range { low, high } => low > high,
        };
        if !wrong {
            return Ok(self);
        }
        Err(match self {
            Tolerance::Share { .. } => "the nominal value is not within: write -20%..+30%",
            Tolerance::Width(_) => "a tolerance is not negative",
            Tolerance::Range { .. } => "the lower end is above the upper end",
        }
        .to_owned())
    }

    /// The widths below and above a nominal value.
    ///
    /// # Errors
    /// Where the nominal value is not in the range.
    pub fn widths(&self, nominal: &Rational) -> Result<[Rational; 2], String> {
        match self {
            Tolerance::Share { below, above } => Ok([below * &nominal.abs(), above * &nominal.abs()]),
            Tolerance::Width(width) => Ok([width.clone(), width.clone()]),
            Tolerance::Range { low, high } if low <= nominal && nominal <= high => Ok([nominal - low, high - nominal]),
            Tolerance::Range { .. } => Err("the nominal value is not in the range".to_owned()),
        }
    }
}

/// A number, and whether a percent sign stands behind it, which divides it by 100.
fn percent(text: &str) -> Result<(Rational, bool), String> {
    let text = text.trim();
    let (number, is_share) = text.strip_suffix('%').map_or((text, false), |number| (number.trim_end(), true));
    let value = parse_number(number.strip_prefix('+').unwrap_or(number)).map_err(|e| e.to_string())?;
    Ok((if is_share { value * Rational::new(1.into(), 100.into()) } else { value }, is_share))
}

impl std::str::FromStr for Tolerance {
    type Err = String;

    /// `10%`, `-20%..+30%`, `0.01`, `0.4..0.7`.
    fn from_str(text: &str) -> Result<Tolerance, String> {
        if let Some((low, high)) = text.split_once("..") {
            return Tolerance::between(low, high);
        }
        match percent(text)? {
            (share, true) => Tolerance::Share { below: share.clone(), above: share }.checked(),
            (width, false) => Tolerance::Width(width).checked(),
        }
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hundred = Rational::from(100);
        match self {
            Tolerance::Share { below, above } if below == above => write!(f, "{}%", below * &hundred),
            Tolerance::Share { below, above } => write!(f, "-{}%..+{}%", below * &hundred, above * &hundred),
            Tolerance::Width(width) => write!(f, "{width}"),
            Tolerance::Range { low, high } => write!(f, "{low}..{high}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_notation_is_read_and_written_alike() {
        for text in ["10%", "-20%..+30%", "1/100", "2/5..7/10", "-1..1", "0%"] {
            assert_eq!(text.parse::<Tolerance>().unwrap().to_string(), text);
        }
        assert_eq!("0.5 %".parse::<Tolerance>().unwrap().to_string(), "1/2%");
    }

    #[test]
    fn what_leaves_the_nominal_value_out_is_refused() {
        for text in ["", "%", "x", "-1", "-10%", "10%..20%", "-20%..-10%", "2..1", "1..2%", "1%..", "1..2..3"] {
            assert!(text.parse::<Tolerance>().is_err(), "{text}");
        }
        assert!("1..2".parse::<Tolerance>().unwrap().widths(&Rational::from(3)).is_err());
        assert_eq!("10%".parse::<Tolerance>().unwrap().widths(&Rational::from(-5)).unwrap()[0].to_string(), "1/2");
    }
}
