//! What `[require]` says: requirements as texts, which are understood when they are asked for.

use super::keys;
use super::model_file::section;
use super::reader::Reader;
use crate::definition::RequirementText;
use crate::text::toml_value::{Kind, Table};

/// Reads the section, if there is one.
pub(super) fn read(root: &Table, reader: &mut Reader) -> Vec<RequirementText> {
    section(root, "require", reader).map(|table| texts(table, reader)).unwrap_or_default()
}

/// The requirements of a table.
pub(super) fn texts(table: &Table, reader: &mut Reader) -> Vec<RequirementText> {
    reader.unknown_keys(table, &keys::REQUIRE, "[require]");
    let mut out = Vec::new();
    for entry in table.iter().filter(|e| keys::REQUIRE.iter().any(|key| key.name == e.key)) {
        let what = format!("'{}'", entry.key);
        let text = match &entry.value.kind {
            Kind::Number(_) if entry.key != "at" => reader.number(&entry.value, &what).map(|number| number.to_string()),
            _ => reader.string(&entry.value, &what).map(|text| text.as_str().to_owned()),
        };
        if let Some(text) = text {
            out.push(RequirementText { name: entry.key.clone(), text, span: entry.value.span });
        }
    }
    out
}
