//! JSON Schemas of the documents, made of their types.

use super::{
    Analysis, Body, Charpoly, Check, Intervals, Jury, Map, MapBoxes, Margins, Norm, RootLocusForm, Tolerance, Transfer,
    Verdict,
};
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
    fn entry<T: JsonSchema>(name: &'static str) -> (&'static str, Value) {
        (name, schema_of::<T>(name))
    }
    vec![
        entry::<Analysis>("jurist/analyze/1"),
        entry::<Body>("jurist/body/1"),
        entry::<Charpoly>("jurist/charpoly/1"),
        entry::<Check>("jurist/check/1"),
        entry::<Intervals>("jurist/intervals/1"),
        entry::<Jury>("jurist/jury/1"),
        entry::<Map>("jurist/map/1"),
        entry::<MapBoxes>("jurist/map-boxes/1"),
        entry::<Margins>("jurist/margins/1"),
        entry::<Norm>("jurist/norm/1"),
        entry::<RootLocusForm>("jurist/root-locus-form/1"),
        entry::<Tolerance>("jurist/tolerance/1"),
        entry::<Transfer>("jurist/transfer/1"),
        entry::<Verdict>("jurist/verdict/1"),
    ]
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
