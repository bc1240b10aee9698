//! Whether resultants that are not expanded seem to have no repeated and no common factor, from their values on lines.

use super::Function;
use crate::limits::{Budget, Exhausted};
use crate::poly::multivariate::{Line, lines};
use crate::poly::{Domain, MultiPoly, Poly, SquareFree, UniPoly, resultant_formal};

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
