//! The program about loops with dead time; their limits are in the corpus and in the library's own tests.

use crate::helpers::program::{json, jurist, jurist_with_input};
use serde_json::Value;

#[test]
fn the_program_says_which_crossing_an_end_is() {
    let run = jurist(&["intervals", "examples/delayed-oscillator.toml", "--param", "tau", "--json"]);
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|e| panic!("{e}: {}", run.stderr));
    let end = &document["stable"][1]["lower"];
    assert_eq!((&end["kind"], &end["exact"]), (&Value::from("transcendental"), &Value::Null));
    assert_eq!((&end["over"]["k"], &end["over"]["direction"]), (&Value::from(1), &Value::from("-")));
    assert_eq!(end["over"]["omega2"]["enclosure"][0], "4/5");
    let verdict = jurist(&["verdict", "examples/delayed-oscillator.toml", "--set", "tau=3", "--json"]);
    let document: Value = serde_json::from_str(&verdict.stdout).unwrap();
    assert_eq!((&document["inside"], &document["outside"]), (&Value::Null, &Value::from(2)));
    assert!(jurist(&["analyze", "examples/dead-time-pi.toml"]).stdout.contains("7.0353318"));
    assert!(jurist(&["charpoly", "examples/dead-time-pi.toml"]).stdout.contains("exp(-theta*s)"));
}

#[test]
fn a_sum_of_fractions_gains_no_factor_in_the_delay() {
    // L = (s + 3 - 2 z s (s + 3)) / (((1 + 2 z) s + 1) (s + 3)) with z = exp(-s): the zeros of 1 + L are -2 and -3.
    // 1 + 2 z, the leading coefficient of the common factor, would have a chain of zeros in the right half plane.
    let first = "1/((1 + 2*exp(-s))*s + 1)";
    let second = "2*exp(-s)*s*(s + 3)/(((1 + 2*exp(-s))*s + 1)*(s + 3))";
    for transfer in [format!("{first} - {second}"), format!("-{second} + {first}")] {
        let model = format!(
            "time = 'continuous'\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
             [[block]]\nname = 'plant'\ninput = 'r - y'\noutput = 'y'\ntransfer = '{transfer}'\n"
        );
        let run = jurist_with_input(&["verdict", "-", "--json"], model.as_bytes());
        let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|e| panic!("{e}: {}", run.stderr));
        assert_eq!(document["verdict"], "stable", "{transfer}: {document}");
    }
}

#[test]
fn other_commands_say_that_they_do_not_know_dead_time_yet() {
    for arguments in [
        vec!["jury", "examples/dead-time-pi.toml", "--param", "K_c"],
        vec!["map", "examples/dead-time-pi.toml", "-x", "K_c", "-y", "theta", "--method", "exact"],
        vec!["locus", "examples/dead-time-pi.toml", "--param", "K_c"],
    ] {
        let run = jurist(&arguments);
        assert!(run.stderr.contains("E-dead-time"), "{arguments:?}: {}", run.stderr);
    }
}

#[test]
fn a_response_begins_after_the_dead_time_and_settles_where_the_loop_does() {
    let document = json(&["simulate", "examples/dead-time-pi.toml", "--input", "r=1", "--duration", "100", "--json"]);
    let signals = document["signals"].as_array().unwrap();
    let y = signals.iter().find(|s| s["name"] == "y").unwrap()["values"].as_array().unwrap();
    let value = |k: usize| y[k].as_f64().unwrap();
    assert_eq!(y.len(), 2001);
    // 3 seconds are 60 points; the integral brings it to 1.
    assert!((0..=60).all(|k| value(k) == 0.0) && value(70) > 0.0 && (value(2000) - 1.0).abs() < 1e-3);
}

#[test]
fn a_map_of_a_loop_with_dead_time_is_made_of_boxes() {
    let window = ["-x", "K_c=0.1..5", "-y", "theta=1..8", "--undecided", "0.4", "--json"];
    let document = json(&[&["map", "examples/dead-time-pi.toml"], &window[..]].concat());
    assert_eq!(document["schema"], "jurist/map-boxes/1");
    let boxes = document["boxes"].as_array().unwrap();
    let with = |verdict: &str| boxes.iter().filter(|b| b["verdict"] == verdict).count();
    assert!(with("stable") > 0 && with("unstable") > 0, "{}", boxes.len());
}

#[test]
fn boxes_without_a_window_are_around_the_nominal_point() {
    let run = jurist(&["map", "examples/dead-time-pi.toml", "-x", "K_c", "-y", "theta=1..8", "--undecided", "0.5"]);
    assert!(run.stdout.contains("by boxes: 0 < K_c < "), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("chosen by '-x K_c=LO..HI'"), "{}", run.stderr);
    let page = std::env::temp_dir().join(format!("jurist-boxes-{}.html", std::process::id()));
    let name = page.to_str().unwrap();
    let run = jurist(&[
        "map",
        "examples/dead-time-pi.toml",
        "-x",
        "K_c",
        "-y",
        "theta=1..8",
        "--undecided",
        "0.5",
        "-o",
        name,
    ]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let html = std::fs::read_to_string(&page).unwrap();
    std::fs::remove_file(&page).unwrap();
    assert!(html.contains("\n    stable: ") && !html.contains("\\n"), "lines of text are lines");
    // Without a nominal value there are none.
    let text = "time = 'continuous'\n[parameters]\nK = { min = 0 }\nL = { min = 0, max = 1 }\n[loop]\ncharacteristic = 's + K*exp(-L*s)'\n";
    let run = jurist_with_input(&["map", "-", "-x", "K", "-y", "L"], text.as_bytes());
    assert!(run.stderr.contains("boxes need a window of 'K' with two ends"), "{}", run.stderr);
}

/// The dead time `b - a p` falls with the parameter: its windows are those of the dead time itself, mirrored, with or without ends of the
/// domain, and so are causes, frequencies and directions.
#[test]
fn windows_of_a_dead_time_that_falls_are_mirrored() {
    let set = |function: &str, domain: &str| {
        let model = format!("time = 'continuous'\n[parameters]\np = {{}}\n[loop]\ncharacteristic = '{function}'\n");
        let run =
            jurist_with_input(&["intervals", "-", "--domain", domain, "--json", "--digits", "20"], model.as_bytes());
        serde_json::from_str::<Value>(&run.stdout).unwrap_or_else(|e| panic!("{function}: {e}: {}", run.stderr))
    };
    let number = |end: &Value| end["decimal"].as_str().map(|x| x.parse::<f64>().unwrap());
    for (before, domain, mirrored, windows) in [
        ("s^2 + 1 + 0.2*", "p=0..20", "p=-10..10", 2),
        ("s^2 + 1 + 0.2*", "p=..17/2", "p=23/4..", 1),
        ("s^2 + 1 + 0.2*", "p=5..", "p=..15/2", 2),
        ("s + 1 + 3*", "p=..", "p=..", 1),
        ("s + 1 + 3*", "p=2..5", "p=15/2..9", 0),
    ] {
        let rising = set(&format!("{before}exp(-p*s)"), domain);
        let falling = set(&format!("{before}exp(-(20 - 2*p)*s)"), mirrored);
        let [a, b] = [&rising, &falling].map(|document| document["stable"].as_array().unwrap());
        assert_eq!((a.len(), b.len()), (windows, windows), "{before} {domain}: {rising} {falling}");
        for (x, y) in a.iter().zip(b.iter().rev()) {
            for (x, y) in [(&x["lower"], &y["upper"]), (&x["upper"], &y["lower"])] {
                let off = (20.0 - 2.0 * number(y).unwrap() - number(x).unwrap()).abs();
                assert!(off < 1e-15 * 20.0, "{x} {y}");
                assert_eq!((&x["cause"], &x["kind"]), (&y["cause"], &y["kind"]));
                assert_eq!(x["frequency_enclosure"], y["frequency_enclosure"]);
                let opposite = match x["over"]["direction"].as_str() {
                    Some("+") => Some("-"),
                    Some("-") => Some("+"),
                    other => other,
                };
                assert_eq!(opposite, y["over"]["direction"].as_str());
            }
        }
    }
}

/// With K = 0 the roots of `s + 1 + K exp(-s)` do not depend on the dead time, and one is -1: this end was sought as a number between others without end.
#[test]
fn an_end_without_a_delayed_term_on_a_shifted_line_is_known_exactly() {
    let asked = ["intervals", "K/(s+1)", "--delay", "1", "--decay", "1", "--param", "K", "--json", "--domain"];
    for (domain, lower, cause) in [("K=-1..5", "0", "s=0"), ("K=0..5", "0", "domain"), ("K=-1..1/2", "0", "s=0")] {
        let document = json(&[&asked[..], &[domain]].concat());
        let stable = &document["stable"][0];
        assert_eq!(
            (&stable["lower"]["exact"], &stable["lower"]["cause"]),
            (&lower.into(), &cause.into()),
            "{document}"
        );
        if domain.ends_with('5') {
            // s + K e exp(-s) has the roots +- pi/2 j at K e = pi/2.
            let upper: f64 = stable["upper"]["decimal"].as_str().unwrap().parse().unwrap();
            assert!((upper - std::f64::consts::FRAC_PI_2 / std::f64::consts::E).abs() < 1e-9, "{document}");
        }
    }
}
