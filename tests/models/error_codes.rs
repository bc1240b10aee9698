//! The table of diagnostic codes is complete, and nothing in it is made up.

use crate::helpers::model::path;
use jurist_engine::error::CODES;
use std::collections::BTreeSet;
use std::path::Path;

/// Codes in the sources, as string literals.
fn collect(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("error/codes.rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            for piece in text.split('"') {
                let name = piece.strip_prefix("E-").or_else(|| piece.strip_prefix("W-"));
                if name.is_some_and(|n| {
                    !n.is_empty() && n.bytes().all(|b| b == b'-' || b.is_ascii_lowercase() || b.is_ascii_digit())
                }) {
                    found.insert(piece.to_owned());
                }
            }
        }
    }
}

#[test]
fn the_table_is_complete() {
    let mut used = BTreeSet::new();
    for room in ["src", "crates/engine/src", "crates/check/src"] {
        collect(&path(room), &mut used);
    }
    let listed: BTreeSet<String> = CODES.iter().map(|(code, _)| (*code).to_owned()).collect();
    assert_eq!(used.difference(&listed).collect::<Vec<_>>(), Vec::<&String>::new(), "used but not explained");
    assert_eq!(listed.difference(&used).collect::<Vec<_>>(), Vec::<&String>::new(), "explained but not used");
    assert_eq!(listed.len(), CODES.len());
    assert!(CODES.is_sorted());
    for (code, text) in CODES {
        assert!(text.lines().count() <= 10 && text.len() > 30, "{code}");
    }
}

/// The page of the docs has every code with the explanation that the program prints.
#[test]
fn the_page_of_codes_is_the_table() {
    let page = include_str!("../../crates/engine/src/error/codes.md");
    let mut expected = String::from("Every code that a diagnostic can carry, as `jurist explain CODE` prints it.\n");
    for (code, text) in CODES {
        expected += &format!("\n### {code}\n\n");
        let mut in_model = false;
        for line in text.lines() {
            let model = line.starts_with("    ");
            match (in_model, model) {
                (false, true) => expected += "```text\n",
                (true, false) => expected += "```\n",
                _ => {}
            }
            in_model = model;
            expected += if model { &line[4..] } else { line };
            expected += "\n";
        }
        if in_model {
            expected += "```\n";
        }
    }
    assert_eq!(page.trim_end(), expected.trim_end());
}
