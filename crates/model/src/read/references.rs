//! Numbers that stand in other files: `from = "params.h#PID_KP"`. Here they are found in a text and replaced; who asks reads the files.

use super::keys::READINGS;
use super::reader::Reader;
use crate::error::{Code, Diagnostic, Diagnostics, Source, Span};
use crate::text::names::did_you_mean;
use crate::text::toml_reader;
use crate::text::toml_value::{Entry, Kind, Table};
use std::sync::Arc;

/// A constant or a parameter whose number stands in another file.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Reference {
    /// The name of the constant or parameter.
    pub name: String,
    /// The file, relative to the model's folder.
    pub file: String,
    /// What is asked for there: a macro, a constant, a path of keys.
    pub key: String,
    /// Whether a literal of C is to be taken as it is written.
    pub as_decimal: bool,
    /// Where the text of the reference stands in the model.
    pub span: Span,
    /// The key that a number of the model's own would have.
    own_key: &'static str,
    /// What the number takes the place of.
    replaced: Span,
    /// What is left out: the entry `as`.
    left_out: Option<Span>,
}

impl Reference {
    /// The references of a model file, in the order of the text; none where the text is not TOML, which its reader says.
    ///
    /// ```
    /// use jurist_model::error::Source;
    /// use jurist_model::Reference;
    /// let source = Source::new("loop.toml", "[constants]\nK = { from = 'params.h#KP', unit = 'V' }\n");
    /// let found = Reference::all(&source)?;
    /// assert_eq!((found[0].file.as_str(), found[0].key.as_str()), ("params.h", "KP"));
    /// let own = Reference::replaced(&source, &[(found[0].clone(), "1/3".to_owned())]);
    /// assert_eq!(own.text, "[constants]\nK = { value = \"1/3\", unit = 'V' }\n");
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    ///
    /// Cost: that of reading the text as TOML.
    ///
    /// # Errors
    /// `E-from` for a reference that is not `FILE#NAME`, and `E-two-forms` for one that stands beside a number.
    pub fn all(source: &Arc<Source>) -> Result<Vec<Reference>, Diagnostics> {
        if !source.text.contains("from") {
            return Ok(Vec::new());
        }
        let Ok(root) = toml_reader::read(&source.text) else { return Ok(Vec::new()) };
        let (mut found, mut errors) = (Vec::new(), Vec::new());
        for (section, own_key) in [("constants", "value"), ("parameters", "nominal")] {
            let Some(Kind::Table(table)) = root.get(section).map(|v| &v.kind) else { continue };
            for entry in table.iter() {
                match reference(entry, own_key, &source.text) {
                    Some(Ok(reference)) => found.push(reference),
                    Some(Err(error)) => errors.push(error),
                    None => {}
                }
            }
        }
        found.sort_by_key(|reference: &Reference| reference.span.start);
        if errors.is_empty() { Ok(found) } else { Err(Diagnostics::new(Some(Arc::clone(source)), errors)) }
    }

    /// The text with numbers, or formulas of numbers, in the place of references. No line comes or goes, so that places in it are on the
    /// lines of the file.
    pub fn replaced(source: &Source, numbers: &[(Reference, String)]) -> Arc<Source> {
        let mut edits: Vec<(Span, String)> = Vec::new();
        for (reference, number) in numbers {
            edits.push((reference.replaced, format!("{} = \"{number}\"", reference.own_key)));
            edits.extend(reference.left_out.map(|span| (span, String::new())));
        }
        edits.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
        let mut text = source.text.clone();
        for (span, new) in edits {
            text.replace_range(span.start..span.end, &new);
        }
        Source::new(source.name.clone(), text)
    }
}

fn reference(entry: &Entry, own_key: &'static str, text: &str) -> Option<Result<Reference, Diagnostic>> {
    let Kind::Table(table) = &entry.value.kind else { return None };
    let from = table.entry("from")?;
    let span = from.value.span;
    let wrong = |what: &str| {
        let error = Diagnostic::error(Code::From, "'from' says in which file a number stands, and under which name");
        Err(error.at(span, what).help("for example from = \"params.h#PID_KP\" or from = \"gains.yaml#speed.K_p\""))
    };
    let Kind::String(written) = &from.value.kind else { return Some(wrong("not a string")) };
    let Some((file, key)) = written.as_str().split_once('#').filter(|(file, key)| !file.is_empty() && !key.is_empty())
    else {
        return Some(wrong("not FILE#NAME"));
    };
    if let Some(own) = table.entry(own_key) {
        let message = format!("'{}' has a number of its own and one of another file", entry.key);
        let error = Diagnostic::error(Code::TwoForms, message).at(own.key_span, "here").also(from.key_span, "and here");
        return Some(Err(error.help("leave one of them out")));
    }
    let reading = match table.entry("as") {
        Some(entry) if !matches!(&entry.value.kind, Kind::String(text) if READINGS.contains(&text.as_str())) => {
            let error = Diagnostic::error(Code::Value, "'as' says how a literal is read: \"decimal\", or nothing");
            let mut error = error.at(entry.value.span, "not understood");
            if let Kind::String(text) = &entry.value.kind {
                error.help = did_you_mean(text.as_str(), READINGS);
            }
            return Some(Err(error));
        }
        other => other,
    };
    Some(Ok(Reference {
        name: entry.key.clone(),
        file: file.to_owned(),
        key: key.to_owned(),
        as_decimal: reading.is_some(),
        span,
        own_key,
        replaced: from.key_span.to(span),
        left_out: reading.map(|entry| with_its_comma(entry, table, text)),
    }))
}

/// The entry with the comma that parts it from another one, if one does.
fn with_its_comma(entry: &Entry, table: &Table, text: &str) -> Span {
    let own = entry.key_span.to(entry.value.span);
    let others = || table.iter().filter(|e| e.key != entry.key);
    let before = others().map(|e| e.value.span.end).filter(|end| *end <= own.start).max();
    let after = others().map(|e| e.key_span.start).filter(|start| *start >= own.end).min();
    let is_comma = |from: usize, to: usize| text[from..to].trim() == ",";
    match (before, after) {
        (Some(end), _) if is_comma(end, own.start) => Span::new(end, own.end),
        (_, Some(start)) if is_comma(own.end, start) => Span::new(own.start, start),
        _ => own,
    }
}

/// Reports a reference that nobody replaced; true if there is one.
pub(super) fn is_left(table: &Table, reader: &mut Reader) -> bool {
    let keys = ["from", "as"].map(|key| table.entry(key));
    let Some(entry) = keys[0] else {
        if let Some(entry) = keys[1] {
            let error =
                Diagnostic::error(Code::From, "'as' goes with 'from'").at(entry.key_span, "no 'from' beside it");
            reader.report(error.help("a number that stands here is taken as it is written"));
        }
        return false;
    };
    let error = Diagnostic::error(Code::From, "no other file is read here");
    let error = error.at(entry.value.span, "the number stands there");
    reader.report(
        error.help("give the model as a file, or write the number into it ('jurist check MODEL --resolved FILE' does)"),
    );
    true
}
