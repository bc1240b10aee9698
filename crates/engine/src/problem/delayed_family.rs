//! Loops with dead time and any number of parameters.

use super::beside_dead_time::refused_beside;
use super::delayed_terms::{CONSTANT_BITS, DelayedTerms, OverDelays};
use super::resolved::Problem;
use crate::coverage::refusals::DECAY;
use crate::error::Error;
use crate::stability::boxes::DelayedFunction;
use jurist_algebra::ball::{Ball, exp};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction};

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
        let Some(over) = self.over_delays("tolerances", budget)? else { return Ok(None) };
        if !over.constants.is_empty() {
            return Err(refused_beside());
        }
        Ok(self.family_over(&over, usual, budget)?.map(|(family, _)| family))
    }

    /// The loop whose roots are to decay as the region says, as [`Problem::delayed_family`]. Constants that are not rational are further parameters, after
    /// the others, between the bounds that are returned; so is each factor `exp(decay tau)` of a delayed part.
    ///
    /// # Errors
    /// As [`Problem::delayed_family`]; `E-dead-time` where a decay rate is asked for and a dead time depends on a parameter.
    pub(crate) fn delayed_family_in_region(
        &self,
        usual: &[Rational],
        budget: &Budget,
    ) -> Result<Option<BesideConstants>, Error> {
        let Some(over) = self.over_delays_in_region(budget)? else { return Ok(None) };
        self.family_over(&over, usual, budget)
    }

    fn family_over(
        &self,
        over: &OverDelays<'_>,
        usual: &[Rational],
        budget: &Budget,
    ) -> Result<Option<BesideConstants>, Error> {
        let OverDelays { polynomial, delays, constants } = over;
        let decay = self.region().decay();
        if decay.is_some() && delays.iter().any(|(_, time)| !time.is_constant()) {
            return Err(DECAY.diagnostic(&[("what", "values of a dead time")]).into());
        }
        let time_of = |variable: usize| delays.iter().find(|(own, _)| *own == variable).map(|(_, time)| time);
        budget.enter(|| {
            let mut bounds = constants.clone();
            let mut all = usual.to_vec();
            all.extend(constants.iter().map(|[low, high]| low.midpoint(high)));
            let mut found = DelayedTerms::of(polynomial, all.len(), time_of, add)?;
            for (time, part) in found.terms.iter_mut().filter(|(time, _)| !time.is_zero()) {
                let Some(decay) = decay else { break };
                let factor = MultiPoly::variable(all.len());
                part.iter_mut().for_each(|c| *c = c.times(&factor));
                let exponent = decay * &time.as_constant().expect("a number");
                let value = exp(&Ball::from_rational(&exponent, CONSTANT_BITS));
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
