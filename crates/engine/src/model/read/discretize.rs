//! `discretize` of a block: the rule or the hold by which a continuous block becomes discrete.

use super::keys;
use super::reader::Reader;
use crate::error::{Code, Diagnostic, Span};
use crate::model::definition::{Discretization, Method};
use crate::model::text::Expression;
use crate::model::text::Text;
use crate::model::text::names::{did_you_mean, list, shorten};
use crate::model::text::toml_value::{Entry, Kind, Table};

fn wrong(message: &str, span: Span, label: &str, help: &str) -> Diagnostic {
    Diagnostic::error(Code::Discretize, message).at(span, label).help(help)
}

/// The entry of a block in a loop with this sample time.
pub(super) fn discretize(
    entry: &Entry,
    sample_time: Option<&Expression>,
    reader: &mut Reader,
) -> Option<Discretization> {
    let found = match &entry.value.kind {
        Kind::String(word) => Discretization {
            method: method(word, reader)?,
            sample_time: None,
            factor: None,
            prewarp: None,
            delay: None,
            span: entry.key_span,
        },
        Kind::Table(table) => from_table(entry, table, reader)?,
        _ => {
            reader.wrong_type(&entry.value, "'discretize'", "a table or the name of a method");
            return None;
        }
    };
    if found.sample_time.is_some() || found.factor.is_some() {
        return Some(found);
    }
    let Some(sample_time) = sample_time else {
        let help = "give the loop a sample_time, or the block one: discretize = { method = \"zoh\", T = \"..\" }";
        reader.report(wrong("'discretize' has no sample time", entry.key_span, "how long is a step?", help));
        return None;
    };
    Some(Discretization { sample_time: Some(sample_time.clone()), ..found })
}

fn method(word: &Text, reader: &mut Reader) -> Option<Method> {
    let text = word.as_str();
    let method = Method::named(text);
    if method.is_none() {
        let known = || format!("known: {}", list(keys::METHODS));
        let help = match text.to_lowercase().as_str() {
            "zero-order hold" | "zero-order-hold" | "zero order hold" | "hold" => "write \"zoh\"".into(),
            "first-order hold" | "triangle" => "write \"foh\"".into(),
            "bilinear" | "trapezoidal" | "prewarp" => "write \"tustin\"; prewarp = \"w\" is a key beside it".into(),
            "euler" => "write \"forward\" or \"backward\"".into(),
            _ => did_you_mean(text, keys::METHODS).unwrap_or_else(known),
        };
        reader.report(wrong(&format!("unknown method '{}'", shorten(text)), word.span(), "not known", &help));
    }
    method
}

fn from_table(entry: &Entry, table: &Table, reader: &mut Reader) -> Option<Discretization> {
    let meant = reader.unknown_keys(table, &keys::DISCRETIZE, "'discretize'");
    let Some(value) = table.get("method") else {
        if !meant.includes("method") {
            let help = "give method = \"zoh\" for a plant behind a hold, or \"tustin\", \"forward\", \"backward\"";
            reader.report(wrong("'discretize' has no 'method'", entry.key_span, "by which rule?", help));
        }
        return None;
    };
    let word = reader.string(value, "'method'")?;
    let method = method(word, reader)?;
    let before = reader.errors();
    for (key, holds) in [("c", false), ("prewarp", false), ("delay", true)] {
        let belongs = if holds { method.is_hold() } else { method == Method::Tustin };
        if let Some(entry) = table.entry(key).filter(|_| !belongs) {
            let (message, help) = if holds {
                ("'delay' belongs to the methods 'zoh' and 'foh'", "add a block with 'delay' for whole samples")
            } else {
                (
                    if key == "c" {
                        "'c' belongs to the method 'tustin'"
                    } else {
                        "'prewarp' belongs to the method 'tustin'"
                    },
                    "leave it out",
                )
            };
            reader.report(wrong(message, entry.key_span, "has no meaning here", help));
        }
    }
    if let (Some(c), Some(prewarp)) = (table.entry("c"), table.entry("prewarp")) {
        let error =
            wrong("'prewarp' and 'c' say the same thing", prewarp.key_span, "given here", "leave one of them out");
        reader.report(error.also(c.key_span, "and here"));
    }
    let mut part = |key: &str| table.get(key).and_then(|v| reader.expression(v, &format!("'{key}'")));
    let (sample_time, factor, prewarp, delay) = (part("T"), part("c"), part("prewarp"), part("delay"));
    if reader.errors() > before {
        return None;
    }
    if let (Some(time), Some(_)) = (table.entry("T"), &factor) {
        reader.unused("'T' says nothing beside 'c': the rule is s = c (z-1)/(z+1)", time.key_span);
    }
    Some(Discretization { method, sample_time, factor, prewarp, delay, span: entry.key_span })
}
