//! JSON Schemas of the documents, made of their types.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value;
use std::path::Path;

/// The JSON Schema (draft 2020-12) of a document, titled by its kind and version.
pub fn schema_of<T: JsonSchema>(name: &str) -> Value {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut schema = generator.into_root_schema_for::<T>();
    schema.insert("title".to_owned(), name.into());
    schema.to_value()
}

/// The documents of the engine: kind with version, and schema.
pub fn schemas() -> Vec<(&'static str, Value)> {
    super::list::schemas()
}

/// Compares schemas with the files of a folder, `intervals-1.schema.json` for `jurist/intervals/1`, and writes these first if
/// the environment says `UPDATE_SCHEMAS=1`.
///
/// # Panics
/// When a file is not there or differs.
pub fn check_published(folder: &Path, schemas: &[(&str, Value)]) {
    for (name, schema) in schemas {
        let file = name.trim_start_matches("jurist/").replace('/', "-");
        let path = folder.join(format!("{file}.schema.json"));
        let made = super::to_text(schema);
        if std::env::var_os("UPDATE_SCHEMAS").is_some() {
            std::fs::write(&path, &made).expect("the schema is written");
        }
        let published = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(
            published == made,
            "{} differs from its type: UPDATE_SCHEMAS=1 cargo test schemas writes it",
            path.display()
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schemas_that_are_published_are_those_of_the_types() {
        check_published(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema"), &schemas());
    }
}
