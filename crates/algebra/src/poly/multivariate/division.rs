//! Exact division.

use super::arithmetic::Packing;
use super::{Monomial, MultiPoly};
use crate::limits::checkpoint;
use crate::number::Integer;
use crate::poly::{Domain, Poly};
use std::collections::BTreeMap;

/// Division goes through one packed univariate division when the packed dividend has at most
/// this many coefficients for each of its terms.
const DENSE_FACTOR: usize = 8;

impl MultiPoly {
    /// Every coefficient divided by `c`; `None` when one is not divisible or `c` is zero.
    pub fn div_exact_integer(&self, c: &Integer) -> Option<MultiPoly> {
        if c.is_one() {
            return Some(self.clone());
        }
        let divide = |(m, a): &(Monomial, Integer)| Domain::div_exact(a, c).map(|q| (m.clone(), q));
        if c.is_zero() {
            return None;
        }
        checkpoint(4 * self.terms.len() as u64);
        self.terms.iter().map(divide).collect::<Option<Vec<_>>>().map(|terms| MultiPoly { terms })
    }

    /// Every term divided by a monomial; `None` when it does not divide.
    pub fn div_exact_monomial(&self, monomial: &Monomial) -> Option<MultiPoly> {
        let divide = |(m, a): &(Monomial, Integer)| m.checked_div(monomial).map(|q| (q, a.clone()));
        self.terms.iter().map(divide).collect::<Option<Vec<_>>>().map(|terms| MultiPoly { terms })
    }

    /// The exact quotient, or `None` when the divisor is zero or does not divide.
    pub(super) fn div_exact_multi(&self, divisor: &MultiPoly) -> Option<MultiPoly> {
        let (lead, c) = divisor.leading_term()?;
        if self.is_zero() {
            return Some(MultiPoly::zero());
        }
        if divisor.terms.len() == 1 {
            let quotient = if lead.is_one() { self.clone() } else { self.div_exact_monomial(lead)? };
            return quotient.div_exact_integer(c);
        }
        // Degrees add up in each variable, and so do the least exponents and the leading terms.
        let (degrees, below) = (self.degrees(), divisor.degrees());
        if below.len() > degrees.len() || below.iter().zip(&degrees).any(|(b, d)| b > d) {
            return None;
        }
        if self == divisor {
            return Some(MultiPoly::one());
        }
        let limit = (self.terms.len() + divisor.terms.len()).saturating_mul(DENSE_FACTOR);
        match Packing::new(degrees.iter().map(|&d| d as usize + 1).collect(), limit) {
            Some(packing) => self.div_exact_packed(divisor, &packing),
            None => self.div_exact_sparse(divisor),
        }
    }

    /// Division of the packed polynomials. A univariate quotient is the multivariate one exactly
    /// when its degrees, variable by variable, add up with the divisor's to at most the
    /// dividend's: then no digit overflows, and packing is one to one.
    fn div_exact_packed(&self, divisor: &MultiPoly, packing: &Packing) -> Option<MultiPoly> {
        let (a, b) = (Poly::new(packing.pack(self)), Poly::new(packing.pack(divisor)));
        let quotient = packing.unpack(a.div_exact(&b)?.into_coeffs());
        let (degrees, of_divisor, of_quotient) = (self.degrees(), divisor.degrees(), quotient.degrees());
        let degree = |d: &[u32], i: usize| d.get(i).map_or(0, |&e| u64::from(e));
        let fits = (0..of_quotient.len().max(of_divisor.len()))
            .all(|i| degree(&of_quotient, i) + degree(&of_divisor, i) <= degree(&degrees, i));
        fits.then_some(quotient)
    }

    /// Long division on sparse terms: the reference.
    fn div_exact_sparse(&self, divisor: &MultiPoly) -> Option<MultiPoly> {
        let (lead, c) = divisor.leading_term()?;
        let mut rest: BTreeMap<Monomial, Integer> = self.terms.iter().cloned().collect();
        let mut quotient = Vec::new();
        while let Some((m, a)) = rest.pop_last() {
            if a.is_zero() {
                continue;
            }
            let (m, a) = (m.checked_div(lead)?, Domain::div_exact(&a, c)?);
            checkpoint(16 * divisor.terms.len() as u64);
            for (n, d) in &divisor.terms[1..] {
                // The dividend's degrees bound the quotient's, unless the division is not exact.
                rest.entry(n.checked_mul(&m)?).or_default().sub_mul_assign(&a, d);
            }
            quotient.push((m, a));
        }
        Some(MultiPoly::from_descending(quotient))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_and_sparse_quotients_agree() {
        let (x, y) = (MultiPoly::variable(0), MultiPoly::variable(1));
        let a = &(&(&x * &x) - &y) + &MultiPoly::from(3);
        let b = &(&(&x * &y) + &(&y * &y)) - &MultiPoly::from(2);
        let product = &a * &b;
        let packing = Packing::new(product.degrees().iter().map(|&d| d as usize + 1).collect(), 1000).unwrap();
        assert_eq!(product.div_exact_packed(&b, &packing), Some(a.clone()));
        assert_eq!(product.div_exact_sparse(&b), Some(a.clone()));
        let off = &product + &x;
        assert_eq!(off.div_exact_packed(&b, &packing), None);
        assert_eq!(off.div_exact_sparse(&b), None);
    }

    /// With radix 3 for `y`, `x` and `y^3` pack to the same number: `y^2 * y` is not `x`.
    #[test]
    fn a_packed_quotient_that_overflows_a_digit_is_refused() {
        let (x, y) = (MultiPoly::variable(0), MultiPoly::variable(1));
        let y2 = &y * &y;
        // Packed with x -> u^3, y -> u: u^3 - 1 = (u - 1)(u^2 + u + 1), but x - 1 is irreducible.
        let a = &(&x - &MultiPoly::from(1)) * &(&y2 + &MultiPoly::from(1));
        let b = &y - &MultiPoly::from(1);
        assert_eq!(a.div_exact(&b), None);
        assert_eq!(a.div_exact_sparse(&b), None);
    }
}
