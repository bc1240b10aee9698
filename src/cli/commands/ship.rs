//! `jurist ship`: the controller as it is stored and run.

use super::{Context, Runs, decided};
use crate::cli::arguments::{DecisionOptions, RunOptions};
use crate::cli::assignments::{assignments, in_line};
use crate::cli::destinations::Files;
use crate::cli::import::{DsOptions, Words, read_c};
use crate::cli::input::{Wanted, decision, question, read_bytes};
use crate::cli::output::{note, write_answer};
use crate::cli::requirements::RequirementOptions;
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::certify;
use clap::Args;
use jurist_algebra::limits::Exhausted;
use jurist_engine::answer::PointVerdict;
use jurist_engine::error::{Code, Diagnostic, Source};
use jurist_engine::model::Model;
use jurist_engine::problem::{Problem, Question};
use jurist_engine::show::documents;
use jurist_ship::answer::{Holds, ShipAnswer};
use jurist_ship::asked::{Asked, Overrides};
use std::ffi::OsString;

/// Options of `jurist ship`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub decision: DecisionOptions,
    #[command(flatten)]
    pub require: RequirementOptions,
    /// Ships the controller of a C file of DSVerifier in its loop, in the place of MODEL
    #[arg(long, value_name = "FILE", conflicts_with_all = ["model", "hold", "delay"])]
    pub from: Option<OsString>,
    #[command(flatten)]
    pub of_c: DsOptions,
    /// The block that is the controller [default: that of [ship]]
    #[arg(long, value_name = "NAME")]
    pub block: Option<String>,
    /// The order of operations: df1, df2, df2t, sos, delta or state
    #[arg(long, value_name = "NAME")]
    pub realisation: Option<String>,
    /// How coefficients are stored: Q2.13 (sign, 2 bits before and 13 behind the point), float32 or float64
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<String>,
    /// How signals are stored: Q5.10
    #[arg(long, value_name = "FORMAT")]
    pub signal: Option<String>,
    /// How coefficients are rounded: nearest, even, half-up, floor, ceil or zero
    #[arg(long, value_name = "MODE")]
    pub round: Option<String>,
    /// The greatest magnitude of an input, for ranges of signals [repeatable]
    #[arg(long, value_name = "NAME=BOUND")]
    pub input: Vec<String>,
    /// Also says how many bits behind the point are enough
    #[arg(long)]
    pub fewest: bool,
    /// Writes the model with the stored coefficients: a model for every other command
    #[arg(long, value_name = "FILE")]
    pub rounded: Option<OsString>,
    /// Writes the model in which each coefficient has the tolerance of its rounding, for 'jurist tolerance'
    #[arg(long, value_name = "FILE")]
    pub every: Option<OsString>,
    /// Writes a certificate that 'jurist verify' re-checks: the verdict on the model of --rounded
    #[arg(long, value_name = "FILE", requires = "rounded")]
    pub certificate: Option<OsString>,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        run(self, context)
    }

    fn run_options(&self) -> &RunOptions {
        &self.decision.output.run
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.decision.model.model, &self.decision.output.output);
        files.inputs.extend(self.from.iter().map(|file| ("the file of DSVerifier", file.as_os_str())));
        files.outputs.extend(self.rounded.iter().map(|file| ("the rounded model", file.clone())));
        files.outputs.extend(self.every.iter().map(|file| ("the model of every rounding", file.clone())));
        files.outputs.extend(self.certificate.iter().map(|file| ("the certificate", file.clone())));
        Ok(())
    }
}

/// Answers on standard output or in a file: 0 stable, requirements and ranges hold, 1 not, 3 open.
fn run(options: &Options, context: &Context) -> Outcome {
    let output = &options.decision.output;
    let (model, question) = match &options.from {
        Some(file) => from_dsverifier(file, options, context)?,
        None => decision(&options.decision, context)?,
    };
    let (asked, question) = options.require.asked(&model, question, &options.decision.region, context)?;
    let shipping = Asked::of(&model, &overrides(options, context, model.inputs())?)?;
    let problem = question.problem()?;
    let answer = match decided(ShipAnswer::of(&problem, shipping, &asked, options.fewest, &context.budget))? {
        Ok(answer) => answer,
        Err(stopped) => return context.undecided(output, &stopped, || None, || no_answer(&problem, &stopped)),
    };
    context.warn(None, problem.warnings());
    let rounded = answer.shipped.rounded_text();
    for (text, file) in [(rounded, &options.rounded), (&answer.shipped.every_text().0, &options.every)] {
        if let Some(file) = file {
            write_answer(text, Some(file))?;
        }
    }
    let digits = output.digits() as usize;
    if let Some(stopped) = answer.stopped() {
        return context.undecided(output, stopped, || Some(answer.text(digits)), || answer.json(digits));
    }
    context.answer(output, || answer.text(digits), || answer.json(digits))?;
    certify(context, &output.run, rounded, &options.certificate, || {
        answer.rounded.verdict.certificate(&context.budget)
    })?;
    Ok(match answer.holds() {
        Holds::Yes => Status::Holds,
        Holds::No => Status::DoesNotHold,
        Holds::Open => Status::Undecided,
    })
}

/// The model of a file of DSVerifier, and the question about it. What its own storing makes of it is said.
fn from_dsverifier(file: &OsString, options: &Options, context: &Context) -> Result<(Model, Question), Error> {
    const FILE: Wanted = Wanted { noun: "file of DSVerifier", help: "FILE is a .c file of DSVerifier" };
    context.check_output(&options.decision.output)?;
    let (name, bytes) = read_bytes(file, &FILE, context)?;
    context.budget.step("reading the file");
    let words = Words { round: options.round.as_deref(), realisation: options.realisation.as_deref() };
    let (read, writing) = read_c((&name, &bytes), &options.of_c, words, context)?;
    let (model, warnings) =
        Model::from_toml(&Source::new(format!("the model of {name}"), read.model(&name, &writing)?))?;
    context.warn(Some(model.source()), &warnings);
    if !context.quiet
        && let Some(text) = read.storing_note(&writing, &context.budget)?
    {
        note(&format!("note: {text}"));
    }
    let question = question(context, &model, &options.decision.model, &options.decision.region)?;
    Ok((model, question))
}

/// The document where even the verdicts are not decided.
fn no_answer(problem: &Problem, stopped: &Exhausted) -> documents::Verdict {
    documents::Verdict::new(problem, Err::<&PointVerdict, _>(stopped))
}

/// What options say in the place of `[ship]`.
fn overrides(options: &Options, context: &Context, inputs: &[jurist_engine::model::Name]) -> Result<Overrides, Error> {
    let mut bounds = Vec::new();
    for (given, text) in assignments(context.line, "--input", &options.input)?.into_iter().zip(&options.input) {
        let place = || context.line.option_value("--input", text).span;
        if inputs.iter().all(|name| name.name != given.name) {
            let error = Diagnostic::error(Code::UnknownName, format!("the loop has no input '{}'", given.name));
            return Err(in_line(context.line, vec![error.at(place(), "not known")]).into());
        }
        if given.value.is_negative() {
            let error = Diagnostic::error(Code::Value, "the bound of an input is not negative");
            return Err(in_line(context.line, vec![error.at(place(), "negative")]).into());
        }
        bounds.push((given.name, given.value));
    }
    Ok(Overrides {
        block: options.block.clone(),
        realisation: options.realisation.clone(),
        format: options.format.clone(),
        signal: options.signal.clone(),
        round: options.round.clone(),
        inputs: bounds,
    })
}
