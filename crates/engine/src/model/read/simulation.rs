//! What `[simulation]` says: defaults of a time response and units for its axes. Nothing here enters
//! the algebra.

use super::keys;
use super::model_file::section;
use super::reader::Reader;
use crate::error::{Code, Diagnostic};
use crate::model::definition::{Block, Dynamics, Form, Model, Name, Simulation};
use crate::model::text::names::{did_you_mean, known_names, shorten};
use crate::model::text::toml_value::{Entry, Table};

/// Reads the section, if there is one.
pub(super) fn read(root: &Table, reader: &mut Reader) -> Simulation {
    let Some(table) = section(root, "simulation", reader) else { return Simulation::default() };
    reader.unknown_keys(table, &keys::SIMULATION, "[simulation]");
    let inputs = entries(table, "inputs", reader, Reader::number);
    let initial = entries(table, "initial", reader, Reader::number);
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

/// The names and values of a table in the section.
fn entries<T>(
    table: &Table,
    key: &str,
    reader: &mut Reader,
    read: impl Fn(&mut Reader, &crate::model::text::toml_value::Value, &str) -> Option<T>,
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
