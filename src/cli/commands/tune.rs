//! `jurist tune`: the best gains within what is required.

use super::map::{freed, ranges};
use super::{Context, Runs, decided};
use crate::certified::certify_tune;
use crate::cli::arguments::{ModelOptions, OutputOptions, RegionOptions};
use crate::cli::assignments::{bound, in_line, plain_number};
use crate::cli::command_line::Place;
use crate::cli::destinations::Files;
use crate::cli::input::{known_names, load, question};
use crate::cli::requirements::RequirementOptions;
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::written::certify;
use clap::Args;
use jurist_algebra::limits::apart;
use jurist_algebra::number::Rational;
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Span};
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use jurist_engine::response::{AllOf, Requirements};
use jurist_show::documents;
use jurist_tune::answer::TuneAnswer;
use jurist_tune::asked::{Asked, Gain, check_gains, is_share};
use jurist_tune::objective::SOURCE as OBJECTIVE;
use jurist_tune::plants::{plants, plants_of_model};
use std::ffi::OsString;
use std::sync::Arc;

/// Options of `jurist tune`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    #[command(flatten)]
    pub region: RegionOptions,
    #[command(flatten)]
    pub require: RequirementOptions,
    /// A gain whose best value is asked for, up to five; three and more need bounds [default: those of [tune]] [repeatable]
    #[arg(long, value_name = "NAME")]
    pub free: Vec<String>,
    /// What is to be best: 'max' or 'min' with a free gain or an expression of free gains; 'max decay', 'min radius',
    /// 'min settling_time', 'max damping', 'max gain_margin', 'max phase_margin', 'max modulus_margin',
    /// 'min complementary_peak', 'max disk_margin', 'max delay_margin', 'min norm INPUT OUTPUT'; 'max tolerance', 'max tolerance absolute'
    /// or 'max tolerance ratio': the middle of the good gains; 'none': are there any gains?
    /// [default: that of [tune], else none]
    #[arg(long, value_name = "TEXT")]
    pub objective: Option<String>,
    /// The least and the greatest value of a free gain, both included [repeatable]
    #[arg(long, value_name = "NAME=LO..HI")]
    pub bound: Vec<String>,
    /// A bracket is narrow enough where it is less than this share [default: 1e-3]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub gap: Option<String>,
    /// What may be given up for gains of few digits: a share, or per cent such as 2% [default: 1%]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub loss: Option<String>,
    /// Writes a certificate that 'jurist verify' re-checks: that no gains within the bounds meet what is required, or none that are better than a value
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<OsString>,
    /// Gains that are good for all values of another name in a range, both ends included, within bounds [repeatable]
    #[arg(long = "for-all", value_name = "NAME=LO..HI")]
    pub for_all: Vec<String>,
    /// Gains that are good for all values within the tolerances of the model
    #[arg(long)]
    pub robust: bool,
    #[command(flatten)]
    pub output: OutputOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.output;
        context.check_output(output)?;
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        known_names(context, &model, "--free", &self.free)?;
        let gains = gains(self, &model, context)?;
        check_gains(&model, &gains)?;
        let question = question(context, &model, &self.model, &self.region)?;
        if let Some(gain) = gains.iter().find(|gain| question.values_set().contains_key(&gain.name)) {
            let error = Diagnostic::error(Code::KeptAndSet, format!("'{}' is free and has a value", gain.name));
            return Err(error.help("leave out --set, or free another gain").into());
        }
        let for_all = all_plants(self, (&model, &question), &gains, context)?;
        let question = for_all
            .iter()
            .fold(question, |question, all| question.set(&all.name, all.range[0].midpoint(&all.range[1])));
        // What is required may not depend on what is free, nor on a name whose values are all of a range.
        let names = gains.iter().map(|gain| &gain.name).chain(for_all.iter().map(|all| &all.name));
        let free = freed(&question, names);
        let (required, _) = self.require.asked(&model, free.clone(), &self.region, context)?;
        let question = required.region.clone().into_iter().fold(question, Question::within);
        let mut asked = asked(self, (&model, gains), required, context)?;
        asked.for_all = for_all;
        let digits = output.digits() as usize;
        let answer = TuneAnswer::of(&question, asked, &context.budget);
        let answer = match decided(answer.map_err(|error| about(self, &model, context, error)))? {
            Ok(answer) => answer,
            Err(stopped) => {
                let problem = free.problem()?;
                let nothing =
                    || documents::Verdict::new(&problem, Err::<&jurist_engine::answer::PointVerdict, _>(&stopped));
                return context.undecided(output, &stopped, || None, nothing);
            }
        };
        context.warn(None, answer.problem.warnings());
        if let Some(stopped) = answer.stopped() {
            return context.undecided(output, stopped, || Some(answer.text(digits)), || answer.json(digits));
        }
        if answer.is_feasible() == Some(false) {
            // The search for what excludes each other may have taken all of the budget.
            context.answer(output, || apart(|| answer.text(digits)), || apart(|| answer.json(digits)))?;
        } else {
            context.answer(output, || answer.text(digits), || answer.json(digits))?;
        }
        let text = &answer.problem.model().source().text;
        certify(context, &output.run, text, &self.certificate, || certify_tune(&answer, &context.budget))?;
        Ok(if answer.is_feasible() == Some(false) { Status::DoesNotHold } else { Status::Holds })
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model.model, &self.output.output);
        files.outputs.extend(self.certificate.iter().map(|file| ("the certificate", file.clone())));
        Ok(())
    }
}

/// What is to be best, how narrow a bracket is to be and what may be given up: as the command line says, else as the model does.
fn asked(
    options: &Options,
    (model, gains): (&Model, Vec<Gain>),
    required: Requirements,
    context: &Context,
) -> Result<Asked, Error> {
    let written = model.tuning();
    let placed = |place: Option<Span>, error: Error| in_model(model, place, error);
    let objective =
        options.objective.as_deref().or(written.and_then(|tuning| Some(tuning.objective.as_ref()?.name.as_str())));
    let mut asked = Asked::of(model, gains, objective.unwrap_or("none"), required)
        .map_err(|error| about(options, model, context, error))?;
    if let Some(text) = &options.gap {
        asked.gap = share(context, "--gap", text)?;
    } else if let Some(gap) = written.and_then(|tuning| tuning.gap.clone()) {
        asked.gap = gap;
    }
    if let Some(text) = &options.loss {
        asked.loss = Some(share(context, "--loss", text)?);
    } else if let Some(loss) = written.and_then(|tuning| tuning.loss.as_ref()) {
        let Some(value) = jurist_tune::asked::share(&loss.name) else {
            let error = Diagnostic::error(Code::TuneObjective, "'loss' is a share above 0 and below 1, or per cent");
            return Err(placed(Some(loss.span), Error::from(error.help("for example loss = \"1%\""))));
        };
        asked.loss = Some(value);
    }
    if !is_share(&asked.gap) {
        let error = Diagnostic::error(Code::TuneObjective, "'gap' is a share above 0 and below 1");
        return Err(placed(written.map(|tuning| tuning.span), Error::from(error.help("for example gap = 1e-3"))));
    }
    Ok(asked)
}

/// An error about the text of the objective, with its places in the command line or in the model.
fn about(options: &Options, model: &Model, context: &Context, error: Error) -> Error {
    let Error::Refused(found) = error else { return error };
    let Some(text) = found.source_text().filter(|source| source.name == OBJECTIVE).map(|source| source.text.clone())
    else {
        return Error::Refused(found);
    };
    let written = model.tuning().and_then(|tuning| tuning.objective.as_ref());
    let (source, place) = match (&options.objective, written) {
        (Some(given), _) if *given == text => (context.line.source(), context.line.option_value("--objective", given)),
        (None, Some(name)) if name.name == text => {
            let source = model.source();
            // A string with escapes has no places in it.
            let start = source.text.get(name.span.start..name.span.end).and_then(|whole| whole.find(&text));
            let span = |start| Span::new(name.span.start + start, name.span.start + start + text.len());
            (source, Place { span: start.map_or(name.span, span), verbatim: start.is_some() })
        }
        _ => return Error::Refused(found),
    };
    let moved = |one: &Diagnostic| {
        let mut one = one.clone();
        for label in one.primary.iter_mut().chain(&mut one.secondary) {
            label.span = place.part(label.span.start, label.span.end);
        }
        one
    };
    Diagnostics::new(Some(Arc::clone(source)), found.diagnostics().iter().map(moved).collect()).into()
}

/// The names of the plant with their ranges: as the command line says, else as the model does.
fn all_plants(
    options: &Options,
    (model, question): (&Model, &Question),
    gains: &[Gain],
    context: &Context,
) -> Result<Vec<AllOf>, Error> {
    let free: Vec<&str> = gains.iter().map(|gain| gain.name.as_str()).collect();
    let given = ranges(&options.for_all, &free, model, context)?;
    if options.for_all.is_empty() && !options.robust {
        let place = model.tuning().map(|tuning| tuning.span);
        return plants_of_model(question, gains).map_err(|error| in_model(model, place, error));
    }
    plants(question, gains, given, options.robust)
}

/// The error with its place in the model, where it has one.
fn in_model(model: &Model, place: Option<Span>, error: Error) -> Error {
    match (place, error) {
        (Some(span), Error::Refused(found)) => {
            let placed = found.diagnostics().iter().cloned().map(|diagnostic| diagnostic.at(span, ""));
            Diagnostics::new(Some(Arc::clone(model.source())), placed.collect()).into()
        }
        (_, error) => error,
    }
}

/// The free gains with their bounds: those of the command line, else those of the model.
fn gains(options: &Options, model: &Model, context: &Context) -> Result<Vec<Gain>, Error> {
    let written = model.tuning().filter(|_| options.free.is_empty());
    let named = written.into_iter().flat_map(|tuning| tuning.free.iter().map(|name| &name.name));
    let mut gains: Vec<Gain> = options.free.iter().chain(named).map(Gain::new).collect();
    for (name, [low, high]) in model.tuning().into_iter().flat_map(|tuning| &tuning.bounds) {
        if let Some(gain) = gains.iter_mut().find(|gain| gain.name == name.name) {
            *gain = gain.clone().within([Some(low.clone()), Some(high.clone())]);
        }
    }
    for text in &options.bound {
        let (name, low, high) = bound(context.line, "--bound", text)?;
        let Some(gain) = gains.iter_mut().find(|gain| gain.name == name) else {
            let place = context.line.option_value("--bound", text);
            let error = Diagnostic::error(Code::TuneBounds, format!("'{name}' is no free gain")).at(place.span, "");
            return Err(in_line(context.line, vec![error.help(format!("add --free {name}"))]).into());
        };
        *gain = gain.clone().within([low, high]);
    }
    Ok(gains)
}

/// The number of a share, and whether it is one per cent.
fn percent(text: &str) -> (&str, bool) {
    match text.trim().strip_suffix('%') {
        Some(number) => (number.trim(), true),
        None => (text.trim(), false),
    }
}

/// A share above 0 and below 1: a number, or per cent.
fn share(context: &Context, option: &str, text: &str) -> Result<Rational, Error> {
    let (number, is_percent) = percent(text);
    let value = plain_number(context.line, option, number)?;
    let value = if is_percent { value * Rational::new(1.into(), 100.into()) } else { value };
    if is_share(&value) {
        return Ok(value);
    }
    let place = context.line.option_value(option, text);
    let error =
        Diagnostic::error(Code::OptionValue, format!("{option} is a share above 0 and below 1")).at(place.span, "");
    Err(in_line(context.line, vec![error.help(format!("for example {option} 1%"))]).into())
}
