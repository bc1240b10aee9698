//! The critical values of `x`: where branches of the curves meet, vanish, leave or have a vertical tangent.

use super::curves::{Curve, X, Y};
use super::ground::Projected;
use crate::Range;

/// The polynomials in `x` whose zeros cut the domain into strips: leading coefficients, discriminants and resultants in `y`, and
/// the curves on the domain's edges. They are independent of each other; their order is fixed.
pub(super) fn projection<'a>(curves: &[Curve], y_domain: &'a Range) -> Vec<Projected<'a>> {
    let degrees: Vec<u32> = curves.iter().map(|c| c.polynomial.degree_in(Y)).collect();
    let mut wanted = Vec::new();
    for (i, &degree) in degrees.iter().enumerate() {
        if degree > 0 || curves[i].polynomial.degree_in(X) > 0 {
            wanted.push(Projected::Leading(i));
        }
        if degree == 0 {
            continue;
        }
        if degree > 1 {
            wanted.push(Projected::Discriminant(i));
        }
        let edges = [&y_domain.lower, &y_domain.upper].into_iter().flatten();
        wanted.extend(edges.map(|end| Projected::AtEdge(i, end)));
        wanted.extend((0..i).filter(|&j| degrees[j] > 0).map(|j| Projected::Resultant(i, j)));
    }
    wanted
}
