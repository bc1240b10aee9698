//! Numbers of YAML and JSON files, by a path of keys. What is valid JSON is read by the reader of YAML, but for characters written as surrogates.

use super::{Found, Refusal};
use jurist_algebra::number::parse_number;
use saphyr_parser::{Event, Parser, ScalarStyle};
use serde::de::IgnoredAny;
use std::collections::HashSet;

/// Deeper files are refused.
const MAX_DEPTH: usize = 64;

/// What is open around a node.
enum Open {
    /// A mapping: the key whose value comes next, and all keys so far.
    Mapping(Option<String>, HashSet<String>),
    /// A sequence, and the index that comes next.
    Sequence(usize),
}

/// A scalar of the file.
struct Scalar {
    text: String,
    is_plain: bool,
    line: usize,
}

/// The number at a path such as `speed.gains[0].K_p`, or a JSON pointer, `/speed/gains/0/K_p`.
pub(super) fn number(text: &str, path: &str) -> Result<Found, Refusal> {
    let Some(scalar) = scalar_at(text, &steps(path))? else {
        return Err(Refusal::of(format!("there is nothing at '{path}'")));
    };
    let written = scalar.text;
    let refuse = |why: String| Refusal { line: Some(scalar.line), why };
    if !scalar.is_plain {
        return Err(refuse(format!("'{written}' is a text, not a number")));
    }
    let decimal = written.strip_prefix(['+', '-']).unwrap_or(&written);
    // With a zero in front it may be octal, and underscores are digits to some readers only.
    let is_octal = decimal.len() > 1 && decimal.starts_with('0') && decimal.bytes().all(|b| b.is_ascii_digit());
    let is_plain = decimal.starts_with(|c: char| c.is_ascii_digit() || c == '.') && !decimal.contains(['/', '_']);
    let is_decimal = is_plain && !is_octal;
    match parse_number(written.strip_prefix('+').unwrap_or(&written)) {
        Ok(number) if is_decimal => {
            Ok(Found { number, how: "as it is written".to_owned(), line: scalar.line, written })
        }
        _ => Err(refuse(format!("'{written}' is not a decimal number"))),
    }
}

/// The number at a path of a JSON file.
pub(super) fn number_of_json(text: &str, path: &str) -> Result<Found, Refusal> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if let Err(error) = serde_json::from_str::<IgnoredAny>(text) {
        return Err(Refusal { line: Some(error.line()), why: format!("the file is not JSON: {error}") });
    }
    // A surrogate is half of a character, which YAML has no escape for.
    let mut whole = text.to_owned();
    let mut from = 0;
    while let Some(at) = whole[from..].find("\\u").map(|k| from + k) {
        let is_high = |c: char| "89abcdefABCDEF".contains(c);
        if whole[at + 2..].starts_with(['d', 'D']) && whole[at + 3..].starts_with(is_high) {
            whole.replace_range(at..at + 6, "??????");
        }
        from = at + 2;
    }
    number(&whole, path)
}

/// The keys and indices of a path.
fn steps(path: &str) -> Vec<String> {
    match path.strip_prefix('/') {
        Some(pointer) => pointer.split('/').map(|step| step.replace("~1", "/").replace("~0", "~")).collect(),
        None => {
            let dotted = path.replace('[', ".").replace(']', "");
            dotted.strip_prefix('.').unwrap_or(&dotted).split('.').map(str::to_owned).collect()
        }
    }
}

/// The scalar at a path.
fn scalar_at(text: &str, wanted: &[String]) -> Result<Option<Scalar>, Refusal> {
    let mut open: Vec<Open> = Vec::new();
    let mut found: Option<Scalar> = None;
    let mut documents = 0;
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| Refusal {
            line: Some(error.marker().line()),
            why: format!("the file is not understood: {}", error.info()),
        })?;
        let line = span.start.line();
        let refuse = |why: &str| Err(Refusal { line: Some(line), why: why.to_owned() });
        let is_key = matches!(open.last(), Some(Open::Mapping(None, _)));
        let is_wanted = !is_key && is_at(&open, wanted);
        match event {
            Event::DocumentStart(_) => documents += 1,
            Event::Scalar(key, ..) if is_key => {
                if let Some(Open::Mapping(next, known)) = open.last_mut() {
                    if !known.insert(key.to_string()) {
                        return refuse(&format!("the key '{key}' stands there twice"));
                    }
                    *next = Some(key.into_owned());
                }
            }
            Event::Scalar(_, _, _, Some(_)) if is_wanted => return refuse("a number with a tag is not read"),
            Event::Scalar(value, style, ..) => {
                if is_wanted && found.is_some() || documents > 1 {
                    return refuse(if documents > 1 {
                        "the file has several documents"
                    } else {
                        "the path stands there twice"
                    });
                }
                if is_wanted {
                    found = Some(Scalar { text: value.into_owned(), is_plain: style == ScalarStyle::Plain, line });
                }
                ended(&mut open);
            }
            Event::Alias(_) if is_wanted || is_key => {
                return refuse("an alias is not followed: ask for what it stands for");
            }
            Event::Alias(_) => ended(&mut open),
            Event::MappingStart(..) | Event::SequenceStart(..) if is_wanted => {
                return refuse("several values stand there, not a number");
            }
            Event::MappingStart(..) | Event::SequenceStart(..) if is_key => return refuse("a key is not a text"),
            Event::MappingStart(..) | Event::SequenceStart(..) if open.len() >= MAX_DEPTH => {
                return refuse("the file is nested too deeply");
            }
            Event::MappingStart(..) => open.push(Open::Mapping(None, HashSet::new())),
            Event::SequenceStart(..) => open.push(Open::Sequence(0)),
            Event::MappingEnd | Event::SequenceEnd => {
                open.pop();
                ended(&mut open);
            }
            _ => {}
        }
    }
    Ok(found)
}

/// True if the next node is the wanted one.
fn is_at(open: &[Open], wanted: &[String]) -> bool {
    let is_step = |(open, step): (&Open, &String)| match open {
        Open::Mapping(key, _) => key.as_ref() == Some(step),
        Open::Sequence(index) => index.to_string() == *step,
    };
    open.len() == wanted.len() && open.iter().zip(wanted).all(is_step)
}

/// A value has ended: the next one has another place.
fn ended(open: &mut [Open]) {
    match open.last_mut() {
        Some(Open::Mapping(key, _)) => *key = None,
        Some(Open::Sequence(index)) => *index += 1,
        None => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const YAML: &str = "# gains\r\nspeed:\r\n  K_p: 0.1 # per unit\r\n  list: [1, 2.5e-3, {x: -7}]\r\n  text: '0.1'\r\nother: &a 4\r\nalias: *a\r\nK_p: 9\r\n";
    const JSON: &str = "{\"speed\": {\"K_p\": 1e-1, \"list\": [1, 0.0025, {\"x\": -7}], \"a.b\": 3}, \"t\": true}";

    #[test]
    fn numbers_are_found_by_their_path() {
        let read = |text, path| number(text, path).map(|f| (f.number.to_string(), f.line));
        assert_eq!(read(YAML, "speed.K_p").unwrap(), ("1/10".to_owned(), 3));
        assert_eq!(read(YAML, "speed.list[1]").unwrap(), ("1/400".to_owned(), 4));
        assert_eq!(read(YAML, "/speed/list/2/x").unwrap().0, "-7");
        assert_eq!(read(YAML, "K_p").unwrap().0, "9");
        assert_eq!(read(JSON, "speed.K_p").unwrap().0, "1/10");
        assert_eq!(read(JSON, "speed.list.2.x").unwrap().0, "-7");
        assert_eq!(read(JSON, "/speed/a.b").unwrap().0, "3");
    }

    #[test]
    fn what_is_no_number_is_refused_with_its_line() {
        for (text, path, why, line) in [
            (YAML, "speed.text", "is a text", Some(5)),
            (YAML, "speed", "several values", Some(3)),
            (YAML, "alias", "an alias", Some(7)),
            (YAML, "speed.missing", "nothing at", None),
            (YAML, "speed.list[7]", "nothing at", None),
            (JSON, "t", "not a decimal", Some(1)),
            ("a: 1\na: 2\n", "a", "twice", Some(2)),
            ("a: 1/2\n", "a", "not a decimal", Some(1)),
            ("a: 010\n", "a", "not a decimal", Some(1)),
            ("a: 1_000\n", "a", "not a decimal", Some(1)),
            ("a: +-1\n", "a", "not a decimal", Some(1)),
            ("a: !!str 1.5\n", "a", "with a tag", Some(1)),
            ("s: {a: 1}\ns: {b: 1}\n", "s.a", "twice", Some(2)),
            ("a: 0x1F\n", "a", "not a decimal", Some(1)),
            ("a: .inf\n", "a", "not a decimal", Some(1)),
            ("a: [1\n", "a", "", None),
            ("a: 1\n---\na: 2\n", "a", "several documents", Some(3)),
        ] {
            let refused = number(text, path).unwrap_err();
            assert!(refused.why.contains(why), "{text}: {path}: {}", refused.why);
            assert!(line.is_none() || refused.line == line, "{text}: {path}: {:?}", refused.line);
        }
        assert!(number(&"[".repeat(100_000), "a").is_err());
        for text in ["{\"a\": 01}", "{\"a\": .5}", "{'a': 1}", "{\"a\": 1,}", "{\"a\": 1} # no", ""] {
            assert!(number_of_json(text, "a").unwrap_err().why.contains("not JSON"), "{text}");
        }
        assert_eq!(number_of_json("[1, {\"\\ud83d\\ude00\": 2, \"a\": 3}]", "[1].a").unwrap().number.to_string(), "3");
    }
}
