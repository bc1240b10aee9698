//! A gain of a complex loop with dead time.

use super::by_gain::affine_parts;
use super::delayed_transfer::DelayedTransfer;
use crate::error::Error;
use crate::problem::{BaseDelay, DelayedLoop, Problem};
use crate::stability::StableSet;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

impl Problem {
    /// The stable set of a parameter that enters a complex loop with dead time as a gain, by its crossings; `None` of another one, and where these do not tell.
    ///
    /// Of the polynomial with each root and its conjugate the parameter is in squares, and two roots that cross at one value are not told apart: here `D` itself
    /// is looked at, at frequencies of both signs.
    ///
    /// Cost: that of [`DelayedFactors::stable_set`](super::delayed_factors::DelayedFactors::stable_set).
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    pub(crate) fn stable_set_of_complex_gain(
        &self,
        delayed: &DelayedLoop,
        budget: &Budget,
    ) -> Result<Option<StableSet>, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let is_number = matches!(delayed.delay(), BaseDelay::Number(_)) && delayed.decay().is_zero();
        let whole = algebra.complex().filter(|_| is_number && !delayed.is_rational() && !self.region().is_free());
        let Some((whole, family)) = whole.zip(delayed.family()) else { return Ok(None) };
        let Some(lists) = budget.enter(|| affine_parts(whole, &Rational::ONE))? else { return Ok(None) };
        let domain = &self.parameter().domain;
        let transfer = budget.enter(|| DelayedTransfer::new(lists, algebra.symbols()))?;
        match transfer.and_then(|transfer| transfer.stable_factors(family, domain, delayed.poles(), budget)) {
            Err(Error::Refused(_)) => Ok(None),
            Err(Error::Stopped(stopped)) if !stopped.stop.is_budget() && budget.check().is_ok() => Ok(None),
            found => found,
        }
    }
}
