//! The exact set of stable parameter values of a loop with transcendental constants.

use super::basis::{Boundary, Split, Unexpanded, Way, Zero};
use super::moving::moving_stable_set;
use super::pair::{Common, CommonRoots, Pair, Values};
use super::resultant::PairResultant;
use super::{MOST_EXPANDED, SymbolicPolynomial, Table};
use crate::{AtPoint, Cause, Causes, End, Range, RealInterval, Shape, StableInterval, StableSet};
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
    let common = (p.formal_degree > 1).then(|| {
        let pair = Arc::new(Pair::of(&p.pair(region)));
        CommonRoots::new(pair, Arc::clone(symbols) as Arc<dyn Values>)
    });
    let examiner = Examiner { p, range, boundaries: &split.boundaries, common, budget };
    let values = zeros.iter().map(|z| z.value.clone()).collect();
    let at = |sample: &Rational| p.at(sample, region, budget);
    let end = |place: Place<'_>, is_between: bool| match place {
        Place::Domain(value) => examiner.at_domain(value).map(Some),
        Place::Zero(k) => examiner.at_zero(&zeros[k], is_between),
    };
    let intervals = intervals(range, values, p.formal_degree(), at, end, budget)?;
    Ok(StableSet::from_intervals(intervals, Vec::new()))
}

/// What a cell ends at.
pub(super) enum Place<'a> {
    /// The domain.
    Domain(&'a Real),
    /// The zero of this number.
    Zero(usize),
}

/// The stable intervals: the zeros cut the range into cells, each of which is decided by `at` a sample; `end` says what
/// happens at an end of a stable cell, `None` where it is none after all between two of them.
pub(super) fn intervals(
    range: &Range,
    zeros: Vec<Real>,
    degree: usize,
    mut at: impl FnMut(&Rational) -> Result<AtPoint, Exhausted>,
    end: impl Fn(Place<'_>, bool) -> Result<Option<End>, Exhausted>,
    budget: &Budget,
) -> Result<Vec<StableInterval>, Exhausted> {
    budget.step("testing a sample of each cell");
    let bound = |bound: &Option<Rational>| bound.clone().map(Real::from);
    let mut ends: Vec<Option<Real>> = vec![bound(&range.lower)];
    ends.extend(zeros.into_iter().map(Some));
    ends.push(bound(&range.upper));
    let mut stable = Vec::with_capacity(ends.len());
    for (i, cell) in ends.windows(2).enumerate() {
        budget.advance(i as u64, ends.len() as u64 - 1);
        let sample = sample(cell, budget)?;
        let found = at(&sample)?;
        stable.push(matches!(found, AtPoint::Defined { count, infinite: 0 } if count.inside == degree));
    }
    budget.step("what happens at each end");
    let mut intervals: Vec<StableInterval> = Vec::new();
    // Whether the interval before goes on in this cell, as nothing happens between them.
    let mut goes_on = false;
    for i in (0..stable.len()).filter(|&i| stable[i]) {
        let find = |k: usize| -> Result<Option<End>, Exhausted> {
            match &ends[k] {
                None => Ok(None),
                Some(value) if k == 0 || k == ends.len() - 1 => end(Place::Domain(value), false),
                Some(_) => end(Place::Zero(k - 1), stable[k - 1] && stable[k]),
            }
        };
        let upper = find(i + 1)?;
        let is_joined = upper.is_none() && stable.get(i + 1) == Some(&true);
        if goes_on {
            if let Some(last) = intervals.last_mut() {
                last.upper = upper;
            }
        } else {
            let shared = i > 0 && stable[i - 1];
            let lower = if shared { intervals.last().and_then(|l| l.upper.clone()) } else { find(i)? };
            intervals.push(StableInterval::new(lower, upper));
        }
        goes_on = is_joined;
    }
    Ok(intervals)
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
                enclosed.push((cause, Arc::new(PairResultant::new(&pair, symbols, budget)?)));
            }
        }
    }
    way.split(expanded, enclosed, symbols, budget).map(Some)
}

/// A rational number inside of a cell.
pub(super) fn sample(cell: &[Option<Real>], budget: &Budget) -> Result<Rational, Exhausted> {
    RealInterval { lower: cell[0].clone(), upper: cell[1].clone() }.sample(budget)
}

/// Finds out what happens at an end of a stable cell.
struct Examiner<'a> {
    p: &'a SymbolicPolynomial,
    range: &'a Range,
    boundaries: &'a [Boundary],
    common: Option<CommonRoots>,
    budget: &'a Budget,
}

impl Examiner<'_> {
    /// At an end of the domain, which is rational.
    fn at_domain(&self, value: &Real) -> Result<End, Exhausted> {
        let exact = value.exact().expect("an end of the range is rational");
        let mut zero = Vec::new();
        for boundary in self.boundaries {
            zero.push(boundary.condition.vanishes_at(&exact, self.budget)?);
        }
        let end = self.end(value, &zero, false)?;
        Ok(end.unwrap_or_else(|| End::new(value.clone(), Causes::default(), None)))
    }

    /// At a zero of the boundary polynomials; `None` where nothing happens that matters between two stable cells.
    fn at_zero(&self, zero: &Zero, is_between: bool) -> Result<Option<End>, Exhausted> {
        let vanishes = self.boundaries.iter().map(|boundary| boundary.has(zero, self.budget));
        let vanishes = vanishes.collect::<Result<Vec<bool>, Exhausted>>()?;
        self.end(&zero.value, &vanishes, is_between)
    }

    fn end(&self, value: &Real, vanishes: &[bool], is_between: bool) -> Result<Option<End>, Exhausted> {
        let held: Vec<Cause> =
            self.boundaries.iter().zip(vanishes).filter(|(_, v)| **v).map(|(b, _)| b.cause).collect();
        named_end(value, &held, self.range, is_between, || self.common_root(value))
    }

    fn common_root(&self, value: &Real) -> Result<Common, Exhausted> {
        assert!(self.p.formal_degree >= 2);
        match &self.common {
            Some(common) => common.at(value, self.budget),
            None => Ok(Common::Unknown),
        }
    }
}

/// The end at which these boundary conditions hold; `None` where nothing happens between two stable cells.
pub(super) fn named_end(
    value: &Real,
    held: &[Cause],
    range: &Range,
    is_between: bool,
    common_root: impl FnOnce() -> Result<Common, Exhausted>,
) -> Result<Option<End>, Exhausted> {
    let mut causes = Causes::default();
    let mut pair = None;
    let is_defined = !held.contains(&Cause::Pole);
    for &cause in held {
        match cause {
            Cause::ComplexPair => {}
            Cause::RootAtOne | Cause::RootAtMinusOne | Cause::RootAtZero if !is_defined => {}
            cause => causes.insert(cause),
        }
    }
    if is_defined && held.contains(&Cause::ComplexPair) {
        match common_root()? {
            Common::Pair(found) => {
                pair = Some(found);
                causes.insert(Cause::ComplexPair);
            }
            Common::Beyond => {}
            // A double root at an end of the boundary is named by its own cause.
            Common::Unknown if causes.iter().next().is_some() => {}
            Common::Unknown => causes.insert(Cause::ComplexPair),
        }
    }
    let is_end = |end: &Option<Rational>| end.is_some() && *end == value.exact();
    if is_end(&range.lower) || is_end(&range.upper) {
        causes.insert(Cause::Domain);
    }
    if is_between && causes.iter().next().is_none() {
        return Ok(None);
    }
    Ok(Some(End::new(value.clone(), causes, pair)))
}
