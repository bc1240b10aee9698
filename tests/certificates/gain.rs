//! Certificates of a gain beside a fixed dead time: accepted by both checkers, and what they accept after a change is true.

use crate::helpers::certificates::checkers::{accept, python, reject, reject_or_find_true};
use crate::helpers::certificates::{emitted, emitted_if_any, with};
use crate::helpers::model::{example_text, read};
use crate::helpers::number::number;
use crate::helpers::thorough::{count, tried};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::stability::Range;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

fn written(function: &str) -> String {
    format!(
        "time = 'continuous'\nparameters.K = {{ nominal = 1, min = -5, max = 12 }}\nloop.characteristic = '{function}'\n"
    )
}

/// Retarded with one and several dead times, a root at `s = 0` for one value and a zero at `s = 0` or on the axis, a gain in the
/// highest power, a divisor, of neutral type, without a stable value.
const FUNCTIONS: [&str; 13] = [
    "s + 1 + K*exp(-s)",
    "s^2 + s + 1 + K*(s + 2)*exp(-s/2)",
    "s - 1/2 + K*exp(-s/2)",
    "s^3 + 2*s^2 + 3*s + K*(s + 1)*exp(-2*s)",
    "s^2 + s/10 + 4 + K*s*exp(-s)",
    "s^2 + s + 4 + K*(s^2 + 9)*exp(-s)/40",
    "(s + 1)*(s + 2) + K*(1 + s*exp(-s)/2 + exp(-2*s))",
    "s*(s + 1) + s^2/3*exp(-s) + K",
    "(K + 6)*s^2 + s + 1 + exp(-s)/2",
    "(s + 1)/(K - 1) + exp(-s)",
    "s^2 + s + K + (s + K/3)*exp(-s/3)",
    "s^2 - s + 1 + K*exp(-s)",
    "s^2/10 + s + 2*K*exp(-3*s/10) + K*exp(-s/10)",
];

/// The cells of a certificate.
fn cells(certificate: &Json) -> Option<Vec<(Rational, Rational, usize)>> {
    let Json::List(list) = certificate.get("statement")?.get("cells")? else { return None };
    let cell = |json: &Json| {
        let (Json::List(between), Json::Count(right)) = (json.get("between")?, json.get("right")?) else { return None };
        let [Json::Text(a), Json::Text(b)] = between.as_slice() else { return None };
        Some((number(a), number(b), *right as usize))
    };
    list.iter().map(cell).collect()
}

/// Cells with what the engine says of them: most changes of a certificate leave most cells as they are.
type Known = RefCell<BTreeMap<String, bool>>;

/// Whether the engine says the same of all cells.
fn is_true(model: &str, certificate: &Json, known: &Known) -> bool {
    let Some(cells) = cells(certificate) else { return false };
    let Some(set) = certificate.get("statement").and_then(|s| s.get("set")) else { return false };
    cells.iter().all(|cell| {
        let name = format!("{cell:?} {}", set.to_text());
        let before = known.borrow().get(&name).copied();
        before.unwrap_or_else(|| {
            let found = is_true_of_cell(model, set, cell);
            known.borrow_mut().insert(name, found);
            found
        })
    })
}

/// By the limits in a domain a little larger than the cell, and the roots in the middle.
fn is_true_of_cell(model: &str, set: &Json, (a, b, right): &(Rational, Rational, usize)) -> bool {
    let budget = Budget::unlimited();
    let Json::Object(set) = set else { return false };
    let asked = || {
        let value = |json: &Json| if let Json::Text(text) = json { number(text) } else { Rational::ZERO };
        set.iter().fold(read(model).ask(), |ask, (name, json)| ask.set(name, value(json)))
    };
    let tiny = (b - a) * number("1/1000000000000000000");
    let domain = Range::between(Some(a - &tiny), Some(b + &tiny));
    let found = asked().free("K").domain("K", domain).stable_set(&budget).expect(model);
    let middle = (a + b) * number("1/2");
    let verdict = asked().set("K", middle).verdict(&budget).expect(model);
    let is_whole = match found.value().intervals() {
        [] => *right > 0,
        [one] => *right == 0 && one.contains(a) && one.contains(b),
        _ => false,
    };
    is_whole && verdict.value().delayed.is_some_and(|roots| roots.right == Some(*right) && roots.on == 0)
}

#[test]
#[ignore = "long: CI runs it"]
fn root_counts_beside_dead_time_are_certified() {
    for function in tried(FUNCTIONS, 3) {
        let model = written(function);
        let certificate = emitted(&model, "K");
        assert!(certificate.contains("jurist/certificate/6"), "{function}");
        accept(&model, &certificate);
        assert!(is_true(&model, &Json::parse(&certificate).unwrap(), &Known::default()), "{function}\n{certificate}");
    }
}

/// Stable cells and their neighbours: all of the domain but gaps around limits.
#[test]
fn cells_cover_the_domain_but_for_narrow_gaps() {
    let model = written(FUNCTIONS[1]);
    let found = cells(&Json::parse(&emitted(&model, "K")).unwrap()).unwrap();
    let ends: Vec<&Rational> = found.iter().flat_map(|(a, b, _)| [a, b]).collect();
    let near = |x: &Rational, y: &Rational| (x - y).abs() < number("1/10000000000");
    assert!(near(ends[0], &number("-5")) && near(ends[ends.len() - 1], &number("12")));
    assert!(ends[1..ends.len() - 1].chunks(2).all(|pair| near(pair[0], pair[1])));
    let answer = read(&model).ask().free("K").stable_set(&Budget::unlimited()).unwrap();
    let stable = found.iter().filter(|(_, _, right)| *right == 0).count();
    assert_eq!(stable, answer.value().intervals().len());
}

#[test]
#[ignore = "long: CI runs it"]
fn the_examples_with_a_gain_beside_dead_time_are_certified() {
    for (name, parameter) in
        [("dead-time-pi", "K_c"), ("dead-time-pid", "K"), ("smith-predictor", "K"), ("neutral-loop", "K")]
    {
        let model = example_text(name);
        accept(&model, &emitted(&model, parameter));
    }
    // The sentence says what is not said.
    let model = example_text("dead-time-pi");
    let proved = check(&model, &emitted(&model, "K_c"), &LIMITS).unwrap();
    assert_eq!(proved.kind, "cells");
    assert!(proved.statement.ends_with("Nothing is said of other values."), "{}", proved.statement);
}

/// Coefficients from a fixed sequence: one dead time, orders 1 to 3.
#[test]
fn certificates_of_many_loops_are_accepted() {
    let mut seed = 5_u64;
    let mut next = |most: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % most
    };
    let mut certified = 0;
    for k in 0..count(3, 12) {
        let order = 1 + k % 3;
        let mut polynomial = |degree: usize| -> String {
            let terms = (0..=degree).map(|j| format!("{}/4*s^{j}", next(17) as i64 - 4));
            terms.collect::<Vec<_>>().join(" + ")
        };
        let (a, b) = (polynomial(order - 1), polynomial(order - 1));
        let model = written(&format!("s^{order} + {a} + K*(1/8 + {b})*exp(-{}/3*s)", 1 + next(6)));
        let Some(certificate) = emitted_if_any(&model, "K") else { continue };
        accept(&model, &certificate);
        certified += 1;
    }
    assert!(certified > count(1, 7), "{certified}");
}

#[test]
fn no_mutation_of_a_certificate_of_cells_proves_what_is_wrong() {
    for function in [FUNCTIONS[3], FUNCTIONS[9]] {
        let model = written(function);
        let known = Known::default();
        reject_or_find_true(&model, &emitted(&model, "K"), 3, 20, |changed| is_true(&model, changed, &known));
    }
}

/// An end moved over the limit by a millionth of it, a count that is another, gaps closed.
#[test]
#[ignore = "long: CI runs it"]
fn wrong_cells_are_rejected() {
    let millionth = number("1/1000000");
    let least = number("1/1000");
    for function in FUNCTIONS.into_iter().step_by(5) {
        let model = written(function);
        let certificate = emitted(&model, "K");
        let found = cells(&Json::parse(&certificate).unwrap()).unwrap();
        let text = |cells: &[(Rational, Rational, usize)]| {
            let cell = |(a, b, right): &(Rational, Rational, usize)| {
                format!("{{\"between\": [\"{a}\", \"{b}\"], \"right\": {right}}}")
            };
            let list = cells.iter().map(cell).collect::<Vec<_>>().join(", ");
            let start = certificate.find("\"cells\": [").unwrap();
            let end = start + certificate[start..].find("]},").unwrap();
            format!("{}\"cells\": [{list}{}", &certificate[..start], &certificate[end..])
        };
        accept(&model, &text(&found));
        for k in 0..found.len() {
            // The cells before it are as they are; those after it would not be looked at.
            let mut other = found[..=k].to_vec();
            other[k].2 += 1;
            reject(&model, &text(&other), Step::Stable);
            let alone = |cell: (Rational, Rational, usize)| text(&[cell]);
            let (a, b, right) = found[k].clone();
            reject(&model, &alone((a.clone(), b.clone(), right + 2)), Step::Stable);
            if k > 0 {
                // Over a gap that is wider where roots meet.
                let over = &found[k - 1].1 - (a.abs() + &least) * &millionth;
                reject_somewhere(&model, &alone((over, b.clone(), right)));
                reject_somewhere(&model, &alone((found[k - 1].0.clone(), b.clone(), right)));
            }
            if k + 1 < found.len() {
                let over = &found[k + 1].0 + (b.abs() + &least) * &millionth;
                reject_somewhere(&model, &alone((a.clone(), over, right)));
            }
        }
        // Not in order, or nothing.
        reject(&model, &text(&[]), Step::Statement);
        let [first, .., last] = found.as_slice() else { continue };
        reject(&model, &text(&[last.clone(), first.clone()]), Step::Statement);
        reject(&model, &text(&[first.clone(), first.clone()]), Step::Statement);
    }
}

fn reject_somewhere(model: &str, certificate: &str) {
    let found = check(model, certificate, &LIMITS);
    assert!(found.is_err(), "{found:?}\n{model}\n{certificate}");
    assert!(python(model, certificate).is_none_or(|found| found.is_err()), "{certificate}");
}

#[test]
fn certificates_of_other_loops_with_a_gain_are_rejected() {
    let model = written(FUNCTIONS[1]);
    let certificate = emitted(&model, "K");
    for (from, to) in [
        ("s/2", "s/3"),
        ("s^2 + s", "s^2 + 1.00001*s"),
        ("(s + 2)", "(s + 2.00001)"),
        ("exp(-s/2)", "exp(-K*s/2)"),
        ("exp(-s/2)", "exp(s/2)"),
        ("+ K*", "+ K^2*"),
        ("+ K*", "- K*"),
        ("continuous", "discrete"),
    ] {
        assert!(model.contains(from), "{from}");
        reject_somewhere(&model.replacen(from, to, 1), &certificate);
    }
    for (from, to) in [("\"delay\": \"1/2\"", "\"delay\": \"1\""), ("\"decay\": \"0\"", "\"decay\": \"1\"")] {
        reject_somewhere(&model, &with(&certificate, from, to));
    }
    // A base of which the dead time is another multiple says the same.
    accept(&model, &with(&certificate, "\"delay\": \"1/2\"", "\"delay\": \"1/4\""));
}

/// Work that a certificate can ask for is bounded: a cell that touches a limit, many bits, frequencies without end.
#[test]
fn hostile_certificates_end() {
    let certificate = |bits: &str, between: &str| {
        format!(
            r#"{{"schema": "jurist/certificate/6", "statement": {{"kind": "cells", "time": "continuous", "parameter": "K", "set": {{}},
  "region": {{"decay": "0"}}, "cells": [{{"between": [{between}], "right": 0}}]}}, "bits": {bits}, "delay": "1"}}"#
        )
    };
    let model = written(FUNCTIONS[0]);
    accept(&model, &certificate("64", r#""-1/2", "2""#));
    // The limits are -1 and 2.261826334114651437....
    reject(&model, &certificate("128", r#""-1", "2""#), Step::Boundary);
    reject(&model, &certificate("1024", r#""-1", "2""#), Step::Boundary);
    reject(&model, &certificate("128", r#""-1/2", "22618263341146515/10000000000000000""#), Step::Boundary);
    reject(&model, &certificate("63", r#""-1/2", "2""#), Step::Format);
    reject(&model, &certificate("1025", r#""-1/2", "2""#), Step::Format);
    let huge = format!("\"-1/2\", \"1{}\"", "0".repeat(60_000));
    reject(&model, &certificate("128", &huge), Step::Statement);
    let far = "\"3\", \"100000000\"";
    reject(&model, &certificate("128", far), Step::Boundary);
}

/// A point of a loop with dead time: as many roots to the right as the engine counts, and no other number of them.
#[test]
fn verdicts_beside_dead_time_are_certified() {
    for function in tried(FUNCTIONS, 2) {
        let model = written(function);
        for value in ["-2/3", "3/2", "11"] {
            let verdict = read(&model).ask().set("K", number(value)).verdict(&Budget::unlimited()).expect(function);
            let certificate = verdict.certificate(&Budget::unlimited()).expect(function);
            accept(&model, &certificate);
            let right = verdict.value().delayed.and_then(|roots| roots.right).expect(function);
            let said = format!("\"right\": {right}");
            reject(&model, &with(&certificate, &said, &format!("\"right\": {}", right + 2)), Step::Stable);
            let (from, to) = if right == 0 { ("\"stable\"", "\"unstable\"") } else { ("\"unstable\"", "\"stable\"") };
            reject(&model, &with(&certificate, from, to), Step::Stable);
            reject_somewhere(&model, &with(&certificate, "\"decay\": \"0\"", "\"decay\": \"1/10\""));
        }
    }
}

/// By hand: `s + 1 + K exp(-s)` has the limits -1 and 2.26182633411465..., and two roots to the right beyond, one below.
#[test]
fn the_cells_of_a_first_order_loop_by_hand() {
    let model = written(FUNCTIONS[0]);
    let certificate = |cells: &str| {
        format!(
            r#"{{"schema": "jurist/certificate/6", "statement": {{"kind": "cells", "time": "continuous", "parameter": "K", "set": {{}},
  "region": {{"decay": "0"}}, "cells": [{cells}]}}, "bits": 96, "delay": "1"}}"#
        )
    };
    let below = r#"{"between": ["-4", "-101/100"], "right": 1}"#;
    let stable = r#"{"between": ["-99/100", "226/100"], "right": 0}"#;
    let above = r#"{"between": ["227/100", "4"], "right": 2}"#;
    accept(&model, &certificate(&format!("{below}, {stable}, {above}")));
    accept(&model, &certificate(stable));
    for (cells, step) in [
        (stable.replace("226/", "227/"), Step::Boundary),
        (stable.replace("-99/", "-101/"), Step::Boundary),
        (above.replace("227/", "226/"), Step::Boundary),
        (above.replace("\"right\": 2", "\"right\": 0"), Step::Stable),
        (below.replace("\"right\": 1", "\"right\": 0"), Step::Stable),
        (format!("{stable}, {below}"), Step::Statement),
    ] {
        reject(&model, &certificate(&cells), step);
    }
}
