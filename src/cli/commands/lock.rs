//! `jurist lock`: holds the limits of a model fast.

use super::{Context, Runs};
use crate::cli::arguments::{ReadingOptions, RunOptions};
use crate::cli::assignments::in_line;
use crate::cli::destinations::{Files, check_read};
use crate::cli::input::{known_names, read_model, tell_numbers};
use crate::cli::output::{ending, finish_answer, note, unknown_ending};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::suite::lock::{file_of, limits, make};
use clap::Args;
use jurist_algebra::number::Rational;
use jurist_engine::error::{Code, Diagnostic};
use jurist_engine::model::{Model, Tolerance};
use jurist_show::documents::to_text;
use std::ffi::OsString;
use std::path::Path;

/// Options of `jurist lock`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// A model file
    #[arg(value_name = "MODEL")]
    pub model: OsString,
    #[command(flatten)]
    pub line: ReadingOptions,
    /// Locks the limits of this parameter; left out: of every parameter of the model whose limits are known [repeatable]
    #[arg(long, value_name = "NAME")]
    pub param: Vec<String>,
    /// By how much a limit may move until 'jurist test' fails
    #[arg(long, value_name = "SHARE", default_value = "0.1%")]
    pub within: String,
    /// The file; left out it stands beside the model, as NAME.lock.json of NAME.toml, where 'jurist test' looks for it
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let within = match self.within.parse::<Tolerance>() {
            Ok(Tolerance::Share { above, .. }) if above.sign().is_gt() => above,
            _ => {
                let place = context.line.option_value("--within", &self.within).span;
                let error = Diagnostic::error(Code::OptionValue, "--within expects a share above 0");
                return Err(in_line(
                    context.line,
                    vec![error.at(place, "not accepted").help("for example --within 0.5%")],
                )
                .into());
            }
        };
        let named = read_model(Some(&self.model), &self.line, context)?;
        let model = named.read?.0;
        tell_numbers(&named.name, &named.numbers, &self.line, context)?;
        if let Some(file) = &self.output {
            if file != "-" && ending(file).as_deref() != Some("json") {
                return Err(unknown_ending(file, &["json"]).into());
            }
            check_read(context, [("the lock", file)], &named.numbers.files)?;
        }
        if self.output.is_none() && !Path::new(&self.model).is_file() {
            let error = Diagnostic::error(Code::Usage, "a lock stands beside a model file, and this model is not one");
            let place = context.line.argument(&self.model.to_string_lossy()).unwrap_or_default();
            return Err(
                in_line(context.line, vec![error.at(place, "no file").help("say where it goes: -o FILE")]).into()
            );
        }
        known_names(context, &model, "--param", &self.param)?;
        let path = Path::new(&self.model);
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let lock = match self.param.as_slice() {
            [] => of_all(&model, &name, &within, context)?,
            named => make(&model, &name, named, &within, &context.budget)?,
        };
        context.reporter.finish();
        if lock.limits.is_empty() {
            return Err(Diagnostic::error(Code::Missing, "no limit of this model is known that could be locked").into());
        }
        let file = self.output.clone().unwrap_or_else(|| file_of(path).into_os_string());
        finish_answer(&to_text(&lock), Some(&file))?;
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.inputs.push(("the model", self.model.as_os_str()));
        files.answer(self.output.as_ref());
        Ok(())
    }
}

/// Work for the limits of one parameter that nobody named.
const WORK_OF_ONE: u64 = 2_000_000_000;

fn of_all(
    model: &Model,
    name: &str,
    within: &Rational,
    context: &Context,
) -> Result<jurist_show::documents::Lock, Error> {
    let mut lock = make(model, name, &[], within, &context.budget)?;
    for parameter in model.parameters() {
        let budget = context.budget.clone().within_work(WORK_OF_ONE);
        match limits(model, &parameter.name, &budget) {
            Ok(found) => lock.limits.push(found),
            Err(_) if context.budget.check().is_err() => context.budget.check()?,
            Err(error) => note(&format!("note: the limits of {} are not locked: {error}", parameter.name)),
        }
    }
    Ok(lock)
}
