//! Limits that are held fast: which they are, whether they moved, and because of which number.

use super::collect::text;
use super::{Line, percent};
use crate::cli::status::Error;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_engine::error::{Code, Diagnostic};
use jurist_engine::model::Model;
use jurist_engine::problem::Ask;
use jurist_show::documents::{Bounds, End, Lock, LockedLimits, TestStatus};
use std::path::{Path, PathBuf};

/// Significant digits of locked limits.
const DIGITS: usize = 20;

/// Digits of limits in what is said.
const SHOWN: usize = 9;

/// Numbers that changed and are looked at alone.
const MOST_CULPRITS: usize = 20;

/// The file that holds the limits of a model file fast.
pub(in crate::cli) fn file_of(model: &Path) -> PathBuf {
    model.with_extension("lock.json")
}

/// The lock beside a model file, if there is one.
pub(super) fn of(model: &Path) -> Option<Result<Lock, Error>> {
    let file = file_of(model);
    file.is_file().then(|| {
        let source = text(&file)?;
        serde_json::from_str(&source.text).map_err(|error| {
            let message = format!("{} is no lock: {error}", file.display());
            Diagnostic::error(Code::Read, message).help("'jurist lock MODEL' writes it anew").into()
        })
    })
}

/// The limits of these parameters, or why one has none.
pub(in crate::cli) fn make(
    model: &Model,
    name: &str,
    parameters: &[String],
    within: &Rational,
    budget: &Budget,
) -> Result<Lock, Error> {
    let values = model.written().into_iter().map(|written| (written.name, written.text)).collect();
    let mut lock = Lock::new(name.to_owned(), within.into(), values);
    for parameter in parameters {
        lock.limits.push(limits(model, parameter, budget)?);
    }
    Ok(lock)
}

/// The limits of a parameter, the others having their nominal values.
pub(in crate::cli) fn limits(model: &Model, parameter: &str, budget: &Budget) -> Result<LockedLimits, Error> {
    Ok(LockedLimits::new(&model.ask().free(parameter).stable_set(budget)?, DIGITS))
}

/// A line for each parameter whose limits are locked.
pub(super) fn check(model: &Model, lock: &Lock, budget: &Budget) -> Vec<Line> {
    let line = |locked: &LockedLimits| {
        let name = format!("locked limits of {}", locked.parameter);
        match limits(model, &locked.parameter, budget) {
            Ok(now) => compared(name.clone(), &now, locked, model, lock, budget)
                .unwrap_or_else(|error| super::judge::failure(name, error)),
            Err(error) => super::judge::failure(name, error),
        }
    };
    lock.limits.iter().map(line).collect()
}

fn compared(
    name: String,
    now: &LockedLimits,
    locked: &LockedLimits,
    model: &Model,
    lock: &Lock,
    budget: &Budget,
) -> Result<Line, Error> {
    let within = parse_number(lock.within.as_str()).ok().ok_or_else(damaged)?;
    let moved = Moved::between(now, locked).ok_or_else(damaged)?;
    let status = match &moved {
        Moved::By { share, .. } if *share <= within => TestStatus::Passed,
        _ => TestStatus::Failed,
    };
    let mut text = moved.text();
    if status == TestStatus::Failed {
        text.push_str(&culprits(model, locked, lock, budget)?);
    }
    Ok(Line::new(name, status, text))
}

/// A lock with something else in the place of a number.
fn damaged() -> Error {
    let error = Diagnostic::error(Code::Read, "the lock has no number where one belongs");
    error.help("'jurist lock MODEL' writes it anew").into()
}

/// How limits moved: by the 20 digits that the lock has, which is what 'moved' means here.
enum Moved {
    /// The end that moved most, as a share of where it was locked.
    By { share: Rational, what: String },
    /// There are other ends than before.
    Otherwise(String),
}

impl Moved {
    /// `None` where a limit is no number.
    fn between(now: &LockedLimits, locked: &LockedLimits) -> Option<Moved> {
        if now.stable.len() != locked.stable.len() {
            return Some(Moved::Otherwise(format!("{}; locked: {}", intervals(now), intervals(locked))));
        }
        let mut most = (Rational::ZERO, "not moved".to_owned());
        for (new, old) in now.stable.iter().zip(&locked.stable) {
            for (side, new, old) in [("lower", &new.lower, &old.lower), ("upper", &new.upper, &old.upper)] {
                let (new, old) = match (new, old) {
                    (None, None) => continue,
                    (Some(new), Some(old)) => (new, old),
                    _ => return Some(Moved::Otherwise(format!("{}; locked: {}", intervals(now), intervals(locked)))),
                };
                let (x, was) = (value(new)?, value(old)?);
                let share = match (&x - &was).abs().checked_div(&was.abs()) {
                    Some(share) => share,
                    // From zero any way is far.
                    None => {
                        if x == was {
                            Rational::ZERO
                        } else {
                            Rational::ONE
                        }
                    }
                };
                if share > most.0 {
                    let what = format!(
                        "the {side} limit is {}, locked {}, moved by {}",
                        short(new),
                        short(old),
                        percent(&share)
                    );
                    most = (share, what);
                }
            }
        }
        Some(Moved::By { share: most.0, what: most.1 })
    }

    fn text(&self) -> String {
        match self {
            Moved::By { what, .. } | Moved::Otherwise(what) => what.clone(),
        }
    }

    /// By how much, where the ends are the same.
    fn share(&self) -> Option<&Rational> {
        match self {
            Moved::By { share, .. } => Some(share),
            Moved::Otherwise(_) => None,
        }
    }
}

/// Whether two values of TOML are the same number, or written alike.
fn is_same(a: &str, b: &str) -> bool {
    let number = |text: &str| parse_number(text.trim_matches(['"', '\''])).ok();
    a == b || number(a).is_some_and(|a| number(b) == Some(a))
}

/// A value of TOML for people: without quotes, a long number with its first digits.
fn plain(written: &str) -> String {
    let inner = written.trim_matches(['"', '\'']);
    match parse_number(inner) {
        Ok(number) => jurist_algebra::number::to_decimal(&number, SHOWN),
        Err(_) => inner.to_owned(),
    }
}

/// An end as a number of so many digits.
fn value(end: &End) -> Option<Rational> {
    let exact = end.number.exact.as_ref().map(|exact| exact.as_str());
    parse_number(exact.unwrap_or(&end.number.decimal)).ok()
}

fn short(end: &End) -> String {
    value(end).map_or_else(|| end.number.decimal.clone(), |x| jurist_algebra::number::to_decimal(&x, SHOWN))
}

fn intervals(limits: &LockedLimits) -> String {
    let end = |end: &Option<End>, none: &str| end.as_ref().map_or_else(|| none.to_owned(), short);
    let interval = |b: &Bounds<End>| format!("{} to {}", end(&b.lower, "-inf"), end(&b.upper, "inf"));
    match limits.stable.as_slice() {
        [] => "stable nowhere".to_owned(),
        all => format!("stable from {}", all.iter().map(interval).collect::<Vec<_>>().join(", and from ")),
    }
}

/// What changed since the lock, each with the limits that the model has when this value alone is as it was: the culprit first.
fn culprits(model: &Model, locked: &LockedLimits, lock: &Lock, budget: &Budget) -> Result<String, Error> {
    let written = model.written();
    let changed: Vec<(&str, &str, &str)> = written
        .iter()
        .filter_map(|now| {
            let (_, was) =
                lock.values.entries().iter().find(|(name, was)| *name == now.name && !is_same(was, &now.text))?;
            Some((now.name.as_str(), was.as_str(), now.text.as_str()))
        })
        .collect();
    let mut tried = Vec::new();
    for (name, was, now) in changed.iter().take(MOST_CULPRITS) {
        // What does not fit the model of today is no explanation.
        let Ok((restored, _)) = model.rewritten(name, was) else { continue };
        let found = match limits(&restored, &locked.parameter, budget) {
            Ok(found) => found,
            Err(Error::Stopped(stopped)) => return Err(stopped.into()),
            Err(_) => continue,
        };
        let Some(moved) = Moved::between(&found, locked) else { continue };
        let text = match moved.share() {
            Some(share) if share.is_zero() => "this alone explains it".to_owned(),
            Some(share) => format!("with the old value it moved by {}", percent(share)),
            None => format!("with the old value {}", intervals(&found)),
        };
        let text = format!("{name} was {}, is {}: {text}", plain(was), plain(now));
        tried.push((moved.share().is_none(), moved.share().cloned(), text));
    }
    tried.sort();
    let known = |name: &str| lock.values.entries().iter().any(|(n, _)| n == name);
    let added: Vec<&str> = written.iter().map(|w| w.name.as_str()).filter(|name| !known(name)).collect();
    let is_left = |name: &str| written.iter().any(|w| w.name == name);
    let removed: Vec<&str> = lock.values.entries().iter().map(|(n, _)| n.as_str()).filter(|n| !is_left(n)).collect();
    let mut said: Vec<String> = tried.into_iter().map(|(_, _, text)| text).collect();
    if !added.is_empty() {
        said.push(format!("new since then: {}", added.join(", ")));
    }
    if !removed.is_empty() {
        said.push(format!("gone since then: {}", removed.join(", ")));
    }
    if said.is_empty() {
        said.push("no constant and no nominal value changed, so the loop itself did".to_owned());
    }
    Ok(format!("; {}", said.join("; ")))
}
