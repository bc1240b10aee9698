//! `jurist tune` with the settling time as what is to be small: by the decay or the radius, against closed forms and the requirement of that name.

use crate::helpers::folder::Folder;
use crate::helpers::number::number;
use crate::helpers::schema::fits;
use proptest::prelude::*;
use serde_json::Value;

fn tune(folder: &Folder, model: &str, options: &[&str]) -> (i32, Value) {
    let run = folder.jurist(&[&["tune", model, "--json", "--digits", "15"], options].concat());
    let document: Value = serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{options:?}: {}", run.stderr));
    fits(&document).unwrap_or_else(|why| panic!("{why}"));
    (run.status, document)
}

fn best(folder: &Folder, model: &str) -> Value {
    let (status, found) = tune(folder, model, &["--free", "K", "--objective", "min settling_time"]);
    assert_eq!(status, 0, "{found}");
    found
}

fn discrete(polynomial: &str) -> String {
    format!("time = 'discrete'\nsample_time = '1/10'\nparameters.K = 1\nloop.characteristic = '{polynomial}'\n")
}

#[test]
fn closed_forms_in_both_kinds_of_time() {
    let models = [("double.toml", discrete("z^2 - z/2 + K")), ("dead.toml", discrete("z - 1 + K"))];
    let folder = Folder::new(&models.each_ref().map(|(name, text)| (*name, text.as_str())));
    // 4/(1 - 1/sqrt 3) = 6 + 2 sqrt 3
    let found = best(&folder, "K/(s*(s+1)*(s+2))");
    assert_eq!(found["optimum"]["decimal"], "9.46410161513775");
    assert_eq!((&found["objective"], &found["optimum"]["value"]), (&"min settling_time".into(), &Value::Null));
    // A radius of 1/4: 4/10/ln 4.
    let found = best(&folder, "double.toml");
    assert_eq!(
        (&found["optimum"]["decimal"], &found["optimum"]["attained"]),
        (&"0.288539008177793".into(), &true.into())
    );
    // All is over after a sample, and without end a decay has no bound.
    assert_eq!(best(&folder, "dead.toml")["optimum"]["decimal"], "0");
    assert_eq!(best(&folder, "K/(s+1)")["optimum"]["decimal"], "0");
}

/// Within the best settling time there are gains, within a shorter one there are none; the gains that are typed in meet it with the loss.
#[test]
fn the_requirement_of_the_same_name_agrees() {
    let held = "time = 'discrete'\nsample_time = '1/10'\nparameters.K = 1\n[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\nname = 'p'\n\
        input = 'K*(r - y)'\noutput = 'y'\ntransfer = '1/(s*(s + 1))'\ndiscretize = 'zoh'\n";
    let models = [("double.toml", discrete("z^3 - 1.2*z^2 + z/4 + K")), ("held.toml", held.to_owned())];
    let folder = Folder::new(&models.each_ref().map(|(name, text)| (*name, text.as_str())));
    for model in ["double.toml", "held.toml", "K/(s*(s+1)*(s+3)^2)"] {
        let found = best(&folder, model);
        let exact = found["optimum"]["decimal"].as_str();
        let least = number(exact.unwrap_or_else(|| found["proved"].as_str().unwrap()));
        let most = number(found["found"]["value"].as_str().unwrap());
        let times = |share: &str, x: &jurist_algebra::number::Rational| (x * &number(share)).to_string();
        for (time, status) in [(times("1.0001", &most), 0), (times("0.9999", &least), 1)] {
            let run = folder.jurist(&["tune", model, "--free", "K", "--objective", "none", "--settling-time", &time]);
            assert_eq!(run.status, status, "{model} {time}: {}{}", run.stdout, run.stderr);
        }
        let gain = format!("K={}", found["rounded"]["K"].as_str().unwrap());
        let run = folder.jurist(&["verdict", model, "--set", &gain, "--settling-time", &times("1.011", &most)]);
        assert_eq!(run.status, 0, "{model} {gain}: {}{}", run.stdout, run.stderr);
    }
}

#[test]
fn what_has_no_settling_time_is_refused() {
    let varying =
        "time = 'discrete'\nsample_time = 'T'\nparameters = { T = 1, K = 1 }\nloop.characteristic = 'z - 1 + K*T'\n";
    let folder = Folder::new(&[("varying.toml", varying)]);
    for (model, gain, objective, words) in [
        ("K/(z*(z-1/2))", "K", "min settling_time", "needs the loop's sample time"),
        ("varying.toml", "T", "min settling_time", "depends on a gain"),
        ("K/(s+1)", "K", "max settling_time", "write 'min settling_time'"),
        ("K/(s+1)", "K", "min setling_time", "did you mean 'settling_time'"),
    ] {
        let run = folder.jurist(&["tune", model, "--free", gain, "--objective", objective]);
        assert!(run.status == 2 && run.stderr.contains(words), "{model} {objective}: {}", run.stderr);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// `K/(z (z - a))` has both roots at `a/2`, `K/(s (s + a))` at `-a/2`.
    #[test]
    #[ignore = "long: CI runs it"]
    fn the_double_root_of_two_poles(a in 1_i64..40) {
        let model = discrete(&format!("z^2 - {a}/20*z + K"));
        let folder = Folder::new(&[("double.toml", &model)]);
        let seconds = |found: &Value| found["optimum"]["decimal"].as_str().unwrap().parse::<f64>().unwrap();
        let expected = 0.4 / -(a as f64 / 40.0).ln();
        prop_assert!((seconds(&best(&folder, "double.toml")) / expected - 1.0).abs() < 1e-12);
        let found = best(&folder, &format!("K/(s*(s + {a}/20))"));
        prop_assert!((seconds(&found) / (160.0 / a as f64) - 1.0).abs() < 1e-12);
        prop_assert_eq!(&found["optimum"]["attained"], true);
    }
}
