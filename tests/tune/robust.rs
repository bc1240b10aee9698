//! `jurist tune --robust` and `--for-all`: gains that are good for all plants.

use crate::helpers::folder::Folder;
use crate::helpers::number::{number, ratio};
use crate::helpers::schema::fits;
use crate::helpers::thorough::count;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::{ToleranceRequest, Verdict};
use jurist_engine::error::Source;
use jurist_engine::model::Model;
use jurist_engine::response::Requirements;
use proptest::prelude::*;
use serde_json::{Value, json};

/// A PI controller for three equal lags with tolerances of their own.
const LAGS: &str = "time = 'continuous'\n[parameters]\nk = 0.5\nki = 0.2\nT = { nominal = 1, tolerance = '20%' }\n\
    g = { nominal = 1, tolerance = '10%' }\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'loop'\ninput = 'r - y'\noutput = 'y'\n\
    transfer = 'g*(k*s + ki)/(s*(T*s + 1)^3)'\n[tune]\nfree = ['k', 'ki']\nbounds = { k = [0, 5], ki = [0, 5] }\nobjective = 'max ki'\n";

fn tune(model: &str, options: &[&str]) -> (i32, Value) {
    let folder = Folder::new(&[("loop.toml", model)]);
    let run = folder.jurist(&[&["tune", "loop.toml", "--json", "--digits", "15"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}: {document}"));
    (run.status, document)
}

/// The value that was found, and the one that none have.
fn bracket(found: &Value) -> [Rational; 2] {
    [&found["found"]["value"], &found["proved"]].map(|text| number(text.as_str().unwrap_or_else(|| panic!("{found}"))))
}

fn characteristic(polynomial: &str) -> String {
    format!("time = 'continuous'\nparameters = {{ K = 1, a = 1, b = 1 }}\nloop.characteristic = '{polynomial}'\n")
}

/// Routh: `K < 2 a (a + 2)`, least at `a = 1`.
#[test]
fn the_largest_gain_for_all_poles() {
    let model = characteristic("s*(s + a)*(s + 2) + K");
    let free = ["--free", "K", "--bound", "K=0..100", "--for-all", "a=1..2"];
    let (status, found) = tune(&model, &[&free[..], &["--objective", "max K"]].concat());
    let [least, proved] = bracket(&found);
    let six = Rational::from(6);
    assert!(status == 0 && least < six && six <= proved && proved < &least * &ratio(1002, 1000), "{found}");
    assert_eq!(found["for_all"], json!([{ "name": "a", "lower": "1", "upper": "2" }]));
    let folder = Folder::new(&[("loop.toml", &model)]);
    let run = folder.jurist(&[&["tune", "loop.toml"], &free[..], &["--objective", "max K"]].concat());
    assert!(run.stdout.contains("\nfor all a from 1 to 2\n"), "{}", run.stdout);
}

/// The same as the model says it: a range, or a tolerance.
#[test]
fn plants_of_the_model() {
    let model = |key: &str| {
        format!(
            "time = 'continuous'\nparameters = {{ K = 1, a = {{ nominal = 1.5, tolerance = '20%' }} }}\n\
             loop.characteristic = 's*(s + a)*(s + 2) + K'\n[tune]\nfree = 'K'\nbounds = {{ K = [0, 100] }}\nobjective = 'max K'\n{key}\n"
        )
    };
    let given = |key: &str, options: &[&str]| tune(&model(key), options).1["for_all"].clone();
    let [range, tolerance] = [
        json!([{ "name": "a", "lower": "1", "upper": "2" }]),
        json!([{ "name": "a", "lower": "6/5", "upper": "9/5" }]),
    ];
    assert_eq!(given("for_all = { a = [1, 2] }", &[]), range);
    assert_eq!(given("robust = true", &[]), tolerance);
    // The command line counts instead of the model.
    assert_eq!(given("for_all = { a = [1, 2] }", &["--robust"]), tolerance);
    let folder = Folder::new(&[("loop.toml", &model("for_all = { a = [1, 2] }"))]);
    let run = folder.jurist(&["report", "loop.toml", "-o", "-"]);
    assert!(run.stdout.contains("for all a from 1 to 2"), "{}", run.stderr);
    for (key, words) in [
        ("for_all = { a = [2, 1] }", "the range of 'a' is no interval"),
        ("for_all = { a = [2] }", "the range of 'a': two numbers are needed"),
        ("for_all = { b = [1, 2] }", "'b' is no parameter"),
        ("robust = 1", "'robust'"),
    ] {
        let folder = Folder::new(&[("loop.toml", &model(key))]);
        let run = folder.jurist(&["tune", "loop.toml"]);
        assert!(run.status == 2 && run.stderr.contains(words), "{key}: {}", run.stderr);
    }
}

/// `s^2 + (K - a) s + b`: of all `a` up to 1 the least `K` is 1; of `b` nothing depends.
#[test]
fn the_smallest_gain_for_two_names() {
    let options = ["--free", "K", "--bound", "K=0..4", "--for-all", "a=0..1", "--for-all", "b=0.5..2"];
    let (_, found) = tune(&characteristic("s^2 + (K - a)*s + b"), &[&options[..], &["--objective", "min K"]].concat());
    let [most, proved] = bracket(&found);
    assert!(proved <= Rational::ONE && Rational::ONE < most && most <= ratio(1002, 1000), "{found}");
}

/// Each `K` has its plant that is unstable with it, and no plant refutes all of them.
#[test]
fn no_gain_is_good_for_both_signs() {
    let options = ["--free", "K", "--bound", "K=-4..5", "--for-all", "a=-1..1", "--objective", "none"];
    let (status, found) = tune(&characteristic("10*s - 1 + a*K"), &options);
    assert_eq!((status, &found["feasible"]), (1, &false.into()), "{found}");
    assert!(found["cells"].as_u64().unwrap() > 0);
}

/// The gains that are found are proved by the tolerances of the model, and are worse than those for the nominal plant.
#[test]
#[ignore = "long: CI runs it"]
fn two_gains_within_tolerances() {
    let options = ["--modulus-margin", "0.5", "--gap", "2e-2"];
    let (status, found) = tune(LAGS, &[&options[..], &["--robust"]].concat());
    let [least, proved] = bracket(&found);
    assert!(status == 0 && least < proved && proved < &least * &ratio(103, 100), "{found}");
    let (_, nominal) = tune(LAGS, &options);
    assert!(proved < number(nominal["optimum"]["value"]["decimal"].as_str().unwrap()));
    let (model, _) = Model::from_toml(&Source::new("loop.toml", LAGS)).unwrap();
    let required =
        Requirements::without_section(&model, &[("modulus_margin", "0.5")], &[], &Budget::unlimited()).unwrap();
    for point in [&found["found"]["point"], &found["rounded"]] {
        let set = ["k", "ki"].map(|name| (name.to_owned(), number(point[name].as_str().unwrap())));
        let request = ToleranceRequest::of_model(&model).require(required.list.clone(), None).gap(ratio(1, 10));
        let answer = model.ask().set_all(set).tolerance(&request, &Budget::unlimited()).unwrap();
        assert!(answer.value().required.iter().all(|required| required.decision.is_stable()), "{point}");
    }
}

#[test]
fn plants_that_cannot_be_asked() {
    let model = characteristic("s + a*K");
    let folder = Folder::new(&[("loop.toml", &model)]);
    for (options, words) in [
        (&["--free", "K", "--robust"][..], "no name beside the gains has a tolerance"),
        (&["--free", "K", "--for-all", "K=1..2"], "'K' is what is asked about"),
        (&["--free", "K", "--for-all", "a=1..2", "--objective", "max K"], "--bound K=LO..HI"),
    ] {
        let run = folder.jurist(&[&["tune", "loop.toml"], options].concat());
        assert!(run.status == 2 && run.stderr.contains(words), "{options:?}: {}", run.stderr);
    }
    // What is required would be another number for each plant.
    let depends = format!("{model}[require]\nsettling_time = '40*a'\n");
    let folder = Folder::new(&[("loop.toml", &depends)]);
    let options = ["--free", "K", "--bound", "K=1..5", "--for-all", "a=1..2", "--objective", "max K"];
    let run = folder.jurist(&[&["tune", "loop.toml"], &options[..]].concat());
    assert!(run.status == 2 && run.stderr.contains("E-require"), "{}{}", run.stdout, run.stderr);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(2, 6) as u32))]

    /// `s^3 + a s^2 + b s + K` with `a` and `b` in ranges: `K < a b` at the least of both; all plants of a grid are stable with what is found.
    #[test]
    fn the_least_product_of_ranges(a in 1_i64..8, b in 1_i64..8, wide in 1_i64..8) {
        let [low, high] = [(a, b), (a + wide, b + 2 * wide)];
        let ranges = [format!("a={}..{}", low.0, high.0), format!("b={}..{}", low.1, high.1)];
        let options = ["--free", "K", "--bound", "K=0..200", "--objective", "max K", "--for-all", &ranges[0], "--for-all", &ranges[1]];
        let model = characteristic("s^3 + a*s^2 + b*s + K");
        let (_, found) = tune(&model, &options);
        let [least, proved] = bracket(&found);
        let exact = Rational::from(low.0 * low.1);
        prop_assert!(least < exact && exact <= proved && proved <= &least * &ratio(1003, 1000), "{}", found);
        let (model, _) = Model::from_toml(&Source::new("loop.toml", &model)).unwrap();
        for k in 0..16 {
            let at = |[low, high]: [i64; 2], step: i64| ratio(low * (3 - step) + high * step, 3);
            let plant = [("a", at([low.0, high.0], k % 4)), ("b", at([low.1, high.1], k / 4)), ("K", least.clone())];
            let set = plant.map(|(name, x)| (name.to_owned(), x));
            let verdict = model.ask().set_all(set).verdict(&Budget::unlimited()).unwrap();
            prop_assert_eq!(verdict.value().verdict, Verdict::Stable);
        }
    }
}
