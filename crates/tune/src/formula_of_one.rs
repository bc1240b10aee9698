//! The best value of an expression of one gain. Between its poles, the zeros of its slope and the ends of the set it rises or falls, so its best value is
//! at one of these *marks*, or a limit there.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::asked::Objective;
use crate::formula::Formula;
use crate::lines::Lines;
use crate::near::toward;
use crate::one_gain::{GAIN, nothing};
use crate::sets::{bound_of, is_closed, names};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{
    Domain, MultiPoly, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots,
    resultant_square_free_decomposition,
};
use jurist_algebra::real::{Real, rational_between};
use jurist_engine::error::Error;
use jurist_engine::response::{RequiredEnd, RequiredInterval, RequiredSet};
use std::cmp::Ordering;

/// The best value of an expression of one gain.
///
/// # Errors
/// As `Lines::set`.
pub(crate) fn best(lines: &Lines<'_>, formula: &Formula) -> Result<Outcome, Error> {
    let is_greatest = matches!(lines.asked.objective, Objective::Formula { is_greatest: true, .. });
    let set = lines.set(GAIN, None, None)?.into_value();
    if let Some(nothing) = nothing(&set) {
        return Ok(nothing);
    }
    lines.budget.step("values at the ends of the set and where the slope is zero");
    let of_one = OfOne::new(lines, formula, is_greatest);
    let mut best: Option<Candidate> = None;
    for interval in &set.intervals {
        for candidate in of_one.candidates(interval)? {
            if best.as_ref().is_none_or(|known| of_one.is_better(&candidate, known)) {
                best = Some(candidate);
            }
        }
    }
    let best = best.expect("between two marks the expression goes towards one of them");
    let value = formula.at(std::slice::from_ref(&best.found)).expect("poles are marks");
    let stopped = of_one.open(&set, &value);
    let optimum = match best.height {
        _ if stopped.is_some() => Best::Nothing,
        Height::Exact(x) => Best::Exact(x.into()),
        Height::Unbounded => Best::Unbounded,
        Height::Between(end) => Best::Between([value.clone(), end]),
    };
    let optimum = Optimum::new(optimum, vec![best.place], vec![best.found], Some(value));
    Ok(Optimum { attained: best.attained, binding: best.binding, stopped, ..optimum }.into())
}

/// A mark at which the best value may be.
struct Candidate {
    height: Height,
    place: Place,
    attained: Option<bool>,
    binding: Vec<String>,
    /// A gain of the set near to it.
    found: Rational,
}

/// A value of the expression, or the limit of its values.
enum Height {
    Exact(RealAlgebraic),
    /// Of a gain that is known by its enclosures only: no value near to it is better than this.
    Between(Rational),
    /// It grows without end, in the sense that is asked for.
    Unbounded,
}

/// A place from which, and to which, the expression only rises or falls.
enum Mark<'i> {
    Infinite,
    End(&'i RequiredEnd),
    Inside(RealAlgebraic),
}

/// Digits of a gain that is known by its enclosures only, and of the gain that is found near to a mark.
const DIGITS: usize = 30;
const FEW: usize = 6;

/// A gain beyond all marks is gone away from by so many times its size.
const FAR: i64 = 1000;

/// An expression of one gain, as a quotient.
struct OfOne<'l, 'a> {
    lines: &'l Lines<'a>,
    formula: &'l Formula,
    is_greatest: bool,
    above: UniPoly,
    below: UniPoly,
}

impl<'l, 'a> OfOne<'l, 'a> {
    fn new(lines: &'l Lines<'a>, formula: &'l Formula, is_greatest: bool) -> OfOne<'l, 'a> {
        let [above, below] = formula.parts().map(|p: &MultiPoly| p.to_univariate(GAIN).expect("one gain is free"));
        OfOne { lines, formula, is_greatest, above, below }
    }

    /// Whether a value that compares so with another one is better.
    fn is_good(&self, order: Ordering) -> bool {
        order == if self.is_greatest { Ordering::Greater } else { Ordering::Less }
    }

    /// Whether a candidate is better, or as good and attained where the other one is not.
    fn is_better(&self, a: &Candidate, b: &Candidate) -> bool {
        let order = match (&a.height, &b.height) {
            (_, Height::Unbounded) => return false,
            (Height::Unbounded, _) => return true,
            (Height::Exact(x), Height::Exact(y)) => x.compare(y),
            (Height::Exact(x), Height::Between(y)) => x.compare_rational(y),
            (Height::Between(x), Height::Exact(y)) => y.compare_rational(x).reverse(),
            (Height::Between(x), Height::Between(y)) => x.cmp(y),
        };
        self.is_good(order) || (order.is_eq() && a.attained == Some(true) && b.attained != Some(true))
    }

    /// Where the best value of an interval of the set may be.
    fn candidates(&self, interval: &RequiredInterval) -> Result<Vec<Candidate>, Error> {
        let mut marks = vec![interval.lower.as_ref().map_or(Mark::Infinite, Mark::End)];
        marks.extend(self.inside(interval)?.into_iter().map(Mark::Inside));
        marks.push(interval.upper.as_ref().map_or(Mark::Infinite, Mark::End));
        let mut out = Vec::new();
        for pair in marks.windows(2) {
            let between = self.between(&pair[0], &pair[1])?;
            out.extend(self.candidate((&pair[0], false), &between)?);
            out.extend(self.candidate((&pair[1], true), &between)?);
        }
        Ok(out)
    }

    /// The poles of the expression and the zeros of its slope strictly inside of an interval, ascending.
    fn inside(&self, interval: &RequiredInterval) -> Result<Vec<RealAlgebraic>, Error> {
        let slope = self.above.derivative().times(&self.below).minus(&self.above.times(&self.below.derivative()));
        let Some(part) = SquareFree::part_of(&slope.times(&self.below)) else { return Ok(Vec::new()) };
        let is_on_side = |x: &RealAlgebraic, end: &Option<RequiredEnd>, side: Ordering| -> Result<bool, Error> {
            let Some(end) = end else { return Ok(true) };
            Ok(end.value().compare(&x.clone().into(), self.lines.budget)? == side)
        };
        let mut out = Vec::new();
        for x in isolate_real_roots(&part, self.lines.budget)? {
            if is_on_side(&x, &interval.lower, Ordering::Less)? && is_on_side(&x, &interval.upper, Ordering::Greater)? {
                out.push(x);
            }
        }
        Ok(out)
    }

    /// A number between two marks.
    fn between(&self, low: &Mark<'_>, high: &Mark<'_>) -> Result<Rational, Error> {
        Ok(match (real(low), real(high)) {
            (Some(low), Some(high)) => {
                rational_between(&low, &high, self.lines.budget)?.expect("an interval of a set is no point")
            }
            (Some(low), None) => low.rational_above() + Rational::ONE,
            (None, Some(high)) => high.rational_below() - Rational::ONE,
            (None, None) => Rational::ZERO,
        })
    }

    /// The value at a mark, or its limit from the side of a number; `None` where it falls without end.
    fn candidate(&self, (mark, is_upper): (&Mark<'_>, bool), between: &Rational) -> Result<Option<Candidate>, Error> {
        let Some(place) = real(mark) else { return Ok(self.limit(between, is_upper)) };
        let unmet = |height: Height| Candidate {
            height,
            place: Place::Exact(place.clone()),
            attained: Some(false),
            binding: Vec::new(),
            found: between.clone(),
        };
        let near = toward(&place, between, FEW);
        let height = match &place {
            Real::Algebraic(x) if x.sign_of(&self.below).is_eq() => {
                return Ok(self.is_good(self.order(&near, between)).then(|| unmet(Height::Unbounded)));
            }
            Real::Algebraic(x) => Height::Exact(self.value_at(x)?),
            Real::Transcendental(_) => {
                let (low, high) = place.refined_to_digits(DIGITS).enclosure();
                let Some([low, high]) = self.formula.range(&[[low, high]]) else {
                    let why = "the expression has a pole at the end of the set, or very near to it";
                    return Err(Exhausted::by_method(why, "the best value of the expression").into());
                };
                Height::Between(if self.is_greatest { high } else { low })
            }
        };
        let (attained, binding) = match mark {
            Mark::End(end) => self.at_end(end)?,
            _ => (true, Vec::new()),
        };
        let found = place.exact().filter(|_| attained).unwrap_or(near);
        Ok(Some(Candidate { attained: Some(attained), binding, found, ..unmet(height) }))
    }

    /// Whether the end of a set is in it, and what binds there.
    fn at_end(&self, end: &RequiredEnd) -> Result<(bool, Vec<String>), Error> {
        let gain = &self.lines.asked.gains[GAIN];
        let value = end.value().exact();
        let attained = match &value {
            Some(value) => self.lines.is_met(&[(gain.name.clone(), value.clone())], None)?,
            None => is_closed(end),
        };
        let is_bound = value.is_some_and(|value| gain.bounds.iter().flatten().any(|bound| *bound == value));
        Ok((attained, if is_bound { vec![bound_of(&gain.name)] } else { names(end) }))
    }

    /// The limit as the gain grows without end, from a number on; `None` where it falls without end.
    fn limit(&self, from: &Rational, is_upper: bool) -> Option<Candidate> {
        let degree = |p: &UniPoly| p.degree().unwrap_or(0);
        // Far away the values are near to the limit.
        let by = Rational::from(FAR) * (from.abs() + Rational::ONE);
        let far = if is_upper { from + &by } else { from - &by };
        let height = match degree(&self.above).cmp(&degree(&self.below)) {
            Ordering::Greater => self.is_good(self.order(&far, from)).then_some(Height::Unbounded)?,
            order => {
                let [p, q] = [&self.above, &self.below].map(|p| Rational::from(p.coeff(degree(p))));
                let limit = p.checked_div(&q).filter(|_| order.is_eq()).unwrap_or(Rational::ZERO);
                Height::Exact(RealAlgebraic::from_rational(limit))
            }
        };
        let (place, binding) = (Place::Unbounded, Vec::new());
        Some(Candidate { height, place, attained: Some(false), binding, found: far })
    }

    /// How the values at two numbers compare, no pole being between them.
    fn order(&self, a: &Rational, b: &Rational) -> Ordering {
        let value = |x: &Rational| self.formula.at(std::slice::from_ref(x)).expect("poles are marks");
        value(a).cmp(&value(b))
    }

    /// The value at an algebraic number that is no pole.
    fn value_at(&self, x: &RealAlgebraic) -> Result<RealAlgebraic, Error> {
        if let Some(x) = x.exact() {
            let value = self.formula.at(&[x]).expect("it is no pole");
            return Ok(RealAlgebraic::from_rational(value));
        }
        let budget = self.lines.budget;
        // All y with p(x) = y q(x) for a root x.
        let constant = |p: &UniPoly, k: usize| UniPoly::new(vec![p.coeff(k)]);
        let roots = Poly::new((0..x.polynomial().coeffs().len()).map(|k| constant(x.polynomial(), k)).collect());
        let count = self.above.coeffs().len().max(self.below.coeffs().len());
        let in_value = |k: usize| UniPoly::new(vec![self.above.coeff(k), -self.below.coeff(k)]);
        let line = Poly::new((0..count).map(in_value).collect());
        let factors = resultant_square_free_decomposition(&roots, &line, budget)?.unwrap_or_default();
        let mut values: Vec<RealAlgebraic> = Vec::new();
        for (factor, _) in factors {
            let part = SquareFree::new(factor).expect("factors are square-free");
            values.extend(isolate_real_roots(&part, budget)?);
        }
        let mut digits = DIGITS;
        loop {
            budget.check()?;
            let (low, high) = x.refined_to_digits(digits).enclosure();
            if let Some([low, high]) = self.formula.range(&[[low, high]]) {
                let is_inside = |value: &&RealAlgebraic| {
                    value.compare_rational(&low).is_ge() && value.compare_rational(&high).is_le()
                };
                let mut inside = values.iter().filter(is_inside);
                if let (Some(only), None) = (inside.next(), inside.next()) {
                    return Ok(only.clone());
                }
            }
            digits *= 2;
        }
    }

    /// Why gains of which it is not known whether they meet all may have better values; `None` where there are none.
    fn open(&self, set: &RequiredSet, found: &Rational) -> Option<Exhausted> {
        let is_open = |sides: [Rational; 2]| match self.formula.range(&[sides]) {
            Some([low, high]) => self.is_good(if self.is_greatest { &high } else { &low }.cmp(found)),
            None => true,
        };
        let bracket = set.undecided.iter().find(|bracket| match (&bracket.lower, &bracket.upper) {
            (Some(low), Some(high)) => is_open([low.clone(), high.clone()]),
            _ => true,
        })?;
        Some(Exhausted::by_method(bracket.why.clone(), "gains beyond those that are found"))
    }
}

/// The number of a mark.
fn real(mark: &Mark<'_>) -> Option<Real> {
    match mark {
        Mark::Infinite => None,
        Mark::End(end) => Some(end.value()),
        Mark::Inside(x) => Some(x.clone().into()),
    }
}
