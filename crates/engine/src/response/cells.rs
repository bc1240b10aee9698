//! A stable interval cut into cells in each of which every requirement is met everywhere or nowhere.

use super::boundaries::Boundaries;
use super::family::Family;
use super::met::AtPoint;
use super::requirement::{Requirement, Rule};
use super::{RequiredEnd, RequiredInterval, RequiredSet};
use crate::error::Error;
use crate::stability::{Bracket, Cause, End, RealInterval, StableInterval, UndecidedBracket};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{RealAlgebraic, SquareFree, UniPoly, isolate_real_roots};
use jurist_algebra::real::Real;
use std::slice::from_ref;

/// What is asked in each cell.
pub(super) struct Cells<'a> {
    pub requirements: &'a [Requirement],
    pub boundaries: &'a [Boundaries<UniPoly>],
    pub family: &'a Family<UniPoly>,
    pub budget: &'a Budget,
}

impl Cells<'_> {
    /// The names of what is not met at a stable value.
    fn unmet(&self, value: &Rational) -> Result<Unmet, Error> {
        let open_loop = self.family.at(from_ref(value));
        let mut out = Vec::new();
        let mut at = AtPoint::new(&open_loop);
        for requirement in self.requirements {
            if !at.meets(requirement, self.budget)? {
                out.push(requirement.name());
            }
        }
        Ok(out)
    }

    /// The parts of a stable interval in which everything is met.
    pub fn within(&self, interval: &StableInterval) -> Result<Vec<RequiredInterval>, Error> {
        let zeros = self.zeros_inside(&interval.bare())?;
        let is_closed = |i: usize, names: &[&'static str]| self.is_closed(&zeros[i], names);
        required_parts(interval, &zeros, |value| self.unmet(value), is_closed, self.budget)
    }

    /// Where a requirement may begin or cease to be met, strictly inside of an interval, ascending.
    fn zeros_inside(&self, interval: &RealInterval) -> Result<Vec<Real>, Exhausted> {
        let mut zeros: Vec<RealAlgebraic> = Vec::new();
        for f in self.boundaries.iter().flat_map(|b| &b.zeros) {
            let Some(f) = self.budget.enter(|| SquareFree::part_of(f))? else { continue };
            zeros.extend(isolate_real_roots(&f, self.budget)?);
        }
        self.budget.enter(|| {
            zeros.sort_by(RealAlgebraic::compare);
            zeros.dedup_by(|a, b| a.compare(b).is_eq());
        })?;
        let all: Vec<Real> = zeros.into_iter().map(Real::from).collect();
        let mut out = Vec::with_capacity(all.len());
        for x in all {
            if interval.has_inside(&x, self.budget)? {
                out.push(x);
            }
        }
        Ok(out)
    }

    /// Whether at a zero beyond which some are not met all are met yet. The distance to a circle and a damping are continuous where the
    /// loop is stable, and so is a phase margin unless a crossing appears; a gain margin asks for stability at its own ends too.
    fn is_closed(&self, zero: &Real, names: &[&'static str]) -> Result<bool, Error> {
        let unmet = |r: &Requirement| names.contains(&r.name());
        let mut closed = true;
        for (requirement, boundary) in self.requirements.iter().zip(self.boundaries).filter(|(r, _)| unmet(r)) {
            closed &= match requirement.rule() {
                Rule::Factors(_) => false,
                Rule::Turned { .. } => {
                    let touches = |x: &RealAlgebraic| x.sign_of(&boundary.touches).is_eq();
                    !self.budget.enter(|| zero.algebraic().is_some_and(touches))?
                }
                Rule::Circle(_) | Rule::Sector(_) | Rule::Modulus { .. } | Rule::DeadTime(_) => true,
            };
        }
        Ok(closed)
    }
}

/// The names of the requirements that are not met.
pub(super) type Unmet = Vec<&'static str>;

/// The values strictly inside of a stable interval.
pub(super) fn inside_of(interval: &StableInterval, values: &[Real], budget: &Budget) -> Result<Vec<Real>, Exhausted> {
    let bare = interval.bare();
    let mut out = Vec::with_capacity(values.len());
    for value in values {
        if bare.has_inside(value, budget)? {
            out.push(value.clone());
        }
    }
    Ok(out)
}

/// The parts of a stable interval beside brackets in which it is not told what is met: `cells` decides what lies between them.
pub(super) fn parts_beside(
    interval: &StableInterval,
    mut brackets: Vec<UndecidedBracket>,
    found: &mut RequiredSet,
    cells: impl Fn(&StableInterval) -> Result<Vec<RequiredInterval>, Error>,
) -> Result<(), Error> {
    brackets.retain(|b| {
        let begins = |lo: &Rational| interval.upper.as_ref().is_none_or(|end| end.value.compare_rational(lo).is_gt());
        let ends = |hi: &Rational| interval.lower.as_ref().is_none_or(|end| end.value.compare_rational(hi).is_lt());
        b.lower.as_ref().is_none_or(begins) && b.upper.as_ref().is_none_or(ends)
    });
    let mut lower = interval.lower.clone();
    for bracket in brackets {
        if let Some(below) = &bracket.lower
            && is_between(below, lower.as_ref(), interval.upper.as_ref())
        {
            let part = StableInterval::new(lower.clone(), Some(edge(below)));
            found.intervals.extend(cells(&part)?);
        }
        let above = bracket.upper.clone();
        found.undecided.push(bracket);
        match &above {
            Some(above) if is_between(above, lower.as_ref(), interval.upper.as_ref()) => lower = Some(edge(above)),
            Some(above) if interval.upper.as_ref().is_none_or(|u| u.value.compare_rational(above).is_gt()) => {}
            _ => return Ok(()),
        }
    }
    found.intervals.extend(cells(&StableInterval::new(lower, interval.upper.clone()))?);
    Ok(())
}

/// A rational number beyond an end of an interval: one that is not rational lies strictly inside.
pub(super) fn outward(end: &Option<End>, is_lower: bool) -> Option<Rational> {
    let (lo, hi) = end.as_ref()?.value.refined_to_digits(9).enclosure();
    Some(if is_lower { lo } else { hi })
}

/// A large value on the side without an end of an interval with one end, up to which parts of it are asked.
pub(super) fn beyond(end: Option<&Rational>, nominal: Option<&Rational>) -> Option<Rational> {
    let nominal = nominal.cloned().unwrap_or(Rational::ONE).abs();
    Some(&end?.abs().max(nominal).max(Rational::dyadic(&Integer::ONE, 64)) * &Rational::from(FARTHEST))
}

/// So many times the nominal value is far for an interval without an end.
const FARTHEST: i64 = 1 << 10;

pub(super) fn edge(x: &Rational) -> End {
    End::new(Real::from(x.clone()), Cause::Undecided.into(), None)
}

fn is_between(x: &Rational, lower: Option<&End>, upper: Option<&End>) -> bool {
    lower.is_none_or(|end| end.value.compare_rational(x).is_lt())
        && upper.is_none_or(|end| end.value.compare_rational(x).is_gt())
}

/// The parts of a stable interval in which everything is met, from one sample of each cell between neighbouring candidates.
///
/// `unmet` has the names of what is not met at a value; `is_closed` tells whether at a candidate, of which the number is given, all is
/// met yet when these are not met beyond.
pub(super) fn required_parts<U, C>(
    interval: &StableInterval,
    candidates: &[Real],
    unmet: U,
    is_closed: C,
    budget: &Budget,
) -> Result<Vec<RequiredInterval>, Error>
where
    U: Fn(&Rational) -> Result<Unmet, Error>,
    C: Fn(usize, &[&'static str]) -> Result<bool, Error>,
{
    let (lower, upper) = (kept_end(&interval.lower, &unmet)?, kept_end(&interval.upper, &unmet)?);
    if let (Some(a), Some(b)) = (&lower, &upper)
        && a.value.is_same(&b.value)
    {
        return Ok(single_value([lower, upper]).into_iter().collect());
    }
    let sample = |cell: RealInterval| {
        budget.check()?;
        unmet(&cell.sample(budget)?)
    };
    let cells = interval.bare().cut(candidates).into_iter().map(sample).collect::<Result<Vec<Unmet>, Error>>()?;
    let mut out: Vec<RequiredInterval> = Vec::new();
    let stability = |end: &Option<End>| end.clone().map(RequiredEnd::Stability);
    let binding = |i: usize, names: &[&'static str]| -> Result<RequiredEnd, Error> {
        let (value, closed) = (candidates[i].clone(), is_closed(i, names)?);
        Ok(RequiredEnd::Requirement { value, names: names.to_vec(), closed })
    };
    let mut begun: Option<Option<RequiredEnd>> = cells[0].is_empty().then(|| stability(&lower));
    for (i, value) in candidates.iter().enumerate() {
        let (before, after) = (&cells[i], &cells[i + 1]);
        match (before.is_empty(), after.is_empty()) {
            (true, false) => {
                let upper = Some(binding(i, after)?);
                out.push(RequiredInterval { lower: begun.take().expect("an interval has begun"), upper });
            }
            (false, true) => begun = Some(Some(binding(i, before)?)),
            (true, true) => {
                // A rational value between two cells is decided like any other.
                let names = value.exact().map(|value| unmet(&value)).transpose()?.unwrap_or_default();
                if !names.is_empty() {
                    let end = RequiredEnd::Requirement { value: value.clone(), names, closed: false };
                    let lower = begun.replace(Some(end.clone())).expect("an interval has begun");
                    out.push(RequiredInterval { lower, upper: Some(end) });
                }
            }
            (false, false) => {
                // Roots that only touch the edge from outside meet a closed requirement at one value.
                if let Some(exact) = value.exact()
                    && unmet(&exact)?.is_empty()
                {
                    let end = RequiredEnd::Requirement { value: value.clone(), names: after.clone(), closed: true };
                    out.push(RequiredInterval { lower: Some(end.clone()), upper: Some(end) });
                }
            }
        }
    }
    if let Some(lower) = begun {
        out.push(RequiredInterval { lower, upper: stability(&upper) });
    }
    Ok(out)
}

/// An interval of one value, if all is met there.
fn single_value(ends: [Option<End>; 2]) -> Option<RequiredInterval> {
    let [lower, upper] = ends.map(|end| end.map(RequiredEnd::Stability));
    let is_met = matches!(&lower, Some(RequiredEnd::Stability(end)) if end.closed);
    is_met.then_some(RequiredInterval { lower, upper })
}

/// An end that is stable itself is kept where all is met there, too.
fn kept_end(end: &Option<End>, unmet: impl Fn(&Rational) -> Result<Unmet, Error>) -> Result<Option<End>, Error> {
    let Some(end) = end else { return Ok(None) };
    let exact = end.value.exact().filter(|_| end.closed);
    let closed = exact.map(|x| unmet(&x)).transpose()?.is_some_and(|names| names.is_empty());
    Ok(Some(end.clone().closed_if(closed)))
}

/// Bits of the bracket around a number that is not told from an end.
const BRACKET_BITS: u64 = 256;

/// A bracket around a number that is not told from another one.
pub(super) fn around(x: &Real) -> Bracket {
    let width = Rational::dyadic(&Integer::ONE, BRACKET_BITS);
    let (lo, hi) = x.refined(&width).enclosure();
    (Some(lo - &width), Some(hi + &width))
}
