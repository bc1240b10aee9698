//! Dense matrices over a domain.

use crate::limits::{checkpoint, claim};
use crate::number::Integer;
use crate::poly::{Domain, Poly};
use std::fmt;
use std::ops::{Add, Index, IndexMut, Mul, Sub};

/// A dense matrix with entries from a domain, stored row by row. Either size may be 0.
///
/// ```
/// use jurist_algebra::matrix::Matrix;
/// use jurist_algebra::number::Integer;
/// let m = Matrix::from_i64(&[&[1, 2], &[3, 4]]);
/// assert_eq!((&m * &m)[(1, 0)], Integer::from(15));
/// assert_eq!(m.trace(), Integer::from(5));
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Matrix<R> {
    rows: usize,
    columns: usize,
    entries: Vec<R>,
}

impl<R: Domain> Matrix<R> {
    /// The matrix whose entry in row `i`, column `j` is `f(i, j)`.
    pub fn from_fn(rows: usize, columns: usize, mut f: impl FnMut(usize, usize) -> R) -> Self {
        claim((rows as u64).saturating_mul(columns as u64).saturating_mul(size_of::<R>() as u64));
        let mut entries = Vec::with_capacity(rows * columns);
        for i in 0..rows {
            checkpoint(columns as u64);
            for j in 0..columns {
                entries.push(f(i, j));
            }
        }
        Matrix { rows, columns, entries }
    }

    /// From rows; `None` when they differ in length. No rows give the 0 x 0 matrix.
    pub fn from_rows(rows: Vec<Vec<R>>) -> Option<Self> {
        let columns = rows.first().map_or(0, Vec::len);
        if rows.iter().any(|row| row.len() != columns) {
            return None;
        }
        Some(Matrix { rows: rows.len(), columns, entries: rows.into_iter().flatten().collect() })
    }

    /// All entries zero.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Matrix::from_fn(rows, columns, |_, _| R::zero())
    }

    /// The identity of size `n`.
    pub fn identity(n: usize) -> Self {
        Matrix::scalar(n, &R::one())
    }

    /// `c` times the identity of size `n`.
    pub fn scalar(n: usize, c: &R) -> Self {
        Matrix::from_fn(n, n, |i, j| if i == j { c.clone() } else { R::zero() })
    }

    /// A square matrix with these entries on the diagonal.
    pub fn diagonal(entries: &[R]) -> Self {
        Matrix::from_fn(entries.len(), entries.len(), |i, j| if i == j { entries[i].clone() } else { R::zero() })
    }

    /// The companion matrix of the monic `z^n + c_(n-1) z^(n-1) + ... + c_0`, given `c_0 ... c_(n-1)`:
    /// ones below the diagonal, the negated coefficients in the last column.
    pub fn companion(coefficients: &[R]) -> Self {
        let n = coefficients.len();
        Matrix::from_fn(n, n, |i, j| match (i, j) {
            (i, j) if j + 1 == n => coefficients[i].negated(),
            (i, j) if i == j + 1 => R::one(),
            _ => R::zero(),
        })
    }

    /// The block matrix `[[a, b], [c, d]]`.
    ///
    /// # Panics
    /// When the sizes do not fit.
    pub fn blocks(a: &Self, b: &Self, c: &Self, d: &Self) -> Self {
        assert!(a.rows == b.rows && c.rows == d.rows, "blocks side by side have equally many rows");
        assert!(a.columns == c.columns && b.columns == d.columns, "stacked blocks have equally many columns");
        Matrix::from_fn(a.rows + c.rows, a.columns + b.columns, |i, j| {
            let (row, left, right) = if i < a.rows { (i, a, b) } else { (i - a.rows, c, d) };
            if j < a.columns { left[(row, j)].clone() } else { right[(row, j - a.columns)].clone() }
        })
    }

    /// The part with rows `rows` and columns `columns`.
    ///
    /// # Panics
    /// When a range leaves the matrix.
    pub fn block(&self, rows: std::ops::Range<usize>, columns: std::ops::Range<usize>) -> Self {
        Matrix::from_fn(rows.len(), columns.len(), |i, j| self[(rows.start + i, columns.start + j)].clone())
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Whether there are as many rows as columns.
    pub fn is_square(&self) -> bool {
        self.rows == self.columns
    }

    /// The entries, row by row.
    pub fn entries(&self) -> &[R] {
        &self.entries
    }

    /// Row `i`.
    ///
    /// # Panics
    /// When there is no such row.
    pub fn row(&self, i: usize) -> &[R] {
        assert!(i < self.rows, "there is no row {i}");
        &self.entries[i * self.columns..(i + 1) * self.columns]
    }

    /// The matrix of the images under `f`.
    pub fn map<S: Domain>(&self, f: impl FnMut(&R) -> S) -> Matrix<S> {
        Matrix { rows: self.rows, columns: self.columns, entries: self.entries.iter().map(f).collect() }
    }

    /// The same where an image may be missing.
    ///
    /// # Errors
    /// The first reason why one is.
    pub fn try_map<S: Domain, E>(&self, f: impl FnMut(&R) -> Result<S, E>) -> Result<Matrix<S>, E> {
        let entries = self.entries.iter().map(f).collect::<Result<_, E>>()?;
        Ok(Matrix { rows: self.rows, columns: self.columns, entries })
    }

    /// Rows and columns exchanged.
    pub fn transposed(&self) -> Self {
        Matrix::from_fn(self.columns, self.rows, |i, j| self[(j, i)].clone())
    }

    /// `c` times the matrix.
    pub fn scaled(&self, c: &R) -> Self {
        self.map(|a| a.times(c))
    }

    /// Every entry divided exactly; `None` when `c` does not divide one of them.
    pub fn div_exact_scalar(&self, c: &R) -> Option<Self> {
        let entries = self.entries.iter().map(|a| a.div_exact(c)).collect::<Option<Vec<R>>>()?;
        Some(Matrix { entries, ..*self })
    }

    /// Adds `c` to each entry of the diagonal.
    pub fn add_to_diagonal(&mut self, c: &R) {
        for i in 0..self.rows.min(self.columns) {
            self[(i, i)] = self[(i, i)].plus(c);
        }
    }

    /// The sum of the diagonal entries.
    pub fn trace(&self) -> R {
        (0..self.rows.min(self.columns)).fold(R::zero(), |sum, i| sum.plus(&self[(i, i)]))
    }

    /// Whether every entry is zero.
    pub fn is_zero(&self) -> bool {
        self.entries.iter().all(R::is_zero)
    }

    /// `z I - M` over the polynomials in `z`.
    ///
    /// # Panics
    /// When the matrix is not square.
    pub fn characteristic_matrix(&self) -> Matrix<Poly<R>> {
        assert!(self.is_square(), "a characteristic matrix is square");
        Matrix::from_fn(self.rows, self.rows, |i, j| {
            let top = if i == j { R::one() } else { R::zero() };
            Poly::new(vec![self[(i, j)].negated(), top])
        })
    }

    fn zip(&self, other: &Self, f: impl Fn(&R, &R) -> R) -> Self {
        assert!((self.rows, self.columns) == (other.rows, other.columns), "matrices of different sizes");
        let entries = self.entries.iter().zip(&other.entries).map(|(a, b)| f(a, b)).collect();
        Matrix { entries, ..*self }
    }

    /// Exchanges two rows.
    pub(super) fn swap_rows(&mut self, i: usize, k: usize) {
        for j in 0..self.columns {
            self.entries.swap(i * self.columns + j, k * self.columns + j);
        }
    }
}

impl Matrix<Integer> {
    /// From machine integers, row by row.
    ///
    /// # Panics
    /// When the rows differ in length.
    pub fn from_i64(rows: &[&[i64]]) -> Self {
        let rows = rows.iter().map(|row| row.iter().map(|&c| Integer::from(c)).collect()).collect();
        Matrix::from_rows(rows).expect("rows have equal lengths")
    }
}

impl<R> Index<(usize, usize)> for Matrix<R> {
    type Output = R;
    fn index(&self, (i, j): (usize, usize)) -> &R {
        assert!(j < self.columns, "there is no column {j}");
        &self.entries[i * self.columns + j]
    }
}

impl<R> IndexMut<(usize, usize)> for Matrix<R> {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut R {
        assert!(j < self.columns, "there is no column {j}");
        &mut self.entries[i * self.columns + j]
    }
}

/// # Panics
/// When the sizes differ.
impl<R: Domain> Add for &Matrix<R> {
    type Output = Matrix<R>;
    fn add(self, other: &Matrix<R>) -> Matrix<R> {
        self.zip(other, R::plus)
    }
}

/// # Panics
/// When the sizes differ.
impl<R: Domain> Sub for &Matrix<R> {
    type Output = Matrix<R>;
    fn sub(self, other: &Matrix<R>) -> Matrix<R> {
        self.zip(other, R::minus)
    }
}

/// # Panics
/// When the left one has not as many columns as the right one has rows.
impl<R: Domain> Mul for &Matrix<R> {
    type Output = Matrix<R>;
    fn mul(self, other: &Matrix<R>) -> Matrix<R> {
        assert!(self.columns == other.rows, "matrices that cannot be multiplied");
        Matrix::from_fn(self.rows, other.columns, |i, j| {
            checkpoint(8 * self.columns as u64);
            let mut sum = R::zero();
            for (k, a) in self.row(i).iter().enumerate().filter(|(_, a)| !a.is_zero()) {
                let b = &other[(k, j)];
                if !b.is_zero() {
                    sum.add_times(a, b);
                }
            }
            sum
        })
    }
}

impl<R: Domain> fmt::Debug for Matrix<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries((0..self.rows).map(|i| self.row(i))).finish()
    }
}
