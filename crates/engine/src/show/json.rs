//! What the JSON documents share. Exact numbers are strings.

use super::margins::margin;
use super::real::{self, JSON_NUMBER_DIGITS};
use super::region as boundary;
use crate::answer::Frequency;
use crate::problem::{Problem, Region};
use crate::stability::{End, IntervalSet, Range, StableSet};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Enclosure, Rational, enclosed_decimal};
use jurist_algebra::poly::{RealAlgebraic, UniPoly};
use serde_json::{Map, Value, json};

/// The document as text, ending with a newline.
pub fn to_text(document: &Value) -> String {
    // Values that are built here have string keys and finite numbers, which always serialise.
    let mut text = serde_json::to_string_pretty(document).unwrap_or_default();
    text.push('\n');
    text
}

/// `{"T": "1/10000"}`.
pub fn set(values: &[(String, Rational)]) -> Value {
    let entries = values.iter().map(|(name, value)| (name.clone(), Value::from(value.to_string())));
    Value::Object(entries.collect::<Map<_, _>>())
}

/// `{"lower": "0", "upper": null}`.
pub fn domain(range: &Range) -> Value {
    json!({ "lower": exact(range.lower.as_ref()), "upper": exact(range.upper.as_ref()) })
}

/// An exact number as a string; `null` for none.
pub fn exact(value: Option<&Rational>) -> Value {
    value.map_or(Value::Null, |v| v.to_string().into())
}

/// An algebraic number: decimal, exact value, enclosure, polynomial.
pub fn number(value: &RealAlgebraic, digits: usize) -> Map<String, Value> {
    let rounded = real::rounded(value, digits);
    let mut out = Map::new();
    out.insert("decimal".into(), rounded.decimal.into());
    out.insert("exact".into(), exact(value.exact().as_ref()));
    out.insert("enclosure".into(), json!([rounded.enclosure.0.to_string(), rounded.enclosure.1.to_string()]));
    out.insert("polynomial".into(), polynomial(value.polynomial()));
    out
}

/// Integer coefficients as strings, from the constant term up.
pub fn polynomial(p: &UniPoly) -> Value {
    p.coeffs().iter().map(|c| c.to_string()).collect::<Vec<_>>().into()
}

/// The end of a solution set, of which only the place is known.
pub fn plain_end(value: Option<&RealAlgebraic>, digits: usize) -> Value {
    value.map_or(Value::Null, |value| {
        let mut out = number(value, digits);
        out.insert("closed".into(), false.into());
        Value::Object(out)
    })
}

/// A union of open intervals.
pub fn interval_set(set: &IntervalSet, digits: usize) -> Value {
    let interval = |i: &crate::stability::AlgebraicInterval| json!({ "lower": plain_end(i.lower.as_ref(), digits), "upper": plain_end(i.upper.as_ref(), digits) });
    set.intervals().iter().map(interval).collect::<Vec<_>>().into()
}

/// A stable set: each end with its cause, frequency and margin.
pub fn stable_set(set: &StableSet, problem: &Problem, digits: usize) -> Value {
    let interval = |i: &crate::stability::StableInterval| json!({ "lower": end(i.lower.as_ref(), problem, digits), "upper": end(i.upper.as_ref(), problem, digits) });
    set.intervals().iter().map(interval).collect::<Vec<_>>().into()
}

/// One end with all that is known about it.
fn end(end: Option<&End>, problem: &Problem, digits: usize) -> Value {
    let Some(end) = end else { return Value::Null };
    let mut out = number(&end.value, digits);
    out.insert("cause".into(), end.causes.to_string().into());
    if let Some(boundary) = boundary::exact_boundary(&end.causes, problem) {
        out.insert("boundary".into(), boundary.into());
    }
    frequency_fields(&mut out, digits, |bits| problem.frequency(end, bits));
    out.insert("closed".into(), false.into());
    let margin = margin(&end.value, problem.free().first().and_then(|f| f.nominal.as_ref()), digits);
    out.insert("margin_factor".into(), margin.as_ref().map_or(Value::Null, |m| m.factor.clone().into()));
    let decibels = margin.as_ref().and_then(|m| m.decibels.as_deref());
    out.insert("margin_db".into(), real::json_number(decibels));
    Value::Object(out)
}

/// The frequency of a complex pair in all its units; `null` where it has none.
pub fn frequency_fields(out: &mut Map<String, Value>, digits: usize, at: impl Fn(u64) -> Option<Frequency>) {
    let places = digits.min(JSON_NUMBER_DIGITS);
    // One enclosure is narrow enough for nearly every decimal; only a value next to a tie asks for another.
    let once = at(real::bits_for(digits));
    let pick = |part: fn(&Frequency) -> Option<Enclosure>| {
        let narrow = once.as_ref().and_then(part)?;
        let decimal = enclosed_decimal(narrow.lower(), narrow.upper(), places);
        decimal.or_else(|| real::enclosed(places, |bits| at(bits).as_ref().and_then(part)))
    };
    out.insert("frequency_hz".into(), real::json_number(pick(|f| f.hertz.clone()).as_deref()));
    let enclosure = once.as_ref().and_then(|f| f.hertz.clone());
    out.insert(
        "frequency_enclosure".into(),
        enclosure.map_or(Value::Null, |e| json!([e.lower().to_string(), e.upper().to_string()])),
    );
    out.insert("radians_per_second".into(), real::json_number(pick(|f| f.radians_per_second.clone()).as_deref()));
    out.insert("angle".into(), real::json_number(pick(|f| f.angle.clone()).as_deref()));
}

/// What every answer about one parameter begins with.
pub fn question(problem: &Problem, schema: &str) -> Map<String, Value> {
    let mut out = Map::new();
    let free = problem.parameter();
    out.insert("schema".into(), schema.into());
    out.insert("title".into(), problem.title().unwrap_or_default().into());
    out.insert("time".into(), problem.time().name().into());
    out.insert("parameter".into(), free.name.as_str().into());
    out.insert("unit".into(), free.unit.as_deref().map_or(Value::Null, Value::from));
    out.insert("nominal".into(), exact(free.nominal.as_ref()));
    out.insert("set".into(), set(problem.set()));
    out.insert("domain".into(), domain(&free.domain));
    region(&mut out, problem.region());
    out
}

/// What every answer about a point begins with.
pub fn point(problem: &Problem, schema: &str) -> Map<String, Value> {
    let mut out = Map::new();
    out.insert("schema".into(), schema.into());
    out.insert("title".into(), problem.title().unwrap_or_default().into());
    out.insert("time".into(), problem.time().name().into());
    out.insert("set".into(), set(problem.set()));
    region(&mut out, problem.region());
    out
}

/// The radius or decay rate, where one was asked for.
pub fn region(out: &mut Map<String, Value>, region: &Region) {
    for (name, value) in [("radius", region.radius()), ("decay", region.decay())] {
        if value.is_some() {
            out.insert(name.into(), exact(value));
        }
    }
}

/// Puts into a document that there is no answer and why: each of `keys` is `null`.
pub fn undecided(out: &mut Map<String, Value>, keys: &[&str], stopped: &Exhausted) {
    for key in keys {
        out.insert((*key).into(), Value::Null);
    }
    out.insert("undecided".into(), json!({ "budget": stopped.budget, "reached": stopped.reached }));
}

/// A document about a point whose answer the budget did not allow.
pub fn undecided_point(schema: &str, key: &str, problem: &Problem, stopped: &Exhausted) -> Value {
    let mut out = point(problem, schema);
    undecided(&mut out, &[key], stopped);
    Value::Object(out)
}
