//! A model file as plain values, through `toml_edit`: numbers by their source text.

use super::number::{Q, Z, decimal, shorten};
use num_traits::Num;
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
    Number(Q),
    Text(String),
    List(Vec<Toml>),
    Table(Vec<(String, Toml)>),
    Other,
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

    /// A text, or the numbers' text: what an expression is written as.
    pub fn expression(&self) -> Result<String, String> {
        match self {
            Toml::Number(q) => Ok(format!("{}/{}", q.numer(), q.denom())),
            Toml::Text(text) => Ok(text.clone()),
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
    let text = quote_long_numbers(text);
    let document = Document::parse(text.as_str()).map_err(|e| format!("not TOML: {}", e.message()))?;
    table(document.as_table(), &text, 0)
}

fn table(source: &dyn TableLike, text: &str, depth: usize) -> Result<Toml, String> {
    let entries = source.iter().map(|(key, item)| Ok((key.to_owned(), of_item(item, text, depth + 1)?)));
    Ok(Toml::Table(entries.collect::<Result<_, String>>()?))
}

fn of_item(item: &Item, text: &str, depth: usize) -> Result<Toml, String> {
    if depth > 100 {
        return Err("the model is nested too deep".into());
    }
    match item {
        Item::None => Ok(Toml::Other),
        Item::Table(t) => table(t, text, depth),
        Item::ArrayOfTables(list) => {
            Ok(Toml::List(list.iter().map(|t| table(t, text, depth)).collect::<Result<_, _>>()?))
        }
        Item::Value(value) => of_value(value, text, depth),
    }
}

fn of_value(value: &Value, text: &str, depth: usize) -> Result<Toml, String> {
    if depth > 100 {
        return Err("the model is nested too deep".into());
    }
    let raw = || value.span().and_then(|span| text.get(span)).ok_or_else(|| "a number has no place".to_owned());
    match value {
        Value::String(s) => Ok(Toml::Text(s.value().clone())),
        Value::Integer(_) | Value::Float(_) => number(raw()?).map(Toml::Number),
        Value::Boolean(_) | Value::Datetime(_) => Ok(Toml::Other),
        Value::Array(items) => {
            Ok(Toml::List(items.iter().map(|v| of_value(v, text, depth + 1)).collect::<Result<_, _>>()?))
        }
        Value::InlineTable(t) => table(t, text, depth),
    }
}

/// A TOML number by its text.
fn number(raw: &str) -> Result<Q, String> {
    let raw = raw.trim();
    let (negative, plain) = match raw.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, raw.strip_prefix('+').unwrap_or(raw)),
    };
    let plain = plain.replace('_', "");
    let radix = [("0x", 16), ("0o", 8), ("0b", 2)].into_iter().find_map(|(p, r)| Some((plain.strip_prefix(p)?, r)));
    let value = match radix {
        Some((digits, radix)) => {
            Q::from(Z::from_str_radix(digits, radix).map_err(|_| format!("'{}' is not a number", shorten(raw)))?)
        }
        None => decimal(&plain)?,
    };
    Ok(if negative { -value } else { value })
}

/// The same text with long decimal numbers as strings, which mean the same.
fn quote_long_numbers(text: &str) -> String {
    let source = toml_parser::Source::new(text);
    let tokens = source.lex().into_vec();
    let mut events: Vec<toml_parser::parser::Event> = Vec::new();
    let mut errors: Vec<toml_parser::ParseError> = Vec::new();
    let mut guard = toml_parser::parser::RecursionGuard::new(&mut events, 100);
    parse_document(&tokens, &mut guard, &mut errors);
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for event in events.iter().filter(|e| e.kind() == EventKind::Scalar && e.encoding().is_none()) {
        let (start, end) = (event.span().start(), event.span().end());
        let Some(raw) = text.get(start..end) else { continue };
        let exponent = raw.find(['e', 'E']).is_some();
        if is_decimal(raw) && start >= done && (exponent || raw.len() > LONG) {
            out.push_str(&text[done..start]);
            out.push('"');
            out.push_str(raw);
            out.push('"');
            done = end;
        }
    }
    out.push_str(&text[done..]);
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
        let text = "a = 0.1\nb = 1e400\nc = 123456789012345678901234567890\nd = 0x1F\ne = [1_000, 2.50e-3]\nf = 'x'";
        let t = read(text).unwrap();
        let of = |key: &str| t.get(key).unwrap().expression().unwrap();
        assert_eq!(of("a"), "1/10");
        assert_eq!(of("b"), "1e400");
        assert_eq!(of("c"), "123456789012345678901234567890");
        assert_eq!(of("d"), "31/1");
        assert_eq!(t.get("e").unwrap().list().unwrap()[1].expression().unwrap(), "2.50e-3");
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
