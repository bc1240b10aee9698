//! Looking things up in a finished decomposition.

use super::decompose::{Branch, StabilityMap, branches_at, locate};
use crate::interval_set::real_cells;
use crate::{Range, RealInterval};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::real::Real;

impl StabilityMap {
    /// Whether the coefficients of the curves contain symbols.
    pub fn has_symbols(&self) -> bool {
        self.curves.iter().any(|c| c.polynomial.variables().iter().any(|&i| i > 1))
    }

    /// The polynomial of a curve with integer coefficients, for pictures: as it is, or, where its coefficients contain symbols, times
    /// `2^bits` and rounded.
    pub fn rounded_curve(&self, number: usize, bits: u64) -> MultiPoly {
        self.ground.rounded(&self.curves[number].polynomial, bits)
    }

    /// The numbers of the strip and the cell that hold a point of the domain; `None` outside, on a
    /// boundary curve, on a wall between strips, and where there are no strips.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn locate(
        &self,
        x: &Rational,
        y: &Rational,
        y_domain: &Range,
        budget: &Budget,
    ) -> Result<Option<(usize, usize)>, Exhausted> {
        if !y_domain.contains(y) {
            return Ok(None);
        }
        locate(&*self.ground, &self.curves, &self.strips, [x, y], y_domain, budget)
    }

    /// The branches of all curves over a rational `x`, from below, with their values in the domain of `y`. Inside
    /// a strip branch `k` is between its cells `k` and `k + 1`.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn branches(&self, x: &Rational, y_domain: &Range, budget: &Budget) -> Result<Vec<(Real, Branch)>, Exhausted> {
        branches_at(&*self.ground, &self.curves, x, y_domain, budget)
    }

    /// The open intervals of `y` that are stable at a rational `x`, cut at every boundary curve; `None`
    /// outside the domain and on a wall between strips.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn slice(
        &self,
        x: &Rational,
        y_domain: &Range,
        budget: &Budget,
    ) -> Result<Option<Vec<RealInterval>>, Exhausted> {
        let Some(strip) = self.strips.iter().find(|s| s.x.contains(x)) else { return Ok(None) };
        let values: Vec<Real> = self.branches(x, y_domain, budget)?.into_iter().map(|b| b.0).collect();
        let intervals = real_cells(y_domain, &values).into_iter().zip(&strip.cells).filter(|(_, cell)| cell.stable);
        Ok(Some(intervals.map(|(interval, _)| interval).collect()))
    }
}
