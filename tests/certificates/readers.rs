//! What is a model, by the three readers: the engine, `jurist verify` and `crates/check/check.py` on one list.

use crate::helpers::certificates::{checkers, emitted, emitted_if_any};
use crate::helpers::model::read;
use crate::helpers::number::number;
use crate::helpers::program::jurist_with_input;
use crate::helpers::thorough::is_tried;
use jurist::Ask;
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_check::Step;
use std::collections::BTreeSet;
use toml::Table;

/// An entry of the list.
struct Case {
    name: String,
    /// The parameter that is asked for.
    question: String,
    text: String,
    /// What a lax reader may take it for.
    near: String,
    /// Whether the engine, the checker and `check.py` accept it.
    accepted: [bool; 3],
}

impl Case {
    /// That of the text, or of what a lax reader takes it for.
    fn certificate(&self) -> String {
        let own = self.accepted[0].then(|| emitted_if_any(&self.text, &self.question)).flatten();
        own.unwrap_or_else(|| emitted(&self.near, &self.question))
    }
}

fn edited(text: &str, pairs: &[String], name: &str) -> String {
    pairs.chunks(2).fold(text.to_owned(), |text, pair| {
        assert!(text.contains(&pair[0]), "{name}: {} in\n{text}", pair[0]);
        text.replace(&pair[0], &pair[1])
    })
}

/// By default one of six, from a place on: each of the three readers has others.
fn tried(first: usize) -> impl Iterator<Item = Case> {
    cases().into_iter().enumerate().filter(move |(i, _)| is_tried(i + first, 6)).map(|(_, case)| case)
}

fn cases() -> Vec<Case> {
    let list = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/readers.toml");
    let list: Table = std::fs::read_to_string(list).expect("the list is there").parse().expect("the list is TOML");
    let bases = list["base"].as_table().expect("a table");
    let read = |case: &Table| {
        let text = |key: &str| case.get(key).map(|v| v.as_str().expect("a string").to_owned());
        let pairs = |key: &str| -> Vec<String> {
            let items = case.get(key).into_iter().flat_map(|v| v.as_array().expect("an array"));
            items.map(|v| v.as_str().expect("a string").to_owned()).collect()
        };
        let name = text("name").expect("a name");
        let base = bases[&text("base").expect("a base")].as_str().expect("a string");
        let mut edits: Vec<String> = text("old").into_iter().chain(text("new")).collect();
        assert!(edits.first().is_none_or(|old| base.matches(old.as_str()).count() == 1), "{name}");
        edits.extend(pairs("with"));
        let accepted = case["accepted"].as_bool().expect("true or false");
        let accepted = ["engine", "checker", "python"].map(|k| case.get(k).map_or(accepted, |v| v.as_bool().unwrap()));
        assert!(case.contains_key("why") || accepted.iter().all(|a| *a == accepted[0]), "{name}: why?");
        let near = edited(base, &pairs("near"), &name);
        let question = text("question").unwrap_or_else(|| "K".into());
        Case { question, text: edited(base, &edits, &name), near, accepted, name }
    };
    let cases: Vec<Case> =
        list["case"].as_array().expect("tables").iter().map(|case| read(case.as_table().expect("a table"))).collect();
    let names: BTreeSet<&str> = cases.iter().map(|c| c.name.as_str()).collect();
    assert!(names.len() == cases.len() && cases.len() > 200);
    cases
}

/// A true certificate of what each text is near to is accepted for that.
#[test]
fn certificates_of_the_list_are_accepted() {
    let near: BTreeSet<(String, String)> = cases().into_iter().map(|c| (c.near, c.question)).collect();
    near.iter().for_each(|(near, question)| checkers::accept(near, &emitted(near, question)));
}

#[test]
#[ignore = "long: CI runs it"]
fn the_engine_reads_what_the_list_says() {
    let mut wrong = Vec::new();
    for case in tried(0) {
        let run = jurist_with_input(&["intervals", "-", "--param", &case.question], case.text.as_bytes());
        let refused = run.status == 2 && run.stderr.contains("error[") && run.stdout.is_empty();
        assert!(refused || (run.status == 0 && !run.stderr.contains("error[")), "{}: {}", case.name, run.stderr);
        if refused == case.accepted[0] {
            wrong.push(case.name);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
#[ignore = "long: CI runs it"]
fn the_checker_reads_what_the_list_says() {
    let file = std::env::temp_dir().join(format!("jurist-readers-{}.json", std::process::id()));
    let mut wrong = Vec::new();
    for case in tried(2) {
        std::fs::write(&file, case.certificate()).expect("a file can be written");
        let path = file.to_str().expect("a path of UTF-8");
        let run = jurist_with_input(&["verify", "-", path, "--timeout", "inf"], case.text.as_bytes());
        assert!(run.status == 0 || run.status == 4, "{}: {}", case.name, run.stderr);
        // Not by its time, and not because it reads another loop.
        let refused = ["'model'", "'work'"].iter().any(|step| run.stderr.contains(&format!("at the step {step}")));
        if refused == case.accepted[1] || (run.status == 4) != refused {
            wrong.push(format!("{}: {}", case.name, run.stderr.trim()));
        }
    }
    let _ = std::fs::remove_file(&file);
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_python_checker_reads_what_the_list_says() {
    let mut wrong = Vec::new();
    for case in tried(4) {
        let Some(read) = checkers::python(&case.text, &case.certificate()) else { return };
        if read.is_ok() != case.accepted[2] {
            wrong.push(format!("{}: {read:?}", case.name));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// As many constants as one likes may be defined by each other, in any order of the text.
#[test]
fn chains_of_constants_are_long() {
    let chain = |names: &mut dyn Iterator<Item = usize>| {
        let lines: Vec<String> = names.map(|i| format!("c{i} = 'c{}'\n", i + 1)).collect();
        format!(
            "time = 'discrete'\nparameters.K = {{}}\nloop.characteristic = 'z - K*c0'\n[constants]\n{}c2500 = '1/2'",
            lines.concat()
        )
    };
    for model in [chain(&mut (0..2500)), chain(&mut (0..2500).rev())] {
        checkers::accept(&model, &emitted(&model, "K"));
    }
}

/// The certificate with another value of `c` in its `set`.
fn with_c(certificate: &str, value: &str) -> String {
    let mut json: serde_json::Value = serde_json::from_str(certificate).expect("JSON");
    json["statement"]["set"]["c"] = value.into();
    json.to_string()
}

/// Degree, points of division and all: the certificate of the text with the number holds for the question with the number set.
#[test]
fn a_constant_that_is_set_is_a_number_in_the_text_to_both_checkers() {
    let budget = Budget::unlimited();
    for (form, divides) in [
        ("characteristic = 'c*z^2 + z/3 + K'", false),
        ("characteristic = 'z/2 + K/(c - 3)'", true),
        ("matrix = [['c/4', 'K'], ['1/2', 'd/(c - 3)']]", true),
        ("[[block]]\ninput = '-K*y'\noutput = 'y'\ntransfer = '(z + d)/(c*z^2 + 2*z + 1/(3 - c))'", true),
    ] {
        let text = |c: &str| {
            let constants = format!("constants.c = '{c}'\nconstants.d = 'c/5'");
            format!("time = 'discrete'\nparameters.K = {{}}\n{constants}\n[loop]\n{form}\n")
        };
        let model = text("1");
        let mut certificates = BTreeSet::new();
        for value in ["0", "-1/2", "2"] {
            let written = emitted(&text(value), "K");
            checkers::accept(&text(value), &written);
            checkers::accept(&model, &with_c(&written, value));
            let answer = read(&model).ask().set("c", number(value)).free("K").stable_set(&budget).expect(form);
            checkers::accept(&model, &answer.certificate(&budget).expect("no limit"));
            checkers::reject(&model, &with_c(&written, "1/7"), Step::Characteristic);
            certificates.insert(written);
        }
        assert_eq!(certificates.len(), 3, "{form}");
        if divides {
            // The text with this number is no model.
            checkers::reject(&model, &with_c(&emitted(&model, "K"), "3"), Step::Model);
        }
    }
}

/// The number of a constant that another formula divides by has to be right before it is replaced or asked for.
#[test]
fn a_model_is_right_as_it_is_written() {
    let text = |c: &str| {
        format!(
            "time = 'discrete'\nparameters.K = {{}}\nconstants.c = {c}\nconstants.d = '1/c'\nloop.characteristic = 'z + d*K'"
        )
    };
    let certificate = with_c(&emitted(&text("2"), "K"), "2");
    checkers::accept(&text("5"), &certificate);
    checkers::reject(&text("0"), &certificate, Step::Model);
}
