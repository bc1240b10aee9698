//! Text taken out of a file, and the way back to where each byte of it stood.

use crate::error::Span;

/// A decoded string that remembers where each of its bytes stands in the source text.
///
/// A TOML string without escapes maps exactly; a character written as an escape maps to the
/// whole escape.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    value: String,
    pieces: Vec<Piece>,
    /// The whole literal in the source, quotes included.
    span: Span,
}

/// A run of decoded bytes that starts at `decoded` and stands at `source`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece {
    decoded: usize,
    source: usize,
    /// Source bytes of an escape; `None` for text that stands there byte by byte.
    escape: Option<usize>,
}

impl Text {
    /// The TOML string at `span` of `source`, whose decoded characters are `value`.
    pub(crate) fn of_literal(source: &str, span: Span, value: &str) -> Self {
        let literal = &source[span.start..span.end];
        let quote = if literal.starts_with("\"\"\"") || literal.starts_with("'''") { 3 } else { 1 };
        let has_escapes = literal.starts_with('"');
        let mut at = quote;
        if quote == 3 {
            // A newline right after the quotes does not count.
            at += ["\r\n", "\n"].iter().find(|n| literal[at..].starts_with(**n)).map_or(0, |n| n.len());
        }
        let mut text = Text { value: String::new(), pieces: Vec::new(), span };
        let mut rest = value;
        while let Some(c) = rest.chars().next() {
            let raw = literal.get(at..).unwrap_or_default();
            if has_escapes && raw.starts_with('\\') {
                let after = &raw[1..];
                if after.starts_with([' ', '\t', '\r', '\n']) {
                    // The line is continued where the next character stands.
                    at += 1 + after.len() - after.trim_start().len();
                    continue;
                }
                let length = match after.chars().next() {
                    Some('x') => 4,
                    Some('u') => 6,
                    Some('U') => 10,
                    _ => 2,
                };
                text.push_escape(c, span.start + at, length);
                (at, rest) = (at + length, &rest[c.len_utf8()..]);
                continue;
            }
            let equal = |&(r, d): &(u8, u8)| r == d && !(has_escapes && r == b'\\');
            let run = rest.floor_char_boundary(raw.bytes().zip(rest.bytes()).take_while(equal).count());
            if run > 0 {
                text.push_verbatim(&rest[..run], span.start + at);
                (at, rest) = (at + run, &rest[run..]);
            } else {
                // Only newlines are not as they stand there.
                let length = if raw.starts_with("\r\n") { 2 } else { raw.chars().next().map_or(0, char::len_utf8) };
                text.push_escape(c, span.start + at.min(literal.len()), length);
                (at, rest) = (at + length, &rest[c.len_utf8()..]);
            }
        }
        text
    }

    /// A text that stands in the source byte by byte from `start` on.
    pub fn verbatim(value: impl Into<String>, start: usize) -> Self {
        let value = value.into();
        let span = Span::new(start, start + value.len());
        Text { value, pieces: vec![Piece { decoded: 0, source: start, escape: None }], span }
    }

    /// Appends text that stands at `source` byte by byte.
    fn push_verbatim(&mut self, text: &str, source: usize) {
        self.pieces.push(Piece { decoded: self.value.len(), source, escape: None });
        self.value.push_str(text);
    }

    /// Appends a character written as an escape of `length` bytes at `source`.
    fn push_escape(&mut self, c: char, source: usize, length: usize) {
        self.pieces.push(Piece { decoded: self.value.len(), source, escape: Some(length) });
        self.value.push(c);
    }

    /// The decoded characters.
    pub fn as_str(&self) -> &str {
        &self.value
    }

    /// The whole literal in the source.
    pub fn span(&self) -> Span {
        self.span
    }

    /// The source range of the decoded bytes `start..end`.
    pub fn source_span(&self, start: usize, end: usize) -> Span {
        let first = self.source_of(start).map_or(self.span.end, |(from, _)| from);
        let last = if end > start { self.source_of(end - 1).map_or(first, |(_, to)| to) } else { first };
        Span::new(first, last)
    }

    /// The source range of the decoded byte at `position`; `None` when the text is empty.
    fn source_of(&self, position: usize) -> Option<(usize, usize)> {
        let index = self.pieces.partition_point(|p| p.decoded <= position).checked_sub(1)?;
        let piece = self.pieces[index];
        Some(match piece.escape {
            Some(length) => (piece.source, piece.source + length),
            None => (piece.source + position - piece.decoded, piece.source + position - piece.decoded + 1),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text of the string literal that is the value in `source`.
    fn literal(source: &str, value: &str) -> Text {
        let start = source.find(['"', '\'']).unwrap();
        Text::of_literal(source, Span::new(start, source.len()), value)
    }

    #[test]
    fn spans_go_back_through_escapes() {
        let text = literal(r#"key =     "a\u0062c""#, "abc");
        assert_eq!(text.as_str(), "abc");
        assert_eq!(text.source_span(0, 1), Span::new(11, 12));
        assert_eq!(text.source_span(1, 2), Span::new(12, 18));
        assert_eq!(text.source_span(1, 3), Span::new(12, 19));
    }

    #[test]
    fn every_notation_of_a_string_knows_its_places() {
        let place = |source: &str, value: &str, c: char| {
            let text = literal(source, value);
            assert_eq!(text.as_str(), value);
            let at = value.find(c).unwrap();
            let span = text.source_span(at, at + c.len_utf8());
            source[span.start..span.end].to_owned()
        };
        assert_eq!(place("k = 'a\\b'", "a\\b", 'b'), "b");
        assert_eq!(place("k = \"\\x41\\tµ\\\\b\"", "A\tµ\\b", 'µ'), "µ");
        assert_eq!(place("k = \"\\x41\\tµ\\\\b\"", "A\tµ\\b", '\\'), "\\\\");
        assert_eq!(place("k = \"\\x41\\tµ\\\\b\"", "A\tµ\\b", 'A'), "\\x41");
        assert_eq!(place("k = \"\\U000000e9x\"", "éx", 'x'), "x");
        assert_eq!(place("k = '''\r\na\r\nb'''", "a\r\nb", 'b'), "b");
        assert_eq!(place("k = \"\"\"\na \\\n   \n  b\"\"\"", "a b", 'b'), "b");
        assert_eq!(place("k = '''a\r\nb'''", "a\nb", '\n'), "\r\n");
        assert_eq!(place("k = '''a\r\nb'''", "a\nb", 'b'), "b");
    }

    #[test]
    fn the_empty_text_points_to_its_literal() {
        assert_eq!(literal("k = ''", "").source_span(0, 0), Span::new(6, 6));
    }
}
