//! Certificates of wrong statements, made by hand against one step of the check each. Both checkers must reject all.

use crate::helpers::certificates::checkers::{accept, python, reject};
use crate::helpers::certificates::{emitted, verdict_emitted};
use jurist_check::Step;

/// Rejected after each of the changes (all of them together in one entry).
fn reject_changes(model: &str, certificate: &str, changes: &[(Step, &[(&str, &str)])]) {
    accept(model, certificate);
    for (step, edits) in changes {
        let changed = edits.iter().fold(certificate.to_owned(), |text, (from, to)| {
            assert_eq!(text.matches(from).count(), 1, "{from} in\n{text}");
            text.replace(from, to)
        });
        reject(model, &changed, *step);
    }
}

fn model(time: &str, characteristic: &str) -> String {
    format!("time = '{time}'\nparameters.K = {{}}\nloop.characteristic = '{characteristic}'")
}

/// A certificate without factors and a line, in which the parts of a statement are the usual ones.
fn certificate(time: &str, domain: [&str; 2], stable: &str, parts: &str) -> String {
    let region = if time == "discrete" { r#""radius": "1""# } else { r#""decay": "0""# };
    let bound = |b: &str| if b == "null" { b.to_owned() } else { format!("\"{b}\"") };
    let (lower, upper) = (bound(domain[0]), bound(domain[1]));
    format!(
        r#"{{"schema": "jurist/certificate/1",
  "statement": {{"kind": "intervals", "time": "{time}", "parameter": "K", "set": {{}}, "region": {{{region}}},
    "domain": {{"lower": {lower}, "upper": {upper}}}, "stable": [{stable}]}},
  {parts}}}"#
    )
}

use Step::{Boundary, Characteristic, Factors, Format, Line, Stable, Statement};

/// `z - 1 + K`: stable for 0 < K < 2.
#[test]
fn points_and_samples_of_a_first_order_loop() {
    let first = model("discrete", "z - 1 + K");
    let text = certificate(
        "discrete",
        ["null", "null"],
        r#"{"lower": "0", "upper": "2"}"#,
        r#""characteristic": [["-1", "1"], ["1"]], "boundary": null, "factors": [["0", "1"], ["-2", "1"]],
  "line": [{"split": [], "sample": "-1", "stable": false}, {"at": "0"},
           {"split": [], "sample": "1", "stable": true}, {"at": "2"}, {"split": [], "sample": "3", "stable": false}]"#,
    );
    let claim = |to: &'static str| (r#"{"lower": "0", "upper": "2"}"#, to);
    reject_changes(
        &first,
        &text,
        &[
            // A point of the line is left out, twice there, out of order, or none.
            (Line, &[(r#", {"at": "2"}, {"split": [], "sample": "3", "stable": false}"#, "")]),
            (
                Line,
                &[
                    (r#"{"at": "2"}, "#, ""),
                    (r#"{"split": [], "sample": "1", "stable": true},"#, ""),
                    claim(r#"{"lower": "0", "upper": null}"#),
                ],
            ),
            (Line, &[(r#"{"at": "0"}"#, r#"{"at": "0"}, {"split": [], "sample": "0", "stable": true}, {"at": "0"}"#)]),
            (Line, &[(r#"{"at": "2"}"#, r#"{"at": "0/1"}"#), (r#"{"at": "0"}"#, r#"{"at": "2"}"#)]),
            (Line, &[(r#"{"at": "2"}"#, r#"{"at": "1"}"#), claim(r#"{"lower": "0", "upper": "1"}"#)]),
            // The same root in two enclosures, in two that share an end, and with another one.
            (
                Line,
                &[(
                    r#"{"at": "0"}"#,
                    r#"{"between": ["-1/2", "1/2"], "factor": 0},
                       {"split": [], "sample": "1/2", "stable": true}, {"between": ["-1/2", "1/2"], "factor": 0}"#,
                )],
            ),
            (
                Line,
                &[(
                    r#"{"at": "0"}"#,
                    r#"{"between": ["-1/2", "1/2"], "factor": 0},
                       {"split": [], "sample": "1/2", "stable": true}, {"between": ["1/2", "3/4"], "factor": 0}"#,
                )],
            ),
            (
                Line,
                &[(
                    r#"{"at": "0"}"#,
                    r#"{"between": ["-1/2", "1/2"], "factor": 0},
                       {"split": [], "sample": "1/2", "stable": true}, {"at": "0"}"#,
                )],
            ),
            (Line, &[(r#"{"at": "0"}"#, r#"{"between": ["-1", "3"], "factor": 0}"#)]),
            (Line, &[(r#"{"at": "0"}"#, r#"{"between": ["0", "1"], "factor": 0}"#)]),
            (Line, &[(r#"{"at": "0"}"#, r#"{"between": ["-1", "0"], "factor": 0}"#)]),
            (Line, &[(r#"{"at": "0"}"#, r#"{"between": ["-1", "1"], "factor": 1}"#)]),
            (Line, &[(r#"{"at": "0"}"#, r#"{"between": ["-1", "1"], "factor": 2}"#)]),
            (Line, &[(r#"{"at": "0"}"#, r#"{"between": ["1", "-1"], "factor": 0}"#)]),
            // Another enclosure of the same end is another text, but the list must be that of the line.
            (Stable, &[(r#"{"at": "0"}"#, r#"{"between": ["-1/2", "1/2"], "factor": 0}"#)]),
            // Samples elsewhere, on a point, at no number; labels turned.
            (Line, &[(r#""sample": "1""#, r#""sample": "3""#)]),
            (Line, &[(r#""sample": "1""#, r#""sample": "0""#)]),
            (Line, &[(r#""sample": "-1", "stable": false"#, r#""sample": "1/2", "stable": true"#)]),
            (Line, &[(r#""sample": "3", "stable": false"#, r#""sample": "1/2", "stable": true"#)]),
            (Line, &[(r#""sample": "3", "stable": false"#, r#""sample": "3", "stable": true"#)]),
            (Line, &[(r#""sample": "1""#, r#""sample": null"#)]),
            // A split point that is a root, or out of order.
            (Line, &[(r#"{"split": [], "sample": "1""#, r#"{"split": ["2"], "sample": "1""#)]),
            (Line, &[(r#"{"split": [], "sample": "1""#, r#"{"split": ["3/2", "1"], "sample": "1""#)]),
            (Line, &[(r#"{"split": [], "sample": "3""#, r#"{"split": ["2"], "sample": "3""#)]),
            // Factors that leave a boundary out, are constant, zero, or hide two roots in one.
            (Factors, &[(r#"["0", "1"], ["-2", "1"]"#, r#"["0", "1"]"#)]),
            (Factors, &[(r#"["0", "1"], ["-2", "1"]"#, r#"["0", "1"], ["-3", "1"]"#)]),
            (Factors, &[(r#"["0", "1"], ["-2", "1"]"#, r#"["0", "1"], ["-2", "1"], ["5"]"#)]),
            (Factors, &[(r#"["0", "1"], ["-2", "1"]"#, r#"["0", "1"], ["-2", "1"], []"#)]),
            (Factors, &[(r#"["0", "1"], ["-2", "1"]"#, r#"["0", "-2", "1"]"#)]),
            (Factors, &[(r#"["0", "1"], ["-2", "1"]"#, r#"["0", "1"], ["-2", "1", "0"]"#)]),
            (Factors, &[(r#"[["0", "1"], ["-2", "1"]]"#, "[]")]),
            // A double factor: its root has two variations.
            (Factors, &[(r#"["0", "1"], ["-2", "1"]"#, r#"["0", "0", "1"], ["-2", "1"]"#)]),
            // Other claims.
            (Stable, &[claim("")]),
            (Stable, &[claim(r#"{"lower": null, "upper": null}"#)]),
            (Stable, &[claim(r#"{"lower": "0", "upper": "2"}, {"lower": "0", "upper": "2"}"#)]),
            (Stable, &[claim(r#"{"lower": "0", "upper": "1"}, {"lower": "1", "upper": "2"}"#)]),
            (Stable, &[claim(r#"{"lower": "2", "upper": "0"}"#)]),
            (Stable, &[claim(r#"{"lower": "0", "upper": {"polynomial": ["-2", "1"], "between": ["1", "3"]}}"#)]),
            // A boundary where none is due.
            (Boundary, &[(r#""boundary": null"#, r#""boundary": {"u": [], "v": [["1"]], "value": ["1"]}"#)]),
            // The polynomial times a number, with another sign, of another degree.
            (Characteristic, &[(r#"[["-1", "1"], ["1"]]"#, r#"[["-2", "2"], ["2"]]"#)]),
            (Characteristic, &[(r#"[["-1", "1"], ["1"]]"#, r#"[["1", "-1"], ["-1"]]"#)]),
            (Characteristic, &[(r#"[["-1", "1"], ["1"]]"#, r#"[["-1", "1"], ["1"], []]"#)]),
            (Characteristic, &[(r#"[["-1", "1"], ["1"]]"#, "[]")]),
            // Domains: a root at its end, inside an enclosure, beyond it.
            (Line, &[(r#""lower": null"#, r#""lower": "0""#)]),
            (Line, &[(r#""lower": null"#, r#""lower": "1""#)]),
            (
                Statement,
                &[(r#""domain": {"lower": null, "upper": null}"#, r#""domain": {"lower": "2", "upper": "2"}"#)],
            ),
            (
                Statement,
                &[(r#""domain": {"lower": null, "upper": null}"#, r#""domain": {"lower": "3", "upper": "2"}"#)],
            ),
            (
                Line,
                &[
                    (r#""domain": {"lower": null"#, r#""domain": {"lower": "0""#),
                    (r#"{"at": "0"}"#, r#"{"between": ["-1/2", "1/2"], "factor": 0}"#),
                ],
            ),
        ],
    );
}

/// `z^2 + 1 - K^2`: the pair is on the circle at 0 and inside on both sides of it.
#[test]
fn points_where_two_stable_stretches_touch() {
    let touching = model("discrete", "z^2 + 1 - K^2");
    let text = certificate(
        "discrete",
        ["-1", "1"],
        r#"{"lower": "-1", "upper": "0"}, {"lower": "0", "upper": "1"}"#,
        r#""characteristic": [["1", "0", "-1"], [], ["1"]], "boundary": {"u": [], "v": [["1"]], "value": ["0", "0", "1"]},
  "factors": [["0", "1"], ["2", "0", "-1"]],
  "line": [{"split": [], "sample": "-1/2", "stable": true}, {"at": "0", "touch": ["v", 0]},
           {"split": [], "sample": "1/2", "stable": true}]"#,
    );
    let joined = (r#"{"lower": "-1", "upper": "0"}, {"lower": "0", "upper": "1"}"#, r#"{"lower": "-1", "upper": "1"}"#);
    let one = (r#"{"split": [], "sample": "-1/2", "stable": true}, {"at": "0", "touch": ["v", 0]},"#, "");
    let identity = r#"{"u": [], "v": [["1"]], "value": ["0", "0", "1"]}"#;
    reject_changes(
        &touching,
        &text,
        &[
            (Stable, &[joined]),
            (Line, &[joined, one]),
            (Line, &[joined, one, (r#"{"split": [], "sample": "1/2""#, r#"{"split": ["0"], "sample": "1/2""#)]),
            (Line, &[(r#", "touch": ["v", 0]"#, "")]),
            (Line, &[(r#"["v", 0]"#, r#"["u", 0]"#)]),
            (Line, &[(r#"["v", 0]"#, r#"["v", 1]"#)]),
            (Line, &[(r#"["v", 0]"#, r#"["v", true]"#)]),
            (Format, &[(r#"["v", 0]"#, r#"["v", -1]"#)]),
            (Line, &[(r#"["v", 0]"#, r#"["w", 0]"#)]),
            // Both cofactors zero; the zero identity; degrees that any U = B, V = -A would meet.
            (Boundary, &[(identity, r#"{"u": [], "v": [[]], "value": []}"#)]),
            (Boundary, &[(identity, r#"{"u": [], "v": [], "value": []}"#)]),
            (Boundary, &[(identity, r#"{"u": [["0", "0", "1"]], "v": [["0"], ["-1"]], "value": []}"#)]),
            (Boundary, &[(identity, r#"{"u": [["0", "0", "1"]], "v": [[], ["-1"]], "value": []}"#)]),
            (Boundary, &[(identity, r#"{"u": [[]], "v": [["1"]], "value": ["0", "0", "1"]}"#)]),
            (Boundary, &[(identity, r#"{"u": [], "v": [["1"], []], "value": ["0", "0", "1"]}"#)]),
            (Boundary, &[(identity, r#"{"u": [], "v": [["1"]], "value": ["1", "0", "1"]}"#)]),
            (Boundary, &[(identity, r#"{"u": [], "v": [["1"]], "value": []}"#)]),
            (Boundary, &[(identity, "null")]),
            (Factors, &[(r#"["0", "1"], ["2", "0", "-1"]"#, r#"["2", "0", "-1"]"#)]),
            // With the identity times K the cofactors vanish at 0 too.
            (Line, &[(identity, r#"{"u": [], "v": [["0", "1"]], "value": ["0", "0", "0", "1"]}"#)]),
        ],
    );
}

/// `z^2 + 1/4` is stable for all values; no factor that a certificate adds may take a point away.
#[test]
fn points_that_are_stable_are_not_left_out() {
    let always = model("discrete", "z^2 + 1/4 + 0*K");
    let text = certificate(
        "discrete",
        ["-1", "1"],
        r#"{"lower": "-1", "upper": "1"}"#,
        r#""characteristic": [["1"], [], ["4"]], "boundary": {"u": [], "v": [["1"]], "value": ["3"]}, "factors": [],
  "line": [{"split": [], "sample": "-1/2", "stable": true}]"#,
    );
    let cut = |line: &'static str| {
        vec![
            (
                r#""stable": [{"lower": "-1", "upper": "1"}]"#,
                r#""stable": [{"lower": "-1", "upper": "0"}, {"lower": "0", "upper": "1"}]"#,
            ),
            (r#""factors": []"#, r#""factors": [["0", "1"]]"#),
            (r#"{"split": [], "sample": "-1/2", "stable": true}"#, line),
        ]
    };
    let at = cut(
        r#"{"split": [], "sample": "-1/2", "stable": true}, {"at": "0"}, {"split": [], "sample": "1/2", "stable": true}"#,
    );
    let touch = cut(r#"{"split": [], "sample": "-1/2", "stable": true}, {"at": "0", "touch": ["v", 0]},
           {"split": [], "sample": "1/2", "stable": true}"#);
    let mut spurious = touch.clone();
    let identity = r#"{"u": [], "v": [["1"]], "value": ["3"]}"#;
    spurious.push((identity, r#"{"u": [], "v": [["0", "1"]], "value": ["0", "3"]}"#));
    let enclosed = cut(
        r#"{"split": [], "sample": "-1/2", "stable": true}, {"between": ["-1/3", "1/3"], "factor": 0, "touch": ["v", 0]},
           {"split": [], "sample": "1/2", "stable": true}"#,
    );
    let mut enclosed_spurious = enclosed.clone();
    enclosed_spurious.push((identity, r#"{"u": [], "v": [["0", "1"]], "value": ["0", "3"]}"#));
    let nowhere: &[(&str, &str)] = &[
        (r#""stable": [{"lower": "-1", "upper": "1"}]"#, r#""stable": []"#),
        (r#""line": [{"split": [], "sample": "-1/2", "stable": true}]"#, r#""line": []"#),
    ];
    let mut zero = nowhere.to_vec();
    zero.push((identity, r#"{"u": [], "v": [[]], "value": []}"#));
    let mut high = nowhere.to_vec();
    high.push((identity, r#"{"u": [["-3"]], "v": [["0"], ["5"]], "value": []}"#));
    let mut no_boundary = nowhere.to_vec();
    no_boundary.push((identity, "null"));
    reject_changes(
        &always,
        &text,
        &[
            (Line, &at),
            (Line, &touch),
            (Line, &spurious),
            (Line, &enclosed),
            (Line, &enclosed_spurious),
            (Line, nowhere),
            (Boundary, &zero),
            (Boundary, &high),
            (Boundary, &no_boundary),
        ],
    );
}

/// Where the degree falls and where a quotient is undefined the loop is not stable, whatever is there on both sides.
#[test]
fn lost_degrees_and_poles_are_not_joined() {
    for (time, written, characteristic, boundary) in [
        ("continuous", "(K - 1)^2*s + 1", r#"[["1"], ["1", "-2", "1"]]"#, "null"),
        ("discrete", "(K - 1)*z", r#"[[], ["-1", "1"]]"#, "null"),
        ("discrete", "z/2 - (K - 1)/(K - 1)/4", r#"[["-1"], ["2"]]"#, "null"),
        (
            "continuous",
            "(K - 1)^2*s^2 + s + 1",
            r#"[["1"], ["1"], ["1", "-2", "1"]]"#,
            r#"{"u": [], "v": [["1"]], "value": ["1"]}"#,
        ),
    ] {
        let parts = format!(
            r#""characteristic": {characteristic}, "boundary": {boundary}, "factors": [["-1", "1"]],
  "line": [{{"split": [], "sample": "0", "stable": true}}, {{"at": "1"}}, {{"split": [], "sample": "2", "stable": true}}]"#
        );
        let two = r#"{"lower": null, "upper": "1"}, {"lower": "1", "upper": null}"#;
        let joined = (two, r#"{"lower": null, "upper": null}"#);
        let one = (r#", {"at": "1"}, {"split": [], "sample": "2", "stable": true}"#, "");
        reject_changes(
            &model(time, written),
            &certificate(time, ["null", "null"], two, &parts),
            &[
                (Stable, &[joined]),
                (Factors, &[joined, one, (r#"[["-1", "1"]]"#, "[]")]),
                (Line, &[joined, one]),
                (Line, &[(r#""sample": "2", "stable": true"#, r#""sample": "1", "stable": true"#)]),
                (Line, &[(r#""sample": "2", "stable": true"#, r#""sample": "2", "stable": false"#)]),
            ],
        );
    }
    // Stable for no value: the polynomial is zero, has a root at 1, or is undefined.
    for (written, characteristic) in
        [("0*K", "[[]]"), ("(z - 1)*K", r#"[["0", "-1"], ["0", "1"]]"#), ("z + 1/(K - K + g - 1)", "[]")]
    {
        let model = format!("{}\nparameters.g = {{}}", model("discrete", written));
        let parts = format!(r#""characteristic": {characteristic}, "boundary": null, "factors": [], "line": []"#);
        let text =
            certificate("discrete", ["null", "null"], "", &parts).replace(r#""set": {}"#, r#""set": {"g": "1"}"#);
        let claim = (r#""stable": []"#, r#""stable": [{"lower": null, "upper": null}]"#);
        let line = (r#""line": []"#, r#""line": [{"split": [], "sample": "1", "stable": true}]"#);
        reject_changes(&model, &text, &[(Stable, &[claim]), (Line, &[claim, line])]);
    }
}

/// The root is `K/g`; the statement is about the radius.
#[test]
fn regions_names_and_values() {
    let lp = "time = 'discrete'\nparameters.K = { nominal = 1 }\nconstants.g = 2\nloop.characteristic = 'z - K/g'";
    let text = r#"{"schema": "jurist/certificate/1",
  "statement": {"kind": "intervals", "time": "discrete", "parameter": "radius", "set": {"K": "1"}, "region": {"radius": "parameter"},
    "domain": {"lower": "0", "upper": null}, "stable": [{"lower": "1/2", "upper": null}]},
  "characteristic": [["-1"], ["0", "2"]], "boundary": null, "factors": [["0", "1"], ["-1", "2"], ["1", "2"]],
  "line": [{"split": [], "sample": "1/4", "stable": false}, {"at": "1/2"}, {"split": [], "sample": "1", "stable": true}]}"#;
    reject_changes(
        lp,
        text,
        &[
            (Statement, &[(r#""parameter": "radius""#, r#""parameter": "K""#)]),
            (Statement, &[(r#""parameter": "radius""#, r#""parameter": "decay""#)]),
            (Step::Model, &[(r#"{"radius": "parameter"}"#, r#"{"radius": "1"}"#)]),
            (Statement, &[(r#"{"radius": "parameter"}"#, r#"{"decay": "parameter"}"#)]),
            (Statement, &[(r#""lower": "0""#, r#""lower": "-1""#)]),
            (Statement, &[(r#""lower": "0""#, r#""lower": null"#)]),
            (Step::Model, &[(r#""set": {"K": "1"}"#, r#""set": {}"#)]),
            (Characteristic, &[(r#""set": {"K": "1"}"#, r#""set": {"K": "2"}"#)]),
            (Step::Model, &[(r#""set": {"K": "1"}"#, r#""set": {"K": "1", "L": "1"}"#)]),
            (Characteristic, &[(r#""set": {"K": "1"}"#, r#""set": {"K": "1", "g": "3"}"#)]),
            (Statement, &[(r#""set": {"K": "1"}"#, r#""set": {"K": "1", "radius": "1"}"#)]),
            (Statement, &[(r#""set": {"K": "1"}"#, r#""set": {"K": "1", "the loop is stable.\n": "1"}"#)]),
            (Format, &[(r#""set": {"K": "1"}"#, r#""set": {"K": "1", "\u004b": "1"}"#)]),
            (
                Step::Model,
                &[
                    (r#""time": "discrete""#, r#""time": "continuous""#),
                    (r#""region": {"radius""#, r#""region": {"decay""#),
                    (r#""parameter": "radius""#, r#""parameter": "decay""#),
                ],
            ),
        ],
    );
    let numbers = [
        "+1", " 1", "1 ", "1.0", "1e0", "1/0", "1/-1", "-1/-1", "--1", "1/1/1", "0x1", "1_0", "\u{663}", "", "/1",
        "1/", "inf", "nan",
    ];
    for number in numbers {
        reject(lp, &text.replace(r#"{"K": "1"}"#, &format!(r#"{{"K": "{number}"}}"#)), Statement);
    }
    // Not texts: numbers, truth values, lists, nothing.
    for other in ["1", "true", "null", "[\"1\"]", "{}"] {
        reject(lp, &text.replace(r#"{"K": "1"}"#, &format!(r#"{{"K": {other}}}"#)), Statement);
    }
    for radius in ["0", "-1", "1/2"] {
        let changed = text.replace(r#"{"radius": "parameter"}"#, &format!(r#"{{"radius": "{radius}"}}"#));
        let changed = changed
            .replace(r#""parameter": "radius""#, r#""parameter": "K""#)
            .replace(r#""set": {"K": "1"}"#, r#""set": {}"#);
        reject(lp, &changed, if radius == "1/2" { Characteristic } else { Statement });
    }
}

/// The verdict at a point: roots 1/2, 1 and 2 of `(z - 1/2)(z - 1)(z - 2)`, and what a pole or a lost degree changes.
#[test]
fn verdicts() {
    let lp = model("discrete", "K*(z - 1/2)*(z - 1)*(z - 2)/K");
    let text = r#"{"schema": "jurist/certificate/1",
  "statement": {"kind": "verdict", "time": "discrete", "set": {"K": "1"}, "region": {"radius": "1"}, "verdict": "unstable",
    "degree": 3, "inside": 1, "on": 1, "outside": 1, "infinite": 0},
  "characteristic": [["-2"], ["7"], ["-7"], ["2"]]}"#;
    reject_changes(
        &lp,
        text,
        &[
            (Stable, &[(r#""verdict": "unstable""#, r#""verdict": "stable""#)]),
            (Stable, &[(r#""verdict": "unstable""#, r#""verdict": "marginal""#)]),
            (Stable, &[(r#""verdict": "unstable""#, r#""verdict": "undefined""#)]),
            (Stable, &[(r#""inside": 1"#, r#""inside": 2"#), (r#""outside": 1"#, r#""outside": 0"#)]),
            (
                Stable,
                &[
                    (r#""on": 1"#, r#""on": 2"#),
                    (r#""outside": 1"#, r#""outside": 0"#),
                    (r#""verdict": "unstable""#, r#""verdict": "marginal""#),
                ],
            ),
            (Stable, &[(r#""degree": 3"#, r#""degree": 4"#), (r#""infinite": 0"#, r#""infinite": 1"#)]),
            (Statement, &[(r#""on": 1"#, r#""on": true"#)]),
            (Statement, &[(r#""on": 1"#, r#""on": "1""#)]),
            (Format, &[(r#""on": 1"#, r#""on": 1.0"#)]),
            (Format, &[(r#""on": 1"#, r#""on": -1"#)]),
            (Format, &[(r#""on": 1"#, r#""on": 1, "on": 1"#)]),
            (Characteristic, &[(r#""set": {"K": "1"}"#, r#""set": {"K": "0"}"#)]),
            (Characteristic, &[(r#""radius": "1""#, r#""radius": "3""#)]),
            (
                Characteristic,
                &[(r#""radius": "1""#, r#""radius": "3""#), (r#""verdict": "unstable""#, r#""verdict": "stable""#)],
            ),
            (Statement, &[(r#""radius": "1""#, r#""radius": "parameter""#)]),
            (Characteristic, &[(r#"["2"]]}"#, r#"["2"], []]}"#)]),
            (Format, &[(r#"["2"]]}"#, r#"["2"]], "factors": []}"#)]),
            (Format, &[(r#""kind": "verdict""#, r#""kind": "intervals""#)]),
        ],
    );
}

/// `inf` and `nan` are numbers of TOML, here also names; keys with another meaning, or none; marks before the text.
#[test]
fn texts_that_are_no_models() {
    let good = format!("{}\nconstants.c = 1\nparameters.inf = 1\nparameters.nan = 1", model("discrete", "z - c*K"));
    let text = emitted(&good, "K");
    accept(&good, &text);
    accept(&format!("\u{feff}{good}"), &text);
    for named in ["inf", "+inf", "-inf", "nan", "+nan"] {
        reject(&good.replace("c = 1", &format!("c = {named}")), &text, Step::Model);
    }
    for further in ["simulation.steps = 3", "loop.a = 1", "parameters.d = { value = 1 }", "name = 'K'"] {
        reject(&format!("{good}\n{further}"), &text, Step::Model);
    }
    let described = "title = 'one'\nsimulation = { inputs = {}, initial = {}, duration = 3, units = {} }\n";
    let declared = "K = { unit = '1', description = 'gain', max = 1e3 }";
    accept(&format!("{described}{}", good.replace("K = {}", declared)), &text);

    let block = "time = 'discrete'\nparameters.K = {}\nloop.inputs = 'r'\n\
                 block = [{ input = 'r - y', output = 'y', transfer = 'K/s', discretize = { method = 'forward', T = 1 } }]";
    let text = emitted(block, "K");
    accept(block, &text);
    for (from, to) in [
        ("input =", "feedback = 1, input ="),
        ("method =", "rule = 1, method ="),
        ("transfer =", "pwm = { amplitude = 1, carrier = 1, period = 1, phase = 1 }, transfer ="),
    ] {
        reject(&block.replacen(from, to, 1), &text, Step::Model);
    }
    for key in ["states = 'x'", "E = []"] {
        // Of no influence on the statement; the engine and Python refuse them beside blocks.
        assert!(
            python(&block.replace("loop.inputs", &format!("loop.{key}\nloop.inputs")), &text)
                .is_none_or(|a| a.is_err())
        );
    }
}

/// Full matrices and blocks in a ring: the way through all permutations never ends, elimination does.
#[test]
fn determinants_without_zeros_end() {
    let rows: Vec<String> = (0..18)
        .map(|i| {
            let entry = |j: usize| format!("'{}/{}'", (i * i + 7 * j + i * j) % 19 + 1, 37 + (3 * i + 5 * j) % 11);
            format!("[{}]", (0..18).map(entry).collect::<Vec<_>>().join(", "))
        })
        .collect();
    let full = format!("time = 'discrete'\nparameters.K = {{}}\nloop.matrix = [{}]", rows.join(", "));
    let full = full.replacen("'1/37'", "'K/37'", 1);
    let ring: Vec<String> = (0..16)
        .map(|i| {
            let input = if i == 0 { "r - y15".to_owned() } else { format!("y{}", i - 1) };
            let discretize = "discretize = { method = 'tustin', T = 'K' }";
            format!(
                "{{ input = '{input}', output = 'y{i}', transfer = '{}/(10*s + {})', {discretize} }}",
                i + 1,
                10 + i
            )
        })
        .collect();
    let ring = format!("time = 'discrete'\nparameters.K = {{}}\nloop.inputs = 'r'\nblock = [{}]", ring.join(", "));
    for model in [full, ring] {
        let text = verdict_emitted(&model, "K", "1/3");
        accept(&model, &text);
    }
}
