//! Loops with dead time and any number of parameters.

use super::delayed_terms::DelayedTerms;
use super::resolved::Problem;
use crate::coverage::refusals::DECAY;
use crate::error::Error;
use crate::stability::boxes::DelayedFunction;
use jurist_algebra::ball::{Ball, exp};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};

/// Factors `exp(decay tau)` are enclosed with so many bits after the point.
const FACTOR_BITS: u64 = 160;

/// A family with the bounds of its last parameters, which are constants.
pub(crate) type BesideConstants = (DelayedFunction, Vec<[Rational; 2]>);

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

impl Problem {
    /// The loop whose roots are to decay as the region says: [`Problem::delayed_family`], where each factor `exp(decay tau)` of a delayed part is one more
    /// parameter, after the others, between the bounds that are returned.
    ///
    /// # Errors
    /// As [`Problem::delayed_family`]; `E-dead-time` where a decay rate is asked for and a dead time depends on a parameter.
    pub(crate) fn delayed_family_in_region(
        &self,
        usual: &[Rational],
        budget: &Budget,
    ) -> Result<Option<BesideConstants>, Error> {
        let Some(decay) = self.region().decay() else {
            return Ok(self.delayed_family(usual, budget)?.map(|family| (family, Vec::new())));
        };
        let Some((polynomial, delays)) = self.over_delays_in_region(budget)? else { return Ok(None) };
        if delays.iter().any(|(_, time)| !time.is_constant()) {
            return Err(DECAY.diagnostic(&[("what", "values of a dead time")]).into());
        }
        let time_of = |variable: usize| delays.iter().find(|(own, _)| *own == variable).map(|(_, time)| time);
        budget.enter(|| {
            let mut found = DelayedTerms::of(polynomial, usual.len(), time_of, add)?;
            let (mut all, mut bounds) = (usual.to_vec(), Vec::new());
            for (time, part) in found.terms.iter_mut().filter(|(time, _)| !time.is_zero()) {
                let factor = MultiPoly::variable(all.len());
                part.iter_mut().for_each(|c| *c = c.times(&factor));
                let exponent = decay * &time.as_constant().expect("a number");
                let value = exp(&Ball::from_rational(&exponent, FACTOR_BITS));
                all.push(value.lower().midpoint(&value.upper()));
                bounds.push([value.lower(), value.upper()]);
            }
            let times = delays.iter().map(|(_, time)| time.clone()).collect();
            let family = DelayedFunction::new(found.terms, times, found.poles, &all);
            Ok(family.map(|family| (family, bounds)))
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
