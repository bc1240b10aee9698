//! What a certificate of a map says beyond the map: the polynomials whose zeros are the walls, and curves along lines.

use super::decompose::{at_x, at_y, in_y};
use crate::Range;
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, Poly, UniPoly, resultant_square_free_decomposition};

/// Polynomials in `x` with the places at which curves may meet, turn, leave or end among their zeros. Such places are zeros of leading coefficients, of
/// resultants of a curve with its derivative and with another curve in `y`, and of the curves on the domain's edges. Each of these is a product of powers
/// of the polynomials, and no polynomial is constant.
///
/// Cost: that of the projection once more, which does not keep what belongs to which power.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn critical_polynomials(
    curves: &[MultiPoly],
    y_domain: &Range,
    budget: &Budget,
) -> Result<Vec<UniPoly>, Exhausted> {
    let curves: Vec<Poly<UniPoly>> = curves.iter().map(in_y).collect();
    let pairs: Vec<(usize, usize)> = (0..curves.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).collect();
    let factors = |f: &Poly<UniPoly>, g: &Poly<UniPoly>| -> Result<Vec<UniPoly>, Exhausted> {
        let found = resultant_square_free_decomposition(f, g, budget)?.unwrap_or_default();
        Ok(found.into_iter().map(|(factor, _)| factor).collect())
    };
    let of_pair = |&(i, j): &(usize, usize)| -> Result<Vec<UniPoly>, Exhausted> {
        budget.check()?;
        let (f, g) = (&curves[i], &curves[j]);
        if i != j {
            return if f.is_constant() || g.is_constant() { Ok(Vec::new()) } else { factors(f, g) };
        }
        let mut out: Vec<UniPoly> = f.leading().into_iter().cloned().collect();
        if f.degree() > Some(1) {
            out.extend(factors(f, &f.derivative())?);
        }
        let edges = [&y_domain.lower, &y_domain.upper].into_iter().flatten().filter(|_| !f.is_constant());
        out.extend(edges.map(|y| at_y(f, y)));
        Ok(out)
    };
    let found: Result<Vec<Vec<UniPoly>>, Exhausted> = parallel_map(&pairs, of_pair);
    Ok(found?.into_iter().flatten().filter(|p| !p.is_constant()).collect())
}

/// A curve's polynomial over one `x`, in `y`, without a common integer factor.
pub fn over(curve: &MultiPoly, x: &Rational) -> UniPoly {
    at_x(curve, x).primitive_part()
}

/// A curve's polynomial at one `y`, in `x`, without a common integer factor.
pub fn at_height(curve: &MultiPoly, y: &Rational) -> UniPoly {
    at_y(&in_y(curve), y).primitive_part()
}
