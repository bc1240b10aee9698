//! The parts of a loop that do not act on each other both ways: each has its own characteristic polynomial.

use super::evaluation::{Algebra, in_region};
use super::resolved::Problem;
use crate::error::Error;
use crate::stability::SymbolicPolynomial;
use jurist_algebra::limits::Budget;

impl Problem {
    /// The polynomial over the constants of the model as that of the loop's parts, whose roots together are those of the whole: those
    /// of the diagonal blocks that the closed-loop matrix has where it is block triangular, and their factors as far as these show.
    ///
    /// Cost: a characteristic polynomial for each part, and of factors that of [`SymbolicPolynomial`]'s own.
    ///
    /// # Errors
    /// As [`Problem::symbolic`].
    pub(crate) fn in_parts(
        &self,
        whole: &SymbolicPolynomial,
        algebra: &Algebra,
        budget: &Budget,
    ) -> Result<Vec<SymbolicPolynomial>, Error> {
        let closed_loop =
            algebra.state_space().filter(|own| !self.region().is_free() && own.is_complex == algebra.is_complex());
        let Some((closed_loop, d)) = closed_loop.zip(algebra.polynomial()) else { return Ok(whole.split(budget)?) };
        let blocks = closed_loop.a.decoupled_parts();
        if blocks.len() < 2 {
            return Ok(whole.split(budget)?);
        }
        budget.step("parts of the loop");
        let mut parts = Vec::with_capacity(blocks.len());
        for block in &blocks {
            let matrix = closed_loop.a.principal(block);
            let own = matrix.characteristic_polynomial(d.variables.clone(), budget)?;
            parts.push(in_region(own, self.region(), None));
        }
        Ok(whole.in_parts(&parts, self.free().len(), budget)?)
    }
}
