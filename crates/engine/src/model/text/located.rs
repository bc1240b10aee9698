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
    /// An empty text for the literal at `span`.
    pub(crate) fn empty(span: Span) -> Self {
        Text { value: String::new(), pieces: Vec::new(), span }
    }

    /// A text that stands in the source byte by byte from `start` on.
    pub fn verbatim(value: impl Into<String>, start: usize) -> Self {
        let value = value.into();
        let span = Span::new(start, start + value.len());
        Text { value, pieces: vec![Piece { decoded: 0, source: start, escape: None }], span }
    }

    /// Appends text that stands at `source` byte by byte.
    pub(crate) fn push_verbatim(&mut self, text: &str, source: usize) {
        self.pieces.push(Piece { decoded: self.value.len(), source, escape: None });
        self.value.push_str(text);
    }

    /// Appends a character written as an escape of `length` bytes at `source`.
    pub(crate) fn push_escape(&mut self, c: char, source: usize, length: usize) {
        self.pieces.push(Piece { decoded: self.value.len(), source, escape: Some(length) });
        self.value.push(c);
    }

    /// Where in the source the next byte is to be looked for.
    pub(crate) fn source_end(&self) -> Option<usize> {
        let last = self.pieces.last()?;
        Some(last.source + last.escape.unwrap_or(self.value.len() - last.decoded))
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

    #[test]
    fn spans_go_back_through_escapes() {
        // The source literal is "a\u0062c" at offset 10.
        let mut text = Text::empty(Span::new(10, 20));
        text.push_verbatim("a", 11);
        text.push_escape('b', 12, 6);
        text.push_verbatim("c", 18);
        assert_eq!(text.as_str(), "abc");
        assert_eq!(text.source_span(0, 1), Span::new(11, 12));
        assert_eq!(text.source_span(1, 2), Span::new(12, 18));
        assert_eq!(text.source_span(1, 3), Span::new(12, 19));
        assert_eq!(text.source_end(), Some(19));
    }

    #[test]
    fn the_empty_text_points_to_its_literal() {
        assert_eq!(Text::empty(Span::new(3, 5)).source_span(0, 0), Span::new(5, 5));
    }
}
