//! Loops with dead time and any number of parameters.

use super::beside_dead_time::{CONSTANT_BITS, Constants, refused_beside};
use super::delayed_terms::{DelayedTerms, OverDelays, add_times};
use super::resolved::Problem;
use crate::coverage::refusals::DECAY;
use crate::error::Error;
use crate::model;
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
            let mut found = DelayedTerms::of(polynomial, all.len(), time_of, add_times)?;
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

/// An open loop `N/D0` with a dead time where it is cut.
pub(crate) struct OverDeadTime {
    /// In the parameters, in constants, and in delays.
    denominator: Poly<MultiPoly>,
    numerator: Poly<MultiPoly>,
    /// Where it is undefined.
    undefined: MultiPoly,
    /// The variables that stand for delays, and the dead times.
    delays: Vec<(usize, RationalFunction)>,
    /// So many parameters are in it.
    parameters: usize,
    /// Bounds of the constants that are not rational.
    constants: Vec<[Rational; 2]>,
}

impl OverDeadTime {
    /// From the denominator and the numerator in the names that are free and in symbols, and from where it is undefined; `None` beside functions of a
    /// free name.
    pub fn new(
        [denominator, numerator]: [&Poly<MultiPoly>; 2],
        undefined: &MultiPoly,
        symbols: &model::Symbols,
    ) -> Option<OverDeadTime> {
        let (delays, parameters) = (symbols.delays(), symbols.first());
        let constants = Constants::of(symbols, 0).ok()?;
        let place = |variable: usize| constants.place(variable, parameters, &delays);
        let [denominator, numerator] = [denominator, numerator].map(|p| p.map(|c| c.map_variables(place)));
        let moved = |(variable, time): &(usize, RationalFunction)| Some((place(*variable), time.map_variables(place)?));
        Some(OverDeadTime {
            denominator,
            numerator,
            undefined: undefined.map_variables(place),
            delays: delays.iter().map(moved).collect::<Option<_>>().expect("variables stay apart"),
            parameters,
            constants: constants.bounds(),
        })
    }

    /// Bounds of the constants that are not rational: parameters of closed loops, after all others.
    pub fn constants(&self) -> &[[Rational; 2]] {
        &self.constants
    }

    /// What is positive where the modulus of the open loop is above one in the limit of high frequencies; `None` where dead times are in that limit.
    pub fn above_at_highest(&self) -> Option<MultiPoly> {
        let degree = self.denominator.degree().max(self.numerator.degree())?;
        let names = self.parameters + self.constants.len();
        let highest = [&self.numerator, &self.denominator].map(|p| {
            let p = p.coeff(degree);
            // One dead time that all terms have turns the loop alone.
            let delays = |exponents: &[u32]| exponents.iter().skip(names).copied().collect::<Vec<u32>>();
            let mut all = p.terms().iter().map(|(monomial, _)| delays(monomial.exponents()));
            let first = all.next();
            let is_one = all.all(|other| Some(&other) == first.as_ref());
            let own = p.terms().iter().map(|(monomial, c)| {
                (monomial.exponents().iter().take(names).copied().collect::<Vec<u32>>(), c.clone())
            });
            is_one.then(|| MultiPoly::from_terms(own))
        });
        let [Some(above), Some(below)] = highest else { return None };
        Some(above.times(&above).minus(&below.times(&below)))
    }

    /// The closed loop `D0 + N exp(-time s)`; parameters of the time may follow those of the loop. `usual` is a usual point of all but the constants.
    /// `None` for a loop that vanishes identically.
    ///
    /// # Errors
    /// `E-dead-time` where the loop divides by a delay.
    pub fn closed(&self, time: &RationalFunction, usual: &[Rational]) -> Result<Option<DelayedFunction>, Error> {
        let further = usual.len() - self.parameters;
        let place = |i: usize| if i < self.parameters { i } else { i + further };
        let moved = |p: &MultiPoly| p.map_variables(place);
        let time_of = |f: &RationalFunction| f.map_variables(place).expect("variables stay apart");
        let mut times: Vec<(usize, RationalFunction)> =
            self.delays.iter().map(|(i, time)| (place(*i), time_of(time))).collect();
        let mut all = usual.to_vec();
        all.extend(self.constants.iter().map(|[low, high]| low.midpoint(high)));
        let own = all.len() + times.len();
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
        let found = DelayedTerms::of(&polynomial, all.len(), time_of, add_times)?;
        let times = times.iter().map(|(_, time)| time.clone()).collect();
        Ok(DelayedFunction::new(found.terms, times, found.poles, &all))
    }
}
