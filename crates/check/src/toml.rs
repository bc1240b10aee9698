//! A model file as plain values, through `toml_edit`: numbers by their source text.

use super::number::shorten;
use std::collections::BTreeSet;
use toml_edit::{Document, Item, TableLike, Value};
use toml_parser::parser::{EventKind, parse_document};

/// Model texts longer than this are refused.
const MAX_TEXT: usize = 4 << 20;

/// Bare numbers longer than this are put in quotes before the text is read, because `toml_edit`
/// refuses integers beyond 64 bits and numbers beyond binary floating point.
const LONG: usize = 15;

/// A value of the file.
#[derive(Clone, Debug)]
pub(super) enum Toml {
    /// A decimal number as it is written.
    Number(String),
    Text(String),
    List(Vec<Toml>),
    Table(Vec<(String, Toml)>),
    Other,
    /// `true` or `false`.
    Boolean,
}

impl Toml {
    pub fn get(&self, key: &str) -> Option<&Toml> {
        self.entries().iter().find(|(k, _)| k == key).map(|(_, v)| v)
    }

    /// The entries of a table; none of anything else.
    pub fn entries(&self) -> &[(String, Toml)] {
        match self {
            Toml::Table(entries) => entries,
            _ => &[],
        }
    }

    /// The entries of the table under a key; none where the key is not there.
    pub fn section(&self, key: &str) -> Result<&[(String, Toml)], String> {
        match self.get(key) {
            None => Ok(&[]),
            Some(Toml::Table(entries)) => Ok(entries),
            Some(_) => Err(format!("'{}' is not a table", shorten(key))),
        }
    }

    /// A text, or the number's text: what an expression is written as.
    pub fn expression(&self) -> Result<&str, String> {
        match self {
            Toml::Number(text) | Toml::Text(text) => Ok(text),
            _ => Err("a number or an expression is expected".into()),
        }
    }

    pub fn text(&self) -> Result<&str, String> {
        match self {
            Toml::Text(text) => Ok(text),
            _ => Err("a string is expected".into()),
        }
    }

    pub fn list(&self) -> Result<&[Toml], String> {
        match self {
            Toml::List(items) => Ok(items),
            _ => Err("an array is expected".into()),
        }
    }

    /// One value, or an array of them.
    pub fn one_or_more(&self) -> Vec<&Toml> {
        match self {
            Toml::List(items) => items.iter().collect(),
            other => vec![other],
        }
    }
}

/// Reads a model text.
pub(super) fn read(text: &str) -> Result<Toml, String> {
    if text.len() > MAX_TEXT {
        return Err(format!("the model is longer than {MAX_TEXT} bytes"));
    }
    let source = quote_long_numbers(text);
    let document = Document::parse(source.text.as_str()).map_err(|e| format!("not TOML: {}", e.message()))?;
    table(document.as_table(), &source, 0)
}

/// A text in which some numbers stand in quotes.
struct Source {
    text: String,
    /// Where these begin.
    numbers: BTreeSet<usize>,
}

fn table(entries: &dyn TableLike, source: &Source, depth: usize) -> Result<Toml, String> {
    let entries = entries.iter().map(|(key, item)| Ok((key.to_owned(), of_item(item, source, depth + 1)?)));
    Ok(Toml::Table(entries.collect::<Result<_, String>>()?))
}

fn of_item(item: &Item, source: &Source, depth: usize) -> Result<Toml, String> {
    if depth > 100 {
        return Err("the model is nested too deep".into());
    }
    match item {
        Item::None => Ok(Toml::Other),
        Item::Table(t) => table(t, source, depth),
        Item::ArrayOfTables(list) => {
            Ok(Toml::List(list.iter().map(|t| table(t, source, depth)).collect::<Result<_, _>>()?))
        }
        Item::Value(value) => of_value(value, source, depth),
    }
}

fn of_value(value: &Value, source: &Source, depth: usize) -> Result<Toml, String> {
    if depth > 100 {
        return Err("the model is nested too deep".into());
    }
    let span = || value.span().ok_or_else(|| "internal: a value has no place".to_owned());
    match value {
        Value::String(s) if source.numbers.contains(&span()?.start) => Ok(Toml::Number(s.value().clone())),
        Value::String(s) => Ok(Toml::Text(s.value().clone())),
        Value::Integer(_) | Value::Float(_) => {
            let raw = source.text.get(span()?).unwrap_or_default().trim();
            // Neither another base nor infinity.
            let number = is_decimal(raw).then(|| Toml::Number(raw.to_owned()));
            number.ok_or_else(|| format!("'{}' is not a decimal number", shorten(raw)))
        }
        Value::Boolean(_) => Ok(Toml::Boolean),
        Value::Datetime(_) => Ok(Toml::Other),
        Value::Array(items) => {
            Ok(Toml::List(items.iter().map(|v| of_value(v, source, depth + 1)).collect::<Result<_, _>>()?))
        }
        Value::InlineTable(t) => table(t, source, depth),
    }
}

/// The same text with long decimal numbers as strings, which mean the same.
fn quote_long_numbers(text: &str) -> Source {
    let source = toml_parser::Source::new(text);
    let tokens = source.lex().into_vec();
    let mut events: Vec<toml_parser::parser::Event> = Vec::new();
    let mut errors: Vec<toml_parser::ParseError> = Vec::new();
    let mut guard = toml_parser::parser::RecursionGuard::new(&mut events, 100);
    parse_document(&tokens, &mut guard, &mut errors);
    let mut out = Source { text: String::with_capacity(text.len()), numbers: BTreeSet::new() };
    let mut done = 0;
    for event in events.iter().filter(|e| e.kind() == EventKind::Scalar && e.encoding().is_none()) {
        let (start, end) = (event.span().start(), event.span().end());
        let Some(raw) = text.get(start..end) else { continue };
        let exponent = raw.find(['e', 'E']).is_some();
        if is_decimal(raw) && start >= done && (exponent || raw.len() > LONG) {
            out.text.push_str(&text[done..start]);
            out.numbers.insert(out.text.len());
            out.text.push('"');
            out.text.push_str(raw);
            out.text.push('"');
            done = end;
        }
    }
    out.text.push_str(&text[done..]);
    out
}

/// Whether a scalar without quotes is a decimal number of TOML: what is not must not become an expression.
fn is_decimal(raw: &str) -> bool {
    // Underscores stand between digits only.
    let digits = |part: &str| part.split('_').all(|d| !d.is_empty() && d.bytes().all(|b| b.is_ascii_digit()));
    let unsigned = |part: &str| part.strip_prefix(['+', '-']).unwrap_or(part).to_owned();
    let number = unsigned(raw);
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(unsigned(exponent))),
        None => (number.as_str(), None),
    };
    let (whole, fraction) = match mantissa.split_once('.') {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (mantissa, None),
    };
    digits(whole)
        && (whole == "0" || !whole.starts_with('0'))
        && fraction.is_none_or(digits)
        && exponent.is_none_or(|e| digits(&e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_every_digit() {
        let text = "a = 0.1\nb = 1e400\nc = 123456789012345678901234567890\nd = '0x1F'\ne = [1_000, 2.50e-3]\nf = 'x'";
        let t = read(text).unwrap();
        let of = |key: &str| t.get(key).unwrap().expression().unwrap();
        assert_eq!(of("a"), "0.1");
        assert_eq!(of("b"), "1e400");
        assert_eq!(of("c"), "123456789012345678901234567890");
        assert_eq!(t.get("e").unwrap().list().unwrap()[1].expression().unwrap(), "2.50e-3");
        // A number is no string, however it is read; nor is a string a number.
        assert!(["a", "b", "c"].iter().all(|key| t.get(key).unwrap().text().is_err()));
        assert_eq!((t.get("d").unwrap().text(), t.get("f").unwrap().text()), (Ok("0x1F"), Ok("x")));
        for wrong in ["0x1F", "0o17", "0b1", "-inf", "+nan"] {
            assert!(read(&format!("a = {wrong}")).is_err(), "{wrong}");
        }
        assert!(read("a = 1\na = 2").is_err());
        assert!(read("a = nan").is_err() && read("a = inf").is_err());
        for wrong in ["1e5-99999.5", "1e5+1", "1-2", "01e5", "1__0e5", "1_e5", "1.e5", ".5e1", "1e", "1e5.0", "--1e5"] {
            assert!(read(&format!("a = {wrong}")).is_err(), "{wrong}");
        }
        for (text, value) in [("-1_0.5e-1_0", "-1_0.5e-1_0"), ("+0e5", "+0e5"), ("0.0E+0", "0.0E+0")] {
            assert_eq!(read(&format!("a = {text}")).unwrap().get("a").unwrap().expression().unwrap(), value);
        }
        assert!(read(&format!("a = {}1{}", "[".repeat(5000), "]".repeat(5000))).is_err());
    }
}
