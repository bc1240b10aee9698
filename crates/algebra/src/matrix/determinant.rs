//! Determinants.

use super::Matrix;
use crate::limits::{Budget, Exhausted, checkpoint};
use crate::poly::Domain;

/// The determinant by elimination without fractions ([Bareiss1968](crate::bibliography#bareiss1968)); 1 for size 0.
///
/// `O(n^3)` products and exact divisions of minors.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When the matrix is not square.
pub fn determinant_bareiss<R: Domain>(matrix: &Matrix<R>, budget: &Budget) -> Result<R, Exhausted> {
    assert!(matrix.is_square(), "the determinant of a square matrix");
    budget.enter(|| by_elimination(matrix))
}

fn by_elimination<R: Domain>(matrix: &Matrix<R>) -> R {
    let n = matrix.rows();
    let mut m = matrix.clone();
    let mut negative = false;
    let mut previous = R::one();
    for k in 0..n.saturating_sub(1) {
        let Some(pivot_row) = (k..n).find(|&i| !m[(i, k)].is_zero()) else { return R::zero() };
        if pivot_row != k {
            m.swap_rows(pivot_row, k);
            negative = !negative;
        }
        for i in k + 1..n {
            checkpoint(16 * (n - k) as u64);
            for j in k + 1..n {
                let mut minor = m[(k, k)].times(&m[(i, j)]);
                minor.sub_times(&m[(i, k)], &m[(k, j)]);
                m[(i, j)] = minor.div_exact(&previous).expect("Sylvester's identity");
            }
        }
        previous = m[(k, k)].clone();
    }
    let value = if n == 0 { R::one() } else { m[(n - 1, n - 1)].clone() };
    if negative { value.negated() } else { value }
}

/// The determinant by expansion along rows (Leibniz' formula): `n!` products, a reference for
/// small matrices.
///
/// # Panics
/// When the matrix is not square.
pub fn determinant_leibniz<R: Domain>(matrix: &Matrix<R>) -> R {
    assert!(matrix.is_square(), "the determinant of a square matrix");
    expand(matrix, 0, &mut (0..matrix.rows()).collect())
}

fn expand<R: Domain>(matrix: &Matrix<R>, row: usize, columns: &mut Vec<usize>) -> R {
    checkpoint(8);
    let mut sum = R::zero();
    if columns.is_empty() {
        return R::one();
    }
    for k in 0..columns.len() {
        let column = columns.remove(k);
        let minor = expand(matrix, row + 1, columns);
        columns.insert(k, column);
        if k % 2 == 0 {
            sum.add_times(&matrix[(row, column)], &minor);
        } else {
            sum.sub_times(&matrix[(row, column)], &minor);
        }
    }
    sum
}
