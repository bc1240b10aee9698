//! The forms of `[loop]`: a characteristic polynomial, a matrix, output feedback, or blocks.

use super::blocks;
use super::keys;
use super::reader::{Meant, Reader, count};
use crate::definition::{Form, Matrix, Ports, Time};
use crate::error::{Code, Diagnostic, Span};
use crate::text::Expression;
use crate::text::toml_value::{Entry, Kind, Table};

/// The keys of `[loop]` that make a form.
const FORM_KEYS: [&str; 6] = ["characteristic", "matrix", "A", "B", "C", "K"];

/// The form of the loop, from `[loop]` and the blocks.
pub(super) fn read_form(
    root: &Table,
    meant: &Meant,
    time: Time,
    sample_time: Option<&Expression>,
    reader: &mut Reader,
) -> Option<Form> {
    let blocks = root.entry("block");
    let Some(entry) = root.entry("loop") else {
        if meant.includes("loop") {
            return None;
        }
        reader.report(no_loop(blocks));
        return None;
    };
    let table = reader.table(entry)?;
    let before = reader.diagnostics.len();
    let meant_in_loop = reader.unknown_keys(table, &keys::LOOP, "[loop]");
    let misspelt = reader.diagnostics.len() > before || meant.includes("block");
    let given: Vec<&Entry> = table.iter().filter(|e| FORM_KEYS.contains(&e.key.as_str())).collect();
    let feedback = |e: &&&Entry| matches!(e.key.as_str(), "A" | "B" | "C" | "K");
    let mut forms: Vec<(&str, Span)> =
        given.iter().filter(|e| !feedback(e)).map(|e| (e.key.as_str(), e.key_span)).collect();
    if let Some(first) = given.iter().find(feedback) {
        forms.push(("A, B, C, K", first.key_span));
    }
    if let Some(block) = blocks {
        forms.push(("[[block]]", block.key_span));
    }
    match forms.as_slice() {
        // What is missing is probably there under the wrong name.
        [] if misspelt => None,
        [] => {
            let error = Diagnostic::error(Code::Missing, "[loop] does not say what the loop is");
            let error = error.at(entry.key_span, "empty");
            reader.report(error.help("give 'characteristic', 'matrix', 'A', 'B', 'C' and 'K', or [[block]] entries"));
            None
        }
        [(form, _)] => match *form {
            "characteristic" => {
                for entry in table.iter().filter(|e| ["states", "inputs", "E", "outputs"].contains(&e.key.as_str())) {
                    let message = format!("'{}' says nothing beside 'characteristic'", entry.key);
                    reader.unused(message, entry.key_span);
                }
                reader.expression(table.get("characteristic")?, "'characteristic'").map(Form::Characteristic)
            }
            "matrix" => read_matrix_form(table, &meant_in_loop, reader),
            "A, B, C, K" => read_feedback_form(table, &meant_in_loop, &given, reader),
            _ => blocks::diagram(table, blocks?, time, sample_time, reader).map(Form::Blocks),
        },
        [(a, first), (b, second), ..] => {
            let message = format!("the loop is given twice: by {a} and by {b}");
            let error = Diagnostic::error(Code::TwoForms, message).at(*second, "given here again");
            reader.report(error.also(*first, "first given here").help("keep exactly one form"));
            None
        }
    }
}

fn no_loop(blocks: Option<&Entry>) -> Diagnostic {
    let error = Diagnostic::error(Code::Missing, "the model has no [loop]");
    match blocks {
        Some(block) => {
            let error = error.at(block.key_span, "these blocks need a [loop] with inputs and outputs");
            error
                .help("add [loop] with the external signals and those of interest: inputs = [\"r\"], outputs = [\"y\"]")
        }
        None => error.help(
            "add [loop] with 'inputs' and 'outputs' and a [[block]] for each block; or [loop] with 'characteristic', \
             with 'matrix', or with 'A', 'B', 'C', 'K'. 'jurist new' writes a model to begin with",
        ),
    }
}

fn read_matrix_form(table: &Table, meant: &Meant, reader: &mut Reader) -> Option<Form> {
    let matrix = reader.matrix(table.get("matrix")?, "the matrix");
    let matrix = matrix.filter(|m| square(m, "the matrix", reader));
    let ports = read_ports(table, meant, matrix.as_ref(), "the matrix", reader);
    Some(Form::Matrix { matrix: matrix?, ports })
}

fn square(matrix: &Matrix, what: &str, reader: &mut Reader) -> bool {
    let (r, c) = matrix.size();
    if r != c {
        let error = Diagnostic::error(Code::Size, format!("{what} is {r} x {c}, but must be square"));
        reader.report(error.at(matrix.span, format!("{}, {}", count(r, "row", "rows"), count(c, "column", "columns"))));
    } else if r == 0 {
        let error = Diagnostic::error(Code::Size, format!("{what} is empty")).at(matrix.span, "no rows");
        reader.report(error.help("a loop has at least one state: [[\"a\"]]"));
    }
    r == c && r > 0
}

fn read_feedback_form(table: &Table, meant: &Meant, given: &[&Entry], reader: &mut Reader) -> Option<Form> {
    let mut matrix = |key: &str| {
        let Some(value) = table.get(key) else {
            if meant.includes(key) {
                return None;
            }
            let place = given.first().map_or(Span::default(), |e| e.key_span);
            let error = Diagnostic::error(Code::Missing, format!("[loop] has no '{key}'"));
            reader.report(error.at(place, "the form A, B, C, K begins here").help("the closed loop is A - B*K*C"));
            return None;
        };
        reader.matrix(value, &format!("the matrix {key}"))
    };
    let (a, b, c, k) = (matrix("A"), matrix("B"), matrix("C"), matrix("K"));
    let a = a.filter(|a| square(a, "A", reader));
    let ports = read_ports(table, meant, a.as_ref(), "A", reader);
    let (a, b, c, k) = (a?, b?, c?, k?);
    let n = a.size().0;
    let because = format!("A is {n} x {n}");
    let (inputs, outputs) = (b.size().1, c.size().0);
    let mut fits = reader.size(&b, "B", n, inputs, (a.span, &because));
    fits &= reader.size(&c, "C", outputs, n, (a.span, &because));
    if k.size().0 == inputs {
        fits &= reader.size(&k, "K", inputs, outputs, (c.span, &format!("C has {}", count(outputs, "row", "rows"))));
    } else {
        let because = format!("B has {}", count(inputs, "column", "columns"));
        fits &= reader.size(&k, "K", inputs, outputs, (b.span, &because));
    }
    fits.then_some(Form::OutputFeedback { a, b, c, k, ports })
}

fn read_ports(table: &Table, meant: &Meant, matrix: Option<&Matrix>, what: &str, reader: &mut Reader) -> Ports {
    let mut names = |key: &str, what: &str| table.get(key).map(|v| reader.names(v, what)).unwrap_or_default();
    let states = names("states", "a state");
    let inputs = names("inputs", "an input");
    let outputs = table.get("outputs").map(|v| reader.outputs(v)).unwrap_or_default();
    let input_matrix = table.get("E").and_then(|v| reader.matrix(v, "the matrix E"));
    if let (Some(matrix), Some(entry)) = (matrix, table.entry("states")) {
        let n = matrix.size().0;
        let given = if let Kind::Array(items) = &entry.value.kind { items.len() } else { 1 };
        if given != n {
            let message = format!("{} for {}", count(given, "state", "states"), count(n, "row", "rows"));
            let error = Diagnostic::error(Code::Size, message).at(entry.value.span, "the states");
            reader.report(error.also(matrix.span, format!("{what} has {}", count(n, "row", "rows"))));
        }
    }
    match (&input_matrix, table.entry("inputs"), table.entry("E")) {
        (Some(e), Some(entry), _) => {
            let r = matrix.map_or(e.size().0, |m| m.size().0);
            let because = format!("there are {}", count(inputs.len(), "input", "inputs"));
            let place = if e.size().1 == inputs.len() { matrix.map_or(e.span, |m| m.span) } else { entry.value.span };
            let because =
                if e.size().1 == inputs.len() { format!("{what} has {}", count(r, "row", "rows")) } else { because };
            reader.size(e, "E", r, inputs.len(), (place, &because));
        }
        (None, Some(entry), None) if !meant.includes("E") => {
            let error = Diagnostic::error(Code::Missing, "[loop] has inputs but no 'E'");
            reader.report(
                error
                    .at(entry.key_span, "how do these enter?")
                    .help("E has a row for each state, a column for each input"),
            );
        }
        (_, None, Some(entry)) if !meant.includes("inputs") => {
            let error = Diagnostic::error(Code::Missing, "[loop] has 'E' but no 'inputs'");
            reader
                .report(error.at(entry.key_span, "what enters here?").help("name the columns of E: inputs = [\"..\"]"));
        }
        _ => {}
    }
    Ports { states, inputs, input_matrix, outputs }
}
