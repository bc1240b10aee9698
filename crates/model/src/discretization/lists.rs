//! What is written elsewhere from the list of methods: Python's type, and a table of the documentation.

use super::LIST;
use crate::published::{between, publish};

#[test]
fn beside_the_schemas_python_has_the_methods_of_the_list() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../python/jurist/_methods.py");
    let names: Vec<String> = LIST.iter().map(|method| format!("\"{}\"", method.name)).collect();
    let made = format!(
        "\"\"\"Methods of discretisation, written by a test from the engine's list.\"\"\"\n\n\
         from __future__ import annotations\n\nfrom typing import Literal\n\n\
         Method = Literal[{}]\n\"\"\"By which rule or hold a continuous block is made discrete.\"\"\"\n",
        names.join(", ")
    );
    publish(path, &std::fs::read_to_string(path).unwrap_or_default(), &made, &made);
}

#[test]
fn beside_the_schemas_the_documentation_has_the_methods_of_the_list() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/how-to/hold.md");
    let text = std::fs::read_to_string(path).expect("the page on holds");
    let row = |method: &&super::Method| {
        let keys: Vec<String> = method.keys.iter().map(|key| format!("`{key}`")).collect();
        format!("| `{}` | {} | {} | {} |\n", method.name, method.words, method.about, keys.join(", "))
    };
    let rows: String = LIST.iter().map(row).collect();
    let made = format!("| method | | what it does | keys beside `T` |\n|---|---|---|---|\n{rows}");
    let [before, written, after] = between(&text, "<!-- methods", "<!-- end of methods");
    publish(path, written, &made, &format!("{before}{made}{after}"));
}
