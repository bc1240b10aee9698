//! Certificates of stable dead times: accepted by both checkers, and by neither when anything is changed.

use crate::helpers::certificates::checkers::{accept, python, reject};
use crate::helpers::certificates::{emitted, mutations};
use crate::helpers::model::read;
use crate::helpers::number::number;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::stability::Range;
use std::time::Duration;

const LIMITS: Limits = Limits::within(Duration::MAX);

fn example(name: &str) -> String {
    let path = format!("{}/examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("an example")
}

fn written(function: &str) -> String {
    format!("time = 'continuous'\nparameters.tau = {{ nominal = 1, min = 0 }}\nloop.characteristic = '{function}'\n")
}

/// Stable up to a limit, in several windows, always, never, with roots on the axis without delay, of neutral type.
const FUNCTIONS: [&str; 12] = [
    "s + 1 + 2*exp(-tau*s)",
    "s + 2 + exp(-tau*s)",
    "s - 1 + 2*exp(-tau*s)",
    "s^2 + 1 - 0.2*exp(-tau*s)",
    "s^2 + s/5 + 1 + 0.7*exp(-2*tau*s)",
    "s^2 + 0.1*s + 4 - (s + 1)*exp(-tau*s/3)",
    "s^3 + 2*s^2 + 3*s + 1 + (s + 2)*exp(-tau*s)",
    "s*(s + 1) + s*exp(-tau*s)",
    "(s + 1)^2 + s^2/2*exp(-tau*s)",
    "s - 3 + exp(-tau*s)",
    "s^2 - 1 + (2 + s)*exp(-tau*s)",
    "s + exp(-tau*s)",
];

#[test]
fn stable_dead_times_are_certified() {
    for function in FUNCTIONS {
        let model = written(function);
        let certificate = emitted(&model, "tau");
        assert!(certificate.contains("jurist/certificate/3"), "{function}");
        accept(&model, &certificate);
        for (lower, upper) in [("0", "1"), ("1/3", "20"), ("3", "7")] {
            let domain = Range::between(Some(number(lower)), Some(number(upper)));
            let answer = read(&model).ask().free("tau").domain("tau", domain).stable_set(&Budget::unlimited());
            let certificate = answer.and_then(|answer| answer.certificate(&Budget::unlimited())).expect(function);
            accept(&model, &certificate);
        }
    }
}

#[test]
fn the_examples_with_dead_time_are_certified() {
    for (name, parameter) in
        [("dead-time-pi", "theta"), ("dead-time-pid", "theta"), ("delayed-oscillator", "tau"), ("neutral-loop", "tau")]
    {
        let model = example(name);
        accept(&model, &emitted(&model, parameter));
    }
}

/// What has no certificate is not given one that would be rejected.
#[test]
fn what_no_checker_knows_gets_no_certificate() {
    let gain = read(&example("dead-time-pi"));
    let answer = gain.ask().free("T_i").stable_set(&Budget::unlimited()).expect("an answer");
    let certified = answer.certificate(&Budget::unlimited());
    assert!(certified.is_ok_and(|text| text.contains("jurist/certificate/6")));
    // A pair on the axis: marginal.
    let oscillator = read("time = 'continuous'\nloop.characteristic = 's^2 + 1 + (s^2 + 1)*exp(-s)/2'\n");
    let verdict = oscillator.ask().verdict(&Budget::unlimited()).expect("a verdict");
    assert!(verdict.certificate(&Budget::unlimited()).is_err());
    for function in ["s + 1 + exp(-tau*s) + exp(-2*tau*s)", "s + 1 + exp(-(tau + 1)*s)"] {
        let model = read(&written(function));
        let answer = model.ask().free("tau").stable_set(&Budget::unlimited()).expect(function);
        assert!(answer.certificate(&Budget::unlimited()).is_err(), "{function}");
    }
}

/// A mutant that passes proves the same, or gives the same ends in wider enclosures; and it passes both checkers.
#[test]
fn no_mutation_of_a_dead_time_certificate_changes_what_is_proved() {
    for function in [FUNCTIONS[0], FUNCTIONS[3], FUNCTIONS[8]] {
        let model = written(function);
        let original = Json::parse(&emitted(&model, "tau")).expect("JSON");
        let proved = check(&model, &original.to_text(), &LIMITS).expect(function).statement;
        let (mut tried, mut accepted) = (0, 0);
        for mutant in mutations(&original).one_in(count(4, 1)) {
            tried += 1;
            let text = mutant.to_text();
            let found = check(&model, &text, &LIMITS);
            if let Some(other) = python(&model, &text) {
                assert_eq!(found.is_ok(), other.is_ok(), "{found:?} {other:?}\n{text}");
            }
            if let Ok(found) = found {
                accepted += 1;
                assert_eq!(found.statement, proved, "{text}");
            }
        }
        assert!(tried > count(25, 100) && accepted * 4 < tried, "{accepted} of {tried}");
    }
}

#[test]
fn certificates_of_other_loops_with_dead_time_are_rejected() {
    let model = written(FUNCTIONS[4]);
    let certificate = emitted(&model, "tau");
    for (from, to) in [
        ("0.7", "0.71"),
        ("s/5", "s/4"),
        ("-2*tau*s", "-tau*s"),
        ("-2*tau*s", "-2*tau*s*s"),
        ("-2*tau*s", "2*tau*s"),
        ("exp(-2*tau*s)", "exp(-2*tau)"),
        ("s^2", "(1 + tau)*s^2"),
        ("continuous", "discrete"),
    ] {
        assert!(model.contains(from), "{from}");
        let other = model.replacen(from, to, 1);
        assert!(check(&other, &certificate, &LIMITS).is_err(), "{to}");
        assert!(python(&other, &certificate).is_none_or(|found| found.is_err()), "{to}");
    }
}

/// By hand: `s^2 + 1 - z/5` crosses at `omega^2 = 4/5` (to the left, `z = 1`) and `6/5` (to the right, `z = -1`).
#[test]
fn the_windows_of_an_oscillator_by_hand() {
    let model = written(FUNCTIONS[3]);
    let certificate = |stable: &str, crossings: &str| {
        format!(
            r#"{{"schema": "jurist/certificate/3", "statement": {{"kind": "intervals", "time": "continuous",
  "parameter": "tau", "set": {{}}, "region": {{"decay": "0"}}, "domain": {{"lower": "0", "upper": "12"}}, "stable": [{stable}]}},
  "bits": 96, "delay": "1", "parts": [["5", "0", "5"], ["-1"]], "crossings": [{crossings}]}}"#
        )
    };
    let first = r#"{"lower": "0", "upper": {"crossing": 1, "turns": 0, "between": ["286/100", "287/100"]}}"#;
    let second = r#"{"lower": {"crossing": 0, "turns": 1, "between": ["7", "8"]}, "upper": {"crossing": 1, "turns": 1, "between": ["8", "9"]}}"#;
    let both = r#"["799999/1000000", "800001/1000000"], ["1199999/1000000", "1200001/1000000"]"#;
    accept(&model, &certificate(&format!("{first}, {second}"), both));
    for (stable, crossings, step) in [
        (first.to_owned(), both, Step::Stable),
        (second.to_owned(), both, Step::Stable),
        (format!("{first}, {second}").replace("\"turns\": 1", "\"turns\": 0"), both, Step::Stable),
        (format!("{first}, {second}").replace("287/100", "2865/1000"), both, Step::Stable),
        (format!("{first}, {second}"), r#"["799999/1000000", "800001/1000000"]"#, Step::Boundary),
        (format!("{first}, {second}"), r#"["1199999/1000000", "1200001/1000000"]"#, Step::Boundary),
        (format!("{first}, {second}"), r#"["7/10", "8/10"], ["1", "2"]"#, Step::Boundary),
        (format!("{first}, {second}"), r#"["7/10", "13/10"], ["14/10", "2"]"#, Step::Boundary),
        (first.to_owned(), r#"["1/2", "1"], ["1", "2"]"#, Step::Boundary),
    ] {
        reject(&model, &certificate(&stable, crossings), step);
    }
}
