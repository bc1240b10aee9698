//! The stable region in two parameters.

use super::intervals::{domain_text, set_lines};
use super::json;
use super::layout::{named_values, short};
use crate::analysis::{Axis, Decision, Map};
use crate::number::Integer;
use crate::poly::Monomial;
use crate::stability::plane::{Branch, Cell, Curve, StabilityMap, StableRegion, Strip};
use crate::stability::{AlgebraicInterval, IntervalSet};
use serde_json::{Map as Object, Value, json};

/// The document `jurist/map/1`.
pub fn map_json(answer: &Map, digits: usize) -> Value {
    let mut out = Object::new();
    out.insert("schema".into(), "jurist/map/1".into());
    out.insert("title".into(), answer.title.as_deref().unwrap_or_default().into());
    out.insert("time".into(), answer.time.name().into());
    let [x, y] = &answer.axes;
    out.insert("x".into(), x.name.as_str().into());
    out.insert("y".into(), y.name.as_str().into());
    out.insert("set".into(), json::set(&answer.set));
    out.insert("domain".into(), json!({ "x": json::domain(&x.domain), "y": json::domain(&y.domain) }));
    json::relative(&mut out, answer.radius.as_ref(), answer.decay.as_ref());
    match &answer.map {
        Decision::Decided(map) => {
            out.insert("curves".into(), map.curves.iter().map(curve_json).collect::<Vec<_>>().into());
            out.insert("strips".into(), map.strips.iter().map(|s| strip_json(s, digits)).collect::<Vec<_>>().into());
            out.insert("regions".into(), map.regions.iter().map(|r| region_json(r, digits)).collect::<Vec<_>>().into());
        }
        Decision::Undecided { budget, reached } => {
            out.insert("regions".into(), Value::Null);
            out.insert("undecided".into(), json::undecided(budget, reached));
        }
    }
    Value::Object(out)
}

fn curve_json(curve: &Curve) -> Value {
    let term = |(m, c): &(Monomial, Integer)| json!([m.exponent(0), m.exponent(1), c.to_string()]);
    json!({ "name": curve.causes.to_string(), "terms": curve.polynomial.terms().iter().map(term).collect::<Vec<_>>() })
}

fn strip_json(strip: &Strip, digits: usize) -> Value {
    json!({
        "x": interval_json(&strip.x, digits),
        "sample": strip.sample.to_string(),
        "cells": strip.cells.iter().map(cell_json).collect::<Vec<_>>(),
    })
}

fn cell_json(cell: &Cell) -> Value {
    let branch = |b: &Option<Branch>| b.map_or(Value::Null, |b| json!({ "curve": b.curve, "root": b.root }));
    json!({
        "lower": branch(&cell.lower),
        "upper": branch(&cell.upper),
        "verdict": if cell.stable { "stable" } else { "unstable" },
        "outside": cell.outside,
        "sample": cell.sample.to_string(),
    })
}

fn region_json(region: &StableRegion, digits: usize) -> Value {
    let cells: Vec<Value> = region.cells.iter().map(|(strip, cell)| json!([strip, cell])).collect();
    json!({ "cells": cells, "x": interval_json(&region.x, digits), "y": interval_json(&region.y, digits) })
}

fn interval_json(interval: &AlgebraicInterval, digits: usize) -> Value {
    json!({
        "lower": json::plain_end(interval.lower.as_ref(), digits),
        "upper": json::plain_end(interval.upper.as_ref(), digits),
    })
}

/// The answer for people: the regions with their extents, and what bounds them.
pub fn map_text(answer: &Map, digits: usize) -> String {
    let mut out = format!("{}, {} time", answer.title.as_deref().unwrap_or("the loop"), answer.time.name());
    if !answer.set.is_empty() {
        out.push_str(&format!(", {}", named_values(&answer.set)));
    }
    out.push('\n');
    let [x, y] = &answer.axes;
    let goal = match (&answer.radius, &answer.decay) {
        (Some(r), _) => format!("all |z| < {}", short(r)),
        (_, Some(s)) => format!("all Re s < {}", short(&-s)),
        _ => "stable".to_owned(),
    };
    out.push_str(&format!("{} against {}: ", axis_text(x), axis_text(y)));
    match &answer.map {
        Decision::Undecided { budget, reached } => {
            out.push_str(&format!("undecided, the budget ran out: {budget}; reached: {reached}\n"));
        }
        Decision::Decided(map) if map.regions.is_empty() => out.push_str(&format!("{goal} in no open region\n")),
        Decision::Decided(map) => {
            let count = map.regions.len();
            out.push_str(&format!("{goal} in {count} region{}\n", if count == 1 { "" } else { "s" }));
            for (k, region) in map.regions.iter().enumerate() {
                out.push_str(&region_text(k + 1, region, map, [&x.name, &y.name], digits));
            }
        }
    }
    out
}

fn axis_text(axis: &Axis) -> String {
    let mut text = axis.name.clone();
    if let Some(unit) = &axis.unit {
        text.push_str(&format!(" in {unit}"));
    }
    match domain_text(&axis.name, &axis.domain).as_str() {
        "all" => text,
        domain => format!("{text} ({domain})"),
    }
}

fn region_text(number: usize, region: &StableRegion, map: &StabilityMap, names: [&str; 2], digits: usize) -> String {
    let mut out = format!("region {number}, {} cells, within\n", region.cells.len());
    for (name, extent) in names.into_iter().zip([&region.x, &region.y]) {
        for line in set_lines(name, &IntervalSet::from_iter([extent.clone()]), digits) {
            out.push_str(&format!("    {line}\n"));
        }
    }
    let mut walls: Vec<(String, String)> = Vec::new();
    for (strip, cell) in &region.cells {
        let cell = &map.strips[*strip].cells[*cell];
        let side = |b: &Option<Branch>| match b {
            Some(b) => format!("{} (curve {}, root {})", map.curves[b.curve].causes, b.curve, b.root),
            None => "the domain's edge".to_owned(),
        };
        let pair = (side(&cell.lower), side(&cell.upper));
        if !walls.contains(&pair) {
            walls.push(pair);
        }
    }
    for (below, above) in walls {
        out.push_str(&format!("    between {below} below and {above} above\n"));
    }
    out
}
