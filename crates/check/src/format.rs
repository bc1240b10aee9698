//! The text of certificates: a strict reader and a writer for a small part of JSON.
//!
//! Numbers are kept as the text they are written in: exact numbers stand in strings, and only
//! small counts are JSON numbers. A key that occurs twice, nesting deeper than [`MAX_DEPTH`], a text longer
//! than [`MAX_TEXT`] and anything after the end are refused.

use std::fmt::Write;

/// The schema this version writes and accepts.
pub const SCHEMA: &str = "jurist/certificate/1";

/// The schema of certificates over symbols, such as those of plants behind a hold.
pub const SCHEMA_WITH_SYMBOLS: &str = "jurist/certificate/2";

/// The schema of certificates of stable dead times.
pub const SCHEMA_WITH_DEAD_TIME: &str = "jurist/certificate/3";

/// The schema of certificates of boxes of tolerances.
pub const SCHEMA_OF_BOXES: &str = "jurist/certificate/4";

/// The version of maps of two parameters.
pub const SCHEMA_OF_MAPS: &str = "jurist/certificate/5";

/// The schema of certificates of a gain beside dead time.
pub const SCHEMA_OF_CELLS: &str = "jurist/certificate/6";

/// The schema of certificates of maps by boxes.
pub const SCHEMA_OF_MAPS_BY_BOXES: &str = "jurist/certificate/7";

/// The schema of certificates of boxes of tolerances over symbols.
pub const SCHEMA_OF_BOXES_WITH_SYMBOLS: &str = "jurist/certificate/8";

/// Of verdicts whose numbers are only enclosed.
pub const SCHEMA_BY_ENCLOSURES: &str = "jurist/certificate/9";

/// Of what holds for all values of names.
pub const SCHEMA_FOR_ALL: &str = "jurist/certificate/10";

/// Of best gains.
pub const SCHEMA_OF_TUNING: &str = "jurist/certificate/11";

/// Texts longer than this many bytes are refused unread.
pub const MAX_TEXT: usize = 64 << 20;

/// Arrays and objects may nest this deep; a certificate needs six levels.
pub const MAX_DEPTH: usize = 16;

/// Counts have at most so many digits.
const MAX_COUNT_DIGITS: usize = 9;

/// A JSON value. Objects keep their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Json {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// A small count.
    Count(u32),
    /// A string.
    Text(String),
    /// An array.
    List(Vec<Json>),
    /// An object.
    Object(Vec<(String, Json)>),
}

impl From<&str> for Json {
    fn from(text: &str) -> Self {
        Json::Text(text.to_owned())
    }
}

impl From<String> for Json {
    fn from(text: String) -> Self {
        Json::Text(text)
    }
}

impl Json {
    /// Reads a whole text.
    ///
    /// # Errors
    /// A sentence with the position in bytes.
    ///
    /// ```
    /// use jurist_check::format::Json;
    /// let value = Json::parse(r#"{"a": ["1/2", 3]}"#)?;
    /// assert_eq!(value.get("a").unwrap().to_text(), "[\"1/2\", 3]\n");
    /// assert!(Json::parse(r#"{"a": 1, "a": 1}"#).is_err());
    /// # Ok::<(), String>(())
    /// ```
    pub fn parse(text: &str) -> Result<Json, String> {
        if text.len() > MAX_TEXT {
            return Err(format!("the text is longer than {MAX_TEXT} bytes"));
        }
        let mut reader = Reader { text, at: 0 };
        let value = reader.value(0)?;
        reader.space();
        if reader.at < text.len() {
            return Err(reader.wrong("something follows the end"));
        }
        Ok(value)
    }

    /// The value under `key`, if this is an object that has it.
    pub fn get(&self, key: &str) -> Option<&Json> {
        match self {
            Json::Object(pairs) => pairs.iter().find(|(k, _)| k == key).map(|(_, v)| v),
            _ => None,
        }
    }

    /// The text, with line breaks between the parts of a certificate, and one at the end.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, 0);
        out.push('\n');
        out
    }

    /// Whether the value is small enough for one line.
    fn is_short(&self) -> bool {
        match self {
            Json::List(items) => {
                items.len() <= 8 && items.iter().all(|i| !matches!(i, Json::List(_) | Json::Object(_)))
            }
            Json::Object(pairs) => pairs.len() <= 6 && pairs.iter().all(|(_, v)| v.is_short()),
            _ => true,
        }
    }

    /// The items between brackets: on one line when short, each on its own otherwise.
    fn write_items<T>(
        &self,
        out: &mut String,
        depth: usize,
        [open, close]: [char; 2],
        items: &[T],
        write: impl Fn(&T, &mut String),
    ) {
        out.push(open);
        for (i, item) in items.iter().enumerate() {
            out.push_str(if i > 0 { "," } else { "" });
            if self.is_short() {
                out.push_str(if i > 0 { " " } else { "" });
            } else {
                out.push('\n');
                out.extend(std::iter::repeat_n(' ', depth + 1));
            }
            write(item, out);
        }
        out.push(close);
    }

    fn write(&self, out: &mut String, depth: usize) {
        match self {
            Json::Null => out.push_str("null"),
            Json::Bool(b) => out.push_str(if *b { "true" } else { "false" }),
            Json::Count(n) => {
                let _ = write!(out, "{n}");
            }
            Json::Text(text) => write_string(out, text),
            Json::List(items) => {
                self.write_items(out, depth, ['[', ']'], items, |item, out| item.write(out, depth + 1))
            }
            Json::Object(pairs) => self.write_items(out, depth, ['{', '}'], pairs, |(key, value), out| {
                write_string(out, key);
                out.push_str(": ");
                value.write(out, depth + 1);
            }),
        }
    }
}

fn write_string(out: &mut String, text: &str) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => {
                out.push('\\');
                out.push(c);
            }
            c if (c as u32) < 0x20 => {
                let _ = write!(out, "\\u{:04x}", c as u32);
            }
            c => out.push(c),
        }
    }
    out.push('"');
}

struct Reader<'t> {
    text: &'t str,
    at: usize,
}

impl Reader<'_> {
    fn wrong(&self, what: &str) -> String {
        format!("{what} (byte {})", self.at + 1)
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn space(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\n' | b'\r' | b'\t')) {
            self.at += 1;
        }
    }

    fn eat(&mut self, byte: u8) -> bool {
        self.space();
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn word(&mut self, word: &str, value: Json) -> Result<Json, String> {
        if self.text[self.at..].starts_with(word) {
            self.at += word.len();
            return Ok(value);
        }
        Err(self.wrong("not a value"))
    }

    fn value(&mut self, depth: usize) -> Result<Json, String> {
        self.space();
        match self.peek() {
            Some(b'n') => self.word("null", Json::Null),
            Some(b't') => self.word("true", Json::Bool(true)),
            Some(b'f') => self.word("false", Json::Bool(false)),
            Some(b'"') => self.string().map(Json::Text),
            Some(b'0'..=b'9') => self.count(),
            Some(b'[' | b'{') if depth >= MAX_DEPTH => Err(self.wrong("nested too deep")),
            Some(b'[') => {
                self.at += 1;
                let mut items = Vec::new();
                if self.eat(b']') {
                    return Ok(Json::List(items));
                }
                loop {
                    items.push(self.value(depth + 1)?);
                    if self.eat(b']') {
                        return Ok(Json::List(items));
                    }
                    if !self.eat(b',') {
                        return Err(self.wrong("',' or ']' is missing"));
                    }
                }
            }
            Some(b'{') => {
                self.at += 1;
                let mut pairs: Vec<(String, Json)> = Vec::new();
                if self.eat(b'}') {
                    return Ok(Json::Object(pairs));
                }
                let mut seen = std::collections::BTreeSet::new();
                loop {
                    self.space();
                    let key = self.string()?;
                    if !seen.insert(key.clone()) {
                        return Err(self.wrong("a key occurs twice"));
                    }
                    if !self.eat(b':') {
                        return Err(self.wrong("':' is missing"));
                    }
                    let value = self.value(depth + 1)?;
                    pairs.push((key, value));
                    if self.eat(b'}') {
                        return Ok(Json::Object(pairs));
                    }
                    if !self.eat(b',') {
                        return Err(self.wrong("',' or '}' is missing"));
                    }
                }
            }
            Some(_) => Err(self.wrong("not a value of this format")),
            None => Err(self.wrong("the text ends too early")),
        }
    }

    fn count(&mut self) -> Result<Json, String> {
        let start = self.at;
        while matches!(self.peek(), Some(b'0'..=b'9')) {
            self.at += 1;
        }
        let digits = &self.text[start..self.at];
        let plain = digits.len() == 1 || !digits.starts_with('0');
        match digits.parse() {
            Ok(n) if plain && digits.len() <= MAX_COUNT_DIGITS && !matches!(self.peek(), Some(b'.' | b'e' | b'E')) => {
                Ok(Json::Count(n))
            }
            _ => Err(self.wrong("only small counts are written as numbers, all others as strings")),
        }
    }

    fn string(&mut self) -> Result<String, String> {
        if self.peek() != Some(b'"') {
            return Err(self.wrong("a string is missing"));
        }
        self.at += 1;
        let mut out = String::new();
        loop {
            let rest = &self.text[self.at..];
            let plain = rest.find(|c: char| c == '"' || c == '\\' || (c as u32) < 0x20);
            let Some(length) = plain else { return Err(self.wrong("a string does not end")) };
            out.push_str(&rest[..length]);
            self.at += length;
            match self.peek() {
                Some(b'"') => {
                    self.at += 1;
                    return Ok(out);
                }
                Some(b'\\') => {
                    let escape = self.text.as_bytes().get(self.at + 1).copied();
                    self.at += 2;
                    out.push(match escape {
                        Some(b'"') => '"',
                        Some(b'\\') => '\\',
                        Some(b'/') => '/',
                        Some(b'n') => '\n',
                        Some(b't') => '\t',
                        Some(b'r') => '\r',
                        Some(b'b') => '\u{8}',
                        Some(b'f') => '\u{c}',
                        Some(b'u') => self.escaped()?,
                        _ => return Err("an escape is wrong".to_owned()),
                    });
                }
                _ => return Err(self.wrong("a control character in a string")),
            }
        }
    }
}

/// The code point of two halves of a surrogate pair (RFC 8259, section 7).
fn joined(high: u32, low: u32) -> u32 {
    0x1_0000 + ((high - 0xd800) << 10) + (low - 0xdc00)
}

impl Reader<'_> {
    /// The character of the four hexadecimal digits behind `\u`, or of two such escapes that are a surrogate pair.
    fn escaped(&mut self) -> Result<char, String> {
        let high = self.code()?;
        let is_half = (0xd800..0xdc00).contains(&high);
        if is_half && self.text.get(self.at..).is_some_and(|rest| rest.starts_with("\\u")) {
            self.at += 2;
            let low = self.code()?;
            if (0xdc00..0xe000).contains(&low) {
                return char::from_u32(joined(high, low)).ok_or_else(|| self.wrong("a \\u escape is wrong"));
            }
        }
        char::from_u32(high).ok_or_else(|| self.wrong("half of a surrogate pair stands alone"))
    }

    fn code(&mut self) -> Result<u32, String> {
        let digits = self.text.get(self.at..self.at + 4).filter(|t| t.bytes().all(|b| b.is_ascii_hexdigit()));
        let code = digits.and_then(|t| u32::from_str_radix(t, 16).ok());
        let code = code.ok_or_else(|| self.wrong("a \\u escape is wrong"))?;
        self.at += 4;
        Ok(code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escaped_characters_are_read_and_halves_of_pairs_are_not() {
        let read = |text: &str| Json::parse(&format!("\"{text}\""));
        assert_eq!(read("\\ud83d\\ude00 \\u00e9"), Ok("\u{1f600} \u{e9}".into()));
        for wrong in
            ["\\ud83d", "\\ude00", "\\ud83d ", "\\ud83d\\n", "\\ud83d\\u0041", "\\ud83d\\ud83d", "\\ud83d\\u", "\\u123"]
        {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn nesting_and_counts_end_where_they_are_said_to() {
        let nested = |n: usize| format!("{}7{}", "[".repeat(n), "]".repeat(n));
        assert!(Json::parse(&nested(MAX_DEPTH)).is_ok() && Json::parse(&nested(MAX_DEPTH + 1)).is_err());
        assert!(Json::parse("999999999").is_ok() && Json::parse("1000000000").is_err());
    }

    #[test]
    fn what_is_written_reads_back() {
        let text = r#"{"a": [null, true, false, 17, "x\"\\\n\u0041é"], "b": {"c": []}, "d": {}}"#;
        let value = Json::parse(text).unwrap();
        assert_eq!(Json::parse(&value.to_text()).unwrap(), value);
        assert_eq!(value.get("a"), value.get("a"));
    }

    #[test]
    fn what_is_not_of_the_format_is_refused() {
        let deep = "[".repeat(100_000);
        for text in [
            "",
            "{",
            "[1,]",
            "{\"a\":1,}",
            "01",
            "1.5",
            "-1",
            "1e3",
            "99999999999",
            "\"",
            "\"\\",
            "\"\\u12\"",
            "\"\\ud800\"",
            "\"\u{1}\"",
            "nul",
            "[] []",
            "{\"a\":1,\"a\":2}",
            "{a:1}",
            "\u{feff}{}",
            "[\"é",
            "\"\\u00é\"",
            &deep,
        ] {
            assert!(Json::parse(text).is_err(), "{}", &text[..text.len().min(20)]);
        }
    }
}
