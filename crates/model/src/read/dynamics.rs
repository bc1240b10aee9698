//! What a block does: one of its keys for that.

use super::blocks::BlockTable;
use super::reader::Reader;
use crate::definition::{Dynamics, Time};
use crate::error::{Code, Diagnostic};
use crate::text::Expression;
use crate::text::names::shorten;
use crate::text::toml_value::{Entry, Kind, Table};

const DYNAMICS: [&str; 9] = ["transfer", "num", "den", "gain", "delay", "A", "B", "C", "D"];

/// The way of saying what a block does to which a key belongs.
fn kind(key: &str) -> &'static str {
    match key {
        "num" | "den" => "num/den",
        "A" | "B" | "C" | "D" => "A, B, C, D",
        "transfer" => "transfer",
        "gain" => "gain",
        _ => "delay",
    }
}

pub(super) fn dynamics(of: &BlockTable<'_>, reader: &mut Reader) -> Option<Dynamics> {
    let table = of.table;
    let given: Vec<&Entry> = table.iter().filter(|e| DYNAMICS.contains(&e.key.as_str())).collect();
    let Some(first) = given.first() else {
        if !DYNAMICS.iter().any(|key| of.may_have(key)) {
            let message = format!("the block '{}' does not say what it does", shorten(&of.name));
            let error = Diagnostic::error(Code::Missing, message).at(of.span, "this block");
            reader.report(error.help("give 'transfer', 'num' and 'den', 'gain', 'delay', or 'A', 'B', 'C', 'D'"));
        }
        return None;
    };
    if let Some(second) = given.iter().find(|e| kind(&e.key) != kind(&first.key)) {
        reader.report(given_twice(of, first, second));
        return None;
    }
    let need = |key: &str, reader: &mut Reader| {
        if table.get(key).is_none() && !of.may_have(key) {
            let message = format!("the block '{}' has no '{key}'", shorten(&of.name));
            let error = Diagnostic::error(Code::Missing, message);
            reader.report(error.at(first.key_span, format!("this needs '{key}' as well")));
        }
    };
    match kind(&first.key) {
        "transfer" => reader.expression(&first.value, "'transfer'").map(Dynamics::Transfer),
        "gain" => reader.expression(&first.value, "'gain'").map(Dynamics::Gain),
        "delay" => {
            let delay = reader.expression(&first.value, "'delay'")?;
            if of.is_discretised {
                let error =
                    Diagnostic::error(Code::Value, "a delay has nothing to discretise").at(first.key_span, "a delay");
                reader.report(error.help("dead time of a held block goes into its 'discretize': delay = \"..\""));
                return None;
            }
            Some(if of.time == Time::Continuous { Dynamics::DeadTime(delay) } else { Dynamics::Delay(delay) })
        }
        "num/den" => {
            need("num", reader);
            need("den", reader);
            let (numerator, denominator) = (coefficients(table, "num", reader), coefficients(table, "den", reader));
            let (numerator, denominator) = (numerator?, denominator?);
            for (list, key) in [(&numerator, "num"), (&denominator, "den")] {
                if list.is_empty() {
                    let error = Diagnostic::error(Code::Value, format!("'{key}' has no coefficients"));
                    reader.report(error.at(table.get(key).map_or(of.span, |v| v.span), "empty"));
                }
            }
            Some(Dynamics::Ratio { numerator, denominator })
        }
        _ => {
            let mut matrix = |key: &str| table.get(key).and_then(|v| reader.matrix(v, &format!("the matrix {key}")));
            let (a, b, c, d) = (matrix("A"), matrix("B"), matrix("C"), matrix("D"));
            if table.get("A").is_none() && table.get("B").is_none() && table.get("C").is_none() {
                return d.map(Dynamics::Static);
            }
            need("A", reader);
            need("B", reader);
            Some(Dynamics::StateSpace { a: a?, b: b?, c, d })
        }
    }
}

/// Dynamics are said in two ways.
fn given_twice(of: &BlockTable<'_>, first: &Entry, second: &Entry) -> Diagnostic {
    let (name, kinds) = (shorten(&of.name), [kind(&first.key), kind(&second.key)]);
    let message = format!("the block '{name}' is given twice: by {} and by {}", kinds[0], kinds[1]);
    let help = match (kinds.contains(&"delay"), of.time, of.is_discretised) {
        (false, ..) => "keep one of them",
        (_, Time::Continuous, _) => "dead time is a factor exp(-tau*s) of 'transfer', or a block of its own",
        (_, _, true) => {
            "dead time of a plant behind a hold is a factor exp(-tau*s) of 'transfer', or a key of 'discretize'"
        }
        _ => "a delay is a block of its own, or a division by z^n",
    };
    let error = Diagnostic::error(Code::TwoForms, message).at(second.key_span, "given here again");
    error.also(first.key_span, "first given here").help(help)
}

fn coefficients(table: &Table, key: &str, reader: &mut Reader) -> Option<Vec<Expression>> {
    let value = table.get(key)?;
    if let Kind::String(text) = &value.kind
        && text.as_str().trim_start().starts_with('[')
    {
        let error = Diagnostic::error(Code::Type, format!("'{key}' must be a list of coefficients"));
        let error = error.at(value.span, "this is a string");
        reader.report(error.help(format!("without the quotes, with commas: {key} = [1, \"-a\"]")));
        return None;
    }
    Some(reader.expressions(value, "a coefficient"))
}
