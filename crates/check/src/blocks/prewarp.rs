//! Tustin's rule that is exact at one frequency `w`: `s = c (z - 1)/(z + 1)` with `c = w/tan(w T/2)`, where `0 < w T < pi`.

use super::hold_rows::numbered;
use super::{Diagram, Rule};
use crate::multivariate::Fraction;
use crate::number::Q;
use num_traits::Signed;

/// A number below pi, as a numerator and the exponent of a power of ten.
const BELOW_PI: (i128, u32) = (31_415_926_535_897_932_384_626_433_832_795_028, 34);

impl Diagram<'_, '_> {
    /// The rule for a frequency and a sample time; by what its factor divides is noted.
    pub(super) fn prewarped(&mut self, frequency: &Fraction, time: &Fraction) -> Result<Rule, String> {
        let clock = self.scope.clock;
        is_below_half_the_sampling_rate(frequency.as_number(), time.as_number())?;
        let Some(values) = self.values else { return Ok(Rule::Unknown) };
        let factor = if let Some(moving) = &mut self.scope.moving {
            moving.prewarped(frequency, time)
        } else {
            let (w, t) = (numbered(frequency, &values, clock)?, numbered(time, &values, clock)?);
            is_below_half_the_sampling_rate(Some(w.clone()), Some(t.clone()))?;
            if values.table.len() == 0 {
                return Err("'prewarp' makes a constant that is not rational, and there are no 'symbols'".into());
            }
            let half = t / Q::from(num_bigint::BigInt::from(2));
            let (x, mut divisors) = values.table.tangent(&(&w * &w), &half, values.first, clock)?;
            divisors.push(x.numerator.clone());
            self.scope.divisors.extend(divisors.into_iter().filter(|m| !m.is_constant()));
            x.inverse(clock)?
        };
        self.substitution("tustin", None, Some(factor)).map(Rule::Quotient)
    }
}

/// Refuses what is a number and for which `w > 0`, `T > 0` and `w T < pi` is not certain.
fn is_below_half_the_sampling_rate(frequency: Option<Q>, time: Option<Q>) -> Result<(), String> {
    if [&frequency, &time].into_iter().flatten().any(|q| !q.is_positive()) {
        return Err("the frequency of 'prewarp', or its sample time, is not positive".into());
    }
    let (top, places) = BELOW_PI;
    let below = Q::new(top.into(), num_bigint::BigInt::from(10).pow(places));
    match frequency.zip(time).map(|(w, t)| w * t) {
        Some(angle) if angle > below => Err("the frequency of 'prewarp' is not below half the sampling rate".into()),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_positive_and_below_pi() {
        let number = |text: &str| Some(crate::number::rational(text).unwrap());
        let is_read = |w: &str, t: &str| is_below_half_the_sampling_rate(number(w), number(t)).is_ok();
        for (w, t) in
            [("700", "1/4000"), ("3", "1"), ("31415/10000", "1"), ("1", "31415926535897932/10000000000000000")]
        {
            assert!(is_read(w, t), "{w} {t}");
        }
        for (w, t) in [
            ("0", "1"),
            ("1", "0"),
            ("-1", "1"),
            ("1", "-1"),
            ("-1", "-1"),
            ("1", "22/7"),
            ("22/7", "1"),
            ("7", "1"),
            ("1", "31415926535897933/10000000000000000"),
        ] {
            assert!(!is_read(w, t), "{w} {t}");
        }
        // What is not known yet is looked at later.
        assert!(is_below_half_the_sampling_rate(None, number("9")).is_ok());
        assert!(is_below_half_the_sampling_rate(number("-9"), None).is_err());
    }
}
