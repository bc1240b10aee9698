//! Loops with dead time and two parameters.

use super::beside_dead_time::refused_beside;
use super::delayed::refused;
use super::delayed_terms::{DelayedTerms, OverDelays};
use super::resolved::Problem;
use crate::error::Error;
use crate::stability::dead_time::{DeadTime, PlaneLoop};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use std::collections::BTreeMap;

impl Problem {
    /// The loop with dead time in the two free parameters; `None` for any other loop, and where it is undefined for all
    /// values.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and a common denominator.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for what cannot be treated.
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn delayed_plane(&self, budget: &Budget) -> Result<Option<PlaneLoop>, Error> {
        assert_eq!(self.free().len(), 2, "two parameters are free");
        let Some(OverDelays { polynomial, delays, constants }) = self.over_delays("two parameters", budget)? else {
            return Ok(None);
        };
        if !constants.is_empty() {
            return Err(refused_beside());
        }
        let line = |(variable, delay): &(usize, RationalFunction)| Some((*variable, dead_time(delay)?));
        let Some(times) = delays.iter().map(line).collect::<Option<BTreeMap<usize, DeadTime>>>() else {
            let help = "the parameters may enter a dead time as a*x + b*y + c with numbers a, b, c";
            return Err(refused("the dead time is not linear in the free parameters", help));
        };
        budget.enter(|| {
            let found = DelayedTerms::of(&polynomial, 2, |variable| times.get(&variable), DeadTime::add)?;
            Ok(Some(PlaneLoop::new(found.terms.into_iter().collect(), times.into_values().collect(), found.poles)))
        })?
    }
}

/// A dead time that is linear in both parameters.
fn dead_time(delay: &RationalFunction) -> Option<DeadTime> {
    let over = delay.denominator().as_constant()?;
    let mut time = DeadTime::default();
    for (monomial, c) in delay.numerator().terms() {
        let place = match (monomial.total_degree(), monomial.exponent(0), monomial.exponent(1)) {
            (0, ..) => &mut time.offset,
            (1, 1, 0) => &mut time.slopes[0],
            (1, 0, 1) => &mut time.slopes[1],
            _ => return None,
        };
        *place = Rational::new(c.clone(), over.clone());
    }
    Some(time)
}
