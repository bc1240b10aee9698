//! Resultants by their square-free factors.

use super::modular::square_free_resultant::square_free_decomposition;
use super::{Poly, UniPoly, resultant};
use crate::limits::{Budget, Exhausted};

/// The square-free decomposition `c f_1 f_2^2 f_3^3 ...` of the resultant of two polynomials over `Z[x]`: the pairs
/// `(f_i, i)` of positive degree, primitive, square-free and pairwise coprime; a zero 0 may stand apart. `None` when the
/// resultant is zero.
///
/// The same as [`Poly::square_free_decomposition`] of [`resultant`], and much cheaper where factors are multiple, as in
/// discriminants of resultants, whose crossings are double zeros: factors are lifted from their images modulo primes, and their
/// product is compared with the determinant modulo as many as its bound asks for, so that they are proved.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Domain, Poly, UniPoly, resultant_square_free_decomposition};
/// // y^2 - x^2 and y: x^2 (up to sign) is where they have a common zero.
/// let a = Poly::new(vec![UniPoly::from_i64(&[0, 0, -1]), UniPoly::zero(), UniPoly::one()]);
/// let b = Poly::new(vec![UniPoly::zero(), UniPoly::one()]);
/// let factors = resultant_square_free_decomposition(&a, &b, &Budget::unlimited())?.unwrap();
/// assert_eq!(factors, [(UniPoly::from_i64(&[0, 1]), 2)]);
/// # Ok::<(), jurist_algebra::limits::Exhausted>(())
/// ```
///
/// Cost: with `d` the degree of the resultant in `x`, `n` and `m` those of the polynomials in `y` and `b` the bits of its bound, `O(b d n m)`
/// products of residues for the values, and `O(c d^2)` for the factors, `c` at most `b` and about twice the bits of the longest factor; where
/// the factors are not found so, that of [`resultant`] and of its decomposition. The coefficients of a factor are lifted as fractions
/// ([Monagan2004](crate::bibliography#monagan2004)) from square-free decompositions modulo primes ([Yun1976](crate::bibliography#yun1976)).
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn resultant_square_free_decomposition(
    a: &Poly<UniPoly>,
    b: &Poly<UniPoly>,
    budget: &Budget,
) -> Result<Option<Vec<(UniPoly, usize)>>, Exhausted> {
    if let Some(factors) = budget.enter(|| square_free_decomposition(a, b))? {
        return Ok(Some(factors));
    }
    let value = resultant(a, b, budget)?;
    if value.coeffs().is_empty() {
        return Ok(None);
    }
    budget.enter(|| Some(value.square_free_decomposition()))
}
