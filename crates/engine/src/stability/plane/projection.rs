//! The critical values of `x`: where branches of the curves meet, vanish, leave or have a vertical tangent.

use super::curves::Curve;
use super::decompose::{at_y, in_y};
use crate::stability::Range;
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Poly, SquareFree, UniPoly, resultant_square_free_decomposition};

/// A polynomial of the projection before it is computed.
enum Projected<'a> {
    Leading(&'a UniPoly),
    AtEdge(&'a Poly<UniPoly>, &'a Rational),
    Resultant(&'a Poly<UniPoly>, &'a Poly<UniPoly>),
}

impl Projected<'_> {
    /// Square-free factors of positive degree.
    fn computed(&self, budget: &Budget) -> Result<Vec<SquareFree>, Exhausted> {
        budget.check()?;
        let of = |value: &UniPoly| budget.enter(|| SquareFree::part_of(value)).map(|part| part.into_iter().collect());
        let parts: Vec<SquareFree> = match self {
            Projected::Leading(c) => of(c)?,
            Projected::AtEdge(f, y) => of(&at_y(f, y))?,
            Projected::Resultant(f, g) => {
                let factors = resultant_square_free_decomposition(f, g, budget)?.unwrap_or_default();
                factors.into_iter().filter_map(|(q, _)| SquareFree::new(q)).collect()
            }
        };
        Ok(parts.into_iter().filter(|q| q.degree() > 0).collect())
    }
}

/// The polynomials in `x` whose zeros cut the domain into strips, coprime to their derivatives: leading
/// coefficients, discriminants and resultants in `y`, and the curves on the domain's edges. They are
/// independent of each other and distributed over the threads; their order is fixed.
pub(super) fn projection(curves: &[Curve], y_domain: &Range, budget: &Budget) -> Result<Vec<SquareFree>, Exhausted> {
    let polynomials: Vec<Poly<UniPoly>> = curves.iter().map(|c| in_y(&c.polynomial)).collect();
    let derivatives: Vec<Poly<UniPoly>> = polynomials.iter().map(Poly::derivative).collect();
    let mut wanted = Vec::new();
    for (i, f) in polynomials.iter().enumerate() {
        let (Some(degree), Some(leading)) = (f.degree(), f.leading()) else { continue };
        wanted.push(Projected::Leading(leading));
        if degree == 0 {
            continue;
        }
        if degree > 1 {
            // The discriminant times the leading coefficient.
            wanted.push(Projected::Resultant(f, &derivatives[i]));
        }
        let edges = [&y_domain.lower, &y_domain.upper].into_iter().flatten();
        wanted.extend(edges.map(|end| Projected::AtEdge(f, end)));
        let others = polynomials[..i].iter().filter(|g| g.coeffs().len() > 1);
        wanted.extend(others.map(|g| Projected::Resultant(f, g)));
    }
    let computed: Result<Vec<Vec<SquareFree>>, Exhausted> = parallel_map(&wanted, |q| q.computed(budget));
    let computed = computed?;
    let mut out: Vec<SquareFree> = Vec::new();
    for q in computed.into_iter().flatten() {
        if !out.contains(&q) {
            out.push(q);
        }
    }
    Ok(out)
}
