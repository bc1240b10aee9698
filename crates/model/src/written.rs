//! The values of a model as they are written, and the model with another text in the place of one.

use super::Model;
use super::builder::quoted;
use super::definition::Form;
use super::text::toml_reader;
use super::text::toml_value::{Entry, Kind, Table, Value};
use crate::error::{Diagnostic, Diagnostics, Source, Span};

/// The value of a constant, or the nominal value of a parameter, as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Written {
    /// The name.
    pub name: String,
    /// The value in TOML: `0.1`, `"L/R"`, `[[0, 1]]`.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

impl Model {
    /// The values of constants and the nominal values of parameters, in the order of the text.
    ///
    /// Cost: that of reading the text as TOML.
    ///
    /// ```
    /// use jurist_model::error::Source;
    /// use jurist_model::Model;
    /// let text = "time = 'discrete'\n[constants]\nk = 0.50\n[parameters]\nK = { nominal = 'k' }\n[loop]\ncharacteristic = 'z - K'\n";
    /// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
    /// let written: Vec<String> = model.written().into_iter().map(|w| format!("{} = {}", w.name, w.text)).collect();
    /// assert_eq!(written, ["k = 0.50", "K = 'k'"]);
    /// let (other, _) = model.rewritten("k", "2")?;
    /// assert_eq!(other.constant("k").unwrap().number, Some(2.into()));
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    pub fn written(&self) -> Vec<Written> {
        let text = &self.source.text;
        let Ok(root) = toml_reader::read(text) else { return Vec::new() };
        let mut out = Vec::new();
        for (section, key) in [("constants", "value"), ("parameters", "nominal")] {
            let Some(Kind::Table(table)) = root.get(section).map(|v| &v.kind) else { continue };
            for entry in table.iter() {
                if let Some(value) = own_value(&entry.value, key) {
                    let span = value.span;
                    out.push(Written { name: entry.key.clone(), text: text[span.start..span.end].to_owned(), span });
                }
            }
        }
        out.sort_by_key(|written| written.span.start);
        out
    }

    /// The model whose text has another value for a name; the model itself where nothing is written for it.
    ///
    /// Cost: that of [`Model::from_toml`].
    ///
    /// # Errors
    /// As [`Model::from_toml`].
    pub fn rewritten(&self, name: &str, text: &str) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
        let mut whole = self.source.text.clone();
        if let Some(written) = self.written().into_iter().find(|w| w.name == name) {
            whole.replace_range(written.span.start..written.span.end, text);
        }
        Model::from_toml(&Source::new(self.source.name.clone(), whole))
    }
}

/// The keys of a block that say how it is wired and when it is active; the others say what it does.
const WIRING: [&str; 6] = ["name", "input", "output", "every", "phase", "sample_time"];

impl Model {
    /// The text of the model with another dynamic in the place of a block's own, which is given by its keys and their values in TOML. Its wiring
    /// and its rate stay, or are replaced by keys of the same name. `None` for a loop that has no such block.
    ///
    /// Cost: that of reading the text as TOML.
    ///
    /// ```
    /// use jurist_model::error::Source;
    /// use jurist_model::Model;
    /// let text = "time = 'discrete'\n[loop]\n[[block]]\nname = 'c'\ninput = '-y'\noutput = 'y'\ntransfer = '1/(2*z)'\n";
    /// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
    /// let other = model.with_block("c", &[("num", "[1]".into()), ("den", "[4, 0]".into())]).unwrap();
    /// assert!(other.contains("den = [4, 0]") && !other.contains("transfer"));
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    pub fn with_block(&self, name: &str, keys: &[(&str, String)]) -> Option<String> {
        let text = &self.source.text;
        let root = toml_reader::read(text).ok()?;
        let Form::Blocks(diagram) = &self.form else { return None };
        let at = diagram.blocks.iter().position(|block| block.name == name)?;
        let Kind::Array(items) = &root.get("block")?.kind else { return None };
        let item = items.get(at)?;
        let Kind::Table(table) = &item.kind else { return None };
        let is_kept =
            |entry: &&Entry| WIRING.contains(&entry.key.as_str()) && keys.iter().all(|(key, _)| *key != entry.key);
        let kept = table.iter().filter(is_kept).map(|entry| (entry.key.as_str(), written(text, &entry.value)));
        let lines: Vec<String> = kept
            .chain(keys.iter().map(|(key, value)| (*key, value.clone())))
            .map(|(key, value)| format!("{key} = {value}"))
            .collect();
        let mut out = text.clone();
        if text[item.span.start..].starts_with('{') {
            out.replace_range(item.span.start..item.span.end, &format!("{{ {} }}", lines.join(", ")));
        } else {
            let start = text[..item.span.start].rfind('[')?;
            let start = text[..start].rfind('[')?;
            out.replace_range(start..end_of(item), &format!("[[block]]\n{}", lines.join("\n")));
        }
        Some(without_initial(out))
    }

    /// A text of a model in which a section has these keys, each with its value in TOML: in the place of those of the same name, else in addition.
    ///
    /// Cost: that of reading the text as TOML, for each key.
    ///
    /// ```
    /// use jurist_model::Model;
    /// let text = Model::with_keys("[loop]\ninputs = ['r']\n", "loop", &[("inputs", "['r', 'd']".into()), ("outputs", "['y']".into())]);
    /// assert_eq!(text, "[loop]\noutputs = ['y']\ninputs = ['r', 'd']\n");
    /// assert_eq!(Model::with_keys("a = 1\n", "b", &[("c", "2".into())]), "a = 1\n\n[b]\nc = 2\n");
    /// ```
    pub fn with_keys(text: &str, section: &str, keys: &[(&str, String)]) -> String {
        keys.iter().fold(text.to_owned(), |text, (key, value)| with_key(&text, section, key, value))
    }
}

/// The text without initial values of states, whose names another dynamic of a block does not have.
fn without_initial(mut text: String) -> String {
    let root = toml_reader::read(&text).ok();
    let simulation = root.as_ref().and_then(|root| root.get("simulation"));
    let initial = simulation.and_then(|value| match &value.kind {
        Kind::Table(table) => table.get("initial"),
        _ => None,
    });
    let Some(initial) = initial else { return text };
    let (start, end) = (initial.span.start, initial.span.end);
    if text[start..].starts_with('{') {
        text.replace_range(start..end, "{}");
    } else if let Some(header) = text[..start].rfind('[').filter(|at| text[*at..].starts_with("[simulation.initial]")) {
        let end = end_of(initial);
        text.replace_range(header..end, "");
    }
    text
}

/// The text with one key in a section.
fn with_key(text: &str, section: &str, key: &str, value: &str) -> String {
    let root = toml_reader::read(text).ok();
    let entry = root.as_ref().and_then(|root| root.entry(section));
    let mut out = text.to_owned();
    let known = entry.and_then(|entry| match &entry.value.kind {
        Kind::Table(table) => table.get(key),
        _ => None,
    });
    if let Some(known) = known {
        out.replace_range(known.span.start..known.span.end, value);
        return out;
    }
    let key = if key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') { key.to_owned() } else { quoted(key) };
    let line = format!("{key} = {value}");
    if let Some(end) = header_end(text, section) {
        let line_break = if text[..end].ends_with('\n') { "" } else { "\n" };
        out.insert_str(end, &format!("{line_break}{line}\n"));
        return out;
    }
    match entry {
        Some(entry) if text[entry.value.span.start..].starts_with('{') => {
            let is_empty = matches!(&entry.value.kind, Kind::Table(table) if table.iter().next().is_none());
            let comma = if is_empty { "" } else { "," };
            out.insert_str(entry.value.span.start + 1, &format!(" {line}{comma}"));
        }
        Some(entry) if !text[..entry.key_span.start].trim_end_matches([' ', '\t']).ends_with('[') => {
            out.insert_str(entry.key_span.start, &format!("{section}.{line}\n"));
        }
        _ => out.push_str(&format!("\n[{section}]\n{line}\n")),
    }
    out
}

/// Where the line after `[section]` begins.
fn header_end(text: &str, section: &str) -> Option<usize> {
    let mut end = 0;
    for line in text.split_inclusive('\n') {
        end += line.len();
        let name = line.trim_start().strip_prefix('[').and_then(|rest| rest.split_once(']'));
        if name.is_some_and(|(name, _)| name.trim() == section) {
            return Some(end);
        }
    }
    None
}

/// A value as it is written.
fn written(text: &str, value: &Value) -> String {
    text[value.span.start..value.span.end].to_owned()
}

/// Where the last value of a table ends, the tables in it included.
fn end_of(value: &Value) -> usize {
    let inside = match &value.kind {
        Kind::Table(table) => table.iter().map(|entry| end_of(&entry.value)).max(),
        _ => None,
    };
    inside.map_or(value.span.end, |inside| inside.max(value.span.end))
}

/// The value alone, or that under a key of its table.
fn own_value<'v>(value: &'v Value, key: &str) -> Option<&'v Value> {
    match &value.kind {
        Kind::Table(table) => Table::get(table, key),
        _ => Some(value),
    }
}
