//! Parts of a box in which functions are polynomials up to a bound, and the cells that prove them.

use super::polynomial::Bundle;
use super::prove::{Cell, Closing};
use super::separate::separating_vector;
use super::tensor::Tensor;
use crate::subdivision::{Look, Order, Tally, decided, subdivide};
use jurist_algebra::ball::{Ball, MultiTaylorModel};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

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

/// The coordinates of a part in what is inside of functions, from -1 to 1, as Taylor models of so many bits and of this degree.
pub(super) fn coordinates(part: &[[Rational; 2]], inside: &[usize], bits: u64, degree: usize) -> Vec<MultiTaylorModel> {
    let line = |&i: &usize| {
        let [low, high] = &part[i];
        let middle = low.midpoint(high);
        (Ball::from_rational(&middle, bits), Ball::from_rational(&(high - &middle), bits))
    };
    MultiTaylorModel::linear(&inside.iter().map(line).collect::<Vec<_>>(), degree)
}

/// The greatest degree of these of which a Taylor model in so many variables has at most so many coefficients.
pub(super) fn model_degree(variables: usize, degrees: RangeInclusive<usize>, most: usize) -> usize {
    let terms = |degree: usize| (1..=variables).fold(1, |n, i| n * (degree + i) / i);
    let least = *degrees.start();
    degrees.rev().find(|&degree| terms(degree) <= most).unwrap_or(least)
}

/// Adds the terms of a Taylor model in what is inside of functions, times a product of other parameters: a bound of all that the model leaves
/// out.
pub(super) fn add_terms(
    own: &mut Vec<Term>,
    (model, beside): (&MultiTaylorModel, &[u32]),
    inside: &[usize],
    part: &[[Rational; 2]],
) -> Integer {
    let powers = beside.iter().zip(part).filter(|(e, _)| **e > 0);
    let bound = powers.fold(Rational::ONE, |product, (&e, [low, high])| {
        &product * &low.abs().max(high.abs()).pow(i64::from(e)).expect("a positive exponent")
    });
    let size = |c: &Integer| (&Rational::from(c.abs()) * &bound).ceil();
    for (exponents, c) in model.terms().filter(|(_, c)| !c.is_zero()) {
        let mut all = beside.to_vec();
        all.resize(part.len(), 0);
        inside.iter().zip(exponents).for_each(|(&i, &e)| all[i] = e);
        own.push(Term { exponents: all, coefficient: c.clone(), size: size(c) });
    }
    size(model.rest_units())
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

/// A part of a box in coordinates of its own: those of what is inside of functions go from -1 to 1.
pub(super) struct Local<'p> {
    part: &'p [[Rational; 2]],
    inside: &'p [usize],
    /// The sides of the part in these coordinates.
    pub sides: Vec<[Rational; 2]>,
}

impl<'p> Local<'p> {
    pub fn new(part: &'p [[Rational; 2]], inside: &'p [usize]) -> Self {
        let mut sides = part.to_vec();
        for &i in inside {
            sides[i] = [-Rational::ONE, Rational::ONE];
        }
        Local { part, inside, sides }
    }

    /// The number of cells, of at most so many, that prove the part; else the sides of the cell in which that is not seen.
    pub fn closed(
        &self,
        tensor: Tensor,
        (closing, most): (Closing, usize),
        budget: &Budget,
    ) -> Result<Result<usize, Vec<[Rational; 2]>>, Exhausted> {
        let look = |cell: &mut Cell, tally: Tally| {
            let hint = match closing(cell, tally.looks() + 1) {
                Ok(_) => return Ok(Look::Decided(())),
                Err(hint) => hint,
            };
            let axis = hint.or_else(|| cell.tensor.best_axis());
            let helps = tally.cells() + 1 < most && !is_blurred(cell) && !is_clear_but_for_slack(cell);
            Ok(axis.filter(|_| helps).map_or_else(|| Look::Open(self.back(cell)), Look::Cut))
        };
        let steps = subdivide([Cell::whole(tensor)], Order::Depth, budget, look)?;
        Ok(steps.map(|steps| decided(steps).count()))
    }

    /// The sides of a cell of the part.
    fn back(&self, cell: &Cell) -> Vec<[Rational; 2]> {
        let mut out = cell.sides(&self.sides);
        for &i in self.inside {
            let [low, high] = &self.part[i];
            let half = Rational::dyadic(&Integer::ONE, 1);
            out[i] = out[i].each_ref().map(|u| low + &(&(&(high - low) * &half) * &(u + &Rational::ONE)));
        }
        out
    }
}

/// Whether the values of a cell vary no more than they are off: halving it does not help.
fn is_blurred(cell: &Cell) -> bool {
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
