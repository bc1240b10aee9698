//! Points at which a block loses its order are undefined, also where direct feedthrough keeps up the degree of
//! the whole: the engine's certificates say so, and no certificate may say otherwise.

use crate::helpers::certificates::checkers::{accept, reject};
use crate::helpers::certificates::emitted;
use jurist_check::Step;

fn diagram(time: &str, input: &str, block: &str) -> String {
    format!(
        "time = '{time}'\nparameters.p = {{}}\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
         [[block]]\nname = 'G'\ninput = '{input}'\noutput = 'y'\n{block}\n"
    )
}

#[test]
fn true_certificates_of_blocks_that_lose_their_order() {
    for (time, input, block) in [
        ("discrete", "r - y", "transfer = '2*z/(p*z + 1)'"),
        ("discrete", "r - 3*y", "transfer = '1/(s - p)'\ndiscretize = { method = 'tustin', c = 2 }"),
        ("discrete", "r - 3*y", "A = [['p']]\nB = [[1]]\nC = [[1]]\ndiscretize = { method = 'tustin', T = 1 }"),
        ("continuous", "r - y", "num = [1, 1]\nden = ['p', 1]"),
        ("discrete", "r - 3*y", "transfer = '1/(s - p)'\ndiscretize = { method = 'backward', T = 1 }"),
        ("discrete", "r - y", "transfer = 'p/(p*z + p^2)'"),
        ("discrete", "r - y/2", "transfer = '1/(p*s + 1)'\ndiscretize = { method = 'tustin', T = 1 }"),
        ("discrete", "r - y/2", "transfer = '1/(p*s + 1)'\ndiscretize = { method = 'forward', T = '1/10' }"),
        ("discrete", "r - y/2", "num = [1, 'p']\nden = ['p', 1, '1/(p - 2)']"),
    ] {
        let model = diagram(time, input, block);
        accept(&model, &emitted(&model, "p"));
    }
}

/// `1/(p z + 1)` times `2 z` in a loop: the closed loop is `(p + 2) z + 1` but for the point `p = 0`, where the
/// block is improper.
#[test]
fn a_point_without_a_model_is_not_stable() {
    let model = diagram("discrete", "r - y", "transfer = '2*z/(p*z + 1)'");
    let statement = |stable: &str, line: &str| {
        format!(
            r#"{{"schema": "jurist/certificate/1",
  "statement": {{"kind": "intervals", "time": "discrete", "parameter": "p", "set": {{}}, "region": {{"radius": "1"}},
    "domain": {{"lower": null, "upper": null}}, "stable": [{stable}]}},
  "characteristic": [["1"], ["2", "1"]], "boundary": null,
  "factors": [["2", "1"], ["3", "1"], ["1", "1"], ["0", "1"]],
  "line": [{{"split": [], "sample": "-4", "stable": true}}, {{"at": "-3"}}, {{"split": [], "sample": "-5/2", "stable": false}},
           {{"at": "-2"}}, {{"split": [], "sample": "-3/2", "stable": false}}, {{"at": "-1"}}, {line}]}}"#
        )
    };
    let true_line =
        r#"{"split": [], "sample": "-1/2", "stable": true}, {"at": "0"}, {"split": [], "sample": "1", "stable": true}"#;
    let claims = r#"{"lower": null, "upper": "-3"}, {"lower": "-1", "upper": "0"}, {"lower": "0", "upper": null}"#;
    accept(&model, &statement(claims, true_line));
    let false_claims = r#"{"lower": null, "upper": "-3"}, {"lower": "-1", "upper": null}"#;
    reject(&model, &statement(false_claims, true_line), Step::Stable);
    let false_line = r#"{"split": [], "sample": "1", "stable": true}"#;
    reject(&model, &statement(false_claims, false_line), Step::Line);
}

/// A key that the engine refuses may be the one that matters: here the discretisation is misspelt.
#[test]
fn misspelt_keys_are_no_models() {
    let model =
        diagram("discrete", "r - y/2", "A = [['p']]\nB = [[1]]\nC = [[1]]\ndiscretize = { method = 'tustin', T = 1 }");
    let text = emitted(&model, "p");
    accept(&model, &text);
    let undiscretised = model.replace("discretize = { method = 'tustin', T = 1 }", "");
    let other = emitted(&undiscretised, "p");
    accept(&undiscretised, &other);
    for (from, to) in
        [("discretize", "discretise"), ("method =", "methode = 1, method ="), ("time =", "times = 1\ntime =")]
    {
        reject(&model.replace(from, to), &text, Step::Model);
    }
    reject(&model.replace("discretize", "discretise"), &other, Step::Model);
    reject(&model.replace("inputs", "states = ['x']\ninputs"), &text, Step::Model);
    reject(&model.replace("p = {}", "p = { nominale = 1 }"), &text, Step::Model);
}

/// With the coefficient set to 0 there is no model for any `p`.
#[test]
fn no_model_at_a_value_is_not_stable() {
    let model =
        diagram("discrete", "r - y", "transfer = '2*z/(a*z + 1) + 0*p'").replace("p = {}", "p = {}\nparameters.a = {}");
    let forged = r#"{"schema": "jurist/certificate/1",
  "statement": {"kind": "intervals", "time": "discrete", "parameter": "p", "set": {"a": "0"}, "region": {"radius": "1"},
    "domain": {"lower": null, "upper": null}, "stable": [{"lower": null, "upper": null}]},
  "characteristic": [["1"], ["2"]], "boundary": null, "factors": [],
  "line": [{"split": [], "sample": "0", "stable": true}]}"#;
    reject(&model, forged, Step::Characteristic);
}
