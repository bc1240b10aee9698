//! The key `tolerance` of parameters and constants.

use super::keys;
use super::reader::Reader;
use crate::error::{Code, Diagnostic};
use crate::text::toml_value::{Kind, Table, Value};
use crate::tolerance::Tolerance;

/// The tolerance in a table, if it has one.
pub(super) fn read_tolerance(table: &Table, reader: &mut Reader) -> Option<Tolerance> {
    let value = table.get("tolerance")?;
    let read: Result<Tolerance, String> = match &value.kind {
        Kind::String(text) => text.as_str().parse(),
        Kind::Number(_) => return width(value, reader),
        Kind::Array(items) => match items.as_slice() {
            [low, high] => Tolerance::between(&bound(low, reader)?, &bound(high, reader)?),
            _ => Err("an array of two bounds is expected".to_owned()),
        },
        Kind::Table(range) => {
            reader.unknown_keys(range, &keys::TOLERANCE, "'tolerance'");
            let mut end = |key: &str| match range.get(key) {
                Some(value) => reader.number(value, &format!("'{key}'")),
                None => {
                    let error = Diagnostic::error(Code::Missing, format!("the tolerance has no '{key}'"));
                    reader.report(
                        error.at(value.span, "both ends are needed").help("for example { low = 0.4, high = 0.7 }"),
                    );
                    None
                }
            };
            let (low, high) = (end("low"), end("high"));
            Tolerance::Range { low: low?, high: high? }.checked()
        }
        _ => {
            reader.wrong_type(value, "'tolerance'", "a number, a text such as \"10%\", two bounds or a table");
            return None;
        }
    };
    refused(read, value, reader)
}

fn width(value: &Value, reader: &mut Reader) -> Option<Tolerance> {
    let width = reader.number(value, "'tolerance'")?;
    refused(Tolerance::Width(width).checked(), value, reader)
}

fn bound(value: &Value, reader: &mut Reader) -> Option<String> {
    match &value.kind {
        Kind::Number(text) => Some(text.clone()),
        _ => reader.string(value, "a bound of 'tolerance'").map(|text| text.as_str().to_owned()),
    }
}

fn refused(read: Result<Tolerance, String>, value: &Value, reader: &mut Reader) -> Option<Tolerance> {
    read.map_err(|why| {
        let error = Diagnostic::error(Code::Tolerance, format!("this is no tolerance: {why}"));
        reader.report(
            error
                .at(value.span, "not accepted")
                .help("write \"10%\", [\"-20%\", \"+30%\"], a width such as 0.01, or { low = 0.4, high = 0.7 }"),
        );
    })
    .ok()
}
