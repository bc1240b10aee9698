//! Words, numbers and signs of a text in C. What is no code is passed over: comments, lines of the preprocessor, texts in quotes.

use jurist_engine::error::Span;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    Number,
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
        self.text == text
    }

    pub fn is_word(&self) -> bool {
        self.kind == Kind::Word
    }
}

/// All tokens of a text, in linear time. What is not closed ends with the text.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut out = Vec::new();
    let mut at = 0;
    let mut is_line_start = true;
    while let Some(letter) = text[at..].chars().next() {
        let rest = &text[at..];
        let (length, kind) = match letter {
            '#' if is_line_start => (line(rest), None),
            '/' if rest.starts_with("//") => (line(rest), None),
            '/' if rest.starts_with("/*") => (rest[2..].find("*/").map_or(rest.len(), |end| end + 4), None),
            '"' | '\'' => (quoted(rest, letter), None),
            _ if letter.is_whitespace() || letter == '\u{feff}' => (letter.len_utf8(), None),
            _ if letter.is_ascii_alphabetic() || letter == '_' => (word(rest), Some(Kind::Word)),
            _ if letter.is_ascii_digit() => (number(rest), Some(Kind::Number)),
            '.' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => (number(rest), Some(Kind::Number)),
            _ => (letter.len_utf8(), Some(Kind::Sign)),
        };
        if let Some(kind) = kind {
            out.push(Token { kind, text: &rest[..length], span: Span::new(at, at + length) });
        }
        is_line_start = letter == '\n' || is_line_start && (letter.is_whitespace() || letter == '\u{feff}');
        at += length;
    }
    out
}

/// Up to the end of a line; a backslash there continues it.
fn line(rest: &str) -> usize {
    let mut length = 0;
    for part in rest.split_inclusive('\n') {
        length += part.len();
        if !part.trim_end_matches(['\n', '\r']).ends_with('\\') {
            // The end of the line stays: what follows stands at the start of a line.
            return length - usize::from(part.ends_with('\n'));
        }
    }
    length
}

fn word(rest: &str) -> usize {
    rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len())
}

/// A number in the sense of C's preprocessor: with all letters behind it, and signs behind an `e`.
fn number(rest: &str) -> usize {
    let is_hexadecimal = rest.starts_with("0x") || rest.starts_with("0X");
    let mut before = ' ';
    let belongs = |before: char, letter: char| {
        letter.is_ascii_alphanumeric()
            || ['.', '_'].contains(&letter)
            || ['+', '-'].contains(&letter) && ['e', 'E'].contains(&before) && !is_hexadecimal
    };
    let end = rest.find(|letter: char| !belongs(std::mem::replace(&mut before, letter), letter));
    end.unwrap_or(rest.len())
}

fn quoted(rest: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (at, letter) in rest.char_indices().skip(1) {
        match letter {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            // No text of C goes over the end of a line.
            '\n' => return at,
            _ if letter == quote => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

#[cfg(test)]
mod tests {
    use super::tokens;

    #[test]
    fn what_is_no_code_is_passed_over() {
        let text = "#define A \\\n 7\n/* .b = 3 */ x = {1.e+3f,-.5}; // y\n \"z\\\"/*\" 0x1e+2 'q' /* open";
        let found: Vec<&str> = tokens(text).iter().map(|token| token.text).collect();
        assert_eq!(found, ["x", "=", "{", "1.e+3f", ",", "-", ".5", "}", ";", "0x1e", "+", "2"]);
    }
}
