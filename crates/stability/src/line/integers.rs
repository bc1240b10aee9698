//! The line of a polynomial over the integers.

use super::{Common, Held, Line, Place, Ring, named_end};
use crate::interval_set::merge_points;
use crate::pair_location::complex_pair_at;
use crate::{Boundary, End, ParametricPolynomial, Range, RealInterval, Shape, StableSet, boundary_polynomials};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{RealAlgebraic, UniPoly, isolate_real_roots_in};
use jurist_algebra::real::Real;

/// The exact stable set of a loop with one parameter over an open range.
///
/// The real zeros of the [`boundary_polynomials`] cut the range into open cells; in each the root
/// count is constant, so it is taken exactly at one rational sample. Ends of stable cells are then
/// examined for all that happens there.
///
/// With the critical constraint of [JuryPavlidis1963](jurist_algebra::bibliography#jurypavlidis1963) as the
/// boundary of complex pairs, and what lies between zeros decided as in
/// [Collins1975](jurist_algebra::bibliography#collins1975).
///
/// Cost: that of [`boundary_polynomials`], one resultant; isolation of the real zeros of each, of degree up to
/// `(n - 1) d` for order `n` and coefficients of degree `d`; one [`count_roots`](crate::count_roots) in each cell
/// between them, `O(n^2)` operations on integers; and at each end of a stable interval the signs of all boundary
/// polynomials.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::poly::{Poly, UniPoly};
/// use jurist_stability::{ParametricPolynomial, Range, Shape, stable_set};
/// // z - 1 + K: stable for 0 < K < 2
/// let d = Poly::new(vec![UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[1])]);
/// let p = ParametricPolynomial::from_integral(&d, 1);
/// let set = stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// let ends = &set.intervals()[0];
/// assert_eq!(ends.lower.as_ref().unwrap().causes.to_string(), "z=1");
/// assert_eq!(ends.upper.as_ref().unwrap().causes.to_string(), "z=-1");
/// ```
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn stable_set(
    p: &ParametricPolynomial,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let Some(boundaries) = boundary_polynomials(p, region, budget)? else { return Ok(StableSet::default()) };
    budget.step("isolating the boundaries' zeros");
    let mut lists = Vec::new();
    for boundary in &boundaries {
        lists.push(isolate_real_roots_in(&boundary.polynomial, range.lower.as_ref(), range.upper.as_ref(), budget)?);
    }
    let zeros = merge_points(lists, budget)?.into_iter().map(Real::from).collect();
    let ring = Integers { p, region, boundaries: &boundaries, budget };
    Ok(Line::new(range, zeros, &ring, budget).stable_set()?.algebraic())
}

/// What happens at an end of a stable interval that was found elsewhere; `None` when the loop is stable
/// nowhere. For a value that is no limit of stable values the answer means nothing.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn end_at(
    p: &ParametricPolynomial,
    value: &RealAlgebraic,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<Option<End>, Exhausted> {
    let Some(boundaries) = boundary_polynomials(p, region, budget)? else { return Ok(None) };
    let place = Place { value: &value.clone().into(), zero: None };
    named_end(&Integers { p, region, boundaries: &boundaries, budget }, range, place, false)
}

/// A polynomial over the integers and its boundaries.
struct Integers<'a> {
    p: &'a ParametricPolynomial,
    region: Shape,
    boundaries: &'a [Boundary],
    budget: &'a Budget,
}

impl Ring for Integers<'_> {
    fn is_stable(&self, _below: usize, cell: &RealInterval) -> Result<(Option<Rational>, bool), Exhausted> {
        let sample = cell.sample(self.budget)?;
        let stable = self.budget.enter(|| self.p.is_stable_at(&sample, self.region))?;
        Ok((Some(sample), stable))
    }

    fn held(&self, place: Place<'_>) -> Result<Held, Exhausted> {
        let value = algebraic(place);
        let vanishes = |f: &UniPoly| self.budget.enter(|| value.sign_of(f).is_eq());
        // Where all coefficients vanish, or one is infinite, no root can be named.
        let has_roots = !vanishes(self.p.denominator())? && !vanishes(self.p.content())?;
        let mut causes = Vec::new();
        for boundary in self.boundaries {
            if vanishes(boundary.polynomial.poly())? {
                causes.push(boundary.cause);
            }
        }
        Ok(Held { causes, has_roots })
    }

    fn common_roots(&self, place: Place<'_>) -> Result<Common, Exhausted> {
        let pair = complex_pair_at(self.p, algebraic(place), self.region, self.budget)?;
        Ok(pair.map_or(Common::Beyond, Common::Pair))
    }
}

fn algebraic(place: Place<'_>) -> &RealAlgebraic {
    place.value.algebraic().expect("a zero of a polynomial, or a rational number")
}
