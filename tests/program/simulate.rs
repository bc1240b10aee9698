//! `jurist simulate` and `jurist locus` as programs and people see them.

use crate::helpers::program::{json, jurist, jurist_with_input, refused};
use serde_json::Value;

fn signal<'a>(document: &'a Value, name: &str) -> &'a Value {
    document["signals"].as_array().unwrap().iter().find(|s| s["name"] == name).unwrap()
}

fn last(signal: &Value) -> f64 {
    signal["values"].as_array().unwrap().last().unwrap().as_f64().unwrap()
}

#[test]
#[ignore = "long: CI runs it"]
fn the_sampled_drive_reaches_80_rad_per_s() {
    let document = json(&["simulate", "--json", "--duration", "6"]);
    assert_eq!(document["schema"], "jurist/simulate/1");
    assert_eq!(document["floating_point"], true);
    assert_eq!(document["kind"], "sampled");
    assert_eq!((&document["sample_time"], &document["time_unit"]), (&1e-4.into(), &"s".into()));
    assert_eq!(document["set"]["K_pwm"], "110");
    let omega = signal(&document, "omega");
    assert_eq!(omega["unit"], "rad/s");
    assert_eq!(signal(&document, "i_a")["unit"], "A");
    assert_eq!(signal(&document, "eps_1i")["unit"], Value::Null);
    assert_eq!(document["time"].as_array().unwrap().len(), omega["values"].as_array().unwrap().len());
    assert!((last(omega) - 80.0).abs() < 0.01, "{}", last(omega));
}

#[test]
fn the_circuit_says_its_steady_state() {
    let document = json(&["simulate", "--switched", "--steady", "--json", "--duration", "0.001"]);
    assert_eq!(document["kind"], "switched");
    assert_eq!(document["clamped_periods"], 0);
    let steady = &document["steady_state"];
    assert!((steady["state"]["omega"].as_f64().unwrap() - 80.0).abs() < 1e-6);
    assert!((steady["duty"][0].as_f64().unwrap() - 45.16 / 110.0).abs() < 1e-3);
    assert!(steady["multipliers"][0][0].as_f64().unwrap() < 1.0);
    let units = ["V_a", "V_a.control", "V_a.duty"].map(|n| signal(&document, n)["unit"].clone());
    assert_eq!(units, ["V".into(), "V".into(), Value::Null]);
    let steady = json(&["simulate", "--switched", "--json", "--duration", "0.001", "--set", "K_pwm=40"]);
    assert_eq!(steady["steady_state"], Value::Null);
}

#[test]
fn a_loop_without_a_sample_time_counts_samples() {
    let model = b"time = 'discrete'\nparameters.k = { nominal = 0.5 }\n[loop]\nmatrix = [['k']]\nstates = ['x']\n\
        inputs = ['r']\nE = [[1]]\n[simulation]\ninputs = { r = 1 }\nduration = 3\n";
    let run = jurist_with_input(&["simulate", "-", "--json"], model);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((&document["sample_time"], &document["time_unit"]), (&Value::Null, &"samples".into()));
    assert_eq!(signal(&document, "x")["values"], serde_json::json!([0.0, 1.0, 1.5, 1.75]));
    assert_eq!(signal(&document, "x")["unit"], Value::Null);
}

#[test]
fn files_say_the_same_as_standard_output() {
    let folder = std::env::temp_dir().join(format!("jurist-simulate-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let arguments = ["simulate", "--duration", "0.01"];
    let with = |more: &[&str]| jurist(&[&arguments[..], more].concat());
    assert_eq!(with(&["-o", &file("run.svg"), "--csv"]).status, 0);
    assert_eq!(with(&["-o", &file("run.json")]).status, 0);
    let svg = std::fs::read_to_string(file("run.svg")).unwrap();
    assert!(svg.contains("omega (rad/s)") && svg.contains("time (ms)"), "{}", &svg[..400]);
    assert_eq!(std::fs::read_to_string(file("run.csv")).unwrap(), with(&[]).stdout);
    assert_eq!(std::fs::read_to_string(file("run.json")).unwrap(), with(&["--json"]).stdout);
    assert_eq!(with(&["-o", &file("run.pdf")]).status, 0);
    assert!(std::fs::read(file("run.pdf")).unwrap().starts_with(b"%PDF-"));
    refused(&["simulate", "-o", &file("run.gif")], "E-output-format");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn no_time_is_no_simulation() {
    let run = jurist(&["simulate", "--duration", "1000", "--timeout", "0"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
}

#[test]
fn the_locus_as_json_has_the_crossings_and_the_branches() {
    let document = json(&["locus", "--param", "K_pwm", "--range", "0.001..1000", "--json"]);
    assert_eq!(document["schema"], "jurist/locus/1");
    assert_eq!(document["floating_point"], true);
    let labels: Vec<&str> =
        document["crossings"].as_array().unwrap().iter().map(|c| c["label"].as_str().unwrap()).collect();
    assert_eq!(labels, ["K_pwm = 38.101 mV, 0.506 Hz", "K_pwm = 550.94 V, 1664 Hz"]);
    let branches = document["branches"].as_array().unwrap();
    assert_eq!(branches.len(), 6);
    for branch in branches {
        assert_eq!(branch["values"].as_array().unwrap().len(), branch["roots"].as_array().unwrap().len());
    }
}

#[test]
fn without_inputs_the_first_one_steps() {
    let model = "time = 'discrete'\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'plant'\n\
        input = 'r - y'\noutput = 'y'\ntransfer = '0.5/z'\n";
    let run = jurist_with_input(&["simulate", "-", "--json"], model.as_bytes());
    assert!(run.stderr.contains("a unit step of 'r'"), "{}", run.stderr);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(document["time"].as_array().unwrap().len(), 51);
    assert!((last(signal(&document, "y")) - 1.0 / 3.0).abs() < 1e-9);
    let quiet = jurist_with_input(&["simulate", "-", "-q", "--duration", "2"], model.as_bytes());
    assert_eq!((quiet.stderr.as_str(), quiet.stdout.lines().count()), ("", 4));
    let given = jurist_with_input(&["simulate", "-", "--input", "r=2", "--json"], model.as_bytes());
    let document: Value = serde_json::from_str(&given.stdout).unwrap();
    assert!(given.stderr.is_empty() && (last(signal(&document, "y")) - 2.0 / 3.0).abs() < 1e-9);
    let closed = "time = 'discrete'\nloop.matrix = [['0.5']]\n";
    let run = jurist_with_input(&["simulate", "-"], closed.as_bytes());
    assert!(run.stderr.contains("--initial NAME=VALUE"), "{}", run.stderr);
}

/// A loop of gains alone has no states, and a final value all the same.
#[test]
fn a_loop_without_states_is_simulated() {
    let model = "time = 'discrete'\n[parameters]\nK = 0.5\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\n\
                 output = 'u'\ngain = 'K'\n[[block]]\ninput = 'u'\noutput = 'y'\ngain = 1\n";
    let run = jurist_with_input(&["simulate", "-", "--json"], model.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let document: Value = serde_json::from_str(&run.stdout).unwrap();
    assert!((last(signal(&document, "y")) - 1.0 / 3.0).abs() < 1e-12);
}
