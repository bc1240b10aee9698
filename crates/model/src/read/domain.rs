//! The domain of a parameter: `min` and `max`, open or closed, or both in one array.

use super::reader::Reader;
use crate::definition::Parameter;
use crate::error::{Code, Diagnostic, Span};
use crate::text::names::shorten;
use crate::text::toml_value::{Kind, Table};

/// Reads the domain; where its lower and its upper end stand.
pub(super) fn read(table: &Table, parameter: &mut Parameter, reader: &mut Reader) -> [Span; 2] {
    let span = |key: &str| table.get(key).map_or(parameter.span, |v| v.span);
    let mut ends = [span("min"), span("max")];
    if let Some(value) = table.get("domain") {
        for key in ["min", "max", "closed"].into_iter().filter_map(|key| table.entry(key)) {
            let message = format!("the domain of '{}' is given twice", shorten(&parameter.name));
            let error =
                Diagnostic::error(Code::TwoForms, message).at(key.key_span, "here").also(value.span, "and here");
            reader.report(error.help("write domain = [LO, HI], which is closed, or 'min', 'max' and 'closed'"));
        }
        let Kind::Array(items) = &value.kind else {
            reader.wrong_type(value, "'domain'", "an array of two numbers");
            return ends;
        };
        let [low, high] = items.as_slice() else {
            let error = Diagnostic::error(Code::Size, "a domain has two ends").at(value.span, "not two numbers");
            reader.report(error.help("for one end alone write 'min' or 'max', and closed = true"));
            return ends;
        };
        ends = [low.span, high.span];
        parameter.min = reader.number(low, "an end of 'domain'");
        parameter.max = reader.number(high, "an end of 'domain'");
        parameter.closed = true;
        return ends;
    }
    let mut number = |key: &str| reader.number(table.get(key)?, &format!("'{key}'"));
    (parameter.min, parameter.max) = (number("min"), number("max"));
    if let Some(value) = table.get("closed") {
        match value.kind {
            Kind::Boolean(closed) => parameter.closed = closed,
            _ => reader.wrong_type(value, "'closed'", "true or false"),
        }
        if table.get("min").is_none() && table.get("max").is_none() {
            let message = format!("the domain of '{}' has no end that could be closed", shorten(&parameter.name));
            let error = Diagnostic::error(Code::Missing, message).at(value.span, "says nothing");
            reader.report(error.help("give it 'min' or 'max', or leave 'closed' out"));
        }
    }
    ends
}

/// `open` or `closed`.
pub(super) fn kind(parameter: &Parameter) -> &'static str {
    if parameter.closed { "closed" } else { "open" }
}

/// The error about a domain whose lower end is not below its upper one.
pub(super) fn empty(parameter: &Parameter, [low, high]: [Span; 2]) -> Diagnostic {
    let name = shorten(&parameter.name);
    if parameter.closed && parameter.min == parameter.max {
        let error = Diagnostic::error(Code::EmptyDomain, format!("the domain of '{name}' is a single value"));
        let error = error.at(high, "the upper bound").also(low, "is the same as this lower bound");
        return error.help("a value that does not vary is a nominal value, or a constant; leave the domain out");
    }
    let error = Diagnostic::error(Code::EmptyDomain, format!("the domain of '{name}' is empty"));
    let error = error.at(high, "the upper bound").also(low, "is not above this lower bound");
    error.help(match parameter.closed {
        true => "the lower bound must be less than the upper one",
        false => "'min' must be less than 'max'; both are open bounds",
    })
}
