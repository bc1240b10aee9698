//! The answer for people.

use crate::answer::{Part, Point, ShipAnswer};
use crate::fewest::Fewest;
use crate::format::Format;
use crate::limits::LimitsByBits;
use crate::ranges::{Moved, NodeRange, Ranges};
use crate::run::Overflow;
use crate::shipped::Stored;
use jurist_algebra::number::{Integer, Rational, enclosed_decimal, to_decimal};
use jurist_algebra::real::Real;
use jurist_engine::answer::{ToleranceAnswer, Verdict};
use jurist_engine::error::Error;
use jurist_engine::model::Form;
use jurist_engine::response::{DelayMargin, Margins, StableMargins};
use jurist_engine::stability::StableSet;
use jurist_engine::stability::boxes::BoxDecision;
use jurist_show::Text;
use jurist_show::bounded::{at_least, at_most};
use jurist_show::intervals::{heading, nowhere, stable_lines};
use jurist_show::layout::{Columns, named_values};
use jurist_show::real::enclosed;
use jurist_show::verdict::verdict_line;
use std::fmt::Write;

/// Digits of bounds and factors.
const FEW: usize = 6;

/// As many digits show the rounding of a `float64`.
const MOST_DIGITS: usize = 20;

/// What a text takes.
const TAKES: &str = "a text takes all text";

impl ShipAnswer {
    /// The answer for people.
    pub fn text(&self, digits: usize) -> String {
        let asked = &self.shipped.asked;
        let mut out = format!("{}\n", heading(&self.shipped.exact));
        writeln!(out, "controller '{}', {}: {}", asked.block, asked.realisation.words(), asked.format.words())
            .expect(TAKES);
        if let Some(signal) = &asked.signal {
            let beyond = match asked.overflow {
                Overflow::Saturate => "saturating",
                Overflow::Wrap => "wrapping around",
            };
            writeln!(out, "signals: {}, {beyond}", Format::Fixed(*signal).words()).expect(TAKES);
        }
        out.push_str(&coefficients(&self.shipped.coefficients, digits));
        for (name, point) in [("as written", &self.exact), ("as stored", &self.rounded)] {
            let verdict = &point.verdict;
            writeln!(out, "{name:<11}{}", verdict_line(verdict.problem(), verdict.value())).expect(TAKES);
        }
        for change in self.shipped.changes() {
            writeln!(out, "{:<11}{change}", "").expect(TAKES);
        }
        out.push_str(&self.margins(digits.min(10)));
        for found in &self.rounded.requirements {
            writeln!(out, "as stored, {}", found.text(digits)).expect(TAKES);
        }
        out.push_str(&self.every());
        if let Some(fewest) = &self.fewest {
            out.push_str(&part("fewest bits", fewest, fewest_text));
        }
        if let Some(limits) = &self.limits {
            out.push_str(&part("limits by bits", limits, |limits| limits_text(limits, digits)));
        }
        if let Some(ranges) = &self.ranges {
            out.push_str(&part("ranges", ranges, |ranges| self.ranges_text(ranges)));
        }
        out
    }

    /// What is proved of signals, in sentences.
    pub fn bounds(&self) -> Vec<String> {
        let Some(Ok(ranges)) = &self.ranges else { return Vec::new() };
        let asked = &self.shipped.asked;
        let mut out = Vec::new();
        if !asked.inputs.is_empty() {
            let inputs: Vec<String> =
                asked.inputs.iter().map(|(name, bound)| format!("|{name}| <= {}", to_decimal(bound, FEW))).collect();
            let node = |node: &NodeRange| {
                let [_, high] = node.greatest.as_ref()?;
                let fits = if node.holds == Some(true) { ", which fits" } else { "" };
                Some(format!("|{}| <= {}{fits}", node.name, at_most(&(high + &node.with_inputs), FEW)))
            };
            let nodes: Vec<String> = ranges.nodes.iter().filter_map(node).collect();
            let held = if self.is_held() { ", held between samples" } else { "" };
            out.push(format!("From rest under {}{held}: {}.", inputs.join(", "), nodes.join(", ")));
        }
        let moved = |moved: &Moved| {
            let [own, all] = [&moved.by_signals, &moved.with_inputs].map(|most| at_most(most, FEW));
            format!(
                "The rounding of these signals moves {} by at most {own}, limit cycles included; with the inputs rounded as well by at most {all}.",
                moved.output
            )
        };
        out.extend(ranges.moved.iter().map(moved));
        out
    }

    /// Whether inputs may reach a plant behind a hold, between samples.
    fn is_held(&self) -> bool {
        match self.shipped.exact.model().form() {
            Form::Blocks(diagram) => diagram.blocks.iter().any(|block| block.discretization.is_some()),
            _ => false,
        }
    }

    /// Margins of both loops side by side.
    fn margins(&self, digits: usize) -> String {
        let of =
            |point: &Point| point.margins.as_ref().ok().and_then(|m| m.value().stable.clone().zip(Some(m.clone())));
        let (before, after) = (of(&self.exact), of(&self.rounded));
        let Some((_, some)) = before.as_ref().or(after.as_ref()) else { return String::new() };
        let place = some.value().open_loop.cut().name().to_owned();
        let mut columns = Columns::new("    ");
        columns.row(["".into(), "as written".into(), "as stored".into()]);
        type Shown = fn(&StableMargins, usize) -> String;
        let rows: [(&str, Shown); 6] = [
            ("gain up", |m, n| m.gain.upper.as_ref().map_or("any".into(), |end| decimal(&end.value, n))),
            ("gain down", |m, n| m.gain.lower.as_ref().map_or("any".into(), |end| decimal(&end.value, n))),
            ("phase, degrees", |m, n| enclosed(n, |bits| m.phase.degrees(bits)).unwrap_or("any".into())),
            ("delay, samples", |m, _| match m.delay {
                DelayMargin::Samples(n) => n.to_string(),
                DelayMargin::SamplesAtLeast(n) => format!("at least {n}"),
                _ => "any".into(),
            }),
            ("modulus", |m, n| decimal(&m.modulus, n)),
            ("peak sensitivity", |m, n| decimal(&m.peak_sensitivity, n)),
        ];
        for (name, shown) in rows {
            let cell = |found: &Option<(StableMargins, jurist_engine::answer::Answer<Margins>)>| {
                found.as_ref().map_or("none".into(), |(m, _)| shown(m, digits))
            };
            columns.row([name.into(), cell(&before), cell(&after)]);
        }
        format!("margins at '{place}'\n{columns}")
    }

    fn every(&self) -> String {
        let mut out = match &self.every_rounding {
            None => "every rounding: nothing is rounded\n".into(),
            Some(every) => part("every rounding", every, |answer| self.every_text(answer.value())),
        };
        let model = self.shipped.exact.model();
        let constants = model.constants().iter().filter(|c| c.tolerance.is_some()).map(|c| c.name.as_str());
        let parameters = model.parameters().iter().filter(|p| p.tolerance.is_some()).map(|p| p.name.as_str());
        let named: Vec<&str> = constants.chain(parameters).collect();
        if !named.is_empty() && self.every_rounding.is_some() {
            writeln!(
                out,
                "    tolerances of the model ({}) are not looked at here: 'jurist tolerance' of the model of --every looks at both",
                named.join(", ")
            )
            .expect(TAKES);
        }
        out
    }

    fn every_text(&self, answer: &ToleranceAnswer) -> String {
        let what = match self.shipped.asked.format {
            Format::Fixed(fixed) if fixed.rounding.error_in_halves() != (-1, 1) => "errors of that rounding",
            _ => "half a unit in the last place",
        };
        let wanted = if answer.required.is_empty() { "stable" } else { "stable with all requirements met" };
        let is_met = |point: &Point| {
            point.verdict.value().verdict == Verdict::Stable && point.requirements.iter().all(|found| found.met)
        };
        if matches!(answer.decision, BoxDecision::NotStable { .. }) && !is_met(&self.exact) {
            return format!("the loop is not {wanted} even as it is written");
        }
        let mut out = match &answer.decision {
            BoxDecision::Stable(proof) => {
                let cells = proof.cells();
                format!(
                    "{wanted} for all coefficients within {what} (proof: {cells} {})",
                    if cells == 1 { "cell" } else { "cells" }
                )
            }
            BoxDecision::NotStable { witness } => {
                let point = witness.as_ref().map(|witness| {
                    let names = self.shipped.coefficients.iter().map(|c| c.name.clone());
                    let values: Vec<(String, Rational)> = names.zip(witness.point.iter().cloned()).collect();
                    format!(": not at {}", named_values(&values))
                });
                format!("not for all coefficients within {what} {wanted}{}", point.unwrap_or_default())
            }
            BoxDecision::Undecided { why, .. } => format!("undecided for coefficients within {what}: {why}"),
        };
        if let Some(factor) = &answer.factor {
            let upper = factor.upper.as_ref().map(|upper| format!(", not {}", at_most(upper, FEW)));
            let upper = upper.or_else(|| Some(" or more: larger ones were not looked for".to_owned()));
            write!(
                out,
                "\n    these errors may be {} times as large{}",
                at_least(&factor.lower, FEW),
                upper.unwrap_or_default()
            )
            .expect(TAKES);
        }
        out
    }

    fn ranges_text(&self, ranges: &Ranges) -> String {
        let asked = &self.shipped.asked;
        let mut out = String::new();
        if !asked.inputs.is_empty() {
            let bounds: Vec<String> =
                asked.inputs.iter().map(|(name, bound)| format!("|{name}| <= {}", to_decimal(bound, FEW))).collect();
            write!(out, "from rest under {}", bounds.join(", ")).expect(TAKES);
            if self.is_held() {
                out.push_str(" held between samples");
            }
            let others = self
                .shipped
                .exact
                .model()
                .inputs()
                .iter()
                .filter(|i| asked.inputs.iter().all(|(name, _)| *name != i.name));
            let others: Vec<&str> = others.map(|name| name.name.as_str()).collect();
            if !others.is_empty() {
                write!(out, ", with {} = 0", others.join(" = ")).expect(TAKES);
            }
            let mut columns = Columns::new("    ");
            for node in &ranges.nodes {
                let Some([_, high]) = &node.greatest else { continue };
                let verdict = match (node.holds, &node.limit) {
                    (_, None) => String::new(),
                    (Some(true), Some(limit)) => format!("fits: its format goes to {}", at_least(limit, FEW)),
                    (Some(false), Some(limit)) => {
                        format!("does not fit: some inputs bring it above {}", at_least(limit, FEW))
                    }
                    (None, Some(limit)) => format!("not decided: its format goes to {}", at_least(limit, FEW)),
                };
                let rounding = if node.with_inputs.is_zero() {
                    String::new()
                } else {
                    format!("and {} by rounding", at_most(&node.with_inputs, FEW))
                };
                columns.row([format!("|{}| <=", node.name), at_most(high, FEW), rounding, verdict]);
            }
            write!(out, "\n{}", columns.to_string().trim_end()).expect(TAKES);
        } else {
            out.push_str("no input has a bound: add inputs = { NAME = BOUND } to [ship]");
        }
        if matches!(asked.format, Format::Binary(_)) {
            out.push_str("\n    what the rounding of signals in floating point adds is not counted");
        }
        for moved in &ranges.moved {
            let [own, all] = [&moved.by_signals, &moved.with_inputs].map(|most| at_most(most, FEW));
            write!(
                out,
                "\n    the rounding of these signals moves {} by at most {own}, limit cycles included,\n        and with the inputs rounded as well by {all}",
                moved.output
            )
            .expect(TAKES);
        }
        out
    }
}

fn decimal(value: &Real, digits: usize) -> String {
    jurist_show::real::rounded(value, digits).decimal
}

/// A part of the answer, or why there is none.
fn part<T>(name: &str, part: &Part<T>, text: impl FnOnce(&T) -> String) -> String {
    match part {
        Ok(found) => format!("{name}: {}\n", text(found)),
        Err(Error::Stopped(stopped)) => format!("{name}: not decided ({})\n", stopped.stop),
        Err(error) => format!("{name}: none; {error}\n"),
    }
}

fn fewest_text(fewest: &Fewest) -> String {
    let list = |bits: &[i64]| bits.iter().map(i64::to_string).collect::<Vec<_>>().join(", ");
    let mut out = match (fewest.every_rounding, fewest.refuted) {
        (Some(bits), Some(refuted)) => {
            format!("{bits} behind the point for every rounding within half a unit, {refuted} are not enough for that")
        }
        (Some(bits), None) => format!("{bits} behind the point for every rounding within half a unit"),
        (None, _) => "no number of bits was proved for every rounding".to_owned(),
    };
    let from = [(fewest.every_rounding, "nearest", &fewest.nearest), (fewest.floor_from, "down", &fewest.floor)];
    for (from, mode, also) in from {
        let Some(from) = from else {
            if !also.is_empty() {
                write!(out, "\n    rounded {mode}: it holds with {}", list(also)).expect(TAKES);
            }
            continue;
        };
        // Neighbours of the proved ones belong to them.
        let mut from = from;
        while also.contains(&(from - 1)) {
            from -= 1;
        }
        let rest: Vec<i64> = also.iter().copied().filter(|bits| *bits < from).collect();
        let rest = if rest.is_empty() {
            String::new()
        } else {
            format!(", and with {}, but not with all between", list(&rest))
        };
        let bits = if from == 1 { "bit" } else { "bits" };
        write!(out, "\n    rounded {mode}: it holds from {from} {bits} on{rest}").expect(TAKES);
    }
    out
}

fn limits_text(limits: &LimitsByBits, digits: usize) -> String {
    let mut columns = Columns::new("    ");
    let row = |set: &StableSet| match set.intervals() {
        [] => nowhere(set.undecided()).to_owned(),
        _ => stable_lines(&limits.parameter, set, digits).join("; "),
    };
    columns.row(["exact".into(), row(limits.exact.value())]);
    for (bits, answer) in &limits.rows {
        let name = bits.map_or("stored".to_owned(), |bits| bits.to_string());
        columns.row([name, row(answer.value())]);
    }
    format!(
        "stable {} with so many bits behind the point; requirements are not looked at\n{}",
        limits.parameter,
        columns.to_string().trim_end()
    )
}

/// The table of coefficients.
fn coefficients(all: &[Stored], digits: usize) -> String {
    if all.is_empty() {
        return "    no coefficient is stored: all are 0, 1 or -1\n".into();
    }
    let mut columns = Columns::new("    ");
    let has_integers = all.iter().any(|c| c.integer.is_some());
    let last = if has_integers { "integer" } else { "" };
    columns.row(["".into(), "exact".into(), "stored".into(), last.to_owned()]);
    for c in all {
        let [exact, stored] = beside(c, digits);
        let integer = c.integer.as_ref().map(Integer::to_string).unwrap_or_default();
        columns.row([c.name.clone(), exact, stored, integer]);
    }
    columns.to_string()
}

/// A coefficient as written and as stored, with so many more digits that they differ, where they do.
fn beside(c: &Stored, digits: usize) -> [String; 2] {
    let exact = |digits| enclosed_decimal(c.exact.lower(), c.exact.upper(), digits);
    let pair = |digits| Some([exact(digits)?, to_decimal(&c.value, digits)]);
    let is_exact = c.exact.lower() == &c.value && c.exact.upper() == &c.value;
    let most = if is_exact { digits } else { digits.max(MOST_DIGITS) };
    let differ = (digits..=most)
        .filter_map(pair)
        .find(|[exact, stored]| exact.trim_end_matches('0') != stored.trim_end_matches('0'));
    differ.unwrap_or_else(|| [exact(digits).unwrap_or_default(), to_decimal(&c.value, digits)])
}
