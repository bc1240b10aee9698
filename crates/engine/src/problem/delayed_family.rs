//! Loops with dead time and any number of parameters.

use super::delayed_terms::DelayedTerms;
use super::resolved::Problem;
use crate::error::Error;
use crate::stability::boxes::DelayedFunction;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};

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
        budget.enter(|| {
            let found = DelayedTerms::of(polynomial, usual.len(), time_of, add)?;
            let times = delays.iter().map(|(_, time)| time.clone()).collect();
            Ok(DelayedFunction::new(found.terms, times, found.poles, usual))
        })?
    }
}

/// Adds a dead time some times to a sum.
fn add(sum: &mut RationalFunction, time: &RationalFunction, times: u32) {
    *sum = &*sum + &(time * &RationalFunction::from(Rational::from(i64::from(times))));
}

/// A loop closed over dead time: `D0 + N exp(-d s)` of the denominator and the numerator of its open loop, `d` being the last parameter.
///
/// The variables of the parameters are followed by those of delays, which are given with their dead times. `usual` is a usual point, `d` included.
/// `None` for a loop that vanishes identically.
///
/// # Errors
/// `E-dead-time` where the loop divides by a delay.
pub(crate) fn closed_over_dead_time(
    [denominator, numerator]: [&Poly<MultiPoly>; 2],
    undefined: &MultiPoly,
    delays: &[(usize, RationalFunction)],
    usual: &[Rational],
) -> Result<Option<DelayedFunction>, Error> {
    // The dead time at the cut stands before the delays, and its own delay behind them.
    let last = usual.len() - 1;
    let moved = |p: &MultiPoly| p.map_variables(|i| if i < last { i } else { i + 1 });
    let own = delays.iter().map(|(variable, _)| variable + 2).max().unwrap_or(usual.len());
    let mut times: Vec<(usize, RationalFunction)> = delays.iter().map(|(i, time)| (i + 1, time.clone())).collect();
    times.push((own, RationalFunction::variable(last)));
    let delayed = numerator.map(moved).scaled(&MultiPoly::variable(own));
    let closed = denominator.map(moved).plus(&delayed);
    let coefficients: Vec<RationalFunction> = closed.coeffs().iter().cloned().map(RationalFunction::from).collect();
    let polynomial = CharacteristicPolynomial {
        variables: Vec::new(),
        formal_degree: coefficients.len().saturating_sub(1),
        coefficients,
        poles: vec![moved(undefined)],
        monic: false,
    };
    let time_of = |variable: usize| times.iter().find(|(own, _)| *own == variable).map(|(_, time)| time);
    let found = DelayedTerms::of(&polynomial, usual.len(), time_of, add)?;
    let all = times.iter().map(|(_, time)| time.clone()).collect();
    Ok(DelayedFunction::new(found.terms, all, found.poles, usual))
}
