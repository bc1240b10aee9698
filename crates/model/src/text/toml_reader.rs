//! TOML text to tables with a place for everything, by the `toml` crate.
//!
//! Its recovering parser gives every key and value its place, leaves numbers as text, so that none passes
//! through binary floating point and none is too long, and goes on after a mistake. What it leaves out is
//! found again here: where the first of two equal keys stands, where an array that never ends begins, and
//! where each character of a string with escapes is written.

use super::located::Text;
use super::names::shorten;
use super::toml_hints::hint;
use super::toml_value::{Entry, Kind, Table, Value};
use crate::error::{Code, Diagnostic, Span};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Syntax errors shown of one file.
const MAX_SHOWN: usize = 8;

/// Reads the whole text. Everything that is wrong with it is returned, not only the first.
pub(crate) fn read(text: &str) -> Result<Table, Vec<Diagnostic>> {
    let (root, errors) = DeTable::parse_recoverable(text);
    let mut reader = Reader { text, diagnostics: Vec::new() };
    let table = reader.table(root.get_ref());
    reader.diagnostics.extend(errors.iter().map(|e| diagnostic(e, text)));
    let mut found = reader.diagnostics;
    if found.is_empty() {
        return Ok(table);
    }
    let start = |d: &Diagnostic| d.primary.as_ref().map_or(0, |l| l.span.start);
    found.sort_by_key(start);
    if let Some(opening) = never_closed(root.get_ref(), text, &errors) {
        // All that follows is read as if it stood between the brackets.
        found.retain(|d| start(d) < opening);
        let error = Diagnostic::error(Code::Toml, "not valid TOML: a bracket is never closed");
        found.push(error.at(Span::new(opening, opening + 1), "opened here"));
    }
    // What follows a syntax error in the same line is read in the wrong light.
    let line = |d: &Diagnostic| text.as_bytes()[..start(d)].iter().filter(|&&b| b == b'\n').count();
    let syntax = |d: &Diagnostic| d.code == Code::Toml;
    found.dedup_by(|next, first| syntax(next) && syntax(first) && line(next) == line(first));
    found.truncate(MAX_SHOWN);
    let found = found.into_iter().map(|d| if d.code == Code::DuplicateKey { with_first_place(d, text) } else { d });
    Err(found.collect())
}

fn diagnostic(error: &toml::de::Error, text: &str) -> Diagnostic {
    let span = error.span().map(|s| Span::new(s.start, s.end));
    let (what, expected) = match error.message().split_once(", expected ") {
        Some((what, "nothing")) => (what, "not expected".to_owned()),
        Some((what, expected)) => (what, format!("expected {expected}")),
        None => (error.message(), "here".to_owned()),
    };
    if what == "duplicate key" {
        let span = span.unwrap_or_default();
        let name = decoded_key(&text[span.start..span.end]);
        let of_an_array = text.lines().any(|line| line.trim().strip_prefix("[[").is_some_and(|l| l.starts_with(&name)));
        let help = match &text[..span.start] {
            before if of_an_array && before.ends_with('[') => {
                format!("each has a header of its own: [[{}]]", shorten(&name))
            }
            _ => "keep one of the two".to_owned(),
        };
        return Diagnostic::error(Code::DuplicateKey, format!("'{}' is defined twice", shorten(&name)))
            .at(span, "defined again here")
            .help(help);
    }
    let code = if what.contains("recur") { Code::TooDeep } else { Code::Toml };
    let error = Diagnostic::error(code, format!("not valid TOML: {what}"));
    let Some(span) = span else { return error };
    let error = error.at(span, expected);
    match hint(text, span.start).filter(|_| code == Code::Toml) {
        Some(hint) => error.help(hint),
        None => error,
    }
}

/// What a key that is written like this is called.
fn decoded_key(written: &str) -> String {
    let line = format!("{written} = 0");
    let (table, _) = DeTable::parse_recoverable(&line);
    table.get_ref().keys().next().map_or_else(|| written.to_owned(), |key| key.get_ref().to_string())
}

/// The same with the place of the first of the two keys: under another name the second stands in the same table.
fn with_first_place(duplicate: Diagnostic, text: &str) -> Diagnostic {
    const OTHER_NAME: &str = "\u{1}";
    let Some(span) = duplicate.primary.as_ref().map(|l| l.span) else { return duplicate };
    let name = decoded_key(&text[span.start..span.end]);
    let renamed = format!("{}\"\\u0001\"{}", &text[..span.start], &text[span.end..]);
    let (root, _) = DeTable::parse_recoverable(&renamed);
    let mut tables = vec![root.get_ref()];
    while let Some(table) = tables.pop() {
        if table.contains_key(OTHER_NAME) {
            let first = table.keys().find(|key| *key.get_ref() == name).map(Spanned::span);
            return match first.filter(|first| first.end <= span.start) {
                Some(first) => duplicate.also(Span::new(first.start, first.end), "first defined here"),
                None => duplicate,
            };
        }
        let mut values: Vec<&Spanned<DeValue<'_>>> = table.values().collect();
        while let Some(value) = values.pop() {
            match value.get_ref() {
                DeValue::Table(table) => tables.push(table),
                DeValue::Array(items) => values.extend(items.iter()),
                _ => {}
            }
        }
    }
    duplicate
}

/// Where the outermost array or inline table begins that has no end.
fn never_closed(root: &DeTable<'_>, text: &str, errors: &[toml::de::Error]) -> Option<usize> {
    let unclosed = |e: &&toml::de::Error| {
        e.message().starts_with("unclosed array,") || e.message().starts_with("unclosed inline table,")
    };
    let end = errors.iter().find(unclosed)?.span()?.end;
    let mut tables = vec![root];
    let mut openings = Vec::new();
    while let Some(table) = tables.pop() {
        for value in table.values() {
            let span = value.span();
            let is_bracketed = text[span.start..].starts_with(['[', '{']);
            match value.get_ref() {
                DeValue::Array(_) | DeValue::Table(_) if is_bracketed && span.end >= end => openings.push(span.start),
                DeValue::Table(table) => tables.push(table),
                DeValue::Array(items) => tables.extend(items.iter().filter_map(|v| v.get_ref().as_table())),
                _ => {}
            }
        }
    }
    openings.into_iter().min()
}

struct Reader<'t> {
    text: &'t str,
    diagnostics: Vec<Diagnostic>,
}

impl Reader<'_> {
    fn table(&mut self, table: &DeTable<'_>) -> Table {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
            let key: &Spanned<std::borrow::Cow<'_, str>> = key;
            let key_span = Span::new(key.span().start, key.span().end);
            Entry { key: key.get_ref().to_string(), key_span, value: self.value(value) }
        };
        Table::new(entries.into_iter().map(entry).collect())
    }

    /// Recursion is as deep as arrays and inline tables nest, which the crate limits.
    fn value(&mut self, value: &Spanned<DeValue<'_>>) -> Value {
        let span = Span::new(value.span().start, value.span().end);
        let kind = match value.get_ref() {
            DeValue::String(decoded) => Kind::String(Text::of_literal(self.text, span, decoded)),
            DeValue::Float(number) => Kind::Number(number.as_str().to_owned()),
            DeValue::Integer(number) => {
                if number.radix() != 10 {
                    let error =
                        Diagnostic::error(Code::Number, "hexadecimal, octal and binary numbers are not accepted");
                    self.diagnostics.push(error.at(span, "not decimal").help("write the number in decimal"));
                }
                Kind::Number(number.as_str().to_owned())
            }
            DeValue::Boolean(value) => Kind::Boolean(*value),
            DeValue::Datetime(_) => Kind::DateTime,
            DeValue::Array(items) => Kind::Array(items.iter().map(|item| self.value(item)).collect()),
            DeValue::Table(table) => {
                let kind = Kind::Table(self.table(table));
                return Value { span: inside_header(self.text, span), kind };
            }
        };
        Value { span, kind }
    }
}

/// The name between the brackets of a header; any other place as it is.
fn inside_header(text: &str, span: Span) -> Span {
    let written = &text[span.start..span.end];
    let inner = written.trim_start_matches('[').trim_start();
    let start = span.end - inner.len();
    let name = inner.trim_end_matches(']').trim_end();
    if written.starts_with('[') { Span::new(start, start + name.len()) } else { span }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Codes, places as source text, and second places of all mistakes.
    fn mistakes(text: &str) -> Vec<String> {
        let at = |span: Span| format!("{}@{}", &text[span.start..span.end], span.start);
        let show = |d: &Diagnostic| {
            let places = d.primary.iter().chain(&d.secondary).map(|l| at(l.span));
            format!("{} {}", d.code, places.collect::<Vec<_>>().join(" "))
        };
        read(text).err().unwrap_or_default().iter().map(show).collect()
    }

    #[test]
    fn every_mistake_is_reported_in_one_run() {
        let text = "a = 'open\nb = 1.\nc = 01 # leading\nd = 2021-02-30\na = 3\nn = 0x1F\n[t]\nk = tru\n";
        assert_eq!(
            mistakes(text),
            [
                "E-toml @9",
                "E-toml @16",
                "E-toml 0@21",
                "E-toml 2021-02-30@38",
                "E-duplicate-key a@49 a@0",
                "E-number 0x1F@59",
                "E-toml tru@72"
            ]
        );
    }

    #[test]
    fn both_places_of_a_key_that_stands_twice_are_known() {
        for (text, expected) in [
            ("a = 1\na = 2", "E-duplicate-key a@6 a@0"),
            ("\"a\" = 1\n'a' = 2", "E-duplicate-key 'a'@8 \"a\"@0"),
            ("K = 0\n[c]\nK = 1\n[p]\nK = 2\nx = { K = 1, K = 2 }\n", "E-duplicate-key K@39 K@32"),
            ("K = 0\n[c]\nK = 1\n[p]\nK = 2\n[[b]]\n[[b]]\nK = 1\nK = 2\n", "E-duplicate-key K@44 K@38"),
            ("[t]\nx = 1\n[t]\ny = 1", "E-duplicate-key t@11 t@1"),
            ("[a.t]\n[b.t]\n[a.t]\n", "E-duplicate-key t@15 t@3"),
            ("[[a]]\n[a]\n", "E-duplicate-key a@7 a@2"),
            ("a = [1]\n[[a]]\n", "E-duplicate-key a@10 a@0"),
            ("a.b = 1\na.b = 2\n", "E-duplicate-key b@10 b@2"),
        ] {
            assert_eq!(mistakes(text), [expected], "{text}");
        }
    }

    #[test]
    fn a_bracket_that_is_never_closed_is_one_mistake_at_its_place() {
        let text = "a = 1.\nm = [['x', 'y'], ['z'\nb = 1\nc = 2.\n[t]\nd = 3\n";
        assert_eq!(mistakes(text), ["E-toml @6", "E-toml [@11"]);
        assert_eq!(mistakes("a = { b = [1, 2], c = 3\nd = 4\n"), ["E-toml {@4"]);
        assert_eq!(mistakes(&"[".repeat(1000)).len(), 1);
        assert!(mistakes(&format!("a = {}", "[".repeat(1000)))[0].starts_with(Code::TooDeep.as_str()));
    }

    #[test]
    fn nesting_and_keys_end_somewhere() {
        let nested = format!("a = {}{}", "[".repeat(100), "]".repeat(100));
        assert!(mistakes(&nested)[0].starts_with(Code::TooDeep.as_str()), "{:?}", mistakes(&nested));
        let dotted = format!("{} = 1", ["a"; 100].join("."));
        assert!(mistakes(&dotted)[0].starts_with(Code::TooDeep.as_str()), "{:?}", mistakes(&dotted));
    }

    #[test]
    fn keys_come_in_the_order_of_the_text() {
        let table = read("z = 1\na = 2\n[m]\n[b]\n[[l]]\nx = 1").unwrap();
        assert_eq!(table.iter().map(|e| e.key.as_str()).collect::<Vec<_>>(), ["z", "a", "m", "b", "l"]);
    }

    #[test]
    fn numbers_keep_their_text() {
        let table = read("a = 1_000\nb = +1_0.5e-3\nc = -0\nd = 99999999999999999999999999\n").unwrap();
        let number = |key: &str| match &table.get(key).unwrap().kind {
            Kind::Number(text) => text.clone(),
            other => panic!("{other:?}"),
        };
        assert_eq!(["a", "b", "c", "d"].map(number), ["1000", "+10.5e-3", "-0", "99999999999999999999999999"]);
    }
}
