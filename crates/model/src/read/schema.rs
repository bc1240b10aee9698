//! The JSON schema of model files, from the keys that the reader knows.

use super::keys::{CONSTANT, Key, METHODS, MODEL, PARAMETER, Shape, TOLERANCE};
use crate::discretization::Method;
use serde_json::{Map, Value, json};

/// The JSON schema (draft 7) of model files, for editors and checkers of TOML: made of the same lists of keys that the
/// reader uses. It says what stands where; whether names are defined and expressions well formed, only the reader knows.
///
/// ```
/// let schema = jurist_model::schema();
/// assert_eq!(schema["properties"]["time"]["enum"], serde_json::json!(["discrete", "continuous"]));
/// ```
pub fn schema() -> Value {
    let mut schema = table(&MODEL);
    let head = [
        ("$schema", json!("http://json-schema.org/draft-07/schema#")),
        ("title", json!("jurist model")),
        ("description", json!("A control loop: constants, parameters, and the loop in one of four forms")),
    ];
    let mut out: Map<String, Value> = head.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    out.append(&mut schema);
    Value::Object(out)
}

/// An object with these keys and no others.
fn table(keys: &[Key]) -> Map<String, Value> {
    let mut properties = Map::new();
    for key in keys {
        let mut property = shape(&key.shape);
        let about = match key.shape {
            Shape::Method => Method::all()
                .iter()
                .fold(key.about.to_owned(), |text, method| format!("{text}; {}: {}", method.name, method.about)),
            _ => key.about.to_owned(),
        };
        property.insert("description".into(), about.into());
        properties.insert(key.name.into(), property.into());
    }
    let needed: Vec<&str> = keys.iter().filter(|k| k.is_needed).map(|k| k.name).collect();
    let mut out = object(json!({ "type": "object", "properties": properties, "additionalProperties": false }));
    if !needed.is_empty() {
        out.insert("required".into(), needed.into());
    }
    out
}

fn shape(shape: &Shape) -> Map<String, Value> {
    // Without alternatives in the schema, so that what does not fit is named by its own place.
    let number = || json!({ "type": ["number", "string"] });
    object(match shape {
        Shape::Text => json!({ "type": "string" }),
        Shape::OneOf(words) => json!({ "enum": words }),
        Shape::Method => json!({ "enum": METHODS }),
        Shape::Number | Shape::Expression => number(),
        Shape::Interval => json!({ "type": "array", "items": number(), "minItems": 2, "maxItems": 2 }),
        Shape::Flag => json!({ "type": "boolean" }),
        Shape::Expressions => json!({ "type": ["number", "string", "array"], "items": number() }),
        Shape::OneOrEach(words) => {
            json!({ "type": ["string", "array"], "items": { "type": "string", "enum": words } })
        }
        Shape::Names => json!({ "type": ["string", "array"], "items": { "type": "string" } }),
        Shape::Matrix => {
            json!({ "type": ["array", "string"], "items": { "type": "array", "items": number() } })
        }
        Shape::Constant => {
            let mut constant = table_or(&CONSTANT, &["number", "string", "array"]);
            constant.insert("items".into(), json!({ "type": "array", "items": number() }));
            return constant;
        }
        Shape::TableOrWord(keys) => return table_or(keys, &["string"]),
        Shape::TableOrNumber(keys) => return table_or(keys, &["number", "string"]),
        Shape::TableOrFlag(keys) => return table_or(keys, &["boolean"]),
        Shape::Parameter => return table_or(&PARAMETER, &["number", "string"]),
        Shape::Tolerance => {
            let mut tolerance = table_or(&TOLERANCE, &["number", "string", "array"]);
            tolerance.insert("items".into(), number());
            return tolerance;
        }
        Shape::Named(values) => json!({ "type": "object", "additionalProperties": self::shape(values) }),
        Shape::Table(keys) => return table(keys),
        Shape::Tables(keys) => json!({ "type": "array", "items": table(keys) }),
    })
}

/// A table with these keys, or a value of these types.
fn table_or(keys: &[Key], types: &[&str]) -> Map<String, Value> {
    let mut out = table(keys);
    let types: Vec<&str> = types.iter().copied().chain(["object"]).collect();
    out.insert("type".into(), json!(types));
    out
}

/// The map of a value that was written as an object.
fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Model;
    use crate::error::Source;
    use std::path::Path;

    #[test]
    fn the_schema_that_is_published_is_the_one_of_the_reader() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema/model.schema.json");
        let made = format!("{}\n", serde_json::to_string_pretty(&schema()).unwrap());
        if std::env::var_os("UPDATE_SCHEMAS").is_some() {
            std::fs::write(&path, &made).unwrap();
        }
        let published = std::fs::read_to_string(&path).unwrap();
        assert_eq!(published, made, "with UPDATE_SCHEMAS=1 this test writes schema/model.schema.json");
    }

    /// Whether a value of TOML fits a schema, as far as these schemas go.
    fn fits(value: &toml::de::DeValue<'_>, schema: &Value) -> bool {
        use toml::de::DeValue;
        if let Some(words) = schema["enum"].as_array() {
            return value.as_str().is_some_and(|text| words.iter().any(|word| word == text));
        }
        let is = |name: &str| match &schema["type"] {
            Value::Array(types) => types.iter().any(|t| t == name),
            one => one == name,
        };
        match value {
            DeValue::String(_) => is("string"),
            DeValue::Integer(_) | DeValue::Float(_) => is("number"),
            DeValue::Array(items) => {
                let is_long_enough = schema["minItems"].as_u64().is_none_or(|least| least <= items.len() as u64);
                let is_short_enough = schema["maxItems"].as_u64().is_none_or(|most| items.len() as u64 <= most);
                let is_of_length = is_long_enough && is_short_enough;
                is("array") && is_of_length && items.iter().all(|item| fits(item.get_ref(), &schema["items"]))
            }
            DeValue::Boolean(_) => is("boolean"),
            DeValue::Table(table) => {
                let required = schema["required"].as_array().cloned().unwrap_or_default();
                is("object")
                    && required.iter().all(|key| key.as_str().is_some_and(|key| table.contains_key(key)))
                    && table.iter().all(|(key, value)| {
                        let property = schema["properties"].get(key.get_ref().as_ref());
                        let property = property.or(schema.get("additionalProperties").filter(|s| s.is_object()));
                        property.is_some_and(|schema| fits(value.get_ref(), schema))
                    })
            }
            _ => false,
        }
    }

    fn text_fits(text: &str) -> bool {
        let (table, errors) = toml::de::DeTable::parse_recoverable(text);
        assert!(errors.is_empty(), "{text}");
        fits(&toml::de::DeValue::Table(table.into_inner()), &schema())
    }

    #[test]
    fn every_example_fits_the_schema_and_names_it() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        let mut models = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "toml") {
                models += 1;
                let text = std::fs::read_to_string(&path).unwrap();
                assert!(text_fits(&text), "{}", path.display());
                assert!(text.starts_with("#:schema ../schema/model.schema.json\n"), "{}", path.display());
            }
        }
        assert!(models > 10);
    }

    #[test]
    fn what_the_schema_refuses_the_reader_refuses() {
        let good = "time = 'discrete'\n[parameters]\nT = { nominal = 1, min = 0 }\nK = 2\n[loop]\ninputs = ['r']\noutputs = ['y']\n\
            [[block]]\ninput = 'r - K*y'\noutput = 'y'\ntransfer = '1/s'\ndiscretize = { method = 'tustin', T = 'T' }\n\
            pwm = { amplitude = 1, carrier = 1, period = 'T' }\n";
        let read = |text: &str| Model::from_toml(&Source::new("model.toml", text)).is_ok();
        assert!(text_fits(good) && read(good));
        for (part, other) in [
            ("time = 'discrete'\n", ""),
            ("'discrete'", "'discret'"),
            ("'discrete'", "1"),
            ("nominal = 1", "nominl = 1"),
            ("nominal = 1", "nominal = [1]"),
            ("K = 2", "K = true"),
            ("K = 2", "K = { domain = 2 }"),
            ("K = 2", "K = { domain = [1, 2, 3] }"),
            ("K = 2", "K = { min = 1, closed = 1 }"),
            ("method = 'tustin', ", ""),
            ("'tustin'", "'tustn'"),
            ("input = 'r - K*y'\n", ""),
            ("output = 'y'\n", ""),
            ("outputs = ['y']", "outputs = [['y']]"),
            ("transfer =", "transfr ="),
            ("period = 'T'", "perid = 'T'"),
            (", period = 'T'", ""),
            ("[[block]]", "[block]"),
        ] {
            let bad = good.replacen(part, other, 1);
            assert_ne!(bad, good, "{part}");
            assert!(!text_fits(&bad), "the schema accepts {other:?} for {part:?}");
            assert!(!read(&bad), "the reader accepts {other:?} for {part:?}");
        }
    }
}
