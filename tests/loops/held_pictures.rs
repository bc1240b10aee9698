//! Maps, loci and tables of loops with plants behind a hold, as the program makes them.

use crate::helpers::model::load;
use crate::helpers::number::number;
use crate::helpers::program::{json, jurist, jurist_with_input};
use crate::helpers::thorough::tried;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_engine::stability::{Shape, count_roots};
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
#[ignore = "long: CI runs it"]
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
    let refused = jurist(&["jury", "examples/dc-servo.toml", "--param", "T"]);
    assert!(refused.stderr.contains("jury at a point"), "{}", refused.stderr);
}

/// The conditions together hold where the loop is stable, end by end; inside of each condition's solution it holds at a point too.
#[test]
#[ignore = "long: CI runs it"]
fn the_conditions_in_a_gain_behind_a_hold_have_their_own_limits() {
    let models = [
        ("dc-servo", "K", 4),
        ("drive-hold", "K_pwm", 7),
        ("lcl-inverter", "Kp", 6),
        ("anti-alias-filter", "T_i", 6),
        ("two-mass-drive", "K_p", 8),
    ];
    for (model, parameter, conditions) in tried(models, 3) {
        let file = format!("examples/{model}.toml");
        let table = json(&["jury", &file, "--param", parameter, "--json", "--digits", "15"]);
        let set = json(&["intervals", &file, "--param", parameter, "--json", "--digits", "15"]);
        assert_eq!(table["intersection"], set["stable"], "{model}");
        let list = table["conditions"].as_array().unwrap();
        assert_eq!(list.len(), conditions, "{model}");
        let ends = set["stable"].as_array().unwrap().iter().flat_map(|i| [&i["lower"], &i["upper"]]);
        let decimals = |i: &Value| ["lower", "upper"].map(|side| i[side]["decimal"].clone());
        for end in ends.filter(|end| !end.is_null() && !end["cause"].as_str().unwrap().contains("domain")) {
            // Every end of the stable set is one of some condition.
            let is_own =
                |c: &Value| c["solution"].as_array().unwrap().iter().any(|i| decimals(i).contains(&end["decimal"]));
            assert!(list.iter().any(is_own), "{model}: {end}");
        }
        let text = jurist(&["jury", &file, "--param", parameter]).stdout;
        assert!(text.contains("all together") && text.contains("rounded to 12 digits"), "{text}");
    }
    // The conditions at 551 and at 555: of the drive only the last two are lost in between.
    let table = json(&["jury", "examples/drive-hold.toml", "--param", "K_pwm", "--json"]);
    let inside = |c: &Value, x: f64| {
        let number = |end: &Value, none: f64| end["decimal"].as_str().map_or(none, |d| d.parse().unwrap());
        let holds = |i: &Value| number(&i["lower"], f64::MIN) < x && x < number(&i["upper"], f64::MAX);
        c["solution"].as_array().unwrap().iter().any(holds)
    };
    for x in [551.0, 555.0, 1e7] {
        let point = json(&["jury", "examples/drive-hold.toml", "--set", &format!("K_pwm={x}"), "--json"]);
        for (c, at) in table["conditions"].as_array().unwrap().iter().zip(point["conditions"].as_array().unwrap()) {
            assert_eq!((&c["name"], Value::from(inside(c, x))), (&at["name"], at["holds"].clone()), "{x}");
        }
    }
}

#[test]
fn routh_conditions_with_functions_of_constants_are_solved() {
    let model = "time = 'continuous'\nparameters.K = { nominal = 1 }\n[loop]\ncharacteristic = 's^3 + pi*s^2 + sqrt(2)*s + K'\n";
    let text = jurist_with_input(&["jury", "-", "--param", "K"], model.as_bytes()).stdout;
    assert!(text.contains("H_2 > 0        K < 4.44288293816"), "{text}");
    assert!(text.contains("all together   0 < K < 4.44288293816"), "{text}");
    let document: Value =
        serde_json::from_str(&jurist_with_input(&["jury", "-", "--set", "K=4.5", "--json"], model.as_bytes()).stdout)
            .unwrap();
    let holds: Vec<&Value> = document["conditions"].as_array().unwrap().iter().map(|c| &c["holds"]).collect();
    assert_eq!(holds, [true, false, false]);
    assert_eq!(document["rows"][3]["name"], "s^0");
}

/// Exact polynomials over the constants of three modes take more than a minute: a locus is drawn from enclosures of the matrix.
#[test]
fn a_locus_of_several_modes_does_not_wait_for_the_characteristic_polynomial() {
    let text = "time = 'discrete'\n[parameters]\nK = { nominal = 0.5 }\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
                [[block]]\nname = 'block'\ninput = 'K*(r - y)'\noutput = 'y'\n\
                transfer = '1/((s + 1)*(s^2 + s/5 + 1)*(s^2 + s/3 + 4)*(s^2 + s/2 + 9))'\n\
                discretize = { method = 'zoh', T = 0.1 }\n";
    let problem = load(text).ask().free("K").problem().unwrap();
    let budget = Budget::with_work(2_000_000_000);
    let rounded = problem.rounded_loop(&budget).unwrap().expect("a loop of several modes");
    // The roots at a value are those of the loop with that value, whose verdict is asked of its numbers.
    let of = |value: &str| {
        let p = rounded.at(&number(value)).unwrap();
        (p.degree(), count_roots(&p, Shape::UnitDisc).inside)
    };
    let told = |value: &str| {
        let answer = load(text).ask().set("K", number(value)).verdict(&budget).unwrap();
        (Some(7), answer.value().count.unwrap().inside)
    };
    for value in ["0", "0.5", "20", "200", "-30"] {
        assert_eq!(of(value), told(value), "{value}");
    }
}
