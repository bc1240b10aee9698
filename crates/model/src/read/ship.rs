//! What `[ship]` says, which is understood when it is asked for.

use super::keys;
use super::model_file::section;
use super::reader::Reader;
use crate::definition::{Diagram, Form, Model, Name};
use crate::error::{Code, Diagnostic};
use crate::shipping::{NumberFormat, Shipping};
use crate::text::names::{did_you_mean, known_names, shorten};
use crate::text::toml_value::{Entry, Kind, Table, Value};
use jurist_algebra::number::Rational;

/// Reads the section, if there is one.
pub(super) fn read(root: &Table, reader: &mut Reader) -> Option<Shipping> {
    let table = section(root, "ship", reader)?;
    reader.unknown_keys(table, &keys::SHIP, "[ship]");
    let bound = |entry: &Entry, reader: &mut Reader| {
        let value = reader.number(&entry.value, &format!("the bound of '{}'", shorten(&entry.key)))?;
        if value.is_negative() {
            let error = Diagnostic::error(Code::Value, "the bound of an input must not be negative");
            reader.report(error.at(entry.value.span, "negative").help("write the bound of its magnitude"));
            return None;
        }
        Some((Name { name: entry.key.clone(), span: entry.key_span }, value))
    };
    let inputs = section(table, "inputs", reader).map(Table::iter);
    let delta = table.get("delta").and_then(|value| Some((reader.number(value, "'delta'")?, value.span)));
    Some(Shipping {
        span: root.entry("ship").map(|entry| entry.key_span).unwrap_or_default(),
        block: word(table, "block", reader),
        realisation: word(table, "realisation", reader),
        format: table.get("format").and_then(|value| number_format(value, "'format'", reader)),
        signal: table.get("signal").and_then(|value| number_format(value, "'signal'", reader)),
        inputs: inputs.into_iter().flatten().filter_map(|entry| bound(entry, reader)).collect(),
        saturate: flag(table, "saturate", reader),
        delta,
    })
}

pub(super) fn word(table: &Table, key: &str, reader: &mut Reader) -> Option<Name> {
    let value = table.get(key)?;
    let text = reader.string(value, &format!("'{key}'"))?;
    Some(Name { name: text.as_str().to_owned(), span: value.span })
}

pub(super) fn flag(table: &Table, key: &str, reader: &mut Reader) -> bool {
    match table.get(key) {
        None => false,
        Some(Value { kind: Kind::Boolean(value), .. }) => *value,
        Some(value) => {
            reader.wrong_type(value, &format!("'{key}'"), "true or false");
            false
        }
    }
}

fn number_format(value: &Value, what: &str, reader: &mut Reader) -> Option<NumberFormat> {
    let table = match &value.kind {
        Kind::String(text) => {
            let word = Some(text.as_str().to_owned());
            return Some(NumberFormat { span: value.span, word, ..NumberFormat::default() });
        }
        Kind::Table(table) => table,
        _ => {
            reader.wrong_type(
                value,
                what,
                "a table such as { bits = 16, fraction = 13 }, or a word such as \"float32\"",
            );
            return None;
        }
    };
    reader.unknown_keys(table, &keys::NUMBER_FORMAT, what);
    let mut number = |key: &str| -> Option<Rational> { reader.number(table.get(key)?, &format!("'{key}'")) };
    let [bits, integer, fraction] = ["bits", "integer", "fraction"].map(&mut number);
    let scale = table.get("scale").and_then(|value| match &value.kind {
        Kind::Number(_) => reader.number(value, "'scale'").map(|number| number.to_string()),
        _ => reader.string(value, "'scale'").map(|text| text.as_str().to_owned()),
    });
    let round = reader.plain_string(table, "round");
    Some(NumberFormat { span: value.span, word: None, bits, integer, fraction, round, scale })
}

/// Reports names that the loop does not have.
pub(super) fn check(model: &Model, reader: &mut Reader) {
    let Some(shipping) = &model.shipping else { return };
    let blocks: Vec<&str> = match &model.form {
        Form::Blocks(Diagram { blocks, .. }) => blocks.iter().map(|block| block.name.as_str()).collect(),
        _ => Vec::new(),
    };
    let inputs: Vec<&str> = model.inputs().iter().map(|name| name.name.as_str()).collect();
    let block = shipping.block.iter().map(|name| (name, &blocks, "block", Code::ShipBlock));
    let bounds = shipping.inputs.iter().map(|(name, _)| (name, &inputs, "input", Code::UnknownName));
    for (name, known, what, code) in
        block.chain(bounds).filter(|(name, known, ..)| !known.contains(&name.name.as_str()))
    {
        let message = format!("unknown {what} '{}'", shorten(&name.name));
        let mut error = Diagnostic::error(code, message).at(name.span, format!("no {what} of the loop"));
        let help = did_you_mean(&name.name, known.iter().copied()).or_else(|| known_names(known.iter().copied()));
        error.help =
            help.or_else(|| Some("[ship] is about a block of a diagram: write the controller as [[block]]".into()));
        reader.report(error);
    }
}
