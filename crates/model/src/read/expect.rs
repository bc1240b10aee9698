//! `[[expect]]`: what is expected of the loop, in a model file or in a file of its own.

use super::keys;
use super::reader::Reader;
use crate::definition::{Name, RequirementText};
use crate::error::{Code, Diagnostic, Diagnostics, Severity, Source, Span};
use crate::expectation::{Claim, ClaimKind, Expectation};
use crate::text::names::did_you_mean;
use crate::text::toml_reader;
use crate::text::toml_value::{Entry, Kind, Table, Value};
use crate::tolerance::Tolerance;
use jurist_algebra::number::Rational;
use std::sync::Arc;

impl Expectation {
    /// Whether a text is a file of expectations, not a model: it has no other keys.
    ///
    /// Cost: that of reading the text as TOML.
    pub fn is_a_file_of(text: &str) -> bool {
        let is_known = |entry: &Entry| keys::EXPECTATIONS.iter().any(|key| key.name == entry.key);
        toml_reader::read(text).is_ok_and(|root| root.entry("expect").is_some() && root.iter().all(is_known))
    }

    /// Whether a text expects or requires something. Of a text that is not TOML this is so where it seems so: its reader says what is wrong.
    ///
    /// Cost: that of reading the text as TOML.
    pub fn are_in(text: &str) -> bool {
        let keys = ["expect", "require"];
        match toml_reader::read(text) {
            Ok(root) => keys.iter().any(|key| root.entry(key).is_some()),
            Err(_) => keys.iter().any(|key| text.contains(key)),
        }
    }

    /// Reads a file of expectations: entries `[[expect]]`, each about the model file that its key `model` names, or that of the whole file.
    ///
    /// ```
    /// use jurist_model::error::Source;
    /// use jurist_model::Expectation;
    /// let text = "model = 'loop.toml'\n[[expect]]\nverdict = 'stable'\n";
    /// let read = Expectation::from_toml(&Source::new("jurist-tests.toml", text))?;
    /// assert_eq!(read[0].model.as_ref().unwrap().0, "loop.toml");
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    ///
    /// Cost: linear in the text, but for the conversion of its numbers.
    ///
    /// # Errors
    /// Everything that is wrong with the text, with its place.
    pub fn from_toml(source: &Arc<Source>) -> Result<Vec<Expectation>, Diagnostics> {
        let fail = |diagnostics| Diagnostics::new(Some(Arc::clone(source)), diagnostics);
        let root = toml_reader::read(&source.text).map_err(fail)?;
        let mut reader = Reader::default();
        reader.unknown_keys(&root, &keys::EXPECTATIONS, "a file of expectations");
        let [model, cases] = ["model", "cases"].map(|key| file(&root, key, &mut reader));
        let mut read = read(&root, source, &mut reader);
        for expectation in &mut read {
            expectation.model = expectation.model.take().or_else(|| model.clone());
            expectation.cases = expectation.cases.take().or_else(|| cases.clone());
            if expectation.model.is_none() {
                let error = Diagnostic::error(Code::Missing, "the expectation does not say of which model");
                let error = error.at(expectation.span, "no 'model' here");
                reader.report(error.help("add model = \"FILE\" here, or above all of them"));
            }
        }
        let mut errors = reader.diagnostics;
        errors.retain(|d| d.severity == Severity::Error);
        if errors.is_empty() { Ok(read) } else { Err(fail(errors)) }
    }
}

/// The entries of a model file, which speak of itself.
pub(super) fn of_model(root: &Table, source: &Arc<Source>, reader: &mut Reader) -> Vec<Expectation> {
    let read = read(root, source, reader);
    for (_, span) in read.iter().filter_map(|expectation| expectation.model.as_ref()) {
        let error = Diagnostic::error(Code::UnknownKey, "'model' does not go with [[expect]] of a model file");
        reader.report(error.at(*span, "another file").help("in a file of its own, such as jurist-tests.toml, it does"));
    }
    read
}

fn read(root: &Table, source: &Arc<Source>, reader: &mut Reader) -> Vec<Expectation> {
    let Some(entry) = root.entry("expect") else { return Vec::new() };
    let Kind::Array(items) = &entry.value.kind else {
        let error = Diagnostic::error(Code::Type, "an expectation is an entry of an array of tables");
        reader.report(error.at(entry.key_span, "not an array of tables").help("write [[expect]] with two brackets"));
        return Vec::new();
    };
    items.iter().filter_map(|item| expectation(item, source, reader)).collect()
}

fn expectation(value: &Value, source: &Arc<Source>, reader: &mut Reader) -> Option<Expectation> {
    let Kind::Table(table) = &value.kind else {
        reader.wrong_type(value, "an expectation", "a table");
        return None;
    };
    let meant = reader.unknown_keys(table, &keys::EXPECT, "[[expect]]");
    let before = reader.errors();
    let set = super::model_file::section(table, "set", reader).map(Table::iter);
    let set: Vec<(Name, Rational)> = set.into_iter().flatten().filter_map(|entry| assigned(entry, reader)).collect();
    let mut claims = Vec::new();
    for entry in table.iter() {
        claims.extend(claim(entry, table, reader));
    }
    if claims.is_empty() && reader.errors() == before && !keys::CLAIMS.iter().any(|key| meant.includes(key)) {
        let error = Diagnostic::error(Code::Missing, "the expectation says nothing of the loop");
        let error = error.at(value.span, "no claim");
        reader.report(error.help("add one of: verdict, stable, lower, upper, require, tolerance, certificate"));
    }
    Some(Expectation {
        name: reader.plain_string(table, "name"),
        source: Arc::clone(source),
        span: value.span,
        model: file(table, "model", reader),
        cases: file(table, "cases", reader),
        set,
        claims,
    })
}

fn file(table: &Table, key: &str, reader: &mut Reader) -> Option<(String, Span)> {
    let value = table.get(key)?;
    let text = reader.string(value, &format!("'{key}'"))?;
    Some((text.as_str().to_owned(), value.span))
}

fn assigned(entry: &Entry, reader: &mut Reader) -> Option<(Name, Rational)> {
    let value = reader.number(&entry.value, &format!("the value of '{}'", entry.key))?;
    Some((Name { name: entry.key.clone(), span: entry.key_span }, value))
}

/// The claim of a key, if it makes one.
fn claim(entry: &Entry, table: &Table, reader: &mut Reader) -> Option<Claim> {
    let kind = match entry.key.as_str() {
        "verdict" => verdict(&entry.value, reader)?,
        "stable" => {
            let param = param(entry, table, reader)?;
            let Kind::Array(ends) = &entry.value.kind else {
                reader.wrong_type(&entry.value, "'stable'", "an array of two numbers");
                return None;
            };
            let [low, high] = ends.as_slice() else {
                let error =
                    Diagnostic::error(Code::Size, "a range has two ends").at(entry.value.span, "not two numbers");
                reader.report(
                    error.help("for example stable = [1, 20]; an end that is not there is \"-inf\" or \"inf\""),
                );
                return None;
            };
            let [low, high] = [end(low, "-inf", reader)?, end(high, "inf", reader)?];
            if let (Some(low), Some(high)) = (&low, &high)
                && low > high
            {
                let error = Diagnostic::error(Code::EmptyDomain, "the range is empty");
                reader.report(error.at(entry.value.span, "the lower end is above the upper end"));
                return None;
            }
            ClaimKind::Stable { param, low, high }
        }
        key @ ("lower" | "upper") => {
            let is_upper = key == "upper";
            let param = param(entry, table, reader)?;
            let value = end(&entry.value, if is_upper { "inf" } else { "-inf" }, reader)?;
            ClaimKind::Limit { param, is_upper, value, within: within(entry, table, reader)? }
        }
        "require" => ClaimKind::Require(requirements(&entry.value, reader)?),
        "tolerance" => {
            let factor = reader.number(&entry.value, "'tolerance'")?;
            if !factor.sign().is_gt() {
                let error = Diagnostic::error(Code::Value, "the factor of tolerances is positive");
                reader
                    .report(error.at(entry.value.span, "not positive").help("1 stands for the model's own tolerances"));
                return None;
            }
            ClaimKind::Tolerance(factor)
        }
        "certificate" => ClaimKind::Certificate(reader.string(&entry.value, "'certificate'")?.as_str().to_owned()),
        _ => return None,
    };
    Some(Claim { kind, span: entry.key_span.to(entry.value.span) })
}

fn verdict(value: &Value, reader: &mut Reader) -> Option<ClaimKind> {
    let text = reader.string(value, "'verdict'")?;
    if keys::VERDICTS.contains(&text.as_str()) {
        return Some(ClaimKind::Verdict(text.as_str().to_owned()));
    }
    let mut error = Diagnostic::error(Code::Value, "an expected verdict is a word of verdicts");
    error.help = did_you_mean(text.as_str(), keys::VERDICTS);
    let error = error.at(value.span, "neither \"stable\" nor \"marginal\" nor \"unstable\"");
    reader.report(error);
    None
}

/// The parameter that a claim speaks of.
fn param(entry: &Entry, table: &Table, reader: &mut Reader) -> Option<Name> {
    let Some(value) = table.get("param") else {
        let error = Diagnostic::error(Code::Missing, format!("'{}' does not say of which parameter", entry.key));
        reader.report(error.at(entry.key_span, "no 'param' beside it").help("add param = \"NAME\""));
        return None;
    };
    let text = reader.string(value, "'param'")?;
    Some(Name { name: text.as_str().to_owned(), span: value.span })
}

/// An end: a number, or the word for none.
fn end(value: &Value, infinite: &str, reader: &mut Reader) -> Option<Option<Rational>> {
    let is_infinite = matches!(&value.kind, Kind::String(text) if text.as_str() == infinite);
    if is_infinite {
        return Some(None);
    }
    let is_bare = matches!(&value.kind, Kind::Number(text) if text.trim_start_matches(['+', '-']) == "inf");
    if is_bare || matches!(&value.kind, Kind::String(text) if ["inf", "-inf"].contains(&text.as_str())) {
        let error =
            Diagnostic::error(Code::NotANumber, "an end that is not there is written in quotes, on its own side");
        reader.report(error.at(value.span, "not understood").help(format!("write \"{infinite}\" here, or a number")));
        return None;
    }
    reader.number(value, "an end").map(Some)
}

/// How far a limit may be from the expected one.
fn within(entry: &Entry, table: &Table, reader: &mut Reader) -> Option<Tolerance> {
    let Some(value) = table.get("within") else {
        let error = Diagnostic::error(Code::Missing, format!("'{}' does not say how exactly", entry.key));
        reader.report(
            error.at(entry.key_span, "no 'within' beside it").help("add within = \"1%\", or a width such as 0.01"),
        );
        return None;
    };
    let tolerance: Result<Tolerance, String> = match &value.kind {
        Kind::String(text) => text.as_str().parse(),
        _ => reader.number(value, "'within'").map(Tolerance::Width)?.checked(),
    };
    match tolerance {
        Ok(tolerance @ (Tolerance::Share { .. } | Tolerance::Width(_))) => Some(tolerance),
        Ok(_) => refused("a range of values is no distance", value, reader),
        Err(why) => refused(&why, value, reader),
    }
}

fn refused<T>(why: &str, value: &Value, reader: &mut Reader) -> Option<T> {
    let error =
        Diagnostic::error(Code::Tolerance, format!("this is no distance: {why}")).at(value.span, "not accepted");
    reader.report(error.help("write \"1%\", or a width such as 0.01"));
    None
}

/// A table as `[require]`, or `true` for that of the model alone.
fn requirements(value: &Value, reader: &mut Reader) -> Option<Vec<RequirementText>> {
    match &value.kind {
        Kind::Boolean(true) => Some(Vec::new()),
        Kind::Table(table) => Some(super::require::texts(table, reader)),
        _ => {
            reader.wrong_type(value, "'require'", "a table as [require], or true for that of the model");
            None
        }
    }
}
