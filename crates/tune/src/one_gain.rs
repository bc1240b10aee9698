//! The best value of one gain, or of a level over one gain.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::asked::Objective;
use crate::centre_of_one;
use crate::formula_of_one;
use crate::level_of_one::best_level;
use crate::lines::Lines;
use crate::sets::{bound_of, is_closed, names, near_end, on_bound, point_inside, widest};
use jurist_algebra::limits::Exhausted;
use jurist_engine::error::Error;
use jurist_engine::response::{Level, RequiredSet};
use std::cmp::Ordering;

/// The gain that is free.
pub(crate) const GAIN: usize = 0;

/// The best of what is asked over one gain.
///
/// # Errors
/// As `Lines::set`.
pub(crate) fn best(lines: &Lines<'_>) -> Result<Outcome, Error> {
    match (&lines.asked.objective, &lines.formula) {
        (Objective::Greatest(_), _) => best_gain(lines, true),
        (Objective::Least(_), _) => best_gain(lines, false),
        (Objective::Level(level) | Objective::SettlingTime(level), _) => best_level(lines, *level),
        (Objective::Norm(_), _) => best_level(lines, Level::Norm),
        (Objective::Tolerance(measure), _) => centre_of_one::best(lines, *measure),
        (Objective::Formula { .. }, Some(formula)) => formula_of_one::best(lines, formula),
        (Objective::Formula { .. } | Objective::Anything, _) => anything(lines),
    }
}

/// What is known where a set is empty.
pub(crate) fn nothing(set: &RequiredSet) -> Option<Outcome> {
    if !set.intervals.is_empty() {
        return None;
    }
    Some(match set.undecided.first() {
        None => Outcome::Infeasible { conflict: Vec::new(), cells: None },
        Some(bracket) => {
            Outcome::open(Exhausted::by_method(bracket.why.clone(), "whether any gain meets what is required"))
        }
    })
}

fn anything(lines: &Lines<'_>) -> Result<Outcome, Error> {
    let set = lines.set(GAIN, None, None)?.into_value();
    if let Some(nothing) = nothing(&set) {
        return Ok(nothing);
    }
    let inside = widest(&set).map(point_inside).expect("it is not empty");
    Ok(Optimum::some(vec![inside]).into())
}

fn best_gain(lines: &Lines<'_>, is_greatest: bool) -> Result<Outcome, Error> {
    let set = lines.set(GAIN, None, None)?.into_value();
    if let Some(nothing) = nothing(&set) {
        return Ok(nothing);
    }
    let interval = if is_greatest { set.intervals.last() } else { set.intervals.first() }.expect("it is not empty");
    let end = if is_greatest { &interval.upper } else { &interval.lower };
    let found = near_end(interval, is_greatest);
    // What is open beyond may hold better gains.
    let beyond = set.undecided.iter().filter(|bracket| {
        let Some(end) = end else { return false };
        let far = if is_greatest { &bracket.upper } else { &bracket.lower };
        far.as_ref().is_none_or(|x| {
            end.value().compare_rational(x) == if is_greatest { Ordering::Less } else { Ordering::Greater }
        })
    });
    let open = if is_greatest { beyond.last() } else { beyond.into_iter().next() };
    let (value, at, binding, attained) = match (end, open) {
        (Some(_), Some(bracket)) => match if is_greatest { &bracket.upper } else { &bracket.lower } {
            Some(far) => {
                (Best::Between([found.clone(), far.clone()]), Place::Exact(found.clone().into()), Vec::new(), None)
            }
            None => (Best::Nothing, Place::Unbounded, Vec::new(), None),
        },
        (None, _) => (Best::Unbounded, Place::Unbounded, Vec::new(), None),
        (Some(end), None) => {
            let bound = &lines.asked.gains[GAIN].bounds[usize::from(is_greatest)];
            let is_bound = bound.as_ref().is_some_and(|bound| end.value().compare_rational(bound).is_eq());
            let attained = match end.value().exact() {
                Some(value) => lines.is_met(&[(lines.asked.gains[GAIN].name.clone(), value)], None)?,
                None => is_closed(end),
            };
            let binding = if is_bound { vec![bound_of(&lines.asked.gains[GAIN].name)] } else { names(end) };
            (Best::Exact(end.value()), Place::Exact(end.value()), binding, Some(attained))
        }
    };
    let stopped = match (&value, open) {
        (Best::Between(_) | Best::Nothing, Some(bracket)) => {
            Some(Exhausted::by_method(bracket.why.clone(), "gains beyond those that are found"))
        }
        _ => None,
    };
    let on_bound = if let Best::Exact(value) = &value { on_bound(value, &binding, attained) } else { None };
    let found = on_bound.unwrap_or(found);
    let optimum = Optimum::new(value, vec![at], vec![found.clone()], Some(found));
    Ok(Optimum { attained, binding, stopped, ..optimum }.into())
}
