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

/// An open loop `N/D0` with a dead time where it is cut.
pub(crate) struct OverDeadTime {
    pub denominator: Poly<MultiPoly>,
    pub numerator: Poly<MultiPoly>,
    /// Where it is undefined.
    pub undefined: MultiPoly,
    /// The variables behind those of the parameters, and the dead times that they stand for.
    pub delays: Vec<(usize, RationalFunction)>,
    /// So many parameters are in it.
    pub parameters: usize,
}

impl OverDeadTime {
    /// The closed loop `D0 + N exp(-time s)`; parameters of the time may follow those of the loop. `usual` is a usual point of all. `None` for a loop that
    /// vanishes identically.
    ///
    /// # Errors
    /// `E-dead-time` where the loop divides by a delay.
    pub fn closed(&self, time: &RationalFunction, usual: &[Rational]) -> Result<Option<DelayedFunction>, Error> {
        let further = usual.len() - self.parameters;
        let moved = |p: &MultiPoly| p.map_variables(|i| if i < self.parameters { i } else { i + further });
        let mut times: Vec<(usize, RationalFunction)> =
            self.delays.iter().map(|(i, time)| (i + further, time.clone())).collect();
        let own = times.iter().map(|(variable, _)| variable + 1).max().unwrap_or(usual.len());
        times.push((own, time.clone()));
        let delayed = self.numerator.map(moved).scaled(&MultiPoly::variable(own));
        let closed = self.denominator.map(moved).plus(&delayed);
        let coefficients: Vec<RationalFunction> = closed.coeffs().iter().cloned().map(RationalFunction::from).collect();
        let polynomial = CharacteristicPolynomial {
            variables: Vec::new(),
            formal_degree: coefficients.len().saturating_sub(1),
            coefficients,
            poles: vec![moved(&self.undefined)],
            monic: false,
        };
        let time_of = |variable: usize| times.iter().find(|(own, _)| *own == variable).map(|(_, time)| time);
        let found = DelayedTerms::of(&polynomial, usual.len(), time_of, add)?;
        let all = times.iter().map(|(_, time)| time.clone()).collect();
        Ok(DelayedFunction::new(found.terms, all, found.poles, usual))
    }
}
