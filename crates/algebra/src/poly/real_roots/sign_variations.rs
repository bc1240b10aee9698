//! Descartes' rule of signs and the Budan-Fourier count.

use crate::number::{Integer, Rational, Sign};
use crate::poly::{Domain, UniPoly};

/// How often the sign changes along a sequence, zeros left out.
pub fn sign_variations(signs: impl IntoIterator<Item = Sign>) -> usize {
    let mut last = Sign::Equal;
    let mut count = 0;
    for sign in signs.into_iter().filter(|s| s.is_ne()) {
        count += usize::from(last.is_ne() && last != sign);
        last = sign;
    }
    count
}

/// The number of sign changes among the coefficients: at least the number of positive roots
/// counted with multiplicity, and of the same parity (Descartes' rule). 0 for zero.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::real_roots::descartes_sign_variations;
/// assert_eq!(descartes_sign_variations(&UniPoly::from_i64(&[2, -3, 1])), 2); // (x - 1)(x - 2)
/// ```
pub fn descartes_sign_variations(p: &UniPoly) -> usize {
    sign_variations(p.coeffs().iter().map(Integer::sign))
}

/// The Budan-Fourier bound: at least the number of roots in `(lo, hi]`, counted with
/// multiplicity, and of the same parity. `lo <= hi`; 0 for the zero polynomial.
pub fn budan_fourier_bound(p: &UniPoly, lo: &Rational, hi: &Rational) -> usize {
    let at = |x: &Rational| descartes_sign_variations(&shifted_to(p, x));
    at(lo).saturating_sub(at(hi))
}

/// A positive multiple of `p(x + a)` with its argument scaled by the positive denominator of `a`.
fn shifted_to(p: &UniPoly, a: &Rational) -> UniPoly {
    let q = a.denominator();
    let n = p.coeffs().len().saturating_sub(1);
    // q^n p(x / q) has integer coefficients c_i q^(n - i).
    let mut coeffs = p.coeffs().to_vec();
    let mut power = Integer::ONE;
    for i in (0..n).rev() {
        power = &power * &q;
        coeffs[i] = coeffs[i].times(&power);
    }
    UniPoly::new(coeffs).taylor_shift(&a.numerator())
}
