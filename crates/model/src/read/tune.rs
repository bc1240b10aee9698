//! What `[tune]` says, which is understood when it is asked for.

use super::keys;
use super::model_file::section;
use super::reader::Reader;
use super::ship::{flag, word};
use crate::definition::{Model, Name};
use crate::error::{Code, Diagnostic};
use crate::text::names::{did_you_mean, known_names, shorten};
use crate::text::toml_value::{Entry, Kind, Table};
use crate::tuning::Tuning;
use jurist_algebra::number::Rational;

/// Reads the section, if there is one.
pub(super) fn read(root: &Table, reader: &mut Reader) -> Option<Tuning> {
    let table = section(root, "tune", reader)?;
    reader.unknown_keys(table, &keys::TUNE, "[tune]");
    let bounds = section(table, "bounds", reader).map(Table::iter);
    let ranges = section(table, "for_all", reader).map(Table::iter);
    let loss = table.get("loss").and_then(|value| {
        let text = match &value.kind {
            Kind::Number(_) => reader.number(value, "'loss'").map(|number| number.to_string()),
            _ => reader.string(value, "'loss'").map(|text| text.as_str().to_owned()),
        };
        Some(Name { name: text?, span: value.span })
    });
    Some(Tuning {
        span: root.entry("tune").map(|entry| entry.key_span).unwrap_or_default(),
        free: free(table, reader),
        bounds: bounds.into_iter().flatten().filter_map(|entry| bound(entry, "the bounds", reader)).collect(),
        objective: word(table, "objective", reader),
        gap: table.get("gap").and_then(|value| reader.number(value, "'gap'")),
        loss,
        for_all: ranges.into_iter().flatten().filter_map(|entry| bound(entry, "the range", reader)).collect(),
        robust: flag(table, "robust", reader),
    })
}

fn free(table: &Table, reader: &mut Reader) -> Vec<Name> {
    let Some(value) = table.get("free") else { return Vec::new() };
    let items = match &value.kind {
        Kind::Array(items) => items.as_slice(),
        _ => std::slice::from_ref(value),
    };
    let mut one = |item: &crate::text::toml_value::Value| {
        let text = reader.string(item, "a name of 'free'")?;
        Some(Name { name: text.as_str().to_owned(), span: item.span })
    };
    items.iter().filter_map(&mut one).collect()
}

fn bound(entry: &Entry, of: &str, reader: &mut Reader) -> Option<(Name, [Rational; 2])> {
    let what = format!("{of} of '{}'", shorten(&entry.key));
    let Kind::Array(items) = &entry.value.kind else {
        reader.wrong_type(&entry.value, &what, "an array of two numbers");
        return None;
    };
    let [low, high] = items.as_slice() else {
        let error = Diagnostic::error(Code::Size, format!("{what}: two numbers are needed"))
            .at(entry.value.span, "not two numbers");
        reader.report(error.help("for one end alone give the name a domain: 'min' or 'max'"));
        return None;
    };
    let ends = [reader.number(low, &what)?, reader.number(high, &what)?];
    Some((Name { name: entry.key.clone(), span: entry.key_span }, ends))
}

/// Reports names that the model does not have.
pub(super) fn check(model: &Model, reader: &mut Reader) {
    let Some(tuning) = &model.tuning else { return };
    let parameters = model.parameters.iter().map(|p| p.name.as_str());
    let known: Vec<&str> = parameters.chain(model.constants.iter().map(|c| c.name.as_str())).collect();
    let names = tuning.free.iter().chain(tuning.bounds.iter().chain(&tuning.for_all).map(|(name, _)| name));
    for name in names.filter(|name| !known.contains(&name.name.as_str())) {
        let message = format!("'{}' is no parameter and no constant", shorten(&name.name));
        let mut error = Diagnostic::error(Code::UnknownName, message).at(name.span, "unknown");
        error.help = did_you_mean(&name.name, known.iter().copied()).or_else(|| known_names(known.iter().copied()));
        reader.report(error);
    }
}
