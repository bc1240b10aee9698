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

/// The same for the roots in an open interval, `None` meaning without end: Descartes' rule after the map of the interval
/// to the positive axis. At least the number of roots there counted with multiplicity, and of the same parity; one Taylor
/// shift with two finite ends, `O(n^2)` additions. On the whole line the sum of both halves and of the root at 0.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::real_roots::descartes_sign_variations_in;
/// let p = UniPoly::from_i64(&[2, -3, 1]); // (x - 1)(x - 2)
/// let end = Rational::new(3.into(), 2.into());
/// assert_eq!(descartes_sign_variations_in(&p, Some(&end), None), 1);
/// assert_eq!(descartes_sign_variations_in(&p, Some(&Rational::ZERO), Some(&end)), 1);
/// ```
pub fn descartes_sign_variations_in(p: &UniPoly, lower: Option<&Rational>, upper: Option<&Rational>) -> usize {
    if p.is_constant() {
        return 0;
    }
    let d = p.coeffs().len() - 1;
    let moved = match (lower, upper) {
        (None, None) => {
            let zeros = p.coeffs().iter().take_while(|c| c.is_zero()).count();
            return zeros + descartes_sign_variations(p) + descartes_sign_variations(&p.negated_argument());
        }
        (Some(l), None) => shifted_to(p, l),
        (None, Some(r)) => shifted_to(p, r).negated_argument(),
        (Some(l), Some(r)) => {
            let s = l.denominator().lcm(&r.denominator());
            let at = (l * &Rational::from(&s)).numerator();
            let width = ((r - l) * Rational::from(&s)).numerator();
            // s^d p(x / s), shifted, widened to the unit interval and turned over.
            let scaled = p.reversed(d).scaled_argument(&s).reversed(d).taylor_shift(&at).scaled_argument(&width);
            scaled.reversed(d).taylor_shift(&Integer::ONE)
        }
    };
    descartes_sign_variations(&moved)
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
