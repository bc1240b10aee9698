//! A whole model file.

use super::check;
use super::definition::{Constant, Diagram, Form, Loop, Matrix, Name, Parameter, Ports, Time};
use super::names::{did_you_mean, list, shorten};
use super::read::{Meant, Reader, constant_value, count};
use super::read_block;
use super::simulation;
use super::toml::{Entry, Kind, Table};
use super::toml_read;
use crate::error::{Diagnostic, Error, Severity, Source, Span};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Errors shown of one file.
const MAX_SHOWN: usize = 20;

/// The keys of `[loop]` that make a form.
const FORM_KEYS: [&str; 6] = ["characteristic", "matrix", "A", "B", "C", "K"];

impl Loop {
    /// Reads a model file. Warnings come with the loop; errors come all together.
    ///
    /// ```
    /// use jurist_engine::error::Source;
    /// use jurist_engine::model::Loop;
    /// let text = "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - k'";
    /// let error = Loop::from_toml(&Source::new("model.toml", text)).unwrap_err();
    /// assert_eq!(error.to_string(), "model.toml:3:28: error[E-unknown-name]: unknown name 'k'");
    /// assert_eq!(error.diagnostics()[0].help.as_deref(), Some("did you mean 'K'?"));
    /// ```
    ///
    /// # Errors
    /// Everything that is wrong with the text, up to twenty diagnostics, each with its place.
    pub fn from_toml(source: &Arc<Source>) -> Result<(Loop, Vec<Diagnostic>), Error> {
        let fail = |diagnostics| Error::new(Some(Arc::clone(source)), diagnostics);
        let root = toml_read::read(&source.text).map_err(fail)?;
        let mut reader = Reader::default();
        let model = read_model(&root, source, &mut reader);
        let mut diagnostics = reader.diagnostics;
        diagnostics.sort_by_key(|d| d.primary.as_ref().map_or(0, |l| l.span.start));
        let errors = diagnostics.iter().any(|d| d.severity == Severity::Error);
        match model {
            Some(model) if !errors => Ok((model, diagnostics)),
            _ => {
                diagnostics.retain(|d| d.severity == Severity::Error);
                diagnostics.truncate(MAX_SHOWN);
                if diagnostics.is_empty() {
                    // Parts are left out only together with an error.
                    diagnostics.push(Diagnostic::error("E-missing", "the model is not complete"));
                }
                Err(fail(diagnostics))
            }
        }
    }

    /// Reads a model file from bytes, which must be UTF-8.
    ///
    /// # Errors
    /// As [`Loop::from_toml`], and `E-utf8`.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<(Loop, Vec<Diagnostic>), Error> {
        Loop::from_toml(&source_from_bytes(name, bytes)?)
    }

    /// The drive of Gürbüz and Akpınar (2002), from `examples/drive.toml`.
    pub fn drive() -> Loop {
        let source = Source::new("<built-in drive>", DRIVE);
        let (drive, _) = Loop::from_toml(&source).expect("the built-in model is tested to be correct");
        drive
    }
}

/// The text of the built-in model.
pub const DRIVE: &str = include_str!("../../../../examples/drive.toml");

/// A source text from bytes.
///
/// # Errors
/// `E-utf8` with the line, when the bytes are not UTF-8.
pub fn source_from_bytes(name: &str, bytes: &[u8]) -> Result<Arc<Source>, Error> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(Source::new(name, text)),
        Err(error) => {
            let offset = error.valid_up_to();
            let text = String::from_utf8_lossy(bytes).into_owned();
            let length = text[offset..].chars().next().map_or(0, char::len_utf8);
            let diagnostic = Diagnostic::error("E-utf8", format!("byte {} is not valid UTF-8", offset + 1))
                .at(Span::new(offset, offset + length), "not UTF-8")
                .help("save the file as UTF-8");
            Err(Error::new(Some(Source::new(name, text)), vec![diagnostic]))
        }
    }
}

fn read_model(root: &Table, source: &Arc<Source>, reader: &mut Reader) -> Option<Loop> {
    let known = ["title", "time", "sample_time", "constants", "parameters", "loop", "block", "simulation"];
    let meant = reader.unknown_keys(root, &known, "the model");
    let title = reader.plain_string(root, "title");
    let time = read_time(root, &meant, reader);
    let sample_time = root.get("sample_time").and_then(|v| reader.expression(v, "'sample_time'"));
    let constants = read_constants(root, reader);
    let parameters = read_parameters(root, reader);
    let form = read_form(root, &meant, time.unwrap_or(Time::Discrete), reader);
    let simulation = simulation::read(root, reader);
    let mut index = HashMap::new();
    check::definitions(&constants, &parameters, time.unwrap_or(Time::Discrete), &mut index, reader);
    let constant_order = check::constant_order(&constants, &index, reader);
    let mut model = Loop {
        source: Arc::clone(source),
        title,
        time: time?,
        sample_time,
        constants,
        constant_order,
        parameters,
        // With a broken form the names are checked all the same.
        form: form.clone().unwrap_or(Form::Blocks(Diagram { inputs: vec![], outputs: vec![], blocks: vec![] })),
        simulation,
        index,
    };
    let form_is_broken = form.is_none();
    check::names(&model, form_is_broken, reader);
    let broken = reader.diagnostics.iter().any(|d| d.severity == Severity::Error);
    if !broken {
        check::values(&model, reader);
        check::sample_time(&model, reader);
    }
    model.form = form?;
    Some(model)
}

fn read_time(root: &Table, meant: &Meant, reader: &mut Reader) -> Option<Time> {
    let Some(value) = root.get("time") else {
        if meant.includes("time") {
            return None;
        }
        let error = Diagnostic::error("E-missing", "the model does not say whether time is discrete or continuous");
        reader.report(error.help("add a line: time = \"discrete\" or time = \"continuous\""));
        return None;
    };
    let text = reader.string(value, "'time'")?;
    match text.as_str() {
        "discrete" => Some(Time::Discrete),
        "continuous" => Some(Time::Continuous),
        other => {
            let mut error = Diagnostic::error("E-value", format!("unknown kind of time '{}'", shorten(other)))
                .at(value.span, "neither \"discrete\" nor \"continuous\"");
            error.help = did_you_mean(other, ["discrete", "continuous"]);
            reader.report(error);
            None
        }
    }
}

pub(super) fn section<'t>(root: &'t Table, key: &str, reader: &mut Reader) -> Option<&'t Table> {
    root.entry(key).and_then(|entry| reader.table(entry))
}

fn read_constants(root: &Table, reader: &mut Reader) -> Vec<Constant> {
    let mut constants = Vec::new();
    for entry in section(root, "constants", reader).into_iter().flat_map(Table::iter) {
        let Some(name) = reader.name(&entry.key, entry.key_span, "a constant") else { continue };
        let what = format!("the constant '{}'", shorten(&entry.key));
        let Some(expression) = reader.expression(&entry.value, &what) else {
            reader.refused.insert(name.name);
            continue;
        };
        let number = match constant_value(&expression) {
            Ok(number) => Some(number),
            Err(Some(diagnostic)) => {
                reader.report(diagnostic);
                reader.refused.insert(name.name);
                continue;
            }
            Err(None) => None,
        };
        constants.push(Constant { name: name.name, span: name.span, expression, number });
    }
    constants
}

fn read_parameters(root: &Table, reader: &mut Reader) -> Vec<Parameter> {
    let mut parameters = Vec::new();
    for entry in section(root, "parameters", reader).into_iter().flat_map(Table::iter) {
        let Some(Name { name, span }) = reader.name(&entry.key, entry.key_span, "a parameter") else { continue };
        let mut parameter =
            Parameter { name, span, nominal: None, min: None, max: None, unit: None, description: None };
        match &entry.value.kind {
            Kind::Table(table) => read_parameter(table, &mut parameter, reader),
            Kind::Number(_) | Kind::String(_) => parameter.nominal = reader.number(&entry.value, "a nominal value"),
            _ => reader.wrong_type(&entry.value, "a parameter", "a table or a number"),
        }
        parameters.push(parameter);
    }
    parameters
}

fn read_parameter(table: &Table, parameter: &mut Parameter, reader: &mut Reader) {
    reader.unknown_keys(table, &["nominal", "min", "max", "unit", "description"], "a parameter");
    let mut number = |key: &str| {
        let value = table.get(key)?;
        reader.number(value, &format!("'{key}'"))
    };
    parameter.nominal = number("nominal");
    parameter.min = number("min");
    parameter.max = number("max");
    parameter.unit = reader.plain_string(table, "unit");
    parameter.description = reader.plain_string(table, "description");
    let span = |key: &str| table.get(key).map_or(parameter.span, |v| v.span);
    if let (Some(min), Some(max)) = (&parameter.min, &parameter.max)
        && min >= max
    {
        let message = format!("the domain of '{}' is empty", shorten(&parameter.name));
        reader.report(
            Diagnostic::error("E-empty-domain", message)
                .at(span("max"), "the upper bound")
                .also(span("min"), "is not above this lower bound")
                .help("'min' must be less than 'max'; both are open bounds"),
        );
    } else if let Some(nominal) = &parameter.nominal
        && !parameter.contains(nominal)
    {
        let message = format!("the nominal value of '{}' is outside its domain", shorten(&parameter.name));
        let outside_below = parameter.min.as_ref().is_some_and(|min| nominal <= min);
        let bound = if outside_below { span("min") } else { span("max") };
        let warning = Diagnostic::warning("W-outside-domain", message).at(span("nominal"), "not in the open domain");
        reader.report(warning.also(bound, "which ends here"));
    }
}

fn read_form(root: &Table, meant: &Meant, time: Time, reader: &mut Reader) -> Option<Form> {
    let blocks = root.entry("block");
    let Some(entry) = root.entry("loop") else {
        if meant.includes("loop") {
            return None;
        }
        let mut error = Diagnostic::error("E-missing", "the model has no [loop]");
        if let Some(block) = blocks {
            error = error.at(block.key_span, "these blocks need a [loop] with inputs and outputs");
        }
        reader.report(error.help(match blocks {
            Some(_) => {
                "add [loop] with the external signals and those of interest: inputs = [\"r\"], outputs = [\"y\"]"
            }
            None => "add [loop] with 'characteristic', with 'matrix', or with 'A', 'B', 'C', 'K'",
        }));
        return None;
    };
    let table = reader.table(entry)?;
    let mut known = FORM_KEYS.to_vec();
    known.extend(["states", "inputs", "E", "outputs"]);
    let before = reader.diagnostics.len();
    let meant_in_loop = reader.unknown_keys(table, &known, "[loop]");
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
            let error = Diagnostic::error("E-missing", "[loop] does not say what the loop is");
            let error = error.at(entry.key_span, "empty");
            reader.report(error.help("give 'characteristic', 'matrix', 'A', 'B', 'C' and 'K', or [[block]] entries"));
            None
        }
        [(form, _)] => match *form {
            "characteristic" => {
                for entry in table.iter().filter(|e| ["states", "inputs", "E", "outputs"].contains(&e.key.as_str())) {
                    let message = format!("'{}' says nothing beside 'characteristic'", entry.key);
                    reader.report(Diagnostic::warning("W-unused", message).at(entry.key_span, "not used"));
                }
                reader.expression(table.get("characteristic")?, "'characteristic'").map(Form::Characteristic)
            }
            "matrix" => read_matrix_form(table, &meant_in_loop, reader),
            "A, B, C, K" => read_feedback_form(table, &meant_in_loop, &given, reader),
            _ => read_block::diagram(table, blocks?, time, reader).map(Form::Blocks),
        },
        [(a, first), (b, second), ..] => {
            let message = format!("the loop is given twice: by {a} and by {b}");
            let error = Diagnostic::error("E-two-forms", message).at(*second, "given here again");
            reader.report(error.also(*first, "first given here").help("keep exactly one form"));
            None
        }
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
        let error = Diagnostic::error("E-size", format!("{what} is {r} x {c}, but must be square"));
        reader.report(error.at(matrix.span, format!("{}, {}", count(r, "row", "rows"), count(c, "column", "columns"))));
    } else if r == 0 {
        let error = Diagnostic::error("E-size", format!("{what} is empty")).at(matrix.span, "no rows");
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
            let error = Diagnostic::error("E-missing", format!("[loop] has no '{key}'"));
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
        if matches!(&entry.value.kind, Kind::Array(items) if items.len() != n) {
            let given = if let Kind::Array(items) = &entry.value.kind { items.len() } else { 1 };
            let message = format!("{} for {}", count(given, "state", "states"), count(n, "row", "rows"));
            let error = Diagnostic::error("E-size", message).at(entry.value.span, "the states");
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
            let error = Diagnostic::error("E-missing", "[loop] has inputs but no 'E'");
            reader.report(
                error
                    .at(entry.key_span, "how do these enter?")
                    .help("E has a row for each state, a column for each input"),
            );
        }
        (_, None, Some(entry)) if !meant.includes("inputs") => {
            let error = Diagnostic::error("E-missing", "[loop] has 'E' but no 'inputs'");
            reader
                .report(error.at(entry.key_span, "what enters here?").help("name the columns of E: inputs = [\"..\"]"));
        }
        _ => {}
    }
    Ports { states, inputs, input_matrix, outputs }
}

/// The names of a list for a message, each once.
pub(super) fn known_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let mut seen = HashSet::new();
    let names: Vec<&str> = names.into_iter().filter(|n| seen.insert(*n)).take(8).collect();
    (!names.is_empty()).then(|| format!("known here: {}", list(names)))
}
