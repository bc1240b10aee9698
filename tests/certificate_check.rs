//! Hand-made certificates, wrong and broken ones, and the imports of the check.

use jurist::certificate::check::{Limits, Step, check};
use jurist::certificate::format::{Json, MAX_DEPTH};

mod certificates;
use certificates::{MODELS, emitted, verdict_emitted};

fn limits() -> Limits {
    Limits::default()
}

const TANGENCY: &str =
    "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^2 - z*(K - 1)^2 + 1 - (K - 1)^2*(K - 3)^2/4'";

/// `z^2 + 1 - K^2`, roots on the circle at 0; stable on both sides.
const TOUCHING: &str = "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^2 + 1 - K^2'";

const TOUCHING_CERTIFICATE: &str = r#"{
  "schema": "jurist/certificate/1",
  "statement": {"kind": "intervals", "time": "discrete", "parameter": "K", "set": {}, "region": {"radius": "1"},
    "domain": {"lower": "-1", "upper": "1"},
    "stable": [{"lower": "-1", "upper": "0"}, {"lower": "0", "upper": "1"}]},
  "characteristic": [["1", "0", "-1"], [], ["1"]],
  "boundary": {"u": [], "v": [["1"]], "value": ["0", "0", "1"]},
  "factors": [["0", "1"], ["2", "0", "-1"]],
  "line": [{"split": [], "sample": "-1/2", "stable": true}, {"at": "0", "touch": ["v", 0]},
           {"split": [], "sample": "1/2", "stable": true}]
}"#;

#[test]
fn a_touching_point_is_excluded_by_its_witness() {
    assert!(check(TOUCHING, TOUCHING_CERTIFICATE, &limits()).is_ok());
    let joined = TOUCHING_CERTIFICATE
        .replace(r#"{"lower": "-1", "upper": "0"}, {"lower": "0", "upper": "1"}"#, r#"{"lower": "-1", "upper": "1"}"#);
    assert_eq!(check(TOUCHING, &joined, &limits()).unwrap_err().step, Step::Stable);
    let without = TOUCHING_CERTIFICATE.replace(r#", "touch": ["v", 0]"#, "");
    assert_eq!(check(TOUCHING, &without, &limits()).unwrap_err().step, Step::Line);
}

/// An identity with a superfluous factor makes a spurious zero, which must not split the set.
#[test]
fn a_spurious_zero_is_no_end() {
    let model = "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z^2 + 1/4'";
    let text = r#"{
      "schema": "jurist/certificate/1",
      "statement": {"kind": "intervals", "time": "discrete", "parameter": "K", "set": {}, "region": {"radius": "1"},
        "domain": {"lower": "-1", "upper": "1"},
        "stable": [{"lower": "-1", "upper": "0"}, {"lower": "0", "upper": "1"}]},
      "characteristic": [["1"], [], ["4"]],
      "boundary": {"u": [], "v": [["0", "1"]], "value": ["0", "3"]},
      "factors": [["0", "1"]],
      "line": [{"split": [], "sample": "-1/2", "stable": true}, {"at": "0", "touch": ["v", 0]},
               {"split": [], "sample": "1/2", "stable": true}]
    }"#;
    assert_eq!(check(model, text, &limits()).unwrap_err().step, Step::Line);
}

#[test]
fn broken_texts_are_rejected_quickly() {
    let start = std::time::Instant::now();
    let good = TOUCHING_CERTIFICATE;
    for cut in 0..good.len() {
        if good.is_char_boundary(cut) {
            assert_eq!(check(TOUCHING, &good[..cut], &limits()).unwrap_err().step, Step::Format);
        }
    }
    let million = "7".repeat(1_000_000);
    let cases = [
        good.replace("certificate/1", "certificate/2"),
        good.replace("\"-1/2\"", &format!("\"{million}\"")),
        good.replace("\"-1/2\"", &format!("\"1/{million}\"")),
        good.replace("\"-1/2\"", "\"1/0\""),
        good.replace("\"-1/2\"", "-0.5"),
        good.replace("\"sample\": \"-1/2\"", "\"sample\": \"-1/2\", \"sample\": \"-1/2\""),
        good.replace("\"factors\": [", &format!("\"factors\": {}", "[".repeat(MAX_DEPTH + 1))),
        "[".repeat(10_000_000),
        format!("{good}{good}"),
        format!("\"{million}"),
        good.replace("\"line\"", "\"lines\""),
        String::new(),
        "null".into(),
        "{}".into(),
    ];
    for text in &cases {
        assert!(check(TOUCHING, text, &limits()).is_err(), "{}", &text[..text.len().min(200)]);
    }
    let models = [
        "(".repeat(1_000_000),
        format!("time = 'discrete'\nparameters.K = {{}}\nloop.characteristic = '{}z'", "(".repeat(100_000)),
        format!("time = 'discrete'\nparameters.K = {{}}\nloop.characteristic = 'z{}'", "^9".repeat(1000)),
        "time = 'discrete'\nparameters.K = {}\nloop.characteristic = '(z + K)^1000*(z - K)^1000'".into(),
        "time = 'discrete'\nconstants.a = 'b'\nconstants.b = 'a'\nparameters.K = {}\nloop.characteristic = 'z'".into(),
        "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z + 1e999999999'".into(),
    ];
    let short = Limits { timeout: std::time::Duration::from_secs(1) };
    for model in &models {
        assert!(check(model, good, &short).is_err());
    }
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn every_model_has_a_certificate_that_is_accepted() {
    for (name, model, parameter) in MODELS.iter().copied().chain([("tangency", TANGENCY, "K")]) {
        let certificate = emitted(model, parameter);
        if let Err(rejection) = check(model, &certificate, &limits()) {
            panic!("{name}: {rejection}\n{certificate}");
        }
    }
}

#[test]
fn verdicts_are_accepted_and_wrong_counts_are_not() {
    for (name, model, parameter) in MODELS {
        for value in ["0", "1", "-1", "1/2", "2", "3", "1/3", "10"] {
            let certificate = verdict_emitted(model, parameter, value);
            check(model, &certificate, &limits()).unwrap_or_else(|e| panic!("{name} at {value}: {e}\n{certificate}"));
            for key in ["degree", "inside", "on", "outside", "infinite"] {
                let wrong = certificates::with_count_changed(&certificate, key);
                assert!(check(model, &wrong, &limits()).is_err(), "{name} at {value}: {key}");
            }
        }
    }
}

#[test]
fn certificates_for_other_models_are_rejected() {
    let all: Vec<String> = MODELS.iter().map(|(_, model, parameter)| emitted(model, parameter)).collect();
    for (i, (name, model, _)) in MODELS.iter().enumerate() {
        for (j, certificate) in all.iter().enumerate().filter(|(j, _)| *j != i) {
            assert!(check(model, certificate, &limits()).is_err(), "{name} by the certificate of {}", MODELS[j].0);
        }
    }
}

/// All single changes of numbers, labels and lines. A change that is accepted must leave the statement true: it
/// concerns the proof or the model's title only, or writes the same statement in another way.
#[test]
fn mutations_are_rejected_unless_the_statement_stays_true() {
    let (mut rejected, mut proof_only, mut narrowed) = (0, 0, 0);
    for (name, model, parameter) in MODELS {
        let text = emitted(model, parameter);
        let original = Json::parse(&text).unwrap();
        for mutant in certificates::mutations(&original) {
            match check(model, &mutant.to_text(), &limits()) {
                Err(_) => rejected += 1,
                Ok(_) if mutant.get("statement") == original.get("statement") => proof_only += 1,
                Ok(proved) => {
                    // The question was changed, or an enclosure: then the engine must agree.
                    assert!(
                        certificates::is_true(model, &mutant),
                        "{name}: accepted: {}\n{}",
                        proved.statement,
                        mutant.to_text()
                    );
                    narrowed += 1;
                }
            }
        }
    }
    println!(
        "{rejected} mutations rejected, {proof_only} accepted with the same statement, {narrowed} with another true one"
    );
    assert!(rejected > 1000);
}

#[test]
fn the_check_uses_nothing_of_the_engine() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/certificate");
    let mut files: Vec<_> = std::fs::read_dir(root.join("check")).unwrap().map(|f| f.unwrap().path()).collect();
    files.push(root.join("format.rs"));
    assert!(files.len() > 10);
    let rooms = ["limits", "number", "poly", "matrix", "stability", "model", "analysis", "simulate", "report", "cli"];
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
            for path in line.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')) {
                if let Some(rest) = path.strip_prefix("crate::") {
                    let allowed = rest.starts_with("error") || rest.starts_with("certificate::format");
                    assert!(allowed, "{}: {line}", file.display());
                }
                assert!(!path.starts_with("malachite"), "{}: {line}", file.display());
                assert!(!path.starts_with("super::super::super"), "{}: {line}", file.display());
                assert!(
                    !rooms.iter().any(|room| path.starts_with(&format!("jurist::{room}"))),
                    "{}: {line}",
                    file.display()
                );
            }
            assert!(!line.contains("crate::{"), "{}: {line}", file.display());
        }
    }
}

/// Both checkers read the same page, so they agree; only where `python3` is there.
#[test]
fn the_python_checker_agrees() {
    use std::process::{Command, Stdio};
    let python = |arguments: &[&str]| {
        Command::new("python3").args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).output()
    };
    if !python(&["-c", "import tomllib"]).is_ok_and(|o| o.status.success()) {
        println!("python3 with tomllib is not there: not tested");
        return;
    }
    let root = env!("CARGO_MANIFEST_DIR");
    let script = format!("{root}/examples/check.py");
    let directory = std::env::temp_dir().join(format!("jurist-check-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let run = |name: &str, model: &str, certificate: &str| {
        let (m, c) = (directory.join(format!("{name}.toml")), directory.join(format!("{name}.json")));
        std::fs::write(&m, model).unwrap();
        std::fs::write(&c, certificate).unwrap();
        let output = python(&[&script, m.to_str().unwrap(), c.to_str().unwrap()]).unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    for (name, model, parameter) in MODELS {
        let certificate = emitted(model, parameter);
        let (code, errors) = run("model", model, &certificate);
        assert_eq!(code, Some(0), "{name}: {errors}");
        let verdict = verdict_emitted(model, parameter, "1/3");
        let (code, errors) = run("model", model, &verdict);
        assert_eq!(code, Some(0), "{name}, verdict: {errors}");
        let original = Json::parse(&certificate).unwrap();
        for mutant in certificates::mutations(&original).into_iter().step_by(97) {
            let text = mutant.to_text();
            let rust = check(model, &text, &limits()).is_ok();
            let (code, errors) = run("mutant", model, &text);
            assert_eq!(code == Some(0), rust, "{name}: {errors}\n{text}");
            assert!(code == Some(0) || code == Some(4), "{errors}");
        }
    }
    let _ = std::fs::remove_dir_all(&directory);
}
