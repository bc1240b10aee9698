//! The document `jurist/map/1`.

use super::super::json;
use super::super::real::JSON_NUMBER_DIGITS;
use super::super::region::{boundary_point, causes_text};
use super::wall_cause;
use crate::answer::{Answer, Map, MapLimit, RegionExtent};
use crate::problem::{Free, Problem};
use crate::stability::plane::{Branch, Cell, Curve, StabilityMap, StableRegion, Strip};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Enclosure, Integer, enclosed_decimal};
use jurist_algebra::poly::{Monomial, RealAlgebraic};
use serde_json::{Map as Object, Value, json};

impl Answer<Map> {
    /// The document `jurist/map/1`.
    pub fn json(&self, digits: usize) -> Value {
        map_json(self.problem(), Ok(self.value()), digits)
    }
}

/// The document `jurist/map/1`, also of a map that the budget did not allow.
pub fn map_json(problem: &Problem, answer: Result<&Map, &Exhausted>, digits: usize) -> Value {
    let mut out = question_fields(problem, "jurist/map/1");
    let x = problem.axes()[0];
    match answer {
        Ok(answer) => {
            let map = &answer.decomposition;
            out.insert("never_stable".into(), map.never_stable.into());
            if map.never_stable {
                out.insert("never_stable_cause".into(), answer.never_stable_cause.map_or(Value::Null, Value::from));
            }
            out.insert("curves".into(), map.curves.iter().map(curve_json).collect::<Vec<_>>().into());
            let undefined = answer.never_stable_cause == Some("undefined");
            let strips = map.strips.iter().map(|s| strip_json(s, map, x, undefined, digits));
            out.insert("strips".into(), strips.collect::<Vec<_>>().into());
            let limits = answer.limits();
            let regions = map.regions.iter().enumerate().map(|(k, r)| region_json(r, limits.get(k), problem, digits));
            out.insert("regions".into(), regions.collect::<Vec<_>>().into());
        }
        Err(stopped) => json::undecided(&mut out, &["never_stable", "curves", "strips", "regions"], stopped),
    }
    Value::Object(out)
}

/// What a document says of the question.
pub(super) fn question_fields(problem: &Problem, schema: &str) -> Object<String, Value> {
    let mut out = Object::new();
    out.insert("schema".into(), schema.into());
    out.insert("title".into(), problem.title().unwrap_or_default().into());
    out.insert("time".into(), problem.time().name().into());
    let [x, y] = problem.axes();
    out.insert("x".into(), x.name.as_str().into());
    out.insert("y".into(), y.name.as_str().into());
    let pair = |of: fn(&Free) -> Value| json!({ "x": of(x), "y": of(y) });
    out.insert("unit".into(), pair(|a| a.unit.as_deref().map_or(Value::Null, Value::from)));
    out.insert("nominal".into(), pair(|a| json::exact(a.nominal.as_ref())));
    out.insert("set".into(), json::set(problem.set()));
    out.insert("domain".into(), pair(|a| json::domain(&a.domain)));
    json::region(&mut out, problem.region());
    out
}

pub(super) fn curve_json(curve: &Curve) -> Value {
    let term = |(m, c): &(Monomial, Integer)| json!([m.exponent(0), m.exponent(1), c.to_string()]);
    json!({ "name": curve.causes.to_string(), "terms": curve.polynomial.terms().iter().map(term).collect::<Vec<_>>() })
}

fn strip_json(strip: &Strip, map: &StabilityMap, x: &Free, undefined: bool, digits: usize) -> Value {
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

fn region_json(region: &StableRegion, limits: Option<&RegionExtent>, problem: &Problem, digits: usize) -> Value {
    let cells: Vec<Value> = region.cells.iter().map(|(strip, cell)| json!([strip, cell])).collect();
    let extents = [&region.x, &region.y].map(|interval| [&interval.lower, &interval.upper]);
    let end = |parameter: usize, side: usize| {
        let limit = limits.and_then(|l| l.ends[parameter][side].as_ref());
        match (limit, extents[parameter][side]) {
            (Some(limit), _) => limit_json(limit, parameter, problem, digits),
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
fn limit_json(limit: &MapLimit, parameter: usize, problem: &Problem, digits: usize) -> Value {
    let mut out = json::number(&limit.limit.value, digits);
    out.insert("cause".into(), limit.limit.causes.to_string().into());
    if boundary_point(problem).is_some() {
        out.insert("boundary".into(), causes_text(&limit.limit.causes, problem).into());
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
