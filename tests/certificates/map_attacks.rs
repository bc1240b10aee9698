//! Certificates of wrong statements about maps, made by hand against one step of the check each. Both checkers must reject all.

use crate::helpers::certificates::checkers::{accept, reject};
use crate::helpers::certificates::with;
use crate::helpers::model::read;
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

/// A model in `a` and `b` without ends.
fn plain(characteristic: &str) -> String {
    format!("time = 'discrete'\nparameters = {{ a = {{}}, b = {{}} }}\nloop.characteristic = '{characteristic}'")
}

fn emitted(text: &str) -> String {
    let budget = Budget::unlimited();
    read(text).ask().free("a").free("b").map(6, &budget).unwrap().certificate(&budget).unwrap()
}

/// `|a b| < 1`, by hand.
const BY_HAND: &str = r#"{
    "schema": "jurist/certificate/5",
    "statement": {"kind": "map", "time": "discrete", "x": "a", "y": "b", "set": {"c": "0"}, "region": {"radius": "1"},
        "domain": {"x": {"lower": null, "upper": null}, "y": {"lower": null, "upper": null}},
        "regions": [[[0, 1], [1, 1]]]},
    "characteristic": [[["1", 1, 1]], [["1"]]],
    "boundary": null,
    "factors": [[["1"], ["1", 1, 1]], [["1"], ["-1", 1, 1]]],
    "x_factors": [{"polynomial": ["0", "1"], "roots": [["0"]]}],
    "strips": [{"x": "-1", "roots": [[["1"]], [["-1"]]], "cells": ["-3", "0", "2"]},
               {"x": "2", "roots": [[["-1/2"]], [["1/3", "2/3"]]], "cells": ["-5", "0", "7"]}],
    "joins": [{"strip": 0, "x": ["-1", "1/3"], "y": "0", "below": [[[], [["-1"]]], [[["-3"]], []]], "clear": [[], []]}]
}"#;

const BY_HAND_MODEL: &str =
    "time = 'discrete'\nparameters = { a = {}, b = {}, c = {} }\nloop.characteristic = 'z + a*b + c'";

#[test]
fn a_certificate_by_hand_is_accepted_and_lies_about_it_are_not() {
    accept(BY_HAND_MODEL, BY_HAND);
    let said = check(BY_HAND_MODEL, BY_HAND, &LIMITS).unwrap().statement;
    assert_eq!(
        said,
        "For all real a and b, with c = 0, the loop is stable, off its boundary curves and 1 line of constant a, exactly \
         in 1 connected region: 2 cells for a from -infinity to infinity."
    );
    // The two halves apart: each is connected.
    let apart = with(&with(BY_HAND, "[[[0, 1], [1, 1]]]", "[[[0, 1]], [[1, 1]]]"), "{\"strip\": 0", "{\"strip\": 9");
    reject(BY_HAND_MODEL, &apart, Step::Joins);
    let no_joins = &apart[..apart.find("\"joins\"").unwrap()];
    accept(BY_HAND_MODEL, &format!("{no_joins}\"joins\": []\n}}"));
    for (step, from, to) in [
        (Step::Format, "certificate/5", "certificate/99"),
        (Step::Statement, "certificate/5", "certificate/4"),
        (Step::Statement, "certificate/5", "certificate/1"),
        (Step::Statement, r#""kind": "map""#, r#""kind": "intervals""#),
        (Step::Statement, r#""kind": "map""#, r#""kind": "verdict""#),
        (Step::Statement, r#""radius": "1""#, r#""radius": "parameter""#),
        (Step::Statement, r#""time": "discrete""#, r#""time": "continuous""#),
        (Step::Statement, r#"[[0, 1], [1, 1]]"#, r#"[[0, 1, 1]]"#),
        (Step::Statement, r#""x": {"lower": null, "upper": null}"#, r#""x": {"lower": "1", "upper": "1"}"#),
        (Step::Model, r#""x": "a""#, r#""x": "b""#),
        (Step::Model, r#""x": "a""#, r#""x": "d""#),
        (Step::Model, r#""set": {"c": "0"}"#, r#""set": {}"#),
        (Step::Characteristic, r#""set": {"c": "0"}"#, r#""set": {"c": "1/2"}"#),
        (Step::Characteristic, r#"[[["1", 1, 1]], [["1"]]]"#, r#"[[["1", 1, 1]], [["2"]]]"#),
        (Step::Characteristic, r#"[[["1", 1, 1]], [["1"]]]"#, r#"[[["1", 1, 2]], [["1", 0, 1]]]"#),
        (Step::Characteristic, r#"[[["1", 1, 1]], [["1"]]]"#, "[]"),
        (Step::Boundary, r#""boundary": null"#, r#""boundary": {"u": [], "v": [[["1"]]], "value": [["1"]]}"#),
        // A curve is left out, is another one, is a number.
        (Step::Factors, r#", [["1"], ["-1", 1, 1]]]"#, "]"),
        (Step::Factors, r#"["-1", 1, 1]"#, r#"["-2", 1, 1]"#),
        (Step::Factors, r#"[["1"], ["-1", 1, 1]]]"#, r#"[["1"], ["-1", 1, 1]], [["5"]]]"#),
        // A critical value is left out, its root is, or is another number.
        (Step::Projection, r#"[{"polynomial": ["0", "1"], "roots": [["0"]]}]"#, "[]"),
        (Step::Projection, r#"["0", "1"], "roots": [["0"]]"#, r#"["0", "1"], "roots": []"#),
        (Step::Projection, r#"["0", "1"], "roots": [["0"]]"#, r#"["-1", "1"], "roots": [["1"]]"#),
        (Step::Projection, r#"["0", "1"], "roots": [["0"]]"#, r#"["0", "1"], "roots": [["1"]]"#),
        (Step::Projection, r#"["0", "1"], "roots": [["0"]]"#, r#"["0", "0", "1"], "roots": [["0"]]"#),
        // The same factor twice.
        (
            Step::Projection,
            r#"[{"polynomial": ["0", "1"], "roots": [["0"]]}]"#,
            r#"[{"polynomial": ["0", "1"], "roots": [["0"]]}, {"polynomial": ["0", "2"], "roots": [["0"]]}]"#,
        ),
        // A wall that is none has no strips of its own here.
        (
            Step::Strips,
            r#"[{"polynomial": ["0", "1"], "roots": [["0"]]}]"#,
            r#"[{"polynomial": ["0", "1"], "roots": [["0"]]}, {"polynomial": ["-5", "1"], "roots": [["5"]]}]"#,
        ),
        (Step::Strips, r#"{"x": "-1""#, r#"{"x": "1""#),
        (Step::Strips, r#"{"x": "-1""#, r#"{"x": "0""#),
        (Step::Strips, r#"{"x": "-1""#, r#"{"x": "-2""#),
        (Step::Strips, r#"[[["1"]], [["-1"]]]"#, r#"[[["1"]], []]"#),
        (Step::Strips, r#"[[["1"]], [["-1"]]]"#, r#"[[["1"]]]"#),
        (Step::Strips, r#"[[["1"]], [["-1"]]]"#, r#"[[["1"]], [["-2", "2"]]]"#),
        (Step::Strips, r#"["-3", "0", "2"]"#, r#"["-3", "0"]"#),
        (Step::Strips, r#"["-3", "0", "2"]"#, r#"["0", "-3", "2"]"#),
        (Step::Strips, r#"["-3", "0", "2"]"#, r#"["-1", "0", "2"]"#),
        (Step::Strips, r#"["-3", "0", "2"]"#, r#"["-3", "0", "2", "4"]"#),
        // Other regions.
        (Step::Stable, "[[[0, 1], [1, 1]]]", "[[[0, 1]]]"),
        (Step::Stable, "[[[0, 1], [1, 1]]]", "[[[0, 1], [1, 1], [1, 2]]]"),
        (Step::Stable, "[[[0, 1], [1, 1]]]", "[[[0, 1], [1, 0]]]"),
        (Step::Stable, "[[[0, 1], [1, 1]]]", "[[[0, 1], [1, 1], [1, 1]]]"),
        (Step::Stable, "[[[0, 1], [1, 1]]]", "[[[0, 1], [1, 1]], []]"),
        (Step::Stable, "[[[0, 1], [1, 1]]]", "[[[0, 1], [7, 1]]]"),
        (Step::Stable, "[[[0, 1], [1, 1]]]", "[]"),
        // Segments that do not join the cells: one that meets a curve, outside of the strips, not there.
        (Step::Joins, r#""strip": 0"#, r#""strip": 1"#),
        (Step::Joins, r#"["-1", "1/3"]"#, r#"["1/3", "-1"]"#),
        (Step::Joins, r#"["-1", "1/3"]"#, r#"["-1", "0"]"#),
        (
            Step::Joins,
            r#""y": "0", "below": [[[], [["-1"]]], [[["-3"]], []]]"#,
            r#""y": "4", "below": [[[["1"]], [["-1"]]], [[["-3"]], [["3"]]]]"#,
        ),
        (Step::Joins, r#"[[], [["-1"]]], [[["-3"]], []]"#, r#"[[], []], [[["-3"]], []]"#),
        (Step::Joins, r#""clear": [[], []]"#, r#""clear": [[]]"#),
        (Step::Joins, r#""clear": [[], []]"#, r#""clear": [[["0"]], []]"#),
        (Step::Stable, r#""regions": [[[0, 1], [1, 1]]]"#, r#""regions": [[[0, 1], [1, 1]], [[0, 0]]]"#),
    ] {
        reject(BY_HAND_MODEL, &with(BY_HAND, from, to), step);
    }
    let bounded = r#""y": {"lower": "-1/2", "upper": null}"#;
    // The edge of a smaller domain has critical values of its own.
    reject(BY_HAND_MODEL, &with(BY_HAND, r#""y": {"lower": null, "upper": null}"#, bounded), Step::Projection);
    let without = format!("{}\"joins\": []\n}}", &BY_HAND[..BY_HAND.find("\"joins\"").unwrap()]);
    reject(BY_HAND_MODEL, &without, Step::Joins);
}

/// Two regions that are given as one, with a segment through the curve between them.
#[test]
fn regions_that_are_apart_are_not_joined() {
    let text = plain("z + a^2 - 2 + 0*b");
    let certificate = emitted(&text);
    let mut json = Json::parse(&certificate).unwrap();
    let list = |text: &str| Json::parse(text).unwrap();
    let all = list("[[[1, 0], [3, 0]]]");
    let regions = json.get("statement").and_then(|statement| statement.get("regions"));
    assert_eq!(regions, Some(&list("[[[1, 0]], [[3, 0]]]")));
    let Json::Object(pairs) = &mut json else { panic!("an object") };
    for (key, value) in pairs.iter_mut() {
        if key == "statement"
            && let Json::Object(statement) = value
        {
            statement.iter_mut().filter(|(key, _)| key == "regions").for_each(|(_, value)| *value = all.clone());
        }
    }
    reject(&text, &json.to_text(), Step::Joins);
    // From strip 1 into the unstable strip between.
    let join = r#"{"strip": 1, "x": ["-5/4", "0"], "y": "0", "below": [[], []], "clear": [[], []]}"#;
    let Json::Object(pairs) = &mut json else { panic!("an object") };
    pairs
        .iter_mut()
        .filter(|(key, _)| key == "joins")
        .for_each(|(_, v)| *v = Json::parse(&format!("[{join}]")).unwrap());
    reject(&text, &json.to_text(), Step::Joins);
}

/// Beside a region that is there, everything that hides a line on which the loop is undefined or loses its degree.
#[test]
fn lines_without_stability_are_curves() {
    for characteristic in ["z + a*b + 0/(a - b)", "(a - b)*(z + a*b)", "(a - b)*z + a*b*(a - b)"] {
        let text = plain(characteristic);
        let honest = emitted(&text);
        accept(&text, &honest);
        let model = BY_HAND_MODEL.replace("z + a*b + c", &format!("{characteristic} + 0*c"));
        reject(&model, BY_HAND, Step::Factors);
    }
}
