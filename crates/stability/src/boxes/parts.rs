//! Parts of a box in which functions are polynomials up to a bound, and the cells that prove them.

use super::polynomial::Bundle;
use super::prove::{Cell, Closing};
use super::separate::separating_vector;
use super::tensor::Tensor;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use std::collections::BTreeMap;

/// A polynomial in the coordinates of a part, up to a bound.
pub(super) struct Known {
    /// By exponents.
    pub terms: BTreeMap<Vec<u32>, Integer>,
    /// How far it may be off anywhere in the part.
    pub slack: Integer,
}

/// A term in the coordinates of a part.
pub(super) struct Term {
    pub exponents: Vec<u32>,
    pub coefficient: Integer,
    /// A bound of the term in the part.
    pub size: Integer,
}

/// Polynomials without the terms that are so much smaller than the greatest that their tensors, which have so many coefficients for each
/// multi-index, are not too large: what is left out is in the bounds. Terms of the first degree in what is inside of functions stay.
pub(super) fn pruned(
    sized: Vec<Vec<Term>>,
    slacks: Vec<Integer>,
    inside: &[usize],
    beside: usize,
    (most, kept_bits): (usize, &[u64]),
) -> Vec<Known> {
    let largest = |own: &[Term]| own.iter().map(|term| &term.size).max().cloned().unwrap_or(Integer::ZERO);
    let stays =
        |term: &Term, least: &Integer| inside.iter().map(|&i| term.exponents[i]).sum::<u32>() < 2 || term.size > *least;
    let fits = |bits: &u64| {
        let mut degrees: Vec<u32> = Vec::new();
        for own in &sized {
            let least = &largest(own) >> *bits;
            for term in own.iter().filter(|term| stays(term, &least)) {
                degrees.resize(term.exponents.len(), 0);
                degrees.iter_mut().zip(&term.exponents).for_each(|(d, e)| *d = (*d).max(*e));
            }
        }
        let terms = degrees.iter().try_fold(beside, |n, &d| n.checked_mul(d as usize + 1));
        terms.is_some_and(|n| n <= most)
    };
    let bits = kept_bits.iter().copied().find(fits).unwrap_or(kept_bits[kept_bits.len() - 1]);
    let one = |(own, slack): (Vec<Term>, Integer)| {
        let least = &largest(&own) >> bits;
        let mut known = Known { terms: BTreeMap::new(), slack };
        for term in own {
            if stays(&term, &least) {
                known.terms.insert(term.exponents, term.coefficient);
            } else {
                known.slack += &term.size;
            }
        }
        known
    };
    sized.into_iter().zip(slacks).map(one).collect()
}

/// The number of cells, of at most so many, that show that a pair has no zero; else the cell in which that is not seen.
pub(super) fn closed(
    tensor: Tensor,
    closing: Closing,
    most: usize,
    budget: &Budget,
) -> Result<Result<usize, Cell>, Exhausted> {
    let mut stack = vec![Cell::whole(tensor)];
    let (mut nodes, mut leaves) = (0, 0);
    while let Some(cell) = stack.pop() {
        budget.check()?;
        nodes += 1;
        let hint = match closing(&cell, nodes) {
            Ok(_) => {
                leaves += 1;
                continue;
            }
            Err(hint) => hint,
        };
        let axis = hint.or_else(|| cell.tensor.best_axis());
        let axis = axis.filter(|_| nodes + stack.len() < most && !is_blurred(&cell) && !is_clear_but_for_slack(&cell));
        let Some(axis) = axis else { return Ok(Err(cell)) };
        let [low, high] = cell.halves(axis);
        stack.extend([high, low]);
    }
    Ok(Ok(leaves))
}

/// Whether the values of a cell vary no more than they are off: halving it does not help.
pub(super) fn is_blurred(cell: &Cell) -> bool {
    let off = |plane: usize| cell.tensor.slack.get(plane).and_then(|s| s.iter().max()).map_or(0, |s| 4 * s);
    (0..cell.tensor.planes.len()).all(|plane| {
        let (low, high) = cell.tensor.range(plane);
        high - low <= off(plane)
    })
}

/// Whether the coefficients themselves prove a pair's cell, and only not what they are off by.
fn is_clear_but_for_slack(cell: &Cell) -> bool {
    let [x, y] = cell.tensor.planes.as_slice() else { return false };
    separating_vector(x, y, cell.tensor.error).is_some()
}

/// The polynomials without their bounds.
pub(super) fn bundle(list: &[Known], parameters: usize) -> Bundle {
    let mut terms: BTreeMap<&Vec<u32>, Vec<Integer>> = BTreeMap::new();
    let mut degrees = vec![0; parameters];
    for (k, f) in list.iter().enumerate() {
        for (exponents, c) in &f.terms {
            degrees.iter_mut().zip(exponents).for_each(|(d, &e)| *d = (*d).max(e as usize));
            terms.entry(exponents).or_insert_with(|| vec![Integer::ZERO; list.len()])[k] = c.clone();
        }
    }
    let terms = terms.into_iter().map(|(exponents, c)| (exponents.clone(), c)).collect();
    Bundle { width: list.len(), degrees, terms }
}

/// How wide a side is for its distance from zero.
pub(super) fn extent([low, high]: &[Rational; 2]) -> Rational {
    let size = low.abs().max(high.abs());
    (high - low).checked_div(&size).unwrap_or(Rational::ZERO)
}

pub(super) fn middle(sides: &[[Rational; 2]]) -> Vec<Rational> {
    sides.iter().map(|[low, high]| low.midpoint(high)).collect()
}

/// The corners of a box, not too many.
pub fn corners(sides: &[[Rational; 2]]) -> impl Iterator<Item = Vec<Rational>> + '_ {
    let wide: Vec<usize> = (0..sides.len()).filter(|&i| sides[i][0] < sides[i][1]).take(6).collect();
    (0..1usize << wide.len()).map(move |mask| {
        let upper = |i: usize| wide.iter().position(|w| *w == i).is_some_and(|bit| mask >> bit & 1 == 1);
        sides.iter().enumerate().map(|(i, side)| side[usize::from(upper(i))].clone()).collect()
    })
}
