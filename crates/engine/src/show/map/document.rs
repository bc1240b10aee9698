//! The document `jurist/map/1`.

use super::super::json;
use super::super::real::JSON_NUMBER_DIGITS;
use super::super::region::map_causes_text;
use super::wall_cause;
use crate::analysis::{Axis, Decision, Map, MapLimit, RegionExtent};
use crate::stability::plane::{Branch, Cell, Curve, StabilityMap, StableRegion, Strip};
use jurist_algebra::number::{Enclosure, Integer, enclosed_decimal};
use jurist_algebra::poly::{Monomial, RealAlgebraic};
use serde_json::{Map as Object, Value, json};

/// The document `jurist/map/1`. `limits` holds what limits each region, as far as it is known.
pub fn map_json(answer: &Map, limits: &[RegionExtent], digits: usize) -> Value {
    let mut out = question_fields(answer, "jurist/map/1");
    let x = &answer.axes[0];
    match &answer.map {
        Decision::Decided(map) => {
            out.insert("never_stable".into(), map.never_stable.into());
            if map.never_stable {
                out.insert("never_stable_cause".into(), never_stable_cause(answer));
            }
            out.insert("curves".into(), map.curves.iter().map(curve_json).collect::<Vec<_>>().into());
            let undefined = answer.polynomial.is_none();
            let strips = map.strips.iter().map(|s| strip_json(s, map, x, undefined, digits));
            out.insert("strips".into(), strips.collect::<Vec<_>>().into());
            let regions = map.regions.iter().enumerate().map(|(k, r)| region_json(r, limits.get(k), answer, digits));
            out.insert("regions".into(), regions.collect::<Vec<_>>().into());
        }
        Decision::Undecided { budget, reached } => {
            for key in ["never_stable", "curves", "strips", "regions"] {
                out.insert(key.into(), Value::Null);
            }
            out.insert("undecided".into(), json::undecided(budget, reached));
        }
    }
    Value::Object(out)
}

/// What a document says of the question.
pub(super) fn question_fields(answer: &Map, schema: &str) -> Object<String, Value> {
    let mut out = Object::new();
    out.insert("schema".into(), schema.into());
    out.insert("title".into(), answer.title.as_deref().unwrap_or_default().into());
    out.insert("time".into(), answer.time.name().into());
    let [x, y] = &answer.axes;
    out.insert("x".into(), x.name.as_str().into());
    out.insert("y".into(), y.name.as_str().into());
    let pair = |of: fn(&Axis) -> Value| json!({ "x": of(x), "y": of(y) });
    out.insert("unit".into(), pair(|a| a.unit.as_deref().map_or(Value::Null, Value::from)));
    out.insert("nominal".into(), pair(|a| json::exact(a.nominal.as_ref())));
    out.insert("set".into(), json::set(&answer.set));
    out.insert("domain".into(), pair(|a| json::domain(&a.domain)));
    json::relative(&mut out, answer.radius.as_ref(), answer.decay.as_ref());
    out
}

/// `undefined`, or the boundary that holds for all values; `null` where it was not found.
fn never_stable_cause(answer: &Map) -> Value {
    answer.never_stable_cause().map_or(Value::Null, Value::from)
}

pub(super) fn curve_json(curve: &Curve) -> Value {
    let term = |(m, c): &(Monomial, Integer)| json!([m.exponent(0), m.exponent(1), c.to_string()]);
    json!({ "name": curve.causes.to_string(), "terms": curve.polynomial.terms().iter().map(term).collect::<Vec<_>>() })
}

fn strip_json(strip: &Strip, map: &StabilityMap, x: &Axis, undefined: bool, digits: usize) -> Value {
    let end = |value: &Option<RealAlgebraic>| {
        value.as_ref().map_or(Value::Null, |value| {
            let mut out = json::number(value, digits);
            out.insert("cause".into(), wall_cause(map, x, value).into());
            json::frequency_fields(&mut out, digits, |_| None);
            out.insert("closed".into(), false.into());
            Value::Object(out)
        })
    };
    json!({
        "x": { "lower": end(&strip.x.lower), "upper": end(&strip.x.upper) },
        "sample": strip.sample.to_string(),
        "cells": strip.cells.iter().map(|c| cell_json(c, undefined)).collect::<Vec<_>>(),
    })
}

fn cell_json(cell: &Cell, undefined: bool) -> Value {
    let branch = |b: &Option<Branch>| b.map_or(Value::Null, |b| json!({ "curve": b.curve, "root": b.root }));
    let verdict = match cell.stable {
        _ if undefined => "undefined",
        true => "stable",
        false => "unstable",
    };
    json!({
        "lower": branch(&cell.lower),
        "upper": branch(&cell.upper),
        "verdict": verdict,
        "outside": if undefined { Value::Null } else { cell.outside.into() },
        "sample": cell.sample.to_string(),
    })
}

fn region_json(region: &StableRegion, limits: Option<&RegionExtent>, answer: &Map, digits: usize) -> Value {
    let cells: Vec<Value> = region.cells.iter().map(|(strip, cell)| json!([strip, cell])).collect();
    let extents = [&region.x, &region.y].map(|interval| [&interval.lower, &interval.upper]);
    let end = |parameter: usize, side: usize| {
        let limit = limits.and_then(|l| l.ends[parameter][side].as_ref());
        match (limit, extents[parameter][side]) {
            (Some(limit), _) => limit_json(limit, parameter, answer, digits),
            (None, value) => json::plain_end(value.as_ref(), digits),
        }
    };
    json!({
        "cells": cells,
        "x": { "lower": end(0, 0), "upper": end(0, 1) },
        "y": { "lower": end(1, 0), "upper": end(1, 1) },
    })
}

/// An extreme value with its causes; `at` lists where the other parameter is then.
fn limit_json(limit: &MapLimit, parameter: usize, answer: &Map, digits: usize) -> Value {
    let mut out = json::number(&limit.limit.value, digits);
    out.insert("cause".into(), limit.limit.causes.to_string().into());
    if answer.radius.is_some() || answer.decay.is_some() {
        out.insert("boundary".into(), map_causes_text(&limit.limit.causes, answer).into());
    }
    json::frequency_fields(&mut out, digits.min(JSON_NUMBER_DIGITS), |_| limit.frequency.clone());
    let at = limit.limit.at.iter().map(|at| enclosure_json(&at[1 - parameter], digits));
    out.insert("at".into(), at.collect::<Vec<_>>().into());
    out.insert("closed".into(), false.into());
    Value::Object(out)
}

fn enclosure_json(value: &Enclosure, digits: usize) -> Value {
    let (lo, hi) = (value.lower(), value.upper());
    // As many digits as the enclosure determines.
    let decimal = (1..=digits.min(JSON_NUMBER_DIGITS)).rev().find_map(|d| enclosed_decimal(lo, hi, d));
    json!({ "decimal": decimal, "enclosure": [lo.to_string(), hi.to_string()] })
}
