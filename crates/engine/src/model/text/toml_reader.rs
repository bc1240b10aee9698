//! TOML text to the value tree, through the events of the `toml_parser` crate.
//!
//! Its events carry places and leave numbers as text, so that no number passes through binary
//! floating point and none is too long.

use super::located::Text;
use super::names::shorten;
use super::toml_value::{Entry, Kind, Origin, Table, Value};
use crate::error::{Diagnostic, Span};
use toml_parser::ParseError;
use toml_parser::decoder::{IntegerRadix, ScalarKind, StringBuilder};
use toml_parser::parser::{Event, EventKind, RecursionGuard, parse_document};

/// Arrays and inline tables may nest this deep.
const MAX_NESTING: u32 = 32;

/// Syntax errors shown of one file.
const MAX_SHOWN: usize = 8;

/// Keys in one header or dotted key.
const MAX_KEY_PARTS: usize = 32;

/// Reads the whole text. Everything that is wrong with it is returned, not only the first.
pub(in crate::model) fn read(text: &str) -> Result<Table, Vec<Diagnostic>> {
    let source = toml_parser::Source::new(text);
    let tokens = source.lex().into_vec();
    let mut events: Vec<Event> = Vec::new();
    let mut errors: Vec<ParseError> = Vec::new();
    parse_document(&tokens, &mut RecursionGuard::new(&mut events, MAX_NESTING), &mut errors);
    for event in &events {
        let Some(raw) = source.get(event) else { continue };
        match event.kind() {
            EventKind::Comment => raw.decode_comment(&mut errors),
            EventKind::Newline => raw.decode_newline(&mut errors),
            _ => {}
        }
    }
    // What follows a syntax error is read in the wrong light: the first one says it best.
    let mut diagnostics: Vec<Diagnostic> = errors.iter().map(|e| syntax_error(e, text)).collect();
    diagnostics.sort_by_key(|d| d.primary.as_ref().map_or(0, |l| l.span.start));
    diagnostics.truncate(1);
    if diagnostics.is_empty() {
        let relevant = |e: &&Event| {
            !matches!(e.kind(), EventKind::Whitespace | EventKind::Comment | EventKind::Newline | EventKind::Error)
        };
        let events: Vec<&Event> = events.iter().filter(relevant).collect();
        let mut reader = Reader { source, text, events: &events, position: 0, diagnostics: Vec::new() };
        let root = reader.document();
        diagnostics = reader.diagnostics;
        if diagnostics.is_empty() {
            return Ok(root);
        }
    }
    diagnostics.sort_by_key(|d| d.primary.as_ref().map_or(0, |l| l.span.start));
    diagnostics.truncate(MAX_SHOWN);
    Err(diagnostics)
}

fn span_of(span: toml_parser::Span) -> Span {
    Span::new(span.start(), span.end())
}

fn syntax_error(error: &ParseError, text: &str) -> Diagnostic {
    use toml_parser::Expected;
    let place = error.unexpected().or(error.context()).map_or(Span::new(text.len(), text.len()), span_of);
    let mut label = String::new();
    for expected in error.expected().unwrap_or_default() {
        label.push_str(if label.is_empty() { "expected " } else { " or " });
        match expected {
            Expected::Literal("\n") => label.push_str("a new line"),
            Expected::Literal(literal) => label.push_str(&format!("'{}'", literal.escape_debug())),
            Expected::Description(description) => label.push_str(description),
            _ => label.push_str("something else"),
        }
    }
    if label.is_empty() {
        label.push_str("here");
    }
    let message = format!("not valid TOML: {}", error.description());
    let diagnostic = Diagnostic::error("E-toml", message).at(place, label);
    if error.description().contains("recur") {
        return Diagnostic { code: "E-too-deep", ..diagnostic };
    }
    diagnostic
}

struct Reader<'t> {
    source: toml_parser::Source<'t>,
    text: &'t str,
    events: &'t [&'t Event],
    position: usize,
    diagnostics: Vec<Diagnostic>,
}

/// One part of a key.
struct Part {
    name: String,
    span: Span,
}

impl<'t> Reader<'t> {
    fn peek(&self) -> Option<EventKind> {
        self.events.get(self.position).map(|e| e.kind())
    }

    fn next(&mut self) -> Option<&'t Event> {
        let event = self.events.get(self.position).copied();
        self.position += 1;
        event
    }

    fn document(&mut self) -> Table {
        let mut root = Table::new(Origin::Header);
        let mut header: Vec<Part> = Vec::new();
        let mut accepted = true;
        while let Some(kind) = self.peek() {
            match kind {
                EventKind::StdTableOpen | EventKind::ArrayTableOpen => {
                    self.next();
                    header = self.key();
                    if matches!(self.peek(), Some(EventKind::StdTableClose | EventKind::ArrayTableClose)) {
                        self.next();
                    }
                    accepted = self.open(&mut root, &header, kind == EventKind::ArrayTableOpen);
                }
                EventKind::SimpleKey => {
                    let key = self.key();
                    let value = self.value();
                    if let Some(value) = value
                        && accepted
                        && let Some(table) = descend(&mut root, &header)
                        && let Err(d) = insert(table, key, value)
                    {
                        self.diagnostics.push(d);
                    }
                }
                _ => {
                    self.next();
                }
            }
        }
        root
    }

    /// The parts of a dotted key, up to what follows it.
    fn key(&mut self) -> Vec<Part> {
        let mut parts = Vec::new();
        while let Some(kind) = self.peek() {
            match kind {
                EventKind::SimpleKey => {
                    let Some(event) = self.next() else { break };
                    let mut name = String::new();
                    let mut errors: Vec<ParseError> = Vec::new();
                    if let Some(raw) = self.source.get(event) {
                        raw.decode_key(&mut name, &mut errors);
                    }
                    self.diagnostics.extend(errors.iter().map(|e| syntax_error(e, self.text)));
                    parts.push(Part { name, span: span_of(event.span()) });
                }
                EventKind::KeySep => {
                    self.next();
                }
                EventKind::KeyValSep => {
                    self.next();
                    break;
                }
                _ => break,
            }
        }
        if parts.len() > MAX_KEY_PARTS {
            let message = format!("a key of more than {MAX_KEY_PARTS} parts");
            self.diagnostics
                .push(Diagnostic::error("E-too-deep", message).at(parts[MAX_KEY_PARTS].span, "too deep here"));
            parts.truncate(MAX_KEY_PARTS);
        }
        parts
    }

    /// Recursion is as deep as the nesting of arrays and inline tables, which is limited.
    fn value(&mut self) -> Option<Value> {
        let event = self.next()?;
        let span = span_of(event.span());
        match event.kind() {
            EventKind::Scalar => Some(self.scalar(event)),
            EventKind::ArrayOpen => {
                let mut items = Vec::new();
                loop {
                    match self.peek() {
                        Some(EventKind::ArrayClose) => {
                            let end = self.next().map_or(span, |e| span_of(e.span()));
                            return Some(Value { span: span.to(end), kind: Kind::Array(items) });
                        }
                        Some(EventKind::ValueSep) => {
                            self.next();
                        }
                        None => return None,
                        _ => items.extend(self.value()),
                    }
                }
            }
            EventKind::InlineTableOpen => {
                let mut table = Table::new(Origin::Dotted);
                loop {
                    match self.peek() {
                        Some(EventKind::InlineTableClose) => {
                            let end = self.next().map_or(span, |e| span_of(e.span()));
                            table.origin = Origin::Inline;
                            return Some(Value { span: span.to(end), kind: Kind::Table(table) });
                        }
                        Some(EventKind::SimpleKey) => {
                            let key = self.key();
                            if let Some(value) = self.value()
                                && let Err(d) = insert(&mut table, key, value)
                            {
                                self.diagnostics.push(d);
                            }
                        }
                        None => return None,
                        _ => {
                            self.next();
                        }
                    }
                }
            }
            _ => None,
        }
    }

    fn scalar(&mut self, event: &Event) -> Value {
        let span = span_of(event.span());
        let mut errors: Vec<ParseError> = Vec::new();
        let mut builder = Builder { source: self.text, text: Text::empty(span) };
        let kind = match self.source.get(event) {
            Some(raw) => raw.decode_scalar(&mut builder, &mut errors),
            None => ScalarKind::String,
        };
        self.diagnostics.extend(errors.iter().map(|e| syntax_error(e, self.text)));
        let kind = match kind {
            ScalarKind::String => Kind::String(builder.text),
            ScalarKind::Boolean(_) => Kind::Boolean,
            ScalarKind::DateTime => Kind::DateTime,
            ScalarKind::Float | ScalarKind::Integer(IntegerRadix::Dec) => {
                Kind::Number(builder.text.as_str().to_owned())
            }
            ScalarKind::Integer(_) => {
                if errors.is_empty() {
                    let error = Diagnostic::error("E-number", "hexadecimal, octal and binary numbers are not accepted");
                    self.diagnostics.push(error.at(span, "not decimal").help("write the number in decimal"));
                }
                Kind::Number("0".into())
            }
        };
        Value { span, kind }
    }

    /// Makes the table of a header; `false` when it is refused.
    fn open(&mut self, root: &mut Table, header: &[Part], array: bool) -> bool {
        let Some((last, path)) = header.split_last() else { return false };
        let Some(parent) = descend_or_create(root, path, Origin::Implicit) else {
            self.diagnostics.push(not_a_table(header));
            return false;
        };
        let new = || Value { span: last.span, kind: Kind::Table(Table::new(Origin::Header)) };
        let Some(entry) = parent.entry_mut(&last.name) else {
            let value = if array { Value { span: last.span, kind: Kind::Array(vec![new()]) } } else { new() };
            parent.insert(Entry { key: last.name.clone(), key_span: last.span, value });
            return true;
        };
        match &mut entry.value.kind {
            // An array written with brackets is not an array of tables.
            Kind::Array(items)
                if array
                    && items.iter().all(|v| matches!(&v.kind, Kind::Table(t) if t.origin == Origin::Header))
                    && !items.is_empty() =>
            {
                items.push(new());
                true
            }
            Kind::Table(table) if !array && table.origin == Origin::Implicit => {
                table.origin = Origin::Header;
                entry.value.span = last.span;
                true
            }
            _ => {
                let first = entry.key_span;
                self.diagnostics.push(duplicate(&last.name, last.span, first));
                false
            }
        }
    }
}

fn duplicate(name: &str, span: Span, first: Span) -> Diagnostic {
    Diagnostic::error("E-duplicate-key", format!("'{}' is defined twice", shorten(name)))
        .at(span, "defined again here")
        .also(first, "first defined here")
        .help("keep one of the two")
}

fn not_a_table(parts: &[Part]) -> Diagnostic {
    let span = parts.iter().map(|p| p.span).reduce(Span::to).unwrap_or_default();
    Diagnostic::error("E-toml", "not valid TOML: a key on the way to this one is no table that can be added to")
        .at(span, "here")
}

/// The table that a header already opened stands for: the last of an array of tables.
fn descend<'r>(root: &'r mut Table, path: &[Part]) -> Option<&'r mut Table> {
    let mut table = root;
    for part in path {
        table = inside(table.entry_mut(&part.name)?, true)?;
    }
    Some(table)
}

fn inside(entry: &mut Entry, headers: bool) -> Option<&mut Table> {
    match &mut entry.value.kind {
        Kind::Table(table) if table.origin != Origin::Inline => Some(table),
        Kind::Array(items) if headers => match &mut items.last_mut()?.kind {
            Kind::Table(table) if table.origin == Origin::Header => Some(table),
            _ => None,
        },
        _ => None,
    }
}

fn descend_or_create<'r>(root: &'r mut Table, path: &[Part], origin: Origin) -> Option<&'r mut Table> {
    let mut table = root;
    for part in path {
        if table.entry(&part.name).is_none() {
            let value = Value { span: part.span, kind: Kind::Table(Table::new(origin)) };
            table.insert(Entry { key: part.name.clone(), key_span: part.span, value });
        }
        let entry = table.entry_mut(&part.name)?;
        if origin == Origin::Dotted && !matches!(&entry.value.kind, Kind::Table(t) if t.origin == Origin::Dotted) {
            return None;
        }
        table = inside(entry, origin == Origin::Implicit)?;
    }
    Some(table)
}

/// Puts a value under a possibly dotted key.
fn insert(table: &mut Table, mut key: Vec<Part>, value: Value) -> Result<(), Diagnostic> {
    let Some(last) = key.pop() else { return Ok(()) };
    let Some(parent) = descend_or_create(table, &key, Origin::Dotted) else {
        key.push(last);
        return Err(not_a_table(&key));
    };
    if let Some(first) = parent.entry(&last.name) {
        return Err(duplicate(&last.name, last.span, first.key_span));
    }
    parent.insert(Entry { key: last.name, key_span: last.span, value });
    Ok(())
}

/// Collects decoded text and the place of each of its pieces.
struct Builder<'t> {
    source: &'t str,
    text: Text,
}

impl Builder<'_> {
    /// Where the next piece would begin if nothing were left out.
    fn next_place(&self) -> usize {
        self.text.source_end().unwrap_or_else(|| {
            let start = self.text.span().start;
            let literal = &self.source[start..self.text.span().end];
            let quotes = if literal.starts_with("\"\"\"") || literal.starts_with("'''") { 3 } else { 1 };
            start + quotes
        })
    }
}

impl<'t> StringBuilder<'t> for Builder<'t> {
    fn clear(&mut self) {
        self.text = Text::empty(self.text.span());
    }

    fn push_str(&mut self, append: &'t str) -> bool {
        // Pieces are slices of the source; a piece that is not (a newline made uniform) has the
        // place where it is expected.
        let offset = (append.as_ptr() as usize).wrapping_sub(self.source.as_ptr() as usize);
        let inside = offset.checked_add(append.len()).is_some_and(|end| end <= self.source.len());
        let place = if inside { offset } else { self.next_place() };
        self.text.push_verbatim(append, place);
        true
    }

    fn push_char(&mut self, append: char) -> bool {
        let place = self.next_place();
        let length = match self.source.as_bytes().get(place + 1) {
            _ if self.source.as_bytes().get(place) != Some(&b'\\') => append.len_utf8(),
            Some(b'x') => 4,
            Some(b'u') => 6,
            Some(b'U') => 10,
            _ => 2,
        };
        self.text.push_escape(append, place, length);
        true
    }
}
