//! Cases from their files. Whatever is not understood is refused: a misspelt key must not make a case say less.

use super::{Case, Expectation, Expected, ExpectedEnd};
use crate::helpers::model::{example_text, path};
use toml::de::{DeTable, DeValue};

/// All cases, by name.
pub fn cases() -> Vec<Case> {
    let folder = path("tests/corpus");
    let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "toml"));
    files.sort();
    let name = |file: &std::path::Path| file.file_stem().unwrap().to_str().unwrap().to_owned();
    files.iter().map(|file| case(name(file), &std::fs::read_to_string(file).unwrap())).collect()
}

fn case(name: String, text: &str) -> Case {
    let table = DeTable::parse(text).unwrap_or_else(|e| panic!("{name}: {e}")).into_inner();
    keys(&name, &table, &["why", "source", "model", "example", "proved", "expect"]);
    for key in ["why", "source"] {
        assert!(!words(&name, &table, key).unwrap_or_default().is_empty(), "{name} has no '{key}'");
    }
    let model = match (words(&name, &table, "model"), words(&name, &table, "example")) {
        (Some(model), None) => model,
        (None, Some(example)) => example_text(&example),
        _ => panic!("{name} has either a 'model' or an 'example'"),
    };
    let expectations = array(&name, &table, "expect");
    assert!(!expectations.is_empty(), "{name} expects nothing");
    let expectations = expectations.iter().map(|e| expectation(&name, e.as_table().expect("[[expect]]"))).collect();
    let is_proved =
        table.get("proved").is_none_or(|value| value.get_ref().as_bool().expect("'proved' is true or false"));
    Case { name, model, is_proved, expectations }
}

fn expectation(name: &str, table: &DeTable) -> Expectation {
    keys(name, table, &["question", "set", "domain", "radius", "decay", "stable", "verdict", "roots"]);
    let question = words(name, table, "question").unwrap_or_else(|| panic!("{name}: no question"));
    let parameter = match question.split(' ').collect::<Vec<_>>()[..] {
        ["intervals", parameter] => Some(parameter.to_owned()),
        ["verdict"] => None,
        _ => panic!("{name}: {question} is neither 'intervals NAME' nor 'verdict'"),
    };
    let answer = if parameter.is_some() {
        assert!(!table.contains_key("verdict") && !table.contains_key("roots"), "{name}: a verdict of intervals");
        assert!(table.contains_key("stable"), "{name}: no answer");
        Expected::Stable(array(name, table, "stable").iter().map(|interval| ends(name, interval)).collect())
    } else {
        assert!(!table.contains_key("stable"), "{name}: intervals of a verdict");
        let verdict = words(name, table, "verdict").unwrap_or_else(|| panic!("{name}: no verdict"));
        Expected::Verdict { verdict, roots: words(name, table, "roots") }
    };
    let option = |key| words(name, table, key);
    let (set, domain) = (pairs(name, table, "set"), pairs(name, table, "domain"));
    Expectation { parameter, set, domain, radius: option("radius"), decay: option("decay"), answer }
}

fn ends(name: &str, interval: &DeValue) -> [ExpectedEnd; 2] {
    let ends: Vec<&str> =
        interval.as_array().map(|a| a.iter().filter_map(|end| end.get_ref().as_str()).collect()).unwrap_or_default();
    let [lower, upper] = ends[..] else { panic!("{name}: an interval is a list of two texts") };
    [ExpectedEnd::read(name, lower, "-inf"), ExpectedEnd::read(name, upper, "inf")]
}

fn keys(name: &str, table: &DeTable, known: &[&str]) {
    for key in table.keys() {
        assert!(known.contains(&key.get_ref().as_ref()), "{name}: unknown key '{}'", key.get_ref());
    }
}

fn words(name: &str, table: &DeTable, key: &str) -> Option<String> {
    let value = table.get(key)?.get_ref();
    Some(value.as_str().unwrap_or_else(|| panic!("{name}: '{key}' is no text")).to_owned())
}

fn array<'t, 'i>(name: &str, table: &'t DeTable<'i>, key: &str) -> Vec<&'t DeValue<'i>> {
    let Some(value) = table.get(key) else { return Vec::new() };
    let array = value.get_ref().as_array().unwrap_or_else(|| panic!("{name}: '{key}' is no list"));
    array.iter().map(|item| item.get_ref()).collect()
}

fn pairs(name: &str, table: &DeTable, key: &str) -> Vec<(String, String)> {
    let Some(value) = table.get(key) else { return Vec::new() };
    let table = value.get_ref().as_table().unwrap_or_else(|| panic!("{name}: '{key}' is no table"));
    let text =
        |value: &DeValue| value.as_str().unwrap_or_else(|| panic!("{name}: numbers in '{key}' are texts")).to_owned();
    table.iter().map(|(key, value)| (key.get_ref().to_string(), text(value.get_ref()))).collect()
}
