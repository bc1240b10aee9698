//! Proofs that polynomials in several variables have no repeated and no common factor, from their values on lines.
//!
//! A factor in which variable `j` occurs keeps its degree in `j` on a line on which the polynomial keeps its own. So one line
//! on which a polynomial is square-free, or two are coprime, shows that no such factor is repeated or common. Lines nearly
//! always show it, where a greatest common divisor in several variables would take long.

use super::MultiPoly;
use crate::number::Integer;
use crate::poly::{Domain, Poly, SquareFree, UniPoly};

/// A line through small integers, parallel to an axis.
pub(crate) struct Line(u64);

/// The lines that are tried.
pub(crate) fn lines() -> impl Iterator<Item = Line> {
    (0..3).map(Line)
}

impl Line {
    /// Small numbers that are neither zero nor one, different for each variable and line.
    fn point(&self, count: usize) -> Vec<Integer> {
        let line = self.0;
        (0..count as u64).map(|i| Integer::from(3 + (i * 7 + line * 11) % 23 + (i * i + line) % 5)).collect()
    }

    /// The polynomial in variable `j` on the line, whatever its degree there.
    fn value(&self, p: &MultiPoly, j: usize) -> UniPoly {
        let point = self.point(p.degrees().len());
        UniPoly::new(p.as_poly_in(j).coeffs().iter().map(|c| c.eval_integers(&point)).collect())
    }

    /// The value of a coefficient in which the variable of the line does not occur.
    fn number(&self, c: &MultiPoly) -> Integer {
        c.eval_integers(&self.point(c.degrees().len()))
    }

    /// The polynomial in variable `j` on the line; `None` where its degree in `j` falls.
    pub fn polynomial(&self, p: &MultiPoly, j: usize) -> Option<UniPoly> {
        let value = self.value(p, j);
        let degree = p.degree_in(j) as usize;
        (value.degree() == Some(degree) || (p.is_zero() && value.is_zero())).then_some(value)
    }
}

/// Whether it is shown that no factor in which variable `j` occurs is repeated.
pub fn is_square_free_in(p: &MultiPoly, j: usize) -> bool {
    lines().any(|line| line.polynomial(p, j).is_some_and(|u| SquareFree::new(u).is_some()))
}

/// Whether it is shown that no factor in which variable `j` occurs is common.
pub fn are_coprime_in(a: &MultiPoly, b: &MultiPoly, j: usize) -> bool {
    if a.degree_in(j) == 0 || b.degree_in(j) == 0 {
        return true;
    }
    let on = |line: Line| Some(line.polynomial(a, j)?.gcd(&line.polynomial(b, j)?).is_constant());
    lines().any(|line| on(line) == Some(true))
}

/// Whether it is shown that two polynomials with coefficients in several variables have no common factor but one of numbers
/// and of these variables.
pub(super) fn coefficients_are_coprime(a: &Poly<MultiPoly>, b: &Poly<MultiPoly>) -> bool {
    let on = |line: &Line, p: &Poly<MultiPoly>| -> Option<UniPoly> {
        let value = UniPoly::new(p.coeffs().iter().map(|c| line.number(c)).collect());
        (value.degree() == p.degree()).then_some(value)
    };
    lines().any(|line| {
        let (Some(a), Some(b)) = (on(&line, a), on(&line, b)) else { return false };
        a.gcd(&b).is_constant()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_and_common_factors_are_never_missed() {
        let [x, y, z] = [0, 1, 2].map(MultiPoly::variable);
        let f = x.times(&y).plus(&z);
        let g = x.times(&x).plus(&y.times(&z)).plus(&MultiPoly::one());
        assert!((0..3).all(|j| is_square_free_in(&f.times(&g), j)));
        assert!((0..3).all(|j| !is_square_free_in(&f.times(&f).times(&g), j)));
        assert!((0..3).all(|j| are_coprime_in(&f, &g, j)));
        assert!((0..3).all(|j| !are_coprime_in(&f.times(&x), &f.times(&g), j)));
        // A factor in which a variable does not occur is of no concern for it.
        let only_y = y.plus(&MultiPoly::one());
        assert!(is_square_free_in(&f.times(&only_y).times(&only_y), 0));
        assert!(are_coprime_in(&f.times(&only_y), &g.times(&only_y), 0));
    }
}
