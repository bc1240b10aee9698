//! The middle of the values of one gain, exactly: of each interval `(a, b)` of its set the middle and the tolerance are functions of both ends.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::centre::Measure;
use crate::lines::Lines;
use crate::one_gain::{GAIN, nothing};
use crate::sets::{inner, names, point_inside};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{
    Domain, Poly, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots, resultant_square_free_decomposition,
};
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::response::{RequiredEnd, RequiredInterval};
use std::cmp::Ordering;

/// Digits of what is enclosed only.
const DIGITS: usize = 30;

/// The middle with the largest tolerance.
///
/// # Errors
/// As `Lines::set`.
pub(crate) fn best(lines: &Lines<'_>, measure: Measure) -> Result<Outcome, Error> {
    let set = lines.set(GAIN, None, None)?.into_value();
    if let Some(nothing) = nothing(&set) {
        return Ok(nothing);
    }
    let mut best: Option<Middle> = None;
    for interval in &set.intervals {
        lines.budget.step("the middle of an interval");
        let middle = Middle::of(interval, measure, lines.budget)?;
        if best.as_ref().is_none_or(|known| middle.is_better(known)) {
            best = Some(middle);
        }
    }
    let best = best.expect("the set is not empty");
    // What is open may belong to an interval and make it longer.
    let stopped = set.undecided.first().map(|bracket| {
        jurist_algebra::limits::Exhausted::by_method(bracket.why.clone(), "gains beyond those that are found")
    });
    let value = if stopped.is_some() { Best::Nothing } else { best.value };
    let optimum = Optimum::new(value, best.at, vec![best.found], best.least);
    Ok(Optimum { attained: None, binding: best.binding, stopped, ..optimum }.into())
}

/// The middle of an interval.
struct Middle {
    value: Best,
    at: Vec<Place>,
    found: Rational,
    /// A tolerance that the gain that is found has.
    least: Option<Rational>,
    binding: Vec<String>,
}

impl Middle {
    fn of(interval: &RequiredInterval, measure: Measure, budget: &Budget) -> Result<Middle, Error> {
        let ends = [&interval.lower, &interval.upper].map(|end| end.as_ref().map(RequiredEnd::value));
        let unbounded = |at: Vec<Place>| Middle {
            value: Best::Unbounded,
            at,
            found: point_inside(interval),
            least: None,
            binding: Vec::new(),
        };
        let side = |end: &Option<Real>| end.as_ref().map(Real::sign);
        let (below, above) = (side(&ends[0]), side(&ends[1]));
        // As near to zero as one likes a gain has any share of itself.
        let reaches_zero = match measure {
            Measure::Absolute => false,
            Measure::Relative => below.is_none_or(|s| s.is_lt()) && above.is_none_or(|s| s.is_gt()),
            Measure::Ratio => below.is_none_or(|s| s.is_le()) && above.is_none_or(|s| s.is_ge()),
        };
        if reaches_zero {
            return Ok(unbounded(Vec::new()));
        }
        let (Some(lower), Some(upper)) = (&interval.lower, &interval.upper) else {
            return Ok(match measure {
                // Far away the whole of a gain may be lost.
                Measure::Relative => {
                    Middle { value: Best::Exact(Rational::ONE.into()), ..unbounded(vec![Place::Unbounded]) }
                }
                Measure::Absolute | Measure::Ratio => unbounded(vec![Place::Unbounded]),
            });
        };
        let [a, b] = [lower, upper].map(RequiredEnd::value);
        let (Some(low), Some(high)) = inner(interval) else { return Ok(unbounded(Vec::new())) };
        let middle = enclosed(Which::Middle, measure, [&low, &high]);
        let found = within(&middle, measure, [&low, &high]);
        let least = least_of(&found, measure, [&low, &high]);
        let (value, at) = match (&a, &b) {
            (Real::Algebraic(a), Real::Algebraic(b)) => {
                let exact = |which| of_ends(which, measure, [a, b], budget);
                let at = Real::from(exact(Which::Middle)?);
                let has_zero = a.sign().is_eq() || b.sign().is_eq();
                (
                    Best::Exact(exact(Which::Tolerance)?.into()),
                    all_to_zero(at, has_zero && measure == Measure::Relative),
                )
            }
            _ => {
                let ends = [&a, &b].map(|end| end.refined_to_digits(DIGITS).enclosure());
                let [(a0, a1), (b0, b1)] = &ends;
                let [x, y] = [[a0, b0], [a1, b1]].map(|ends| enclosed(Which::Middle, measure, ends)[0].clone());
                let most = enclosed(Which::Tolerance, measure, [a0, b1])[1].clone();
                (Best::Between([least.clone(), most]), Place::Between([x.clone().min(y.clone()), x.max(y)]))
            }
        };
        let mut binding: Vec<String> = [lower, upper].into_iter().flat_map(names).collect();
        binding.sort();
        binding.dedup();
        Ok(Middle { value, at: vec![at], found, least: Some(least), binding })
    }

    fn is_better(&self, other: &Middle) -> bool {
        match (&self.value, &other.value) {
            (_, Best::Unbounded) => false,
            (Best::Unbounded, _) => true,
            (Best::Exact(Real::Algebraic(a)), Best::Exact(Real::Algebraic(b))) => a.compare(b) == Ordering::Greater,
            _ => self.least > other.least,
        }
    }
}

/// The middle, or all gains from it to zero: the whole of each may be lost.
fn all_to_zero(middle: Real, is_all: bool) -> Place {
    if !is_all {
        return Place::Exact(middle);
    }
    let (low, high) = middle.refined_to_digits(DIGITS).enclosure();
    Place::From(match low.is_negative() {
        true => (Some(low), Some(Rational::ZERO)),
        false => (Some(Rational::ZERO), Some(high)),
    })
}

/// A function of both ends.
#[derive(Clone, Copy)]
enum Which {
    Middle,
    Tolerance,
}

/// Two numbers between which a function of both ends lies, these being numbers; one number but for a root.
fn enclosed(which: Which, measure: Measure, [a, b]: [&Rational; 2]) -> [Rational; 2] {
    let half = Rational::new(1.into(), 2.into());
    let divided = |x: Rational, y: Rational| x.checked_div(&y).expect("zero is not between the ends");
    let both = |x: Rational| [x.clone(), x];
    match (which, measure) {
        (Which::Middle, Measure::Relative | Measure::Absolute) => both((a + b) * half),
        (Which::Tolerance, Measure::Absolute) => both((b - a) * half),
        (Which::Tolerance, Measure::Relative) => both(divided(b - a, (a + b).abs())),
        (Which::Middle, Measure::Ratio) => {
            let [low, high] = root(&(a * b));
            if b.sign().is_gt() { [low, high] } else { [-high, -low] }
        }
        (Which::Tolerance, Measure::Ratio) => {
            let [less, more] = if b.sign().is_gt() { [a, b] } else { [b, a] };
            root(&divided(more.clone(), less.clone()))
        }
    }
}

/// The root of a positive number between two decimals.
fn root(x: &Rational) -> [Rational; 2] {
    let square = UniPoly::new(vec![-x.numerator(), 0.into(), x.denominator()]);
    let part = SquareFree::part_of(&square).expect("it is a square less a number");
    let roots = isolate_real_roots(&part, &Budget::unlimited()).expect("there is no budget");
    let (low, high) = roots.last().expect("the number is positive").refined_to_digits(DIGITS).enclosure();
    [low, high]
}

/// A short number near to a middle.
fn within([low, high]: &[Rational; 2], measure: Measure, [a, b]: [&Rational; 2]) -> Rational {
    let tiny = least_of(low, measure, [a, b]).abs().min(b - a) * Rational::new(1.into(), (1 << 20).into());
    jurist_algebra::poly::simplest_between(&(low - &tiny), &(high + &tiny)).unwrap_or_else(|| low.clone())
}

/// The tolerance of a gain between two others.
fn least_of(gain: &Rational, measure: Measure, [a, b]: [&Rational; 2]) -> Rational {
    let size = gain.abs();
    let share = |x: Rational| x.checked_div(&size).unwrap_or(Rational::ZERO);
    let below = gain - a;
    let above = b - gain;
    match measure {
        Measure::Absolute => below.min(above),
        Measure::Relative => share(below.min(above)),
        Measure::Ratio => {
            let up = if gain.is_negative() { share(a.abs()) } else { share(b.clone()) };
            let inner = if gain.is_negative() { b.abs() } else { a.clone() };
            up.min(size.checked_div(&inner).unwrap_or(Rational::ONE))
        }
    }
}

/// A function of two algebraic ends, exactly: a root of the resultant of both polynomials, the second one in the first end and the value.
fn of_ends(
    which: Which,
    measure: Measure,
    [a, b]: [&RealAlgebraic; 2],
    budget: &Budget,
) -> Result<RealAlgebraic, Error> {
    if let (Some(a), Some(b)) = (a.exact(), b.exact())
        && measure != Measure::Ratio
    {
        return Ok(RealAlgebraic::from_rational(enclosed(which, measure, [&a, &b])[0].clone()));
    }
    let is_positive = b.sign().is_gt();
    let in_value = |all: &[i64]| UniPoly::from_i64(all);
    let line = |constant: &[i64], slope: &[i64]| Poly::new(vec![in_value(constant), in_value(slope)]);
    // The second end as a quotient, in the first end (x) and the value (y).
    let [above, below] = match (which, measure) {
        (Which::Middle, Measure::Relative | Measure::Absolute) => [line(&[0, 2], &[-1]), line(&[1], &[0])],
        (Which::Tolerance, Measure::Absolute) => [line(&[0, 2], &[1]), line(&[1], &[0])],
        // b - a = y (a + b), or y (-a - b).
        (Which::Tolerance, Measure::Relative) if is_positive => [line(&[0], &[1, 1]), line(&[1, -1], &[0])],
        (Which::Tolerance, Measure::Relative) => [line(&[0], &[1, -1]), line(&[1, 1], &[0])],
        (Which::Middle, Measure::Ratio) => [line(&[0, 0, 1], &[0]), line(&[0], &[1])],
        (Which::Tolerance, Measure::Ratio) if is_positive => [line(&[0], &[0, 0, 1]), line(&[1], &[0])],
        (Which::Tolerance, Measure::Ratio) => [line(&[0], &[1]), line(&[0, 0, 1], &[0])],
    };
    let degree = b.polynomial().degree().unwrap_or(0);
    let constant = |c: jurist_algebra::number::Integer| Poly::new(vec![UniPoly::new(vec![c])]);
    let mut second = Poly::new(Vec::new());
    for k in 0..=degree {
        let mut term = constant(b.polynomial().coeff(k));
        for j in 0..degree {
            term = term.times(if j < k { &above } else { &below });
        }
        second = second.plus(&term);
    }
    let first = a.polynomial().map(|c| UniPoly::new(vec![c.clone()]));
    let factors = resultant_square_free_decomposition(&first, &second, budget)?.unwrap_or_default();
    let mut roots: Vec<RealAlgebraic> = Vec::new();
    for (factor, _) in factors {
        let Some(part) = SquareFree::part_of(&factor) else { continue };
        roots.extend(isolate_real_roots(&part, budget)?);
    }
    let mut digits = DIGITS;
    loop {
        budget.check()?;
        let [(a0, a1), (b0, b1)] = [a, b].map(|end| end.refined_to_digits(digits).enclosure());
        let corners = [[&a0, &b0], [&a0, &b1], [&a1, &b0], [&a1, &b1]];
        let all: Vec<Rational> = corners.into_iter().flat_map(|ends| enclosed(which, measure, ends)).collect();
        let (low, high) = (all.iter().min().expect("four corners"), all.iter().max().expect("four corners"));
        let mut inside = roots.iter().filter(|x| x.compare_rational(low).is_ge() && x.compare_rational(high).is_le());
        if let (Some(only), None) = (inside.next(), inside.next()) {
            return Ok(only.clone());
        }
        digits *= 2;
    }
}
