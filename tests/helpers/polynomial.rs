//! Polynomials in one variable that several tests isolate.

use jurist_algebra::number::Integer;
use jurist_algebra::poly::{Domain, UniPoly};

/// The product of the factors.
pub fn product(factors: impl IntoIterator<Item = UniPoly>) -> UniPoly {
    factors.into_iter().fold(UniPoly::one(), |product, f| &product * &f)
}

/// `x^n - 2 (a x - 1)^2`: two roots that are very close.
pub fn mignotte(n: usize, a: i64) -> UniPoly {
    let linear = UniPoly::from_i64(&[-1, a]);
    &UniPoly::monomial(Integer::ONE, n) - &(&linear * &linear).scaled(&Integer::from(2))
}
