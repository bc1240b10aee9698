//! The exact set of stable parameter values of a loop with transcendental constants.

use super::basis::{Boundary, Split, Unexpanded, Way};
use super::moving::moving_stable_set;
use super::pair::{CommonRoots, Pair, Values};
use super::resultant::PairResultant;
use super::{MOST_EXPANDED, SymbolicPolynomial, Table};
use crate::line::{Common, Held, Line, Place, Ring};
use crate::{Cause, Range, RealInterval, Shape, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Function, SymbolicPoly, Symbols};
use std::sync::Arc;

/// The exact stable set of a loop with one parameter and transcendental constants over an open range.
///
/// As [`stable_set`](crate::stable_set): the zeros of the boundary polynomials cut the range into cells, and one
/// rational sample decides each. Zeros are isolated with enclosed coefficients; what is zero is only ever an identity. With
/// one parameter outside of all exponentials the set is always found, given the time. Where symbols depend on the parameter,
/// brackets may stay undecided in which roots touch the boundary or cross it twice, and what lies beyond a large multiple of
/// the parameter's usual value where nothing tells what happens there.
///
/// Cost: one resultant over the polynomials in the parameter and the symbols, greatest common divisors of the boundary
/// polynomials, and their zeros with more and more bits until all are told apart.
///
/// # Errors
/// [`Exhausted`] when the budget runs out, and where a zero is not proved and not disproved by some thousand bits.
pub fn symbolic_stable_set(
    p: &SymbolicPolynomial,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let symbols = match &p.symbols {
        Table::Fixed(symbols) => symbols,
        Table::Moving(symbols) => return moving_stable_set(p, symbols, range, region, budget),
    };
    if let Some(end) = &p.unstable_beyond {
        let lower = range.lower.clone().map_or_else(|| -end, |lower| lower.max(-end));
        let upper = range.upper.clone().map_or_else(|| end.clone(), |upper| upper.min(end.clone()));
        if lower >= upper {
            return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
        }
        // An expansion over coefficients of which nothing else is known would show nothing.
        let range = Range { lower: Some(lower), upper: Some(upper) };
        return set_over(p, symbols, &range, region, Way::Expanding(MOST_EXPANDED), budget);
    }
    // Zeros that coincide, or a resultant that is zero, show in its expansion.
    Way::in_order(symbols, MOST_EXPANDED, |way| set_over(p, symbols, range, region, way, budget))
}

/// The stable set of a loop whose polynomial has been split: what lies in the stable sets of all parts.
///
/// Cost: that of [`symbolic_stable_set`] for each part, the short ones first, until one is stable nowhere.
///
/// # Errors
/// As [`symbolic_stable_set`].
pub fn stable_set_of_parts(
    parts: &[SymbolicPolynomial],
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let size = |p: &&SymbolicPolynomial| p.polynomial.coeffs().iter().map(|c| c.terms().len()).sum::<usize>();
    let mut parts: Vec<&SymbolicPolynomial> = parts.iter().collect();
    parts.sort_by_key(size);
    let mut common: Option<StableSet> = None;
    for part in parts {
        let found = symbolic_stable_set(part, range, region, budget)?;
        let found = match common {
            Some(common) => common.intersection(&found, budget)?,
            None => found,
        };
        if found.is_empty() && found.undecided().is_empty() {
            return Ok(found);
        }
        common = Some(found);
    }
    Ok(common.unwrap_or_else(|| StableSet::from_intervals(Vec::new(), Vec::new())))
}

/// The stable set, found in one way.
pub(super) fn set_over(
    p: &SymbolicPolynomial,
    symbols: &Arc<Symbols>,
    range: &Range,
    region: Shape,
    way: Way,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let Some(split) = boundaries(p, symbols, region, way, budget)? else {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    };
    budget.step("isolating the boundaries' zeros");
    let zeros = split.zeros(range, budget)?;
    let held = |place: Place<'_>| {
        let vanishes = |boundary: &Boundary| match place.zero {
            Some(zero) => boundary.has(&zeros[zero], budget),
            None => boundary.condition.vanishes_at(&place.value.exact().expect("an end is rational"), budget),
        };
        causes(&split.boundaries, |boundary| Ok(vanishes(boundary)?.then_some(boundary.cause)))
    };
    let values: Vec<Real> = zeros.iter().map(|z| z.value.clone()).collect();
    let ring = OverSymbols::new(p, Arc::clone(symbols) as Arc<dyn Values>, region, &held, budget);
    Line::new(range, values, &ring, budget).stable_set()
}

/// The causes of the boundaries that hold.
pub(super) fn causes<B>(
    boundaries: &[B],
    cause: impl Fn(&B) -> Result<Option<Cause>, Exhausted>,
) -> Result<Vec<Cause>, Exhausted> {
    boundaries.iter().filter_map(|boundary| cause(boundary).transpose()).collect()
}

/// The boundary conditions that hold at a place.
pub(super) type HeldAt<'a> = dyn Fn(Place<'_>) -> Result<Vec<Cause>, Exhausted> + 'a;

/// A loop over symbols, whatever they depend on.
pub(super) struct OverSymbols<'a> {
    p: &'a SymbolicPolynomial,
    region: Shape,
    held: &'a HeldAt<'a>,
    common: Option<CommonRoots>,
    budget: &'a Budget,
}

impl<'a> OverSymbols<'a> {
    pub fn new(
        p: &'a SymbolicPolynomial,
        values: Arc<dyn Values>,
        region: Shape,
        held: &'a HeldAt<'a>,
        budget: &'a Budget,
    ) -> Self {
        let common = (p.formal_degree > 1).then(|| CommonRoots::new(Arc::new(Pair::of(&p.pair(region))), values));
        OverSymbols { p, region, held, common, budget }
    }
}

impl Ring for OverSymbols<'_> {
    fn is_stable(&self, _below: usize, cell: &RealInterval) -> Result<(Option<Rational>, bool), Exhausted> {
        let sample = cell.sample(self.budget)?;
        let stable = self.p.at(&sample, self.region, self.budget)?.is_stable(self.p.formal_degree);
        Ok((Some(sample), stable))
    }

    fn held(&self, place: Place<'_>) -> Result<Held, Exhausted> {
        let causes = (self.held)(place)?;
        // Where a pole is, no root can be named.
        Ok(Held { has_roots: !causes.contains(&Cause::Pole), causes })
    }

    fn common_roots(&self, place: Place<'_>) -> Result<Common, Exhausted> {
        self.common.as_ref().map_or(Ok(Common::Unknown), |common| common.at(place.value, self.budget))
    }
}

/// The boundary conditions and the pairwise coprime polynomials they are made of; `None` where the loop is stable nowhere.
fn boundaries(
    p: &SymbolicPolynomial,
    symbols: &Arc<Symbols>,
    region: Shape,
    way: Way,
    budget: &Budget,
) -> Result<Option<Split>, Exhausted> {
    let Some(conditions) = p.conditions(region, way.most_expanded(), budget)? else { return Ok(None) };
    let mut expanded: Vec<(Cause, SymbolicPoly)> = Vec::new();
    let mut enclosed: Vec<(Cause, Arc<dyn Unexpanded>)> = Vec::new();
    for (cause, function) in conditions {
        budget.check()?;
        match function {
            Function::Polynomial(mut polynomial) => {
                if let Way::OverNumbers = way {
                    polynomial = symbols.square_free_part(&polynomial, budget)?;
                }
                let Some(polynomial) = SymbolicPoly::new(&polynomial, symbols, budget)? else { return Ok(None) };
                expanded.push((cause, polynomial));
            }
            Function::Resultant { .. } => {
                let pair = Arc::new(Pair::of(&p.pair(region)));
                enclosed
                    .push((cause, Arc::new(PairResultant::new(&pair, symbols, p.unstable_beyond.is_some(), budget)?)));
            }
        }
    }
    way.split(expanded, enclosed, symbols, budget).map(Some)
}
