//! The answer for people: each region, how far it reaches, and what limits it there.

use super::super::intervals::{domain_text, extent_line, heading, stable_lines, undecided_text};
use super::super::layout::{Columns, named_values, short, visible};
use super::super::real;
use super::super::region::{causes_text, goal_or_stable};
use super::required::required_text;
use crate::Text;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Enclosure, Integer, enclosed_decimal, to_decimal};
use jurist_algebra::poly::algebraic::simplest_between;
use jurist_engine::answer::{Answer, Map, MapLimit, RegionExtent};
use jurist_engine::problem::{Free, Problem};
use jurist_engine::stability::plane::{Branch, StabilityMap, StableRegion};
use jurist_engine::stability::{Cause, RealInterval};

/// Digits of frequencies and of places.
const FREQUENCY_DIGITS: usize = 7;

impl Text for Answer<Map> {
    /// The answer for people.
    fn text(&self, digits: usize) -> String {
        map_text(self.problem(), Ok(self.value()), digits)
    }
}

/// The answer for people, also one that the budget did not allow.
pub fn map_text(problem: &Problem, answer: Result<&Map, &Exhausted>, digits: usize) -> String {
    let mut out = format!("{}\n", heading(problem));
    let [x, y] = problem.axes();
    let goal = goal_or_stable(problem);
    out.push_str(&format!("{} against {}: ", axis_text(x), axis_text(y)));
    let answer = match answer {
        Ok(answer) => answer,
        Err(stopped) => {
            out.push_str(&format!("{}\n", undecided_text(stopped)));
            return out;
        }
    };
    let map = &answer.decomposition;
    if map.never_stable {
        let why = answer.never_stable_cause.map(never_stable_text).unwrap_or_default();
        out.push_str(&format!("{goal} nowhere{why}\n"));
        return out;
    }
    match map.regions.len() {
        0 => out.push_str(&format!("{goal} in no open region\n")),
        count => {
            out.push_str(&format!("{goal} in {count} region{}\n", if count == 1 { "" } else { "s" }));
            for (k, region) in map.regions.iter().enumerate() {
                let number = (count > 1).then_some(k + 1);
                out.push_str(&region_text(number, region, answer.limits().get(k), map, problem, digits));
            }
        }
    }
    if let Some(found) = &answer.required {
        out.push_str(&required_text(found, problem, digits));
    }
    out.push_str(&nominal_text(problem, answer, digits));
    out
}

pub(super) fn axis_text(axis: &Free) -> String {
    let mut text = axis.name.clone();
    if let Some(unit) = &axis.unit {
        text.push_str(&format!(" in {}", visible(unit)));
    }
    match domain_text(&axis.name, &axis.domain).as_str() {
        "all" => text,
        domain => format!("{text} ({domain})"),
    }
}

pub(crate) fn never_stable_text(cause: &str) -> &'static str {
    match cause {
        "undefined" => ": the loop is undefined for all values of both",
        "z=1" => ": a root stays at z = 1",
        "z=-1" => ": a root stays at z = -1",
        "s=0" => ": a root stays at s = 0",
        "complex pair" => ": two roots mirror each other in the boundary for all values of both",
        _ => ": the degree is lost for all values of both",
    }
}

fn region_text(
    number: Option<usize>,
    region: &StableRegion,
    limits: Option<&RegionExtent>,
    map: &StabilityMap,
    problem: &Problem,
    digits: usize,
) -> String {
    let axes = problem.axes();
    let mut out = match number {
        Some(k) => format!("region {k}: all points lie within\n"),
        None => "all its points lie within\n".to_owned(),
    };
    let extents = [&region.x, &region.y];
    for (axis, extent) in axes.into_iter().zip(extents) {
        out.push_str(&format!("    {}\n", extent_line(&axis.name, extent, digits)));
    }
    let mut columns = Columns::new("    ");
    for (k, axis) in axes.iter().enumerate() {
        let ends = [&extents[k].lower, &extents[k].upper];
        for (side, end) in ends.into_iter().enumerate() {
            let word = ["least", "greatest"][side];
            let limit = limits.and_then(|l| l.ends[k][side].as_ref());
            let cells = match (limit, end) {
                (_, None) => vec![format!("no {word} {}", axis.name)],
                (None, Some(value)) => {
                    vec![format!("{word} {}", axis.name), real::rounded(value, digits).decimal]
                }
                (Some(limit), Some(value)) => vec![
                    format!("{word} {}", axis.name),
                    real::rounded(value, digits).decimal,
                    mechanism(limit, problem),
                    place(limit, k, axes),
                ],
            };
            columns.row(cells);
        }
    }
    out.push_str(&format!("limited by\n{columns}"));
    let walls = walls(region, map, problem);
    if !walls.is_empty() {
        out.push_str(&format!("with the walls\n{walls}"));
    }
    out
}

/// `complex pair at 1.2 Hz, 0.4 rad`.
pub(super) fn mechanism(limit: &MapLimit, problem: &Problem) -> String {
    let mut causes = causes_text(&limit.limit.causes, problem);
    if limit.limit.causes.contains(Cause::Pole) {
        causes.push_str(" (undefined there)");
    } else if limit.limit.causes.contains(Cause::SquareRoot) {
        causes.push_str(" (undefined beyond)");
    }
    let Some(frequency) = &limit.frequency else { return causes };
    let decimal = |e: &Enclosure| enclosed_decimal(e.lower(), e.upper(), FREQUENCY_DIGITS);
    let mut at = Vec::new();
    at.extend(frequency.hertz.as_ref().and_then(decimal).map(|v| format!("{v} Hz")));
    match (&frequency.angle, &frequency.radians_per_second) {
        (Some(angle), _) => at.extend(decimal(angle).map(|v| format!("{v} rad"))),
        (None, Some(rate)) => at.extend(decimal(rate).map(|v| format!("{v} rad/s"))),
        _ => {}
    }
    if at.is_empty() { causes } else { format!("{causes} at {}", at.join(", ")) }
}

/// Where the extreme value is taken.
pub(super) fn place(limit: &MapLimit, parameter: usize, axes: [&Free; 2]) -> String {
    let other = axes[1 - parameter];
    let places = &limit.limit.at;
    if places.is_empty() {
        return match limit.limit.along_line {
            true if limit.limit.causes.contains(Cause::Domain) => String::new(),
            true => "along a line".to_owned(),
            false => format!("in the limit of large |{}|", other.name),
        };
    }
    let value = |at: &[Enclosure; 2]| {
        let (lo, hi) = (at[1 - parameter].lower(), at[1 - parameter].upper());
        for edge in [&other.domain.lower, &other.domain.upper].into_iter().flatten() {
            if edge == lo || edge == hi {
                return short(edge);
            }
        }
        let simplest = simplest_between(lo, hi);
        let whole = simplest.filter(|v| v.denominator() < Integer::from(10_000));
        whole.map_or_else(
            || enclosed_decimal(lo, hi, FREQUENCY_DIGITS).unwrap_or_else(|| to_decimal(lo, FREQUENCY_DIGITS)),
            |v| to_decimal(&v, FREQUENCY_DIGITS),
        )
    };
    let values: Vec<String> = places.iter().map(value).collect();
    format!("at {} = {}", other.name, values.join(", "))
}

/// What is below and above, from which `x` to which.
fn walls(region: &StableRegion, map: &StabilityMap, problem: &Problem) -> String {
    let axes = problem.axes();
    let mut rows: Vec<(RealInterval, [String; 2])> = Vec::new();
    for (strip, cell) in &region.cells {
        let cell = &map.strips[*strip].cells[*cell];
        let side = |b: &Option<Branch>, domain: bool| match b {
            Some(b) => causes_text(&map.curves[b.curve].causes, problem),
            None if domain => "domain".to_owned(),
            None => "nothing".to_owned(),
        };
        let sides =
            [side(&cell.lower, axes[1].domain.lower.is_some()), side(&cell.upper, axes[1].domain.upper.is_some())];
        let x = &map.strips[*strip].x;
        // Neighbouring strips share the wall.
        let continues = |last: &RealInterval| match (&last.upper, &x.lower) {
            (Some(a), Some(b)) => a.is_same(b),
            _ => false,
        };
        match rows.iter_mut().find(|r| r.1 == sides && continues(&r.0)) {
            Some(row) => row.0.upper.clone_from(&x.upper),
            None => rows.push((x.clone(), sides)),
        }
    }
    let mut columns = Columns::new("    ");
    for (x, [below, above]) in rows {
        let range = extent_line(&axes[0].name, &x, FREQUENCY_DIGITS);
        columns.row([range, format!("below: {below}"), format!("above: {above}")]);
    }
    columns.to_string()
}

/// The two lines through the nominal point.
fn nominal_text(problem: &Problem, answer: &Map, digits: usize) -> String {
    let axes = problem.axes();
    let [Some(x), Some(y)] = [&axes[0].nominal, &axes[1].nominal] else { return String::new() };
    let point = named_values(&[(axes[0].name.clone(), x.clone()), (axes[1].name.clone(), y.clone())]);
    let mut out = String::new();
    for (line, set) in &answer.slices {
        let fixed = line.set().last().map(|(name, value)| format!("{name} = {}", short(value))).unwrap_or_default();
        let name = &line.parameter().name;
        let lines = stable_lines(name, set, digits);
        let lines = if lines.is_empty() { vec![format!("no {name}")] } else { lines };
        for line in lines {
            out.push_str(&format!("    {line}   at {fixed}\n"));
        }
    }
    if out.is_empty() { out } else { format!("through the nominal point {point}\n{out}") }
}
