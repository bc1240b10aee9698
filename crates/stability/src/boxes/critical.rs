//! A cell around the worst point of a box, and trees of cells that leave it out.

use super::prove::{Cell, Closing};
use super::tensor::Tensor;
use super::tree::{Node, Tree};
use crate::subdivision::{Look, Order, Tally, subdivide};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};

/// Cells of one attempt.
pub(super) const CELLS: usize = 4000;

/// A cell of the box around its worst point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CriticalCell {
    /// The part of each parameter's side, as shares from 0 to 1; last that of the frequency axis, as `t` in
    /// `v = 4^scale t / (1 - t)`.
    pub parts: Vec<[Rational; 2]>,
}

impl CriticalCell {
    /// The part of the box.
    pub(super) fn sides(&self, whole: &[[Rational; 2]]) -> Vec<[Rational; 2]> {
        let part = |([low, high], shares): (&[Rational; 2], &[Rational; 2])| {
            shares.each_ref().map(|share| low + &(&(high - low) * share))
        };
        whole.iter().zip(&self.parts).map(part).collect()
    }
}

/// Five parts of `2^-(halvings + 2)` of the unit interval around a share.
pub(super) fn around(share: &Rational, halvings: u64) -> [Rational; 2] {
    let unit = Rational::dyadic(&Integer::ONE, halvings + 2);
    let at = share.checked_div(&unit).expect("a unit is not zero").floor();
    let edge = |k: i64| (&unit * &Rational::from(&at + &Integer::from(k))).max(Rational::ZERO).min(Rational::ONE);
    [edge(-2), edge(3)]
}

/// A tree of cells that are closed, but for those inside the critical cell; `None` where it takes too many.
pub(super) fn cover(
    tensor: Tensor,
    critical: &CriticalCell,
    closed: Closing,
    budget: &Budget,
) -> Result<Option<Tree>, Exhausted> {
    let parts = &critical.parts;
    let frequency = parts.len() - 1;
    let look = |cell: &mut Cell, tally: Tally| {
        let hint = match closed(cell, tally.looks()) {
            Ok(node) => return Ok(Look::Decided(node)),
            Err(hint) => hint,
        };
        let own: Vec<[Rational; 2]> = (0..=frequency).map(|axis| cell.part(axis)).collect();
        let beyond: Vec<usize> =
            (0..=frequency).filter(|&i| own[i][0] < parts[i][0] || own[i][1] > parts[i][1]).collect();
        if beyond.is_empty() {
            return Ok(Look::Decided(Node::Critical));
        }
        let meets = (0..=frequency).all(|i| own[i][0] < parts[i][1] && own[i][1] > parts[i][0]);
        if tally.cells() > CELLS {
            return Ok(Look::Open(()));
        }
        let axis = match hint {
            Some(axis) if !meets || beyond.contains(&axis) => Some(axis),
            _ if meets => cell.tensor.best_axis_of(&beyond),
            _ => cell.tensor.best_axis(),
        };
        Ok(axis.or_else(|| meets.then(|| beyond[0])).map_or(Look::Open(()), Look::Cut))
    };
    let steps = subdivide([Cell::whole(tensor)], Order::Depth, budget, look)?;
    Ok(steps.ok().map(|steps| Tree::of(steps, frequency)))
}
