//! `jurist margins --param`: how much of each margin a loop has, by the value of one parameter.

use crate::helpers::program::{jurist, jurist_with_input};
use crate::helpers::thorough::count;
use jurist::{Ask, Budget, Model, Rational, Source};
use jurist_engine::response::{RequiredSet, Requirement};
use serde_json::Value;

/// The phase margin of `K/(s (s + 1))` is `p` at `K = cos p/sin^2 p`; the modulus margin of `K/s` is 1, and its gain margin has no bound.
#[test]
fn ends_of_margins_have_closed_forms() {
    let run = jurist(&["margins", "K/(s*(s+1))", "--param", "K", "--json", "-q"]);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(document["schema"], "jurist/margin-ranges/1");
    let end = |name: &str, required: &str| {
        let margins = document["margins"].as_array().unwrap();
        let found = margins.iter().find(|m| m["name"] == name && m["required"] == required).unwrap();
        assert_eq!(found["intervals"].as_array().unwrap().len(), 1, "{found}");
        found["intervals"][0]["upper"].clone()
    };
    assert_eq!(end("phase_margin", "60 deg")["exact"], "2/3");
    assert_eq!(end("phase_margin", "45 deg")["polynomial"], serde_json::json!(["-2", "0", "1"]));
    assert_eq!(end("phase_margin", "30 deg")["polynomial"], serde_json::json!(["-12", "0", "1"]));
    assert_eq!(end("gain_margin", "6 dB"), Value::Null);
    let run = jurist(&["margins", "K/s", "--param", "K", "-q"]);
    assert!(run.stdout.contains("modulus_margin >= 7/10 for\n    0 < K\n"), "{}", run.stdout);
}

/// On both sides of each end the margins at the point say the same.
#[test]
fn margins_at_points_beside_each_end_agree() {
    let text = "time = 'discrete'\nparameters.K = 1\nloop = { inputs = ['r'], outputs = ['y'] }\n\
        [[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ntransfer = 'K*(z - 1/2)/(z - 1)'\n\
        [[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = '(z + 1/3)/(z*(z - 3/4))'\n";
    let (model, _) = Model::from_toml(&Source::new("loop.toml", text)).unwrap();
    let budget = Budget::unlimited();
    let margins = Requirement::usual_margins(&model, &budget).unwrap();
    let ranges = model.ask().free("K").problem().unwrap().margin_ranges(&margins, None, &budget).unwrap();
    let mut ends = 0;
    for level in &ranges.value().levels {
        let set = level.found.as_ref().unwrap();
        assert!(set.undecided.is_empty());
        for end in set.intervals.iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
            let (low, high) = end.value().refined_to_digits(12).enclosure();
            let step = Rational::new(1.into(), 1_000_000_000.into());
            for point in [&low - &step, &high + &step] {
                let problem = model.ask().set("K", point.clone()).problem().unwrap();
                let stable = problem.verdict(&budget).unwrap().value().verdict == jurist::Verdict::Stable;
                let met = problem.requirements_met(std::slice::from_ref(&level.requirement), None, &budget).unwrap();
                let expected = set.intervals.iter().any(|interval| interval.contains(&point));
                assert_eq!(stable && met[0].met, expected, "{} at {point}", level.requirement.text());
            }
            ends += 1;
        }
    }
    assert!(ends >= 10, "{ends}");
}

/// A gain that multiplies the open loop is the same cut as the signal behind it: of rational loops, behind a hold, and with dead time; where it is free, and
/// where it has a value and another name is free.
#[test]
#[ignore = "long: CI runs it"]
fn a_parameter_as_the_cut_is_the_gain_of_the_loop() {
    let plants = [
        ("continuous", "(s + 2)/((s + 1)*(s^2 + a*s + 4))", ""),
        ("discrete", "3/(s^2 + a*s + 2)", "discretize = { method = 'zoh', T = 0.2 }\n"),
        ("continuous", "exp(-0.2*s)/(s + a)", ""),
    ];
    let budget = Budget::unlimited();
    let mut compared = 0;
    for (time, transfer, held) in plants {
        let text = format!(
            "time = '{time}'\nparameters = {{ K = {{ nominal = '3/4', min = 0, max = 20 }}, a = {{ nominal = 1, min = '1/4', max = 6 }} }}\n\
             loop = {{ inputs = ['r'], outputs = ['y'] }}\n[[block]]\nname = 'C'\ninput = 'r - y'\noutput = 'u'\ngain = 'K'\n\
             [[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = '{transfer}'\n{held}"
        );
        let (model, _) = Model::from_toml(&Source::new("loop.toml", &text)).unwrap();
        let margins = Requirement::usual_margins(&model, &budget).unwrap();
        for name in ["K", "a"] {
            // A name inside of functions beside a gain with a value is refused.
            if name == "a" && !held.is_empty() {
                let refused =
                    model.ask().free("a").problem().unwrap().margin_ranges(&margins[3..4], Some("K"), &budget);
                assert!(refused.unwrap_err().to_string().contains("E-cut"));
                continue;
            }
            let ranges = |at: &str| {
                let found = model.ask().free(name).problem().unwrap().margin_ranges(
                    &margins[2..count(3, margins.len())],
                    Some(at),
                    &budget,
                );
                found.unwrap().into_value().levels.into_iter().map(|level| level.found.unwrap()).collect::<Vec<_>>()
            };
            for (by_gain, by_signal) in ranges("K").iter().zip(&ranges("u")) {
                let ends = |set: &RequiredSet| -> Vec<String> {
                    let ends = set.intervals.iter().flat_map(|i| [&i.lower, &i.upper]);
                    ends.map(|end| end.as_ref().map_or(String::new(), |end| end.value().decimal(15))).collect()
                };
                assert_eq!(ends(by_gain), ends(by_signal), "{transfer} {name}");
                compared += ends(by_gain).len();
            }
        }
    }
    assert!(compared >= count(5, 40), "{compared}");
}

/// A model without signals is cut at the parameter that is asked about.
#[test]
fn the_drive_in_matrices_has_margins_by_its_gain() {
    let run = jurist(&["margins", "--param", "K_pwm", "-q"]);
    assert!(
        run.stdout.contains("gain_margin > 6 dB for\n    0.0760205583701 < K_pwm < 276.124679223\n"),
        "{}",
        run.stdout
    );
    let run = jurist(&["intervals", "--param", "T", "--at", "T", "--phase-margin", "45 deg"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("'T' is not a gain of the loop"), "{}", run.stderr);
}

#[test]
fn mistakes_are_shown() {
    let run = jurist(&["margins", "K/(s*(s+1))", "--param", "L"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("'L'"), "{}", run.stderr);
    let text = b"time = 'continuous'\nparameters.K = 1\nloop.characteristic = 's + K'\n";
    let run = jurist_with_input(&["margins", "-", "--param", "K", "--at", "v"], text);
    assert_eq!(run.status, 2, "{}", run.stdout);
}
