//! Each command on the built-in drive, against values from two independent computer-algebra systems.

use crate::helpers::program::{json, jurist, jurist_with_input, number_in};
use jurist_algebra::number::{Rational, parse_number};
use serde_json::Value;

const LOWER: &str = "0.0381005333482991622339946374985";
const UPPER: &str = "550.941166686674575539637530920";
const PERIOD: &str = "0.000496939745106872225766768147027";

fn close(value: &Value, expected: f64, tolerance: f64) {
    let value = value.as_f64().expect("a number");
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
}

/// Checks what the contract says of every end, and that its decimal begins with these digits.
fn check_end(end: &Value, digits: &str, cause: &str, places: i64) {
    let decimal = end["decimal"].as_str().expect("a string");
    assert!(decimal.starts_with(digits), "{decimal} is not {digits}...");
    assert_eq!(end["cause"], cause);
    assert_eq!(end["closed"], false);
    let (lo, hi) = (number_in(&end["enclosure"][0]), number_in(&end["enclosure"][1]));
    assert_eq!(lo == hi, end["exact"].is_string());
    let tolerance = Rational::from(10).pow(-places - 2).unwrap();
    assert!(&hi - &lo <= lo.abs() * tolerance);
    let coefficients: Vec<Rational> = end["polynomial"].as_array().unwrap().iter().map(number_in).collect();
    let at = |x: &Rational| coefficients.iter().rev().fold(Rational::ZERO, |sum, c| sum * x + c);
    if lo == hi {
        assert!(at(&lo).is_zero());
    } else {
        assert_ne!(at(&lo).sign(), at(&hi).sign());
    }
}

#[test]
fn the_amplitude_to_forty_digits() {
    let answer = json(&["intervals", "--param", "K_pwm", "--json", "--digits", "40"]);
    assert_eq!(answer["schema"], "jurist/intervals/1");
    assert_eq!(answer["time"], "discrete");
    assert_eq!(answer["parameter"], "K_pwm");
    assert_eq!(answer["set"]["T"], "1/10000");
    assert_eq!(answer["domain"]["lower"], "0");
    assert_eq!(answer["domain"]["upper"], Value::Null);
    let stable = answer["stable"].as_array().unwrap();
    assert_eq!(stable.len(), 1);
    let (lower, upper) = (&stable[0]["lower"], &stable[0]["upper"]);
    check_end(lower, LOWER, "complex pair", 40);
    check_end(upper, UPPER, "complex pair", 40);
    assert_eq!(lower["decimal"].as_str().unwrap().trim_start_matches("0.0").len(), 40);
    close(&lower["frequency_hz"], 0.505696, 1e-6);
    close(&upper["frequency_hz"], 1664.065, 1e-3);
    close(&lower["angle"], 0.000317738, 1e-9);
    for end in [lower, upper] {
        let frequency = end["frequency_hz"].as_f64().unwrap();
        let (lo, hi) = (number_in(&end["frequency_enclosure"][0]), number_in(&end["frequency_enclosure"][1]));
        assert!(lo < hi && (&hi - &lo) * parse_number("1e40").unwrap() < hi);
        assert!((lo.to_f64_approximate() - frequency).abs() <= 1e-12 * frequency);
    }
    close(&upper["margin_db"], 13.99425, 1e-5);
    assert!(upper["margin_factor"].as_str().unwrap().starts_with("5.0085560607"));
}

#[test]
fn the_period() {
    let answer = json(&["intervals", "--param", "T", "--json", "--digits", "33"]);
    let stable = answer["stable"].as_array().unwrap();
    assert_eq!(stable.len(), 1);
    check_end(&stable[0]["lower"], "0", "z=1+domain", 33);
    assert_eq!(stable[0]["lower"]["exact"], "0");
    assert_eq!(stable[0]["lower"]["frequency_hz"], Value::Null);
    check_end(&stable[0]["upper"], PERIOD, "complex pair", 33);
    close(&stable[0]["upper"]["frequency_hz"], 332.766, 1e-3);
}

#[test]
fn the_main_job_is_one_page_with_the_limits_beside_the_papers() {
    let run = jurist(&[]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    for expected in [
        "0.03810053334",
        "550.9411666866",
        "0.000496939745106",
        "2012.3164",
        "2.9853",
        "549.7",
        "2012.47",
        "2.98531969042",
        "550.941166686",
        "1.81612318841",
        "736568.8795",
        "|b_0| > |b_5|",
        "|e_0| > |e_2|",
        "2.67978e-12*K_pwm - 8e-12",
    ] {
        let found =
            run.stdout.contains(expected) || expected == "1.81612318841" && run.stdout.contains("0.00181612318841");
        assert!(found, "{expected} is missing:\n{}", run.stdout);
    }
    assert!(run.stdout.lines().count() <= 66, "more than a page");
    assert!(run.stdout.lines().all(|l| l.chars().count() <= 110), "too wide");
    let document = json(&["--json"]);
    assert_eq!(document["rounding"]["printed_zero"].as_str().map(|z| parse_number(z).is_ok()), Some(true));
}

#[test]
fn analyze_has_a_verdict_and_every_parameter() {
    let answer = json(&["analyze", "--json"]);
    assert_eq!(answer["verdict"]["verdict"], "stable");
    let names: Vec<&Value> = answer["parameters"].as_array().unwrap().iter().map(|p| &p["parameter"]).collect();
    assert_eq!(names, ["K_pwm", "T"]);
    assert!(jurist(&["analyze"]).stdout.contains("550.941166687"));
}

#[test]
fn verdicts_and_their_exit_statuses() {
    let stable = jurist(&["verdict", "--set", "K_pwm=545"]);
    assert_eq!((stable.status, stable.stdout.contains("stable: all 6 roots")), (0, true));
    for (set, verdict, outside) in [("K_pwm=555", "unstable", 2), ("T=1/2010", "unstable", 2)] {
        let run = jurist(&["verdict", "--set", set, "--json"]);
        let answer: Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!((run.status, &answer["verdict"], &answer["outside"]), (1, &verdict.into(), &outside.into()));
        assert_eq!(answer["degree"], 6);
    }
    assert_eq!(jurist(&["verdict", "--set", "T=1/2020"]).status, 0);
    let on_the_circle = b"time = 'discrete'\nloop.characteristic = '(z^2 + 1)^2*(z - 1/2)'";
    let run = jurist_with_input(&["verdict", "-", "--json"], on_the_circle);
    let answer: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((run.status, &answer["verdict"], &answer["on"]), (1, &"marginal".into(), &4.into()));
}

#[test]
fn the_characteristic_polynomial_equals_the_reference() {
    let answer = json(&["charpoly", "--json"]);
    assert_eq!(answer["schema"], "jurist/charpoly/1");
    assert_eq!(answer["variable"], "z");
    assert_eq!(answer["parameters"], serde_json::json!(["K_pwm", "T"]));
    let r = |text: &str| parse_number(text).unwrap();
    let (k, t) = (r("7/3"), r("2/5"));
    let p = |e: i64| t.pow(e).unwrap();
    let expected = [
        &k * &p(2) * (r("42968750") * p(2) - r("18906250") * &t + r("687500")) / r("6417"),
        &k * &t * (r("85937500") * p(3) - r("250000") * p(2) + r("1541250") * &t - r("116250")) / r("6417"),
        r("42968750/6417") * &k * p(4)
            + r("18906250/6417") * &k * p(3)
            + (r("2250/31") - r("248750/713") * &k) * p(2)
            + (r("1250/23") * &k - r("46684/2139")) * &t
            + Rational::ONE,
        r("250000/6417") * &k * p(3) - (r("2896250/6417") * &k + r("4500/31")) * p(2)
            + (r("46684/713") - r("1250/23") * &k) * &t
            - r("4"),
        (r("31250/69") * &k + r("2250/31")) * p(2) + (r("1250/69") * &k - r("46684/713")) * &t + r("6"),
        r("46684/2139") * &t - r("4"),
        Rational::ONE,
    ];
    let value = |part: &Value| {
        part.as_array().unwrap().iter().fold(Rational::ZERO, |sum, term| {
            let power = |i: usize| term[0][i].as_i64().unwrap();
            sum + number_in(&term[1]) * k.pow(power(0)).unwrap() * t.pow(power(1)).unwrap()
        })
    };
    let coefficients = answer["coefficients"].as_array().unwrap();
    assert_eq!(coefficients.len(), expected.len());
    for (c, expected) in coefficients.iter().zip(&expected) {
        assert_eq!(value(&c["numerator"]) / value(&c["denominator"]), *expected);
    }
}

#[test]
fn blocks_give_the_same_polynomial_as_matrices() {
    let coefficients = |arguments: &[&str]| json(arguments)["coefficients"].clone();
    assert_eq!(
        coefficients(&["charpoly", "examples/drive-blocks.toml", "--json"]),
        coefficients(&["charpoly", "--json"])
    );
}

#[test]
fn equation_23_has_the_printed_digits() {
    let run = jurist(&["charpoly", "--set", "T=1e-4", "--digits", "12"]);
    for line in [
        "a_0 = 0.00000106842730978*K_pwm",
        "a_1 = -0.00180919241724*K_pwm",
        "a_2 = 0.00543129677584*K_pwm + 0.997818210612",
        "a_3 = -0.00543929597164*K_pwm - 3.99345390603",
        "a_4 = 0.00181612318841*K_pwm + 5.99345318022",
        "a_5 = -3.99781748481",
        "a_6 = 1",
    ] {
        assert!(run.stdout.lines().any(|l| l == line), "{line}\n{}", run.stdout);
    }
    let locus = jurist(&["charpoly", "--set", "T=1e-4", "--root-locus-form", "K_pwm", "--digits", "12"]);
    assert!(locus.stdout.contains("b_4 = 0.00181612318841\n") && locus.stdout.contains("a_2 = 0.997818210612\n"));
}

#[test]
fn the_jury_table_has_seven_conditions() {
    let answer = json(&["jury", "--param", "K_pwm", "--json", "--digits", "20"]);
    let rows = answer["rows"].as_array().unwrap();
    let sizes: Vec<usize> = rows.iter().map(|r| r["entries"].as_array().unwrap().len()).collect();
    assert_eq!(sizes, [7, 6, 5, 4, 3]);
    // e_0 has degree 16 in K_pwm.
    assert_eq!(rows[4]["entries"][0].as_array().unwrap().len(), 17);
    let names: Vec<&str> =
        answer["conditions"].as_array().unwrap().iter().map(|c| c["name"].as_str().unwrap()).collect();
    assert_eq!(names.len(), 7);
    assert_eq!(&names[2..], ["|a_0| < a_6", "|b_0| > |b_5|", "|c_0| > |c_4|", "|d_0| > |d_3|", "|e_0| > |e_2|"]);
    let intersection = answer["intersection"].as_array().unwrap();
    assert_eq!(intersection.len(), 1);
    check_end(&intersection[0]["lower"], "0.03810053334829916223", "complex pair", 20);
    // b_0 = a_0^2 - a_6^2, exactly as in the paper's Eq. 26.
    let (a0, b0) = (&rows[0]["entries"][0], &rows[1]["entries"][0]);
    assert_eq!(number_in(&b0[2]), number_in(&a0[1]) * number_in(&a0[1]));
    assert_eq!(number_in(&b0[0]), Rational::from(-1));
    let text = jurist(&["jury", "--param", "K_pwm"]).stdout;
    assert!(text.contains("e_2 = ") && text.contains("all together"));
    let numeric = json(&["jury", "--json"]);
    assert_eq!((&numeric["holds"], numeric["conditions"].as_array().unwrap().len()), (&true.into(), 7));
    assert_eq!(json(&["jury", "--json", "--set", "K_pwm=555"])["holds"], false);
}

#[test]
fn the_speed_follows_its_reference() {
    let answer = json(&["charpoly", "--transfer", "omega_ref", "omega", "--json"]);
    let sum = |part: &str| {
        let mut terms: Vec<(String, Rational)> = Vec::new();
        for c in answer[part].as_array().unwrap() {
            assert_eq!(c["denominator"], serde_json::json!([[[0, 0], "1"]]));
            for term in c["numerator"].as_array().unwrap() {
                let (powers, value) = (term[0].to_string(), number_in(&term[1]));
                match terms.iter_mut().find(|(p, _)| *p == powers) {
                    Some((_, sum)) => *sum += value,
                    None => terms.push((powers, value)),
                }
            }
        }
        terms.retain(|(_, v)| !v.is_zero());
        terms.sort();
        terms
    };
    assert!(!sum("numerator").is_empty());
    assert_eq!(sum("numerator"), sum("denominator"));
}
