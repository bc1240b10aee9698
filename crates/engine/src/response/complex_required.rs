//! Requirements over values of parameters, of loops with complex coefficients: refused.

use crate::coverage::refusals::COMPLEX_REQUIRED;
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
}
