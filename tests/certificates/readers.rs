//! What is a model, by the three readers: the engine, `jurist verify` and `crates/check/check.py` on one list.

use crate::helpers::certificates::{checkers, emitted};
use crate::helpers::program::jurist_with_input;
use jurist_check::{Limits, check};
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
        emitted(if self.accepted[0] { &self.text } else { &self.near }, &self.question)
    }
}

fn edited(text: &str, pairs: &[String], name: &str) -> String {
    pairs.chunks(2).fold(text.to_owned(), |text, pair| {
        assert!(text.contains(&pair[0]), "{name}: {} in\n{text}", pair[0]);
        text.replace(&pair[0], &pair[1])
    })
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
    let cases: Vec<Case> = list["case"].as_array().expect("tables").iter().map(|case| read(case.as_table().expect("a table"))).collect();
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
fn the_engine_reads_what_the_list_says() {
    let mut wrong = Vec::new();
    for case in cases() {
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
fn the_checker_reads_what_the_list_says() {
    let file = std::env::temp_dir().join(format!("jurist-readers-{}.json", std::process::id()));
    let mut wrong = Vec::new();
    for case in cases() {
        std::fs::write(&file, case.certificate()).expect("a file can be written");
        let path = file.to_str().expect("a path of UTF-8");
        let run = jurist_with_input(&["verify", "-", path], case.text.as_bytes());
        assert!(run.status == 0 || run.status == 4, "{}: {}", case.name, run.stderr);
        // Not by its time, and not because it reads another loop.
        let refused = run.stderr.contains("at the step 'model'");
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
    for case in cases() {
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
        let certificate = emitted(&model, "K");
        assert!(checkers::python(&model, &certificate).is_none_or(|read| read.is_ok()));
        check(&model, &certificate, &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
    }
}
