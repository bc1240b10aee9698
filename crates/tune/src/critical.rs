//! Critical values: heights between which nothing begins and nothing ends, and places above which a curve turns or meets another one.

use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in,
    resultant_square_free_decomposition,
};
use jurist_stability::Range;
use jurist_stability::plane::{coprime_polynomials, critical_polynomials};
use std::cmp::Ordering;

/// The variable of the height, and that of the place.
const HEIGHT: usize = 0;
const PLACE: usize = 1;

/// Curves in height and place, square-free and coprime.
pub(crate) struct Curves {
    curves: Vec<MultiPoly>,
}

impl Curves {
    pub fn new(all: &[MultiPoly], budget: &Budget) -> Result<Curves, Exhausted> {
        Ok(Curves { curves: coprime_polynomials(all, budget)? })
    }

    /// The critical heights strictly between two numbers, `None` being infinity, ascending.
    pub fn heights(
        &self,
        places: &Range,
        ends: [Option<&Rational>; 2],
        budget: &Budget,
    ) -> Result<Vec<RealAlgebraic>, Exhausted> {
        let polynomials = critical_polynomials(&self.curves, places, budget)?;
        roots(&polynomials, ends, budget)
    }

    /// The places at which a curve has an extreme height or meets another one, strictly inside of a range, ascending.
    pub fn places(&self, range: &Range, budget: &Budget) -> Result<Vec<RealAlgebraic>, Exhausted> {
        // As polynomials in the height over those in the place.
        let over = |f: &MultiPoly| -> Poly<UniPoly> {
            f.as_poly_in(HEIGHT).map(|c| c.to_univariate(PLACE).expect("two variables"))
        };
        let mut found: Vec<UniPoly> = Vec::new();
        for (i, f) in self.curves.iter().enumerate() {
            let in_height = over(f);
            if in_height.is_constant() {
                found.push(in_height.coeff(0));
                continue;
            }
            let slope = over(&f.derivative(PLACE));
            for other in std::iter::once(slope).chain(self.curves[..i].iter().map(over)) {
                budget.check()?;
                if other.is_zero() || other.is_constant() {
                    found.extend((!other.is_zero()).then(|| other.coeff(0)));
                    continue;
                }
                let factors = resultant_square_free_decomposition(&in_height, &other, budget)?.unwrap_or_default();
                found.extend(factors.into_iter().map(|(factor, _)| factor));
            }
        }
        roots(&found, [range.lower.as_ref(), range.upper.as_ref()], budget)
    }
}

/// All roots strictly between two numbers, ascending, each once.
fn roots(
    polynomials: &[UniPoly],
    [low, high]: [Option<&Rational>; 2],
    budget: &Budget,
) -> Result<Vec<RealAlgebraic>, Exhausted> {
    let mut out: Vec<RealAlgebraic> = Vec::new();
    for polynomial in polynomials.iter().filter(|p| !p.is_constant()) {
        budget.check()?;
        let Some(part) = budget.enter(|| SquareFree::part_of(polynomial))? else { continue };
        out.extend(isolate_real_roots_in(&part, low, high, budget)?);
    }
    budget.enter(|| {
        out.sort_by(RealAlgebraic::compare);
        out.dedup_by(|a, b| a.compare(b) == Ordering::Equal);
    })?;
    Ok(out)
}
