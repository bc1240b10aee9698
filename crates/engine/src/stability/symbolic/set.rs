//! The exact set of stable parameter values of a loop with transcendental constants.

use super::moving::moving_stable_set;
use super::pair::{Common, CommonRoots, Pair, Values};
use super::resultant::PairResultant;
use super::{MOST_EXPANDED, SymbolicPolynomial, Table};
use crate::stability::{AtPoint, Cause, Causes, End, Range, Shape, StableInterval, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::multivariate::are_coprime_in;
use jurist_algebra::poly::{Domain, MultiPoly, isolate_real_roots_in};
use jurist_algebra::real::{Real, rational_between};
use jurist_algebra::symbols::{EnclosedPoly, Function, SymbolicPoly, Symbols, enclosed_roots, merged};
use std::sync::Arc;

/// A polynomial in the parameter whose coefficients are numbers.
enum Condition {
    /// A polynomial over symbols.
    Symbolic(SymbolicPoly),
    /// A resultant that is not expanded.
    Resultant(Arc<PairResultant>),
}

impl Condition {
    fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        match self {
            Condition::Symbolic(p) => p.vanishes_at(x, budget),
            Condition::Resultant(p) if x.is_zero() => Ok(p.vanishes_at_zero()),
            Condition::Resultant(p) => p.vanishes_at(x, budget),
        }
    }

    fn roots(&self, range: &Range, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        let (lower, upper) = (range.lower.as_ref(), range.upper.as_ref());
        let p = match self {
            Condition::Symbolic(p) => return p.real_roots_in(lower, upper, budget),
            Condition::Resultant(p) => p,
        };
        let mut found = enclosed_roots(&(Arc::clone(p) as Arc<dyn EnclosedPoly>), lower, upper, budget)?;
        let inside = lower.is_none_or(Rational::is_negative) && upper.is_none_or(|u| u.sign().is_gt());
        if p.vanishes_at_zero() && inside {
            found = merged(found, vec![Real::from(Rational::ZERO)], budget)?;
        }
        Ok(found)
    }
}

/// A boundary condition and the polynomials it is made of.
struct Boundary {
    cause: Cause,
    condition: Condition,
    /// Which polynomials of the basis divide it.
    parts: Vec<usize>,
}

/// The boundary conditions, and the pairwise coprime polynomials they are made of.
type Split = (Vec<Boundary>, Vec<Condition>);

/// A zero of the boundary polynomials, and from which polynomial of the basis it comes.
struct Zero {
    value: Real,
    parts: Vec<usize>,
}

/// The exact stable set of a loop with one parameter and transcendental constants over an open range.
///
/// As [`stable_set`](crate::stability::stable_set): the zeros of the boundary polynomials cut the range into cells, and one
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
    match set_over(p, symbols, range, region, MOST_EXPANDED, budget) {
        // Zeros that coincide, or a resultant that is zero, show in its expansion.
        Err(stopped) if stopped.budget.starts_with("precision") => {
            set_over(p, symbols, range, region, u64::MAX, budget)
        }
        found => found,
    }
}

/// The stable set; resultants with no more than `most` terms are expanded.
pub(super) fn set_over(
    p: &SymbolicPolynomial,
    symbols: &Arc<Symbols>,
    range: &Range,
    region: Shape,
    most: u64,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let Some(found) = boundaries(p, symbols, region, most, budget)? else {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    };
    let (boundaries, basis) = found;
    budget.step("isolating the boundaries' zeros");
    let zeros = zeros(&boundaries, &basis, range, budget)?;
    let common = (p.formal_degree > 1).then(|| {
        let pair = Arc::new(Pair::of(&p.pair(region)));
        CommonRoots::new(pair, Arc::clone(symbols) as Arc<dyn Values>)
    });
    let examiner = Examiner { p, range, boundaries: &boundaries, common, budget };
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
    most: u64,
    budget: &Budget,
) -> Result<Option<Split>, Exhausted> {
    let Some(conditions) = p.conditions(region, most, budget)? else { return Ok(None) };
    let mut found: Vec<(Cause, SymbolicPoly)> = Vec::new();
    let mut resultant = None;
    for (cause, function) in conditions {
        budget.check()?;
        match function {
            Function::Polynomial(polynomial) => {
                let Some(polynomial) = SymbolicPoly::new(&polynomial, symbols, budget)? else { return Ok(None) };
                found.push((cause, polynomial));
            }
            Function::Resultant { .. } => {
                let pair = Arc::new(Pair::of(&p.pair(region)));
                resultant = Some((cause, Arc::new(PairResultant::new(&pair, symbols, budget)?)));
            }
        }
    }
    let rests: Vec<MultiPoly> = found.iter().map(|(_, b)| b.rest().clone()).collect();
    let basis = budget.enter(|| coprime(&rests, &[0]))?;
    let mut boundaries = Vec::with_capacity(found.len());
    for (cause, polynomial) in found {
        let divides = |part: &MultiPoly| {
            polynomial.rest() == part
                || (!are_coprime_in(polynomial.rest(), part, 0) && polynomial.rest().gcd(part).degree_in(0) > 0)
        };
        let parts = budget.enter(|| (0..basis.len()).filter(|&k| divides(&basis[k])).collect())?;
        boundaries.push(Boundary { cause, condition: Condition::Symbolic(polynomial), parts });
    }
    let mut parts = Vec::with_capacity(basis.len());
    for part in &basis {
        // A factor of a polynomial whose content is not zero has none that is.
        let Some(part) = SymbolicPoly::new(part, symbols, budget)? else { return Ok(None) };
        parts.push(Condition::Symbolic(part));
    }
    if let Some((cause, resultant)) = resultant {
        boundaries.push(Boundary {
            cause,
            condition: Condition::Resultant(Arc::clone(&resultant)),
            parts: vec![parts.len()],
        });
        parts.push(Condition::Resultant(resultant));
    }
    Ok(Some((boundaries, parts)))
}

/// Square-free, pairwise coprime polynomials of which all given ones, square-free themselves, are products, as far as factors
/// are concerned in which one of `unknowns` occurs.
pub(super) fn coprime(polynomials: &[MultiPoly], unknowns: &[usize]) -> Vec<MultiPoly> {
    let varies = |p: &MultiPoly| unknowns.iter().any(|&j| p.degree_in(j) > 0);
    let mut basis: Vec<MultiPoly> = Vec::new();
    for p in polynomials {
        let mut part = p.clone();
        let mut k = 0;
        while k < basis.len() && varies(&part) {
            if !unknowns.iter().all(|&j| are_coprime_in(&part, &basis[k], j)) {
                let common = part.gcd(&basis[k]).primitive_over_integers();
                if varies(&common) {
                    let rest = basis[k].div_exact(&common).expect("a gcd divides");
                    part = part.div_exact(&common).expect("a gcd divides");
                    basis[k] = common;
                    if varies(&rest) {
                        basis.push(rest);
                    }
                }
            }
            k += 1;
        }
        if varies(&part) {
            basis.push(part);
        }
    }
    basis
}

/// All zeros in the range, ascending.
fn zeros(boundaries: &[Boundary], basis: &[Condition], range: &Range, budget: &Budget) -> Result<Vec<Zero>, Exhausted> {
    let (lower, upper) = (range.lower.as_ref(), range.upper.as_ref());
    let mut all: Vec<Real> = Vec::new();
    for boundary in boundaries {
        let Condition::Symbolic(polynomial) = &boundary.condition else { continue };
        let roots = isolate_real_roots_in(polynomial.algebraic(), lower, upper, budget)?;
        all = merged(all, roots.into_iter().map(Real::from).collect(), budget)?;
    }
    let mut from: Vec<(usize, Real)> = Vec::new();
    for (k, part) in basis.iter().enumerate() {
        let roots = part.roots(range, budget)?;
        from.extend(roots.iter().map(|root| (k, root.clone())));
        all = merged(all, roots, budget)?;
    }
    let part_of = |value: &Real| from.iter().filter(|(_, root)| root.is_same(value)).map(|(k, _)| *k).collect();
    Ok(all.into_iter().map(|value| Zero { parts: part_of(&value), value }).collect())
}

/// A rational number inside of a cell.
fn sample(cell: &[Option<Real>], budget: &Budget) -> Result<Rational, Exhausted> {
    match cell {
        [Some(lower), Some(upper)] => Ok(rational_between(lower, upper, budget)?.expect("the ends differ")),
        [Some(lower), None] => budget.enter(|| lower.rational_above()),
        [None, Some(upper)] => budget.enter(|| upper.rational_below()),
        _ => Ok(Rational::ZERO),
    }
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
        let mut vanishes = Vec::new();
        for boundary in self.boundaries {
            let by_part = boundary.parts.iter().any(|k| zero.parts.contains(k));
            let by_root = match (&boundary.condition, zero.value.algebraic()) {
                (Condition::Symbolic(p), Some(x)) => x.sign_of(p.algebraic().poly()).is_eq(),
                _ => false,
            };
            let by_value = match zero.value.exact() {
                Some(exact) if !by_part && !by_root => boundary.condition.vanishes_at(&exact, self.budget)?,
                _ => false,
            };
            vanishes.push(by_part || by_root || by_value);
        }
        self.end(&zero.value, &vanishes, is_between)
    }

    fn end(&self, value: &Real, vanishes: &[bool], is_between: bool) -> Result<Option<End>, Exhausted> {
        let held: Vec<Cause> =
            self.boundaries.iter().zip(vanishes).filter(|(_, v)| **v).map(|(b, _)| b.cause).collect();
        named_end(value, &held, self.range, is_between, || self.common_root(value))
    }

    fn common_root(&self, value: &Real) -> Result<Common, Exhausted> {
        debug_assert!(self.p.formal_degree >= 2);
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
