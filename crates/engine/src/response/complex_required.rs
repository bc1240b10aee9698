//! Requirements over values of parameters, of loops with complex coefficients: refused.

use super::requirement::Requirement;
use crate::coverage::refusals::{COMPLEX_DELAY_MARGIN, COMPLEX_REQUIRED};
use crate::error::{Code, Error};
use crate::problem::Problem;
use jurist_algebra::limits::Budget;

impl Problem {
    /// [`Problem::refuse_complex`] in the words of a question about requirements over values of parameters.
    ///
    /// # Errors
    /// As [`Problem::refuse_complex`].
    pub(crate) fn refuse_complex_requirements(&self, budget: &Budget) -> Result<(), Error> {
        match self.refuse_complex(budget) {
            Err(Error::Refused(found)) if found.code() == Code::Complex => Err(COMPLEX_REQUIRED.diagnostic(&[]).into()),
            known => known,
        }
    }

    /// Refuses a delay margin over values of one parameter of a loop with complex coefficients.
    ///
    /// # Errors
    /// `E-complex`; as [`Problem::algebra_over_symbols`].
    pub(super) fn refuse_complex_set(&self, requirements: &[Requirement], budget: &Budget) -> Result<(), Error> {
        if !self.is_written_complex() || !self.algebra_over_symbols(budget)?.is_complex() {
            return Ok(());
        }
        match requirements.iter().any(Requirement::is_delay_margin) {
            true => Err(COMPLEX_DELAY_MARGIN.diagnostic(&[]).into()),
            false => Ok(()),
        }
    }
}
