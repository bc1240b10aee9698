//! How many bits behind the point a controller needs.

use crate::format::{Fixed, Format, Rounding};
use crate::realise::Entry;
use crate::shipped::{Shipped, with_controller};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{ToleranceAnswer, Verdict};
use jurist_engine::error::{Code, Error};
use jurist_engine::response::Requirement;

/// With how many bits behind the point a loop is stable and meets its requirements, at the scale of the format; what the range asks for is another
/// question.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Fewest {
    /// From this number on it holds whatever each coefficient is rounded to within half a unit: each more bit makes the box smaller. `None` where no
    /// box was proved.
    pub every_rounding: Option<i64>,
    /// The greatest number below at which some rounding within half a unit does not hold, where a point was found.
    pub refuted: Option<i64>,
    /// The numbers below at which rounding to nearest holds and some coefficient can be other than 0.
    pub nearest: Vec<i64>,
    /// The numbers at which rounding down holds, below the first from which all do.
    pub floor: Vec<i64>,
    /// From this number on rounding down holds: each error is within half a unit of one bit less.
    pub floor_from: Option<i64>,
}

/// So many bits more than those that were asked for are tried.
const MOST_MORE: i64 = 16;

/// Numbers of bits that are tried below the proved one.
const MOST_TRIED: i64 = 64;

impl Shipped {
    /// The fewest bits behind the point. `every` is the answer about every rounding with the format that was asked for; `None` of a format in
    /// floating point.
    ///
    /// Cost: a verdict with requirements for each number of bits below the proved one.
    ///
    /// # Errors
    /// As [`Problem::verdict`](jurist_engine::problem::Problem::verdict) and
    /// [`Problem::requirements_met`](jurist_engine::problem::Problem::requirements_met).
    pub fn fewest(
        &self,
        every: &ToleranceAnswer,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Option<Fewest>, Error> {
        let Format::Fixed(fixed) = self.asked.format else { return Ok(None) };
        // Of directed rounding the box is not the one of half a unit to both sides.
        let has_box = fixed.rounding.error_in_halves() == (-1, 1);
        let factor = every.factor.as_ref().filter(|_| has_box);
        let fraction = i64::from(fixed.fraction);
        let proved = factor.and_then(|f| Some(fraction - floor_of_log2(&f.lower)?));
        let refuted = factor.and_then(|f| Some(fraction - ceiling_of_log2(f.upper.as_ref()?)?));
        let first = self.first_that_tells(&fixed);
        let [refuted, every_rounding] = match has_box {
            true => self.bracketed([refuted, proved], (&fixed, first), (requirements, at), budget)?,
            false => [refuted, proved],
        };
        let last = every_rounding.unwrap_or(fraction + 1);
        let start = first.max(last - MOST_TRIED);
        let mut out = Fewest {
            every_rounding,
            refuted,
            nearest: Vec::new(),
            floor: Vec::new(),
            floor_from: every_rounding.map(|f| f + 1),
        };
        for (rounding, end) in [(Rounding::Nearest, last), (Rounding::Floor, last + 1)] {
            for bits in start..end {
                let fixed = Fixed { bits: 64, fraction: bits as i32, rounding, ..fixed };
                if self.holds(&fixed, requirements, at, budget)? {
                    match rounding {
                        Rounding::Floor => out.floor.push(bits),
                        _ => out.nearest.push(bits),
                    }
                }
            }
        }
        Ok(Some(out))
    }

    /// The greatest number of bits that is refuted and the least that is proved, from what the factor of one box says: each more bit makes the box
    /// smaller, so halving finds them.
    fn bracketed(
        &self,
        [mut refuted, mut proved]: [Option<i64>; 2],
        (fixed, first): (&Fixed, i64),
        asked: (&[Requirement], Option<&str>),
        budget: &Budget,
    ) -> Result<[Option<i64>; 2], Error> {
        let decide = |bits: i64| {
            budget.step(&format!("every rounding with {bits} bits behind the point"));
            self.every_rounding_with(fixed, bits, asked, budget)
        };
        let mut more = 1;
        while proved.is_none() && more <= MOST_MORE {
            let bits = i64::from(fixed.fraction).max(first) + more;
            if decide(bits)? == Some(true) {
                proved = Some(bits);
            }
            more *= 2;
        }
        let Some(mut high) = proved else { return Ok([refuted, proved]) };
        // Below the first bit that tells all coefficients may be 0.
        let mut low = refuted.unwrap_or(first - 2);
        while high - low > 1 {
            let middle = (low + high) / 2;
            match decide(middle)? {
                Some(true) => high = middle,
                Some(false) => {
                    low = middle;
                    refuted = Some(middle);
                }
                None => low = middle,
            }
        }
        Ok([refuted, Some(high)])
    }

    /// The coefficients in a format, whatever its range is.
    ///
    /// # Errors
    /// `E-ship-format` where an enclosure does not tell what is stored.
    pub(crate) fn values_in(&self, fixed: &Fixed) -> Result<Vec<Entry>, Error> {
        let value = |c: &crate::program::Coefficient| -> Result<Entry, Error> {
            let integer = fixed.rounded(c.exact.lower());
            if c.exact.lower() != c.exact.upper() && integer != fixed.rounded(c.exact.upper()) {
                return Err(crate::shipped::not_told(&c.name).into());
            }
            Ok(Entry::Number(fixed.value(&integer)))
        };
        self.realised.program.coefficients.iter().map(value).collect()
    }

    /// The least number of bits at which a coefficient may be other than zero.
    pub(crate) fn first_that_tells(&self, fixed: &Fixed) -> i64 {
        let size = |c: &crate::program::Coefficient| c.exact.lower().abs().max(c.exact.upper().abs());
        let greatest = self.realised.program.coefficients.iter().map(size).max().unwrap_or_default();
        i64::from(fixed.scale) - 1 - floor_of_log2(&greatest).unwrap_or(0)
    }

    /// Whether the loop is stable and meets the requirements with coefficients in this format, whatever their range is.
    fn holds(
        &self,
        fixed: &Fixed,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<bool, Error> {
        let values = self.values_in(fixed)?;
        let problem = match with_controller(&self.exact, &self.asked.block, &self.realised.keys(&values)) {
            // A loop that is not well posed does nothing.
            Err(Error::Refused(found)) if found.code() == Code::AlgebraicLoop => return Ok(false),
            question => question?.problem()?,
        };
        if problem.verdict(budget)?.value().verdict != Verdict::Stable {
            return Ok(false);
        }
        Ok(problem.requirements_met(requirements, at, budget)?.iter().all(|found| found.met))
    }
}

/// The greatest k with `2^k <= value`; `None` for what is not positive.
fn floor_of_log2(value: &Rational) -> Option<i64> {
    if !value.sign().is_gt() {
        return None;
    }
    let guess = value.numerator().bit_length() as i64 - value.denominator().bit_length() as i64;
    Some(if crate::format::power_of_two(guess) <= *value { guess } else { guess - 1 })
}

/// The least k with `2^k >= value`.
fn ceiling_of_log2(value: &Rational) -> Option<i64> {
    let floor = floor_of_log2(value)?;
    Some(if crate::format::power_of_two(floor) == *value { floor } else { floor + 1 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::parse_number;

    #[test]
    fn logarithms_are_rounded_both_ways() {
        let cases = [("1", 0, 0), ("0.99", -1, 0), ("1.01", 0, 1), ("8", 3, 3), ("1/8", -3, -3), ("1e30", 99, 100)];
        for (text, floor, ceiling) in cases {
            let value = parse_number(text).unwrap();
            assert_eq!((floor_of_log2(&value), ceiling_of_log2(&value)), (Some(floor), Some(ceiling)), "{text}");
        }
        assert_eq!(floor_of_log2(&0.into()), None);
    }
}
