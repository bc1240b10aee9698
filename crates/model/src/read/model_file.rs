//! A whole model file.

use super::keys;
use super::loop_forms::read_form;
use super::reader::{Meant, NamedMatrix, Reader};
use super::tolerance::read_tolerance;
use super::{check_names, check_rules, check_values, rates};
use super::{domain, expect, nominal, references, require, ship, simulation, tune};
use crate::definition::{Constant, Diagram, Form, Model, Name, Parameter, Time};
use crate::error::{Code, Diagnostic, Diagnostics, Severity, Source, Span};
use crate::evaluate::work::constant_value;
use crate::text::names::{did_you_mean, shorten};
use crate::text::toml_reader;
use crate::text::toml_value::{Kind, Table};
use std::collections::HashMap;
use std::sync::Arc;

/// Errors shown of one file, and warnings of one kind.
const MAX_SHOWN: usize = 20;

impl Model {
    /// Reads a model file. Warnings come with the loop, up to twenty of a kind; errors come all together.
    ///
    /// Cost: linear in the text, but for the conversion of its numbers and the values of constants that are
    /// computed to be checked; no characteristic polynomial is made.
    ///
    /// ```
    /// use jurist_model::error::Source;
    /// use jurist_model::Model;
    /// let text = "time = 'discrete'\nparameters.K = {}\nloop.characteristic = 'z - k'";
    /// let error = Model::from_toml(&Source::new("model.toml", text)).unwrap_err();
    /// assert_eq!(error.to_string(), "model.toml:3:28: error[E-unknown-name]: unknown name 'k'");
    /// assert_eq!(error.diagnostics()[0].help.as_deref(), Some("did you mean 'K'?"));
    /// ```
    ///
    /// # Errors
    /// Everything that is wrong with the text, up to twenty diagnostics, each with its place.
    pub fn from_toml(source: &Arc<Source>) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
        let fail = |diagnostics| Diagnostics::new(Some(Arc::clone(source)), diagnostics);
        let root = toml_reader::read(&source.text).map_err(fail)?;
        let mut reader = Reader::default();
        let model = read_model(&root, source, &mut reader);
        let mut diagnostics = reader.diagnostics;
        diagnostics.sort_by_key(|d| d.primary.as_ref().map_or(0, |l| l.span.start));
        let errors = diagnostics.iter().any(|d| d.severity == Severity::Error);
        match model {
            Some(model) if !errors => Ok((model, counted(diagnostics))),
            _ => {
                diagnostics.retain(|d| d.severity == Severity::Error);
                diagnostics.truncate(MAX_SHOWN);
                if diagnostics.is_empty() {
                    // Parts are left out only together with an error.
                    diagnostics.push(Diagnostic::error(Code::Missing, "the model is not complete"));
                }
                Err(fail(diagnostics))
            }
        }
    }

    /// Reads a model file from bytes, which must be UTF-8.
    ///
    /// # Errors
    /// As [`Model::from_toml`], and `E-utf8`.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
        Model::from_toml(&source_from_bytes(name, bytes)?)
    }

    /// The drive of Gürbüz and Akpınar (2002), from `examples/drive.toml`.
    pub fn drive() -> Model {
        let source = Source::new("<built-in drive>", DRIVE);
        let (drive, _) = Model::from_toml(&source).expect("the built-in model is tested to be correct");
        drive
    }
}

/// The first warnings of each kind, and how many more there are of it: nobody reads thousands.
fn counted(warnings: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    let mut counts: Vec<(Code, usize)> = Vec::new();
    for warning in warnings {
        let at = counts.iter().position(|(code, _)| *code == warning.code).unwrap_or_else(|| {
            counts.push((warning.code, 0));
            counts.len() - 1
        });
        counts[at].1 += 1;
        if counts[at].1 <= MAX_SHOWN {
            out.push(warning);
        }
    }
    for (code, count) in counts.into_iter().filter(|(_, count)| *count > MAX_SHOWN) {
        let message = format!("{} more warnings of this kind are not shown", count - MAX_SHOWN);
        out.push(Diagnostic::warning(code, message));
    }
    out
}

/// The text of the built-in model.
pub const DRIVE: &str = include_str!("../../models/drive.toml");

/// A source text from bytes.
///
/// # Errors
/// `E-utf8` with the line, when the bytes are not UTF-8.
pub fn source_from_bytes(name: &str, bytes: &[u8]) -> Result<Arc<Source>, Diagnostics> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(Source::new(name, text)),
        Err(_) if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) => {
            let error = Diagnostic::error(Code::Utf8, "the file is UTF-16")
                .help("save it as UTF-8; in PowerShell: 'Set-Content -Encoding utf8' in place of '>'");
            Err(Diagnostics::new(Some(Source::new(name, "")), vec![error]))
        }
        Err(error) => {
            let offset = error.valid_up_to();
            let text = String::from_utf8_lossy(bytes).into_owned();
            let length = text[offset..].chars().next().map_or(0, char::len_utf8);
            let diagnostic = Diagnostic::error(Code::Utf8, format!("byte {} is not valid UTF-8", offset + 1))
                .at(Span::new(offset, offset + length), "not UTF-8")
                .help("save the file as UTF-8");
            Err(Diagnostics::new(Some(Source::new(name, text)), vec![diagnostic]))
        }
    }
}

fn read_model(root: &Table, source: &Arc<Source>, reader: &mut Reader) -> Option<Model> {
    let meant = reader.unknown_keys(root, &keys::MODEL, "the model");
    let title = reader.plain_string(root, "title");
    let time = read_time(root, &meant, reader);
    let sample_time = root.get("sample_time").and_then(|v| reader.expression(v, "'sample_time'"));
    let constants = read_constants(root, reader);
    let parameters = read_parameters(root, reader);
    let form = read_form(root, &meant, time.unwrap_or(Time::Discrete), sample_time.as_ref(), reader);
    let simulation = simulation::read(root, reader);
    let require = require::read(root, reader);
    let expect = expect::of_model(root, source, reader);
    let shipping = ship::read(root, reader);
    let tuning = tune::read(root, reader);
    let mut index = HashMap::new();
    check_names::definitions(&constants, &parameters, time.unwrap_or(Time::Discrete), &mut index, reader);
    let order = check_names::order(&constants, &parameters, &index, reader);
    let mut form = form;
    let mut model = Model {
        source: Arc::clone(source),
        title,
        time: time?,
        sample_time,
        constants,
        order,
        parameters,
        // With a broken form the names are checked all the same.
        form: form.clone().unwrap_or(Form::Blocks(Diagram { inputs: vec![], outputs: vec![], blocks: vec![] })),
        simulation,
        require,
        expect,
        shipping,
        tuning,
        index,
        has_unit: false,
    };
    let form_is_broken = form.is_none();
    check_names::names(&model, form_is_broken, reader);
    model.has_unit = reader.has_unit;
    let broken = reader.diagnostics.iter().any(|d| d.severity == Severity::Error);
    if !broken {
        if let Some(form) = &mut form {
            rates::resolve(&model, form, reader);
            model.form = form.clone();
        }
        check_values::values(&model, reader);
        check_values::sample_time(&model, reader);
        check_rules::rules(&model, reader);
        model.expect.iter().for_each(|expectation| reader.diagnostics.extend(expectation.unknown_names(&model)));
        nominal::values(&mut model, reader);
    }
    model.form = form?;
    Some(model)
}

fn read_time(root: &Table, meant: &Meant, reader: &mut Reader) -> Option<Time> {
    let Some(value) = root.get("time") else {
        if meant.includes("time") {
            return None;
        }
        let error = Diagnostic::error(Code::Missing, "the model does not say whether time is discrete or continuous");
        reader.report(error.help("add a line: time = \"discrete\" or time = \"continuous\""));
        return None;
    };
    let text = reader.string(value, "'time'")?;
    match text.as_str() {
        "discrete" => Some(Time::Discrete),
        "continuous" => Some(Time::Continuous),
        other => {
            let mut error = Diagnostic::error(Code::Value, format!("unknown kind of time '{}'", shorten(other)))
                .at(value.span, "neither \"discrete\" nor \"continuous\"");
            error.help = did_you_mean(other, keys::TIMES);
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
        if let Kind::Array(_) = &entry.value.kind {
            match reader.matrix(&entry.value, &what) {
                Some(matrix) => reader.matrices.push(NamedMatrix { name, matrix, is_used: false }),
                None => {
                    reader.refused.insert(name.name);
                }
            }
            continue;
        }
        let (value, tolerance) = match &entry.value.kind {
            Kind::Table(table) => {
                reader.unknown_keys(table, &keys::CONSTANT, "a constant");
                let tolerance = read_tolerance(table, reader);
                reader.plain_string(table, "unit");
                reader.plain_string(table, "description");
                if references::is_left(table, reader) {
                    reader.refused.insert(name.name);
                    continue;
                }
                let Some(value) = table.get("value") else {
                    let error = Diagnostic::error(Code::Missing, format!("{what} has no 'value'"));
                    reader.report(error.at(entry.value.span, "a table without a value"));
                    reader.refused.insert(name.name);
                    continue;
                };
                (value, tolerance.zip(table.get("tolerance").map(|v| v.span)))
            }
            _ => (&entry.value, None),
        };
        let Some(expression) = reader.expression(value, &what) else {
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
        if let (None, Some((_, span))) = (&number, &tolerance) {
            let error =
                Diagnostic::error(Code::Tolerance, format!("{what} is given by a formula, so it has no tolerance"));
            reader.report(error.at(*span, "not accepted").help("give what it depends on a tolerance"));
        }
        let tolerance = tolerance.map(|(tolerance, _)| tolerance);
        constants.push(Constant { name: name.name, span: name.span, expression, number, tolerance });
    }
    constants
}

fn read_parameters(root: &Table, reader: &mut Reader) -> Vec<Parameter> {
    let mut parameters = Vec::new();
    for entry in section(root, "parameters", reader).into_iter().flat_map(Table::iter) {
        let Some(Name { name, span }) = reader.name(&entry.key, entry.key_span, "a parameter") else { continue };
        let mut parameter = Parameter::named(name, span);
        match &entry.value.kind {
            Kind::Table(table) => read_parameter(table, &mut parameter, reader),
            Kind::Number(_) | Kind::String(_) => {
                nominal::read(&entry.value, &mut parameter, "a nominal value", reader);
            }
            _ => reader.wrong_type(&entry.value, "a parameter", "a table or a number"),
        }
        parameters.push(parameter);
    }
    parameters
}

fn read_parameter(table: &Table, parameter: &mut Parameter, reader: &mut Reader) {
    reader.unknown_keys(table, &keys::PARAMETER, "a parameter");
    references::is_left(table, reader);
    if let Some(value) = table.get("nominal") {
        nominal::read(value, parameter, "'nominal'", reader);
    }
    let ends = domain::read(table, parameter, reader);
    parameter.unit = reader.plain_string(table, "unit");
    parameter.description = reader.plain_string(table, "description");
    parameter.tolerance = read_tolerance(table, reader);
    if let (Some(min), Some(max)) = (&parameter.min, &parameter.max)
        && min >= max
    {
        reader.report(domain::empty(parameter, ends));
    } else if let Some(value) = &parameter.nominal
        && !parameter.contains(value)
    {
        let is_below = parameter.min.as_ref().is_some_and(|min| value <= min);
        let at = table.get("nominal").map_or(parameter.span, |v| v.span);
        let warning = nominal::outside(parameter, at, &format!("not in the {} domain", domain::kind(parameter)));
        reader.report(warning.also(ends[usize::from(!is_below)], "which ends here"));
    }
}
