//! Loops with complex coefficients: the questions that only real loops have an answer to refuse them here.

use super::{Free, Problem};
use crate::coverage::Asked;
use crate::error::{Diagnostics, Error};
use crate::model::RealisedBlocks;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

impl Problem {
    /// Refuses a model in which the imaginary unit is written, or a frame: what reads its text again does not know them.
    ///
    /// # Errors
    /// `E-complex`.
    pub fn refuse_written_complex(&self) -> Result<(), Error> {
        match self.is_written_complex() {
            true => Err(Asked::refused_of_complex_loops().into()),
            false => Ok(()),
        }
    }

    /// Refuses a loop with complex coefficients.
    ///
    /// Cost: for a model without imaginary unit and frames none; else the expressions are evaluated.
    ///
    /// # Errors
    /// `E-complex`; as [`Model::evaluate`](crate::model::Model::evaluate).
    pub fn refuse_complex(&self, budget: &Budget) -> Result<(), Error> {
        let is_bound = |f: &&Free| self.region().is_free() && f.name == self.region().bound_name();
        let kept: Vec<String> = self.free().iter().filter(|f| !is_bound(f)).map(|f| f.name.clone()).collect();
        self.refuse_complex_with(&kept, self.set(), budget)
    }

    /// The same with other names kept, and other values.
    fn refuse_complex_with(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<(), Error> {
        if !self.is_written_complex() || !self.model().is_complex_loop(kept, values, budget)? {
            return Ok(());
        }
        let refused = vec![Asked::refused_of_complex_loops()];
        Err(Diagnostics::new(Some(self.model().source().clone()), refused).into())
    }

    /// The blocks of a loop with real coefficients.
    ///
    /// # Errors
    /// As [`Problem::refuse_complex`] and [`Model::realised_blocks`](crate::model::Model::realised_blocks).
    pub(super) fn realised_blocks(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Option<RealisedBlocks>, Error> {
        self.refuse_complex_with(kept, values, budget)?;
        self.model().realised_blocks(kept, values, budget)
    }
}
