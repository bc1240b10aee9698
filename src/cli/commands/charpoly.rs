//! `jurist charpoly`: the characteristic polynomial.

use super::Context;
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::assignments::in_line;
use crate::cli::input::{known_names, load, settings};
use crate::cli::output::{ending, unknown_ending, write_answer};
use crate::cli::status::{Failure, Outcome, Status};
use clap::{Args, ValueEnum};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_engine::analysis::{Point, Settings};
use jurist_engine::error::{Diagnostic, Error};
use jurist_engine::model::{Loop, ModelError, Question};
use jurist_engine::show::json;
use jurist_engine::show::notation::{NamedPolynomial, Notation, PolynomialReport, Relation, root_locus_form};
use std::ffi::OsString;

/// Options of `jurist charpoly`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Keeps a parameter as a symbol [repeatable; default: every parameter that is not set]
    #[arg(long, value_name = "NAME")]
    pub keep: Vec<String>,
    /// How it is written
    #[arg(long, value_enum)]
    pub format: Option<Format>,
    /// As 1 + NAME num/den, for a root locus in NAME
    #[arg(long, value_name = "NAME", conflicts_with = "transfer")]
    pub root_locus_form: Option<String>,
    /// The closed-loop transfer function from an input to an output
    #[arg(long, num_args = 2, value_names = ["INPUT", "OUTPUT"])]
    pub transfer: Option<Vec<String>>,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Answers on standard output or in a file.
pub(in crate::cli) fn run(options: &Options, context: &Context) -> Outcome {
    let notation = notation(options)?;
    let model = load(options.model.model.as_ref(), context)?;
    let question = question(options, context, &model)?;
    let file = options.output.output.as_ref();
    if notation == Notation::Json {
        let document = undecided(options, &model, &question)?;
        context.watch.know(file, move |budget, reached| Some(document(&budget, &reached)));
    }
    let report = match report(options, context, &model, &question) {
        Ok(report) => report,
        Err(Failure::Undecided(exhausted)) if notation == Notation::Json => {
            let document = undecided(options, &model, &question)?;
            write_answer(&document(&exhausted.budget, &context.reporter.reached()), file)?;
            return Err(exhausted.into());
        }
        Err(failure) => return Err(failure),
    };
    context.reporter.finish();
    let digits = options.output.digits.map(|d| d as usize);
    write_answer(&report.write(notation, digits), file)?;
    Ok(Status::Holds)
}

/// The notation asked for: by `--format`, by `--json`, or by the file's ending.
fn notation(options: &Options) -> Result<Notation, Failure> {
    const ENDINGS: [(&str, Notation); 7] = [
        ("txt", Notation::Text),
        ("json", Notation::Json),
        ("csv", Notation::Csv),
        ("tex", Notation::Latex),
        ("m", Notation::Matlab),
        ("py", Notation::Python),
        ("rs", Notation::Rust),
    ];
    let by_option = match (options.format, options.output.json) {
        (None | Some(Format::Json), true) => Some(Notation::Json),
        (Some(_), true) => {
            return Err(Diagnostic::error("E-usage", "'--json' contradicts '--format'")
                .help("leave out one of the two")
                .into());
        }
        (Some(Format::Text), _) => Some(Notation::Text),
        (Some(Format::Json), _) => Some(Notation::Json),
        (Some(Format::Csv), _) => Some(Notation::Csv),
        (Some(Format::Latex), _) => Some(Notation::Latex),
        (Some(Format::Matlab), _) => Some(Notation::Matlab),
        (Some(Format::Python), _) => Some(Notation::Python),
        (Some(Format::Rust), _) => Some(Notation::Rust),
        (None, false) => None,
    };
    let by_ending = |file: &OsString| {
        let Some(e) = ending(file) else { return Ok(Notation::Text) };
        let found = ENDINGS.iter().find(|(known, _)| *known == e).map(|(_, notation)| *notation);
        found.ok_or_else(|| Failure::from(unknown_ending(file, &ENDINGS.map(|(e, _)| e))))
    };
    match (by_option, &options.output.output) {
        (Some(notation), _) => Ok(notation),
        (None, Some(file)) => by_ending(file),
        (None, None) => Ok(Notation::Text),
    }
}

/// What stays symbolic and what is set.
fn question(options: &Options, context: &Context, model: &Loop) -> Result<Question, Failure> {
    let settings = settings(context, model, &options.model, &RegionOptions::default())?;
    known_names(context, model, "--keep", &options.keep)?;
    let mut keep = options.keep.clone();
    if keep.is_empty() {
        let free = model.parameters().iter().map(|p| p.name.clone());
        keep.extend(free.filter(|name| !settings.set.contains_key(name)));
    }
    if let Some(name) = &options.root_locus_form {
        known_names(context, model, "--root-locus-form", std::slice::from_ref(name))?;
        if !keep.contains(name) {
            keep.push(name.clone());
        }
    }
    let warnings = settings.warnings(model, &keep);
    let question = Question { keep, set: settings.set };
    model.resolve(&question).map_err(|e| about_line(context, e))?;
    context.warn(None, &warnings);
    Ok(question)
}

/// Writes a document, given the budget and how far the work came.
type Document = Box<dyn FnOnce(&str, &str) -> String + Send>;

/// The document of a polynomial that the budget does not allow.
fn undecided(options: &Options, model: &Loop, question: &Question) -> Result<Document, Failure> {
    let (schema, key) = match (&options.root_locus_form, &options.transfer) {
        (Some(_), _) => ("jurist/root-locus-form/1", "numerator"),
        (None, Some(_)) => ("jurist/transfer/1", "numerator"),
        (None, None) => ("jurist/charpoly/1", "coefficients"),
    };
    let settings = Settings { set: question.set.clone(), ..Settings::default() };
    let point = Point::of(model, &settings, &question.keep)?;
    let (variable, parameters) = (model.time().variable(), question.keep.clone());
    Ok(Box::new(move |budget, reached| {
        let mut document = json::undecided_at_point(schema, key, budget, reached, &point);
        document["variable"] = variable.into();
        document["parameters"] = parameters.into();
        json::to_text(&document)
    }))
}

/// An error about the question that points into no text is about the command line.
fn about_line(context: &Context, error: Error) -> Error {
    if error.diagnostics().iter().all(|d| d.primary.is_none()) {
        return in_line(context.line, error.diagnostics().to_vec());
    }
    error
}

fn report(
    options: &Options,
    context: &Context,
    model: &Loop,
    question: &Question,
) -> Result<PolynomialReport, Failure> {
    context.budget.step("characteristic polynomial");
    let set = model.resolve(question).map_err(|e| about_line(context, e))?.values;
    let mut report = PolynomialReport {
        title: model.title().unwrap_or_default().to_owned(),
        variable: model.time().variable().to_owned(),
        parameters: question.keep.clone(),
        set,
        relation: Relation::Characteristic,
        polynomials: Vec::new(),
    };
    if let Some([input, output]) = options.transfer.as_deref() {
        let transfer = model.transfer_function(input, output, question, &context.budget);
        let transfer = transfer.map_err(|e| unknown_signal(context, e, [input, output]))?;
        report.relation = Relation::Transfer { input: input.clone(), output: output.clone() };
        report.polynomials = vec![
            NamedPolynomial::new("num", "b", transfer.numerator),
            NamedPolynomial::new("den", "a", transfer.denominator.coefficients),
        ];
        return Ok(report);
    }
    let polynomial = model.characteristic_polynomial(question, &context.budget).map_err(|e| refused(context, e))?;
    match &options.root_locus_form {
        None => report.polynomials = vec![NamedPolynomial::new("Q", "a", polynomial.coefficients)],
        Some(name) => {
            let (num, den) = root_locus(context, &polynomial, name)?;
            report.relation = Relation::RootLocus { parameter: name.clone() };
            report.polynomials = vec![num, den];
        }
    }
    Ok(report)
}

fn root_locus(
    context: &Context,
    polynomial: &CharacteristicPolynomial,
    name: &str,
) -> Result<(NamedPolynomial, NamedPolynomial), Failure> {
    let split = polynomial.variable(name).and_then(|i| root_locus_form(polynomial, i));
    let Some((num, den)) = split else {
        let span = context.line.option_value("--root-locus-form", name).span;
        let message = format!("'{name}' does not enter the characteristic polynomial linearly");
        let diagnostic = Diagnostic::error("E-no-root-locus", message)
            .at(span, "1 + NAME num/den has NAME to the first power only")
            .help("a root locus needs a parameter that multiplies one polynomial in z or s");
        return Err(in_line(context.line, vec![diagnostic]).into());
    };
    Ok((NamedPolynomial::new("num", "b", num), NamedPolynomial::new("den", "a", den)))
}

/// A signal's name that the loop does not know is marked on the command line.
fn unknown_signal(context: &Context, error: ModelError, names: [&String; 2]) -> Failure {
    if let ModelError::Input(error) = &error
        && let [diagnostic] = error.diagnostics()
        && diagnostic.primary.is_none()
    {
        let quoted = |name: &&String| diagnostic.message.contains(&format!("'{name}'"));
        if let Some(span) = names.into_iter().find(quoted).and_then(|name| context.line.argument(name)) {
            return in_line(context.line, vec![diagnostic.clone().at(span, "not in the model")]).into();
        }
    }
    refused(context, error)
}

/// A model that gives no polynomial.
fn refused(context: &Context, error: ModelError) -> Failure {
    match error {
        ModelError::Input(error) => about_line(context, error).into(),
        ModelError::Exhausted(exhausted) => exhausted.into(),
        ModelError::Undefined(what) => {
            let message = format!("the model is undefined for these values: {what}");
            Diagnostic::error("E-undefined", message).help("set the parameters to other values").into()
        }
    }
}

/// The notations a polynomial is written in.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum Format {
    /// For people
    Text,
    /// For programs
    Json,
    /// A row per coefficient and monomial
    Csv,
    /// Aligned equations
    Latex,
    /// A coefficient vector, highest power first
    Matlab,
    /// A list of fractions, lowest power first
    Python,
    /// An array of fractions, lowest power first
    Rust,
}
