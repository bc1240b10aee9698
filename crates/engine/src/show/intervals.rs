//! The stable set of one parameter.

use super::layout::{Columns, called, fraction, named_values, short, visible};
use super::margins::margin;
use super::{json, real, region};
use crate::analysis::{Decision, Intervals, OneParameter, frequency};
use crate::stability::{Cause, End, IntervalSet, Range, StableSet};
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::poly::RealAlgebraic;
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
    let title = called(question.title.as_deref());
    let mut line = format!("{title}, {} time", question.time.name());
    if !question.set.is_empty() {
        line.push_str(&format!(", {}", named_values(&question.set)));
    }
    line
}

/// The intervals, and a line for each end.
pub fn answer_lines(answer: &Intervals, digits: usize) -> String {
    let question = &answer.question;
    let name = &question.parameter;
    let goal = region::goal(question).unwrap_or_else(|| "stable".to_owned());
    let mut asked = name.clone();
    if let Some(unit) = &question.unit {
        asked.push_str(&format!(" in {}", visible(unit)));
    }
    let domain = domain_text(name, &question.domain);
    if domain != "all" {
        asked.push_str(&format!(", domain {domain}"));
    }
    match &answer.stable {
        Decision::Undecided { budget, reached } => {
            format!("{asked}: undecided, the budget ran out: {budget}; reached: {reached}\n")
        }
        Decision::Decided(set) if set.is_empty() && question.polynomial.is_none() => {
            format!("{asked}: {goal} nowhere, undefined for every {name}\n")
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
pub fn domain_text(name: &str, range: &Range) -> String {
    match (&range.lower, &range.upper) {
        (None, None) => "all".to_owned(),
        (Some(l), None) => format!("{name} > {}", short(l)),
        (None, Some(u)) => format!("{name} < {}", short(u)),
        (Some(l), Some(u)) => format!("{} < {name} < {}", short(l), short(u)),
    }
}

/// `0.038 < K < 550.9`, one line for each interval.
pub fn set_lines(name: &str, set: &IntervalSet, digits: usize) -> Vec<String> {
    let ends = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().collect::<Vec<_>>();
    let mut decimals = distinct_decimals(&ends, digits).into_iter();
    let mut decimal = |end: &Option<RealAlgebraic>| end.as_ref().and_then(|_| decimals.next());
    let line = |i: &crate::stability::AlgebraicInterval| match (decimal(&i.lower), decimal(&i.upper)) {
        (None, None) => format!("every {name}"),
        (Some(l), None) => format!("{name} > {l}"),
        (None, Some(u)) => format!("{name} < {u}"),
        (Some(l), Some(u)) => format!("{l} < {name} < {u}"),
    };
    set.intervals().iter().map(line).collect()
}

/// Digits up to which two ends that are close are told apart.
const MOST_DIGITS: usize = 100;

/// Decimals of ascending values. Different values that round to the same decimal have more digits, so many
/// that all of them can be told apart.
fn distinct_decimals(values: &[&RealAlgebraic], digits: usize) -> Vec<String> {
    let decimals = |values: &[&RealAlgebraic], digits| -> Vec<String> {
        values.iter().map(|x| real::rounded(x, digits).decimal).collect()
    };
    let mut out = decimals(values, digits);
    let mut first = 0;
    while first < values.len() {
        let same = out[first..].iter().take_while(|d| **d == out[first]).count();
        let group = &values[first..first + same];
        let differ: Vec<bool> = group.windows(2).map(|pair| pair[0].compare(pair[1]).is_ne()).collect();
        if differ.contains(&true) {
            // Exact decimals have no trailing zeros, so that only their values tell.
            let tell = |d: &Vec<String>| {
                let apart =
                    |(pair, differ): (&[String], &bool)| !differ || parse_number(&pair[0]) != parse_number(&pair[1]);
                d.windows(2).zip(&differ).all(apart)
            };
            if let Some(longer) = (digits + 1..=MOST_DIGITS).map(|more| decimals(group, more)).find(tell) {
                out.splice(first..first + same, longer);
            }
        }
        first += same;
    }
    out
}

/// A row for each end: value, cause, frequency, margin.
fn end_lines(set: &StableSet, question: &OneParameter, digits: usize) -> String {
    let mut columns = Columns::new("    ");
    let mut ends: Vec<&End> = set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten().collect();
    // Two intervals that touch share an end.
    ends.dedup_by(|b, a| a.value.compare(&b.value).is_eq());
    let values: Vec<&RealAlgebraic> = ends.iter().map(|end| &end.value).collect();
    for (end, decimal) in ends.iter().zip(distinct_decimals(&values, digits)) {
        columns.row(end_cells(end, decimal, question, digits));
    }
    if columns.is_empty() { String::new() } else { format!("ends\n{columns}") }
}

fn end_cells(end: &End, decimal: String, question: &OneParameter, digits: usize) -> Vec<String> {
    let exact = match end.value.exact() {
        Some(exact) if !is_decimal_of(&decimal, &exact) => match fraction(&exact) {
            Ok(whole) => format!("= {whole}"),
            Err(size) => format!("{size}, --json has it"),
        },
        _ => String::new(),
    };
    let places = digits.min(7);
    let pick = |part: fn(&crate::analysis::Frequency) -> Option<jurist_algebra::number::Enclosure>| {
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
    let mut cause = if at.is_empty() { causes } else { format!("{causes} at {}", at.join(", ")) };
    if end.causes.contains(Cause::Pole) {
        cause.push_str(": the model is undefined here");
    }
    // A gain margin of a time means nothing in decibels.
    let is_time = question.sample_time.as_ref().is_some_and(|(n, d)| !(n.is_constant() && d.is_constant()));
    let margin = margin(&end.value, question.nominal.as_ref(), places).and_then(|m| {
        let nominal = question.nominal.as_ref().map(short).unwrap_or_default();
        // That an end at 0 is 0 x nominal goes without saying.
        let decibels = m.decibels?;
        let factor = format!("{} x nominal {nominal}", decimal_factor(&m.factor, places));
        Some(if is_time { factor } else { format!("{factor} ({decibels} dB)") })
    });
    vec![decimal, exact, cause, margin.unwrap_or_default()]
}

/// An exact factor as a decimal.
fn decimal_factor(factor: &str, digits: usize) -> String {
    match parse_number(factor) {
        Ok(value) => jurist_algebra::number::to_decimal(&value, digits),
        Err(_) => factor.to_owned(),
    }
}

fn is_decimal_of(decimal: &str, value: &Rational) -> bool {
    parse_number(decimal).as_ref() == Ok(value)
}
