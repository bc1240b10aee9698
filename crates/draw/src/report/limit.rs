//! Limits as a table shows them, and how far they move.

use jurist_algebra::number::{Rational, to_decimal};
use jurist_algebra::real::Real;
use jurist_engine::answer::Answer;
use jurist_engine::stability::{StableInterval, StableSet};
use jurist_show::real;

/// The stable interval that the nominal value lies in.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_draw::report::around_nominal;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited())?;
/// let upper = around_nominal(&answer).unwrap().upper.as_ref().unwrap();
/// assert_eq!(upper.value.decimal(6), "550.941");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub fn around_nominal(answer: &Answer<StableSet>) -> Option<&StableInterval> {
    let nominal = answer.problem().parameter().nominal.as_ref()?;
    answer.value().intervals().iter().find(|i| i.contains(nominal))
}

/// The number to that many digits; `none` for none.
///
/// ```
/// use jurist_draw::report::limit_text;
/// assert_eq!(limit_text(Some(&jurist_algebra::number::Rational::from(2).into()), 6), "2");
/// assert_eq!(limit_text(None, 6), "none");
/// ```
pub fn limit_text(x: Option<&Real>, digits: usize) -> String {
    x.map_or_else(|| "none".into(), |x| real::rounded(x, digits).decimal)
}

/// Digits of the numbers of which a change is computed.
pub(super) const CHANGE_DIGITS: usize = 20;

/// By how many percent a number is above another, to three digits; `None` where it is the same, or the other is 0.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_draw::report::percent_change;
/// let real = |n: i64| Rational::from(n).into();
/// assert_eq!(percent_change(&real(11), &real(10)).as_deref(), Some("+10"));
/// assert_eq!(percent_change(&real(10), &real(10)), None);
/// ```
pub fn percent_change(now: &Real, base: &Real) -> Option<String> {
    let middle = |x: &Real| {
        let (lo, hi) = x.refined_to_digits(CHANGE_DIGITS).enclosure();
        lo.midpoint(&hi)
    };
    let ratio = middle(now).checked_div(&middle(base))?;
    let percent = (&ratio - &Rational::ONE) * Rational::from(100);
    let sign = if percent.sign().is_gt() { "+" } else { "" };
    // The enclosures are far narrower than three digits ask for.
    (!percent.is_zero()).then(|| format!("{sign}{}", three_digits(&percent)))
}

/// A number that is not zero to three digits, small ones with a power of ten.
fn three_digits(value: &Rational) -> String {
    let thousandth = Rational::new(1.into(), 1000.into());
    if value.abs() >= thousandth {
        return to_decimal(value, 3);
    }
    let (mut mantissa, mut power) = (value.clone(), 0);
    while mantissa.abs() < Rational::ONE {
        (mantissa, power) = (mantissa * Rational::from(10), power + 1);
    }
    format!("{}e-{power}", to_decimal(&mantissa, 3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_changes_have_powers_of_ten() {
        let q = |n: i64, d: i64| Rational::new(n.into(), d.into());
        assert_eq!(three_digits(&q(-1, 300)), "-0.00333");
        assert_eq!(three_digits(&q(1, 1000)), "0.001");
        assert_eq!(three_digits(&q(1, 3_000_000)), "3.33e-7");
    }
}
