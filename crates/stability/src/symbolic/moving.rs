//! The stable set where the parameter is inside of exponentials, such as the sample time of a held plant.

use super::boundary_zeros::{Boundary, Bracket, Reach, Zero, split};
use super::brackets::{Counter, Decided, looked_at};
use super::count::certain_count;
use super::outward::{Found, Looked, MULTIPLES};
use super::pair::{Common, CommonRoots, Pair, Values};
use super::set::{Place, intervals, named_end};
use super::{Condition, MOST_EXPANDED, SymbolicPolynomial};
use crate::{Cause, Causes, End, Range, Shape, StableInterval, StableSet, UndecidedBracket};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational, to_decimal};
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::real::Real;
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
    // What lies beyond a number at which functions are undefined is another question.
    let (part, beyond) = connected(symbols, range, &p.usual);
    let reach = reach(p, symbols, &conditions, &part, region, &usual, budget)?;
    let (boundaries, basis) = split(conditions, symbols, budget)?;
    let (boundaries, basis) = (&boundaries[..], &basis[..]);
    let looked = Looked { boundaries, basis, symbols, usual: &usual, is_scale: p.usual.is_zero(), budget };
    let Found { reach, zeros, undecided } = looked.outward(reach)?;
    let common = (p.formal_degree > 1).then(|| {
        let pair = Arc::new(Pair::of(&p.pair(region)));
        CommonRoots::new(pair, Arc::clone(symbols) as Arc<dyn Values>)
    });
    let examiner = Examiner { symbols, range, boundaries, common, budget };
    let is_looked_at = looked_at(&undecided, &p.usual);
    let mut stable = Assembly::default();
    let mut lower = reach.lower.clone();
    // After the last bracket there is one more piece.
    let brackets = undecided.iter().zip(is_looked_at).map(Some).chain([None]);
    for bracket in brackets {
        let is_looked_at = bracket.is_some_and(|(_, is_looked_at)| is_looked_at);
        let bracket = bracket.map(|(bracket, _)| bracket);
        let upper = bracket.map_or_else(|| reach.upper.clone(), |b| b.0.clone());
        let is_piece = match (&lower, &upper) {
            (Some(lower), Some(upper)) => lower < upper,
            // A bracket without a lower end begins before everything.
            (None, None) => bracket.is_none(),
            _ => bracket.is_none_or(|b| b.0.is_some()),
        };
        if is_piece {
            let piece = Range::between(lower.clone(), upper);
            let inside = |z: &&Zero| {
                piece.lower.as_ref().is_none_or(|x| z.value.compare_rational(x).is_gt())
                    && piece.upper.as_ref().is_none_or(|x| z.value.compare_rational(x).is_lt())
            };
            let zeros: Vec<&Zero> = zeros.iter().filter(inside).collect();
            let values = zeros.iter().map(|z| z.value.clone()).collect();
            let at = |sample: &Rational| p.at(sample, region, budget);
            let end = |place: Place<'_>, is_between: bool| match place {
                Place::Domain(value) => {
                    let exact = value.exact();
                    let is_beside = undecided.iter().any(|b| exact.is_some() && (exact == b.0 || exact == b.1));
                    match is_beside {
                        true => Ok(Some(End::new(value.clone(), Causes::default(), None))),
                        false => examiner.at_domain(value).map(Some),
                    }
                }
                Place::Zero(k) => examiner.at_zero(zeros[k], is_between),
            };
            for interval in intervals(&piece, values, p.formal_degree(), at, end, budget)? {
                stable.push(interval);
            }
        }
        let Some(bracket) = bracket else { break };
        let known = match bracket {
            (Some(lo), Some(hi)) if is_looked_at => counter.decided(lo, hi, &p.usual, budget)?,
            _ => Vec::new(),
        };
        stable.bracket(bracket, known);
        lower = bracket.1.clone();
        if lower.is_none() {
            break;
        }
    }
    let brackets = stable.open.into_iter().map(|(lo, hi)| {
        let why = match (&lo, &hi) {
            (Some(lo), Some(_)) if lo.is_zero() && part.lower.as_ref().is_some_and(Rational::is_zero) => {
                "not resolved so near to 0"
            }
            (Some(_), Some(_)) => "touching or crossing",
            _ => "not resolved so far out: give bounds of the domain",
        };
        UndecidedBracket::new(lo, hi, why)
    });
    let mut brackets: Vec<UndecidedBracket> = brackets.collect();
    brackets.extend(beyond);
    brackets.sort_by(|a, b| a.lower.cmp(&b.lower));
    Ok(StableSet::from_intervals(stable.intervals, brackets))
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

/// The stable intervals from below, and what is left of the brackets between them.
#[derive(Default)]
struct Assembly {
    intervals: Vec<StableInterval>,
    open: Vec<Bracket>,
    /// A number at which the loop is known to be stable: an interval that ends there goes on.
    joint: Option<Rational>,
}

impl Assembly {
    fn push(&mut self, interval: StableInterval) {
        let exact = |end: &Option<End>| end.as_ref().and_then(|end| end.value.exact());
        match self.intervals.last_mut() {
            Some(last)
                if self.joint.is_some() && exact(&last.upper) == self.joint && exact(&interval.lower) == self.joint =>
            {
                last.upper = interval.upper;
            }
            _ => self.intervals.push(interval),
        }
    }

    /// A bracket, of which parts are known.
    fn bracket(&mut self, bracket: &Bracket, known: Vec<Decided>) {
        let mut lower = bracket.0.clone();
        // An infinite end is never reached.
        let mut is_open = true;
        for Decided { lower: lo, upper: hi, is_stable } in known {
            if lower.as_ref() != Some(&lo) {
                self.open.push((lower, Some(lo.clone())));
            }
            is_open = bracket.1.as_ref() != Some(&hi);
            lower = Some(hi.clone());
            if is_stable {
                let end = |x: &Rational| Some(End::new(x.clone(), Causes::default(), None));
                self.joint = Some(lo.clone());
                self.push(StableInterval::new(end(&lo), end(&hi)));
                self.joint = Some(hi);
            }
        }
        if is_open {
            self.open.push((lower, bracket.1.clone()));
        }
    }
}

/// How far a parameter goes that is not bounded: to where nothing happens any more, or, by its reciprocal, all the way, or
/// else to a large multiple of its usual value.
fn reach(
    p: &SymbolicPolynomial,
    symbols: &Arc<MovingSymbols>,
    conditions: &[Condition],
    range: &Range,
    region: Shape,
    usual: &Rational,
    budget: &Budget,
) -> Result<Reach, Exhausted> {
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

/// Finds out what happens at an end of a stable cell.
struct Examiner<'a> {
    symbols: &'a Arc<MovingSymbols>,
    range: &'a Range,
    boundaries: &'a [Boundary],
    common: Option<CommonRoots>,
    budget: &'a Budget,
}

impl Examiner<'_> {
    fn at_domain(&self, value: &Real) -> Result<End, Exhausted> {
        let exact = value.exact().expect("an end of the range is rational");
        let mut held = Vec::new();
        for boundary in self.boundaries {
            if self.symbols.may_vanish_at(&boundary.function, &exact, self.budget)? {
                held.push(boundary.cause);
            }
        }
        // Several pairs may come together at the end of the range, such as at the sample time 0.
        let pair = || match held.as_slice() {
            [Cause::ComplexPair] => self.common_root(value),
            _ => Ok(Common::Beyond),
        };
        let end = named_end(value, &held, self.range, false, pair)?;
        Ok(end.unwrap_or_else(|| End::new(value.clone(), Causes::default(), None)))
    }

    fn at_zero(&self, zero: &Zero, is_between: bool) -> Result<Option<End>, Exhausted> {
        let mut held = Vec::new();
        for boundary in self.boundaries {
            if boundary.has(zero) {
                held.push(boundary.cause);
            }
        }
        named_end(&zero.value, &held, self.range, is_between, || self.common_root(&zero.value))
    }

    fn common_root(&self, value: &Real) -> Result<Common, Exhausted> {
        match &self.common {
            Some(common) => common.at(value, self.budget),
            None => Ok(Common::Unknown),
        }
    }
}
