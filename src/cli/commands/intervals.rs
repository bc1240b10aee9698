//! `jurist intervals`: the exact stable set of one parameter.

use super::{Context, Runs, decided};
use crate::certified::{CertifiedIntervals, certify_intervals, certify_required_intervals};
use crate::cli::arguments::DecisionOptions;
use crate::cli::commands::map::{freed, ranges};
use crate::cli::destinations::Files;
use crate::cli::input::{decision, known_names, only_parameter};
use crate::cli::output::{note, write_answer};
use crate::cli::picture::WRITES;
use crate::cli::requirements::{RequirementOptions, refuse_theorems};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::{certified, check_certificate, share};
use clap::Args;
use jurist_engine::answer::Answer;
use jurist_engine::coverage::Asked;
use jurist_engine::model::Model;
use jurist_engine::problem::{DECAY, Problem, Question, RADIUS};
use jurist_engine::response::{MapForAll, RequiredSet, Requirement};
use jurist_prove::Theorem;
use jurist_show::documents::Intervals;
use jurist_show::{Document, Text};
use jurist_show::{intervals_text, required_text};
use std::ffi::OsString;
use std::slice::from_ref;
use std::sync::Arc;

/// Options of `jurist intervals`.
#[derive(Args, Debug, Default)]
pub(in crate::cli) struct Options {
    /// The parameter in question: a parameter, a constant given as a number, 'radius' or 'decay'; left out: the model's only one
    #[arg(long, value_name = "NAME")]
    pub param: Option<String>,
    #[command(flatten)]
    pub decision: DecisionOptions,
    #[command(flatten)]
    pub require: RequirementOptions,
    /// Adds how each limit moves with each other parameter and constant: exact derivatives
    #[arg(long)]
    pub sensitivity: bool,
    /// The values that are good for all values of another name in a range, both ends included (can be given again)
    #[arg(long = "for-all", value_name = "NAME=LO..HI", conflicts_with_all = ["smt2", "coq", "sensitivity"])]
    pub for_all: Vec<String>,
    /// Writes a certificate that 'jurist verify' re-checks
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
    /// Writes the statement as SMT-LIB 2; a solver answers 'unsat' if it is true
    #[arg(long, value_name = "FILE")]
    pub smt2: Option<OsString>,
    /// Writes the answer as a theorem for Coq, proved with the library in proofs/
    #[arg(long, value_name = "FILE")]
    pub coq: Option<OsString>,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.decision.output;
        let (model, question) = decision(&self.decision, context)?;
        let name = self.param.clone().map_or_else(|| only_parameter(&model, &self.decision.model), Ok)?;
        if name != RADIUS && name != DECAY {
            known_names(context, &model, "--param", from_ref(&name))?;
        }
        let digits = output.digits() as usize;
        let (all, question) = (ranges(&self.for_all, &[&name], &model, context)?, question.free(&name));
        let free = freed(&question, all.iter().map(|all| &all.name));
        let asked = self.require.asked(&model, free, &self.decision.region, context)?.0;
        let question = asked.region.clone().into_iter().fold(question, Question::within);
        refuse_theorems(&asked, self.smt2.is_some() || self.coq.is_some())?;
        if !all.is_empty() {
            let for_all = MapForAll::new(all).with_requirements(asked.list.clone(), asked.at.clone());
            return match decided(for_all.intervals(question, &context.budget))? {
                Ok(answer) => required(&answer, (&asked.list, asked.at.as_deref()), self, &model, context),
                Err(stopped) => Ok(context.say_undecided(&stopped)),
            };
        }
        let problem = question.problem()?;
        let requirements = asked.list;
        let question = requirements.iter().fold(Asked::Intervals, |asked, r| asked.with_requirement(r, problem.time()));
        context.explain(&self.decision.explain, output, &problem, question)?;
        if !requirements.is_empty() {
            let at = asked.at.as_deref();
            return match decided(problem.required_set(&requirements, at, &context.budget))? {
                Ok(answer) => required(&answer, (&requirements, at), self, &model, context),
                Err(stopped) => {
                    context.undecided(output, &stopped, || None, || Intervals::new(&problem, Err(&stopped), digits))
                }
            };
        }
        stable_set(&problem, (&model, &name), self, context)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.decision.model.model, &self.decision.output.output);
        files.outputs.extend(self.certificate.iter().map(|file| ("the certificate", file.clone())));
        files.outputs.extend(self.smt2.iter().map(|file| ("the SMT-LIB script", file.clone())));
        files.outputs.extend(self.coq.iter().map(|file| ("the file for Coq", file.clone())));
        Ok(())
    }
}

/// The answer without requirements.
fn stable_set(problem: &Arc<Problem>, (model, name): (&Model, &str), options: &Options, context: &Context) -> Outcome {
    let output = &options.decision.output;
    let digits = output.digits() as usize;
    let answer = match decided(problem.stable_set(&context.budget))? {
        Ok(answer) => answer,
        Err(stopped) => {
            let known = Err(&stopped);
            let text = || Some(intervals_text(problem, known, digits));
            return context.undecided(output, &stopped, text, || Intervals::new(problem, known, digits));
        }
    };
    context.warn(None, problem.warnings());
    if let Some(file) = options.smt2.as_ref().filter(|_| WRITES) {
        write_answer(&jurist_prove::smt2(&answer, &context.budget)?, Some(file))?;
    }
    if let Some(file) = options.coq.as_ref().filter(|_| WRITES) {
        write_answer(&answer.coq(&context.budget)?, Some(file))?;
    }
    let table = if options.sensitivity { Some(answer.sensitivities(&context.budget)?) } else { None };
    let text = || table.iter().fold(answer.text(digits), |text, table| text + &table.text(digits));
    let document = || table.iter().fold(answer.json(digits), |document, t| document.with_sensitivities(t, digits));
    context.answer(output, text, document)?;
    // The answer is out, however long the certificate takes.
    let certified = certified(context, &options.certificate, || certify_intervals(&answer, &context.budget))?;
    if certified.is_some() {
        let mut ends = answer.problem().parameter().closed_ends();
        if let Some(end) = ends.next().filter(|_| !context.quiet) {
            note(&format!(
                "note: the certificate is about the inside of the domain; an end has one of its own: \
                 jurist verdict --set {name}={end} --certificate FILE"
            ));
        }
    }
    written(options, model, (name, &certified), context)?;
    Ok(Status::Holds)
}

/// The answer with requirements, or for all values of other names.
fn required(
    answer: &Answer<RequiredSet>,
    (requirements, at): (&[Requirement], Option<&str>),
    options: &Options,
    model: &Model,
    context: &Context,
) -> Outcome {
    let output = &options.decision.output;
    let digits = output.digits() as usize;
    context.warn(None, answer.problem().warnings());
    if let Some(stopped) = &answer.value().stopped {
        let text = || Some(required_text(answer, requirements, digits));
        return context.undecided(output, stopped, text, || Intervals::of_required(answer, requirements, digits));
    }
    context.answer(
        output,
        || required_text(answer, requirements, digits),
        || Intervals::of_required(answer, requirements, digits),
    )?;
    let make = || certify_required_intervals(answer, requirements, at, &context.budget);
    let certified = certified(context, &options.certificate, make)?;
    written(options, model, (&answer.problem().parameter().name, &certified), context)?;
    Ok(Status::Holds)
}

/// Writes a certificate, says how much it speaks of, and checks it.
fn written(
    options: &Options,
    model: &Model,
    (name, certified): (&str, &Option<(CertifiedIntervals, &OsString)>),
    context: &Context,
) -> Result<(), Error> {
    let Some((certified, file)) = certified else { return Ok(()) };
    write_answer(&certified.text, Some(file))?;
    if let Some(window) = certified.window.as_ref().filter(|_| !context.quiet) {
        note(&format!("note: the certificate {}", share(name, window, &certified.proved)));
    }
    check_certificate(context, &options.decision.output.run, &model.source().text, &certified.text, file);
    Ok(())
}
