//! Certificates of loops with rules that are exact at one frequency: accepted by both checkers, and by neither for another frequency, another
//! sample time, or an angle that no sampled loop has.

use super::map_boxes::{certified, emitted as emitted_map, leaves, tree_of};
use crate::helpers::certificates::checkers::{accept, python, reject};
use crate::helpers::certificates::{emitted, emitted_if_any, verdict_emitted, with_count_changed};
use crate::helpers::model::{example_text, read};
use crate::helpers::number::number;
use crate::helpers::thorough::{is_thorough, tried};
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_check::{Limits, Step, check};
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

/// A gain `K`, a lag by Tustin's rule, a sample of delay. With `c = w/tan(w T/2)` the characteristic polynomial is
/// `z (c (z - 1) + z + 1) + K (z + 1)`, by Jury's criterion stable for `-1 < K < 1 + c`.
fn lag(frequency: &str, time: &str) -> String {
    format!(
        "time = 'discrete'\nparameters = {{ K = {{}}, b = {{ nominal = 1 }} }}\n[loop]\n[[block]]\ninput = '-K*y'\noutput = 'u'\ntransfer = '1/z'\n\
         [[block]]\ninput = 'u'\noutput = 'y'\ntransfer = '1/(s + 1)'\n\
         discretize = {{ method = 'tustin', T = '{time}', prewarp = '{frequency}' }}\n"
    )
}

/// `1 + w/tan(w T/2)`.
fn greatest_gain(frequency: f64, time: f64) -> f64 {
    1.0 + frequency / (frequency * time / 2.0).tan()
}

fn is_rejected(model: &str, certificate: &str) {
    assert!(check(model, certificate, &LIMITS).is_err(), "{model}\n{certificate}");
    assert!(python(model, certificate).is_none_or(|found| found.is_err()), "Python\n{model}\n{certificate}");
}

#[test]
fn the_limit_of_a_lag_is_the_one_by_hand() {
    for (frequency, time) in [("3", "1"), ("1/8", "2"), ("700", "1/4000"), ("31", "1/10")] {
        let model = lag(frequency, time);
        accept(&model, &emitted(&model, "K"));
        let [w, t] = [frequency, time].map(|q| number(q).to_f64_approximate());
        let limit = greatest_gain(w, t);
        for (factor, letter) in [(0.999, true), (1.001, false)] {
            let gain = Rational::from_f64(limit * factor).unwrap().to_string();
            let certificate = verdict_emitted(&model, "K", &gain);
            accept(&model, &certificate);
            assert_eq!(certificate.contains(r#""verdict": "stable""#), letter, "{certificate}");
            is_rejected(&model, &with_count_changed(&certificate, "inside"));
        }
    }
}

/// A notch whose frequency and angle are what the plant's own are not; one whose angle is three times that of the plant's tangent (angles are added);
/// two notches; a block given by matrices, with the parameter in it; one with another sample time; one without states beside another.
#[test]
#[ignore = "long: CI runs it"]
fn lines_and_verdicts_of_prewarped_loops_are_certified() {
    const NOTCH: &str = "transfer = '(s^2 + s/2 + 9)/(s^2 + 4*s + 9)'";
    let model = |rule: &str, plant: &str, more: &str| {
        format!(
            "time = 'discrete'\nsample_time = 'T'\nconstants.T = '1/5'\nparameters.K = {{ nominal = '1/10' }}\n[loop]\n\
             [[block]]\ninput = '-K*y'\noutput = 'u'\n{rule}\n[[block]]\ninput = 'u'\noutput = 'y'\n{plant}\n{more}"
        )
    };
    let notch = |of: &str| format!("{NOTCH}\ndiscretize = {{ method = 'tustin', {of} }}");
    let held = |transfer: &str| format!("transfer = '{transfer}'\ndiscretize = 'zoh'");
    let another = "[[block]]\ninput = 'y'\noutput = 'v'\ntransfer = '1/(s + 2)'\n\
        discretize = { method = 'tustin', T = '3*T/2', prewarp = 'T + 2' }\n";
    for text in [
        model(&notch("prewarp = 3"), &held("1/(s + 1)"), ""),
        model(&notch("prewarp = '30*T'"), &held("1/(s^2 + s + 17/4)"), ""),
        model(&notch("prewarp = 3"), &held("1/(s + 1)"), another),
        model(
            "A = [[0, 1], ['-4 - K', -1]]\nB = [[0], [1]]\nC = [[1, 0]]\ndiscretize = { method = 'tustin', prewarp = 15.7 }",
            "transfer = '1/z'",
            "",
        ),
        model("gain = 1\ndiscretize = { method = 'tustin', prewarp = 5 }", "transfer = '1/z'", another),
    ] {
        let certificate = emitted(&text, "K");
        assert!(certificate.contains("{\"tan\": [\"1\", "), "{certificate}");
        accept(&text, &certificate);
        let certificate = verdict_emitted(&text, "K", "1/10");
        accept(&text, &certificate);
        is_rejected(&text, &with_count_changed(&certificate, "inside"));
    }
}

/// The same for a line, a verdict and a map: the model has another frequency or time, one that no sampled loop has, or another rule.
#[test]
fn certificates_of_other_rules_are_rejected() {
    let text = lag("3", "1/2");
    let map = emitted_map(&text, [("K", "-1/2", "2"), ("b", "1", "2")], "0.1").0;
    for certificate in [emitted(&text, "K"), verdict_emitted(&text, "K", "1")] {
        for (from, to) in [("prewarp = '3'", "prewarp = '3.0000001'"), ("T = '1/2'", "T = '0.5000001'")] {
            is_rejected(&text.replace(from, to), &certificate);
        }
    }
    // The map has room for that.
    accept(&text.replace("prewarp = '3'", "prewarp = '3.0000001'"), &map);
    is_rejected(&text.replace("prewarp = '3'", "prewarp = '6'"), &map);
    for certificate in [&emitted(&text, "K"), &verdict_emitted(&text, "K", "1"), &map] {
        for (from, to) in [
            ("prewarp = '3'", "prewarp = '-3'"),
            ("prewarp = '3'", "prewarp = '0'"),
            ("prewarp = '3'", "prewarp = '6.2832'"),
            // A turn more: the same tangent but for the sign of the angle.
            ("prewarp = '3'", "prewarp = '15.566'"),
            ("T = '1/2'", "T = '-1/2'"),
            ("T = '1/2'", "T = '0'"),
            ("T = '1/2'", "T = '2'"),
            ("T = '1/2', ", ""),
            ("prewarp = '3'", "prewarp = '3', c = '3.2'"),
            ("prewarp = '3'", "prewarp = '3', c = '3.2', delay = 1"),
            ("T = '1/2', prewarp = '3'", "c = '3.2', prewarp = '3'"),
            ("tustin", "forward"),
            ("tustin", "backward"),
            ("tustin", "zoh"),
            ("prewarp = '3'", "prewarp = 'z'"),
            ("prewarp = '3'", "prewarp = 'u'"),
            ("prewarp = '3'", "prewarps = '3'"),
        ] {
            assert!(text.contains(from), "{from}");
            reject(&text.replacen(from, to, 1), certificate, Step::Model);
        }
    }
    // Both negative: the angle is that of the model.
    reject(&text.replace("'1/2'", "'-1/2'").replace("'3'", "'-3'"), &map, Step::Model);
}

/// By the formula alone these loops are what the certificates say, with a tangent that is the right one: but no angle is above pi, and no frequency or time
/// is negative. Numbers are seen as they are written, others with the values of the parameters.
#[test]
fn angles_and_signs_that_no_sampled_loop_has_are_rejected() {
    for (frequency, factor) in [("3", ""), ("3*b", "*b")] {
        let text = |time: &str| lag(frequency, &format!("{time}{factor}"));
        let right = verdict_emitted(&text("1/2"), "K", "1");
        accept(&text("1/2"), &right);
        // tan(15/4) is positive again; the loop with the factor 3/tan(15/4) has both of its roots inside.
        let angle = "\"3/4\"";
        assert!(right.contains(angle) && right.contains(r#""inside": 2"#), "{right}");
        reject(&text("5/2"), &right.replace(angle, "\"15/4\""), Step::Model);
        // w/tan(w T/2) is even in w.
        let negative = lag(&format!("-{frequency}"), &format!("1/2{factor}"));
        reject(&negative, &right, Step::Model);
        // The other sign of the factor, or of s.
        let mirrored = |text: &str| text.replace("1/(s + 1)", "1/(1 - s)");
        let right = verdict_emitted(&mirrored(&text("1/2")), "K", "-2");
        accept(&mirrored(&text("1/2")), &right);
        assert!(right.contains(r#""inside": 2"#), "{right}");
        reject(&text("-1/2"), &right, Step::Model);
        reject(&lag(&format!("-{frequency}"), &format!("-1/2{factor}")), &right, Step::Model);
    }
    // A loop that is nowhere stable needs no factor for that, but is to be one.
    let nowhere = |frequency: &str, time: &str| {
        format!("{}[[block]]\ninput = 'y'\noutput = 'v'\ntransfer = '1/(z - 1)'\n", lag(frequency, time))
    };
    let boxes = of_boxes(["1/8", "1/7"], ["1", "2"], "-");
    accept(&nowhere("3", "1"), &boxes);
    for (frequency, time) in [("4", "1"), ("-3", "1"), ("3", "-1"), ("-3", "-1"), ("0", "1")] {
        reject(&nowhere(frequency, time), &boxes, Step::Model);
    }
}

/// A certificate of boxes of `K` and `b`.
fn of_boxes(gains: [&str; 2], b: [&str; 2], tree: &str) -> String {
    let [gains, b] = [gains, b].map(|ends| ends.map(|end| number(end).to_string()));
    format!(
        r#"{{"schema": "jurist/certificate/7", "statement": {{"kind": "boxes", "time": "discrete", "x": "K", "y": "b", "set": {{}},
        "region": {{"radius": "1"}}, "window": {{"x": {gains:?}, "y": {b:?}}}, "tree": "{tree}"}}, "order": 4, "bits": 128}}"#
    )
}

/// A gain of 1/8 is stable by the formula wherever the factor is not below -7/8, and one of -2 by no factor: where the angle is none between zero and
/// pi nothing is said of it, be it by numbers, by functions, by both factors of it, or of either sign.
#[test]
fn no_box_is_shown_in_which_the_angle_leaves_zero_to_pi() {
    let small = ["1/8", "1/7"];
    let cases = [
        (
            "b",
            "1",
            &[["1/8", "1/7"], ["1", "3/2"], ["3", "3.1"]][..],
            // At zero and beyond it, around pi and above it; at 7 to 9 the formula's factor is positive again.
            &[
                ["0", "1"],
                ["-1", "1"],
                ["-2", "-1"],
                ["-1/8", "-1/9"],
                ["3", "22/7"],
                ["3.1", "3.2"],
                ["3.2", "3.5"],
                ["7", "7.1"],
                ["8", "9"],
            ][..],
        ),
        (
            "2",
            "b",
            &[["1/8", "1/7"], ["1/2", "3/4"], ["3/2", "1.55"]],
            &[["0", "1"], ["-1", "1"], ["-3/4", "-1/2"], ["1.5", "1.6"], ["1.6", "1.7"], ["3.5", "3.6"]],
        ),
        // The angle is b^2 or b^2/4: positive on both sides of zero.
        ("b", "b", &[["1", "5/4"], ["17/10", "7/4"]], &[["-5/4", "-1"], ["-1", "1"], ["7/4", "9/5"], ["9/5", "2"]]),
        ("-b", "-b/4", &[["-2", "-3/2"], ["-7/2", "-10/3"]], &[["1", "2"], ["-18/5", "-7/2"], ["-4", "-18/5"]]),
        ("1/b", "b^2", &[["1/2", "3/4"], ["3", "3.1"]], &[["-3/4", "-1/2"], ["3", "22/7"], ["4", "5"]]),
        (
            "pi*b",
            "1",
            &[["1/2", "3/4"], ["9/10", "99/100"]],
            &[["99/100", "1"], ["99/100", "101/100"], ["1", "11/10"], ["-1/2", "-1/4"]],
        ),
        (
            "4*sin(b)",
            "1",
            &[["1/8", "1/7"], ["3", "3.05"]],
            &[["1/2", "1"], ["3", "22/7"], ["1", "3/2"], ["-1/7", "-1/8"]],
        ),
    ];
    for (frequency, time, inside, outside) in tried(cases, 4) {
        let text = lag(frequency, time);
        for side in inside {
            accept(&text, &of_boxes(small, *side, "+"));
            accept(&text, &of_boxes(["-3", "-2"], *side, "-"));
            for (gains, tree) in [(small, "-"), (["-3", "-2"], "+")] {
                reject(&text, &of_boxes(gains, *side, tree), Step::Stable);
            }
        }
        for side in outside {
            for tree in ["+", "-"] {
                for gains in [small, ["-3", "-2"]] {
                    reject(&text, &of_boxes(gains, *side, tree), Step::Stable);
                }
            }
        }
    }
    // The lower half is seen; the upper one has an angle above pi, and so has the whole.
    let text = lag("b", "1");
    accept(&text, &of_boxes(small, ["2", "4"], "y+?"));
    for tree in ["y++", "y+-", "y?+", "y+y-?"] {
        reject(&text, &of_boxes(small, ["2", "4"], tree), Step::Stable);
    }
    // No matter what the block does with its factor.
    for block in ["transfer = '1/2'", "gain = '1/2'", "D = [['1/2']]"] {
        let text = text.replace("transfer = '1/(s + 1)'", block);
        accept(&text, &of_boxes(small, ["1", "2"], "+"));
        reject(&text, &of_boxes(small, ["3", "4"], "+"), Step::Stable);
        reject(&text, &of_boxes(small, ["-2", "-1"], "+"), Step::Stable);
    }
}

/// The boxes of a map are on the side of the curve by hand that they say, and the engine says the same of points in them.
#[test]
#[ignore = "long: CI runs it"]
fn maps_of_prewarped_loops_are_certified() {
    let loops = [
        ("b", "1", [("K", "0", "4"), ("b", "1/2", "3")]),
        ("2", "b", [("K", "0", "8"), ("b", "1/4", "3/2")]),
        ("2*pi*b", "1/(1 + b)", [("K", "0", "4"), ("b", "1/4", "9/10")]),
    ];
    for (frequency, time, sides) in tried(loops, 3) {
        let text = lag(frequency, time);
        let (undecided, least) = if is_thorough() { ("0.15", "0.8") } else { ("0.3", "0.6") };
        assert!(certified(&text, sides, undecided, least, 1) > 10, "{text}");
        let (certificate, _) = emitted_map(&text, sides, undecided);
        let window = sides.map(|(_, low, high)| [number(low), number(high)]);
        for (letter, [gains, b]) in leaves(&tree_of(&certificate), window).unwrap() {
            let b = b.map(|q| q.to_f64_approximate());
            let limit = |b: f64| match (frequency, time) {
                ("b", _) => greatest_gain(b, 1.0),
                ("2", _) => greatest_gain(2.0, b),
                _ => greatest_gain(2.0 * std::f64::consts::PI * b, 1.0 / (1.0 + b)),
            };
            let gains = gains.map(|q| q.to_f64_approximate());
            // It falls as b grows.
            match letter {
                '+' => assert!(gains[1] <= limit(b[1]), "{gains:?} {b:?}"),
                '-' => assert!(gains[0] >= limit(b[0]), "{gains:?} {b:?}"),
                _ => {}
            }
        }
    }
}

/// A gain and the inertia of the load; a gain and the frequency of the notch, which is a constant of the model.
#[test]
#[ignore = "long: CI runs it"]
fn maps_of_the_two_mass_drive_are_certified() {
    let text = example_text("two-mass-drive");
    let maps = [
        ([("K_p", "1/10", "1"), ("w_n", "600", "800")], "0.9"),
        ([("K_p", "1/10", "1/2"), ("J_l", "0.0015", "0.002")], "0.9"),
        ([("K_p", "4", "5"), ("T", "0.0002", "0.00025")], "0.3"),
    ];
    for (sides, least) in tried(maps, 2) {
        assert!(certified(&text, sides, "0.5", least, 3) > 0, "{sides:?}");
    }
}

/// A map over constants that are not rational has no exact certificate, nor has an answer in the parameter inside of the tangent, nor one where the tangents cancel.
#[test]
fn what_no_checker_knows_gets_no_certificate() {
    let budget = Budget::unlimited();
    let text = lag("3", "1/2");
    let model = read(&text);
    let refused =
        jurist_prove::refuse_map_certificate(&model.ask().free("K").free("b").plane_problem().unwrap(), &budget)
            .unwrap_err();
    assert!(refused.to_string().contains("constants that are not rational"), "{refused}");
    for (frequency, time) in [("b", "1"), ("1", "b")] {
        let free = read(&lag(frequency, time));
        let domain = jurist_engine::stability::Range::between(Some(number("1/2")), Some(number("3/2")));
        let answer = free.ask().set("K", number("1")).free("b").domain("b", domain).stable_set(&budget).unwrap();
        let refused = answer.certificate(&budget).unwrap_err().to_string();
        assert!(refused.contains("no checker knows"), "{refused}");
    }
    // Functions that are written stay without one, be they the same tangent.
    for written in ["2*pi*b", "sqrt(5)", "3 + 0*tan(3/4)"] {
        assert!(emitted_if_any(&lag(written, "1/8"), "K").is_none(), "{written}");
    }
    // tan(pi/4) = 1: no symbol is left, but the number pi is written. A verdict is proved by enclosures.
    let written = lag("2", "pi/4");
    let cancels = read(&written).ask().set("K", number("1")).verdict(&budget).unwrap().certificate(&budget).unwrap();
    accept(&written, &cancels);
    // c (z - 1) + 0: the factor is left out, but the loop is undefined without it.
    let out = text.replace("1/(s + 1)", "K/s");
    accept(&out, &verdict_emitted(&out, "K", "0"));
    // By certificates of rational loops nothing is proved.
    let plain = text.replace(", prewarp = '3'", "");
    for certificate in [emitted(&plain, "K"), verdict_emitted(&plain, "K", "1")] {
        accept(&plain, &certificate);
        reject(&text, &certificate, Step::Model);
    }
}
