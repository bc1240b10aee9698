//! The parts of a matrix that determine its eigenvalues alone.

use super::Matrix;
use crate::poly::Domain;

impl<R: Domain> Matrix<R> {
    /// The index sets of the diagonal blocks that the matrix has when rows and columns are put in order so that it is block
    /// triangular with as many blocks as possible: the strongly connected components of the graph with an edge for each entry
    /// that is not zero. Each set is ascending, and they are in the order of their first members.
    ///
    /// The characteristic polynomial is the product of those of the blocks.
    ///
    /// ```
    /// use jurist_algebra::matrix::Matrix;
    /// // 0 and 2 act on each other, 1 is driven by both.
    /// let m = Matrix::from_i64(&[&[1, 0, 5], &[3, 2, 4], &[6, 0, 0]]);
    /// assert_eq!(m.decoupled_parts(), [vec![0, 2], vec![1]]);
    /// ```
    ///
    /// Cost: `n^3` operations on truth values.
    ///
    /// # Panics
    /// When the matrix is not square.
    pub fn decoupled_parts(&self) -> Vec<Vec<usize>> {
        assert!(self.is_square(), "eigenvalues are those of a square matrix");
        let n = self.rows();
        let mut reaches: Vec<Vec<bool>> =
            (0..n).map(|i| (0..n).map(|j| i == j || !self[(i, j)].is_zero()).collect()).collect();
        for k in 0..n {
            let through = reaches[k].clone();
            for row in reaches.iter_mut().filter(|row| row[k]) {
                row.iter_mut().zip(&through).for_each(|(to, by)| *to |= by);
            }
        }
        let mut parts: Vec<Vec<usize>> = Vec::new();
        for (i, row) in reaches.iter().enumerate() {
            match parts.iter_mut().find(|part| reaches[part[0]][i] && row[part[0]]) {
                Some(part) => part.push(i),
                None => parts.push(vec![i]),
            }
        }
        parts
    }

    /// The matrix of the rows and columns with these indices.
    ///
    /// # Panics
    /// When an index leaves the matrix.
    pub fn principal(&self, indices: &[usize]) -> Self {
        Matrix::from_fn(indices.len(), indices.len(), |i, j| self[(indices[i], indices[j])].clone())
    }
}

#[cfg(test)]
mod tests {
    use super::super::faddeev_leverrier;
    use super::super::strategies::integer_matrix;
    use crate::number::Integer;
    use crate::poly::{Domain, UniPoly};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn the_characteristic_polynomial_is_that_of_the_parts(
            m in integer_matrix(6, 3),
            zeros in prop::collection::vec(any::<bool>(), 36),
        ) {
            // More zeros: else all is one part.
            let m = super::Matrix::from_fn(m.rows(), m.rows(), |i, j| {
                if zeros[6 * i + j] && i != j { Integer::ZERO } else { m[(i, j)].clone() }
            });
            let characteristic = |m: &super::Matrix<Integer>| -> UniPoly {
                faddeev_leverrier(m, &crate::limits::Budget::unlimited()).unwrap().characteristic
            };
            let parts = m.decoupled_parts();
            let product = parts.iter().fold(UniPoly::one(), |p, part| p.times(&characteristic(&m.principal(part))));
            prop_assert_eq!(product, characteristic(&m));
            let mut all: Vec<usize> = parts.into_iter().flatten().collect();
            all.sort_unstable();
            prop_assert_eq!(all, (0..m.rows()).collect::<Vec<_>>());
        }
    }
}
