//! The rows of a sweep: one for each interval, one for a verdict, for a set without intervals, and for what has no answer.
//! Columns, their order and the bytes of a file are those of the Python package.

use super::key::{Question, VERDICT};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::parse_number;
use jurist_algebra::real::Real;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error};
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;
use jurist_engine::stability::{End, StableSet};
use jurist_show::Document;
use jurist_show::diagnostics::render_error;
use serde_json::{Value, json};
use std::cmp::Ordering;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A row: columns with their values, in order; what there is nothing to say of is left out.
pub(in crate::cli) type Row = serde_json::Map<String, Value>;

/// Digits of the decimals.
const DIGITS: usize = 17;

/// The title of a model, or the name of its text.
fn name(model: &Model) -> &str {
    model.title().filter(|title| !title.is_empty()).unwrap_or(&model.source().name)
}

/// The rows of a question.
pub(in crate::cli) fn rows(model: &Model, question: &Question, budget: &Budget) -> Vec<Row> {
    let mut base = Row::new();
    base.insert("key".into(), question.key(&model.source().text).into());
    base.insert("model".into(), name(model).into());
    base.insert("parameter".into(), question.ask.as_str().into());
    base.insert("status".into(), "decided".into());
    for (name, value) in &question.point {
        base.insert(format!("p.{name}"), value.to_string().into());
    }
    let answered = catch_unwind(AssertUnwindSafe(|| answered(model, question, budget)));
    let (status, code, message) = match answered {
        Ok(Ok(found)) if found.is_empty() => return vec![base],
        Ok(Ok(found)) => {
            let row = |columns: Row| base.clone().into_iter().chain(columns).collect();
            return found.into_iter().map(row).collect();
        }
        Ok(Err(error)) => failure(error),
        Err(_) => ("defect", Code::Internal.to_string(), "error[E-internal]: this is a defect of jurist".to_owned()),
    };
    base.insert("status".into(), status.into());
    base.insert("code".into(), code.into());
    base.insert("message".into(), message.into());
    vec![base]
}

/// The columns of each row of an answer.
fn answered(model: &Model, question: &Question, budget: &Budget) -> Result<Vec<Row>, Error> {
    let mut asked = model.ask();
    for (name, value) in &question.point {
        asked = asked.set(name, value.clone());
    }
    if question.ask == VERDICT {
        let document = asked.verdict(budget)?.json(DIGITS);
        let document = serde_json::to_value(&document).unwrap_or_default();
        let names = ["verdict", "degree", "inside", "on", "outside", "infinite"];
        return Ok(vec![names.iter().filter_map(|n| column(n, &document[*n])).collect()]);
    }
    let answer = asked.free(&question.ask).stable_set(budget)?;
    let documents = budget.enter(|| serde_json::to_value(answer.json(DIGITS)).unwrap_or_default())?;
    let set: &StableSet = answer.value();
    let mut out = Vec::new();
    for (k, interval) in set.intervals().iter().enumerate() {
        let mut row = Row::new();
        row.insert("interval".into(), k.into());
        for (side, end) in [("lower", &interval.lower), ("upper", &interval.upper)] {
            row.extend(end_columns(side, end.as_ref(), &documents["stable"][k][side]));
        }
        out.push(row);
    }
    Ok(out)
}

/// A column that has something to say.
fn column(name: &str, value: &Value) -> Option<(String, Value)> {
    (!value.is_null()).then(|| (name.to_owned(), value.clone()))
}

fn end_columns(side: &str, end: Option<&End>, document: &Value) -> Row {
    let Some(end) = end else {
        // No number of JSON is infinite.
        return Row::from_iter([(side.to_owned(), Value::Null)]);
    };
    let causes: Vec<&str> = document["cause"].as_str().unwrap_or_default().split('+').collect();
    let parts = [
        ("", json!(nearest(&end.value))),
        ("_decimal", document["decimal"].clone()),
        ("_exact", document["exact"].clone()),
        ("_polynomial", document["polynomial"].clone()),
        ("_enclosure", document["enclosure"].clone()),
        ("_causes", json!(causes)),
        ("_closed", json!(end.closed)),
        ("_hz", document["frequency_hz"].clone()),
    ];
    parts.iter().filter_map(|(part, value)| column(&format!("{side}{part}"), value)).collect()
}

/// The nearest double: both bounds round alike.
fn nearest(value: &Real) -> f64 {
    let mut value = value.refined_to_digits(DIGITS);
    loop {
        let (low, high) = value.enclosure();
        let (low, high) = (low.to_f64_approximate(), high.to_f64_approximate());
        if low == high {
            return low;
        }
        value = value.refined_further();
    }
}

/// Status, code and message of what has no answer.
fn failure(error: Error) -> (&'static str, String, String) {
    let refused =
        |error: &Diagnostics| ("refused", error.code().to_string(), render_error(error, false).trim_end().to_owned());
    match error {
        Error::Refused(error) => refused(&error),
        Error::Undefined(why) => {
            let message = format!("the model is undefined for these values: {why}");
            refused(&Diagnostic::error(Code::Undefined, message).help("set the parameters to other values").into())
        }
        Error::Stopped(stopped) => ("undecided", "undecided".to_owned(), format!("undecided: {stopped}")),
        other => ("defect", Code::Internal.to_string(), other.to_string()),
    }
}

/// By parameter, values, key and interval.
pub(in crate::cli) fn order(a: &Row, b: &Row) -> Ordering {
    let text = |row: &Row, name: &str| row.get(name).and_then(Value::as_str).unwrap_or_default().to_owned();
    let values = |row: &Row| {
        let mut values: Vec<_> = row
            .iter()
            .filter(|(name, _)| name.starts_with("p."))
            .map(|(name, value)| (name.clone(), parse_number(value.as_str().unwrap_or_default()).unwrap_or_default()))
            .collect();
        values.sort();
        values
    };
    let whole = |row: &Row| row.get("interval").and_then(Value::as_u64).unwrap_or(0);
    text(a, "parameter")
        .cmp(&text(b, "parameter"))
        .then_with(|| values(a).cmp(&values(b)))
        .then_with(|| text(a, "key").cmp(&text(b, "key")))
        .then_with(|| whole(a).cmp(&whole(b)))
}
