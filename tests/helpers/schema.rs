//! Documents against the published JSON Schemas: a reader of the keywords that these use, and of no others.

use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The folder of the schemas.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("schema")
}

/// Whether a document fits the schema that it names, or where it does not. Keys that the schema does not know do not fit.
pub fn fits(document: &Value) -> Result<(), String> {
    let name = document["schema"].as_str().ok_or("the document names no schema")?;
    let file = format!("{}.schema.json", name.trim_start_matches("jurist/").replace('/', "-"));
    let text = std::fs::read_to_string(folder().join(&file)).map_err(|e| format!("{file}: {e}"))?;
    let root: Value = serde_json::from_str(&text).expect("a schema is JSON");
    Schema { root: &root }.whole(document, &root, name)
}

struct Schema<'a> {
    root: &'a Value,
}

impl Schema<'_> {
    /// A value with all its keys.
    fn whole(&self, value: &Value, schema: &Value, place: &str) -> Result<(), String> {
        let known = self.part(value, schema, place)?;
        let keys = value.as_object().into_iter().flat_map(|object| object.keys());
        match keys.into_iter().find(|key| !known.contains(*key)) {
            Some(key) => Err(format!("{place}: the key '{key}' is not in the schema")),
            None => Ok(()),
        }
    }

    /// The keys of a value that a schema knows.
    fn part(&self, value: &Value, schema: &Value, place: &str) -> Result<BTreeSet<String>, String> {
        let mut known = BTreeSet::new();
        let refuse = |what: &dyn std::fmt::Display| Err(format!("{place}: {what} does not allow {value}"));
        for (keyword, rule) in schema.as_object().expect("a schema is an object") {
            let list = rule.as_array().map(Vec::as_slice).unwrap_or_default();
            let bound = rule.as_u64();
            let items = value.as_array().map(Vec::as_slice);
            match keyword.as_str() {
                "$schema" | "$defs" | "title" | "description" | "format" => {}
                "$ref" => {
                    let pointer = rule.as_str().and_then(|r| r.strip_prefix('#')).expect("a place in this schema");
                    let target = self.root.pointer(pointer).expect("the schema has what it refers to");
                    known.append(&mut self.part(value, target, place)?);
                }
                "type" => {
                    let is = |name: &Value| match name.as_str().expect("a type has a name") {
                        "object" => value.is_object(),
                        "array" => value.is_array(),
                        "string" => value.is_string(),
                        "integer" => value.is_u64() || value.is_i64(),
                        "number" => value.is_number(),
                        "boolean" => value.is_boolean(),
                        "null" => value.is_null(),
                        other => panic!("the type {other}"),
                    };
                    if !(is_one_of(rule, is)) {
                        return refuse(rule);
                    }
                }
                "const" if value != rule => return refuse(rule),
                "enum" if !list.contains(value) => return refuse(rule),
                "const" | "enum" => {}
                "pattern" => {
                    assert_eq!(rule, "^-?[0-9]+(/[0-9]+)?$", "the only pattern");
                    if value.as_str().is_some_and(|text| !is_exact(text)) {
                        return refuse(rule);
                    }
                }
                "minimum" if value.as_f64().is_some_and(|v| Some(v) < rule.as_f64()) => return refuse(rule),
                "minimum" => {}
                "minItems" if items.is_some_and(|items| (items.len() as u64) < bound.unwrap()) => return refuse(rule),
                "maxItems" if items.is_some_and(|items| (items.len() as u64) > bound.unwrap()) => return refuse(rule),
                "minItems" | "maxItems" => {}
                "prefixItems" => {
                    for (i, (item, schema)) in items.unwrap_or_default().iter().zip(list).enumerate() {
                        self.whole(item, schema, &format!("{place}[{i}]"))?;
                    }
                }
                "items" => {
                    assert!(schema.get("prefixItems").is_none(), "all items by one schema");
                    for (i, item) in items.unwrap_or_default().iter().enumerate() {
                        self.whole(item, rule, &format!("{place}[{i}]"))?;
                    }
                }
                "properties" => {
                    for (key, schema) in rule.as_object().expect("properties by name") {
                        if let Some(value) = value.get(key) {
                            self.whole(value, schema, &format!("{place}.{key}"))?;
                            known.insert(key.clone());
                        }
                    }
                }
                "additionalProperties" => {
                    let named = schema.get("properties").and_then(Value::as_object);
                    let others = |key: &String| named.is_none_or(|names| !names.contains_key(key));
                    for (key, value) in value.as_object().into_iter().flatten().filter(|(key, _)| others(key)) {
                        self.whole(value, rule, &format!("{place}.{key}"))?;
                        known.insert(key.clone());
                    }
                }
                "required" => {
                    let missing = |key: &&Value| value.get(key.as_str().expect("a key")).is_none();
                    if let Some(key) = list.iter().find(missing).filter(|_| value.is_object()) {
                        return Err(format!("{place}: the key {key} is missing"));
                    }
                }
                "anyOf" | "oneOf" => {
                    let all = list.iter().map(|schema| self.part(value, schema, place));
                    let (fitting, refused): (Vec<_>, Vec<_>) = all.partition(Result::is_ok);
                    if fitting.is_empty() || keyword == "oneOf" && fitting.len() > 1 {
                        let why: Vec<String> = refused.into_iter().filter_map(Result::err).collect();
                        return Err(format!("{place}: {} alternatives fit: {}", fitting.len(), why.join("; ")));
                    }
                    known.extend(fitting.into_iter().flatten().flatten());
                }
                "allOf" => {
                    for schema in list {
                        known.append(&mut self.part(value, schema, place)?);
                    }
                }
                other => panic!("{place}: the keyword {other}"),
            }
        }
        Ok(known)
    }
}

/// One name or a list of names.
fn is_one_of(rule: &Value, is: impl Fn(&Value) -> bool) -> bool {
    match rule {
        Value::Array(names) => names.iter().any(is),
        name => is(name),
    }
}

/// `p/q` or an integer.
fn is_exact(text: &str) -> bool {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    let unsigned = text.strip_prefix('-').unwrap_or(text);
    unsigned.split_once('/').map_or(digits(unsigned), |(p, q)| digits(p) && digits(q))
}
