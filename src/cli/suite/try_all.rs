//! All expectations, tried on all cores.

use super::collect::{Entry, Locked, Suite};
use super::judge::{failure, judge, words};
use super::{InText, Line, lock};
use crate::cli::status::Error;
use crate::cli::table::Point;
use jurist_algebra::limits::{Budget, parallel_map};
use jurist_algebra::number::Rational;
use jurist_engine::model::ClaimKind;
use jurist_show::documents::TestStatus;
use jurist_show::layout::short;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What became of the expectations of each file.
pub(in crate::cli) struct Outcomes {
    pub files: Vec<(String, Vec<Line>)>,
}

/// A claim at all its operating points.
struct Job<'s> {
    file: usize,
    entry: &'s Entry,
    claim: &'s ClaimKind,
    place: &'s Option<InText>,
    points: Vec<Point>,
}

/// Values shown of an operating point.
const SHOWN: usize = 6;

/// Tries everything; what the budget does not allow is undecided.
pub(in crate::cli) fn try_all(suites: &[Suite], budget: &Budget) -> Outcomes {
    budget.step("trying the expectations");
    let mut files: Vec<(String, Vec<Line>)> = suites.iter().map(|suite| (suite.file.clone(), Vec::new())).collect();
    let mut jobs = Vec::new();
    for (file, suite) in suites.iter().enumerate() {
        match &suite.entries {
            Ok(entries) => jobs.extend(entries.iter().flat_map(|entry| jobs_of(file, entry))),
            Err(error) => {
                let mut line = failure("the file".to_owned(), error.clone());
                line.place = place_of(error);
                files[file].1.push(line);
            }
        }
    }
    let tasks: Vec<(usize, usize)> =
        jobs.iter().enumerate().flat_map(|(j, job)| (0..job.points.len()).map(move |row| (j, row))).collect();
    let done = AtomicU64::new(0);
    let total = tasks.len() as u64;
    let judged: Vec<Vec<Line>> = parallel_map(tasks.iter().copied(), |(j, row)| {
        let job: &Job<'_> = &jobs[j];
        let lines = judge(job.claim, &job.entry.model, &job.points[row], &job.entry.folder, budget);
        budget.advance(done.fetch_add(1, Ordering::Relaxed) + 1, total);
        lines
    });
    let mut judged = judged.into_iter();
    for job in &jobs {
        let rows: Vec<Vec<Line>> = judged.by_ref().take(job.points.len()).collect();
        files[job.file].1.extend(worst(job, rows));
    }
    let locks: Vec<Vec<Line>> = parallel_map(suites.iter().map(|suite| &suite.lock), |lock| match lock {
        None => Vec::new(),
        Some(Locked { model, lock: Ok(lock) }) => lock::check(model, lock, budget),
        Some(Locked { lock: Err(error), .. }) => vec![failure("the lock".to_owned(), error.clone())],
    });
    for ((_, lines), locked) in files.iter_mut().zip(locks) {
        lines.extend(locked);
    }
    Outcomes { files }
}

fn jobs_of(file: usize, entry: &Entry) -> Vec<Job<'_>> {
    let points: Vec<Point> = match &entry.cases {
        None => vec![entry.set.clone()],
        // What the entry itself sets holds at every point.
        Some(cases) => cases.points.iter().map(|point| with(point, &entry.set)).collect(),
    };
    let is_fixed = |claim: &ClaimKind| matches!(claim, ClaimKind::Certificate(_));
    entry
        .claims
        .iter()
        .map(|(claim, place)| {
            let points = if is_fixed(claim) { vec![entry.set.clone()] } else { points.clone() };
            Job { file, entry, claim, place, points }
        })
        .collect()
}

fn with(point: &Point, set: &Point) -> Point {
    let others = point.iter().filter(|(name, _)| !set.iter().any(|(own, _)| own == name));
    others.chain(set).cloned().collect()
}

/// Of each line the one at the worst operating point.
fn worst(job: &Job<'_>, rows: Vec<Vec<Line>>) -> Vec<Line> {
    let named = |line: Line| Line {
        place: own_place(job, &line.name).or(job.place.clone()),
        name: match &job.entry.name {
            Some(name) => format!("{name}: {}", line.name),
            None => line.name,
        },
        ..line
    };
    if job.points.len() == 1 {
        return rows.into_iter().flatten().map(named).collect();
    }
    let mut names: Vec<String> = Vec::new();
    for line in rows.iter().flatten() {
        if !names.contains(&line.name) {
            names.push(line.name.clone());
        }
    }
    let of_name = |name: String| -> Option<Line> {
        let lines = rows.iter().enumerate().flat_map(|(row, lines)| lines.iter().map(move |line| (row, line)));
        let lines: Vec<(usize, &Line)> = lines.filter(|(_, line)| line.name == name).collect();
        let bad = lines.iter().filter(|(_, line)| line.status != TestStatus::Passed).count();
        let (row, line) = lines.into_iter().min_by(|(_, a), (_, b)| rank(a).cmp(&rank(b)))?;
        let values = job.points[row].iter().take(SHOWN).map(|(name, value)| format!("{name} = {}", short(value)));
        let values = values.collect::<Vec<_>>().join(", ");
        let of = match bad {
            0 => format!("the worst of {} operating points is", job.points.len()),
            bad => format!("not so at {bad} of {} operating points, the worst is", job.points.len()),
        };
        Some(Line {
            text: format!("{of} row {} ({values}): {}", row + 1, line.text),
            row: Some(row + 1),
            ..line.clone()
        })
    };
    if names.is_empty() {
        names.push(words(job.claim));
    }
    names.into_iter().filter_map(of_name).map(named).collect()
}

/// Where the model's `[require]` has the requirement of a line.
fn own_place(job: &Job<'_>, name: &str) -> Option<InText> {
    let ClaimKind::Require(further) = job.claim else { return None };
    let is_of_line = |text: &str| name.strip_prefix(text).is_some_and(|rest| rest.starts_with(' '));
    let model = &job.entry.model;
    let own = model.require().iter().find(|r| is_of_line(&r.name) && !further.iter().any(|f| f.name == r.name))?;
    Some((Arc::clone(model.source()), own.span))
}

/// The worst comes first: by what became of it, then by what is left.
fn rank(line: &Line) -> (std::cmp::Reverse<TestStatus>, bool, Rational) {
    (std::cmp::Reverse(line.status), line.margin.is_none(), line.margin.clone().unwrap_or(Rational::ZERO))
}

/// Where an error stands.
fn place_of(error: &Error) -> Option<InText> {
    let Error::Refused(refused) = error else { return None };
    let source = refused.source_text()?;
    let span = refused.diagnostics().first()?.primary.as_ref()?.span;
    Some((Arc::clone(source), span))
}
