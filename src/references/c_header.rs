//! Numbers of C and C++ headers: `#define NAME literal` and `const TYPE NAME = literal;`.
//!
//! This is no preprocessor. One literal is read, perhaps with a sign and in parentheses; everything else is refused, so that no number
//! comes out that a compiler would not have.

use super::literal::{Format, Literal, literal};
use super::{Found, Refusal};
use jurist_algebra::number::{BinaryFormat, Rational};

/// The number of a name.
pub(super) fn number(text: &str, name: &str, as_decimal: bool) -> Result<Found, Refusal> {
    let code = without_comments(text);
    let definitions = definitions(&code, name)?;
    let [first, others @ ..] = definitions.as_slice() else {
        return Err(Refusal::of(format!("there is no '#define {name}' and no constant '{name}'")));
    };
    if let Some(other) = others.iter().find(|other| (other.body, &other.kind) != (first.body, &first.kind)) {
        let [one, two] = [first.at, other.at].map(|at| line(text, at));
        return Err(Refusal::at(
            text,
            other.at,
            format!("'{name}' is defined on line {one} and again on line {two}, differently"),
        ));
    }
    first.value(text, as_decimal)
}

/// How a name is defined.
#[derive(Debug, PartialEq)]
enum Kind<'t> {
    Macro,
    /// With the words of its declaration, without storage and qualifiers.
    Constant(Vec<&'t str>),
}

/// A definition of the name.
#[derive(Debug)]
struct Definition<'t> {
    at: usize,
    body: &'t str,
    kind: Kind<'t>,
    /// Whether the compiler may be given another one: it stands in `#ifndef NAME`.
    is_default: bool,
}

impl Definition<'_> {
    fn value(&self, text: &str, as_decimal: bool) -> Result<Found, Refusal> {
        let refuse = |why: String| Refusal::at(text, self.at, why);
        let Literal { written, value, format } = literal(self.body).map_err(refuse)?;
        let of_type = match &self.kind {
            Kind::Macro => None,
            Kind::Constant(words) if as_decimal => type_of(words).ok(),
            Kind::Constant(words) => Some(type_of(words).map_err(refuse)?),
        };
        if let Some(Type::Integer { low, high }) = of_type {
            if !value.is_integer() {
                return Err(refuse(format!("C cuts off the fraction of {written}")));
            }
            if value < Rational::from(low) || value > Rational::from(high) {
                return Err(refuse(format!(
                    "{written} may not fit into its type, which compilers make of different sizes"
                )));
            }
        }
        let rounded = |value: &Rational, format: BinaryFormat| {
            format.nearest(value).ok_or_else(|| refuse(format!("{written} is infinite in this format")))
        };
        let (number, how) = match (as_decimal, format, of_type) {
            (true, ..) => (value, "as it is written".to_owned()),
            (_, Format::LongDouble, _) => {
                return Err(refuse(format!(
                    "{written} is a long double, which compilers hold differently; as = \"decimal\" takes it as written"
                )));
            }
            (_, Format::Integer, None | Some(Type::Integer { .. })) => (value, "a whole number".to_owned()),
            (_, Format::Integer, Some(Type::Binary(to))) => (rounded(&value, to)?, format!("as {}", words(to))),
            (_, Format::Binary(own), None | Some(Type::Integer { .. })) => {
                (rounded(&value, own)?, format!("as {}", words(own)))
            }
            (_, Format::Binary(own), Some(Type::Binary(to))) => {
                let first = rounded(&value, own)?;
                let how = if own == to {
                    format!("as {}", words(own))
                } else {
                    format!("as {}, then as {}", words(own), words(to))
                };
                (rounded(&first, to)?, how)
            }
        };
        let how = if self.is_default { format!("{how}, unless the compiler is given another") } else { how };
        Ok(Found { number, written: written.to_owned(), how, line: line(text, self.at) })
    }
}

fn words(format: BinaryFormat) -> &'static str {
    match format {
        BinaryFormat::Single => "float32",
        BinaryFormat::Double => "double",
    }
}

/// What a declaration holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Type {
    /// With the values that it has at least, whatever compiler there is; `int` is taken for 32 bits.
    Integer {
        low: i64,
        high: i64,
    },
    Binary(BinaryFormat),
}

fn type_of(words: &[&str]) -> Result<Type, String> {
    let is = |names: &[&str]| words.iter().any(|word| names.contains(word));
    if is(&["long"]) && is(&["double"]) {
        return Err("a long double is held differently by compilers; as = \"decimal\" takes it as written".to_owned());
    }
    if is(&["float", "float32_t", "float_t32", "real32_T", "single"]) {
        return Ok(Type::Binary(BinaryFormat::Single));
    }
    if is(&["double", "float64_t", "real_T", "real64_T", "auto"]) {
        return Ok(Type::Binary(BinaryFormat::Double));
    }
    let fixed = |word: &&str| -> Option<(bool, u32)> {
        let (is_unsigned, rest) = word.strip_prefix('u').map_or((false, *word), |rest| (true, rest));
        let bits =
            rest.strip_prefix("int")?.strip_suffix("_t")?.trim_start_matches("_least").trim_start_matches("_fast");
        bits.parse().ok().filter(|bits| [8, 16, 32, 64].contains(bits)).map(|bits| (is_unsigned, bits))
    };
    let known = ["int", "long", "short", "char", "unsigned", "signed"];
    let named = words.iter().find_map(fixed).or_else(|| {
        let bits = if is(&["char"]) {
            8
        } else if is(&["short"]) {
            16
        } else {
            32
        };
        let is_whole = !words.is_empty() && words.iter().all(|word| known.contains(word));
        is_whole.then(|| (is(&["unsigned"]), bits)).or_else(|| is(&["size_t"]).then_some((true, 32)))
    });
    if let Some((is_unsigned, bits)) = named {
        let most = i64::try_from((1_i128 << (bits - 1)) - 1).unwrap_or(i64::MAX);
        // Whether a plain char has a sign is the compiler's choice.
        let low = if is_unsigned || is(&["char"]) && !is(&["signed"]) { 0 } else { -most - 1 };
        let high = if is_unsigned && bits < 64 { 2 * most + 1 } else { most };
        return Ok(Type::Integer { low, high });
    }
    let shown = words.join(" ");
    Err(format!("the type '{shown}' is not known here; as = \"decimal\" takes the literal as written"))
}

/// The text with blanks in the place of comments, of the insides of texts, and of line breaks that a backslash takes back.
fn without_comments(text: &str) -> String {
    let mut out: Vec<u8> = text.as_bytes().to_vec();
    let bytes = text.as_bytes();
    let mut blank = |from: usize, to: usize| out[from..to].iter_mut().filter(|b| **b != b'\n').for_each(|b| *b = b' ');
    let mut breaks = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        let rest = &bytes[i..];
        let end = if rest.starts_with(b"/*") {
            text[i + 2..].find("*/").map_or(bytes.len(), |k| i + 2 + k + 2)
        } else if rest.starts_with(b"//") {
            end_of_line_comment(text, i)
        } else if rest[0] == b'"' || (rest[0] == b'\'' && !(i > 0 && bytes[i - 1].is_ascii_hexdigit())) {
            end_of_text(bytes, i)
        } else if rest.starts_with(b"\\\n") || rest.starts_with(b"\\\r\n") {
            let end = i + if rest[1] == b'\n' { 2 } else { 3 };
            breaks.push(end - 1);
            end
        } else {
            i += 1;
            continue;
        };
        // A comment may break lines, which a directive does not end at.
        if rest.starts_with(b"/*") || rest.starts_with(b"//") {
            breaks.extend((i..end).filter(|k| bytes[*k] == b'\n'));
        }
        // The quotes stay: a text is no number.
        let is_text = matches!(rest[0], b'"' | b'\'');
        if is_text {
            blank(i + 1, (end - 1).max(i + 1));
        } else {
            blank(i, end);
        }
        i = end;
    }
    breaks.into_iter().for_each(|at| out[at] = b' ');
    // Whole characters were replaced, byte by byte.
    String::from_utf8(out).unwrap_or_default()
}

/// The end of the line that the comment ends with; a backslash before it takes the end back.
fn end_of_line_comment(text: &str, start: usize) -> usize {
    let ends = text[start..].match_indices('\n').map(|(k, _)| start + k);
    let is_taken_back = |end: &usize| text[start..*end].trim_end_matches('\r').ends_with('\\');
    ends.into_iter().find(|end| !is_taken_back(end)).unwrap_or(text.len())
}

/// Behind the closing quote of the text that begins here, or the end of its line.
fn end_of_text(bytes: &[u8], start: usize) -> usize {
    let mut i = start + 1;
    while i < bytes.len() && bytes[i] != b'\n' {
        match bytes[i] {
            b'\\' => i += 1,
            quote if quote == bytes[start] => return i + 1,
            _ => {}
        }
        i += 1;
    }
    i.min(bytes.len())
}

/// A condition that lines stand in.
#[derive(Clone, Copy, PartialEq)]
enum Condition<'t> {
    True,
    False,
    /// `#ifndef` of a name.
    Undefined(&'t str),
    Unknown(usize),
}

/// The definitions of a name in code without comments. Those in `#if 0` are none; one in another condition is refused.
fn definitions<'t>(code: &'t str, name: &str) -> Result<Vec<Definition<'t>>, Refusal> {
    let mut found: Vec<Definition<'t>> = Vec::new();
    let mut conditions: Vec<Condition<'t>> = Vec::new();
    let guard = guard(code);
    let mut start = 0;
    for text in code.split_inclusive('\n') {
        let at = start;
        start += text.len();
        let Some(directive) = text.trim_start().strip_prefix('#') else { continue };
        let (word, rest) = word(directive.trim_start());
        match word {
            "if" | "ifdef" | "ifndef" => conditions.push(match (word, rest.trim()) {
                ("if", "0") => Condition::False,
                ("if", "1") => Condition::True,
                ("ifndef", defined) if Some(defined) == guard => Condition::True,
                ("ifndef", defined) => Condition::Undefined(defined),
                _ => Condition::Unknown(at),
            }),
            "else" | "elif" => {
                if let Some(last) = conditions.last_mut() {
                    *last = match (*last, word) {
                        (Condition::False, "else") => Condition::True,
                        (Condition::True, _) => Condition::False,
                        _ => Condition::Unknown(at),
                    };
                }
            }
            "endif" => {
                conditions.pop();
            }
            "undef" if rest.trim() == name && !conditions.contains(&Condition::False) => {
                return Err(Refusal::at(code, at, format!("'{name}' is taken back by #undef")));
            }
            "define" => {
                let (defined, body) = self::word(rest.trim_start());
                if defined == name {
                    if body.starts_with('(') {
                        return Err(Refusal::at(code, at, format!("'{name}' is a macro with arguments")));
                    }
                    found.extend(conditional(&conditions, code, name, at)?.map(|is_default| Definition {
                        at,
                        body: body.trim(),
                        kind: Kind::Macro,
                        is_default,
                    }));
                }
            }
            _ => {}
        }
    }
    found.extend(constants(code, name)?);
    Ok(found)
}

/// Whether a definition is a default; `None` where it is never compiled.
fn conditional(conditions: &[Condition<'_>], code: &str, name: &str, at: usize) -> Result<Option<bool>, Refusal> {
    if conditions.contains(&Condition::False) {
        return Ok(None);
    }
    let mut is_default = false;
    for condition in conditions {
        match condition {
            Condition::Undefined(defined) if *defined == name => is_default = true,
            Condition::Undefined(_) | Condition::Unknown(_) => {
                let why = format!("'{name}' is defined under a condition, which is not evaluated here");
                return Err(Refusal::at(code, at, why));
            }
            _ => {}
        }
    }
    Ok(Some(is_default))
}

/// The name of the file's include guard: `#ifndef X`, and `#define X` next.
fn guard(code: &str) -> Option<&str> {
    let mut directives = code.lines().map(str::trim).filter(|line| !line.is_empty());
    let first = directives.next()?.strip_prefix('#')?.trim_start().strip_prefix("ifndef")?.trim();
    let second = directives.next()?.strip_prefix('#')?.trim_start().strip_prefix("define")?.trim();
    (first == second).then_some(first)
}

/// The constants of this name: statements that end with `NAME = body;` and say `const` or `constexpr`.
fn constants<'t>(code: &'t str, name: &str) -> Result<Vec<Definition<'t>>, Refusal> {
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(k) = code[from..].find(name) {
        let at = from + k;
        from = at + name.len();
        let is_part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
        if is_part(code[..at].chars().next_back()) || is_part(code[from..].chars().next()) {
            continue;
        }
        let line_start = code[..at].rfind('\n').map_or(0, |k| k + 1);
        if code[line_start..].trim_start().starts_with('#') {
            continue;
        }
        let start = code[..at].rfind([';', '{', '}']).map_or(0, |k| k + 1);
        // A directive before the declaration ends with its line.
        let declaration = code[start..at].lines().filter(|line| !line.trim_start().starts_with('#'));
        let words: Vec<&str> = declaration.flat_map(str::split_whitespace).collect();
        let behind = code[from..].trim_start();
        let is_declared =
            !words.is_empty() && words.iter().all(|w| w.chars().all(|c| c.is_alphanumeric() || "_:<>".contains(c)));
        let is_array = behind.starts_with('[') || behind.starts_with('{');
        if !is_declared || !(behind.starts_with('=') && !behind.starts_with("==") || is_array) {
            continue;
        }
        if is_array {
            return Err(Refusal::at(code, at, format!("'{name}' is not a single number with '='")));
        }
        if !words.iter().any(|w| ["const", "constexpr"].contains(w)) {
            return Err(Refusal::at(
                code,
                at,
                format!("'{name}' is a variable: without 'const' it may have another value"),
            ));
        }
        let body = behind[1..].split_once(';').map_or(&behind[1..], |(body, _)| body);
        let rest = ["const", "constexpr", "static", "inline", "extern", "volatile", "register"];
        let words = words.into_iter().filter(|w| !rest.contains(w)).collect();
        if conditions_at(code, at) {
            return Err(Refusal::at(
                code,
                at,
                format!("'{name}' is defined under a condition, which is not evaluated here"),
            ));
        }
        found.push(Definition { at, body: body.trim(), kind: Kind::Constant(words), is_default: false });
    }
    Ok(found)
}

/// Whether a place stands in a condition other than the include guard's.
fn conditions_at(code: &str, at: usize) -> bool {
    let guard = guard(code);
    let mut open = Vec::new();
    for line in code[..at].lines() {
        let Some(directive) = line.trim_start().strip_prefix('#') else { continue };
        let (word, rest) = word(directive.trim_start());
        match word {
            "if" | "ifdef" | "ifndef" => open.push(!(word == "ifndef" && Some(rest.trim()) == guard)),
            "endif" => {
                open.pop();
            }
            _ => {}
        }
    }
    open.contains(&true)
}

/// The name that a text begins with, and what follows.
fn word(text: &str) -> (&str, &str) {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    text.split_at(end)
}

/// The number of the line.
fn line(text: &str, at: usize) -> usize {
    text.as_bytes()[..at.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1
}
