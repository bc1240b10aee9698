//! The stable set where the parameter is inside of exponentials, such as the sample time of a held plant.

use super::boundary_zeros::{Boundary, Reach, split};
use super::brackets::{Counter, looked_at};
use super::count::certain_count;
use super::outward::{Found, Looked, MULTIPLES};
use super::pair::Values;
use super::set::{OverSymbols, causes};
use super::{Condition, MOST_EXPANDED, SymbolicPolynomial};
use crate::line::{Line, Place};
use crate::{Cause, Range, Shape, StableSet, UndecidedBracket};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, to_decimal};
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::symbols::{Function, MovingSymbols};
use std::sync::Arc;

impl Values for MovingSymbols {
    fn at(&self, list: &[MultiPoly], parameter: &Ball) -> Option<Vec<Ball>> {
        self.enclose(list, parameter)
    }
}

/// As [`symbolic_stable_set`](super::symbolic_stable_set) for symbols that depend on the parameter.
pub(super) fn moving_stable_set(
    p: &SymbolicPolynomial,
    symbols: &Arc<MovingSymbols>,
    range: &Range,
    region: Shape,
    budget: &Budget,
) -> Result<StableSet, Exhausted> {
    let Some(conditions) = p.conditions(region, MOST_EXPANDED, budget)? else {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    };
    let counter = Counter::new(p, symbols, region);
    let usual = if p.usual.is_zero() { counter.scale(range) } else { p.usual.clone() };
    let Some(defined) = defined_part(symbols, range, budget)? else {
        return Ok(StableSet::from_intervals(Vec::new(), Vec::new()));
    };
    // What lies beyond a number at which functions are undefined is another question.
    let (part, beyond) = connected(symbols, &defined, &p.usual);
    let reach = match (&p.open_parts, &part.lower, &part.upper) {
        (Some(only), Some(lower), Some(upper)) => {
            Reach { only: Some(Arc::clone(only)), ..Reach::between(lower, upper) }
        }
        _ => reach(&counter, &conditions, &part, &usual, budget)?,
    };
    let (boundaries, basis) = split(conditions, symbols, budget)?;
    let (boundaries, basis) = (&boundaries[..], &basis[..]);
    let looked = Looked { boundaries, basis, symbols, usual: &usual, is_scale: p.usual.is_zero(), budget };
    let Found { reach, zeros, undecided } = looked.outward(reach)?;
    let held = |place: Place<'_>| {
        let vanishes = |boundary: &Boundary| match place.zero {
            Some(zero) => Ok(boundary.has(&zeros[zero])),
            None => {
                let value = place.value.exact().expect("an end is rational");
                symbols.may_vanish_at(&boundary.function, &value, budget)
            }
        };
        let mut held = causes(boundaries, |boundary| Ok(vanishes(boundary)?.then_some(boundary.cause)))?;
        held.retain(|cause| *cause != Cause::Undecided);
        // Several pairs may come together at the end of the range, such as at the sample time 0.
        if place.zero.is_none() && held.len() > 1 {
            held.retain(|cause| *cause != Cause::ComplexPair);
        }
        Ok(held)
    };
    let ring = OverSymbols::new(p, Arc::clone(symbols) as Arc<dyn Values>, region, &held, budget);
    let mut brackets = Vec::with_capacity(undecided.len());
    for (bracket, is_looked_at) in undecided.iter().zip(looked_at(&undecided, &p.usual)) {
        let parts = match bracket {
            // Parts that were looked at before show nothing more.
            (Some(lower), Some(upper)) if is_looked_at && p.open_parts.is_none() => {
                counter.decided(lower, upper, &p.usual, budget)?
            }
            _ => Vec::new(),
        };
        brackets.push((bracket.clone(), parts));
    }
    let values = zeros.iter().map(|z| z.value.clone()).collect();
    let reach = Range::between(reach.lower, reach.upper);
    Line { reach, brackets, beyond, ..Line::new(range, values, &ring, budget) }.stable_set()
}

/// Bounds the open ends of a range where an argument of a square root is negative beyond: the loop has no value there. `None` where it
/// has none in the whole range.
fn defined_part(symbols: &MovingSymbols, range: &Range, budget: &Budget) -> Result<Option<Range>, Exhausted> {
    let (lower, upper) = symbols.defined_between(budget)?;
    let part = Range::between(range.lower.clone().or(lower), range.upper.clone().or(upper));
    Ok((!part.is_empty()).then_some(part))
}

/// The part of a range between numbers at which an argument of a function divides by zero, where the range itself has no end, and
/// what lies beyond: near to such a number functions have zeros without end, and beyond it the loop is another one.
fn connected(symbols: &MovingSymbols, range: &Range, usual: &Rational) -> (Range, Vec<UndecidedBracket>) {
    let roots: Vec<Rational> = symbols.undefined_at().into_iter().filter(|x| range.contains(x)).collect();
    let (mut part, mut beyond) = (range.clone(), Vec::new());
    let why = |x: &Rational| {
        let x = to_decimal(x, 12);
        format!("not looked at, as functions of the loop divide by zero at {x}: give bounds of the domain")
    };
    if range.lower.is_none()
        && let Some(x) = roots.iter().filter(|x| *x < usual).max()
    {
        part.lower = Some(x.clone());
        beyond.push(UndecidedBracket::new(None, Some(x.clone()), why(x)));
    }
    if range.upper.is_none()
        && let Some(x) = roots.iter().filter(|x| *x > usual).min()
    {
        part.upper = Some(x.clone());
        beyond.push(UndecidedBracket::new(Some(x.clone()), None, why(x)));
    }
    (part, beyond)
}

/// How far a parameter goes that is not bounded: to where nothing happens any more, or, by its reciprocal, all the way, or
/// else to a large multiple of its usual value.
fn reach(
    of: &Counter<'_>,
    conditions: &[Condition],
    range: &Range,
    usual: &Rational,
    budget: &Budget,
) -> Result<Reach, Exhausted> {
    let (p, symbols, region) = (of.polynomial, of.symbols, of.region);
    let start = match &range.lower {
        Some(lower) if lower.is_zero() => Some(p.after_death(symbols, conditions, range.upper.as_ref(), budget)?),
        _ => None,
    };
    let reach = Reach::without_tail(symbols, range, start, usual, MULTIPLES[0]);
    if range.upper.is_none()
        && let Some(to) = p.tail_start(symbols, conditions, &reach.from, region, budget)?
    {
        let undecided = reach.undecided.into_iter().filter(|(_, hi)| hi.is_some()).collect();
        return Ok(Reach { to, inverted: None, upper: None, undecided, ..reach });
    }
    Ok(reach)
}

/// The values that are tried for the beginning of the tail: powers of two from this one on.
const FIRST_POWER: i64 = -40;

/// The last of them.
const LAST_POWER: i64 = 60;

impl SymbolicPolynomial {
    /// A number above `lower` from which on no root comes to the boundary, as all symbols have died away; `None` where none is
    /// found.
    ///
    /// Cost: exponentials of small matrices and a root count or a determinant for each of up to a hundred powers of two.
    fn tail_start(
        &self,
        symbols: &MovingSymbols,
        conditions: &[Condition],
        lower: &Rational,
        region: Shape,
        budget: &Budget,
    ) -> Result<Option<Rational>, Exhausted> {
        budget.step("bounding what dies away");
        let is_inside_only = self.polynomial.coeffs().iter().chain(&self.poles).all(|c| c.degree_in(0) == 0);
        for power in FIRST_POWER..=LAST_POWER {
            budget.check()?;
            let start = Rational::from(2).pow(power).expect("two is not zero");
            if start <= *lower {
                continue;
            }
            let bound = |f: &MultiPoly| symbols.beyond(f, &start);
            let certain = budget.enter(|| {
                if !is_inside_only {
                    return conditions.iter().all(|(_, f)| symbols.has_no_zero_beyond(f, &start));
                }
                let poles = self.poles.iter().all(|pole| bound(pole).is_some_and(|b| !b.contains_zero()));
                let coefficients: Option<Vec<Ball>> = self.polynomial.coeffs().iter().map(bound).collect();
                poles && coefficients.is_some_and(|c| certain_count(&c, region).is_some())
            })?;
            if certain {
                return Ok(Some(start));
            }
        }
        Ok(None)
    }

    /// The number between 0 and which nothing happens, where the symbols die away towards 0, as `exp(-T/T_m)` does with the time
    /// constant `T_m`; 0 where none is found.
    ///
    /// Cost: as of [`Self::tail_start`], in the reciprocal of the parameter.
    fn after_death(
        &self,
        symbols: &MovingSymbols,
        conditions: &[Condition],
        upper: Option<&Rational>,
        budget: &Budget,
    ) -> Result<Rational, Exhausted> {
        if symbols.at(&Rational::ZERO).is_some() {
            return Ok(Rational::ZERO);
        }
        let Some(inverted) = symbols.inverted() else { return Ok(Rational::ZERO) };
        budget.step("bounding what dies away");
        let functions: Vec<Function> = conditions.iter().map(|(_, f)| f.inverted()).collect();
        for power in 0..=LAST_POWER {
            budget.check()?;
            let start = Rational::from(2).pow(power).expect("two is not zero");
            let to = Rational::dyadic(&Integer::ONE, power.unsigned_abs());
            if upper.is_some_and(|upper| to >= *upper) {
                continue;
            }
            if budget.enter(|| functions.iter().all(|f| inverted.has_no_zero_beyond(f, &start)))? {
                return Ok(to);
            }
        }
        Ok(Rational::ZERO)
    }
}
