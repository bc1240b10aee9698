//! The value tree of a TOML text, with a place for everything and numbers by their own text.

use super::located::Text;
use crate::error::Span;
use std::collections::HashMap;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Value {
    pub span: Span,
    pub kind: Kind,
}

/// What a value is.
#[derive(Clone, Debug)]
pub(crate) enum Kind {
    /// A string, decoded.
    String(Text),
    /// A number by its text: sign, digits, point, exponent, without underscores.
    Number(String),
    /// `true` or `false`.
    Boolean(bool),
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
            Kind::Boolean(_) => "a boolean",
            Kind::DateTime => "a date or time",
            Kind::Array(_) => "an array",
            Kind::Table(_) => "a table",
        }
    }
}

/// Keys in the order of the text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    entries: Vec<Entry>,
    index: HashMap<String, usize>,
}

/// A key with its value.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub key: String,
    pub key_span: Span,
    pub value: Value,
}

impl Table {
    /// The table of these entries, whose keys are distinct.
    pub fn new(entries: Vec<Entry>) -> Self {
        let index = entries.iter().enumerate().map(|(i, e)| (e.key.clone(), i)).collect();
        Table { entries, index }
    }

    pub fn get(&self, key: &str) -> Option<&Value> {
        self.entry(key).map(|e| &e.value)
    }

    pub fn entry(&self, key: &str) -> Option<&Entry> {
        self.index.get(key).map(|&i| &self.entries[i])
    }

    pub fn iter(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter()
    }
}
