//! Isolation by Descartes' rule and bisection (Collins and Akritas), in exact integers.

use crate::limits::checkpoint;
use crate::number::{Integer, Sign};
use crate::poly::UniPoly;

/// The open interval `(at / 2^depth, (at + 1) / 2^depth)` times the power of two that the search
/// was scaled by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    pub at: Integer,
    pub depth: u64,
}

struct Node {
    coeffs: Vec<Integer>,
    at: Integer,
    depth: u64,
}

/// Cells with exactly one root each, ascending, of the roots in `(0, 1)` of a square-free
/// polynomial without rational roots; `wanted` may refuse cells that need no search.
///
/// [CollinsAkritas1976](crate::bibliography#collinsakritas1976): a cell without sign variation (after the map of `(0, 1)` to the positive
/// axis) holds no root, with one exactly one; others are halved. Since no end can be a root, the
/// cells' ends have opposite signs.
pub(super) fn cells_by_bisection(p: &UniPoly, wanted: &dyn Fn(&Integer, u64) -> bool) -> Vec<Cell> {
    let mut found = Vec::new();
    let mut stack = Vec::new();
    visit(p.coeffs().to_vec(), Integer::ZERO, 0, wanted, &mut found, &mut stack);
    while let Some(node) = stack.pop() {
        let left = halved(node.coeffs);
        let right = shifted_by_one(left.clone());
        let (at, depth) = (&node.at << 1, node.depth + 1);
        let mut pending = Vec::new();
        visit(left, at.clone(), depth, wanted, &mut found, &mut pending);
        visit(right, at + Integer::ONE, depth, wanted, &mut found, &mut pending);
        stack.append(&mut pending);
    }
    found.sort_by(compare_cells);
    found
}

/// Disjoint cells, compared by their left ends.
fn compare_cells(a: &Cell, b: &Cell) -> Sign {
    let depth = a.depth.max(b.depth);
    (&a.at << (depth - a.depth)).cmp(&(&b.at << (depth - b.depth)))
}

/// Settles a cell or leaves it to be halved.
fn visit(
    coeffs: Vec<Integer>,
    at: Integer,
    depth: u64,
    wanted: &dyn Fn(&Integer, u64) -> bool,
    found: &mut Vec<Cell>,
    pending: &mut Vec<Node>,
) {
    if !wanted(&at, depth) {
        return;
    }
    match variations_on_unit_interval(&coeffs) {
        0 => {}
        1 => found.push(Cell { at, depth }),
        _ => pending.push(Node { coeffs, at, depth }),
    }
}

/// The sign variations of `(1 + x)^n p(1 / (1 + x))`, at most 2: the count stops there.
fn variations_on_unit_interval(coeffs: &[Integer]) -> usize {
    let mut c: Vec<Integer> = coeffs.iter().rev().cloned().collect();
    let n = c.len();
    let mut last = Sign::Equal;
    let mut count = 0;
    for i in 0..n {
        checkpoint(4 * (n - i) as u64);
        // If all that is left has one sign, so have all coefficients still to come.
        if let Some(sign) = common_sign(&c[i..]) {
            let change = sign.is_ne() && last.is_ne() && sign != last;
            return (count + usize::from(change)).min(2);
        }
        for j in (i..n - 1).rev() {
            let (low, high) = c.split_at_mut(j + 1);
            low[j] += &high[0];
        }
        let sign = c[i].sign();
        if sign.is_ne() {
            count += usize::from(last.is_ne() && last != sign);
            last = sign;
            if count == 2 {
                return 2;
            }
        }
    }
    count
}

/// The sign of all non-zero members, if they share one (`Equal` if all are zero).
fn common_sign(c: &[Integer]) -> Option<Sign> {
    let mut common = Sign::Equal;
    for sign in c.iter().map(Integer::sign).filter(|s| s.is_ne()) {
        if common.is_ne() && common != sign {
            return None;
        }
        common = sign;
    }
    Some(common)
}

/// `2^n p(x / 2)`, divided by the greatest power of two in its content.
fn halved(mut coeffs: Vec<Integer>) -> Vec<Integer> {
    let n = coeffs.len() - 1;
    let zeros = |(i, c): (usize, &Integer)| c.trailing_zeros().map(|z| z + (n - i) as u64);
    let common = coeffs.iter().enumerate().filter_map(zeros).min().unwrap_or(0);
    for (i, c) in coeffs.iter_mut().enumerate() {
        let up = (n - i) as u64;
        *c = if up >= common { &*c << (up - common) } else { &*c >> (common - up) };
    }
    coeffs
}

/// `p(x + 1)`.
fn shifted_by_one(mut c: Vec<Integer>) -> Vec<Integer> {
    let n = c.len();
    for i in 0..n {
        checkpoint(4 * (n - i) as u64);
        for j in (i..n - 1).rev() {
            let (low, high) = c.split_at_mut(j + 1);
            low[j] += &high[0];
        }
    }
    c
}
