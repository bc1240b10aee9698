//! Peak-to-peak gains of loops: known values, loops behind holds against a simulation in floating point, and what is refused.

use crate::helpers::model::read;
use crate::helpers::number::number;
use crate::helpers::program::{jurist, jurist_with_input};
use jurist::{Ask, Document, Text};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::problem::Region;
use jurist_engine::response::PeakToPeak;
use jurist_engine::stability::AbsoluteSum;

/// A loop whose input is added to what a block makes of its own output.
fn unity(transfer: &str, further: &str) -> Model {
    read(&format!(
        "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'P'\ninput = 'r - y'\noutput = 'y'\n\
         transfer = '{transfer}'\n{further}"
    ))
}

fn found(model: &Model, input: &str, output: &str) -> PeakToPeak {
    model.ask().peak_to_peak(input, output, 15, &Budget::unlimited()).unwrap().into_value()
}

fn gain(model: &Model, input: &str, output: &str) -> AbsoluteSum {
    found(model, input, output).gain.expect("stable")
}

/// A PI controller with integers over 2^13 to whose sum a rounding `e` is added at each step, and a plant of one pole.
const ROUNDED: &str = "time = 'discrete'\n[loop]\ninputs = ['r', 'e']\noutputs = ['y', 'u']\n[[block]]\nname = 'differences'\n\
    input = 'r - y'\noutput = 'f'\ntransfer = '(4096*z - 4095)/(8192*z)'\n[[block]]\nname = 'sum'\ninput = 'f + e'\n\
    output = 'u'\ntransfer = 'z/(z - 1)'\n[[block]]\nname = 'P'\ninput = 'u'\noutput = 'y'\ntransfer = '0.1/(z - 0.9)'\n";

/// From the rounding to the controller's output goes `z (z - 0.9)/D` with `D(1) = 0.1/8192`; by hand its gain at frequency 0 is 8192.
#[test]
fn a_rounding_in_a_slow_integrator_counts_8192_times() {
    let model = read(ROUNDED);
    assert_eq!(gain(&model, "e", "u").exact, Some(8192.into()));
    let peak = model.ask().norm("e", "u", &Budget::unlimited()).unwrap().into_value().peak.unwrap();
    assert_eq!(peak.value.exact(), Some(8192.into()));
    // With one step less the integral action is lost.
    let lost = found(&read(&ROUNDED.replace("4095", "4096")), "e", "u");
    assert_eq!((lost.verdict.verdict.name(), lost.gain), ("marginal", None));
}

#[test]
fn known_gains_are_found() {
    let exact = |transfer: &str| gain(&unity(transfer, ""), "r", "y").exact.map(|x| x.to_string());
    // L/(1 + L) = 1/(z - 1/2), z/(z^2 - z + 1/2), 1/(z^2 - 1.5 z + 0.7).
    assert_eq!(exact("1/(z - 3/2)").as_deref(), Some("2"));
    let eight = gain(&unity("z/(z^2 - 2*z + 1/2)", ""), "r", "y");
    let third = Rational::new(10.into(), 3.into());
    assert!(eight.lower < third && third < eight.upper && &eight.upper - &eight.lower < number("1e-15"));
    let model = unity("1/(z^2 - 1.5*z - 0.3)", "");
    let answer = model.ask().peak_to_peak("r", "y", 24, &Budget::unlimited()).unwrap();
    assert!(answer.text(24).contains("from r to y: 9.27327473281694209071200\n"), "{}", answer.text(24));
    let document = serde_json::to_value(answer.json(24)).unwrap();
    assert_eq!(document["l1"]["decimal"], "9.27327473281694209071200");
    assert!(document["norm"].is_null() && document["l1"]["exact"].is_null());
    // Nothing but what is direct, a delay, and nothing at all.
    assert_eq!(exact("-1/3").as_deref(), Some("1/2"));
    assert_eq!(exact("1/(z - 1)").as_deref(), Some("1"));
    let idle = ROUNDED.replace("'f + e'", "'f + 0*e'");
    assert_eq!(gain(&read(&idle), "e", "y").exact, Some(Rational::ZERO));
}

/// The bound is that of the loop's own poles, whatever smaller region was asked for.
#[test]
fn a_region_does_not_change_the_gain() {
    let within = Region::disc("1/4".parse().unwrap()).unwrap();
    let problem = unity("1/(z - 3/2)", "").ask().within(within).problem().unwrap();
    let answer = problem.peak_to_peak("r", "y", 9, &Budget::unlimited()).unwrap();
    assert_eq!(answer.value().gain.as_ref().unwrap().exact, Some(2.into()));
}

#[test]
fn a_loop_that_is_not_stable_has_no_gain() {
    let unstable = found(&unity("1/(z - 3)", ""), "r", "y");
    assert!(unstable.gain.is_none() && unstable.signs(9, &Budget::unlimited()).unwrap().is_empty());
    let text = "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'P'\ninput = 'r'\noutput = 'y'\n\
        transfer = '1/(z - 1/2)'\n[[block]]\nname = 'hidden'\ninput = 'y'\noutput = 'x'\ntransfer = '1/(z - 2)'\n";
    let run = jurist_with_input(&["norm", "-", "r", "y", "--l1"], text.as_bytes());
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(run.stdout.contains("unstable") && run.stdout.contains("no peak-to-peak gain"), "{}", run.stdout);
}

/// `k/(s (s + 1))` behind a zero-order hold and dead time of whole samples, with unity feedback: the output by its difference
/// equation in floating point.
fn simulated(k: f64, t: f64, delay: usize, input: &[f64]) -> Vec<f64> {
    let e = f64::exp(-t);
    let (b, c) = (k * (t - 1.0 + e), k * (1.0 - e - t * e));
    let (mut y, mut error) = (vec![0.0; 2], vec![0.0; 2 + delay]);
    for r in input {
        let n = y.len();
        y.push((1.0 + e) * y[n - 1] - e * y[n - 2] + b * error[n - 1] + c * error[n - 2]);
        error.push(r - y[n]);
    }
    y.split_off(2)
}

/// The sum of the simulated response is the gain; and the input of the signs drives the simulated output there.
#[test]
fn loops_behind_a_hold_have_the_gain_of_a_simulation() {
    const COUNT: usize = 4000;
    for (k, t, delay) in [(0.5, 0.25, 0usize), (1.0, 0.5, 1), (0.25, 1.0, 2), (2.0, 0.125, 3)] {
        let further = format!("discretize = {{ method = 'zoh', T = '{t}', delay = '{}' }}\n", t * delay as f64);
        let answer = found(&unity(&format!("{k}/(s*(s + 1))"), &further), "r", "y");
        let bounds = answer.gain.as_ref().unwrap();
        let mut impulse = vec![0.0; COUNT];
        impulse[0] = 1.0;
        let sum: f64 = simulated(k, t, delay, &impulse).iter().map(|h| h.abs()).sum();
        let signs = answer.signs(COUNT, &Budget::unlimited()).unwrap();
        let worst: Vec<f64> = signs.iter().rev().map(|&sign| f64::from(sign)).collect();
        let reached = *simulated(k, t, delay, &worst).last().unwrap();
        let [lower, upper] = [&bounds.lower, &bounds.upper].map(Rational::to_f64_approximate);
        for value in [sum, reached, upper] {
            assert!((lower - value).abs() < 1e-9 * lower, "{k} {t} {delay}: {lower} {value}");
        }
    }
}

/// `k/(s (s + 1))` with unity feedback has a pair of poles: the gain is `coth(pi zeta/(2 sqrt(1 - zeta^2)))`.
#[test]
fn a_continuous_pair_has_the_gain_of_its_overshoots() {
    for k in [1, 4, 30] {
        let run = jurist(&["norm", &format!("{k}/(s*(s + 1))"), "r", "y", "--l1"]);
        let damping = 0.5 / f64::from(k).sqrt();
        let known = 1.0 / f64::tanh(std::f64::consts::PI * damping / (2.0 * (1.0 - damping * damping).sqrt()));
        let value = run.stdout.split("from r to y: ").nth(1).unwrap().lines().next().unwrap().parse::<f64>().unwrap();
        assert!(run.status == 0 && (value - known).abs() < 1e-10 * known, "{known}: {}", run.stdout);
    }
}

/// The constant `sqrt(2)` is enclosed: `sqrt(2)/(s + 1)` in the loop has the gain `sqrt(2)/(1 + sqrt(2))`.
#[test]
fn a_continuous_loop_over_constants_has_its_gain() {
    let run = jurist(&["norm", "sqrt(2)/(s + 1)", "r", "y", "--l1", "--json"]);
    let document: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(document["l1"]["decimal"], "0.585786437627", "{}", run.stdout);
}

#[test]
fn what_has_no_peak_to_peak_gain_is_refused_in_words() {
    for (arguments, code, word) in [
        (&["norm", "exp(-s)/(s + 1)", "r", "y", "--l1"][..], "E-dead-time", "dead time"),
        (&["norm", "examples/drive-two-rates.toml", "omega_ref", "omega", "--l1"], "E-rate-margin", "several rates"),
        (&["norm", "1/(z - 1/2)", "r", "x", "--l1"], "E-unknown-signal", "'x'"),
    ] {
        let run = jurist(arguments);
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(&format!("error[{code}]")) && run.stderr.contains(word), "{}", run.stderr);
    }
}

/// The difference of two lags that are the same is 0 by an identity alone: that is left open, within a budget.
#[test]
fn a_transfer_function_that_is_zero_by_an_identity_is_left_open() {
    let text = "time = 'discrete'\nsample_time = '1/10'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'a'\n\
        input = 'r'\noutput = 'u'\ntransfer = '1/(s + 1)'\ndiscretize = 'zoh'\n[[block]]\nname = 'b'\ninput = 'r'\noutput = 'v'\n\
        transfer = '1/(s + 1)'\ndiscretize = 'zoh'\n[[block]]\nname = 'c'\ninput = 'u - v'\noutput = 'y'\ngain = 1\n";
    match read(text).ask().peak_to_peak("r", "y", 9, &Budget::unlimited()) {
        Err(Error::Stopped(stopped)) => assert!(stopped.stop.is_precision()),
        other => panic!("{other:?}"),
    }
}
