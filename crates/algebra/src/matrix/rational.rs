//! Matrices of rational functions.

use super::{
    CharacteristicPolynomial, FaddeevLeVerrier, Matrix, characteristic_polynomial_over_rows, faddeev_leverrier,
};
use crate::limits::{Budget, Exhausted};
use crate::poly::{Domain, MultiPoly, RationalFunction};

/// A matrix of rational functions.
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
pub type RationalMatrix = Matrix<RationalFunction>;

/// A matrix of rational functions over a common denominator: the matrix is `numerators / denominator`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cleared {
    /// The numerators.
    pub numerators: Matrix<MultiPoly>,
    /// The least common denominator, with positive leading coefficient.
    pub denominator: MultiPoly,
}

impl RationalMatrix {
    /// The matrix over the least common denominator of its entries.
    ///
    /// Cost: a least common multiple and a product of polynomials for each entry.
    pub fn cleared(&self) -> Cleared {
        let mut denominator = MultiPoly::one();
        for entry in self.entries() {
            denominator = least_common_multiple(&denominator, entry.denominator());
        }
        let numerators = Matrix::from_fn(self.rows(), self.columns(), |i, j| {
            let entry = &self[(i, j)];
            entry.numerator().times(&denominator.div_exact(entry.denominator()).expect("a common multiple"))
        });
        Cleared { numerators, denominator }
    }

    /// The distinct denominators of the entries that are not constant: where one of them is zero,
    /// an entry is undefined.
    pub fn poles(&self) -> Vec<MultiPoly> {
        let mut poles: Vec<MultiPoly> = Vec::new();
        for entry in self.entries() {
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
    /// `variables` are the names of variables 0, 1, ... By [`characteristic_polynomial_over_rows`] where the grid of
    /// parameters is not too large, else by the recursion of Faddeev and LeVerrier.
    ///
    /// Cost: `O(n^3)` products of residues ([Hadamard1893](crate::bibliography#hadamard1893) bounds how many primes
    /// there are) at each point of a grid, which has in each variable one point more than the sum of the greatest
    /// degrees of the rows; then a greatest common divisor for each of the `n` coefficients.
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
        let Some((numerator, denominator)) = characteristic_polynomial_over_rows(self, budget)? else {
            return self.characteristic_polynomial_faddeev_leverrier(variables, budget);
        };
        budget.enter(|| {
            let over_denominator =
                |c| RationalFunction::new(c, denominator.clone()).expect("a denominator is not zero");
            let coefficients = numerator.into_coeffs().into_iter().map(over_denominator).collect();
            self.characteristic_of(variables, coefficients)
        })
    }

    /// `det(zI - M)` with coefficients in lowest terms, monic, by the recursion of Faddeev and
    /// LeVerrier over the common denominator. The poles are those of the entries; `variables` are
    /// the names of variables 0, 1, ...
    ///
    /// Cost: `O(n^4)` products of polynomials ([Faddeev1949](crate::bibliography#faddeev1949)), and a greatest
    /// common divisor for each of the `n` coefficients.
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
        let Cleared { numerators, denominator } = budget.enter(|| self.cleared())?;
        let FaddeevLeVerrier { characteristic, .. } = faddeev_leverrier(&numerators, budget)?;
        budget.enter(|| {
            let mut coefficients = Vec::with_capacity(self.rows() + 1);
            let mut power = MultiPoly::one();
            // det(zI - N/q) has the coefficients c_k / q^(n-k), with c_k those of det(zI - N).
            for c in characteristic.into_coeffs().into_iter().rev() {
                coefficients.push(RationalFunction::new(c, power.clone()).expect("a denominator is not zero"));
                power = power.times(&denominator);
            }
            coefficients.reverse();
            self.characteristic_of(variables, coefficients)
        })
    }

    fn characteristic_of(
        &self,
        variables: Vec<String>,
        coefficients: Vec<RationalFunction>,
    ) -> CharacteristicPolynomial {
        let (formal_degree, poles) = (self.rows(), self.poles());
        CharacteristicPolynomial { variables, coefficients, formal_degree, poles, monic: true }
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
