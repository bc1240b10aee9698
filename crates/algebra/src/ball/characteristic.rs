//! The characteristic polynomial of a matrix of balls, or of functions.

use super::{Ball, BallMatrix, Enclosed};
use crate::limits::checkpoint;
use crate::number::Integer;

impl BallMatrix {
    /// Enclosures of the coefficients of `det(zI - M)` from the constant term up, for every matrix `M` in this one; `bits` are those of
    /// the entries.
    ///
    /// By the recursion of Faddeev and LeVerrier ([Faddeev1949](crate::bibliography#faddeev1949)): it divides by integers only, so that
    /// no pivot has to be told from zero.
    ///
    /// ```
    /// use jurist_algebra::ball::{Ball, BallMatrix};
    /// // [2 1; 0 3]: z^2 - 5 z + 6
    /// let entry = |i: usize, j: usize| Ball::from_integer(&[[2, 1], [0, 3]][i][j].into(), 64);
    /// let p = BallMatrix::from_fn(2, entry).characteristic_polynomial(64);
    /// assert!(p[0].contains(&6.into()) && p[1].contains(&(-5).into()) && p[2].contains(&1.into()));
    /// ```
    ///
    /// Cost: `n` products of matrices; an entry that is zero for certain costs nothing.
    pub fn characteristic_polynomial(&self, bits: u64) -> Vec<Ball> {
        let n = self.size();
        let mut coefficients = vec![Ball::zero(bits); n + 1];
        coefficients[n] = Ball::from_integer(&Integer::ONE, bits);
        // N_0 = I, c_(n-k) = -trace(M N_(k-1))/k, N_k = M N_(k-1) + c_(n-k) I.
        let mut current =
            BallMatrix::from_fn(n, |i, j| if i == j { coefficients[n].clone() } else { Ball::zero(bits) });
        for k in 1..=n {
            checkpoint((n * n) as u64);
            let next = self.mul(&current);
            let trace = (0..n).fold(Ball::zero(bits), |sum, i| sum.add(next.at(i, i)));
            let c = trace.neg().divided_by(k as u64);
            current = BallMatrix::from_fn(n, |i, j| if i == j { next.at(i, j).add(&c) } else { next.at(i, j).clone() });
            coefficients[n - k] = c;
        }
        coefficients
    }
}

/// The characteristic polynomial of a matrix of `n` rows, given row by row, from the constant term up, without the leading 1: by the traces of no
/// inverse, from one leading principal part of the matrix to the next ([Berkowitz1984](crate::bibliography#berkowitz1984)). Nothing is divided by.
///
/// Cost: `n^4/4` products; entries that are zero cost nothing.
///
/// ```
/// use jurist_algebra::ball::{Ball, characteristic_polynomial};
/// let entries = [1, 2, 3, 4].map(|k: i64| Ball::from_integer(&k.into(), 64));
/// let p = characteristic_polynomial(2, &entries); // z^2 - 5 z - 2
/// assert!(p[0].contains(&(-2).into()) && p[1].contains(&(-5).into()));
/// ```
pub fn characteristic_polynomial<S: Enclosed>(n: usize, matrix: &[S]) -> Vec<S> {
    let at = |i: usize, j: usize| &matrix[i * n + j];
    // From the power below the leading one down, as the others.
    let mut polynomial: Vec<S> = Vec::new();
    for r in 0..n {
        checkpoint((r * r * r) as u64);
        let zero = at(r, r).nothing();
        // -a, -R C, -R A C, ..: A is the part before, R and C what comes beside and below.
        let mut steps = vec![zero.minus(at(r, r))];
        let mut column: Vec<S> = (0..r).map(|i| at(i, r).clone()).collect();
        for k in 0..r {
            steps.push(zero.minus(&zero.sum_of_products((0..r).map(|i| (at(r, i), &column[i])))));
            if k + 1 < r {
                column = (0..r).map(|i| zero.sum_of_products((0..r).map(|j| (at(i, j), &column[j])))).collect();
            }
        }
        let next = |k: usize| {
            let products = zero.sum_of_products((0..k).map(|i| (&steps[i], &polynomial[k - 1 - i])));
            let own = steps[k].plus(&products);
            if k < polynomial.len() { own.plus(&polynomial[k]) } else { own }
        };
        polynomial = (0..=r).map(next).collect();
    }
    polynomial.reverse();
    polynomial
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Budget;
    use crate::matrix::{Matrix, faddeev_leverrier};
    use crate::number::Rational;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn coefficients_hold_those_of_every_matrix_inside(entries in prop::collection::vec(-9i64..10, 16), n in 0usize..5) {
            let exact = Matrix::from_fn(n, n, |i, j| Integer::from(entries[4 * i + j]));
            let expected = faddeev_leverrier(&exact, &Budget::unlimited()).unwrap().characteristic;
            // Thirds: the polynomial of M/3 has the coefficients c_k/3^(n-k).
            let third = |i: usize, j: usize| Rational::new(entries[4 * i + j].into(), 3.into());
            let found = BallMatrix::from_fn(n, |i, j| Ball::from_rational(&third(i, j), 96)).characteristic_polynomial(96);
            prop_assert_eq!(found.len(), n + 1);
            for (k, c) in found.iter().enumerate() {
                let value = Rational::new(expected.coeff(k), Integer::from(3).pow((n - k) as u64));
                prop_assert!(c.contains(&value) && c.width_units().bit_length() < 40, "{} {:?}", k, c);
            }
            let entries: Vec<Ball> = (0..n * n).map(|k| Ball::from_rational(&third(k / n, k % n), 96)).collect();
            let again = characteristic_polynomial(n, &entries);
            prop_assert_eq!(again.len(), n);
            for (a, b) in again.iter().zip(&found) {
                prop_assert!(a.intersection(b).is_some() && a.width_units().bit_length() < 40, "{:?} {:?}", a, b);
            }
        }
    }
}
