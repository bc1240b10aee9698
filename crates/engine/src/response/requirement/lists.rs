//! What is written elsewhere from the list of requirements: Python's keywords, and a table of the documentation.

use super::RequirementKind;
use crate::model::published::{between, publish};
use crate::model::requirements::ALL;

/// The words of an entry in Python: regions are keywords of every question.
fn in_python() -> String {
    let kinds = || RequirementKind::all().iter().filter(|kind| kind.option.is_some());
    let names: Vec<String> = kinds().map(|kind| format!("    \"{}\",\n", kind.name)).collect();
    let keywords: Vec<String> = kinds().map(|kind| format!("    {}: Exact | None\n", kind.name)).collect();
    let words: Vec<String> = kinds().map(|kind| format!("- ``{}``: {}.\n", kind.name, kind.about)).collect();
    format!(
        "\"\"\"Requirements as keywords, written by a test from the engine's list.\n\n{}\"\"\"\n\n\
         from __future__ import annotations\n\nfrom typing import TypedDict\n\nfrom ._exact import Exact\n\n\
         REQUIREMENTS = (\n{})\n\"\"\"What may be required beyond stability, named as the program's options.\"\"\"\n\n\n\
         class Requiring(TypedDict, total=False):\n    \"\"\"A number for each requirement.\"\"\"\n\n{}",
        words.concat(),
        names.concat(),
        keywords.concat(),
    )
}

/// The rows of the documentation's table.
fn in_the_documentation() -> String {
    let rows = RequirementKind::all().iter().map(|kind| {
        let option = format!("`--{}`", kind.name.replace('_', "-"));
        let (name, about) = (kind.name, kind.about.replace('|', "\\|"));
        format!("| `{name}` | {option} | {about} |\n")
    });
    let rows: String = rows.collect();
    format!("| key | option | what it asks for |\n|---|---|---|\n{rows}")
}

#[test]
fn beside_the_schemas_python_has_the_keywords_of_the_list() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../python/jurist/_requirements.py");
    let (written, made) = (std::fs::read_to_string(path).unwrap_or_default(), in_python());
    publish(path, &written, &made, &made);
}

#[test]
fn beside_the_schemas_the_documentation_has_the_table_of_the_list() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/how-to/margins.md");
    let text = std::fs::read_to_string(path).expect("the page on margins");
    let made = in_the_documentation();
    let [before, written, after] = between(&text, "<!-- requirements", "<!-- end of requirements");
    publish(path, written, &made, &format!("{before}{made}{after}"));
}

#[test]
fn each_requirement_stands_at_the_place_of_its_key() {
    let names: Vec<&str> = RequirementKind::all().iter().map(|kind| kind.name).collect();
    assert_eq!(names, ALL.iter().map(|key| key.name).collect::<Vec<_>>());
}
