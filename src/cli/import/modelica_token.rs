//! Words and signs of Modelica, as far as linear models have them.

use super::refused;
use jurist_engine::error::{Diagnostic, Span};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// A name or a keyword.
    Word,
    /// A name in quotes, `'x_motor.phi'`; the token's text is without them.
    QuotedName,
    Number,
    Text,
    Sign,
}

/// A piece of the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'t> {
    pub kind: Kind,
    pub text: &'t str,
    pub span: Span,
}

impl Token<'_> {
    pub fn is(&self, text: &str) -> bool {
        matches!(self.kind, Kind::Word | Kind::Sign) && self.text == text
    }
}

/// All pieces; comments are left out.
pub(super) fn tokens(text: &str) -> Result<Vec<Token<'_>>, Diagnostic> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = match first {
            _ if first.is_whitespace() || first == '\u{feff}' => (None, first.len_utf8()),
            _ if rest.starts_with("//") => (None, rest.find('\n').unwrap_or(rest.len())),
            _ if rest.starts_with("/*") => (None, closed(rest, 2, "*/", at)?),
            '"' => (Some(Kind::Text), quoted(rest, '"', at)?),
            '\'' => (Some(Kind::QuotedName), quoted(rest, '\'', at)?),
            'A'..='Z' | 'a'..='z' | '_' => (Some(Kind::Word), while_word(rest)),
            '0'..='9' => (Some(Kind::Number), number(rest)),
            '.' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => (Some(Kind::Number), number(rest)),
            _ => (Some(Kind::Sign), first.len_utf8()),
        };
        if let Some(kind) = kind {
            let inner = if matches!(kind, Kind::Text | Kind::QuotedName) { 1 } else { 0 };
            let span = Span::new(at, at + length);
            out.push(Token { kind, text: &rest[inner..length - inner], span });
        }
        at += length;
    }
    Ok(out)
}

fn while_word(rest: &str) -> usize {
    rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len())
}

/// The length of a number: a sign belongs to it only behind `e`.
fn number(rest: &str) -> usize {
    let mut before = ' ';
    for (at, c) in rest.char_indices() {
        let goes_on =
            c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E') || matches!(c, '+' | '-') && matches!(before, 'e' | 'E');
        if !goes_on {
            return at;
        }
        before = c;
    }
    rest.len()
}

/// The length of what ends with `end`.
fn closed(rest: &str, begin: usize, end: &str, at: usize) -> Result<usize, Diagnostic> {
    let found = rest[begin..].find(end).map(|found| begin + found + end.len());
    found.ok_or_else(|| refused("a comment does not end").at(Span::new(at, at + begin), "begins here"))
}

/// The length of a text in quotes, in which a backslash takes the next character away.
fn quoted(rest: &str, quote: char, at: usize) -> Result<usize, Diagnostic> {
    let mut is_escaped = false;
    for (length, c) in rest.char_indices().skip(1) {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            _ if c == quote => return Ok(length + 1),
            _ => {}
        }
    }
    Err(refused("a text in quotes does not end").at(Span::new(at, at + 1), "begins here"))
}
