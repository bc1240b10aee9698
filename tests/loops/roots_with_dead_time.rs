//! The rightmost roots of loops with dead time, against what other commands say of the same loops.

use crate::helpers::model::{continuous, example};
use crate::helpers::number::number;
use crate::helpers::program::{json, jurist, jurist_with_input};
use crate::helpers::thorough::tried;
use jurist::{Ask, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{ClosedLoopRoot, Roots};
use jurist_engine::problem::Question;

fn rightmost(question: Question, wanted: usize) -> Roots {
    question.problem().unwrap().rightmost_roots(wanted, 15, &Budget::unlimited()).unwrap().into_value()
}

fn bounds(document: &serde_json::Value) -> [Rational; 2] {
    [0, 1].map(|i| number(document[i].as_str().unwrap()))
}

/// The largest decay rate is the distance of the rightmost root from the axis, and the frequency at that limit its imaginary part.
#[test]
fn the_largest_decay_rate_is_that_of_the_rightmost_root() {
    for name in tried(["dead-time-pi", "smith-predictor", "delayed-oscillator", "dead-time-pid"], 3) {
        let path = format!("examples/{name}.toml");
        let limits = json(&["intervals", &path, "--param", "decay", "--json"]);
        let end = &limits["stable"].as_array().unwrap().last().unwrap()["upper"];
        let [low, high] = bounds(&end["enclosure"]);
        let roots = rightmost(example(name).ask(), 2);
        let root = roots.list[0].real().neg();
        assert!(root.lower() <= &high && &low <= root.upper(), "{name}: {end}");
        assert_eq!(end["cause"].as_str().unwrap().contains("pair"), roots.list[0].disc.is_pair, "{name}: {end}");
    }
}

/// Where a window of the dead time ends a pair is on the axis, at the frequency that the end says.
#[test]
fn a_pair_is_on_the_axis_at_the_limit_of_the_dead_time() {
    for (name, parameter) in [("dead-time-pi", "theta"), ("dead-time-pid", "theta"), ("delayed-oscillator", "tau")] {
        let limits = json(&["intervals", &format!("examples/{name}.toml"), "--param", parameter, "--json"]);
        for window in limits["stable"].as_array().unwrap().iter().take(2) {
            let [low, high] = bounds(&window["upper"]["enclosure"]);
            let beside = number("1e-9");
            let [before, after] = [low - &beside, high + &beside].map(|at| {
                let roots = rightmost(example(name).ask().set(parameter, at), 1);
                roots.list.into_iter().next().unwrap()
            });
            assert!(before.real().upper().is_negative() && after.real().lower().sign().is_gt(), "{name}: {window}");
            let frequency = number(&window["upper"]["radians_per_second"].to_string());
            for root in [before, after] {
                assert!((root.imaginary().upper() - &frequency).abs() < number("1e-6"), "{name}: {window}");
            }
        }
    }
}

#[test]
fn a_loop_whose_dead_time_is_zero_or_cancels_has_finitely_many_roots() {
    let shown = |text: &str, tau: i64| {
        let roots = rightmost(continuous(text, "nominal = 1").ask().set("k", tau), 3);
        assert!(roots.beyond.is_none(), "{text}");
        roots.list.iter().map(|root| root.text(6)).collect::<Vec<_>>()
    };
    assert_eq!(shown("s + 2*exp(-k*s)", 0), ["-2"]);
    assert_eq!(shown("(s + 2)*(s - 1)^2*exp(-k*s)", 1), ["1 (2 times)", "-2"]);
    assert_eq!(shown("s + 2 + exp(-k*s) - exp(-k*s)", 1), ["-2"]);
}

#[test]
fn discs_and_what_follows_of_them_have_the_digits_that_are_asked_for() {
    // s + exp(-s)
    let roots = rightmost(continuous("s + k*exp(-s)", "nominal = 1").ask(), 2);
    let root: &ClosedLoopRoot = &roots.list[0];
    assert_eq!(root.text(12), "-0.318131505205 +- 1.33723570143 j");
    assert_eq!(root.natural_frequency(200).unwrap().decimal(12).unwrap(), "1.37455701074");
    assert_eq!(root.damping(200).unwrap().decimal(12).unwrap(), "0.231442932318");
}

#[test]
fn the_command_says_how_far_the_roots_are_listed() {
    let run = jurist(&["roots", "examples/dead-time-pi.toml", "--rightmost", "3"]);
    assert!(run.stdout.contains("infinitely many roots, the 3 rightmost; a pair counts as one\n"), "{}", run.stdout);
    assert!(run.stdout.ends_with("no other root lies right of Re s = -0.99\n"), "{}", run.stdout);
    let document = json(&["roots", "examples/dead-time-pi.toml", "--json"]);
    let keys = [&document["rightmost"], &document["others_left_of"], &document["chain"]];
    assert_eq!(keys, [&serde_json::json!(10), &"-3/2".into(), &serde_json::Value::Null]);
    assert_eq!(document["roots"].as_array().unwrap().len(), 10);
    let neutral = jurist(&["roots", "examples/neutral-loop.toml"]).stdout;
    assert!(neutral.contains("come as near as one likes to the line Re s = -0.6931472"), "{neutral}");
    let document = json(&["roots", "examples/neutral-loop.toml", "--json"]);
    let [low, high] = bounds(&document["chain"]);
    assert!(low < high && high < number(document["others_left_of"].as_str().unwrap()));
    // A loop without dead time has all its roots listed, and no such keys.
    let document = json(&["roots", "examples/dc-servo.toml", "--rightmost", "1", "--json"]);
    assert!(document.get("rightmost").is_none() && document["roots"].as_array().unwrap().len() > 1);
}

#[test]
fn what_is_not_listed_is_refused_or_undecided_in_words() {
    let model = |text: &str| format!("time = 'continuous'\n[parameters]\nk = 1\n[loop]\ncharacteristic = '{text}'\n");
    let run = jurist_with_input(&["roots", "-"], model("s^2*exp(-s) + s + k").as_bytes());
    assert_eq!(run.status, 2, "{}", run.stdout);
    let words = "infinitely many roots lie right of any line";
    assert!(run.stderr.contains("error[E-dead-time]") && run.stderr.contains(words), "{}", run.stderr);
    let run = jurist_with_input(&["roots", "-"], model("s + sqrt(2)*s*exp(-s)/3 + k").as_bytes());
    assert!(run.status == 3 && run.stderr.contains("neutral type"), "{} {}", run.stdout, run.stderr);
    let run = jurist_with_input(&["roots", "-", "--timeout", "0", "--json"], model("s + k*exp(-s)").as_bytes());
    assert_eq!(run.status, 3, "{}", run.stderr);
}
