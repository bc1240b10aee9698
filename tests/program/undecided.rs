//! An answer that the budget does not allow says all that is known of the question.

use crate::helpers::budget::endless_model;
use crate::helpers::program::{Run, given_time, jurist, jurist_with_input};
use crate::helpers::thorough::tried;
use serde_json::Value;

fn undecided(arguments: &[&str]) -> Value {
    let run = jurist(&[arguments, &["--timeout", "0", "--json"]].concat());
    assert_eq!(run.status, 3, "{arguments:?}: {}", run.stderr);
    let document: Value = serde_json::from_str(&run.stdout).expect("a document");
    assert!(run.stderr.contains("undecided: the budget ran out: time (0 s)"), "{}", run.stderr);
    document
}

fn check_about(document: &Value, schema: &str) {
    assert_eq!(document["schema"], schema);
    assert!(document["title"].as_str().unwrap().starts_with("PWM"), "{document}");
    assert_eq!(document["time"], "discrete");
    assert_eq!(document["undecided"]["budget"], "time (0 s)");
    assert!(!document["undecided"]["reached"].as_str().unwrap().is_empty());
}

#[test]
fn one_parameter() {
    for (command, schema, key) in [("intervals", "jurist/intervals/1", "stable"), ("jury", "jurist/jury/1", "rows")] {
        let document = undecided(&[command, "--param", "K_pwm", "--set", "T=1/9000", "--radius", "99/100"]);
        check_about(&document, schema);
        assert_eq!(document["parameter"], "K_pwm");
        assert_eq!(document["set"]["T"], "1/9000");
        assert_eq!(document["domain"]["lower"], "0");
        assert_eq!(document["radius"], "99/100");
        assert_eq!(document.get(key), Some(&Value::Null));
    }
}

#[test]
fn a_point() {
    for (command, schema, key) in [("verdict", "jurist/verdict/1", "verdict"), ("jury", "jurist/jury/1", "rows")] {
        let document = undecided(&[command, "--set", "T=1/9000"]);
        check_about(&document, schema);
        assert_eq!(document["set"]["K_pwm"], "110");
        assert_eq!(document["set"]["T"], "1/9000");
        assert_eq!(document.get(key), Some(&Value::Null));
    }
}

#[test]
fn a_polynomial() {
    let document = undecided(&["charpoly", "--set", "T=1/9000"]);
    check_about(&document, "jurist/charpoly/1");
    assert_eq!(document["variable"], "z");
    assert_eq!(document["parameters"][0], "K_pwm");
    assert_eq!(document["set"]["T"], "1/9000");
    assert_eq!(document.get("coefficients"), Some(&Value::Null));
    assert_eq!(undecided(&["charpoly", "--transfer", "omega_ref", "omega"])["schema"], "jurist/transfer/1");
}

#[test]
fn everything() {
    let document = undecided(&["analyze"]);
    check_about(&document["verdict"], "jurist/verdict/1");
    check_about(&document["parameters"][0], "jurist/intervals/1");
    assert_eq!(document["parameters"].as_array().unwrap().len(), 2);
}

#[test]
fn a_bad_question_is_refused_whatever_the_time() {
    let run = jurist(&["intervals", "--param", "K_pwm", "--set", "K_pwm=1", "--timeout", "0", "--json"]);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""));
}

/// The domain of the question is the one that values are held against.
#[test]
fn a_domain_of_the_command_line_replaces_the_models() {
    let model = "time = 'discrete'\nparameters.K = { nominal = 1, min = 0, max = 2 }\n\
                 parameters.L = 1\nconstants.c = 1\nloop.characteristic = 'z - (K + L + c)/10'\n";
    let verdict =
        |arguments: &[&str]| -> Run { jurist_with_input(&[&["verdict", "-"], arguments].concat(), model.as_bytes()) };
    let warned = |arguments: &[&str]| verdict(arguments).stderr.matches("W-outside-domain").count();
    assert_eq!(warned(&["--set", "K=5"]), 1);
    assert_eq!(warned(&["--set", "K=5", "--domain", "K=0..10"]), 0);
    assert_eq!(warned(&["--set", "K=1", "--domain", "K=2..10"]), 1);
    assert_eq!(warned(&["--domain", "K=2..10"]), 1, "the nominal value is outside what is asked");
    assert_eq!(warned(&["--domain", "K=0..10"]), 0);
    assert_eq!(warned(&["--set", "c=5", "--domain", "c=0..1"]), 1);
    let run = jurist_with_input(&["intervals", "-", "--param", "K", "--domain", "K=5..6"], model.as_bytes());
    assert!(!run.stderr.contains("W-outside-domain"), "the question itself has no value: {}", run.stderr);
    for command in ["analyze", "charpoly", "jury"] {
        let arguments = [command, "-", "--set", "K=5", "--domain", "K=0..10"];
        assert!(!jurist_with_input(&arguments, model.as_bytes()).stderr.contains("W-outside"), "{command}");
    }
}

#[test]
fn long_exact_values_are_cut_for_people_only() {
    let digits = "7".repeat(3000);
    let model = format!("time = 'discrete'\nparameters.K = 1\nloop.characteristic = 'z - K/{digits}'\n");
    let text = jurist_with_input(&["intervals", "-", "--param", "K"], model.as_bytes()).stdout;
    assert!(text.len() < 1500 && text.contains("a number of 3000 digits, --json has it"), "{text}");
    let json = jurist_with_input(&["intervals", "-", "--param", "K", "--json"], model.as_bytes()).stdout;
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["stable"][0]["upper"]["exact"].as_str(), Some(digits.as_str()));
    let set = format!("K=1/{digits}");
    let text = jurist_with_input(&["verdict", "-", "--set", &set], model.as_bytes()).stdout;
    assert!(text.len() < 400 && text.contains("(a fraction of 1 over 3000 digits)"), "{text}");
}

/// Whatever step the time ends in, the program ends and says what it knows. There is no bound on how soon it must: a
/// program that does not keep its time runs on for ever.
#[test]
fn the_time_is_kept_whatever_the_step() {
    let model = endless_model();
    let commands = [
        &["intervals", "-", "--param", "K", "--json"][..],
        &["jury", "-", "--param", "K", "--json"],
        &["analyze", "-", "--json"],
    ];
    for arguments in tried(commands, 3) {
        given_time(|seconds| {
            let run = jurist_with_input(&[arguments, &["--timeout", seconds]].concat(), model.as_bytes());
            assert_eq!(run.status, 3, "{arguments:?}: {}", run.stderr);
            let ran_out = format!("time ({seconds} s)");
            assert!(run.stderr.contains(&format!("undecided: the budget ran out: {ran_out}")), "{}", run.stderr);
            // In too little time the model is not even read.
            let document: Value =
                (!run.stdout.is_empty()).then(|| serde_json::from_str(&run.stdout).expect("a whole document"))?;
            let about = if arguments[0] == "analyze" { &document["parameters"][0] } else { &document };
            assert_eq!(about["parameter"], "K");
            assert_eq!(about["undecided"]["budget"], ran_out);
            Some(())
        });
    }
}

/// A budget of counted work that ends within a later part, where the question of that part is asked, or within the growth of a box.
#[test]
fn work_that_ends_in_a_later_part_leaves_a_document() {
    for (command, works, key) in [
        (&["analyze", "examples/drive-pwm.toml"][..], &["100000", "300000", "1000000"][..], "verdict"),
        (
            &["tolerance", "examples/drive-pwm.toml", "--tol", "T=10%", "--limit", "T"],
            &["300000", "3000000"],
            "undecided",
        ),
        (&["tolerance", "examples/drive-pwm.toml", "--all", "10%"], &["3000000"], "undecided"),
        (
            &["ship", "examples/anti-alias-filter.toml", "--block", "PI", "--format", "float32"],
            &["60000000", "80000000"],
            "block",
        ),
    ] {
        for work in works {
            let run = jurist(&[command, &["--work", work, "--json"]].concat());
            assert_eq!(run.status, 3, "{command:?} {work}: {}", run.stderr);
            let document: Value =
                serde_json::from_str(&run.stdout).unwrap_or_else(|e| panic!("{command:?} {work}: {e}"));
            assert!(!document[key].is_null(), "{command:?} {work}: {document}");
        }
    }
}
