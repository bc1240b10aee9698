//! A system as a model file.

use super::names::{Given, plain};
use super::number::Number;
use super::{Matrix, Names, StateSpace, Time};
use jurist_show::layout::visible;
use std::fmt::Write;

/// What is made of the system.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) struct Form {
    /// Whether no loop is closed around it.
    pub open: bool,
    /// Whether half a unit in the last place is a tolerance.
    pub last_place: bool,
}

/// Names of the signals of a model.
struct Signals {
    inputs: Vec<String>,
    outputs: Vec<String>,
    references: Vec<String>,
    /// Where the file names them.
    states: Vec<String>,
}

/// The text of the model file, and what is to be said of it on standard error.
pub(in crate::cli) fn model(system: &StateSpace, file: &str, form: Form) -> (String, Vec<String>) {
    let size = system.inputs.as_ref().map(|(b, _)| (b.columns, system.c.rows));
    let closed = !form.open && size.is_some_and(|(inputs, outputs)| inputs == outputs);
    let mut remarks = system.remarks.clone();
    remarks.extend(size.filter(|(inputs, outputs)| !form.open && inputs != outputs).map(|(inputs, outputs)| {
        format!("with {} no loop is closed around it", counted(inputs, "input") + " and " + &counted(outputs, "output"))
    }));
    let mut constants = Constants { wanted: form.last_place, lines: String::new() };
    let signals = Signals::of(&system.names, system.a.rows, size);
    let body = match &system.inputs {
        None => autonomous(&system.a, &signals, &mut constants),
        Some(inputs) => blocks(system, inputs, &signals, closed, &mut constants),
    };
    remarks.extend(last_digit(system, form.last_place, !constants.lines.is_empty()));
    let mut text = header(system, file, size, closed, form.last_place);
    for line in remarks.iter().flat_map(|remark| wrapped(&sentence(remark))) {
        let _ = writeln!(text, "# {line}");
    }
    let title = system.names.title.as_deref().unwrap_or(file);
    let _ = writeln!(text, "\ntitle = {}", quoted(title));
    match &system.time {
        Time::Continuous => text.push_str("time = \"continuous\"\n"),
        Time::Discrete(sample_time) => {
            text.push_str("time = \"discrete\"\n");
            let _ = sample_time.iter().try_for_each(|time| writeln!(text, "sample_time = {time}"));
        }
    }
    if !constants.lines.is_empty() {
        let _ = write!(text, "\n[constants]\n{}", constants.lines);
    }
    if closed {
        text.push_str("\n[parameters]\nK = { nominal = 1, description = \"gain of every channel: replace by your controller\" }\n");
    }
    (text + &body, remarks)
}

fn header(system: &StateSpace, file: &str, size: Option<(usize, usize)>, closed: bool, last_place: bool) -> String {
    let (inputs, outputs) = size.unwrap_or((0, 0));
    let parts = [counted(system.a.rows, "state"), counted(inputs, "input"), counted(outputs, "output")];
    let mut out = format!("# Made by 'jurist import' from {}: {}.\n", visible(file), parts.join(", "));
    let commands: &[(&str, &str)] = match (closed, last_place) {
        (true, false) => &[("intervals", "the limits of K"), ("analyze", "verdict, limits, causes")],
        (true, true) => {
            &[("intervals", "the limits of K"), ("tolerance", "is it stable for all values within the last places?")]
        }
        (false, false) => &[("verdict", "is it stable on its own?")],
        (false, true) => {
            &[("verdict", "is it stable on its own?"), ("tolerance", "is it so for all values within the last places?")]
        }
    };
    for (command, about) in commands {
        let _ = writeln!(out, "# {:30} {about}", format!("jurist {command} FILE"));
    }
    out
}

/// What the digits of the file mean for the answers.
fn last_digit(system: &StateSpace, last_place: bool, has_constants: bool) -> Option<String> {
    let direct = system.inputs.iter().flat_map(|(b, d)| [b, d, &system.c]);
    let entries: Vec<&Number> = [&system.a].into_iter().chain(direct).flat_map(|matrix| &matrix.entries).collect();
    if entries.iter().all(|entry| entry.is_exact()) {
        return last_place
            .then(|| "all numbers are integers and taken for exact: no last place is a tolerance".to_owned());
    }
    let what = match entries.iter().any(|entry| entry.is_binary()) {
        true => "the numbers are binary in the file, and each is written as the shortest decimal that reads back to it",
        false => "the numbers are the decimals of the file",
    };
    let then = match has_constants {
        true => {
            "half a unit in the last place of each that is no integer is a tolerance, of which 'jurist tolerance' asks"
        }
        false => "a limit may rest on the last digit; '--last-place' makes half a unit in it a tolerance",
    };
    Some(format!("{what}; {then}"))
}

impl Signals {
    fn of(names: &Names, states: usize, size: Option<(usize, usize)>) -> Signals {
        let mut given = Given::default();
        let (inputs, outputs) = size.unwrap_or((0, 0));
        let mut named = |list: &[String], letter: &str, count: usize| -> Vec<String> {
            let wishes = |k: usize| match list.get(k).map(|name| plain(name)).filter(|name| !name.is_empty()) {
                Some(name) => vec![name.clone(), format!("{letter}_{name}")],
                None if count == 1 => vec![letter.to_owned()],
                None => vec![format!("{letter}_{}", k + 1)],
            };
            (0..count).map(|k| given.name(&wishes(k))).collect()
        };
        let outputs = named(&names.outputs, "y", outputs);
        let inputs = named(&names.inputs, "u", inputs);
        let references: Vec<String> = match names.outputs.is_empty() {
            true => named(&[], "r", outputs.len()),
            false => named(&outputs.iter().map(|output| format!("r_{output}")).collect::<Vec<_>>(), "r", outputs.len()),
        };
        let states = if names.states.is_empty() { Vec::new() } else { named(&names.states, "x", states) };
        Signals { inputs, outputs, references, states }
    }
}

/// Entries that became constants with a tolerance.
struct Constants {
    wanted: bool,
    lines: String,
}

impl Constants {
    /// What stands for an entry in its matrix.
    fn entry(&mut self, letter: char, row: usize, column: usize, number: &Number) -> String {
        let Some(half) = number.half_unit().filter(|_| self.wanted) else { return number.to_string() };
        let name = format!("{letter}_{}_{}", row + 1, column + 1);
        let _ = writeln!(self.lines, "{name} = {{ value = {number}, tolerance = {half} }}");
        format!("\"{name}\"")
    }

    /// A matrix, each row on a line with the name of what the row is about.
    fn matrix(&mut self, key: &str, letter: char, matrix: &Matrix, rows: &[String]) -> String {
        let mut out = format!("{key} = [\n");
        for (i, row) in matrix.each_row().enumerate() {
            let entries: Vec<String> =
                row.iter().enumerate().map(|(j, entry)| self.entry(letter, i, j, entry)).collect();
            let about = rows.get(i).map(|name| format!("  # {name}")).unwrap_or_default();
            let _ = writeln!(out, "    [{}],{about}", entries.join(", "));
        }
        out + "]\n"
    }
}

fn autonomous(a: &Matrix, signals: &Signals, constants: &mut Constants) -> String {
    let matrix = constants.matrix("matrix", 'a', a, &[]);
    let states = match signals.states.is_empty() {
        true => String::new(),
        false => format!("states = {}\n", list(&signals.states)),
    };
    format!("\n[loop]\n{matrix}{states}")
}

fn blocks(
    system: &StateSpace,
    (b, d): &(Matrix, Matrix),
    signals: &Signals,
    closed: bool,
    constants: &mut Constants,
) -> String {
    let external = if closed { &signals.references } else { &signals.inputs };
    let mut out = format!("\n[loop]\ninputs = {}\noutputs = {}\n", list(external), list(&signals.outputs));
    if closed {
        let single = signals.outputs.len() == 1;
        for (k, (output, reference)) in signals.outputs.iter().zip(&signals.references).enumerate() {
            let name = if single { "controller".to_owned() } else { format!("controller {}", k + 1) };
            let _ = write!(
                out,
                "\n[[block]]\nname = \"{name}\"\ninput = \"{reference} - {output}\"\noutput = \"{}\"\ngain = \"K\"\n",
                signals.inputs[k]
            );
        }
    }
    let _ = write!(
        out,
        "\n[[block]]\nname = \"plant\"\ninput = {}\noutput = {}\n",
        list(&signals.inputs),
        list(&signals.outputs)
    );
    out += &constants.matrix("A", 'a', &system.a, &signals.states);
    out += &constants.matrix("B", 'b', b, &[]);
    out += &constants.matrix("C", 'c', &system.c, &[]);
    if d.entries.iter().any(|entry| entry.sign().is_ne()) {
        out += &constants.matrix("D", 'd', d, &[]);
    }
    out
}

fn counted(count: usize, noun: &str) -> String {
    match count {
        0 => format!("no {noun}s"),
        1 => format!("1 {noun}"),
        _ => format!("{count} {noun}s"),
    }
}

fn list(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    format!("[{}]", quoted.join(", "))
}

/// A text as a TOML string.
fn quoted(text: &str) -> String {
    format!("\"{}\"", visible(text).replace('\\', "\\\\").replace('"', "\\\""))
}

/// A remark as a sentence.
fn sentence(remark: &str) -> String {
    let mut letters = remark.chars();
    letters.next().map(|first| format!("{}{}.", first.to_uppercase(), letters.as_str())).unwrap_or_default()
}

/// A sentence in lines.
fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 118;
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().expect("there is a line");
        if line.is_empty() {
            line.push_str(word);
        } else if line.len() + word.len() < WIDTH {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
