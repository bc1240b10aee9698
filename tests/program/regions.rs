//! Relative stability: ends and tables name the boundary that was asked for, not the unit circle.

use crate::helpers::program::{jurist, jurist_with_input};
use serde_json::Value;

const DISCRETE: &str = "time = 'discrete'\nparameters.K = { nominal = 0.1 }\nloop.characteristic = 'z - 1/10 + K'\n";
const PAIR: &str = "time = 'discrete'\nparameters.K = { nominal = 0.1 }\nloop.characteristic = 'z^2 + K'\n";
const CONTINUOUS: &str = "time = 'continuous'\nparameters.K = { nominal = 9 }\nloop.characteristic = 's + K'\n";

/// Text and JSON of `jurist intervals - ARGUMENTS` on a model.
fn both(model: &str, arguments: &[&str]) -> (String, Value) {
    let all = [&["intervals", "-"], arguments].concat();
    let text = jurist_with_input(&all, model.as_bytes());
    let json = jurist_with_input(&[&all[..], &["--json"]].concat(), model.as_bytes());
    assert_eq!((text.status, json.status), (0, 0), "{}", text.stderr);
    (text.stdout, serde_json::from_str(&json.stdout).unwrap())
}

#[test]
fn a_radius_names_its_own_points() {
    // |1/10 - K| < 9/10
    let (text, json) = both(DISCRETE, &["--param", "K", "--radius", "9/10"]);
    assert!(text.contains("all |z| < 0.9") && text.contains("z=0.9") && text.contains("z=-0.9"), "{text}");
    assert!(!text.contains("z=1") && !text.contains("z=-1"), "{text}");
    let ends = &json["stable"][0];
    assert_eq!((&ends["lower"]["boundary"], &ends["lower"]["cause"]), (&"z=9/10".into(), &"z=1".into()));
    assert_eq!((&ends["upper"]["boundary"], &ends["upper"]["cause"]), (&"z=-9/10".into(), &"z=-1".into()));
    // A pair at |z| = 1/2, and the two real roots on either side.
    let (text, json) = both(PAIR, &["--param", "K", "--radius", "1/2"]);
    assert!(text.contains("complex pair on |z|=0.5 at"), "{text}");
    assert_eq!(json["stable"][0]["upper"]["boundary"], "complex pair on |z|=1/2");
    assert_eq!(json["stable"][0]["lower"]["boundary"], "z=1/2+z=-1/2");
    let (text, json) = both(PAIR, &["--param", "radius"]);
    assert!(text.contains("complex pair on |z|=radius"), "{text}");
    assert_eq!(json["stable"][0]["lower"]["boundary"], "complex pair on |z|=radius");
}

#[test]
fn a_decay_rate_names_its_own_points() {
    let (text, json) = both(CONTINUOUS, &["--param", "K", "--decay", "2"]);
    assert!(text.contains("s=-2") && !text.contains("s=0"), "{text}");
    assert_eq!(json["stable"][0]["lower"]["boundary"], "s=-2");
    assert_eq!(json["stable"][0]["lower"]["cause"], "s=0");
    let (text, json) = both(CONTINUOUS, &["--param", "decay", "--set", "K=3"]);
    assert!(text.contains("s=-decay"), "{text}");
    assert_eq!(json["stable"][0]["upper"]["boundary"], "s=-decay");
    // The pair's real part, and its own frequency.
    let model = "time = 'continuous'\nparameters.K = 1\nloop.characteristic = 's^2 + K*s + 25'\n";
    let (text, json) = both(model, &["--param", "K", "--decay", "3"]);
    assert!(text.contains("complex pair on Re s=-3 at 0.6366198 Hz, 4 rad/s"), "{text}");
    assert_eq!(json["stable"][0]["lower"]["boundary"], "complex pair on Re s=-3");
    assert_eq!(json["stable"][0]["upper"]["exact"], "34/3");
}

#[test]
fn without_a_region_nothing_is_said() {
    let (text, json) = both(DISCRETE, &["--param", "K"]);
    assert!(text.contains("z=1 ") || text.contains("z=1\n"), "{text}");
    assert_eq!(json["stable"][0]["lower"]["boundary"], Value::Null);
}

#[test]
fn tables_say_which_region_they_are_for() {
    for arguments in [&["jury", "-", "--radius", "9/10"][..], &["jury", "-", "--param", "K", "--radius", "9/10"]] {
        let run = jurist_with_input(arguments, DISCRETE.as_bytes());
        let heading = run.stdout.lines().next().unwrap();
        assert!(heading.contains("all |z| < 0.9"), "{heading}");
    }
    for arguments in [&["jury", "-", "--decay", "2"][..], &["jury", "-", "--param", "K", "--decay", "2"]] {
        let run = jurist_with_input(arguments, CONTINUOUS.as_bytes());
        let heading = run.stdout.lines().next().unwrap();
        assert!(heading.contains("all Re s < -2"), "{heading}");
    }
    assert!(!jurist(&["jury"]).stdout.lines().next().unwrap().contains("all"));
}

#[test]
fn the_bound_of_a_region_is_an_axis_of_a_map() {
    let run = jurist_with_input(&["map", "-", "-x", "K", "-y", "radius=0..1"], DISCRETE.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("radius"), "{}", run.stdout);
    let run = jurist_with_input(&["map", "-", "-x", "decay", "-y", "K"], CONTINUOUS.as_bytes());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let wrong = jurist_with_input(&["map", "-", "-x", "radius", "-y", "K"], CONTINUOUS.as_bytes());
    assert_eq!(wrong.status, 2, "{}", wrong.stdout);
}
