//! Square-free polynomials as a type.

use crate::poly::modular::gcd::coprime_modulo_some_prime;
use crate::poly::{Domain, UniPoly};
use std::sync::Arc;

/// A non-zero primitive integer polynomial without repeated roots, leading coefficient positive.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::real_roots::SquareFree;
/// let p = UniPoly::from_i64(&[4, -8, 4]); // 4 (x - 1)^2
/// assert!(SquareFree::new(p.clone()).is_none());
/// assert_eq!(SquareFree::part_of(&p).unwrap().poly(), &UniPoly::from_i64(&[-1, 1]));
/// assert!(SquareFree::part_of(&UniPoly::from_i64(&[])).is_none());
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SquareFree(Arc<UniPoly>);

impl SquareFree {
    /// The polynomial itself, made primitive; `None` when it is zero or has a repeated root.
    pub fn new(p: UniPoly) -> Option<SquareFree> {
        let degree = p.degree()?;
        let part = SquareFree::part_of(&p)?;
        (part.degree() == degree).then_some(part)
    }

    /// The product of the distinct irreducible factors: same roots, each once. `None` for zero;
    /// 1 for a non-zero constant.
    ///
    /// Cost: a check modulo a prime where there are no repeated roots, else that of
    /// [`Poly::square_free_part`](crate::poly::Poly::square_free_part).
    pub fn part_of(p: &UniPoly) -> Option<SquareFree> {
        if p.is_zero() {
            return None;
        }
        // x^v q(x^h) has the square-free part x sqf(q)(x^h), x only if v > 0.
        let v = p.coeffs().iter().take_while(|c| c.is_zero()).count();
        let h = deflation(&p.coeffs()[v..]);
        let q = UniPoly::new(p.coeffs()[v..].iter().step_by(h).cloned().collect()).primitive_part();
        let part = if coprime_modulo_some_prime(&q, &q.derivative()) { q } else { q.square_free_part() };
        let inflated = if h == 1 { part } else { inflate(&part, h) };
        Some(SquareFree(Arc::new(if v > 0 { inflated.shifted_up(1) } else { inflated })))
    }

    /// A polynomial of which the caller knows that it is primitive, square-free, non-zero and has
    /// a positive leading coefficient.
    pub(crate) fn known(p: UniPoly) -> SquareFree {
        SquareFree(Arc::new(p))
    }

    /// The polynomial.
    pub fn poly(&self) -> &UniPoly {
        &self.0
    }

    /// The degree; 0 means that there are no roots.
    pub fn degree(&self) -> usize {
        self.0.coeffs().len() - 1
    }

    /// The shared polynomial.
    pub(crate) fn shared(&self) -> Arc<UniPoly> {
        Arc::clone(&self.0)
    }
}

/// The greatest `h` with `p(x) = q(x^h)`, given by the coefficients of `p`; 1 for a constant.
pub(super) fn deflation(coeffs: &[crate::number::Integer]) -> usize {
    let mut h = 0usize;
    for (k, _) in coeffs.iter().enumerate().skip(1).filter(|(_, c)| !c.is_zero()) {
        let (mut a, mut b) = (h, k);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        h = a;
        if h == 1 {
            break;
        }
    }
    h.max(1)
}

/// `p(x^h)`.
fn inflate(p: &UniPoly, h: usize) -> UniPoly {
    let mut coeffs = Vec::with_capacity(p.coeffs().len() * h);
    for c in p.coeffs() {
        coeffs.push(c.clone());
        coeffs.extend(std::iter::repeat_n(crate::number::Integer::ZERO, h - 1));
    }
    UniPoly::new(coeffs)
}
