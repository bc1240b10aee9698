//! Matrices of rational functions.

use super::{
    CharacteristicPolynomial, FaddeevLeVerrier, PolyMatrix, characteristic_polynomial_multimodular, faddeev_leverrier,
};
use crate::limits::{Budget, Exhausted};
use crate::poly::{Domain, MultiPoly, RationalFunction};
use std::ops::{Add, Index, IndexMut, Mul, Sub};

/// A dense matrix of rational functions, stored row by row. Either size may be 0.
///
/// ```
/// use jurist_algebra::matrix::RationalMatrix;
/// use jurist_algebra::poly::RationalFunction;
/// let k = RationalFunction::variable(0);
/// let m = RationalMatrix::from_rows(vec![vec![k.clone(), k.recip().unwrap()]]).unwrap();
/// let cleared = m.cleared();
/// assert_eq!(cleared.denominator.display(&["K"]).to_string(), "K");
/// assert_eq!(cleared.numerators[(0, 0)].display(&["K"]).to_string(), "K^2");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RationalMatrix {
    rows: usize,
    columns: usize,
    entries: Vec<RationalFunction>,
}

/// A matrix of rational functions over a common denominator: the matrix is `numerators / denominator`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cleared {
    /// The numerators.
    pub numerators: PolyMatrix<MultiPoly>,
    /// The least common denominator, with positive leading coefficient.
    pub denominator: MultiPoly,
}

impl RationalMatrix {
    /// The matrix whose entry in row `i`, column `j` is `f(i, j)`.
    pub fn from_fn(rows: usize, columns: usize, mut f: impl FnMut(usize, usize) -> RationalFunction) -> Self {
        let mut entries = Vec::with_capacity(rows * columns);
        for i in 0..rows {
            for j in 0..columns {
                entries.push(f(i, j));
            }
        }
        RationalMatrix { rows, columns, entries }
    }

    /// From rows; `None` when they differ in length. No rows give the 0 x 0 matrix.
    pub fn from_rows(rows: Vec<Vec<RationalFunction>>) -> Option<Self> {
        let columns = rows.first().map_or(0, Vec::len);
        if rows.iter().any(|row| row.len() != columns) {
            return None;
        }
        Some(RationalMatrix { rows: rows.len(), columns, entries: rows.into_iter().flatten().collect() })
    }

    /// All entries zero.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        RationalMatrix::from_fn(rows, columns, |_, _| RationalFunction::zero())
    }

    /// The identity of size `n`.
    pub fn identity(n: usize) -> Self {
        RationalMatrix::from_fn(n, n, |i, j| if i == j { RationalFunction::one() } else { RationalFunction::zero() })
    }

    /// The block matrix `[[a, b], [c, d]]`.
    ///
    /// # Panics
    /// When the sizes do not fit.
    pub fn blocks(a: &Self, b: &Self, c: &Self, d: &Self) -> Self {
        assert!(a.rows == b.rows && c.rows == d.rows, "blocks side by side have equally many rows");
        assert!(a.columns == c.columns && b.columns == d.columns, "stacked blocks have equally many columns");
        RationalMatrix::from_fn(a.rows + c.rows, a.columns + b.columns, |i, j| {
            let (row, left, right) = if i < a.rows { (i, a, b) } else { (i - a.rows, c, d) };
            if j < a.columns { left[(row, j)].clone() } else { right[(row, j - a.columns)].clone() }
        })
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
    pub fn entries(&self) -> &[RationalFunction] {
        &self.entries
    }

    /// The matrix of the images under `f`.
    pub fn map(&self, f: impl FnMut(&RationalFunction) -> RationalFunction) -> Self {
        RationalMatrix { rows: self.rows, columns: self.columns, entries: self.entries.iter().map(f).collect() }
    }

    /// `c` times the matrix.
    pub fn scaled(&self, c: &RationalFunction) -> Self {
        self.map(|a| a * c)
    }

    /// The sum of the diagonal entries.
    pub fn trace(&self) -> RationalFunction {
        (0..self.rows.min(self.columns)).fold(RationalFunction::zero(), |sum, i| &sum + &self[(i, i)])
    }

    /// The matrix over the least common denominator of its entries.
    pub fn cleared(&self) -> Cleared {
        let mut denominator = MultiPoly::one();
        for entry in &self.entries {
            denominator = least_common_multiple(&denominator, entry.denominator());
        }
        let numerators = PolyMatrix::from_fn(self.rows, self.columns, |i, j| {
            let entry = &self[(i, j)];
            entry.numerator().times(&denominator.div_exact(entry.denominator()).expect("a common multiple"))
        });
        Cleared { numerators, denominator }
    }

    /// The distinct denominators of the entries that are not constant: where one of them is zero,
    /// an entry is undefined.
    pub fn poles(&self) -> Vec<MultiPoly> {
        let mut poles: Vec<MultiPoly> = Vec::new();
        for entry in &self.entries {
            if entry.denominator().is_constant() {
                continue;
            }
            let pole = entry.denominator().primitive_over_integers();
            if !pole.is_constant() && !poles.contains(&pole) {
                poles.push(pole);
            }
        }
        poles
    }

    /// `det(zI - M)` with coefficients in lowest terms, monic. The poles are those of the entries;
    /// `variables` are the names of variables 0, 1, ... By [`characteristic_polynomial_multimodular`] where the grid of
    /// parameters is not too large, else by the recursion of Faddeev and LeVerrier.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    ///
    /// # Panics
    /// When the matrix is not square.
    pub fn characteristic_polynomial(
        &self,
        variables: Vec<String>,
        budget: &Budget,
    ) -> Result<CharacteristicPolynomial, Exhausted> {
        let Some(answer) = characteristic_polynomial_multimodular(self, budget) else {
            return self.characteristic_polynomial_faddeev_leverrier(variables, budget);
        };
        let (numerator, denominator) = answer?;
        let n = self.rows;
        let mut coefficients = Vec::with_capacity(n + 1);
        for c in numerator.into_coeffs() {
            budget.check()?;
            coefficients.push(RationalFunction::new(c, denominator.clone()).expect("a denominator is not zero"));
        }
        Ok(CharacteristicPolynomial { variables, coefficients, formal_degree: n, poles: self.poles(), monic: true })
    }

    /// `det(zI - M)` with coefficients in lowest terms, monic, by the recursion of Faddeev and
    /// LeVerrier over the common denominator. The poles are those of the entries; `variables` are
    /// the names of variables 0, 1, ...
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    ///
    /// # Panics
    /// When the matrix is not square.
    pub fn characteristic_polynomial_faddeev_leverrier(
        &self,
        variables: Vec<String>,
        budget: &Budget,
    ) -> Result<CharacteristicPolynomial, Exhausted> {
        let Cleared { numerators, denominator } = self.cleared();
        let FaddeevLeVerrier { characteristic, .. } = faddeev_leverrier(&numerators, budget)?;
        let n = self.rows;
        let mut coefficients = Vec::with_capacity(n + 1);
        let mut power = MultiPoly::one();
        // det(zI - N/q) has the coefficients c_k / q^(n-k), with c_k those of det(zI - N).
        for c in characteristic.into_coeffs().into_iter().rev() {
            budget.check()?;
            coefficients.push(RationalFunction::new(c, power.clone()).expect("a denominator is not zero"));
            power = power.times(&denominator);
        }
        coefficients.reverse();
        Ok(CharacteristicPolynomial { variables, coefficients, formal_degree: n, poles: self.poles(), monic: true })
    }

    fn zip(&self, other: &Self, f: impl Fn(&RationalFunction, &RationalFunction) -> RationalFunction) -> Self {
        assert!((self.rows, self.columns) == (other.rows, other.columns), "matrices of different sizes");
        let entries = self.entries.iter().zip(&other.entries).map(|(a, b)| f(a, b)).collect();
        RationalMatrix { entries, ..*self }
    }
}

/// The least common multiple, with positive leading coefficient.
pub(super) fn least_common_multiple(a: &MultiPoly, b: &MultiPoly) -> MultiPoly {
    if b.is_one() || a == b {
        return a.clone();
    }
    if let (Some(a), Some(b)) = (a.as_constant(), b.as_constant()) {
        return MultiPoly::constant(a.lcm(&b));
    }
    let g = a.gcd(b);
    let product = a.times(&b.div_exact(&g).expect("the gcd divides"));
    if product.needs_negation() { product.negated() } else { product }
}

impl Index<(usize, usize)> for RationalMatrix {
    type Output = RationalFunction;
    fn index(&self, (i, j): (usize, usize)) -> &RationalFunction {
        assert!(j < self.columns, "there is no column {j}");
        &self.entries[i * self.columns + j]
    }
}

impl IndexMut<(usize, usize)> for RationalMatrix {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut RationalFunction {
        assert!(j < self.columns, "there is no column {j}");
        &mut self.entries[i * self.columns + j]
    }
}

/// # Panics
/// When the sizes differ.
impl Add for &RationalMatrix {
    type Output = RationalMatrix;
    fn add(self, other: &RationalMatrix) -> RationalMatrix {
        self.zip(other, |a, b| a + b)
    }
}

/// # Panics
/// When the sizes differ.
impl Sub for &RationalMatrix {
    type Output = RationalMatrix;
    fn sub(self, other: &RationalMatrix) -> RationalMatrix {
        self.zip(other, |a, b| a - b)
    }
}

/// # Panics
/// When the left one has not as many columns as the right one has rows.
impl Mul for &RationalMatrix {
    type Output = RationalMatrix;
    fn mul(self, other: &RationalMatrix) -> RationalMatrix {
        assert!(self.columns == other.rows, "matrices that cannot be multiplied");
        RationalMatrix::from_fn(self.rows, other.columns, |i, j| {
            let nonzero = (0..self.columns).filter(|&k| !self[(i, k)].is_zero() && !other[(k, j)].is_zero());
            nonzero.fold(RationalFunction::zero(), |sum, k| &sum + &(&self[(i, k)] * &other[(k, j)]))
        })
    }
}
