//! `jurist charpoly`: the characteristic polynomial.

use super::{Context, Runs, decided};
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::assignments::in_line;
use crate::cli::destinations::Files;
use crate::cli::input::{known_names, load, question};
use crate::cli::output::{ending, finish_answer, unknown_ending};
use crate::cli::status::{Error, Outcome, Status};
use clap::{Args, ValueEnum};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_engine::error::{Code, Diagnostic, Diagnostics};
use jurist_engine::model::Model;
use jurist_engine::problem::Problem;
use jurist_show::documents::{Charpoly, RootLocusForm, Transfer, to_text};
use jurist_show::notation::{NamedPolynomial, Notation, PolynomialReport, Relation, root_locus_form};
use std::ffi::OsString;
use std::sync::Arc;

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

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let notation = notation(self)?;
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        let problem = problem(self, context, &model)?;
        let file = self.output.output.as_ref();
        let report = match decided(report(self, context, &problem))? {
            Ok(report) => report,
            Err(stopped) => {
                if notation == Notation::Json {
                    finish_answer(&undecided(self, &problem, &stopped), file)?;
                }
                return Ok(context.say_undecided(&stopped));
            }
        };
        let digits = self.output.digits.map(|d| d as usize);
        let text = context.budget.enter(|| report.write(notation, digits))?;
        context.reporter.finish();
        finish_answer(&text, file)?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model.model, &self.output.output);
        Ok(())
    }
}

/// The notation asked for: by `--format`, by `--json`, or by the file's ending.
fn notation(options: &Options) -> Result<Notation, Error> {
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
            return Err(Diagnostic::error(Code::Usage, "'--json' contradicts '--format'")
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
        found.ok_or_else(|| Error::from(unknown_ending(file, &ENDINGS.map(|(e, _)| e))))
    };
    match (by_option, &options.output.output) {
        (Some(notation), _) => Ok(notation),
        (None, Some(file)) => by_ending(file),
        (None, None) => Ok(Notation::Text),
    }
}

/// What stays symbolic and what is set.
fn problem(options: &Options, context: &Context, model: &Model) -> Result<Arc<Problem>, Error> {
    let mut question = question(context, model, &options.model, &RegionOptions::default())?;
    known_names(context, model, "--keep", &options.keep)?;
    let mut keep = options.keep.clone();
    if keep.is_empty() {
        let free = model.parameters().iter().map(|p| p.name.clone());
        keep.extend(free.filter(|name| !question.values_set().contains_key(name)));
    }
    if let Some(name) = &options.root_locus_form {
        known_names(context, model, "--root-locus-form", std::slice::from_ref(name))?;
        if !keep.contains(name) {
            keep.push(name.clone());
        }
    }
    for name in keep {
        question = question.free(name);
    }
    let problem = question.problem().map_err(|failure| match failure {
        Error::Refused(error) => about_line(context, error).into(),
        other => other,
    })?;
    context.warn(None, problem.warnings());
    Ok(problem)
}

/// The document of a polynomial that the budget does not allow.
fn undecided(options: &Options, problem: &Problem, stopped: &Exhausted) -> String {
    match (&options.root_locus_form, &options.transfer) {
        (Some(_), _) => to_text(&RootLocusForm::undecided(problem, stopped)),
        (None, Some(_)) => to_text(&Transfer::undecided(problem, stopped)),
        (None, None) => to_text(&Charpoly::undecided(problem, stopped)),
    }
}

/// The names of what is free.
fn parameters(problem: &Problem) -> Vec<String> {
    problem.free().iter().map(|f| f.name.clone()).collect()
}

/// An error about the question that points into no text is about the command line.
fn about_line(context: &Context, error: Diagnostics) -> Diagnostics {
    if error.diagnostics().iter().all(|d| d.primary.is_none()) {
        return in_line(context.line, error.diagnostics().to_vec());
    }
    error
}

fn report(options: &Options, context: &Context, problem: &Problem) -> Result<PolynomialReport, Error> {
    let mut report = PolynomialReport {
        title: problem.title().unwrap_or_default().to_owned(),
        variable: problem.time().variable().to_owned(),
        parameters: parameters(problem),
        symbols: Vec::new(),
        set: problem.set().to_vec(),
        relation: Relation::Characteristic,
        polynomials: Vec::new(),
    };
    if let Some([input, output]) = options.transfer.as_deref() {
        problem.refuse_complex(&context.budget)?;
        let (closed_loop, symbols) = problem.closed_loop_over_symbols(&context.budget)?;
        report.with_symbols(symbols);
        let transfer = closed_loop.transfer_function(input, output, &context.budget);
        let transfer = transfer.map_err(|e| unknown_signal(context, e, [input, output]))?;
        report.relation = Relation::Transfer { input: input.clone(), output: output.clone() };
        report.polynomials = vec![
            NamedPolynomial::new("num", "b", transfer.numerator),
            NamedPolynomial::new("den", "a", transfer.denominator.coefficients),
        ];
        return Ok(report);
    }
    let algebra = problem.algebra_over_symbols(&context.budget)?;
    report.with_symbols(algebra.symbols());
    let Some(polynomial) = algebra.polynomial().cloned() else {
        return Err(Error::Undefined(algebra.undefined().unwrap_or_default().to_owned()));
    };
    match &options.root_locus_form {
        None if let Some(complex) = algebra.complex() => {
            report.relation = Relation::Complex;
            let (re, im) = (complex.re.clone(), complex.im.clone());
            report.polynomials = vec![NamedPolynomial::new("re", "a", re), NamedPolynomial::new("im", "b", im)];
        }
        None => report.polynomials = vec![NamedPolynomial::new("Q", "a", polynomial.coefficients)],
        Some(name) => {
            problem.refuse_complex(&context.budget)?;
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
) -> Result<(NamedPolynomial, NamedPolynomial), Error> {
    let split = polynomial.variable(name).and_then(|i| root_locus_form(polynomial, i));
    let Some((num, den)) = split else {
        let span = context.line.option_value("--root-locus-form", name).span;
        let message = format!("'{name}' does not enter the characteristic polynomial linearly");
        let diagnostic = Diagnostic::error(Code::NoRootLocus, message)
            .at(span, "1 + NAME num/den has NAME to the first power only")
            .help("a root locus needs a parameter that multiplies one polynomial in z or s");
        return Err(in_line(context.line, vec![diagnostic]).into());
    };
    Ok((NamedPolynomial::new("num", "b", num), NamedPolynomial::new("den", "a", den)))
}

/// A signal's name that the loop does not know is marked on the command line.
fn unknown_signal(context: &Context, failure: Error, names: [&String; 2]) -> Error {
    if let Error::Refused(error) = &failure
        && let [diagnostic] = error.diagnostics()
        && diagnostic.primary.is_none()
    {
        let quoted = |name: &&String| diagnostic.message.contains(&format!("'{name}'"));
        if let Some(span) = names.into_iter().find(quoted).and_then(|name| context.line.argument(name)) {
            return in_line(context.line, vec![diagnostic.clone().at(span, "not in the model")]).into();
        }
    }
    failure
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
