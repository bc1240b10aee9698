//! Proofs that polynomials in several variables have no repeated and no common factor, from their values on lines.
//!
//! A factor in which variable `j` occurs keeps its degree in `j` on a line on which the polynomial keeps its own. So one line
//! on which a polynomial is square-free, or two are coprime, shows that no such factor is repeated or common. Lines nearly
//! always show it, where a greatest common divisor in several variables would take long.

use super::Function;
use crate::limits::{Budget, Exhausted};
use crate::number::Integer;
use crate::poly::{Domain, MultiPoly, Poly, SquareFree, UniPoly, resultant_formal};

/// A line through small integers, parallel to an axis.
pub(super) struct Line(u64);

/// The lines that are tried.
fn lines() -> impl Iterator<Item = Line> {
    (0..3).map(Line)
}

impl Line {
    /// The polynomial in variable `j` on the line, whatever its degree there.
    fn value(&self, p: &MultiPoly, j: usize) -> UniPoly {
        let line = self.0;
        let count = p.degrees().len();
        // Small numbers that are neither zero nor one, different for each variable and line.
        let point: Vec<Integer> =
            (0..count as u64).map(|i| Integer::from(3 + (i * 7 + line * 11) % 23 + (i * i + line) % 5)).collect();
        let parts = p.as_poly_in(j);
        let values = parts.coeffs().iter().map(|c| {
            let mut at = point.clone();
            at.resize(c.degrees().len().max(count), Integer::ONE);
            c.eval_integers(&at)
        });
        UniPoly::new(values.collect())
    }

    /// The polynomial in variable `j` on the line; `None` where its degree in `j` falls.
    pub fn polynomial(&self, p: &MultiPoly, j: usize) -> Option<UniPoly> {
        let value = self.value(p, j);
        let degree = p.degree_in(j) as usize;
        (value.degree() == Some(degree) || (p.is_zero() && value.is_zero())).then_some(value)
    }
}

/// The resultant of two polynomials, by all coefficients for their formal degrees, in variable `j` on a line.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn resultant_on_line(
    a: &[MultiPoly],
    b: &[MultiPoly],
    j: usize,
    line: &Line,
    budget: &Budget,
) -> Result<Option<UniPoly>, Exhausted> {
    let on = |list: &[MultiPoly]| list.iter().map(|p| line.polynomial(p, j)).collect::<Option<Vec<UniPoly>>>();
    let (Some(of_a), Some(of_b)) = (on(a), on(b)) else { return Ok(None) };
    resultant_formal(&Poly::new(of_a), a.len() - 1, &Poly::new(of_b), b.len() - 1, budget).map(Some)
}

/// Whether it is shown that no factor in which variable `j` occurs is repeated.
pub fn is_square_free_in(p: &MultiPoly, j: usize) -> bool {
    lines().any(|line| line.polynomial(p, j).is_some_and(|u| SquareFree::new(u).is_some()))
}

/// Whether resultants among the functions, on a line, are not zero and, apart from powers of variable `j`, have no repeated
/// factor in which it occurs and none in common with another function. No proof, as degree may be lost on all lines; for one
/// who finds out when it is not so.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn resultants_seem_simple_in(functions: &[Function], j: usize, budget: &Budget) -> Result<bool, Exhausted> {
    'lines: for line in lines() {
        let mut parts = Vec::with_capacity(functions.len());
        for f in functions {
            let Some(value) = f.on_line(j, &line, budget)?.filter(|v| !v.is_zero()) else { continue 'lines };
            let order = value.coeffs().iter().position(|c| !c.is_zero()).unwrap_or(0);
            parts.push((UniPoly::new(value.coeffs()[order..].to_vec()), f.polynomial().is_none()));
        }
        let is_simple = |k: usize| {
            let (part, is_resultant) = &parts[k];
            let others = || parts.iter().enumerate().filter(|(i, _)| *i != k);
            !is_resultant
                || (SquareFree::new(part.clone()).is_some()
                    && others().all(|(_, (other, _))| part.gcd(other).is_constant()))
        };
        if budget.enter(|| (0..parts.len()).all(is_simple))? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether it is shown that no factor in which variable `j` occurs is common.
pub fn are_coprime_in(a: &MultiPoly, b: &MultiPoly, j: usize) -> bool {
    if a.degree_in(j) == 0 || b.degree_in(j) == 0 {
        return true;
    }
    let on = |line: Line| Some(line.polynomial(a, j)?.gcd(&line.polynomial(b, j)?).is_constant());
    lines().any(|line| on(line) == Some(true))
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
