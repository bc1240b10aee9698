//! Points of the boundary curves: isolated roots on a fine set of vertical lines in every strip.

use super::window::AxisWindow;
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::algebraic::simplest_between;
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::stability::Range;
use jurist_engine::stability::plane::{StabilityMap, Strip};

/// Lines per width of the picture before refinement.
const LINES: f64 = 320.0;
/// Neighbouring points are at most this far apart in height, in heights of the picture.
const STEP: f64 = 1.0 / 320.0;
/// Lines are never closer than this, in widths of the picture.
const CLOSEST: f64 = 1e-8;
/// Lines in a strip at most.
const MOST_LINES: usize = 6000;
/// Decimal digits to which a root is known for a picture.
const DIGITS: usize = 5;

/// The branches in one strip as far as the window shows it, in places from 0 to 1 (beyond outside).
#[derive(Clone, Debug)]
pub struct TracedStrip {
    /// The number of the strip.
    pub strip: usize,
    /// The lines, from left to right.
    pub lines: Vec<TracedLine>,
}

/// The branches on one vertical line.
#[derive(Clone, Debug)]
pub struct TracedLine {
    /// Where the line is drawn.
    pub u: f64,
    /// The exact value of the parameter.
    pub x: Rational,
    /// Where the branches are, from below.
    pub v: Vec<f64>,
}

/// All branches in a window.
#[derive(Clone, Debug)]
pub struct MapTrace {
    /// The window.
    pub windows: [AxisWindow; 2],
    /// The strips that the window shows, from left to right.
    pub strips: Vec<TracedStrip>,
}

/// Traces the branches of a decided map; none while it is undecided.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn trace_map(answer: &Answer<Map>, windows: [AxisWindow; 2], budget: &Budget) -> Result<MapTrace, Exhausted> {
    trace(&answer.value().decomposition, &answer.problem().free()[1].domain, windows, budget)
}

/// Traces the branches of a decomposition with this domain of `y`.
pub(super) fn trace(
    map: &StabilityMap,
    y_domain: &Range,
    windows: [AxisWindow; 2],
    budget: &Budget,
) -> Result<MapTrace, Exhausted> {
    budget.step("tracing the curves");
    let mut strips = Vec::new();
    for (number, strip) in map.strips.iter().enumerate() {
        budget.check()?;
        budget.advance(number as u64, map.strips.len() as u64);
        let tracer = Tracer { y_domain, map, strip, windows: &windows, budget };
        let lines = tracer.lines()?;
        if lines.len() > 1 {
            strips.push(TracedStrip { strip: number, lines });
        }
    }
    Ok(MapTrace { windows, strips })
}

struct Tracer<'a> {
    y_domain: &'a Range,
    map: &'a StabilityMap,
    strip: &'a Strip,
    windows: &'a [AxisWindow; 2],
    budget: &'a Budget,
}

impl Tracer<'_> {
    fn lines(&self) -> Result<Vec<TracedLine>, Exhausted> {
        let (Some((left, a)), Some((right, b))) = (self.end(false), self.end(true)) else { return Ok(Vec::new()) };
        if left >= right {
            return Ok(Vec::new());
        }
        let count = ((right - left) * LINES).ceil().max(4.0);
        let mut wanted = vec![(left, Some(a))];
        wanted.extend((1..count as usize).map(|k| (left + (right - left) * k as f64 / count, None)));
        wanted.push((right, Some(b)));
        let mut lines = self.at_all(wanted, (right - left) / count)?;
        loop {
            let mut wanted = Vec::new();
            let mut closest = f64::INFINITY;
            for pair in lines.windows(2) {
                let width = pair[1].u - pair[0].u;
                if width > 2.0 * CLOSEST && steep(&pair[0], &pair[1]) {
                    wanted.push((f64::midpoint(pair[0].u, pair[1].u), None));
                    closest = closest.min(width);
                }
            }
            if wanted.is_empty() || lines.len() + wanted.len() > MOST_LINES {
                return Ok(lines);
            }
            let before = lines.len();
            lines.extend(self.at_all(wanted, closest / 2.0)?);
            lines.sort_by(|a, b| a.u.total_cmp(&b.u).then_with(|| a.x.cmp(&b.x)));
            lines.dedup_by(|a, b| a.x == b.x);
            if lines.len() == before {
                return Ok(lines);
            }
        }
    }

    /// Where the visible part of the strip ends, and an exact value of `x` there, just inside the strip.
    fn end(&self, right: bool) -> Option<(f64, Rational)> {
        let window = &self.windows[0];
        let edge = if right { &window.upper } else { &window.lower };
        if self.strip.x.contains(edge) {
            return Some((if right { 1.0 } else { 0.0 }, edge.clone()));
        }
        let wall = if right { self.strip.x.upper.as_ref() } else { self.strip.x.lower.as_ref() }?;
        // A wall beyond the window's edge on the wrong side: nothing of the strip shows.
        let beyond = wall.compare_rational(&window.upper).is_gt() || wall.compare_rational(&window.lower).is_lt();
        if beyond {
            return None;
        }
        let u = window.place(approximate_real(wall)).clamp(0.0, 1.0);
        let aside = if right { u - CLOSEST } else { u + CLOSEST };
        let mut step = Rational::from_f64((window.value(aside) - window.value(u)).abs())?;
        let half = Rational::dyadic(&jurist_algebra::number::Integer::ONE, 1);
        for _ in 0..200 {
            let (lo, hi) = wall.refined(&step).enclosure();
            let x = if right { &lo - &step } else { &hi + &step };
            if self.strip.x.contains(&x) {
                return Some((u, x));
            }
            step *= &half;
        }
        None
    }

    /// Lines at places, each at the simplest value of `x` near it.
    fn at_all(&self, wanted: Vec<(f64, Option<Rational>)>, spacing: f64) -> Result<Vec<TracedLine>, Exhausted> {
        let found: Vec<Result<Option<TracedLine>, Exhausted>> = parallel_map(wanted, |(u, exact)| {
            self.budget.check()?;
            let x = match exact {
                Some(x) => Some(x),
                None => {
                    let near = |d: f64| Rational::from_f64(self.windows[0].value(u + d * spacing));
                    let range = near(-0.01).zip(near(0.01));
                    range.and_then(|(a, b)| simplest_between(&a, &b)).filter(|x| self.strip.x.contains(x))
                }
            };
            let Some(x) = x else { return Ok(None) };
            let v = self.branches(&x)?;
            Ok(Some(TracedLine { u, x, v }))
        });
        found.into_iter().filter_map(Result::transpose).collect()
    }

    fn branches(&self, x: &Rational) -> Result<Vec<f64>, Exhausted> {
        let window = &self.windows[1];
        let branches = self.map.branches(x, self.y_domain, self.budget)?;
        let width = (&window.upper - &window.lower) * Rational::dyadic(&jurist_algebra::number::Integer::ONE, 14);
        let place = |value: &Real| {
            let fine = if window.logarithmic { value.refined_to_digits(DIGITS) } else { value.refined(&width) };
            let (lo, hi) = fine.enclosure();
            window.place(lo.midpoint(&hi).to_f64_approximate())
        };
        Ok(branches.iter().map(|(value, _)| place(value)).collect())
    }
}

/// Whether a branch rises or falls by more than a step between two lines, inside the picture.
fn steep(a: &TracedLine, b: &TracedLine) -> bool {
    let near = |v: f64| v.clamp(-0.02, 1.02);
    a.v.iter().zip(&b.v).any(|(a, b)| (near(*a) - near(*b)).abs() > STEP)
}

/// The nearest floating-point number, about.
pub(super) fn approximate_real(value: &Real) -> f64 {
    let (lo, hi) = value.refined_to_digits(15).enclosure();
    lo.midpoint(&hi).to_f64_approximate()
}
