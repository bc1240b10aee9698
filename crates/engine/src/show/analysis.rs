//! Everything that is said about a loop one parameter at a time.

use super::intervals::{answer_lines, intervals_json};
use super::json;
use super::layout::{called, named_values, short};
use super::verdict::{verdict_json, verdict_line};
use crate::analysis::{Analysis, Decision};
use serde_json::{Value, json};

/// The document `jurist/analyze/1`.
pub fn analysis_json(answer: &Analysis, digits: usize) -> Value {
    let verdict = match (&answer.verdict, &answer.point) {
        (Some(Decision::Decided(verdict)), _) => verdict_json(verdict),
        (Some(Decision::Undecided { budget, reached }), Some(point)) => {
            json::undecided_at_point("jurist/verdict/1", "verdict", budget, reached, point)
        }
        _ => Value::Null,
    };
    let parameters: Vec<Value> = answer.intervals.iter().map(|i| intervals_json(i, digits)).collect();
    json!({ "schema": "jurist/analyze/1", "verdict": verdict, "parameters": parameters })
}

/// The analysis for people.
pub fn analysis_text(answer: &Analysis, digits: usize) -> String {
    let mut out = String::new();
    if let (Some(verdict), Some(point)) = (&answer.verdict, &answer.point) {
        let title = called(point.title.as_deref());
        out.push_str(&format!("{title}, {} time\n", point.time.name()));
        if !point.set.is_empty() {
            out.push_str(&format!("at {}\n", named_values(&point.set)));
        }
        let line = match verdict {
            Decision::Decided(verdict) => verdict_line(verdict),
            Decision::Undecided { budget, reached } => {
                format!("undecided, the budget ran out: {budget}; reached: {reached}")
            }
        };
        out.push_str(&format!("    {line}\n"));
    } else if let Some(first) = answer.intervals.first() {
        let title = called(first.question.title.as_deref());
        out.push_str(&format!("{title}, {} time\n", first.question.time.name()));
        // One parameter alone may be without a value: the one that is asked about.
        let name = &first.question.parameter;
        out.push_str(&format!("    no verdict: parameter {name} has no nominal value\n"));
    }
    for intervals in &answer.intervals {
        let question = &intervals.question;
        let nominal = question.nominal.as_ref().map(|n| format!("{} = {} varied", question.parameter, short(n)));
        let nominal = nominal.unwrap_or_else(|| format!("{} varied", question.parameter));
        let others = if question.set.is_empty() { String::new() } else { format!(", {}", named_values(&question.set)) };
        out.push_str(&format!("\n{nominal}{others}\n"));
        out.push_str(&answer_lines(intervals, digits));
    }
    out
}
