//! What the JSON documents share. Exact numbers are strings.

use super::margins::margin;
use super::real::{self, JSON_NUMBER_DIGITS};
use super::region;
use crate::analysis::{Frequency, OneParameter, Point, frequency};
use crate::stability::{End, IntervalSet, Range, StableSet};
use jurist_algebra::number::{Enclosure, Rational};
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
pub fn stable_set(set: &StableSet, question: &OneParameter, digits: usize) -> Value {
    let interval = |i: &crate::stability::StableInterval| json!({ "lower": end(i.lower.as_ref(), question, digits), "upper": end(i.upper.as_ref(), question, digits) });
    set.intervals().iter().map(interval).collect::<Vec<_>>().into()
}

/// One end with all that is known about it.
fn end(end: Option<&End>, question: &OneParameter, digits: usize) -> Value {
    let Some(end) = end else { return Value::Null };
    let mut out = number(&end.value, digits);
    out.insert("cause".into(), end.causes.to_string().into());
    if let Some(boundary) = region::exact_boundary(&end.causes, question) {
        out.insert("boundary".into(), boundary.into());
    }
    frequency_fields(&mut out, digits, |bits| frequency(end, question, bits));
    out.insert("closed".into(), false.into());
    let margin = margin(&end.value, question.nominal.as_ref(), digits);
    out.insert("margin_factor".into(), margin.as_ref().map_or(Value::Null, |m| m.factor.clone().into()));
    let decibels = margin.as_ref().and_then(|m| m.decibels.as_deref());
    out.insert("margin_db".into(), real::json_number(decibels));
    Value::Object(out)
}

/// The frequency of a complex pair in all its units; `null` where it has none.
pub fn frequency_fields(out: &mut Map<String, Value>, digits: usize, at: impl Fn(u64) -> Option<Frequency>) {
    let places = digits.min(JSON_NUMBER_DIGITS);
    let pick = |part: fn(&Frequency) -> Option<Enclosure>| {
        let decimal = real::enclosed(places, |bits| at(bits).as_ref().and_then(part));
        real::json_number(decimal.as_deref())
    };
    out.insert("frequency_hz".into(), pick(|f| f.hertz.clone()));
    let enclosure = at(real::bits_for(digits)).and_then(|f| f.hertz);
    out.insert(
        "frequency_enclosure".into(),
        enclosure.map_or(Value::Null, |e| json!([e.lower().to_string(), e.upper().to_string()])),
    );
    out.insert("radians_per_second".into(), pick(|f| f.radians_per_second.clone()));
    out.insert("angle".into(), pick(|f| f.angle.clone()));
}

/// What every answer about one parameter begins with.
pub fn question(question: &OneParameter, schema: &str) -> Map<String, Value> {
    let mut out = Map::new();
    out.insert("schema".into(), schema.into());
    out.insert("title".into(), question.title.as_deref().unwrap_or_default().into());
    out.insert("time".into(), question.time.name().into());
    out.insert("parameter".into(), question.parameter.as_str().into());
    out.insert("unit".into(), question.unit.as_deref().map_or(Value::Null, Value::from));
    out.insert("nominal".into(), exact(question.nominal.as_ref()));
    out.insert("set".into(), set(&question.set));
    out.insert("domain".into(), domain(&question.domain));
    relative(&mut out, question.radius.as_ref(), question.decay.as_ref());
    out
}

/// The radius or decay rate, where one was asked for.
pub fn relative(out: &mut Map<String, Value>, radius: Option<&Rational>, decay: Option<&Rational>) {
    for (name, value) in [("radius", radius), ("decay", decay)] {
        if value.is_some() {
            out.insert(name.into(), exact(value));
        }
    }
}

/// Why there is no answer.
pub fn undecided(budget: &str, reached: &str) -> Value {
    json!({ "budget": budget, "reached": reached })
}

/// A document without an answer, because a budget ran out before the question was reduced to algebra.
pub fn undecided_document(schema: &str, key: &str, budget: &str, reached: &str) -> Value {
    json!({ "schema": schema, key: null, "undecided": undecided(budget, reached) })
}

/// The same about a point: with all that is known of it.
pub fn undecided_at_point(schema: &str, key: &str, budget: &str, reached: &str, point: &Point) -> Value {
    let mut out = Map::new();
    out.insert("schema".into(), schema.into());
    out.insert("title".into(), point.title.as_deref().unwrap_or_default().into());
    out.insert("time".into(), point.time.name().into());
    out.insert("set".into(), set(&point.set));
    relative(&mut out, point.radius.as_ref(), point.decay.as_ref());
    out.insert(key.into(), Value::Null);
    out.insert("undecided".into(), undecided(budget, reached));
    Value::Object(out)
}
