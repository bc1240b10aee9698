//! The walls as lines: branches joined from strip to strip, and the vertical lines among the curves.

use super::super::COLOURS;
use super::trace::{MapTrace, approximate_real};
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, Map};
use jurist_engine::stability::plane::{Cell, StabilityMap};
use jurist_engine::stability::{Cause, Causes, Shape};
use jurist_show::region::boundary_point;

/// What a wall separates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Stable points are on one side or on both.
    Stable,
    /// The number of roots outside differs, neither side is stable.
    Count,
    /// Nothing changes: two roots mirror each other off the boundary.
    Nothing,
}

/// A wall, drawn as a line.
#[derive(Clone, Debug)]
pub struct Wall {
    /// The number of its curve.
    pub curve: usize,
    /// What it separates.
    pub role: Role,
    /// Its points in places of the window, from 0 to 1 inside.
    pub points: Vec<(f64, f64)>,
    /// The exact value of `x` at each point and the number of the branch there; none for a vertical line.
    pub lines: Vec<(Rational, usize)>,
}

/// Ends of walls in neighbouring strips that are this close, in sizes of the picture, are one point.
const TOGETHER: f64 = 0.004;

/// The colour and the dashes of a mechanism.
pub fn mechanism_colour(causes: &Causes) -> (&'static str, &'static [f64]) {
    match leading_cause(causes) {
        Some(Cause::ComplexPair | Cause::ComplexRoot) => (COLOURS[0], &[]),
        Some(Cause::RootAtOne | Cause::RootAtZero) => (COLOURS[1], &[9.0, 3.0]),
        Some(Cause::RootAtMinusOne) => (COLOURS[3], &[4.0, 3.0]),
        Some(Cause::DegreeLost | Cause::Neutral) => (COLOURS[5], &[9.0, 3.0, 2.0, 3.0]),
        Some(Cause::Pole | Cause::SquareRoot | Cause::Duty) => ("#777777", &[2.0, 3.0]),
        Some(Cause::Domain | Cause::Undecided) | None => ("#999999", &[1.0, 3.0]),
    }
}

/// A mechanism in words, with the points of the boundary that was asked for.
pub fn mechanism_words(causes: &Causes, answer: &Answer<Map>) -> String {
    let edge = boundary_point(answer.problem());
    let printed = |sign: &str| match &edge {
        Some(edge) => format!("{sign}{edge}").replace("--", "").replace('-', "\u{2212}"),
        None => format!("{sign}1").replace('-', "\u{2212}"),
    };
    let words = |cause: Cause| match (cause, answer.problem().shape()) {
        (Cause::RootAtOne, _) => format!("root at z = {}", printed("")),
        (Cause::RootAtMinusOne, _) => format!("root at z = {}", printed("-")),
        (Cause::ComplexPair | Cause::ComplexRoot, Shape::UnitDisc) if edge.is_some() => {
            format!("{cause} on |z| = {}", printed(""))
        }
        (Cause::ComplexPair | Cause::ComplexRoot, Shape::LeftHalfPlane) if edge.is_some() => {
            format!("{cause} on Re s = {}", printed(""))
        }
        (Cause::ComplexPair | Cause::ComplexRoot, Shape::UnitDisc) => format!("{cause} on the circle"),
        (Cause::ComplexPair | Cause::ComplexRoot, Shape::LeftHalfPlane) => format!("{cause} on the axis"),
        (Cause::RootAtZero, _) if edge.is_some() => format!("root at s = {}", printed("")),
        (Cause::RootAtZero, _) => "root at s = 0".into(),
        (Cause::DegreeLost, _) => "degree lost".into(),
        (Cause::Neutral, _) => "difference operator not stable".into(),
        (Cause::Pole, _) => "loop undefined".into(),
        (Cause::SquareRoot, _) => "loop undefined beyond".into(),
        (Cause::Duty, _) => "no pulse, or no pause, beyond".into(),
        (Cause::Domain, _) => "end of the domain".into(),
        (Cause::Undecided, _) => "undecided beyond".into(),
    };
    // On a curve of real roots the pair's constraint vanishes because a root is its own mirror image twice.
    let named: Vec<String> = match leading_cause(causes) {
        Some(Cause::ComplexPair | Cause::ComplexRoot) | None => causes.iter().map(words).collect(),
        Some(_) => causes.iter().filter(|c| !c.is_of_complex_roots()).map(words).collect(),
    };
    named.join(" + ")
}

/// The cause that gives a curve its colour: a pair only where nothing else holds.
fn leading_cause(causes: &Causes) -> Option<Cause> {
    causes.iter().find(|c| !c.is_of_complex_roots()).or_else(|| causes.iter().next())
}

fn role(below: &Cell, above: &Cell, causes: &Causes) -> Role {
    if below.stable || above.stable {
        Role::Stable
    } else if below.outside == above.outside && leading_cause(causes).is_some_and(Cause::is_of_complex_roots) {
        Role::Nothing
    } else {
        Role::Count
    }
}

/// All walls of a traced map.
pub(super) fn walls(answer: &Answer<Map>, map: &StabilityMap, trace: &MapTrace) -> Vec<Wall> {
    let mut done: Vec<Wall> = Vec::new();
    let mut open: Vec<Wall> = Vec::new();
    let mut last_strip = None;
    for traced in &trace.strips {
        let strip = &map.strips[traced.strip];
        if last_strip.is_some_and(|last| last + 1 != traced.strip) {
            done.append(&mut open);
        }
        last_strip = Some(traced.strip);
        let mut next = Vec::new();
        for (number, pair) in strip.cells.windows(2).enumerate() {
            let Some(branch) = pair[0].upper else { continue };
            let curve = branch.curve;
            let role = role(&pair[0], &pair[1], &map.curves[curve].causes);
            let points = traced.lines.iter().map(|l| (l.u, l.v[number]));
            let lines = traced.lines.iter().map(|l| (l.x.clone(), number));
            let first = traced.lines[0].v[number];
            let fits = |w: &Wall| {
                let end = w.points.last().map_or(f64::NAN, |p| p.1);
                w.curve == curve && w.role == role && ((end - first).abs() < TOGETHER || end == first)
            };
            match open.iter().position(fits) {
                Some(k) => {
                    let mut wall = open.swap_remove(k);
                    wall.points.extend(points);
                    wall.lines.extend(lines);
                    next.push(wall);
                }
                None => next.push(Wall { curve, role, points: points.collect(), lines: lines.collect() }),
            }
        }
        done.append(&mut open);
        open = next;
    }
    done.append(&mut open);
    done.extend(vertical_walls(answer, map, trace));
    done
}

/// The vertical lines among the curves: where stable cells touch them, and elsewhere.
fn vertical_walls(answer: &Answer<Map>, map: &StabilityMap, trace: &MapTrace) -> Vec<Wall> {
    let mut out = Vec::new();
    for curve in (0..map.curves.len()).filter(|&k| map.curves[k].polynomial.degree_in(1) == 0) {
        for (k, strip) in map.strips.iter().enumerate() {
            let shown = |side: usize| {
                let value = [&strip.x.lower, &strip.x.upper][side].as_ref();
                let value = value.filter(|_| strip.lines[side].contains(&curve))?;
                Some(trace.windows[0].place(approximate_real(value))).filter(|u| (0.0..=1.0).contains(u))
            };
            if k == 0
                && let Some(u) = shown(0)
            {
                out.extend(pieces(answer, map, trace, (curve, u), None, Some(k)));
            }
            if let Some(u) = shown(1) {
                let right = (k + 1 < map.strips.len()).then_some(k + 1);
                out.extend(pieces(answer, map, trace, (curve, u), Some(k), right));
            }
        }
    }
    out
}

/// A vertical line cut into what touches stable cells of the strips beside it and what does not.
fn pieces(
    answer: &Answer<Map>,
    map: &StabilityMap,
    trace: &MapTrace,
    (curve, u): (usize, f64),
    left: Option<usize>,
    right: Option<usize>,
) -> Vec<Wall> {
    let traced = |strip: Option<usize>| trace.strips.iter().find(|t| Some(t.strip) == strip);
    let left = traced(left).and_then(|t| Some((t, t.lines.last()?)));
    let right = traced(right).and_then(|t| Some((t, t.lines.first()?)));
    let sides: Vec<_> = [left, right].into_iter().flatten().collect();
    let mut cuts: Vec<f64> = sides.iter().flat_map(|(_, line)| line.v.iter().copied()).collect();
    let edge = |end: &Option<Rational>, otherwise: f64| {
        end.as_ref().map_or(otherwise, |e| trace.windows[1].place(e.to_f64_approximate())).clamp(0.0, 1.0)
    };
    let domain = &answer.problem().free()[1].domain;
    let (bottom, top) = (edge(&domain.lower, 0.0), edge(&domain.upper, 1.0));
    cuts.retain(|v| *v > bottom && *v < top);
    cuts.extend([bottom, top]);
    cuts.sort_by(f64::total_cmp);
    let stable_at = |v: f64| {
        sides.iter().any(|(traced, line)| {
            let cell = line.v.iter().filter(|w| **w < v).count();
            map.strips[traced.strip].cells.get(cell).is_some_and(|c| c.stable)
        })
    };
    let mut out: Vec<Wall> = Vec::new();
    for pair in cuts.windows(2).filter(|p| p[0] < p[1]) {
        let role = if stable_at(f64::midpoint(pair[0], pair[1])) { Role::Stable } else { Role::Count };
        match out.last_mut().filter(|w| w.role == role) {
            Some(wall) => wall.points.push((u, pair[1])),
            None => out.push(Wall { curve, role, points: vec![(u, pair[0]), (u, pair[1])], lines: Vec::new() }),
        }
    }
    out
}
