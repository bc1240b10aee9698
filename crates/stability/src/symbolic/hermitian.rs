//! The conditions of a loop with complex coefficients over symbols.

use super::basis::Way;
use super::conditions::{MOST_EXPANDED, solved};
use super::jury::Comparison;
use super::minors::Minor;
use super::rows::{enclosed_quotient, shown};
use super::statements::{Conditions, Rule, Stated};
use super::{EnclosedTable, SymbolicCondition, SymbolicPolynomial, SymbolicTest, Table};
use crate::Range;
use crate::hermitian::minor_name;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{Domain, MultiPoly};

impl SymbolicPolynomial {
    /// The conditions of a loop with complex coefficients: the leading principal minors of its Hermitian matrix are positive. This polynomial has the
    /// loop's roots and their conjugates. The coefficients have been multiplied by `below`.
    ///
    /// Cost: as [`SymbolicPolynomial::classical_test`], with minors that are expanded.
    ///
    /// # Errors
    /// As [`SymbolicPolynomial::classical_test`].
    ///
    /// # Panics
    /// When symbols depend on the parameter.
    pub fn hermitian_test(
        &self,
        minors: &[MultiPoly],
        below: &MultiPoly,
        range: &Range,
        digits: usize,
        budget: &Budget,
    ) -> Result<SymbolicTest, Exhausted> {
        let Table::Fixed(symbols) = &self.symbols else { panic!("symbols depend on the parameter") };
        budget.step("the conditions");
        let rule = |k: usize| Rule { product: vec![k], is_negative: false, other_than_zero: Vec::new() };
        let stated =
            |k: usize| Stated { name: minor_name(k), row: None, comparison: Comparison::Greater, rule: rule(k) };
        let conditions = Conditions {
            functions: minors.iter().cloned().map(Minor::of).collect(),
            stated: (0..minors.len()).map(stated).collect(),
            is_plain: true,
            ..Conditions::default()
        };
        let ((solutions, intersection), _) =
            Way::in_order(symbols, MOST_EXPANDED, |way| solved(self, &conditions, symbols, range, way, budget))?;
        budget.step("the table");
        let is_number = below.degree_in(0) == 0;
        let square = if is_number { below.times(below) } else { MultiPoly::one() };
        let mut scale = MultiPoly::one();
        let mut out = Vec::with_capacity(minors.len());
        for ((stated, solution), minor) in conditions.stated.iter().zip(solutions).zip(minors) {
            scale = scale.times(&square);
            out.push(SymbolicCondition {
                name: stated.name.clone(),
                comparison: stated.comparison,
                left: shown(&enclosed_quotient(minor, &scale, symbols, digits, budget)?, digits),
                right: Vec::new(),
                row: None,
                solution,
            });
        }
        let cleared = |below: &MultiPoly| enclosed_quotient(below, &MultiPoly::one(), symbols, digits, budget);
        let cleared_by = (!is_number).then(|| cleared(below)).transpose()?;
        Ok(SymbolicTest {
            order: minors.len(),
            rows: Vec::new(),
            cleared_by: cleared_by.map(|p| shown(&p, digits)),
            conditions: out,
            intersection,
        })
    }

    /// The conditions of a loop with complex coefficients at a point, as [`SymbolicPolynomial::hermitian_test`]; `None` where the loop is undefined, or its
    /// degree lost.
    ///
    /// Cost: that of [`SymbolicPolynomial::hermitian_test`].
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn hermitian_conditions(
        &self,
        minors: &[MultiPoly],
        below: &MultiPoly,
        digits: usize,
        budget: &Budget,
    ) -> Result<Option<EnclosedTable>, Exhausted> {
        if self.is_undefined_without_parameter(budget)? {
            return Ok(None);
        }
        Ok(Some(self.hermitian_test(minors, below, &Range::all(), digits, budget)?.into()))
    }
}
