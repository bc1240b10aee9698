//! Maps, loci and tables of loops with plants behind a hold, as the program makes them.

use crate::helpers::program::{json, jurist};
use serde_json::Value;

#[test]
fn a_map_behind_a_hold_is_made_of_boxes() {
    let window = ["-x", "K=1..200", "-y", "T=0.0005..0.01", "--undecided", "0.4", "--json"];
    let document = json(&[&["map", "examples/dc-servo.toml"], &window[..]].concat());
    assert_eq!(document["schema"], "jurist/map-boxes/1");
    let boxes = document["boxes"].as_array().unwrap();
    let with = |verdict: &str| boxes.iter().filter(|b| b["verdict"] == verdict).count();
    assert!(with("stable") > 0 && with("unstable") > 0, "{}", boxes.len());
}

/// The largest distance from 0 of a root at the value that is next to a crossing's.
fn spectral_radius(document: &Value, value: f64) -> f64 {
    let number = |x: &Value| x.as_f64().unwrap();
    let root = |branch: &Value| {
        let values = branch["values"].as_array().unwrap().iter().map(number);
        let (at, _) = values.enumerate().min_by(|a, b| (a.1 - value).abs().total_cmp(&(b.1 - value).abs())).unwrap();
        number(&branch["roots"][at][0]).hypot(number(&branch["roots"][at][1]))
    };
    document["branches"].as_array().unwrap().iter().map(root).fold(0.0, f64::max)
}

#[test]
fn a_locus_behind_a_hold_crosses_the_circle_at_the_certified_limit() {
    for (model, parameter) in [("dc-servo", "K"), ("dc-servo", "T"), ("drive-hold", "K_pwm")] {
        let file = format!("examples/{model}.toml");
        let range = if parameter == "T" { vec!["--domain", "T=1e-4..0.1"] } else { Vec::new() };
        let document = json(&[&["locus", &file, "--param", parameter, "--json"], &range[..]].concat());
        let crossings = document["crossings"].as_array().unwrap();
        assert!(!crossings.is_empty(), "{model} {parameter}");
        for crossing in crossings {
            let value = crossing["value"].as_f64().unwrap();
            let radius = spectral_radius(&document, value);
            assert!((radius - 1.0).abs() < 1e-9, "{model} {parameter} = {value}: {radius}");
        }
    }
}

#[test]
fn the_table_behind_a_hold_holds_up_to_the_certified_limit() {
    // The limit is 117.936....
    for (gain, holds) in [("117.9", true), ("118", false)] {
        let document = json(&["jury", "examples/dc-servo.toml", "--set", &format!("K={gain}"), "--json"]);
        assert_eq!((&document["schema"], &document["holds"]), (&"jurist/jury/1".into(), &Value::from(holds)));
        let entry = &document["rows"][1]["entries"][0];
        assert!(entry[0].is_string() && entry[1].is_string(), "{entry}");
        let failing = document["conditions"].as_array().unwrap().iter().filter(|c| c["holds"] == false).count();
        assert_eq!(failing == 0, holds);
    }
    let refused = jurist(&["jury", "examples/dc-servo.toml", "--param", "K"]);
    assert!(refused.stderr.contains("jury at a point"), "{}", refused.stderr);
}
