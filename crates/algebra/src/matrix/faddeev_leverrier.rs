//! The recursion of Faddeev and LeVerrier.

use super::Matrix;
use crate::limits::{Budget, Exhausted};
use crate::number::Integer;
use crate::poly::{Domain, Poly};

/// The characteristic polynomial of a matrix `M` of size `n`, and the adjugate of `zI - M`, as the recursion of
/// [Faddeev1949](crate::bibliography#faddeev1949) gives them.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::matrix::{Matrix, faddeev_leverrier};
/// use jurist_algebra::poly::UniPoly;
/// let m = Matrix::from_i64(&[&[2, 1], &[0, 3]]);
/// let fl = faddeev_leverrier(&m, &Budget::unlimited()).unwrap();
/// assert_eq!(fl.adjugate_entry(0, 0), UniPoly::from_i64(&[-3, 1])); // z - 3
/// assert_eq!(fl.adjugate_entry(0, 1), UniPoly::from_i64(&[1]));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FaddeevLeVerrier<R: Domain> {
    /// `det(zI - M)`, monic of degree `n`.
    pub characteristic: Poly<R>,
    /// `N_0, ..., N_(n-1)` with `adj(zI - M) = N_0 z^(n-1) + N_1 z^(n-2) + ... + N_(n-1)`, so that
    /// `(zI - M) adj(zI - M) = det(zI - M) I`. `N_0` is the identity; empty for `n = 0`.
    pub adjugate: Vec<Matrix<R>>,
}

impl<R: Domain> FaddeevLeVerrier<R> {
    /// The entry of `adj(zI - M)` in row `i`, column `j`, as a polynomial in `z`: the numerator of
    /// the transfer function from input `j` to state `i`.
    ///
    /// # Panics
    /// When there is no such entry.
    pub fn adjugate_entry(&self, i: usize, j: usize) -> Poly<R> {
        Poly::new(self.adjugate.iter().rev().map(|n| n[(i, j)].clone()).collect())
    }
}

/// The characteristic polynomial and the adjugate by the recursion
/// `N_0 = I`, `c_(n-k) = -trace(M N_(k-1)) / k`, `N_k = M N_(k-1) + c_(n-k) I`
/// ([Faddeev1949](crate::bibliography#faddeev1949), [Souriau1948](crate::bibliography#souriau1948)).
///
/// The only divisions are the exact ones by `1, ..., n`. `n` products of matrices, `O(n^4)`
/// products of entries.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::matrix::{Matrix, faddeev_leverrier};
/// use jurist_algebra::poly::UniPoly;
/// let m = Matrix::from_i64(&[&[2, 1], &[1, 2]]);
/// let fl = faddeev_leverrier(&m, &Budget::unlimited()).unwrap();
/// assert_eq!(fl.characteristic, UniPoly::from_i64(&[3, -4, 1]));
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
///
/// # Panics
/// When the matrix is not square.
pub fn faddeev_leverrier<R: Domain>(m: &Matrix<R>, budget: &Budget) -> Result<FaddeevLeVerrier<R>, Exhausted> {
    assert!(m.is_square(), "the characteristic polynomial of a square matrix");
    budget.enter(|| recursion(m))
}

fn recursion<R: Domain>(m: &Matrix<R>) -> FaddeevLeVerrier<R> {
    let n = m.rows();
    let mut coefficients = vec![R::zero(); n + 1];
    coefficients[n] = R::one();
    let mut adjugate = Vec::with_capacity(n);
    let mut current = Matrix::identity(n);
    for k in 1..=n {
        let mut next = m * &current;
        let divisor = R::from_integer(&Integer::from(k));
        let c = next.trace().negated().div_exact(&divisor).expect("the trace of M N_(k-1) is -k c_(n-k)");
        next.add_to_diagonal(&c);
        coefficients[n - k] = c;
        adjugate.push(std::mem::replace(&mut current, next));
    }
    debug_assert!(current.is_zero(), "the theorem of Cayley and Hamilton");
    FaddeevLeVerrier { characteristic: Poly::new(coefficients), adjugate }
}

/// `q^n det(zI - N/q) = det(q z I - N)`, from the characteristic polynomial of `N`: the
/// coefficient of `z^k` is multiplied by `q^k`.
pub fn characteristic_over_denominator<R: Domain>(of_numerator: &Poly<R>, q: &R) -> Poly<R> {
    of_numerator.scaled_argument(q)
}
