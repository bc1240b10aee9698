//! Views as univariate polynomials, renaming of variables.

use super::{Monomial, MultiPoly};
use crate::limits::claim;
use crate::number::Integer;
use crate::poly::{Domain, Poly, UniPoly};

impl MultiPoly {
    /// The polynomial in the single variable `i`; `None` when another variable occurs.
    pub fn to_univariate(&self, i: usize) -> Option<UniPoly> {
        claim((u64::from(self.degree_in(i)) + 1) * size_of::<Integer>() as u64);
        let mut coefficients = vec![Integer::ZERO; self.degree_in(i) as usize + 1];
        for (m, c) in &self.terms {
            let exponents = m.exponents();
            if exponents.iter().enumerate().any(|(j, &e)| j != i && e > 0) {
                return None;
            }
            coefficients[m.exponent(i) as usize] = c.clone();
        }
        Some(UniPoly::new(coefficients))
    }

    /// A univariate polynomial, its indeterminate being variable `i`.
    ///
    /// # Panics
    /// When the degree exceeds `2^32 - 1`.
    pub fn from_univariate(p: &UniPoly, i: usize) -> MultiPoly {
        let term = |(k, c): (usize, &Integer)| (Monomial::power_of(i, exponent(k)), c.clone());
        let terms = p.coeffs().iter().enumerate().rev().filter(|(_, c)| !c.is_zero()).map(term).collect();
        MultiPoly::from_descending(terms)
    }

    /// The same polynomial, as one in variable `i` with coefficients in which `i` does not occur.
    pub fn as_poly_in(&self, i: usize) -> Poly<MultiPoly> {
        claim((u64::from(self.degree_in(i)) + 1) * size_of::<MultiPoly>() as u64);
        let mut coefficients = vec![MultiPoly::default(); self.degree_in(i) as usize + 1];
        for (m, c) in &self.terms {
            // Terms with equal exponents of `i` keep their order without it.
            coefficients[m.exponent(i) as usize].terms.push((m.with_exponent(i, 0), c.clone()));
        }
        Poly::new(coefficients)
    }

    /// The value of `p` where its indeterminate is variable `i`, which may occur in the
    /// coefficients too.
    ///
    /// # Panics
    /// When an exponent would reach `2^32`.
    pub fn from_poly_in(p: &Poly<MultiPoly>, i: usize) -> MultiPoly {
        let mut terms = Vec::new();
        for (k, coefficient) in p.coeffs().iter().enumerate() {
            for (m, c) in &coefficient.terms {
                let e = m.exponent(i).checked_add(exponent(k)).expect("exponents stay below 2^32");
                terms.push((m.with_exponent(i, e), c.clone()));
            }
        }
        MultiPoly::from_unsorted(terms)
    }

    /// The same polynomial with variable `i` called `new_index(i)`. Two variables may become one.
    ///
    /// # Panics
    /// When an exponent would reach `2^32`.
    pub fn map_variables(&self, new_index: impl Fn(usize) -> usize) -> MultiPoly {
        let rename = |(m, c): &(Monomial, Integer)| {
            let mut renamed: Vec<u32> = Vec::new();
            for (i, &e) in m.exponents().iter().enumerate().filter(|(_, e)| **e > 0) {
                let j = new_index(i);
                renamed.resize(renamed.len().max(j + 1), 0);
                renamed[j] = renamed[j].checked_add(e).expect("exponents stay below 2^32");
            }
            (Monomial::new(&renamed), c.clone())
        };
        MultiPoly::from_unsorted(self.terms.iter().map(rename).collect())
    }

    /// The partial derivative with respect to variable `i`.
    pub fn derivative(&self, i: usize) -> MultiPoly {
        let derive = |(m, c): &(Monomial, Integer)| {
            let e = m.exponent(i);
            (e > 0).then(|| (m.with_exponent(i, e - 1), c * &Integer::from(e)))
        };
        MultiPoly::from_descending(self.terms.iter().filter_map(derive).collect())
    }

    /// The product of the distinct irreducible factors of positive degree, primitive over the
    /// integers with a positive leading coefficient. Zero stays zero, a constant becomes 1.
    pub fn square_free_part(&self) -> MultiPoly {
        if self.is_zero() {
            return MultiPoly::zero();
        }
        let p = self.primitive_over_integers();
        // A repeated factor divides every partial derivative; a simple one in variable `i` does
        // not divide the derivative with respect to `i`, being of lower degree there.
        let mut common = p.clone();
        for i in p.variables() {
            if common.is_one() {
                break;
            }
            common = common.gcd(&p.derivative(i));
        }
        p.div_exact(&common).expect("the gcd divides").primitive_over_integers()
    }
}

fn exponent(k: usize) -> u32 {
    u32::try_from(k).expect("degrees stay below 2^32")
}
