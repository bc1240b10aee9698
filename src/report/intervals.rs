//! The stable set of one parameter.

use super::layout::{Columns, fraction, named_values, short};
use super::margins::margin;
use super::{json, real, region};
use crate::analysis::{Decision, Intervals, OneParameter, frequency};
use crate::number::Rational;
use crate::poly::RealAlgebraic;
use crate::stability::{End, IntervalSet, Range, StableSet};
use serde_json::Value;

/// The document `jurist/intervals/1`.
pub fn intervals_json(answer: &Intervals, digits: usize) -> Value {
    let mut out = json::question(&answer.question, "jurist/intervals/1");
    match &answer.stable {
        Decision::Decided(set) => {
            out.insert("stable".into(), json::stable_set(set, &answer.question, digits));
        }
        Decision::Undecided { budget, reached } => {
            out.insert("stable".into(), Value::Null);
            out.insert("undecided".into(), json::undecided(budget, reached));
        }
    }
    Value::Object(out)
}

/// The answer for people.
pub fn intervals_text(answer: &Intervals, digits: usize) -> String {
    let question = &answer.question;
    let mut out = format!("{}\n", heading(question));
    out.push_str(&answer_lines(answer, digits));
    out
}

/// The model and the values of the other parameters.
fn heading(question: &OneParameter) -> String {
    let title = question.title.as_deref().unwrap_or("the loop");
    let mut line = format!("{title}, {} time", question.time.name());
    if !question.set.is_empty() {
        line.push_str(&format!(", {}", named_values(&question.set)));
    }
    line
}

/// The intervals, and a line for each end.
pub(super) fn answer_lines(answer: &Intervals, digits: usize) -> String {
    let question = &answer.question;
    let name = &question.parameter;
    let goal = region::goal(question).unwrap_or_else(|| "stable".to_owned());
    let mut asked = name.clone();
    if let Some(unit) = &question.unit {
        asked.push_str(&format!(" in {unit}"));
    }
    let domain = domain_text(name, &question.domain);
    if domain != "all" {
        asked.push_str(&format!(", domain {domain}"));
    }
    match &answer.stable {
        Decision::Undecided { budget, reached } => {
            format!("{asked}: undecided, the budget ran out: {budget}; reached: {reached}\n")
        }
        Decision::Decided(set) if set.is_empty() => format!("{asked}: {goal} nowhere\n"),
        Decision::Decided(set) => {
            let mut out = format!("{asked}: {goal} for\n");
            for interval in set_lines(name, &set.to_interval_set(), digits) {
                out.push_str(&format!("    {interval}\n"));
            }
            out.push_str(&end_lines(set, question, digits));
            out
        }
    }
}

/// `K > 0`, `0 < K < 3`, `all`.
pub(super) fn domain_text(name: &str, range: &Range) -> String {
    match (&range.lower, &range.upper) {
        (None, None) => "all".to_owned(),
        (Some(l), None) => format!("{name} > {}", short(l)),
        (None, Some(u)) => format!("{name} < {}", short(u)),
        (Some(l), Some(u)) => format!("{} < {name} < {}", short(l), short(u)),
    }
}

/// `0.038 < K < 550.9`, one line for each interval.
pub(super) fn set_lines(name: &str, set: &IntervalSet, digits: usize) -> Vec<String> {
    let decimal = |x: &RealAlgebraic| real::rounded(x, digits).decimal;
    let line = |i: &crate::stability::AlgebraicInterval| match (&i.lower, &i.upper) {
        (None, None) => format!("every {name}"),
        (Some(l), None) => format!("{name} > {}", decimal(l)),
        (None, Some(u)) => format!("{name} < {}", decimal(u)),
        (Some(l), Some(u)) => format!("{} < {name} < {}", decimal(l), decimal(u)),
    };
    set.intervals().iter().map(line).collect()
}

/// A row for each end: value, cause, frequency, margin.
fn end_lines(set: &StableSet, question: &OneParameter, digits: usize) -> String {
    let mut columns = Columns::new("    ");
    let mut last: Option<&RealAlgebraic> = None;
    for interval in set.intervals() {
        for end in [&interval.lower, &interval.upper].into_iter().flatten() {
            // Two intervals that touch share an end.
            if last.is_some_and(|l| l.compare(&end.value).is_eq()) {
                continue;
            }
            last = Some(&end.value);
            columns.row(end_cells(end, question, digits));
        }
    }
    if columns.is_empty() { String::new() } else { format!("ends\n{columns}") }
}

fn end_cells(end: &End, question: &OneParameter, digits: usize) -> Vec<String> {
    let decimal = real::rounded(&end.value, digits).decimal;
    let exact = match end.value.exact() {
        Some(exact) if !is_decimal_of(&decimal, &exact) => match fraction(&exact) {
            Ok(whole) => format!("= {whole}"),
            Err(size) => format!("{size}, --json has it"),
        },
        _ => String::new(),
    };
    let places = digits.min(7);
    let pick = |part: fn(&crate::analysis::Frequency) -> Option<crate::number::Enclosure>| {
        real::enclosed(places, |bits| frequency(end, question, bits).as_ref().and_then(part))
    };
    let mut at = Vec::new();
    if let Some(hertz) = pick(|f| f.hertz.clone()) {
        at.push(format!("{hertz} Hz"));
    }
    if let Some(angle) = pick(|f| f.angle.clone()) {
        at.push(format!("{angle} rad"));
    } else if let Some(rate) = pick(|f| f.radians_per_second.clone()) {
        at.push(format!("{rate} rad/s"));
    }
    let causes = region::causes_text(&end.causes, question);
    let cause = if at.is_empty() { causes } else { format!("{causes} at {}", at.join(", ")) };
    let margin = margin(&end.value, question.nominal.as_ref(), places).map(|m| {
        let nominal = question.nominal.as_ref().map(short).unwrap_or_default();
        match m.decibels {
            Some(db) => format!("{} x nominal {nominal} ({db} dB)", decimal_factor(&m.factor, places)),
            None => format!("0 x nominal {nominal}"),
        }
    });
    vec![decimal, exact, cause, margin.unwrap_or_default()]
}

/// An exact factor as a decimal.
fn decimal_factor(factor: &str, digits: usize) -> String {
    match crate::number::parse_number(factor) {
        Ok(value) => crate::number::to_decimal(&value, digits),
        Err(_) => factor.to_owned(),
    }
}

fn is_decimal_of(decimal: &str, value: &Rational) -> bool {
    crate::number::parse_number(decimal).as_ref() == Ok(value)
}
