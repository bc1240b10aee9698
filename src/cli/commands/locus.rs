//! `jurist locus`: root locus with the exact crossings on it.

use super::{Context, Runs};
use crate::cli::arguments::{ModelOptions, PictureOptions, RunOptions};
use crate::cli::assignments::in_line;
use crate::cli::destinations::Files;
use crate::cli::input::{known_names, load, only_parameter, question};
use crate::cli::picture::{Picture, deliver, wanted};
use crate::cli::requirements::warn_of_ignored;
use crate::cli::status::{Error, Outcome, Status};
use clap::Args;
use jurist_algebra::number::{Rational, parse_number};
use jurist_draw::document::locus_json;
use jurist_draw::figures::{locus_of, locus_range};
use jurist_draw::simulate::ParameterScale;
use jurist_engine::error::{Code, Diagnostic};
use jurist_show::documents::to_text;
use std::slice::from_ref;

/// Options of `jurist locus`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    #[command(flatten)]
    pub model: ModelOptions,
    /// The parameter that moves; left out: the model's only one
    #[arg(long, value_name = "NAME")]
    pub param: Option<String>,
    /// From where to where [default: around the stable set and nominal]
    #[arg(long, value_name = "LO..HI", allow_hyphen_values = true)]
    pub range: Option<String>,
    /// Lets the parameter run evenly in its logarithm [default: over ranges of more than two decades]
    #[arg(long)]
    pub log: bool,
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let kind = wanted(&self.picture)?;
        let model = load(self.model.model.as_ref(), &self.model.line, context)?;
        warn_of_ignored(&model, context);
        let question = question(context, &model, &self.model, &Default::default())?;
        let name = self.param.clone().map_or_else(|| only_parameter(&model, &self.model), Ok)?;
        known_names(context, &model, "--param", from_ref(&name))?;
        let answer = question.free(&name).stable_set(&context.budget)?;
        context.warn(None, answer.problem().warnings());
        let range = match &self.range {
            Some(text) => range_of(text, context)?,
            None => locus_range(&answer).ok_or_else(|| {
                Diagnostic::error(Code::Usage, "the parameter's range is unknown").help("give it with --range LO..HI")
            })?,
        };
        let scale = if self.log { Some(ParameterScale::Logarithmic) } else { None };
        let budget = &context.budget;
        let picture = budget.enter(|| locus_of(&answer, &range, scale, budget))??;
        context.reporter.finish();
        for crossing in &picture.crossings {
            crate::cli::output::note(&format!("crossing: {}", crossing.label));
        }
        let table = || picture.locus.to_csv(&name);
        let document = || to_text(&locus_json(&answer, &picture));
        let out = Picture { figure: &picture.figure, csv: &table, json: &document, csv_beside: self.picture.csv };
        deliver(&out, kind, self.picture.output.as_ref())?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.picture(&self.model.model, &self.picture)
    }
}

fn range_of(text: &str, context: &Context) -> Result<(Rational, Rational), Error> {
    let wrong = |what: &str| {
        let place = context.line.option_value("--range", text).span;
        let error = Diagnostic::error(Code::OptionValue, "--range expects LO..HI with LO below HI");
        Error::from(in_line(context.line, vec![error.at(place, what).help("for example --range 0.001..1000")]))
    };
    let Some((lo, hi)) = text.split_once("..") else { return Err(wrong("there is no '..'")) };
    let number = |part: &str| parse_number(part.trim()).map_err(|_| wrong("not two numbers"));
    let (lo, hi) = (number(lo)?, number(hi)?);
    if lo < hi { Ok((lo, hi)) } else { Err(wrong("nothing lies between")) }
}
