//! Which parts of a C file stand, as far as its conditions compare names with numbers.

use super::refused;
use super::token::{Kind, Token};
use jurist_engine::error::Diagnostic;
use std::collections::HashMap;

/// A name with the number that it has, as `-D NAME=NUMBER` gives it to a compiler.
pub type Define = (String, i64);

/// What stands, and what would have to be defined for what does not.
pub(super) struct Selected<'t> {
    pub tokens: Vec<Token<'t>>,
    /// The first conditions that do not hold, as `DS_ID=1`.
    pub missing: Vec<String>,
}

/// The names that have numbers.
type Defines = HashMap<String, i64>;

/// A condition that is open: whether it holds, whether a branch of it held before, and whether it stands at all.
struct Branch {
    holds: bool,
    held: bool,
    stands: bool,
}

/// The tokens outside of conditions that do not hold. A name without a number is 0, as in C.
pub(super) fn selected<'t>(tokens: &[Token<'t>], given: &[Define]) -> Result<Selected<'t>, Diagnostic> {
    let mut defines: Defines = given.iter().cloned().collect();
    let mut open: Vec<Branch> = Vec::new();
    let mut out = Selected { tokens: Vec::new(), missing: Vec::new() };
    for token in tokens {
        let stands = open.last().is_none_or(|branch| branch.stands && branch.holds);
        if token.kind != Kind::Directive {
            if stands {
                out.tokens.push(*token);
            }
            continue;
        }
        let line = without_comments(token.text);
        let (word, rest) = split_word(line.trim());
        match (word, open.last_mut()) {
            ("if" | "ifdef" | "ifndef", _) => {
                let holds = stands && begins(word, rest, &defines, token)?;
                open.push(Branch { holds, held: holds, stands });
                if stands && !holds {
                    wish(rest, &mut out.missing);
                }
            }
            ("elif", Some(branch)) => {
                branch.holds = branch.stands && !branch.held && condition(rest, &defines, token)?;
                branch.held |= branch.holds;
            }
            ("else", Some(branch)) => {
                branch.holds = !branch.held;
                branch.held = true;
            }
            ("endif", Some(_)) => {
                open.pop();
            }
            ("define", _) if stands => define(rest, &mut defines, given),
            _ => {}
        }
    }
    Ok(out)
}

fn begins(word: &str, rest: &str, defines: &Defines, token: &Token<'_>) -> Result<bool, Diagnostic> {
    let is_defined = || defines.contains_key(split_word(rest).0);
    match word {
        "ifdef" => Ok(is_defined()),
        "ifndef" => Ok(!is_defined()),
        _ => condition(rest, defines, token),
    }
}

/// `#define NAME NUMBER`; what the command line gives stays.
fn define(rest: &str, defines: &mut Defines, given: &[Define]) {
    let (name, value) = split_word(rest);
    if !name.is_empty() && given.iter().all(|(known, _)| known != name) {
        defines.insert(name.to_owned(), value.trim().parse().unwrap_or(0));
    }
}

/// `A`, `3`, `defined(A)`, `!A`, `A == 3`, `A != 3`, each in parentheses or not.
fn condition(text: &str, defines: &Defines, token: &Token<'_>) -> Result<bool, Diagnostic> {
    let unread = || {
        refused("this condition is not read")
            .at(token.span, "not a comparison of a name with a number")
            .help("let a compiler read it first: gcc -E FILE.c, with -D for what it asks")
    };
    let text = unwrapped(text);
    for (sign, equal) in [("==", true), ("!=", false)] {
        if let Some((left, right)) = text.split_once(sign) {
            let (left, right) = (value(left, defines), value(right, defines));
            return Ok((left.ok_or_else(unread)? == right.ok_or_else(unread)?) == equal);
        }
    }
    match text.strip_prefix('!') {
        Some(rest) => Ok(value(rest, defines).ok_or_else(unread)? == 0),
        None => Ok(value(text, defines).ok_or_else(unread)? != 0),
    }
}

fn value(text: &str, defines: &Defines) -> Option<i64> {
    let text = unwrapped(text);
    let of = |name: &str| defines.get(name).copied();
    let is_name = |text: &str| !text.is_empty() && split_word(text).0 == text;
    if let Some(name) = text.strip_prefix("defined").map(unwrapped).filter(|name| is_name(name)) {
        return Some(i64::from(of(name).is_some()));
    }
    match text.parse() {
        Ok(number) => Some(number),
        Err(_) if is_name(text) => Some(of(text).unwrap_or(0)),
        Err(_) => None,
    }
}

/// Adds what would make a condition hold, to be shown: `DS_ID=1`, once for a name.
fn wish(condition: &str, missing: &mut Vec<String>) {
    let Some((name, number)) = unwrapped(condition).split_once("==") else { return };
    let (name, wish) = (name.trim(), format!("{}={}", name.trim(), number.trim()));
    let is_new = missing.iter().all(|known| known.split('=').next() != Some(name));
    if is_new && wish.len() < 60 && missing.len() < 4 {
        missing.push(wish);
    }
}

/// Without blanks and one pair of parentheses around it all.
fn unwrapped(text: &str) -> &str {
    let text = text.trim();
    match text.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
        Some(inner) if !inner.contains(['(', ')']) => inner.trim(),
        _ => text,
    }
}

fn split_word(text: &str) -> (&str, &str) {
    let text = text.trim();
    text.split_at(text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len()))
}

fn without_comments(line: &str) -> String {
    let line = line.split("//").next().unwrap_or_default();
    let mut out = String::new();
    for (k, piece) in line.split("/*").enumerate() {
        out.push_str(if k == 0 { piece } else { piece.split_once("*/").map_or("", |(_, rest)| rest) });
    }
    out
}
