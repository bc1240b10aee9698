//! What `[simulation]` says: defaults of a time response and units for its axes. Nothing here enters
//! the algebra.

use super::keys;
use super::model_file::section;
use super::reader::Reader;
use crate::complex::names_of_parts;
use crate::definition::{Block, Dynamics, Form, Model, Name, Simulation};
use crate::error::{Code, Diagnostic};
use crate::text::names::{did_you_mean, known_names, shorten};
use crate::text::toml_value::{Entry, Kind, Table};
use jurist_algebra::number::Rational;

/// Reads the section, if there is one.
pub(super) fn read(root: &Table, reader: &mut Reader) -> Simulation {
    let Some(table) = section(root, "simulation", reader) else { return Simulation::default() };
    reader.unknown_keys(table, &keys::SIMULATION, "[simulation]");
    let inputs = numbers(table, "inputs", reader);
    let initial = numbers(table, "initial", reader);
    let units = entries(table, "units", reader, |reader, value, what| {
        reader.string(value, what).map(|text| text.as_str().to_owned())
    });
    let duration = table.get("duration").and_then(|v| {
        let number = reader.number(v, "'duration'")?;
        if number.is_negative() || number.is_zero() {
            let error = Diagnostic::error(Code::Value, "the duration of a simulation must be positive");
            reader.report(error.at(v.span, "not positive"));
            return None;
        }
        Some(number)
    });
    Simulation { inputs, initial, duration, units }
}

/// The names and numbers of a table in the section: of a complex signal a number, or its parts, as `i_ref.im = 1` or `i_ref = { re = 1, im = 2 }`.
fn numbers(table: &Table, key: &str, reader: &mut Reader) -> Vec<(Name, Rational)> {
    let Some(values) = section(table, key, reader) else { return Vec::new() };
    let mut out = Vec::new();
    for entry in values.iter() {
        let mut add = |name: String, entry: &Entry, reader: &mut Reader| {
            let value = reader.number(&entry.value, &format!("'{}'", shorten(&name)));
            out.extend(value.map(|value| (Name { name, span: entry.key_span }, value)));
        };
        match &entry.value.kind {
            Kind::Table(parts) => {
                for part in parts.iter() {
                    add(format!("{}.{}", entry.key, part.key), part, reader);
                }
            }
            _ => add(entry.key.clone(), entry, reader),
        }
    }
    out
}

/// The names and values of a table in the section.
fn entries<T>(
    table: &Table,
    key: &str,
    reader: &mut Reader,
    read: impl Fn(&mut Reader, &crate::text::toml_value::Value, &str) -> Option<T>,
) -> Vec<(Name, T)> {
    let Some(values) = section(table, key, reader) else { return Vec::new() };
    let one = |entry: &Entry| {
        let value = read(reader, &entry.value, &format!("'{}'", shorten(&entry.key)))?;
        Some((Name { name: entry.key.clone(), span: entry.key_span }, value))
    };
    values.iter().filter_map(one).collect()
}

/// Reports names that the loop does not have.
pub(super) fn check(model: &Model, reader: &mut Reader) {
    let inputs: Vec<&str> = model.inputs().iter().map(|n| n.name.as_str()).collect();
    let states: Vec<&str> = match &model.form {
        Form::Characteristic(_) => Vec::new(),
        Form::Matrix { ports, .. } | Form::OutputFeedback { ports, .. } => {
            ports.states.iter().map(|n| n.name.as_str()).collect()
        }
        Form::Blocks(diagram) => {
            let own = |b: &Block| matches!(b.dynamics, Dynamics::StateSpace { c: None, .. });
            diagram.driven().filter(|(_, b)| own(b)).map(|(n, _)| n.name.as_str()).collect()
        }
    };
    let signals: Vec<&str> = match &model.form {
        Form::Blocks(diagram) => inputs.iter().copied().chain(diagram.driven().map(|(n, _)| n.name.as_str())).collect(),
        _ => inputs.iter().chain(&states).copied().collect(),
    };
    let outputs = model.outputs().iter().map(|o| o.name.name.as_str());
    let signals: Vec<&str> = signals.into_iter().chain(outputs).collect();
    let simulation = &model.simulation;
    let with_parts = |names: &[&str]| -> Vec<String> {
        let parts = model.is_written_complex().then(|| names_of_parts(names.iter().map(|name| (*name).to_owned())));
        names.iter().map(|name| (*name).to_owned()).chain(parts.into_iter().flatten()).collect()
    };
    let [inputs, states] = [with_parts(&inputs), with_parts(&states)];
    let [inputs, states]: [Vec<&str>; 2] = [&inputs, &states].map(|names| names.iter().map(String::as_str).collect());
    unknown(simulation.inputs.iter().map(|(n, _)| n), &inputs, "input", reader);
    unknown(simulation.initial.iter().map(|(n, _)| n), &states, "state", reader);
    unknown(simulation.units.iter().map(|(n, _)| n), &signals, "signal", reader);
}

fn unknown<'n>(names: impl Iterator<Item = &'n Name>, known: &[&str], what: &str, reader: &mut Reader) {
    for name in names.filter(|n| !known.contains(&n.name.as_str())) {
        let message = format!("unknown {what} '{}'", shorten(&name.name));
        let mut error = Diagnostic::error(Code::UnknownName, message).at(name.span, format!("no {what} of the loop"));
        error.help = did_you_mean(&name.name, known.iter().copied()).or_else(|| known_names(known.iter().copied()));
        reader.report(error);
    }
}
