//! Margins of loops with plants behind a hold, to thirty digits of mpmath at eighty, by another formulation: partial fractions
//! for the plant, zeros of functions of the angle, dead time as a second unknown.

use crate::helpers::model::{example, load};
use crate::helpers::number::number;
use crate::helpers::open_loops::{SERVO_BEHIND_A_HOLD, margins_of, stable};
use crate::helpers::program::jurist_with_input;
use crate::helpers::thorough::tried;
use jurist::{Ask, Document, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::response::{DelayMargin, PhaseMargin};
use jurist_show::real;
use serde_json::Value;

#[test]
fn the_servo_behind_a_hold_has_these_margins_to_thirty_digits() {
    let answer = margins_of(&load(SERVO_BEHIND_A_HOLD), None);
    let margins = stable(&answer);
    let upper = margins.gain.upper.as_ref().unwrap();
    assert_eq!(upper.value.decimal(30), "11.6813631716081419454664993290");
    assert!(upper.value.algebraic().is_none() && upper.causes.to_string() == "complex pair");
    assert_eq!(margins.gain.lower.as_ref().unwrap().value.exact(), Some(Rational::ZERO));
    let degrees = real::enclosed(30, |bits| margins.phase.degrees(bits)).unwrap();
    assert_eq!(degrees, "57.0653311557805752815703930298");
    let PhaseMargin::Angle { place: Some(place), .. } = &margins.phase else { panic!("a crossing") };
    let angle = real::enclosed(30, |bits| answer.value().frequency(place, bits)?.angle).unwrap();
    assert_eq!(angle, "0.0894978514984041673052830916609");
    assert_eq!(margins.modulus.decimal(30), "0.824835438341139985494855810137");
    assert_eq!(margins.disk.alpha.as_ref().unwrap().decimal(28), "1.086049308070804174017218031");
    let product = margins.modulus.refined_to_digits(40).enclosure().0
        * margins.peak_sensitivity.refined_to_digits(40).enclosure().0;
    assert!((product - Rational::ONE).abs() < number("1e-38"));
    // Both delays, each under its own name: the dead time at the hold's input, and the phase margin over the frequency.
    assert!(matches!(margins.delay, DelayMargin::Samples(11)));
    let held = answer.value().held_delay.as_ref().unwrap();
    assert_eq!(held.block, "motor");
    assert_eq!(real::enclosed(30, |bits| held.seconds(bits)).unwrap(), "0.0222569480871918508499350414687");
    let angle = real::enclosed(30, |bits| held.frequency(bits)?.angle).unwrap();
    assert_eq!(angle, "0.0894977118834207719569449133608");
    let text = answer.text(12);
    assert!(text.contains("less than 0.0222569480872 s of dead time at the input of 'motor'"), "{text}");
    assert!(text.contains("PM/omega 11.12851 samples = 0.02225702 s"), "{text}");
    let document = serde_json::to_value(answer.json(18)).unwrap();
    assert_eq!(document["delay"]["seconds"], "0.0222569480871918508");
    assert_eq!(document["delay"]["behind_hold"], "motor");
    assert_eq!(document["crossings"]["gain"][0]["delay_seconds"], "0.0222570240678242755");
    assert_eq!(document["phase"]["tangent"]["kind"], "transcendental");
    // With that dead time less a little the loop is stable, with a little more it is not.
    for (delay, verdict) in [("0.0222569480", "stable"), ("0.0222569481", "unstable")] {
        let more = SERVO_BEHIND_A_HOLD
            .replace("discretize = 'zoh'", &format!("discretize = {{ method = 'zoh', delay = '{delay}' }}"));
        let found = load(&more).ask().verdict(&Budget::unlimited()).unwrap();
        assert_eq!(found.value().verdict.name(), verdict, "{delay}");
    }
}

/// A factor of the transfer function, wherever it stands, is the same as the hold's own dead time.
#[test]
#[ignore = "long: CI runs it"]
fn dead_time_of_a_plant_may_be_a_factor_of_its_transfer_function() {
    let of = |transfer: &str, discretize: &str| {
        let text = SERVO_BEHIND_A_HOLD
            .replace("'20/(s*(T_m*s + 1))'", &format!("'{transfer}'"))
            .replace("discretize = 'zoh'", &format!("discretize = {discretize}"));
        let model = load(&text);
        let stable_set = model.ask().free("K").stable_set(&Budget::unlimited()).unwrap();
        (stable_set.text(30), margins_of(&model, None).text(30))
    };
    let plain = of("20/(s*(T_m*s + 1))", "{ method = 'zoh', delay = '3*T_m/10 + 0.001' }");
    assert!(plain.1.contains("stable"), "{}", plain.1);
    let transfers =
        ["-2*(10*exp(-s/1000)/s)/(T_m*s + 1)*-exp(-T_m*(3*s)/10)", "exp(-(3*T_m/10 + 0.001)*s)*20/(s*(T_m*s + 1))"];
    for transfer in tried(transfers, 2) {
        assert_eq!(of(transfer, "'zoh'"), plain, "{transfer}");
    }
    assert_eq!(of("exp(-s/1000)*20/(s*(T_m*s + 1))", "{ method = 'zoh', delay = '3*T_m/10' }"), plain);
}

/// Only the fraction up to 18.46 samples had been looked at, and was called the margin.
#[test]
#[ignore = "long: CI runs it"]
fn dead_time_behind_a_hold_is_not_less_than_the_whole_samples_that_are_borne() {
    let model = load(include_str!("../../src/cli/templates/held-plant.toml"));
    let answer = margins_of(&model, None);
    assert!(matches!(stable(&answer).delay, DelayMargin::Samples(37)));
    assert!(answer.value().held_delay.as_ref().is_some_and(|held| held.samples.is_none()));
    let text = answer.text(12);
    let words =
        "37 samples (0.074 s); with one more the loop is not stable; any dead time up to 12 samples at the input of";
    assert!(text.contains(words) && !text.contains("less than"), "{text}");
}

#[test]
fn the_peak_gain_of_the_held_servo() {
    let answer = load(SERVO_BEHIND_A_HOLD).ask().norm("r", "y", &Budget::unlimited()).unwrap();
    let peak = answer.value().peak.as_ref().unwrap();
    assert_eq!(peak.value.decimal(30), "1.16393389170524927311057031234");
    let angle = real::enclosed(20, |bits| answer.value().frequency(bits)?.angle).unwrap();
    assert_eq!(angle, "0.061497963235524362911");
}

/// `[require]` in the model, options beside it, and the exit status for CI.
#[test]
fn a_model_with_requirements_is_checked_at_its_nominal_point() {
    let with = |section: &str| format!("{SERVO_BEHIND_A_HOLD}[require]\n{section}\n");
    let met = with("phase_margin = '45 deg'\ngain_margin = '6 dB'\nmodulus_margin = '1/2'");
    let run = jurist_with_input(&["verdict", "-", "--json"], met.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    let list = document["requirements"].as_array().unwrap();
    let names: Vec<&str> = list.iter().map(|r| r["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["gain_margin", "phase_margin", "modulus_margin"]);
    assert!(list.iter().all(|r| r["met"] == true), "{list:?}");
    let run = jurist_with_input(&["verdict", "-", "--phase-margin", "60 deg"], met.as_bytes());
    assert_eq!(run.status, 1, "{}", run.stdout);
    assert!(run.stdout.contains("phase_margin >= 60 deg: not met (57.0653311558)"), "{}", run.stdout);
    // What is met is certified; what is not written as a theorem is refused, and what is not looked at is said.
    let run = jurist_with_input(&["verdict", "-", "--certificate", "-", "-o", "/dev/null"], met.as_bytes());
    assert!(run.status == 0 && run.stdout.contains("\"modulus_margin\""), "{}{}", run.stdout, run.stderr);
    let run = jurist_with_input(&["verdict", "-", "--coq", "/dev/null"], met.as_bytes());
    assert!(run.status == 2 && run.stderr.contains("E-require"), "{}", run.stderr);
    let run = jurist_with_input(&["analyze", "-"], met.as_bytes());
    assert!(run.stderr.contains("W-require"), "{}", run.stderr);
    let run = jurist_with_input(&["verdict", "-"], with("phase_margin = '45 rad'").as_bytes());
    assert!(
        run.status == 2 && run.stderr.contains("E-require") && run.stderr.contains("phase_margin = '45 rad'"),
        "{}",
        run.stderr
    );
    let run = jurist_with_input(&["verdict", "-"], with("phase = 45").as_bytes());
    assert!(run.status == 2 && run.stderr.contains("E-unknown-key"), "{}", run.stderr);
}

/// At the current error of the drive the factor is the chopper's gain.
#[test]
fn the_held_drive_is_cut_at_its_current_error() {
    let drive = example("drive-hold");
    let budget = Budget::unlimited();
    let answer = margins_of(&drive, Some("current controller"));
    let limit = drive.ask().free("K_pwm").stable_set(&budget).unwrap();
    let limit = limit.value().intervals()[0].upper.clone().unwrap().value.refined_to_digits(30).enclosure().0;
    let factor = stable(&answer).gain.upper.as_ref().unwrap().value.refined_to_digits(30).enclosure().0;
    assert!((limit / number("110") - factor).abs() < number("1e-28"));
}
