//! `jurist check`: only reads a model.

use super::{Context, Runs};
use crate::cli::arguments::{ReadingOptions, RunOptions};
use crate::cli::destinations::Files;
use crate::cli::input::{NamedModel, read_model, tell_numbers};
use crate::cli::output::write_answer;
use crate::cli::show;
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Verdict;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error};
use jurist_engine::model::Model;
use jurist_engine::problem::{Ask, Question};
use jurist_engine::response::Requirements;
use jurist_show::Text;
use jurist_show::documents::{Check, to_text};
use std::ffi::OsString;

/// Options of `jurist check`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// A model file, '-' for standard input, or a loop in one line; left out: the built-in drive
    #[arg(value_name = "MODEL")]
    pub model: Option<OsString>,
    #[command(flatten)]
    pub line: ReadingOptions,
    /// Writes JSON
    #[arg(long)]
    pub json: bool,
    /// Writes a SARIF log, which editors and code hosts show beside the text; what [require] asks for and the nominal loop does not
    /// meet is in it as well
    #[arg(long, conflicts_with = "json")]
    pub sarif: bool,
    /// Writes the JSON document or the log to a file
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let NamedModel { name, read, numbers, .. } = read_model(self.model.as_ref(), &self.line, context)?;
        if read.is_ok() {
            tell_numbers(&name, &numbers, &self.line, context)?;
        }
        let mut unmet = Vec::new();
        let (source, diagnostics) = match read {
            Ok((model, warnings)) => {
                let refused = refusals(&model, &context.budget);
                if self.sarif && refused.is_empty() && !model.require().is_empty() {
                    unmet = unmet_requirements(&model, &context.budget);
                }
                (Some(model.source().clone()), [warnings, refused, unmet.clone()].concat())
            }
            Err(errors) => (errors.source_text().cloned(), errors.diagnostics().to_vec()),
        };
        let check = Check::new(&name, source.as_deref(), &diagnostics);
        let status = match (check.accepted, unmet.is_empty()) {
            (true, true) => Status::Holds,
            (true, false) => Status::DoesNotHold,
            (false, _) => Status::BadInput,
        };
        context.reporter.finish();
        if self.json || self.sarif {
            let text = if self.sarif { to_text(&check.sarif()) } else { to_text(&check) };
            write_answer(&text, self.output.as_ref())?;
            return Ok(status);
        }
        let only_warnings = check.accepted;
        if !diagnostics.is_empty() && (!only_warnings || !context.quiet) {
            show(&Diagnostics::new(source, diagnostics.clone()));
        }
        if check.accepted {
            let remarks = match diagnostics.len() {
                0 => "no mistakes found".to_owned(),
                1 => "no mistakes found, one warning".to_owned(),
                n => format!("no mistakes found, {n} warnings"),
            };
            write_answer(&format!("{name}: {remarks}"), self.output.as_ref())?;
        }
        Ok(status)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model, &self.output);
        Ok(())
    }
}

/// Significant digits of the values in remarks.
const DIGITS: usize = 6;

/// Units of counted work for expressions that grow and for requirements: seconds, where a model needs them. What takes more is not looked at.
const WORK_OF_EXPRESSIONS: u64 = 200_000_000;
const WORK_OF_REQUIREMENTS: u64 = 30_000_000;

/// What every question is refused for, and what is refused of the requirements of the model.
fn refusals(model: &Model, budget: &Budget) -> Vec<Diagnostic> {
    let refused = |found: Result<(), Error>| match found {
        Err(Error::Refused(refused)) => refused.diagnostics().to_vec(),
        _ => Vec::new(),
    };
    let mut wrong = refused(model.check_expressions(&budget.silent().within_work(WORK_OF_EXPRESSIONS)));
    if !wrong.is_empty() || model.require().is_empty() {
        return wrong;
    }
    let budget = &budget.silent().within_work(WORK_OF_REQUIREMENTS);
    let values = match model.ask().with_nominal_values() {
        Ok(question) => question.values_set().clone().into_iter().collect::<Vec<_>>(),
        Err(_) => return Vec::new(),
    };
    let asked = match Requirements::of(model, &[], &values, budget) {
        Ok(asked) => asked,
        other => {
            let mut wrong = refused(other.map(drop));
            wrong.retain(|one| !depends_on_open(model, &values, one));
            return wrong;
        }
    };
    let mut add = |found: Result<(), Error>, name: &str| {
        for one in refused(found) {
            let name = if one.code == Code::UnknownSignal { "at" } else { name };
            let one = if one.primary.is_none() { required(model, name, one) } else { one };
            // A cut that is missing is so for each margin.
            if wrong.iter().all(|known: &Diagnostic| known.message != one.message) {
                wrong.push(one);
            }
        }
    };
    let Ok(plain) = model.ask().problem() else { return Vec::new() };
    for requirement in &asked.list {
        let met = plain.requirements_met(std::slice::from_ref(requirement), asked.at.as_deref(), budget);
        add(met.map(drop), requirement.name());
    }
    if let Some((name, _)) = asked.regional.last() {
        add(question(model, &asked).problem().and_then(|problem| problem.verdict(budget).map(drop)), name);
    }
    wrong
}

/// Whether what is wrong with a requirement may be right with a value that is given with the question.
fn depends_on_open(model: &Model, values: &[(String, Rational)], wrong: &Diagnostic) -> bool {
    let is_open = |word: &str| model.parameter(word).is_some() && values.iter().all(|(name, _)| name != word);
    let words = |text: &str| text.split(|c: char| !c.is_alphanumeric() && c != '_').any(is_open);
    let own = |span| model.require().iter().find(|required| required.span == span);
    wrong.primary.as_ref().and_then(|label| own(label.span)).is_some_and(|required| words(&required.text))
}

/// The nominal loop with the region that is required.
fn question(model: &Model, asked: &Requirements) -> Question {
    asked.region.clone().into_iter().fold(model.ask(), Question::within)
}

/// A diagnostic at the place of a requirement.
fn required(model: &Model, name: &str, diagnostic: Diagnostic) -> Diagnostic {
    match model.require().iter().find(|r| r.name == name).or(model.require().first()) {
        Some(required) => diagnostic.at(required.span, "required here"),
        None => diagnostic,
    }
}

/// A remark for each requirement of the model that the nominal loop does not meet, or one that they were not decided.
fn unmet_requirements(model: &Model, budget: &Budget) -> Vec<Diagnostic> {
    let remark = |name: &str, message: String| {
        let warning = Diagnostic::warning(Code::NotMetWarning, message).help("'jurist verdict' has all values");
        required(model, name, warning)
    };
    let found = || -> Result<Vec<Diagnostic>, Error> {
        let values = model.ask().problem()?.set().to_vec();
        let asked = Requirements::of(model, &[], &values, budget)?;
        let problem = question(model, &asked).problem()?;
        let in_region = problem.verdict(budget)?.value().verdict == Verdict::Stable;
        let met = problem.requirements_met(&asked.list, asked.at.as_deref(), budget)?;
        let listed = met.iter().filter(|r| !r.met).map(|r| remark(r.requirement.name(), r.text(DIGITS)));
        let regional = asked.regional.iter().filter(|_| !in_region);
        Ok(listed.chain(regional.map(|(name, text)| remark(name, format!("{name} {text}: not met")))).collect())
    };
    found().unwrap_or_else(|error| vec![remark("", format!("what is required was not decided: {error}"))])
}
