//! Both checkers give the same word on every file: accepted, rejected, or refused as too much. Certificates of all seven schemas and their models are
//! changed at random, and all are looked at by `jurist_check::check` and by `check.py`.
//!
//! `JURIST_AGREEMENT=20000` looks at so many; `JURIST_AGREEMENT_SEED` begins elsewhere.

#[path = "agreement/changes.rs"]
mod changes;
#[path = "agreement/findings.rs"]
mod findings;
#[path = "agreement/python.rs"]
mod python;

use changes::Draw;
use jurist_check::{Limits, Step, check};
use python::Python;
use std::collections::BTreeMap;
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

/// So many pairs of texts in an ordinary run, and with `JURIST_THOROUGH`, as in CI.
const USUAL: [u64; 2] = [50, 150];

fn folder() -> &'static str {
    concat!(env!("CARGO_MANIFEST_DIR"), "/tests/agreement")
}

fn text(name: &str) -> String {
    std::fs::read_to_string(format!("{}/{name}", folder())).expect("the file is there")
}

/// Models and what was written for them, by the names of the files: `held.2.json` is of `held.toml`.
fn corpus() -> Vec<(String, String)> {
    let mut names: Vec<String> = std::fs::read_dir(folder())
        .expect("the folder is there")
        .map(|file| file.expect("a file").file_name().into_string().expect("a name of UTF-8"))
        .filter(|name| name.ends_with(".json"))
        .collect();
    names.sort();
    let model = |name: &str| format!("{}.toml", name.split('.').next().expect("a name"));
    names.iter().map(|name| (text(&model(name)), text(name))).collect()
}

fn rust(model: &str, certificate: &str) -> (&'static str, String) {
    match check(model, certificate, &LIMITS) {
        Ok(proved) => ("accepted", proved.statement),
        Err(e) if matches!(e.step, Step::Work | Step::Time) => ("refused", e.to_string()),
        Err(e) => ("rejected", e.to_string()),
    }
}

/// The same word, and of what is accepted the same statement.
fn assert_same(python: &mut Python, model: &str, certificate: &str) -> Result<&'static str, String> {
    let ((word, said), (other, other_said)) = (rust(model, certificate), python.judge(model, certificate));
    if word == other && (word != "accepted" || said == other_said) {
        return Ok(word);
    }
    Err(format!("Rust: {word}: {said}\nPython: {other}: {other_said}\n{model}\n{certificate}"))
}

#[test]
fn certificates_of_all_schemas_are_accepted_with_the_same_words() {
    let Some(mut python) = Python::start() else { return };
    let corpus = corpus();
    for version in 1..=7 {
        let schema = format!("jurist/certificate/{version}\"");
        assert!(corpus.iter().any(|(_, certificate)| certificate.contains(&schema)), "{schema}");
    }
    for (model, certificate) in &corpus {
        assert_eq!(assert_same(&mut python, model, certificate), Ok("accepted"));
    }
}

#[test]
fn both_checkers_have_one_version() {
    let python = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/check.py")).expect("the file is there");
    assert!(
        python.contains(concat!("VERSION = \"", env!("CARGO_PKG_VERSION"), "\"\n")),
        "check.py has another version"
    );
}

#[test]
fn changed_texts_get_the_same_word() {
    let Some(mut python) = Python::start() else { return };
    let number = |name: &str, usual: u64| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(usual);
    let usual = USUAL[usize::from(std::env::var_os("JURIST_THOROUGH").is_some())];
    let (count, seed) = (number("JURIST_AGREEMENT", usual), number("JURIST_AGREEMENT_SEED", 20_020_326));
    let (corpus, mut draw) = (corpus(), Draw::new(seed));
    let (mut words, mut wrong) = (BTreeMap::new(), Vec::new());
    for _ in 0..count {
        let (model, certificate) = changes::changed(&corpus, &mut draw);
        let schema = (1..=7).find(|n| certificate.contains(&format!("certificate/{n}\"")));
        match assert_same(&mut python, &model, &certificate) {
            Ok(word) => *words.entry((schema.unwrap_or(0), word)).or_insert(0) += 1,
            Err(said) => {
                println!("==\n{said}");
                wrong.push(said);
            }
        }
    }
    println!("{count} pairs by schema (0 is another) and word: {words:?}, {} disagreements", wrong.len());
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n\n==\n"));
    for word in ["accepted", "rejected"] {
        assert!(words.keys().any(|&(_, own)| own == word), "{words:?}");
    }
}
