//! The code of a C header without comments, and which of its lines are compiled.

use super::Refusal;

/// Code with blanks in the place of comments, of the insides of texts, and of line breaks that a backslash takes back. Places in it are
/// places in the header.
pub(super) struct Source {
    pub code: String,
    /// The name of the include guard, and where the guarded part ends.
    guard: Option<(String, usize)>,
}

/// A line, and whether it is compiled.
pub(super) struct Line<'t> {
    pub at: usize,
    pub text: &'t str,
    pub standing: Standing<'t>,
}

/// Whether a line is compiled.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Standing<'t> {
    Compiled,
    Dead,
    /// Unless a name is defined.
    Unless(&'t str),
    /// Under a condition that is not evaluated.
    Unknown,
}

/// What is open around a line: the condition that holds for it, and whether a part before may have been compiled.
struct Open<'t> {
    now: Standing<'t>,
    before: Before,
}

#[derive(Clone, Copy, PartialEq)]
enum Before {
    None,
    Some,
    Perhaps,
}

impl Source {
    /// Of the text of a header.
    ///
    /// What other readers of this text might see otherwise is refused: digraphs and trigraphs of directives, raw texts, a comment whose
    /// beginning is broken by a line.
    pub fn of(text: &str) -> Result<Source, Refusal> {
        let starts = |line: &str| ["%:", "??="].iter().any(|mark| line.trim_start().starts_with(mark));
        let mut at = 0;
        for line in text.split_inclusive('\n') {
            if starts(line) {
                return Err(Refusal::at(text, at, "directives are read with '#' alone".to_owned()));
            }
            at += line.len();
        }
        for mark in ["R\"", "/\\\n", "/\\\r\n", "??/"] {
            if let Some(at) = text.find(mark) {
                let shown = mark.trim_end();
                return Err(Refusal::at(text, at, format!("the header has {shown}, which is not read here")));
            }
        }
        let code = without_comments(text).replace('\u{feff}', "   ");
        let guard = guard(&code);
        Ok(Source { code, guard })
    }

    /// The directive of a line, and what follows it.
    pub fn directive(line: &str) -> Option<(&str, &str)> {
        let (directive, rest) = word(line.trim_start().strip_prefix('#')?.trim_start());
        Some((directive, rest.trim_start()))
    }

    /// The lines in their order.
    pub fn lines(&self) -> Vec<Line<'_>> {
        let mut open: Vec<Open<'_>> = Vec::new();
        let mut at = 0;
        let mut out = Vec::new();
        for text in self.code.split_inclusive('\n') {
            if let Some((directive, rest)) = Self::directive(text) {
                self.follow(&mut open, directive, rest.trim_end(), at);
            }
            out.push(Line { at, text, standing: standing(&open) });
            at += text.len();
        }
        out
    }

    /// What a directive changes.
    fn follow<'t>(&self, open: &mut Vec<Open<'t>>, directive: &str, rest: &'t str, at: usize) {
        match directive {
            "if" | "ifdef" | "ifndef" => {
                let is_guard =
                    self.guard.as_ref().is_some_and(|(name, end)| directive == "ifndef" && rest == name && at < *end);
                let is_first = open.is_empty() && self.code[..at].lines().all(|line| Self::directive(line).is_none());
                let now = match (directive, rest) {
                    ("if", "0") => Standing::Dead,
                    ("if", "1") => Standing::Compiled,
                    _ if is_guard && is_first => Standing::Compiled,
                    ("ifndef", name) => Standing::Unless(name),
                    _ => Standing::Unknown,
                };
                open.push(Open { before: before(&now), now });
            }
            "else" | "elif" | "elifdef" | "elifndef" => {
                if let Some(last) = open.last_mut() {
                    let is_else = directive == "else";
                    last.now = match last.before {
                        Before::Some => Standing::Dead,
                        Before::None if is_else => Standing::Compiled,
                        _ => Standing::Unknown,
                    };
                    last.before = match (last.before, before(&last.now)) {
                        (Before::Some, _) | (_, Before::Some) => Before::Some,
                        (Before::None, Before::None) => Before::None,
                        _ => Before::Perhaps,
                    };
                }
            }
            "endif" => {
                open.pop();
            }
            _ => {}
        }
    }

    /// How the line of a place stands.
    pub fn standing_at(&self, at: usize) -> Standing<'_> {
        let lines = self.lines();
        let line = lines.into_iter().take_while(|line| line.at <= at).last();
        line.map_or(Standing::Compiled, |line| line.standing)
    }

    /// Where a name stands outside of directives.
    pub fn places_of<'s>(&'s self, name: &'s str) -> impl Iterator<Item = usize> + 's {
        let is_part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
        let code = &self.code;
        code.match_indices(name).map(|(at, _)| at).filter(move |at| {
            let line_start = code[..*at].rfind('\n').map_or(0, |k| k + 1);
            let is_whole =
                !is_part(code[..*at].chars().next_back()) && !is_part(code[at + name.len()..].chars().next());
            is_whole && !code[line_start..].trim_start().starts_with('#')
        })
    }

    /// Whether a place is inside of braces other than those of a namespace or of `extern "C"`.
    pub fn is_inside_braces(&self, at: usize) -> bool {
        let mut open: Vec<bool> = Vec::new();
        let mut start = 0;
        // Braces of macros open nothing.
        let lines = self.code[..at].split_inclusive('\n');
        let code: String = lines.map(|line| if Self::directive(line).is_some() { ";\n" } else { line }).collect();
        for (k, c) in code.char_indices() {
            match c {
                '{' => {
                    let before = &code[start..k];
                    let words: Vec<&str> = before.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
                    open.push(!(words.contains(&"namespace") || words.contains(&"extern") && !before.contains('(')));
                }
                '}' => {
                    open.pop();
                }
                _ => {}
            }
            if [';', '{', '}'].contains(&c) {
                start = k + 1;
            }
        }
        open.contains(&true)
    }
}

fn before(now: &Standing<'_>) -> Before {
    match now {
        Standing::Compiled => Before::Some,
        Standing::Dead => Before::None,
        _ => Before::Perhaps,
    }
}

/// What conditions inside of each other amount to.
fn standing<'t>(open: &[Open<'t>]) -> Standing<'t> {
    let mut whole = Standing::Compiled;
    for Open { now, .. } in open {
        whole = match (&whole, now) {
            (Standing::Dead, _) | (_, Standing::Dead) => return Standing::Dead,
            (_, Standing::Compiled) => whole,
            (Standing::Compiled, now) => now.clone(),
            _ => Standing::Unknown,
        };
    }
    whole
}

/// The name of the include guard and where it ends: `#ifndef X` and `#define X` are the first directives, its `#endif` is the last one, and
/// there is no `#else` to it.
fn guard(code: &str) -> Option<(String, usize)> {
    let mut at = 0;
    let mut directives = Vec::new();
    for line in code.split_inclusive('\n') {
        if let Some((directive, rest)) = Source::directive(line) {
            directives.push((directive, rest.trim(), at));
        } else if directives.is_empty() && !line.trim().is_empty() {
            return None;
        }
        at += line.len();
    }
    let [("ifndef", name, _), ("define", defined, _), .., ("endif", _, end)] = directives.as_slice() else {
        return None;
    };
    let mut depth = 0;
    for (k, (directive, ..)) in directives.iter().enumerate() {
        match *directive {
            "if" | "ifdef" | "ifndef" => depth += 1,
            "endif" => depth -= 1,
            "else" | "elif" | "elifdef" | "elifndef" if depth == 1 => return None,
            _ => {}
        }
        if depth == 0 && k + 1 < directives.len() {
            return None;
        }
    }
    (word(defined).0 == *name && depth == 0).then(|| ((*name).to_owned(), *end))
}

/// The name that a text begins with, and what follows.
pub(super) fn word(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    text.split_at(end)
}

/// The end of a line break that a backslash here takes back, blanks between them included, as compilers have it.
fn taken_back(rest: &[u8]) -> Option<usize> {
    let blanks = rest.iter().skip(1).take_while(|b| matches!(b, b' ' | b'\t' | b'\r')).count();
    (rest.first() == Some(&b'\\') && rest.get(1 + blanks) == Some(&b'\n')).then_some(2 + blanks)
}

fn without_comments(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut out = bytes.to_vec();
    // Of every line break that is not the end of a line.
    let mut breaks = Vec::new();
    let mut blank = |from: usize, to: usize| out[from..to].iter_mut().filter(|b| **b != b'\n').for_each(|b| *b = b' ');
    let mut i = 0;
    while i < bytes.len() {
        let rest = &bytes[i..];
        if let Some(length) = taken_back(rest) {
            breaks.push(i + length - 1);
            blank(i, i + length);
            i += length;
        } else if rest.starts_with(b"/*") || rest.starts_with(b"//") {
            let is_block = rest[1] == b'*';
            let end = match is_block {
                true => text[i + 2..].find("*/").map_or(bytes.len(), |k| i + 2 + k + 2),
                false => end_of_line(bytes, i),
            };
            breaks.extend((i..end).filter(|k| bytes[*k] == b'\n'));
            blank(i, end);
            i = end;
        } else if rest[0] == b'"' || rest[0] == b'\'' && !is_in_number(bytes, i) {
            // The quotes stay: a text is no number.
            let end = end_of_text(bytes, i);
            breaks.extend((i..end).filter(|k| bytes[*k] == b'\n'));
            blank(i + 1, (end - 1).max(i + 1));
            i = end;
        } else {
            i += 1;
        }
    }
    breaks.into_iter().for_each(|at| out[at] = b' ');
    // Whole characters were replaced, byte by byte.
    String::from_utf8(out).unwrap_or_default()
}

/// Whether a quote parts digits: what it stands in begins with a digit.
fn is_in_number(bytes: &[u8], quote: usize) -> bool {
    let is_part = |b: &&u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'\'' | b'.');
    let length = bytes[..quote].iter().rev().take_while(is_part).count();
    length > 0 && bytes[quote - length].is_ascii_digit()
}

/// The end of the line, over the line breaks that are taken back.
fn end_of_line(bytes: &[u8], start: usize) -> usize {
    let mut i = start;
    while i < bytes.len() && bytes[i] != b'\n' {
        i += taken_back(&bytes[i..]).unwrap_or(1);
    }
    i.min(bytes.len())
}

/// Behind the closing quote of the text that begins here, or the end of its line.
fn end_of_text(bytes: &[u8], start: usize) -> usize {
    let mut i = start + 1;
    while i < bytes.len() && bytes[i] != b'\n' {
        if let Some(length) = taken_back(&bytes[i..]) {
            i += length;
            continue;
        }
        match bytes[i] {
            b'\\' => i += 1,
            quote if quote == bytes[start] => return i + 1,
            _ => {}
        }
        i += 1;
    }
    i.min(bytes.len())
}
