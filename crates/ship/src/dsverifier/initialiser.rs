//! Definitions `TYPE NAME = { .field = value, ... }` in the tokens of a text.

use super::number::{shown, whole};
use super::refused;
use super::token::Token;
use jurist_engine::error::{Diagnostic, Span};
use std::collections::BTreeSet;

/// A field with the tokens of its value.
#[derive(Clone, Debug)]
pub(super) struct Field<'t> {
    pub name: &'t str,
    pub value: Vec<Token<'t>>,
    pub span: Span,
}

/// A definition with all its fields.
#[derive(Clone, Debug)]
pub(super) struct Definition<'t> {
    pub kind: &'t str,
    pub name: &'t str,
    /// The place of its name.
    pub span: Span,
    pub fields: Vec<Field<'t>>,
}

impl<'t> Definition<'t> {
    /// The field of this name.
    pub fn field(&self, name: &str) -> Option<&Field<'t>> {
        self.fields.iter().find(|field| field.name == name)
    }
}

/// The types that are read.
const TYPES: [&str; 2] = ["digital_system", "implementation"];

/// An index is not longer than this, in tokens.
const INDEX: usize = 32;

/// More fields than a definition has.
const MOST_FIELDS: usize = 64;

/// All definitions of the types that are read, in linear time.
pub(super) fn definitions<'t>(tokens: &[Token<'t>]) -> Result<Vec<Definition<'t>>, Diagnostic> {
    let mut out: Vec<Definition<'t>> = Vec::new();
    let mut names = BTreeSet::new();
    let mut at = 0;
    while at < tokens.len() {
        let rest = &tokens[at..];
        match rest {
            [kind, name, equals, open, ..]
                if TYPES.contains(&kind.text) && name.is_word() && equals.is("=") && open.is("{") =>
            {
                let length = braced(&rest[3..]).ok_or_else(|| open_brace(open))?;
                let fields = fields(&rest[4..3 + length - 1])?;
                names.insert(name.text);
                out.push(Definition { kind: kind.text, name: name.text, span: name.span, fields });
                at += 3 + length;
                continue;
            }
            [name, dot, field, ..]
                if name.is_word()
                    && dot.is(".")
                    && field.is_word()
                    && is_assigned(&rest[3..])
                    && names.contains(name.text) =>
            {
                return Err(refused(format!("'{}' is changed by a statement", shown(name.text)))
                    .at(whole(&rest[..3]), "assigned")
                    .help("write the value in the braces of its definition: no statement is run"));
            }
            _ => {}
        }
        at += 1;
    }
    Ok(out)
}

/// Whether a field is given a value by what follows: `= value`, `[i] = value`, `+= value`, `++`.
fn is_assigned(rest: &[Token<'_>]) -> bool {
    let rest = match rest.first() {
        Some(open) if open.is("[") => {
            let close = rest.iter().take(INDEX).position(|token| token.is("]"));
            close.map_or(&[][..], |close| &rest[close + 1..])
        }
        _ => rest,
    };
    match rest {
        [equals, next, ..] if equals.is("=") => !next.is("="),
        [first, second, ..] if ["+", "-", "*", "/"].contains(&first.text) => {
            second.is("=") || first.text == second.text && ["+", "-"].contains(&first.text)
        }
        _ => false,
    }
}

fn open_brace(open: &Token<'_>) -> Diagnostic {
    refused("this brace is not closed").at(open.span, "opened here")
}

/// The number of tokens from an opening brace to the one that closes it.
fn braced(tokens: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate() {
        match token.text {
            "{" => depth += 1,
            "}" => depth = depth.checked_sub(1)?,
            _ => {}
        }
        if depth == 0 {
            return Some(at + 1);
        }
    }
    None
}

/// What stands between commas outside of braces and parentheses; a comma at the end is one too many, as in C.
pub(super) fn entries<'a, 't>(tokens: &'a [Token<'t>]) -> Vec<&'a [Token<'t>]> {
    let (mut out, mut depth, mut start) = (Vec::new(), 0_usize, 0);
    for (at, token) in tokens.iter().enumerate() {
        match token.text {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth = depth.saturating_sub(1),
            "," if depth == 0 => {
                out.push(&tokens[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    if start < tokens.len() {
        out.push(&tokens[start..]);
    }
    out
}

fn fields<'t>(tokens: &[Token<'t>]) -> Result<Vec<Field<'t>>, Diagnostic> {
    let mut out: Vec<Field<'t>> = Vec::new();
    for entry in entries(tokens) {
        if out.len() >= MOST_FIELDS {
            return Err(refused("a definition with too many fields").at(whole(entry), "one more"));
        }
        let [dot, name, equals, value @ ..] = entry else { return Err(unnamed(entry)) };
        if !(dot.is(".") && name.is_word() && equals.is("=")) {
            return Err(unnamed(entry));
        }
        let span = Span::new(dot.span.start, name.span.end);
        if let Some(first) = out.iter().find(|field| field.name == name.text) {
            return Err(refused(format!("'.{}' stands there twice", shown(name.text)))
                .at(span, "the second one")
                .also(first.span, "the first one"));
        }
        out.push(Field { name: name.text, value: value.to_vec(), span });
    }
    Ok(out)
}

fn unnamed(entry: &[Token<'_>]) -> Diagnostic {
    refused("a value without the name of its field")
        .at(whole(entry), "no '.name = value'")
        .help("write .b = { ... }, .b_size = ..., .a = { ... }, .a_size = ...")
}
