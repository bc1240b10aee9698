//! Certificates of maps by boxes of loops with dead time: both checkers accept what is written, and nothing that is wrong.

use super::map_boxes::{Side, certified, emitted, is_true, leaves, plain, rejected_or_true, tree_of};
use crate::helpers::certificates::checkers::{PYTHON_EVERY, accept, reject};
use crate::helpers::certificates::with;
use crate::helpers::model::{example_text, path};
use crate::helpers::number::number;
use crate::helpers::program::jurist;
use crate::helpers::random::Random;
use crate::helpers::thorough::{count, is_thorough, tried};
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

const INTEGRATOR: &str = "s + a*exp(-b*s)";
const WINDOW: [Side; 2] = [("a", "-1/2", "4"), ("b", "0", "2")];

/// That a map is certified, at least this share of the window, by both checkers, and that its boxes are stable or not as a function with
/// monotone limits says at their corners: it is positive where the loop is stable.
fn follows(characteristic: &str, sides: [Side; 2], least: &str, margin: impl Fn(f64, f64) -> f64) {
    let text = plain("continuous", characteristic);
    let (undecided, fewer) = if is_thorough() { ("0.15", "0") } else { ("0.3", "0.2") };
    let (certificate, share) = emitted(&text, sides, undecided);
    accept(&text, &certificate);
    assert!(share > number(least) - number(fewer), "{share}\n{text}");
    let window = sides.map(|(_, low, high)| [number(low), number(high)]);
    let mut seen = [0, 0];
    for (letter, cell) in leaves(&tree_of(&certificate), window).unwrap().into_iter().filter(|(l, _)| *l != '?') {
        let [xs, ys] = cell.map(|side| side.map(|end| end.to_f64_approximate()));
        for (x, y) in [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| (xs[i], ys[j])) {
            assert_eq!(margin(x, y) > 0.0, letter == '+', "{characteristic} at {x}, {y}");
        }
        seen[usize::from(letter == '+')] += 1;
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{characteristic}: {seen:?}");
}

#[test]
#[ignore = "long: CI runs it"]
fn boxes_follow_closed_forms() {
    follows(INTEGRATOR, WINDOW, "0.8", |a, b| a.min(FRAC_PI_2 - a * b));
    // With w = sqrt(a^2 - 1): b < (pi - atan w)/w.
    follows("s + 1 + a*exp(-b*s)", [("a", "-2", "4"), ("b", "0", "3")], "0.8", |a, b| {
        let w = (a * a - 1.0).max(0.0).sqrt();
        if a <= 1.0 { a + 1.0 } else { (PI - w.atan()) / w - b }
    });
    // Of neutral type: on the axis |i w + b| = |a w| is never met for |a| < 1; beyond 1 there are chains to the right.
    follows("s*(1 + a*exp(-s)) + b", [("a", "-2", "2"), ("b", "-1", "2")], "0.7", |a, b| b.min(1.0 - a.abs()));
    // Both parameters are dead times; and one is that of several terms, which cancel.
    follows("s + exp(-a*s)*exp(-b*s)", [("a", "0", "2"), ("b", "0", "2")], "0.8", |a, b| FRAC_PI_2 - a - b);
    follows("s + a*(exp(-2*b*s) - exp(-b*s)^2) + a - 1", [("a", "0", "3"), ("b", "0", "1")], "0.8", |a, _| a - 1.0);
}

#[test]
#[ignore = "long: CI runs it"]
fn examples_are_certified() {
    let mut seen = 0;
    let maps = [
        ("dead-time-pi", [("K_c", "0", "4"), ("T_i", "1", "20")]),
        ("dead-time-pid", [("K", "0", "20"), ("theta", "0", "4")]),
        ("chatter", [("k_c", "0", "2"), ("T", "2", "6")]),
        ("smith-predictor", [("theta_model", "3", "7"), ("theta_process", "3", "8")]),
        ("neutral-loop", [("K", "-3/4", "3/4"), ("tau", "1/4", "3")]),
    ];
    for (name, sides) in tried(maps, 3) {
        seen += certified(&example_text(name), sides, "0.25", "0.7", 2);
    }
    assert!(seen > 10 * count(1, 3), "{seen}");
}

#[test]
fn random_loops_agree_with_verdicts() {
    let (mut random, mut seen) = (Random::new(11), 0);
    for round in 0..5 {
        let mut c = |n: usize| random.below(n) as i64;
        let delayed = match round % 3 {
            0 => format!("(a + {}*s)*exp(-b*s)", c(3)),
            1 => format!("a*exp(-b*s) + ({} - s)*exp(-{}*s)", c(4), 1 + c(2)),
            _ => format!("(a*s + {})*exp(-(b + 1/2)*s) - b*s", 1 + c(4)),
        };
        let text = plain("continuous", &format!("s^{} + {}*s + {} + {delayed}", 2 + c(2), 1 + c(9), c(9)));
        let sides = [("a", "-1", "5"), ("b", "0", "1")];
        seen += certified(&text, sides, "0.1", "0.8", 1);
    }
    assert!(seen > 20, "{seen}");
}

#[test]
#[ignore = "long: CI runs it"]
fn a_leaf_that_lies_is_rejected() {
    let text = plain("continuous", INTEGRATOR);
    let (certificate, _) = emitted(&text, WINDOW, "0.3");
    let tree = tree_of(&certificate);
    let changed = |tree: &str| with(&certificate, &format!("\"{}\"", tree_of(&certificate)), &format!("\"{tree}\""));
    let mut undecidable = 0;
    for (at, letter) in tree.char_indices() {
        let replaced = |by: char| changed(&format!("{}{by}{}", &tree[..at], &tree[at + 1..]));
        match letter {
            '+' => reject(&text, &replaced('-'), Step::Stable),
            '-' => reject(&text, &replaced('+'), Step::Stable),
            '?' => {
                for by in ['+', '-'] {
                    let is_true = check(&text, &replaced(by), &LIMITS).is_ok();
                    assert!(!is_true || self::is_true(&text, &Json::parse(&replaced(by)).unwrap()));
                    undecidable += usize::from(!is_true);
                }
            }
            _ => {}
        }
    }
    assert!(undecidable > 10, "{undecidable}");
}

#[test]
fn another_statement_or_model_is_rejected() {
    let text = plain("continuous", INTEGRATOR);
    let by_hand = r#"{
        "schema": "jurist/certificate/7",
        "statement": {"kind": "boxes", "time": "continuous", "x": "a", "y": "b", "set": {}, "region": {"decay": "0"},
            "window": {"x": ["1", "2"], "y": ["1/2", "5/2"]}, "tree": "yyxx+???y?x?-"},
        "order": 1, "bits": 96
    }"#;
    let said = check(&text, by_hand, &LIMITS).unwrap_or_else(|e| panic!("{e}")).statement;
    assert!(said.starts_with("For a from 1 to 2 and b from 1/2 to 5/2, the loop is stable in all boxes '+'"), "{said}");
    accept(&text, by_hand);
    for (step, from, to) in [
        (Step::Model, r#"{"decay": "0"}"#, r#"{"decay": "1/2"}"#),
        (Step::Model, r#""x": "a""#, r#""x": "c""#),
        (Step::Stable, r#"["1", "2"]"#, r#"["1", "7"]"#),
        (Step::Stable, r#"["1", "2"]"#, r#"["-1", "2"]"#),
        (Step::Stable, r#"["1/2", "5/2"]"#, r#"["1", "5/2"]"#),
        // No loop has a negative dead time.
        (Step::Stable, r#"["1/2", "5/2"]"#, r#"["-1/100", "5/2"]"#),
        (Step::Stable, r#"["1/2", "5/2"]"#, r#"["1/2", "1"]"#),
    ] {
        reject(&text, &with(by_hand, from, to), step);
    }
    for (step, characteristic) in [
        (Step::Stable, "s + a*exp(-(b + 1)*s)"),
        (Step::Stable, "s - a*exp(-b*s)"),
        (Step::Stable, "s + a*exp(-b*s) + a*exp(-3*b*s)"),
        (Step::Stable, "s + a*exp(b*s)"),
        (Step::Model, "s + a*exp(-b^2*s)"),
        (Step::Model, "s + a*exp(-s/b)"),
        (Step::Model, "s + a*exp(-b*s)*exp(s)"),
        (Step::Model, "s + a*exp(-b*s^2)"),
        (Step::Model, "s + a*exp(1 - b*s)"),
        (Step::Model, "s + sqrt(a)*exp(-sqrt(b)*s)"),
        (Step::Model, "s + a*exp(-b*s)*sqrt(2 + exp(-b*s))"),
        (Step::Stable, "s + sqrt(a - 1)*exp(-b*s)"),
        (Step::Model, "s + a*exp(-b*s)/(2 + exp(-b*s))"),
        // The highest power is delayed alone; or there is none.
        (Step::Stable, "s*exp(-b*s) + a"),
        (Step::Model, "a + exp(-b*s)"),
    ] {
        reject(&plain("continuous", characteristic), by_hand, step);
    }
    let discrete = with(
        &with(by_hand, r#""time": "continuous""#, r#""time": "discrete""#),
        r#"{"decay": "0"}"#,
        r#"{"radius": "1"}"#,
    );
    reject(&plain("discrete", "z + a*exp(-b*z)"), &discrete, Step::Model);
    // Where a neutral loop's dead time is zero it has no chain of roots to the right.
    let neutral = plain("continuous", "s*(1 + a*exp(-b*s)) + 1");
    let chains = by_hand.replace(r#"["1", "2"]"#, r#"["3/2", "2"]"#).replace("yyxx+???y?x?-", "-");
    accept(&neutral, &chains);
    reject(&neutral, &chains.replace(r#"["1/2", "5/2"]"#, r#"["0", "5/2"]"#), Step::Stable);
    // All points of such a box are undefined.
    let negative = by_hand.replace(r#"["1/2", "5/2"]"#, r#"["-2", "-1"]"#).replace("yyxx+???y?x?-", "-");
    accept(&text, &negative);
    reject(&text, &negative.replace(r#""-""#, r#""+""#), Step::Stable);
}

#[test]
#[ignore = "long: CI runs it"]
fn changed_certificates_are_rejected_or_true() {
    let text = plain("continuous", INTEGRATOR);
    let (certificate, _) = emitted(&text, WINDOW, "0.4");
    let [rejected, accepted] = rejected_or_true(&text, &certificate, &mut Random::new(5), [2, 40, PYTHON_EVERY]);
    assert!(rejected > 40 && accepted > 0, "{rejected} rejected, {accepted} accepted");
}

#[test]
fn the_program_certifies_boxes_with_dead_time() {
    let file = std::env::temp_dir().join(format!("jurist-boxes-dead-time-{}.json", std::process::id()));
    let file_name = file.to_str().unwrap();
    let pi = path("examples/dead-time-pi.toml").to_str().unwrap().to_owned();
    let ask = ["map", &pi, "-x", "K_c=0..4", "-y", "theta=0..8", "--undecided", "0.3", "--certificate", file_name];
    let run = jurist(&ask);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.starts_with("note: the certificate proves "), "{}", run.stderr);
    let proved = jurist(&["verify", &pi, file_name, "--timeout", "inf"]);
    assert_eq!(proved.status, 0, "{}", proved.stderr);
    assert!(proved.stdout.contains("K_c from 0 to 4 and theta from 0 to 8, with T_i = 8"), "{}", proved.stdout);
    std::fs::remove_file(&file).unwrap();
}
