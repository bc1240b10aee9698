//! `jurist sweep`: the same question at many points.

use super::{Context, Runs};
use crate::cli::arguments::{ReadingOptions, RunOptions};
use crate::cli::assignments::{assignments, in_line};
use crate::cli::destinations::Files;
use crate::cli::input::{known_name, known_names, load};
use crate::cli::output::{finish_answer, note};
use crate::cli::status::{Error, Outcome, Status};
use crate::cli::sweep::file::{Format, Known, Part};
use crate::cli::sweep::grid::{Axis, axis, points};
use crate::cli::sweep::key::{Point, Question, VERDICT};
use crate::cli::sweep::rows::{Row, order, rows};
use clap::Args;
use jurist_algebra::limits::{Budget, apart, parallel_map};
use jurist_engine::error::{Code, Diagnostic};
use jurist_engine::model::Model;
use serde_json::Value;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::ffi::OsString;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Options of `jurist sweep`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// A model file, '-' for standard input, or a loop in one line; left out: the built-in drive
    #[arg(value_name = "MODEL")]
    pub model: Option<OsString>,
    #[command(flatten)]
    pub line: ReadingOptions,
    /// The parameter whose stable set is asked for; left out: the verdict at each point [repeatable]
    #[arg(long, value_name = "NAME")]
    pub param: Vec<String>,
    /// Values of a parameter or constant: so many from LO to HI, both included, or a list; with several, all combinations
    #[arg(long, value_name = "NAME=LO..HI:N", required = true)]
    pub over: Vec<String>,
    /// Gives another parameter or constant one value, exactly [repeatable]
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Gives a single question up after this time; its row says so
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = crate::cli::arguments::seconds)]
    pub each: Duration,
    /// Keeps the rows that are there, and asks the rest; undecided questions are asked again
    #[arg(long, requires = "output")]
    pub resume: bool,
    /// Writes to a file: .jsonl or .csv [default: JSON lines on standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<OsString>,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let format = Format::of(self.output.as_ref())?;
        let model = load(self.model.as_ref(), &self.line, context)?;
        let (questions, names) = questions(self, &model, context)?;
        let file = self.output.as_ref().filter(|file| *file != "-");
        let mut kept = match file.filter(|_| self.resume) {
            Some(file) => kept(file, format, &questions, context)?,
            None => HashMap::new(),
        };
        let part = file.map(|file| Part::open(file, self.resume)).transpose()?;
        let open: Vec<&Question> =
            questions.iter().filter(|(key, _)| !kept.contains_key(key)).map(|(_, q)| q).collect();
        let asked = ask(&open, &model, self, part.as_ref(), context);
        let answered: Vec<Vec<Row>> = asked.into_iter().flatten().collect::<Result<_, Error>>()?;
        context.reporter.finish();
        let rest = open.len() - answered.len();
        if rest > 0
            && let Err(stopped) = context.budget.check()
        {
            note(&format!("{rest} of {} questions are open; '--resume' goes on from here", questions.len()));
            return Ok(context.say_undecided(&stopped));
        }
        let of_questions = questions.iter().filter_map(|(key, _)| kept.remove(key));
        let mut all: Vec<Row> = of_questions.flatten().chain(answered.into_iter().flatten()).collect();
        all.sort_by(order);
        finish_answer(&format.text(&all, &names), self.output.as_ref())?;
        if let Some(part) = part {
            part.done();
        }
        let undecided = all.iter().filter(|row| text(row, "status") == "undecided").count();
        if undecided > 0 {
            note(&format!("undecided: {undecided} of {} questions", questions.len()));
            return Ok(Status::Undecided);
        }
        Ok(Status::Holds)
    }

    fn files<'a>(&'a self, files: &mut Files<'a>) -> Result<(), Error> {
        files.question(&self.model, &self.output);
        Ok(())
    }
}

/// The rows that earlier runs of this sweep left, by key.
fn kept(
    file: &OsString,
    format: Format,
    questions: &Keyed,
    context: &Context,
) -> Result<HashMap<String, Vec<Row>>, Error> {
    let known = Known::read(file, format)?;
    let keys: HashSet<&str> = questions.iter().map(|(key, _)| key.as_str()).collect();
    if let Some(why) = known.of_others(|key| keys.contains(key)) {
        let name = file.to_string_lossy();
        let error = Diagnostic::error(Code::Resume, format!("{name} is not of this sweep: {why}"));
        let error = match context.line.argument(&name) {
            Some(span) => error.at(span, "of another model, other values, or another version of jurist"),
            None => error,
        };
        let error = error.help("write to another file; without '--resume' this one is written anew");
        return Err(in_line(context.line, vec![error]).into());
    }
    let mut kept = HashMap::new();
    for rows in known.rows {
        let Some(first) = rows.first() else { continue };
        if matches!(text(first, "status"), "decided" | "refused") {
            kept.insert(text(first, "key").to_owned(), rows);
        }
    }
    Ok(kept)
}

/// A column that is a text.
fn text<'r>(row: &'r Row, column: &str) -> &'r str {
    row.get(column).and_then(Value::as_str).unwrap_or_default()
}

/// Questions, each with its key.
type Keyed = Vec<(String, Question)>;

/// The questions with their keys, each once, and the names in their points.
fn questions(options: &Options, model: &Model, context: &Context) -> Result<(Keyed, BTreeSet<String>), Error> {
    known_names(context, model, "--param", &options.param)?;
    let refuse = |message: String, at| -> Error {
        in_line(context.line, vec![Diagnostic::error(Code::SetTwice, message).at(at, "a second time")]).into()
    };
    let mut fixed: Point = Vec::new();
    let mut axes: Vec<Axis> = Vec::new();
    for assignment in assignments(context.line, "--set", &options.set)? {
        known_name(context, model, &assignment.name, assignment.name_span)?;
        fixed.push((assignment.name, assignment.value));
    }
    for text in &options.over {
        let axis = axis(context.line, text)?;
        known_name(context, model, &axis.name, axis.name_span)?;
        let mut taken = fixed.iter().map(|(name, _)| name).chain(axes.iter().map(|a| &a.name)).chain(&options.param);
        if taken.any(|name| *name == axis.name) {
            return Err(refuse(format!("'{}' is given twice", axis.name), axis.name_span));
        }
        axes.push(axis);
    }
    fixed.sort();
    let names = fixed.iter().map(|(name, _)| name.clone()).chain(axes.iter().map(|a| a.name.clone())).collect();
    let Some(points) = points(&axes, &fixed) else {
        return Err(Diagnostic::error(Code::OptionValue, "there are too many combinations").into());
    };
    let verdict = [VERDICT.to_owned()];
    let asks = if options.param.is_empty() { &verdict[..] } else { &options.param };
    let mut seen = HashSet::new();
    let mut out = Vec::new();
    for ask in asks {
        for point in &points {
            let question = Question { ask: ask.clone(), point: point.clone() };
            let key = question.key(&model.source().text);
            if seen.insert(key.clone()) {
                out.push((key, question));
            }
        }
    }
    Ok((out, names))
}

/// The rows of each question; `None` for those that were not begun in time.
fn ask(
    questions: &[&Question],
    model: &Model,
    options: &Options,
    part: Option<&Part>,
    context: &Context,
) -> Vec<Option<Result<Vec<Row>, Error>>> {
    context.budget.step("asking the questions");
    let done = AtomicU64::new(0);
    let alone = || {
        let time = time_of_one(options.each, options.run.timeout, context.reporter.elapsed());
        Budget::with_timeout(time).within_memory(options.run.memory())
    };
    parallel_map(questions, |question| {
        if context.budget.check().is_err() {
            return None;
        }
        // No part of another question, whose budget may run out first.
        let found = apart(|| rows(model, question, &alone()));
        // Given up because all are: it stays open.
        if found.iter().any(|row| text(row, "status") == "undecided") && context.budget.check().is_err() {
            return None;
        }
        let written = part.map_or(Ok(()), |part| part.add(&found));
        context.budget.advance(done.fetch_add(1, Ordering::Relaxed) + 1, questions.len() as u64);
        Some(written.map(|()| found))
    })
}

/// How long a question may take: as long as each may, and no longer than all.
fn time_of_one(each: Duration, all: Option<Duration>, elapsed: Duration) -> Duration {
    all.map_or(each, |all| each.min(all.saturating_sub(elapsed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_takes_no_longer_than_all_may() {
        let [zero, one, ten] = [0, 1, 10].map(Duration::from_secs);
        assert_eq!(time_of_one(ten, None, one), ten);
        assert_eq!(time_of_one(ten, Some(one), zero), one);
        assert_eq!(time_of_one(ten, Some(one), ten), zero);
        assert_eq!(time_of_one(one, Some(ten), one), one);
    }
}
