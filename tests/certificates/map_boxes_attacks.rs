//! Certificates of boxes by hand, each against one thing that a check of boxes must not forget. Both checkers say the same.

use crate::helpers::certificates::checkers::{accept, reject};
use jurist_check::Step;

/// A model in `a`, `b`, and `c`.
fn model(time: &str, characteristic: &str) -> String {
    let parameters = "{ a = {}, b = {}, c = {} }";
    format!("time = '{time}'\nparameters = {parameters}\nloop.characteristic = '{characteristic}'")
}

/// A certificate about `a` and `b` with `c = 0`.
fn certificate(region: &str, x: [&str; 2], y: [&str; 2], tree: &str) -> String {
    let time = if region.contains("radius") { "discrete" } else { "continuous" };
    format!(
        r#"{{"schema": "jurist/certificate/7", "statement": {{"kind": "boxes", "time": "{time}", "x": "a", "y": "b",
        "set": {{"c": "0"}}, "region": {{{region}}}, "window": {{"x": {x:?}, "y": {y:?}}}, "tree": "{tree}"}},
        "order": 3, "bits": 64}}"#
    )
}

const DISC: &str = r#""radius": "1""#;
const LEFT: &str = r#""decay": "0""#;

#[test]
fn boxes_where_a_loop_may_be_undefined_are_not_stable() {
    let unit = ["0", "1"];
    for divisor in ["a - b", "a^2 - b", "a - exp(b - 1)", "(a - b)/(a + 2)"] {
        let text = model("discrete", &format!("z + a/4 + b/4 + 0/({divisor}) + 0*c"));
        // It vanishes at some points of this box, and stays as stable as it was beside.
        reject(&text, &certificate(DISC, unit, unit, "+"), Step::Stable);
        reject(&text, &certificate(DISC, unit, unit, "-"), Step::Stable);
        accept(&text, &certificate(DISC, ["7/4", "15/8"], unit, "+"));
    }
    // Of a constant that nothing is made of: no coefficient shows it.
    for divisor in ["a - b", "a - exp(b - 1)"] {
        let text = format!("{}\nconstants.unused = '1/({divisor})'", model("discrete", "z + a/4 + b/4 + 0*c"));
        reject(&text, &certificate(DISC, unit, unit, "+"), Step::Stable);
        accept(&text, &certificate(DISC, ["7/4", "15/8"], unit, "+"));
        accept(&text, &certificate(DISC, ["7", "8"], unit, "-"));
    }
    let nowhere = format!("{}\nconstants.unused = '1/c'", model("discrete", "z + a/4 + b/4"));
    accept(&nowhere, &certificate(DISC, unit, unit, "-"));
    reject(&nowhere, &certificate(DISC, unit, unit, "+"), Step::Stable);
    // Of a block, in the loop's variable: where all of it vanishes.
    for (divisor, is_defined) in
        [("(b + 2)*z", true), ("(b + 2)*z + (a - b)/8", true), ("(b - 1/2)*z", false), ("(a - b)*(z + 1/8)", false)]
    {
        let text = format!(
            "time = 'discrete'\nparameters = {{ a = {{}}, b = {{}}, c = {{}} }}\n[loop]\n[[block]]\ninput = '-a*y/9'\noutput = 'u'\n\
             transfer = '1/({divisor})'\n[[block]]\ninput = 'u'\noutput = 'y'\ngain = 1\n"
        );
        match is_defined {
            true => accept(&text, &certificate(DISC, unit, unit, "+")),
            false => reject(&text, &certificate(DISC, unit, unit, "+"), Step::Stable),
        }
        reject(&text, &certificate(DISC, unit, unit, "-"), Step::Stable);
    }
}

#[test]
fn loops_that_are_nowhere_stable_have_no_stable_box() {
    let [x, y] = [["1", "2"], ["1", "2"]];
    for (time, region, characteristic) in [
        ("discrete", DISC, "z + a/4 + b/9 + 0/c"),
        ("discrete", DISC, "(z - 1)*(z + a/4 + b/9) + 0*c"),
        ("continuous", LEFT, "s^3 + a*s^2 + b + 0*c"),
        ("continuous", LEFT, "c*s^2 + a*s + b"),
    ] {
        let text = model(time, characteristic);
        accept(&text, &certificate(region, x, y, "-"));
        reject(&text, &certificate(region, x, y, "+"), Step::Stable);
        reject(&text, &certificate(region, x, y, "y?x-+"), Step::Stable);
    }
}

#[test]
fn what_is_known_of_one_half_is_not_said_of_the_other() {
    let text = model("discrete", "z - a + 0*b + 0*c");
    let of = |tree: &str| certificate(DISC, ["0", "3"], ["0", "1"], tree);
    for right in ["x?-", "yx?-x?-", "xy??-", "xy??y--", "xx+?-"] {
        // The lower quarter ends at 3/4.
        accept(&text, &of(right));
    }
    for wrong in ["x-?", "x+?", "x?+", "y-?", "y?-", "y+?", "y?+", "yx?-x-?", "yx-?x?-", "xx?+-", "xx?--"] {
        reject(&text, &of(wrong), Step::Stable);
    }
    let turned = model("discrete", "z - b + 0*a + 0*c");
    let of = |tree: &str| certificate(DISC, ["0", "1"], ["0", "3"], tree);
    accept(&turned, &of("yx??-"));
    for wrong in ["x?-", "x-?", "x+?", "y-?", "y?+", "xy?-y-?"] {
        reject(&turned, &of(wrong), Step::Stable);
    }
}

#[test]
fn the_region_is_that_of_the_statement() {
    let text = model("discrete", "z - a + 0*b + 0*c");
    let of =
        |radius: &str, tree: &str| certificate(&format!(r#""radius": "{radius}""#), ["5/8", "7/8"], ["0", "1"], tree);
    for (radius, right, wrong) in [("1", "+", "-"), ("1/2", "-", "+"), ("9/10", "+", "-"), ("3/5", "-", "+")] {
        accept(&text, &of(radius, right));
        reject(&text, &of(radius, wrong), Step::Stable);
    }
    let text = model("continuous", "s + a + 0*b + 0*c");
    let of = |decay: &str, tree: &str| certificate(&format!(r#""decay": "{decay}""#), ["5/8", "7/8"], ["0", "1"], tree);
    for (decay, right, wrong) in [("0", "+", "-"), ("1/2", "+", "-"), ("1", "-", "+"), ("-1", "+", "-")] {
        accept(&text, &of(decay, right));
        reject(&text, &of(decay, wrong), Step::Stable);
    }
}

/// What the loop's variable is inside of is no function of the parameters: `exp(-s)` is dead time, and nothing else is read.
#[test]
fn of_functions_of_the_variable_of_the_loop_dead_time_is_read() {
    let with = |inside: &str| model("continuous", &format!("s + 1 + a + b*{inside} + 0*c"));
    let certificate = certificate(LEFT, ["0", "1"], ["0", "1/4"], "+");
    for inside in ["exp(-s)", "exp(-s*(a + 1))"] {
        accept(&with(inside), &certificate);
    }
    for inside in ["sin(1/(s + 1))", "exp(s/s)", "exp(a/s)", "exp(-s^2)", "exp(-s - 1)", "exp(-a*b*s)", "sqrt(s)"] {
        reject(&with(inside), &certificate, Step::Model);
    }
}

/// Before time begins nothing is held: `z = exp(-T) - K (1 - exp(-T))` is a number there, and no loop.
#[test]
fn sample_times_are_positive() {
    let text = "time = 'discrete'\nsample_time = 'b'\nparameters = { a = { nominal = 1 }, b = { nominal = 1 }, c = {} }\n[loop]\n\
        [[block]]\ninput = '-a*y'\noutput = 'u'\ngain = 1\n\
        [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 1)'\ndiscretize = 'zoh'\n";
    accept(text, &certificate(DISC, ["1/8", "1/4"], ["1", "2"], "+"));
    for (b, tree) in [(["-2", "-1"], "-"), (["-2", "-1"], "+"), (["-1", "1"], "-"), (["-1", "1"], "+")] {
        reject(text, &certificate(DISC, ["1/8", "1/4"], b, tree), Step::Stable);
    }
}

/// Sine and cosine of the same angle, whichever is read first.
#[test]
fn functions_of_one_argument_are_told_apart() {
    for (characteristic, right, wrong) in [
        ("z - cos(b)/2 - 3*sin(b)", "+", "-"),
        ("z - 3*sin(b) - cos(b)/2", "+", "-"),
        ("z - 3*sin(b) - 2*cos(b)", "-", "+"),
        ("z - 2*cos(b) - 3*sin(b)", "-", "+"),
        ("z - sqrt(b + 1/8) - exp(b + 1/8)/4", "+", "-"),
        ("z - exp(b + 1/8) - sqrt(b + 1/8)/4", "-", "+"),
    ] {
        let text = model("discrete", &format!("{characteristic} + 0*a + 0*c"));
        accept(&text, &certificate(DISC, ["0", "1"], ["0", "1/8"], right));
        reject(&text, &certificate(DISC, ["0", "1"], ["0", "1/8"], wrong), Step::Stable);
    }
}
