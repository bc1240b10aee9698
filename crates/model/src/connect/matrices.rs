//! Matrices of rational functions, whose work is counted.

use crate::evaluate::work::count_work;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::poly::RationalFunction;

/// `M^-1 R` and `det M` by elimination over the field of rational functions; `None` when `M` is
/// singular. Zero entries cost nothing, so a sparse diagram stays cheap.
pub(crate) fn solve(
    m: &RationalMatrix,
    right: &RationalMatrix,
    budget: &Budget,
) -> Result<Option<(RationalMatrix, RationalFunction)>, Exhausted> {
    let n = m.rows();
    let columns = right.columns();
    let mut rows: Vec<Vec<RationalFunction>> = (0..n)
        .map(|i| (0..n).map(|j| m[(i, j)].clone()).chain((0..columns).map(|j| right[(i, j)].clone())).collect())
        .collect();
    let mut determinant = RationalFunction::one();
    for k in 0..n {
        budget.check()?;
        // The simplest pivot keeps the entries small.
        let size = |f: &RationalFunction| f.numerator().terms().len() + f.denominator().terms().len();
        let candidates = (k..n).filter(|&i| !rows[i][k].is_zero());
        let Some(pivot) = candidates.min_by_key(|&i| size(&rows[i][k])) else { return Ok(None) };
        if pivot != k {
            rows.swap(pivot, k);
            determinant = -determinant;
        }
        determinant = &determinant * &rows[k][k];
        let Some(inverse) = rows[k][k].recip() else { return Ok(None) };
        if !inverse.is_one() {
            for f in rows[k].iter_mut().filter(|f| !f.is_zero()) {
                count_work(f, &inverse);
                *f = &*f * &inverse;
            }
        }
        let pivot_row = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            if row[k].is_zero() {
                continue;
            }
            let factor = row[k].clone();
            assert!(i != k);
            for (f, p) in row.iter_mut().zip(&pivot_row).filter(|(_, p)| !p.is_zero()) {
                count_work(&factor, p);
                *f = &*f - &(&factor * p);
            }
        }
    }
    let solution = RationalMatrix::from_fn(n, columns, |i, j| rows[i][n + j].clone());
    Ok(Some((solution, determinant)))
}

/// `left * right`, whose work is counted.
pub(crate) fn product(left: &RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    for (i, k) in (0..left.rows()).flat_map(|i| (0..left.columns()).map(move |k| (i, k))) {
        let a = &left[(i, k)];
        if !a.is_zero() {
            (0..right.columns()).map(|j| &right[(k, j)]).filter(|b| !b.is_zero()).for_each(|b| count_work(a, b));
        }
    }
    left * right
}

pub(super) fn block_diagonal(parts: &[&RationalMatrix]) -> RationalMatrix {
    let rows = parts.iter().map(|m| m.rows()).sum();
    let columns = parts.iter().map(|m| m.columns()).sum();
    let mut out = RationalMatrix::zeros(rows, columns);
    let (mut top, mut left) = (0, 0);
    for m in parts {
        for i in 0..m.rows() {
            for j in 0..m.columns() {
                out[(top + i, left + j)] = m[(i, j)].clone();
            }
        }
        top += m.rows();
        left += m.columns();
    }
    out
}

/// `[left right]`.
pub(super) fn beside(left: &RationalMatrix, right: &RationalMatrix) -> RationalMatrix {
    RationalMatrix::from_fn(left.rows(), left.columns() + right.columns(), |i, j| {
        if j < left.columns() { left[(i, j)].clone() } else { right[(i, j - left.columns())].clone() }
    })
}
