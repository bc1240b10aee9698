//! `jurist margins`: how far the loop is from instability.

use super::map::ranges;
use super::{Context, Runs, decided};
use crate::cli::arguments::{ExplainOptions, ModelOptions, OutputOptions, RegionOptions};
use crate::cli::assignments::plain_number;
use crate::cli::destinations::Files;
use crate::cli::input::{known_names, load, question};
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_algebra::number::Rational;
use jurist_engine::coverage::Asked;
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use jurist_engine::response::{AllOf, Everywhere, LeastMargin, MapForAll, Requirement};
use jurist_show::documents::{MarginRanges, Margins};
use jurist_show::{Document, Text};

/// Options of `jurist margins`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// Where the loop is cut: a signal, a block (at its input), or a parameter (the loop's gain) [default: what
    /// [require] says, else the error of a single loop]
    #[arg(long, value_name = "SIGNAL")]
    pub at: Option<String>,
    /// The skew of the disk margin; 0 is the balanced disk
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true, default_value = "0")]
    pub skew: String,
    /// For which values of this parameter, or constant given as a number, the loop has so much of each margin
    #[arg(long, value_name = "NAME", conflicts_with = "skew")]
    pub param: Option<String>,
    /// How much of each margin the loop has for all of these values, both ends included; a name of the model
    /// without units, up to four [repeatable]
    #[arg(long, value_name = "NAME=LO..HI", allow_hyphen_values = true, conflicts_with_all = ["skew", "param", "explain"])]
    pub for_all: Vec<String>,
    #[command(flatten)]
    pub explain: ExplainOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let output = &self.output;
        context.check_output(output)?;
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        let question = question(context, &model, &self.model, &RegionOptions::default())?;
        if let Some(name) = &self.param {
            return by_parameter(name, (&model, question), self, context);
        }
        let all = ranges(&self.for_all, &[], &model, context)?;
        if !all.is_empty() {
            return least(all, question, self, context);
        }
        let skew: Rational = plain_number(context.line, "--skew", &self.skew)?;
        let digits = output.digits() as usize;
        let problem = question.problem()?;
        context.explain(&self.explain, output, &problem, Asked::Margins)?;
        let answer = match decided(problem.margins(self.at.as_deref(), &skew, &context.budget))? {
            Ok(answer) => answer,
            Err(stopped) => {
                let document = || Margins::new(&problem, Err(&stopped), digits);
                return context.undecided(output, &stopped, || None, document);
            }
        };
        context.warn(None, problem.warnings());
        context.answer(output, || answer.text(digits), || answer.json(digits))?;
        Ok(if answer.value().stable.is_some() { Status::Holds } else { Status::DoesNotHold })
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model.model, &self.output.output);
        Ok(())
    }
}

/// The values of a parameter for which the loop has each margin.
fn by_parameter(name: &str, (model, question): (&Model, Question), options: &Options, context: &Context) -> Outcome {
    let output = &options.output;
    known_names(context, model, "--param", std::slice::from_ref(&name.to_owned()))?;
    let digits = output.digits() as usize;
    let problem = question.free(name).problem()?;
    context.explain(&options.explain, output, &problem, Asked::Intervals)?;
    let margins = Requirement::usual_margins(model, &context.budget);
    let found = margins.and_then(|list| problem.margin_ranges(&list, options.at.as_deref(), &context.budget));
    match decided(found)? {
        Ok(answer) => {
            context.warn(None, problem.warnings());
            context.answer(output, || answer.text(digits), || answer.json(digits))?;
            Ok(Status::Holds)
        }
        Err(stopped) => {
            context.undecided(output, &stopped, || None, || MarginRanges::new(&problem, Err(&stopped), digits))
        }
    }
}

/// The least margins for all values of names; the status is 1 where the loop is not stable for some.
fn least(all: Vec<AllOf>, question: Question, options: &Options, context: &Context) -> Outcome {
    let output = &options.output;
    let digits = output.digits() as usize;
    let names = MapForAll::new(all).with_requirements(Vec::new(), options.at.clone());
    match decided(names.least_margins(question, &context.budget))? {
        Ok(answer) => {
            context.warn(None, answer.problem().warnings());
            context.answer(output, || answer.text(digits), || answer.json(digits))?;
            let found = answer.value();
            if let Some(stopped) = &found.stopped {
                return Ok(context.say_undecided(stopped));
            }
            // A margin that nothing limits needs no number.
            let is_limited = |margin: &LeastMargin| margin.proved.is_none() && margin.found.is_some();
            let is_open = found.stable == Everywhere::Open || found.margins.iter().any(is_limited);
            Ok(match found.stable {
                Everywhere::NotAt(_) => Status::DoesNotHold,
                _ if is_open => Status::Undecided,
                _ => Status::Holds,
            })
        }
        Err(stopped) => Ok(context.say_undecided(&stopped)),
    }
}
