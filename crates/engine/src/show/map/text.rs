//! The answer for people: each region, how far it reaches, and what limits it there.

use super::super::intervals::{domain_text, set_lines};
use super::super::layout::{Columns, called, named_values, short, visible};
use super::super::real;
use super::super::region::{map_causes_text, map_goal};
use crate::analysis::{Axis, Decision, Intervals, Map, MapLimit, RegionExtent};
use crate::stability::plane::{Branch, StabilityMap, StableRegion};
use crate::stability::{AlgebraicInterval, Cause, IntervalSet};
use jurist_algebra::number::{Enclosure, Integer, enclosed_decimal, to_decimal};
use jurist_algebra::poly::algebraic::simplest_between;

/// Digits of frequencies and of places.
const FREQUENCY_DIGITS: usize = 7;

/// The answer for people. `limits` holds what limits each region, `slices` the stable sets on the two lines
/// through the nominal point, as far as they are known.
pub fn map_text(answer: &Map, limits: &[RegionExtent], slices: &[Intervals], digits: usize) -> String {
    let mut out = format!("{}, {} time", called(answer.title.as_deref()), answer.time.name());
    if !answer.set.is_empty() {
        out.push_str(&format!(", {}", named_values(&answer.set)));
    }
    out.push('\n');
    let [x, y] = &answer.axes;
    let goal = map_goal(answer);
    out.push_str(&format!("{} against {}: ", axis_text(x), axis_text(y)));
    match &answer.map {
        Decision::Undecided { budget, reached } => {
            out.push_str(&format!("undecided, the budget ran out: {budget}; reached: {reached}\n"));
        }
        Decision::Decided(map) if map.never_stable => {
            let why = answer.never_stable_cause().map(never_stable_text).unwrap_or_default();
            out.push_str(&format!("{goal} nowhere{why}\n"));
        }
        Decision::Decided(map) if map.regions.is_empty() => out.push_str(&format!("{goal} in no open region\n")),
        Decision::Decided(map) => {
            let count = map.regions.len();
            out.push_str(&format!("{goal} in {count} region{}\n", if count == 1 { "" } else { "s" }));
            for (k, region) in map.regions.iter().enumerate() {
                let number = (count > 1).then_some(k + 1);
                out.push_str(&region_text(number, region, limits.get(k), map, answer, digits));
            }
        }
    }
    if answer.map.decided().is_some_and(|m| !m.never_stable) {
        out.push_str(&nominal_text(answer, slices, digits));
    }
    out
}

pub(super) fn axis_text(axis: &Axis) -> String {
    let mut text = axis.name.clone();
    if let Some(unit) = &axis.unit {
        text.push_str(&format!(" in {}", visible(unit)));
    }
    match domain_text(&axis.name, &axis.domain).as_str() {
        "all" => text,
        domain => format!("{text} ({domain})"),
    }
}

fn never_stable_text(cause: &str) -> &'static str {
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
    answer: &Map,
    digits: usize,
) -> String {
    let axes = &answer.axes;
    let mut out = match number {
        Some(k) => format!("region {k}: all points lie within\n"),
        None => "all its points lie within\n".to_owned(),
    };
    let extents = [&region.x, &region.y];
    for (axis, extent) in axes.iter().zip(extents) {
        for line in set_lines(&axis.name, &IntervalSet::from_iter([extent.clone()]), digits) {
            out.push_str(&format!("    {line}\n"));
        }
    }
    let mut columns = Columns::new("    ");
    for (k, axis) in axes.iter().enumerate() {
        let ends = [&extents[k].lower, &extents[k].upper];
        for (side, end) in ends.into_iter().enumerate() {
            let word = ["least", "greatest"][side];
            let limit = limits.and_then(|l| l.ends[k][side].as_ref());
            let cells = match (limit, end) {
                (_, None) => vec![format!("no {word} {}", axis.name)],
                (None, Some(value)) => vec![format!("{word} {}", axis.name), real::rounded(value, digits).decimal],
                (Some(limit), Some(value)) => vec![
                    format!("{word} {}", axis.name),
                    real::rounded(value, digits).decimal,
                    mechanism(limit, answer),
                    place(limit, k, axes),
                ],
            };
            columns.row(cells);
        }
    }
    out.push_str(&format!("limited by\n{columns}"));
    let walls = walls(region, map, answer);
    if !walls.is_empty() {
        out.push_str(&format!("with the walls\n{walls}"));
    }
    out
}

/// `complex pair at 1.2 Hz, 0.4 rad`.
fn mechanism(limit: &MapLimit, answer: &Map) -> String {
    let mut causes = map_causes_text(&limit.limit.causes, answer);
    if limit.limit.causes.contains(Cause::Pole) {
        causes.push_str(" (undefined there)");
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
fn place(limit: &MapLimit, parameter: usize, axes: &[Axis; 2]) -> String {
    let other = &axes[1 - parameter];
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
fn walls(region: &StableRegion, map: &StabilityMap, answer: &Map) -> String {
    let axes = &answer.axes;
    let mut rows: Vec<(AlgebraicInterval, [String; 2])> = Vec::new();
    for (strip, cell) in &region.cells {
        let cell = &map.strips[*strip].cells[*cell];
        let side = |b: &Option<Branch>, domain: bool| match b {
            Some(b) => map_causes_text(&map.curves[b.curve].causes, answer),
            None if domain => "domain".to_owned(),
            None => "nothing".to_owned(),
        };
        let sides =
            [side(&cell.lower, axes[1].domain.lower.is_some()), side(&cell.upper, axes[1].domain.upper.is_some())];
        let x = &map.strips[*strip].x;
        let continues = |last: &AlgebraicInterval| match (&last.upper, &x.lower) {
            (Some(a), Some(b)) => a.compare(b).is_eq(),
            _ => false,
        };
        match rows.iter_mut().find(|r| r.1 == sides && continues(&r.0)) {
            Some(row) => row.0.upper.clone_from(&x.upper),
            None => rows.push((x.clone(), sides)),
        }
    }
    let mut columns = Columns::new("    ");
    for (x, [below, above]) in rows {
        let range = set_lines(&axes[0].name, &IntervalSet::from_iter([x]), FREQUENCY_DIGITS).remove(0);
        columns.row([range, format!("below: {below}"), format!("above: {above}")]);
    }
    columns.to_string()
}

/// The two lines through the nominal point.
fn nominal_text(answer: &Map, slices: &[Intervals], digits: usize) -> String {
    let [Some(x), Some(y)] = [&answer.axes[0].nominal, &answer.axes[1].nominal] else { return String::new() };
    let point = named_values(&[(answer.axes[0].name.clone(), x.clone()), (answer.axes[1].name.clone(), y.clone())]);
    let mut out = String::new();
    for slice in slices {
        let question = &slice.question;
        let Decision::Decided(set) = &slice.stable else { continue };
        let fixed = question.set.last().map(|(name, value)| format!("{name} = {}", short(value))).unwrap_or_default();
        let lines = set_lines(&question.parameter, &set.to_interval_set(), digits);
        let lines = if lines.is_empty() { vec![format!("no {}", question.parameter)] } else { lines };
        for line in lines {
            out.push_str(&format!("    {line}   at {fixed}\n"));
        }
    }
    if out.is_empty() { out } else { format!("through the nominal point {point}\n{out}") }
}
