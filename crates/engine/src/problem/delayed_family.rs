//! Loops with dead time and any number of parameters.

use super::delayed_terms::DelayedTerms;
use super::resolved::Problem;
use crate::error::Error;
use crate::stability::boxes::DelayedFunction;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

impl Problem {
    /// The loop with dead time in all free parameters, around a usual point; `None` for any other loop, and where it is undefined or vanishes
    /// for all values.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and a common denominator.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for what cannot be treated.
    pub(crate) fn delayed_family(&self, usual: &[Rational], budget: &Budget) -> Result<Option<DelayedFunction>, Error> {
        let Some((polynomial, delays)) = self.over_delays("tolerances", budget)? else { return Ok(None) };
        let time_of = |variable: usize| delays.iter().find(|(own, _)| *own == variable).map(|(_, time)| time);
        let add = |sum: &mut RationalFunction, time: &RationalFunction, times: u32| {
            *sum = &*sum + &(time * &RationalFunction::from(Rational::from(i64::from(times))));
        };
        budget.enter(|| {
            let found = DelayedTerms::of(polynomial, usual.len(), time_of, add)?;
            let times = delays.iter().map(|(_, time)| time.clone()).collect();
            Ok(DelayedFunction::new(found.terms, times, found.poles, usual))
        })?
    }
}
