//! Requirements on the command line.

use super::arguments::RegionOptions;
use super::commands::Context;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use jurist_engine::response::{RequirementKind, Requirements};
use std::sync::LazyLock;

/// What is required beyond stability, with an option for each requirement of the engine's list.
#[derive(Clone, Debug, Default)]
pub(super) struct RequirementOptions {
    /// Keys of `[require]` with what is given for them.
    given: Vec<(&'static str, String)>,
    /// Whether the model's `[require]` is left out.
    alone: bool,
}

/// The option that leaves out what the model requires.
const ALONE: &str = "no-require";

fn alone() -> Arg {
    Arg::new(ALONE)
        .long(ALONE)
        .action(ArgAction::SetTrue)
        .help("Leaves out the model's [require]: stability alone is asked for")
}

/// The key that says where the loop is cut.
const AT: &str = "at";

/// The keys of `[require]` that have an option here, each with its option.
static OPTIONS: LazyLock<Vec<(&str, Arg)>> = LazyLock::new(|| {
    let at = Arg::new(AT).long(AT).value_name("SIGNAL").help(
        "Where the loop is cut for margins: a signal, or a block (at its input) [default: what [require] says, else the error of a single loop]",
    );
    let mut options = Vec::new();
    for kind in RequirementKind::all() {
        let Some(option) = kind.option else { continue };
        // Names of options live as long as the program.
        let long: &'static str = kind.name.replace('_', "-").leak();
        options.push((kind.name, Arg::new(kind.name).long(long).value_name(option.value).help(option.help)));
    }
    options.push((AT, at));
    options
});

impl Args for RequirementOptions {
    fn augment_args(command: Command) -> Command {
        command.args(OPTIONS.iter().map(|(_, option)| option)).arg(alone())
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for RequirementOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = OPTIONS.iter().filter_map(|(key, _)| Some((*key, matches.get_one::<String>(key)?.clone())));
        Ok(RequirementOptions { given: given.collect(), alone: matches.get_flag(ALONE) })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl RequirementOptions {
    /// An option that requires something, if one does.
    pub fn first(&self) -> Option<String> {
        let is_at = |key: &str| key == AT;
        let last = self.given.iter().rev().find(|(key, _)| !is_at(key)).or(self.given.last());
        last.map(|(key, _)| format!("--{}", key.replace('_', "-")))
    }

    /// What the model's `[require]` and the command line ask for together, and the question with the region that follows.
    pub fn asked(
        &self,
        model: &Model,
        question: Question,
        region: &RegionOptions,
        context: &Context,
    ) -> Result<(Requirements, Question), Error> {
        let own = [("decay", &region.decay), ("radius", &region.radius)];
        let own = own.into_iter().filter_map(|(name, text)| Some((name, text.as_deref()?)));
        let further: Vec<(&str, &str)> =
            self.given.iter().map(|(name, text)| (*name, text.as_str())).chain(own).collect();
        // A region alone is the question's own.
        let asks = further.iter().any(|(name, _)| !["decay", "radius"].contains(name));
        if !asks && (self.alone || model.require().is_empty()) {
            return Ok((Requirements::default(), question));
        }
        let values = question.clone().problem()?.set().to_vec();
        let mut asked = match self.alone {
            true => Requirements::without_section(model, &further, &values, &context.budget)?,
            false => Requirements::of(model, &further, &values, &context.budget)?,
        };
        // A region that the command line gives is the question's own.
        asked.regional.retain(|(name, _)| match name.as_str() {
            "decay" => region.decay.is_none(),
            "radius" => region.radius.is_none(),
            _ => true,
        });
        let question = asked.region.clone().into_iter().fold(question, Question::within);
        Ok((asked, question))
    }
}

impl RequirementOptions {
    /// As [`RequirementOptions::asked`], with lists such as `30 deg, 45 deg`: those with the same name stand together.
    pub fn asked_each(
        &self,
        model: &Model,
        question: Question,
        region: &RegionOptions,
        context: &Context,
    ) -> Result<(Requirements, Question), Error> {
        let mut first = self.clone();
        let mut further: Vec<(&str, String)> = Vec::new();
        for kind in RequirementKind::all().iter().filter(|kind| kind.is_listed) {
            let Some((_, text)) = first.given.iter_mut().find(|(name, _)| *name == kind.name) else { continue };
            let list = std::mem::take(text);
            let mut parts = list.split(',').map(|part| part.trim().to_owned());
            *text = parts.next().unwrap_or_default();
            further.extend(parts.map(|part| (kind.name, part)));
        }
        let (mut asked, question) = first.asked(model, question, region, context)?;
        if !further.is_empty() {
            let values = question.clone().problem()?.set().to_vec();
            for (name, text) in further {
                let more = Requirements::of(model, &[(name, &text)], &values, &context.budget)?;
                let place = asked.list.iter().rposition(|r| r.name() == name).map_or(asked.list.len(), |k| k + 1);
                asked.list.splice(place..place, more.list.into_iter().filter(|r| r.name() == name));
            }
        }
        Ok((asked, question))
    }
}

/// That no theorem is written of requirements.
pub(super) fn refuse_theorems(asked: &Requirements, any_theorem: bool) -> Result<(), Error> {
    if !any_theorem || (asked.list.is_empty() && asked.regional.is_empty()) {
        return Ok(());
    }
    let error =
        Diagnostic::error(Code::Require, "an answer with requirements is not written for Coq or for SMT solvers");
    Err(error.help("'--no-require' leaves out those of the model; '--certificate FILE' proves margins").into())
}

/// Warns that a command does not look at the model's requirements.
pub(super) fn warn_of_ignored(model: &Model, context: &Context) {
    if !model.require().is_empty() {
        let warning =
            Diagnostic::warning(Code::RequireWarning, "[require] is not looked at here: stability alone is decided");
        let help =
            "requirements are decided by 'verdict', 'intervals', 'map', 'tolerance', 'tune', 'report' and 'test'";
        context.warn(None, &[warning.help(help)]);
    }
}
