//! Words, numbers and signs of C, and lines of the preprocessor.

use super::refused;
use jurist_engine::error::{Diagnostic, Span};

/// Longer files are refused.
const MAX_TOKENS: usize = 4_000_000;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A name or a keyword.
    Word,
    Number,
    /// A text or a character in quotes.
    Text,
    Sign,
    /// A line that begins with `#`, without that sign.
    Directive,
}

/// A piece of the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'t> {
    pub kind: Kind,
    pub text: &'t str,
    pub span: Span,
}

impl Token<'_> {
    /// Whether it is this word or sign.
    pub fn is(&self, text: &str) -> bool {
        matches!(self.kind, Kind::Word | Kind::Sign) && self.text == text
    }
}

/// All pieces; comments are left out.
pub(super) fn tokens(text: &str) -> Result<Vec<Token<'_>>, Diagnostic> {
    let mut out = Vec::new();
    let (mut at, mut begins_line) = (0, true);
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = match first {
            _ if first.is_whitespace() || first == '\u{feff}' => (None, first.len_utf8()),
            _ if rest.starts_with("//") => (None, line_length(rest)),
            _ if rest.starts_with("/*") => (None, comment(rest, at)?),
            '#' if begins_line => (Some(Kind::Directive), line_length(rest)),
            '"' | '\'' => (Some(Kind::Text), quoted(rest, first)),
            'A'..='Z' | 'a'..='z' | '_' => (Some(Kind::Word), word(rest)),
            '0'..='9' => (Some(Kind::Number), number(rest)),
            '.' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => (Some(Kind::Number), number(rest)),
            _ => (Some(Kind::Sign), first.len_utf8()),
        };
        begins_line = first == '\n' || begins_line && kind.is_none();
        if let Some(kind) = kind {
            let skipped = usize::from(kind == Kind::Directive);
            out.push(Token { kind, text: &rest[skipped..length], span: Span::new(at, at + length) });
        }
        if out.len() > MAX_TOKENS {
            return Err(refused("the file is too long").at(Span::new(at, at + 1), "not read any further"));
        }
        at += length;
    }
    Ok(out)
}

/// The length of a line that a backslash at its end makes longer.
fn line_length(rest: &str) -> usize {
    let mut length = 0;
    for line in rest.split_inclusive('\n') {
        length += line.len();
        if !line.trim_end_matches(['\n', '\r']).ends_with('\\') {
            return length - usize::from(line.ends_with('\n'));
        }
    }
    rest.len()
}

fn comment(rest: &str, at: usize) -> Result<usize, Diagnostic> {
    let found = rest[2..].find("*/").map(|end| end + 4);
    found.ok_or_else(|| refused("a comment does not end").at(Span::new(at, at + 2), "begins here"))
}

/// The length of a text in quotes; one that does not end on its line ends with it.
fn quoted(rest: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (length, c) in rest.char_indices().skip(1) {
        match c {
            '\n' => return length,
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            _ if c == quote => return length + 1,
            _ => {}
        }
    }
    rest.len()
}

fn word(rest: &str) -> usize {
    rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len())
}

/// The length of a number of the preprocessor: a sign belongs to it only behind `e` or `p`.
fn number(rest: &str) -> usize {
    let mut before = ' ';
    for (at, c) in rest.char_indices() {
        let is_exponent_sign = matches!(c, '+' | '-') && matches!(before, 'e' | 'E' | 'p' | 'P');
        if !c.is_ascii_alphanumeric() && !matches!(c, '.' | '_') && !is_exponent_sign {
            return at;
        }
        before = c;
    }
    rest.len()
}
