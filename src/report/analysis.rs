//! Everything that is said about a loop one parameter at a time.

use super::intervals::{answer_lines, intervals_json};
use super::layout::{named_values, short};
use super::verdict::{verdict_json, verdict_line};
use crate::analysis::Analysis;
use serde_json::{Value, json};

/// The document `jurist/analyze/1`.
pub fn analysis_json(answer: &Analysis, digits: usize) -> Value {
    let verdict = answer.verdict.as_ref().map_or(Value::Null, verdict_json);
    let parameters: Vec<Value> = answer.intervals.iter().map(|i| intervals_json(i, digits)).collect();
    json!({ "schema": "jurist/analyze/1", "verdict": verdict, "parameters": parameters })
}

/// The analysis for people.
pub fn analysis_text(answer: &Analysis, digits: usize) -> String {
    let mut out = String::new();
    if let Some(verdict) = &answer.verdict {
        let title = verdict.title.as_deref().unwrap_or("the loop");
        out.push_str(&format!("{title}, {} time\n", verdict.time.name()));
        if !verdict.set.is_empty() {
            out.push_str(&format!("at {}\n", named_values(&verdict.set)));
        }
        out.push_str(&format!("    {}\n", verdict_line(verdict)));
    } else if let Some(first) = answer.intervals.first() {
        let title = first.question.title.as_deref().unwrap_or("the loop");
        out.push_str(&format!("{title}, {} time\n", first.question.time.name()));
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
