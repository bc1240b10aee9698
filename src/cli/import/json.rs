//! A JSON object with the matrices as arrays of rows. Numbers are taken over as they are written.

use super::number::{Number, Unread};
use super::{DESCRIPTOR, MAX_SIDE, Shape, Variable, Variables, bad_entry, is_read, refused};
use jurist_engine::error::{Diagnostic, Span};
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;
use std::borrow::Cow;
use std::fmt;

/// The members of an object as they stand there, all of them.
struct Members<'t>(Vec<(String, &'t RawValue)>);

impl<'t> Deserialize<'t> for Members<'t> {
    fn deserialize<D: Deserializer<'t>>(deserializer: D) -> Result<Self, D::Error> {
        struct Object;

        impl<'t> Visitor<'t> for Object {
            type Value = Members<'t>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object with A, B, C, D, Ts")
            }

            fn visit_map<M: MapAccess<'t>>(self, mut map: M) -> Result<Members<'t>, M::Error> {
                let mut members = Vec::new();
                while let Some((name, value)) = map.next_entry::<Cow<'t, str>, &'t RawValue>()? {
                    members.push((name.into_owned(), value));
                }
                Ok(Members(members))
            }
        }

        deserializer.deserialize_map(Object)
    }
}

/// The whole text, into which spans point.
#[derive(Clone, Copy)]
struct Whole<'t>(&'t str);

pub(super) fn read(text: &str) -> Result<Variables, Diagnostic> {
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let whole = Whole(text);
    let Members(members) = serde_json::from_str(body).map_err(|error| whole.wrong(body, &error))?;
    let has_state_matrix = |members: &[(String, &RawValue)]| members.iter().any(|(name, _)| name == "A");
    if has_state_matrix(&members) {
        return variables(whole, &members);
    }
    let structs = members.iter().filter(|(_, value)| value.get().starts_with('{'));
    let structs = structs.filter_map(|(name, value)| Some((name, whole.members(value).ok()?)));
    let structs: Vec<_> = structs.filter(|(_, inner)| has_state_matrix(inner)).collect();
    match structs.as_slice() {
        [] => variables(whole, &members),
        [(_, inner)] => variables(whole, inner),
        [(first, _), (second, _), ..] => {
            Err(refused(format!("there are several systems, such as '{first}' and '{second}'"))
                .help("leave one of them in the file"))
        }
    }
}

impl<'t> Whole<'t> {
    fn span(self, part: &str) -> Span {
        let start = part.as_ptr().addr().saturating_sub(self.0.as_ptr().addr());
        Span::new(start, start + part.len())
    }

    /// What the library says of a part of the text, at its place.
    fn wrong(self, part: &str, error: &serde_json::Error) -> Diagnostic {
        let line = part.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum::<usize>();
        let mut at = (line + error.column().saturating_sub(1)).min(part.len());
        while !part.is_char_boundary(at) {
            at -= 1;
        }
        let length = part[at..].chars().next().map_or(0, char::len_utf8);
        let said = error.to_string();
        let message = said.split(" at line ").next().unwrap_or_default();
        let error = refused(format!("this is no JSON: {message}"));
        let is_word = ["NaN", "Infinity", "-Infinity"].iter().any(|word| part[at.saturating_sub(1)..].contains(word));
        let error = if is_word {
            error.help("NaN and Infinity are no numbers of JSON, and no entries of a system")
        } else {
            error
        };
        let start = self.span(part).start + at;
        error.at(Span::new(start, start + length), "")
    }

    fn members(self, value: &'t RawValue) -> Result<Vec<(String, &'t RawValue)>, Diagnostic> {
        serde_json::from_str(value.get()).map(|Members(list)| list).map_err(|error| self.wrong(value.get(), &error))
    }

    /// The elements of an array; none of what is no array.
    fn elements(self, value: &'t RawValue) -> Option<Result<Vec<&'t RawValue>, Diagnostic>> {
        let text = value.get();
        text.starts_with('[').then(|| serde_json::from_str(text).map_err(|error| self.wrong(text, &error)))
    }
}

fn variables(whole: Whole<'_>, members: &[(String, &RawValue)]) -> Result<Variables, Diagnostic> {
    let mut out = Variables::default();
    for (name, value) in members {
        out.present.push(name.clone());
        // MATLAB writes what is empty, and Python what is missing, as null.
        if !(is_read(name) || name == DESCRIPTOR) || value.get() == "null" {
            continue;
        }
        let span = whole.span(value.get());
        if let Some(first) = out.list.iter().find(|variable| variable.name == *name) {
            let error = refused(format!("{name} stands there twice")).at(span, "the second one");
            return Err(match first.span {
                Some(first) => error.also(first, "the first one"),
                None => error,
            });
        }
        out.list.push(variable(whole, name, value)?);
    }
    Ok(out)
}

fn variable(whole: Whole<'_>, name: &str, value: &RawValue) -> Result<Variable, Diagnostic> {
    let span = Some(whole.span(value.get()));
    let named = |shape, entries| Ok(Variable { name: name.to_owned(), shape, entries, span });
    let entry = |row, column, value: &RawValue| number(whole, name, row, column, value);
    let Some(rows) = whole.elements(value) else { return named(Shape::Scalar, vec![entry(0, 0, value)?]) };
    let rows = rows?;
    let too_long =
        || refused(format!("{name} has more than {MAX_SIDE} rows or columns")).at(whole.span(value.get()), "");
    if rows.len() > MAX_SIDE {
        return Err(too_long());
    }
    if !rows.iter().any(|row| row.get().starts_with('[')) {
        let entries = rows.iter().enumerate().map(|(k, value)| entry(0, k, value)).collect::<Result<Vec<_>, _>>()?;
        return named(Shape::Vector(rows.len()), entries);
    }
    let (mut entries, mut columns) = (Vec::new(), None);
    for (i, row) in rows.iter().enumerate() {
        let Some(elements) = whole.elements(row) else {
            let error = refused(format!("row {} of {name} is no array", i + 1));
            return Err(error
                .at(whole.span(row.get()), "beside arrays")
                .help("a matrix is an array of rows: [[0, 1], [-2, -3]]"));
        };
        let elements = elements?;
        let expected = *columns.get_or_insert(elements.len());
        if elements.len() != expected {
            let message = format!("row {} of {name} has {} numbers, but row 1 has {expected}", i + 1, elements.len());
            return Err(refused(message).at(whole.span(row.get()), "another length"));
        }
        if expected > MAX_SIDE {
            return Err(too_long());
        }
        for (j, element) in elements.iter().enumerate() {
            entries.push(entry(i, j, element)?);
        }
    }
    named(Shape::Matrix(rows.len(), columns.unwrap_or(0)), entries)
}

fn number(whole: Whole<'_>, name: &str, row: usize, column: usize, value: &RawValue) -> Result<Number, Diagnostic> {
    let text = value.get();
    let why = match text {
        // MATLAB's name for what is not finite.
        "null" => Unread::NotFinite,
        _ if text.starts_with(['"', '{', '[', 't', 'f']) => Unread::NotANumber,
        _ => match Number::decimal(text) {
            Ok(number) => return Ok(number),
            Err(why) => why,
        },
    };
    Err(bad_entry(name, row, column, why, text).at(whole.span(text), ""))
}

#[cfg(test)]
mod tests {
    use super::read;

    fn shown(text: &str) -> Vec<String> {
        read(text).unwrap().shown()
    }

    #[test]
    fn numbers_are_taken_over_as_they_are_written() {
        let text = "{\"A\": [[0.10000000000000000000000001, 1],\r\n [-2.50e-3, 12345678901234567890]], \"x\": {}, \"B\": [0, 1], \"Ts\": 0.1}";
        let expected = [
            "A Matrix(2, 2) 0.10000000000000000000000001 1 -0.00250 1.2345678901234567890e19",
            "B Vector(2) 0 1",
            "Ts Scalar 0.1",
        ];
        assert_eq!(shown(text), expected);
        assert_eq!(shown(&format!("\u{feff}{{\"sys\": {text}, \"note\": \"x\"}}")), expected);
        assert_eq!(shown("{\"A\": [[1]], \"B\": [[]], \"D\": null}"), ["A Matrix(1, 1) 1", "B Matrix(1, 0) "]);
    }

    #[test]
    fn mistakes_have_their_places() {
        let place = |text: &str| {
            let error = read(text).unwrap_err();
            let span = error.primary.unwrap().span;
            (text[span.start..span.end].to_owned(), error.message)
        };
        assert_eq!(place("\u{feff}{\r\n\"A\": [[1, \"x\"]]}").0, "\"x\"");
        assert_eq!(place("{\"A\": [[1, null]]}").1, "row 1, column 2 of A is null: not a finite number");
        assert_eq!(place("{\"A\": [[1, 2], [3]]}").0, "[3]");
        assert_eq!(place("{\"A\": [[1], 3]}").0, "3");
        assert_eq!(place("{\"A\": [[1]], \"A\": [[2]]}").0, "[[2]]");
        assert!(place("{\"A\": [[NaN]]}").1.starts_with("this is no JSON"));
        assert!(place("{\"A\": [[1]").1.starts_with("this is no JSON"));
        assert!(place("[1]").1.starts_with("this is no JSON"));
        assert_eq!(
            read("{\"p\": {\"A\": [[1]]}, \"q\": {\"A\": [[1]]}}").unwrap_err().message,
            "there are several systems, such as 'p' and 'q'"
        );
        assert!(read(&"[".repeat(100_000)).is_err());
        assert!(read(&format!("{{\"A\": {}", "[".repeat(100_000))).is_err());
        assert!(read(&format!("{{\"x\": {}{}}}", "[".repeat(100_000), "]".repeat(100_000))).is_ok());
    }
}
