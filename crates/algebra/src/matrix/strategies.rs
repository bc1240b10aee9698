//! Random matrices, some with eigenvalues known by construction, for property tests.

use super::Matrix;
use crate::number::Integer;
use crate::poly::{Domain, MultiPoly, Poly};
use proptest::prelude::*;

/// A square matrix of size `0..=max_size` with entries in `-bound..=bound`, one in three zero.
pub fn integer_matrix(max_size: usize, bound: i64) -> impl Strategy<Value = Matrix<Integer>> {
    (0..=max_size).prop_flat_map(move |n| integer_matrix_of_size(n, bound))
}

/// A square matrix of size `n` with entries in `-bound..=bound`, one in three zero.
pub fn integer_matrix_of_size(n: usize, bound: i64) -> impl Strategy<Value = Matrix<Integer>> {
    let entry = prop_oneof![1 => Just(0), 2 => -bound..=bound];
    prop::collection::vec(entry, n * n).prop_map(move |v| Matrix::from_fn(n, n, |i, j| Integer::from(v[i * n + j])))
}

/// A square matrix of size `n` whose entries are polynomials in variables `0..variables`.
pub fn polynomial_matrix(
    n: usize,
    variables: usize,
    max_exponent: u32,
    max_terms: usize,
) -> impl Strategy<Value = Matrix<MultiPoly>> {
    let entry = crate::poly::multivariate::strategies::multi_poly(variables, max_exponent, max_terms);
    prop::collection::vec(entry, n * n).prop_map(move |v| Matrix::from_fn(n, n, |i, j| v[i * n + j].clone()))
}

/// An integer matrix of determinant 1 and its inverse: products of additions of one row to another.
pub fn unimodular(n: usize) -> impl Strategy<Value = (Matrix<Integer>, Matrix<Integer>)> {
    let step = (0..n.max(1), 0..n.max(1), -2i64..=2);
    prop::collection::vec(step, 0..=2 * n).prop_map(move |steps| {
        let mut matrix = Matrix::identity(n);
        let mut inverse = Matrix::identity(n);
        for (i, j, c) in steps {
            if i == j || n == 0 {
                continue;
            }
            let elementary = |c: i64| {
                let mut e = Matrix::identity(n);
                e[(i, j)] = Integer::from(c);
                e
            };
            matrix = &elementary(c) * &matrix;
            inverse = &inverse * &elementary(-c);
        }
        (matrix, inverse)
    })
}

/// A dense-looking matrix together with its eigenvalues: a triangular matrix with small random
/// entries above the given diagonal, conjugated by a [`unimodular`] one.
pub fn with_eigenvalues<R: Domain>(eigenvalues: Vec<R>) -> impl Strategy<Value = (Matrix<R>, Vec<R>)> {
    let n = eigenvalues.len();
    (unimodular(n), prop::collection::vec(-3i64..=3, n * n)).prop_map(move |((u, inverse), above)| {
        let triangular = Matrix::from_fn(n, n, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => R::from_integer(&Integer::from(above[i * n + j])),
            std::cmp::Ordering::Equal => eigenvalues[i].clone(),
            std::cmp::Ordering::Greater => R::zero(),
        });
        let (u, inverse) = (u.map(R::from_integer), inverse.map(R::from_integer));
        (&(&u * &triangular) * &inverse, eigenvalues.clone())
    })
}

/// The monic polynomial with these roots.
pub fn from_roots<R: Domain>(roots: &[R]) -> Poly<R> {
    roots.iter().fold(Poly::one(), |p, r| p.times(&Poly::new(vec![r.negated(), R::one()])))
}
