//! Certificates of a gain beside dead time: between the values at which roots are on the axis, how many are to the right.

use super::no_certificate;
use super::statement::{about, number, object, region, set};
use super::text::to_text;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::simplest_between;
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, PointVerdict};
use jurist_engine::problem::{BaseDelay, DelayedLoop, Problem};
use jurist_model::error::Error;
use jurist_stability::dead_time::{GainLoop, GainPoint, Happening, NotCounted, NotSolved, gain_cells};
use jurist_stability::{Range, StableSet};
use serde_json::Value;

/// The schema of certificates of cells.
const SCHEMA: &str = "jurist/certificate/6";

/// Bits of the checkers' enclosures.
const BITS: u64 = 256;

/// Gaps around ends are about as narrow as this digit.
const DIGITS: usize = 12;

/// The same where roots meet on the axis or only touch it: the checkers' first-order enclosures need parts of the axis there that are as
/// many as the gap is narrow.
const WIDE_DIGITS: usize = 3;

/// The certificate of the root counts in the cells of a parameter.
pub(super) fn of_set(answer: &Answer<StableSet>, delayed: &DelayedLoop, budget: &Budget) -> Result<String, Error> {
    let problem = answer.problem();
    let BaseDelay::Number(tau) = delayed.delay() else { unreachable!("a fixed dead time") };
    let not_yet = "no certificate: beside a fixed dead time only a parameter that enters as a factor has one";
    let gain = delayed.gain_loop().filter(|_| delayed.decay().is_zero() && delayed.degree_in_parameter() == 1);
    let gain = gain.ok_or_else(|| no_certificate(not_yet))?;
    let (range, scale) = looked_at(answer, problem);
    let mut cells = match gain_cells(&gain, &range, budget) {
        Ok(Ok(cells)) => cells,
        Err(NotSolved::NotCounted(NotCounted::Stopped(stopped))) => return Err(stopped.into()),
        Ok(Err(_)) | Err(_) => return Err(no_certificate(not_yet)),
    };
    cells.cut_at_poles(delayed.poles(), &range, budget)?;
    // What ends a cell: the domain, roots on the axis, and where the loop is undefined.
    let end = |end: &Option<Rational>| Real::from(end.clone().expect("both ends are there"));
    let simple = |value: Real, right: Option<usize>| Limit { value, right, digits: DIGITS };
    let mut ends: Vec<Limit> = vec![simple(end(&range.lower), None)];
    for (point, right) in cells.points.iter().zip(&cells.right) {
        let digits = if is_singular(point, &gain, tau) { WIDE_DIGITS } else { DIGITS };
        ends.push(Limit { value: point.value.clone(), right: *right, digits });
    }
    ends.push(simple(end(&range.upper), cells.right.last().copied().flatten()));
    let mut list = Vec::new();
    for pair in ends.windows(2) {
        budget.check()?;
        let Some(right) = pair[1].right else { continue };
        let (_, lower) = budget.enter(|| pair[0].gap(&scale))?;
        let (upper, _) = budget.enter(|| pair[1].gap(&scale))?;
        // Two ends may be nearer than their gaps are wide.
        if lower < upper {
            let between = Value::Array(vec![number(&lower), number(&upper)]);
            list.push(object([("between", between), ("right", right.into())]));
        }
    }
    if list.is_empty() {
        return Err(no_certificate(not_yet));
    }
    let statement = object([
        ("kind", "cells".into()),
        ("time", problem.time().name().into()),
        ("parameter", problem.parameter().name.as_str().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("cells", Value::Array(list)),
    ]);
    certificate(problem, statement, tau)
}

/// The certificate of a point at which no root is on the axis.
pub(super) fn of_verdict(answer: &Answer<PointVerdict>, delayed: &DelayedLoop) -> Result<String, Error> {
    let (problem, verdict) = (answer.problem(), answer.value());
    let right = verdict.delayed.filter(|roots| roots.on == 0).and_then(|roots| roots.right);
    let (BaseDelay::Number(tau), Some(right), true) = (delayed.delay(), right, delayed.decay().is_zero()) else {
        let message = "no certificate: of a loop with dead time the count of roots to the right has one, none of them on the axis";
        return Err(no_certificate(message));
    };
    let statement = object([
        ("kind", "verdict".into()),
        ("time", problem.time().name().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("verdict", verdict.verdict.name().into()),
        ("right", right.into()),
    ]);
    certificate(problem, statement, tau)
}

fn certificate(problem: &Problem, statement: Value, tau: &Rational) -> Result<String, Error> {
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about(problem)?),
        ("statement", statement),
        ("bits", BITS.into()),
        ("delay", number(tau)),
    ])))
}

/// The part of the domain that is spoken of, twice as far as the largest limit where it has no end, and the size of the limits.
fn looked_at(answer: &Answer<StableSet>, problem: &Problem) -> (Range, Rational) {
    let free = problem.parameter();
    let ends = answer.value().intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten();
    let of_end = |end: &jurist_stability::End| {
        let (lo, hi) = end.value.refined_to_digits(2).enclosure();
        lo.abs().max(hi.abs())
    };
    let scale = ends.filter(|end| end.value.exact().is_none_or(|x| !x.is_zero())).map(of_end).max();
    let scale = scale.into_iter().chain(free.nominal.as_ref().map(Rational::abs)).max();
    let scale = scale.filter(|s| !s.is_zero()).unwrap_or(Rational::ONE);
    let far = Rational::from((&scale + &scale).ceil());
    let domain = &free.domain;
    let upper = domain.upper.clone().unwrap_or_else(|| match &domain.lower {
        Some(lower) if *lower >= far => lower + &far,
        _ => far.clone(),
    });
    let lower = domain.lower.clone().unwrap_or_else(|| if upper <= -&far { &upper - &far } else { -far });
    (Range::between(Some(lower), Some(upper)), scale)
}

/// What ends a cell.
struct Limit {
    value: Real,
    /// The roots to the right in the cell below.
    right: Option<usize>,
    /// How narrow the gap around it is.
    digits: usize,
}

impl Limit {
    /// Short numbers a little below and a little above.
    fn gap(&self, scale: &Rational) -> (Rational, Rational) {
        let unit = Rational::new(Integer::ONE, Integer::from(10).pow(self.digits as u64));
        let (lo, hi, size) = match self.value.exact() {
            Some(x) => (x.clone(), x.clone(), if x.is_zero() { scale.clone() } else { x.abs() }),
            None => {
                let (lo, hi) = self.value.refined_to_digits(DIGITS).enclosure();
                let size = lo.abs().max(hi.abs());
                (lo, hi, size)
            }
        };
        let width = size * unit;
        let short = |a: Rational, b: Rational| simplest_between(&a, &b).expect("an interval with numbers inside");
        let twice = &width + &width;
        (short(&lo - &twice, &lo - &width), short(&hi + &width, &hi + &twice))
    }
}

/// Whether two roots meet at `s = 0`, or roots only touch the axis.
fn is_singular(point: &GainPoint, gain: &GainLoop, tau: &Rational) -> bool {
    if point.change == Some(0) {
        return !matches!(point.happening, Happening::Pole);
    }
    let Some(p) = point.value.exact().and_then(|x| gain.at(&x)) else { return false };
    let (mut value, mut slope) = (Rational::ZERO, Rational::ZERO);
    for (k, part) in p.parts().iter().enumerate() {
        let delay = Rational::from(k as u64) * tau;
        value += &Rational::from(part.coeff(0));
        slope += &(Rational::from(part.coeff(1)) - delay * Rational::from(part.coeff(0)));
    }
    value.is_zero() && slope.is_zero()
}
