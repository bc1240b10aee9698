//! `discretize` of a block: the rule or the hold by which a continuous block becomes discrete.

use super::keys;
use super::pulses::pulses;
use super::reader::Reader;
use crate::definition::Discretization;
use crate::discretization::Method;
use crate::error::{Code, Diagnostic, Span};
use crate::text::Expression;
use crate::text::Text;
use crate::text::names::{did_you_mean, list, shorten};
use crate::text::toml_value::{Entry, Kind, Table};

/// The keys that some methods have, with what to do where another method is asked for.
const METHOD_KEYS: [(&str, &str); 7] = [
    ("c", "leave it out"),
    ("prewarp", "leave it out"),
    ("delay", "add a block with 'delay' for whole samples"),
    ("frame", "a plant is held in another frame by discretize = { method = \"zoh\", frame = \"..\" }"),
    ("advance", "leave it out"),
    ("edge", "leave it out"),
    ("duty", "leave it out"),
];

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
        Kind::String(word) => {
            let method = method(word, reader)?;
            if method.is_modulated() {
                let help = format!("discretize = {{ method = \"{}\", edge = \"trailing\", duty = 0.5 }}", method.name);
                reader.report(wrong("a modulator has an edge and a duty ratio", word.span(), "incomplete", &help));
                return None;
            }
            Discretization {
                method,
                sample_time: None,
                is_sample_time_of_loop: false,
                factor: None,
                prewarp: None,
                delay: None,
                frame: None,
                advance: None,
                pulses: None,
                span: entry.key_span,
            }
        }
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
    Some(Discretization { sample_time: Some(sample_time.clone()), is_sample_time_of_loop: true, ..found })
}

fn method(word: &Text, reader: &mut Reader) -> Option<&'static Method> {
    let text = word.as_str();
    let method = Method::named(text);
    if method.is_none() {
        let known = || format!("known: {}", list(keys::METHODS));
        let meant = Method::written(&text.to_lowercase()).or_else(|| did_you_mean(text, keys::METHODS));
        let help = meant.unwrap_or_else(known);
        reader.report(wrong(&format!("unknown method '{}'", shorten(text)), word.span(), "not known", &help));
    }
    method
}

fn from_table(entry: &Entry, table: &Table, reader: &mut Reader) -> Option<Discretization> {
    let meant = reader.unknown_keys(table, &keys::DISCRETIZE, "'discretize'");
    let Some(value) = table.get("method") else {
        if !meant.includes("method") {
            let rules = Method::all().iter().filter(|method| !method.is_hold());
            let rules: Vec<String> = rules.map(|rule| format!("\"{}\"", rule.name)).collect();
            let help = &format!("give method = \"zoh\" for a plant behind a hold, or {}", rules.join(", "));
            reader.report(wrong("'discretize' has no 'method'", entry.key_span, "by which rule?", help));
        }
        return None;
    };
    let word = reader.string(value, "'method'")?;
    let method = method(word, reader)?;
    let before = reader.errors();
    for (key, help) in METHOD_KEYS {
        if let Some(entry) = table.entry(key).filter(|_| !method.has_key(key)) {
            let message = format!("'{key}' belongs to {}", Method::with_key(key));
            reader.report(wrong(&message, entry.key_span, "has no meaning here", help));
        }
    }
    if let (Some(c), Some(prewarp)) = (table.entry("c"), table.entry("prewarp")) {
        let error =
            wrong("'prewarp' and 'c' say the same thing", prewarp.key_span, "given here", "leave one of them out");
        reader.report(error.also(c.key_span, "and here"));
    }
    let mut part = |key: &str| table.get(key).and_then(|v| reader.expression(v, &format!("'{key}'")));
    let (sample_time, factor, prewarp, delay) = (part("T"), part("c"), part("prewarp"), part("delay"));
    let (frame, advance) = (part("frame"), part("advance"));
    if let (Some(entry), None) = (table.entry("advance"), table.entry("frame"))
        && !meant.includes("frame")
    {
        let error = Diagnostic::error(Code::Frame, "'advance' turns a command ahead into a frame that is not given");
        let error = error.at(entry.key_span, "into which frame?");
        reader.report(error.help("give the speed of the controller's frame: frame = \"omega_e\""));
    }
    let pulses = if method.is_modulated() { pulses(entry, table, &meant, reader) } else { None };
    if let Some(time) = table.entry("T").filter(|_| method.is_modulated()) {
        let help = "leave it out: there is one pulse in each sample time of the loop";
        reader.report(wrong("a modulator has no sample time of its own", time.key_span, "has no meaning here", help));
    }
    if reader.errors() > before {
        return None;
    }
    if let (Some(time), Some(_)) = (table.entry("T"), &factor) {
        reader.unused("'T' says nothing beside 'c': the rule is s = c (z-1)/(z+1)", time.key_span);
    }
    Some(Discretization {
        method,
        sample_time,
        is_sample_time_of_loop: false,
        factor,
        prewarp,
        delay,
        frame,
        advance,
        pulses,
        span: entry.key_span,
    })
}
