//! The value tree of a TOML text, with a place for everything and numbers by their own text.

use super::located::Text;
use crate::error::Span;
use std::collections::HashMap;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub(in crate::model) struct Value {
    pub span: Span,
    pub kind: Kind,
}

/// What a value is.
#[derive(Clone, Debug)]
pub(in crate::model) enum Kind {
    /// A string, decoded.
    String(Text),
    /// A number by its text: sign, digits, point, exponent, without underscores.
    Number(String),
    /// `true` or `false`; no key takes one yet.
    Boolean,
    /// A date or a time; no key takes one.
    DateTime,
    /// `[..]`, or the tables of `[[..]]`.
    Array(Vec<Value>),
    /// A table of any notation.
    Table(Table),
}

impl Value {
    /// What to call the value in a message.
    pub fn describe(&self) -> &'static str {
        match self.kind {
            Kind::String(_) => "a string",
            Kind::Number(_) => "a number",
            Kind::Boolean => "a boolean",
            Kind::DateTime => "a date or time",
            Kind::Array(_) => "an array",
            Kind::Table(_) => "a table",
        }
    }
}

/// Keys in the order of the text.
#[derive(Clone, Debug, Default)]
pub(in crate::model) struct Table {
    entries: Vec<Entry>,
    index: HashMap<String, usize>,
    /// How the table came to be, which decides what may still be added to it.
    pub origin: Origin,
}

/// A key with its value.
#[derive(Clone, Debug)]
pub(in crate::model) struct Entry {
    pub key: String,
    pub key_span: Span,
    pub value: Value,
}

/// How a table came to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::model) enum Origin {
    /// Named only as a part of a longer header; may still get its own header.
    #[default]
    Implicit,
    /// By its own header.
    Header,
    /// By dotted keys; closed to headers.
    Dotted,
    /// Inline; closed.
    Inline,
}

impl Table {
    pub fn new(origin: Origin) -> Self {
        Table { origin, ..Table::default() }
    }

    pub fn get(&self, key: &str) -> Option<&Value> {
        self.entry(key).map(|e| &e.value)
    }

    pub fn entry(&self, key: &str) -> Option<&Entry> {
        self.index.get(key).map(|&i| &self.entries[i])
    }

    pub fn entry_mut(&mut self, key: &str) -> Option<&mut Entry> {
        self.index.get(key).map(|&i| &mut self.entries[i])
    }

    /// Adds a key that is not there yet.
    pub fn insert(&mut self, entry: Entry) {
        self.index.insert(entry.key.clone(), self.entries.len());
        self.entries.push(entry);
    }

    pub fn iter(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter()
    }
}
