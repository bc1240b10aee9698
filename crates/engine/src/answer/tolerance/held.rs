//! Tolerances of loops with what is not rational, such as plants behind a hold.
//!
//! Each symbol whose arguments are fixed is one more side of the box, as wide as its enclosure: what is proved for all values in it holds for the true
//! one. A point that is not stable is counted once more with the true constants.

use crate::answer::{DelayedRoots, Verdict};
use crate::error::Error;
use crate::problem::{Ask, Problem};
use crate::stability::boxes::{
    BoxDecision, Family, LargestFactor, OpenReason, Side, ToleranceProblem, Witness, corners,
};
use crate::stability::{AtPoint, RootCount};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// Symbols are enclosed with so many bits after the point.
pub const SYMBOL_BITS: u64 = 512;

/// What the polynomial's variables beyond the free parameters are.
pub struct Truth<'a> {
    problem: &'a Arc<Problem>,
    symbols: Vec<Side>,
    is_exact: bool,
}

impl<'a> Truth<'a> {
    /// Of a loop whose verdict at a point is asked of the model itself.
    pub fn of_points(problem: &'a Arc<Problem>) -> Self {
        Truth { problem, symbols: Vec::new(), is_exact: false }
    }

    /// Encloses the symbols of a problem, none of which moves.
    ///
    /// # Errors
    /// `E-dead-time`.
    pub fn of(problem: &'a Arc<Problem>, budget: &Budget) -> Result<Self, Error> {
        let symbols = problem.algebra_over_symbols(budget)?.symbols();
        if symbols.is_empty() {
            return Ok(Truth { problem, symbols: Vec::new(), is_exact: true });
        }
        let table = problem.fixed_symbols(budget)?;
        let values = budget.enter(|| table.values(SYMBOL_BITS))?;
        let bounds: Vec<[Rational; 2]> = values.iter().map(|ball| [ball.lower(), ball.upper()]).collect();
        Ok(Truth::beside_constants(problem, &bounds))
    }

    /// Of a loop with constants between these bounds as further parameters.
    pub fn beside_constants(problem: &'a Arc<Problem>, bounds: &[[Rational; 2]]) -> Self {
        let side = |[low, high]: &[Rational; 2]| {
            let middle = low.midpoint(high);
            let widths = [&middle - low, high - &middle];
            Side::fixed(middle, widths)
        };
        Truth { problem, symbols: bounds.iter().map(side).collect(), is_exact: false }
    }

    /// Whether everything is rational.
    pub fn is_exact(&self) -> bool {
        self.is_exact
    }

    /// The sides of the parameters and those of the symbols.
    pub fn beside(&self, sides: &[Side]) -> Vec<Side> {
        sides.iter().chain(&self.symbols).cloned().collect()
    }

    /// The exact root count at a point of the parameters.
    pub fn at(&self, p: &impl Family, point: &[Rational], budget: &Budget) -> Result<AtPoint, Error> {
        // With sides for symbols the loop is another at each of their values.
        if self.symbols.is_empty()
            && let Some(at) = budget.enter(|| p.count(point))?
        {
            return Ok(at);
        }
        let problem = self.problem;
        let time = problem.algebra_over_symbols(budget)?.sample_time();
        if let Some(time) = time.filter(|time| time.variables().iter().all(|v| *v < point.len())) {
            // No loop has a sample time that is not positive.
            let value = time.numerator().eval(point).checked_div(&time.denominator().eval(point));
            if value.is_none_or(|value| !value.sign().is_gt()) {
                return Ok(AtPoint::Undefined);
            }
        }
        let names = problem.free().iter().map(|free| free.name.clone());
        let question = problem.model().ask().within(problem.region().clone()).set_all(problem.set().to_vec());
        let verdict = match question.set_all(names.zip(point.iter().cloned())).verdict(budget) {
            Err(Error::Undefined(_)) => return Ok(AtPoint::Undefined),
            verdict => verdict?.into_value(),
        };
        // As of the polynomial, which of a complex loop has the conjugate roots as well.
        let n = if problem.algebra_over_symbols(budget)?.is_complex() { 2 } else { 1 };
        if let Some(DelayedRoots { on, right }) = verdict.delayed {
            return Ok(AtPoint::Delayed { on: n * on, right: right.map(|right| n * right) });
        }
        Ok(match (verdict.verdict, verdict.count) {
            (Verdict::Undefined, _) | (_, None) => AtPoint::Undefined,
            (_, Some(RootCount { inside, on, outside })) => {
                let count = RootCount { inside: n * inside, on: n * on, outside: n * outside };
                AtPoint::Defined { count, infinite: n * verdict.infinite }
            }
        })
    }

    /// A point that is not stable with the true constants.
    pub fn confirmed(&self, p: &impl Family, witness: Witness, budget: &Budget) -> Result<Option<Witness>, Error> {
        if self.is_exact {
            return Ok(Some(witness));
        }
        let mut point = witness.point;
        point.truncate(self.problem.free().len());
        let at = match self.at(p, &point, budget) {
            Err(Error::Refused(_)) => return Ok(None),
            at => at?,
        };
        let degree = self.problem.algebra_over_symbols(budget)?.formal_degree();
        Ok((!at.is_stable(degree)).then(|| Witness::new(point, at)))
    }

    /// The decision with the true constants, for the parameters alone.
    pub fn decision(&self, p: &impl Family, found: BoxDecision, budget: &Budget) -> Result<BoxDecision, Error> {
        if self.is_exact {
            return Ok(found);
        }
        let close = || BoxDecision::Undecided { why: OpenReason::Constants, cell: Vec::new() };
        Ok(match found {
            BoxDecision::NotStable { witness: Some(witness) } => match self.confirmed(p, witness, budget)? {
                Some(witness) => BoxDecision::NotStable { witness: Some(witness) },
                None => close(),
            },
            BoxDecision::NotStable { witness: None } => close(),
            BoxDecision::Undecided { why, mut cell } => {
                cell.truncate(self.problem.free().len());
                match self.corner_of(p, &cell, budget)? {
                    Some(witness) => BoxDecision::NotStable { witness: Some(witness) },
                    None => BoxDecision::Undecided { why, cell },
                }
            }
            stable => stable,
        })
    }

    /// A corner of a cell of a loop with dead time that is not stable: roots that are on the axis there are told by the verdict alone.
    fn corner_of(&self, p: &impl Family, cell: &[[Rational; 2]], budget: &Budget) -> Result<Option<Witness>, Error> {
        let has_dead_time = !self.problem.algebra_over_symbols(budget)?.symbols().delays().is_empty();
        for point in corners(cell).filter(|_| has_dead_time) {
            if let Some(found) = self.confirmed(p, Witness::uncounted(point), budget)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// The bracket with the true constants, for the parameters alone.
    pub fn factor<F: Family>(
        &self,
        boxes: &ToleranceProblem<'_, F>,
        p: &F,
        mut found: LargestFactor,
        budget: &Budget,
    ) -> Result<LargestFactor, Error> {
        if self.is_exact {
            return Ok(found);
        }
        let free = self.problem.free().len();
        let confirmed = |witness: Witness| match self.confirmed(p, witness, budget) {
            Err(Error::Stopped(_)) => Ok(None),
            confirmed => confirmed,
        };
        let mut witness = found.witness.take().map(confirmed).transpose()?.flatten();
        // With a constant in the middle of its enclosure a root may be on the boundary: one just beyond is told.
        if witness.is_none()
            && !self.symbols.is_empty()
            && let Some((factor, point)) = boxes.just_beyond(&found)
        {
            witness = confirmed(Witness::uncounted(point))?;
            found.upper = Some(factor);
        }
        if witness.is_none() {
            (found.upper, found.direction, found.shares) = (None, None, None);
        }
        found.witness = witness;
        found.direction.iter_mut().chain(&mut found.shares).for_each(|values| values.truncate(free));
        if let Some((_, cell)) = &mut found.open {
            cell.truncate(free);
        }
        Ok(found)
    }
}
