//! Expression text to tokens.

use super::located::Text;
use crate::error::{Code, Diagnostic, Span};
use jurist_algebra::number::{Rational, parse_decimal_literal, scan_decimal_literal};

/// A token and its place in the source text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Token {
    pub kind: TokenKind,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TokenKind {
    Number(Rational),
    Name(String),
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Open,
    Close,
    End,
}

impl TokenKind {
    /// What to call the token in a message.
    pub fn describe(&self) -> String {
        match self {
            TokenKind::Number(_) => "a number".into(),
            TokenKind::Name(name) => format!("the name '{}'", super::names::shorten(name)),
            TokenKind::Plus => "'+'".into(),
            TokenKind::Minus => "'-'".into(),
            TokenKind::Times => "'*'".into(),
            TokenKind::Over => "'/'".into(),
            TokenKind::Power => "'^'".into(),
            TokenKind::Open => "'('".into(),
            TokenKind::Close => "')'".into(),
            TokenKind::End => "the end of the expression".into(),
        }
    }
}

/// Whether `c` may begin a name.
pub(crate) fn begins_name(c: char) -> bool {
    c == '_' || (c.is_alphabetic() && !is_blank_letter(c))
}

/// Whether `c` may stand in a name.
pub(crate) fn continues_name(c: char) -> bool {
    c == '_' || (c.is_alphanumeric() && !is_blank_letter(c))
}

/// Whether `c` is a letter that is not seen: the fillers of the Korean script. All letters of Unicode that text may be drawn
/// without (`Default_Ignorable_Code_Point`) are among them; in a name they would hide what is meant.
pub fn is_blank_letter(c: char) -> bool {
    matches!(c, '\u{115f}' | '\u{1160}' | '\u{3164}' | '\u{ffa0}')
}

/// Whether `text` is a name as expressions know them.
pub(crate) fn is_name(text: &str) -> bool {
    text.chars().next().is_some_and(begins_name) && text.chars().all(continues_name)
}

/// How products are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Products {
    /// With an operator only, as in model files.
    Written,
    /// Also without one: `2z`, `K(s + 1)`, `(s + 1)(s + 2)`.
    Implied,
}

/// All tokens of `text`, ending with [`TokenKind::End`].
pub(crate) fn lex(text: &Text, products: Products) -> Result<Vec<Token>, Diagnostic> {
    let source = text.as_str();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = source[at..].chars().next() {
        let rest = &source[at..];
        let (kind, length) = match c {
            _ if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            '+' => (TokenKind::Plus, 1),
            '-' => (TokenKind::Minus, 1),
            '*' => (TokenKind::Times, 1),
            '/' => (TokenKind::Over, 1),
            '^' => (TokenKind::Power, 1),
            '(' => (TokenKind::Open, 1),
            ')' => (TokenKind::Close, 1),
            _ if c.is_ascii_digit() || c == '.' => number(text, at, products)?,
            _ if begins_name(c) => {
                let length = rest.find(|c| !continues_name(c)).unwrap_or(rest.len());
                (TokenKind::Name(rest[..length].to_owned()), length)
            }
            _ => return Err(strange_character(text, at, c)),
        };
        tokens.push(Token { kind, span: text.source_span(at, at + length) });
        at += length;
    }
    tokens.push(Token { kind: TokenKind::End, span: text.source_span(at, at) });
    Ok(tokens)
}

/// The number literal at `at`.
fn number(text: &Text, at: usize, products: Products) -> Result<(TokenKind, usize), Diagnostic> {
    let rest = &text.as_str()[at..];
    let length = scan_decimal_literal(rest);
    let after = rest[length..].chars().next();
    let is_factor = products == Products::Implied && is_followed_by_name(&rest[..length], &rest[length..]);
    if length == 0 || (!is_factor && after.is_some_and(|c| c == '.' || continues_name(c))) {
        let run = rest.find(|c| !(c == '.' || continues_name(c))).unwrap_or(rest.len());
        let error = Diagnostic::error(Code::Number, "this is not a number")
            .at(text.source_span(at, at + run.max(1)), "neither a number nor a name");
        let with_name = length > 0 && after.is_some_and(begins_name);
        return Err(if with_name && products == Products::Written {
            error.help("multiplication is written out: '2*K', not '2K'")
        } else {
            error.help("numbers look like 12, 0.046, 46e-3 or 1_000")
        });
    }
    match parse_decimal_literal(&rest[..length]) {
        Ok(value) => Ok((TokenKind::Number(value), length)),
        Err(error) => Err(Diagnostic::error(Code::Number, error.to_string())
            .at(text.source_span(at, at + length), "not accepted")
            .help("write a shorter number")),
    }
}

/// True if a name begins right after a number, as in `2z`. What looks like a number in another notation (`0x10`, `2e`) is no product.
fn is_followed_by_name(literal: &str, rest: &str) -> bool {
    let name = &rest[..rest.find(|c| !continues_name(c)).unwrap_or(rest.len())];
    name.starts_with(begins_name) && literal != "0" && !name.eq_ignore_ascii_case("e")
}

fn strange_character(text: &Text, at: usize, c: char) -> Diagnostic {
    let span = text.source_span(at, at + c.len_utf8());
    if is_blank_letter(c) {
        let message = format!("a character that cannot be seen, '{}'", c.escape_unicode());
        return Diagnostic::error(Code::Syntax, message).at(span, "not part of a name").help("delete it");
    }
    let error = Diagnostic::error(Code::Syntax, format!("unexpected character '{}'", c.escape_debug()));
    let error = error.at(span, "not part of an expression");
    match c {
        '−' | '–' | '—' => error.help("write the minus sign as '-'"),
        '·' | '×' | '⋅' => error.help("write multiplication as '*'"),
        '÷' => error.help("write division as '/'"),
        '²' | '³' => error.help("write powers with '^', for example 'z^2'"),
        '[' | ']' | '{' | '}' => error.help("only round parentheses group terms"),
        ',' => error.help("the decimal point is '.'"),
        '=' => error.help("an expression has no '='; write the side that is compared with zero"),
        _ => error.help("expressions are made of names, numbers, functions, + - * / ^ and parentheses"),
    }
}
