//! The best value of one of two gains, or of a level over both.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::asked::Objective;
use crate::level_of_one::{bracketed, is_unbounded_at, is_without_end, not_found, scale};
use crate::lines::Lines;
use crate::near::{is_narrow, toward};
use crate::search::Search;
use crate::sets::{bound_of, is_closed, names, outer, point_inside, widest};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::response::{Level, RequiredInterval};
use jurist_stability::plane::Strip;

/// The best of what is asked over two gains.
///
/// # Errors
/// As `Lines::strips` and `Lines::set`.
pub(crate) fn best(lines: &Lines<'_>) -> Result<Outcome, Error> {
    match lines.asked.objective {
        Objective::Greatest(gain) => best_gain(lines, gain, true),
        Objective::Least(gain) => best_gain(lines, gain, false),
        Objective::Level(level) | Objective::SettlingTime(level) => best_level(lines, level),
        // Of an expression, a peak gain and a tolerance boxes are searched.
        Objective::Norm(_) | Objective::Tolerance(_) | Objective::Formula { .. } | Objective::Anything => {
            anything(lines)
        }
    }
}

/// A point of a cell in which what is asked is met; of all, the one in the middle of the list.
fn met_point(strips: &[Strip]) -> Option<[Rational; 2]> {
    let all: Vec<[Rational; 2]> = strips
        .iter()
        .flat_map(|strip| {
            let met = strip.cells.iter().filter(|cell| cell.stable);
            met.map(|cell| [strip.sample.clone(), cell.sample.clone()])
        })
        .collect();
    all.get(all.len() / 2).cloned()
}

fn anything(lines: &Lines<'_>) -> Result<Outcome, Error> {
    Ok(match met_point(&lines.strips(0, None)?) {
        None => Outcome::Infeasible { conflict: Vec::new(), cells: None },
        Some(point) => Optimum::some(point.into()).into(),
    })
}

/// So many digits of the best value are gone towards, until the other gain is known.
const DIGITS: [usize; 3] = [6, 36, 72];

/// The last strip of the map, with the gain as its first axis, in which something is met: its outer end is the best value.
fn best_gain(lines: &Lines<'_>, gain: usize, is_greatest: bool) -> Result<Outcome, Error> {
    let strips = lines.strips(gain, None)?;
    let is_met = |strip: &&Strip| strip.cells.iter().any(|cell| cell.stable);
    let strip = if is_greatest { strips.iter().rfind(is_met) } else { strips.iter().find(is_met) };
    let Some(strip) = strip else { return Ok(Outcome::Infeasible { conflict: Vec::new(), cells: None }) };
    let cell = strip.cells.iter().find(|cell| cell.stable).expect("it is met");
    let sample = in_order(gain, strip.sample.clone(), cell.sample.clone());
    let end = if is_greatest { &strip.x.upper } else { &strip.x.lower };
    let Some(value) = end else {
        let places = vec![Place::Unbounded, Place::Unbounded];
        return Ok(Optimum::new(Best::Unbounded, places, sample, Some(strip.sample.clone())).into());
    };
    match lines.part(|| beside_best(lines, (gain, is_greatest), value, &strip.sample)) {
        // The best value is known; where it is had is not.
        Err(Error::Stopped(stopped)) => {
            let optimum = Optimum::new(Best::Exact(value.clone()), Vec::new(), sample, Some(strip.sample.clone()));
            Ok(Optimum { stopped: Some(stopped), ..optimum }.into())
        }
        found => Ok(found?.into()),
    }
}

fn in_order(gain: usize, height: Rational, place: Rational) -> Vec<Rational> {
    if gain == 0 { vec![height, place] } else { vec![place, height] }
}

/// The other gain at the best value of one, from a value inside.
fn beside_best(
    lines: &Lines<'_>,
    (gain, is_greatest): (usize, bool),
    value: &Real,
    inside: &Rational,
) -> Result<Optimum, Error> {
    let mut near: Vec<(Rational, RequiredInterval)> = Vec::new();
    for digits in DIGITS {
        lines.budget.step("gains near the best value");
        let height = toward(value, inside, digits);
        let set = match lines.part(|| lines.set(1 - gain, Some((gain, &height)), None)) {
            Err(Error::Stopped(_)) if !near.is_empty() => break,
            set => set?.into_value(),
        };
        let Some(interval) = widest(&set) else { break };
        near.push((height, interval.clone()));
        let is_known = near.len() > 1 && (is_point(interval) || is_plateau(&near));
        if is_known {
            break;
        }
    }
    let (height, interval) = near.last().expect("the strip is met");
    let range = lines.range(gain);
    let bound = if is_greatest { &range.upper } else { &range.lower };
    let bound = bound.as_ref().filter(|bound| value.compare_rational(bound).is_eq());
    let mut found = in_order(gain, height.clone(), point_inside(interval));
    let mut height = height.clone();
    let (place, attained, binding) = match bound {
        Some(bound) => {
            let set = lines.set(1 - gain, Some((gain, bound)), None)?.into_value();
            // A bound is a value that some gains have, or the limit of such values.
            if let Some(own) = widest(&set) {
                found = in_order(gain, bound.clone(), point_inside(own));
                height = bound.clone();
            }
            let own = widest(&set).unwrap_or(interval);
            (range_of(own), Some(widest(&set).is_some()), vec![bound_of(&lines.asked.gains[gain].name)])
        }
        None => {
            let ends: Vec<_> = [&interval.lower, &interval.upper].into_iter().flatten().collect();
            let is_closed = !ends.is_empty() && ends.iter().all(|end| is_closed(end));
            match is_plateau(&near) {
                false => (enclosed(interval), Some(is_closed), ends.iter().flat_map(|end| names(end)).collect()),
                true => {
                    let (attained, binding) = across(lines, (gain, is_greatest), &height, &found[1 - gain])?;
                    (range_of(interval), attained, binding)
                }
            }
        }
    };
    let mut at = vec![Place::Exact(value.clone()), place];
    if gain == 1 {
        at.reverse();
    }
    let mut binding: Vec<String> = binding;
    binding.sort();
    binding.dedup();
    let optimum = Optimum::new(Best::Exact(value.clone()), at, found, Some(height));
    Ok(Optimum { attained, binding, ..optimum })
}

/// What ends the gain that is to be best on a plateau, at a value of the other one: whether the end has it, and what binds.
fn across(
    lines: &Lines<'_>,
    (gain, is_greatest): (usize, bool),
    height: &Rational,
    other: &Rational,
) -> Result<(Option<bool>, Vec<String>), Error> {
    let set = lines.set(gain, Some((1 - gain, other)), None)?.into_value();
    let interval = set.intervals.iter().find(|interval| interval.contains(height));
    let end = interval.and_then(|interval| if is_greatest { interval.upper.as_ref() } else { interval.lower.as_ref() });
    let Some(end) = end else { return Ok((None, Vec::new())) };
    // Where stability alone is asked, no end is stable itself; else other values may have an end that is met.
    let attained = if is_closed(end) { Some(true) } else { lines.asked.requirements.list.is_empty().then_some(false) };
    Ok((attained, names(end)))
}

fn width(interval: &RequiredInterval) -> Option<Rational> {
    match outer(interval) {
        (Some(low), Some(high)) => Some(high - low),
        _ => None,
    }
}

/// Whether an interval is so narrow that it tells one gain.
fn is_point(interval: &RequiredInterval) -> bool {
    matches!(outer(interval), (Some(low), Some(high)) if is_narrow(&low, &high))
}

/// Whether gains near to the best value stay as far apart as they were: the best value is then had, or come near to, on a whole interval.
fn is_plateau(near: &[(Rational, RequiredInterval)]) -> bool {
    let [.., (_, before), (_, last)] = near else { return false };
    match (width(before), width(last)) {
        (Some(before), Some(last)) => last * Rational::from(2) > before,
        _ => true,
    }
}

/// All of an interval.
fn range_of(interval: &RequiredInterval) -> Place {
    match outer(interval) {
        (Some(low), Some(high)) if low == high => Place::Exact(low.into()),
        ends => Place::From(ends),
    }
}

/// A number in an interval.
fn enclosed(interval: &RequiredInterval) -> Place {
    match outer(interval) {
        (Some(low), Some(high)) if low == high => Place::Exact(low.into()),
        (Some(low), Some(high)) => Place::Between([low, high]),
        _ => Place::Unbounded,
    }
}

/// A bracket of a level, a map for each halving.
fn best_level(lines: &Lines<'_>, level: Level) -> Result<Outcome, Error> {
    let Some(plain) = met_point(&lines.strips(0, None)?) else {
        return Ok(Outcome::Infeasible { conflict: Vec::new(), cells: None });
    };
    let search =
        Search { ends: scale(lines, level), is_rising: level.is_rising(), is_without_end: is_without_end(level) };
    let met = |scale: &Rational| Ok(met_point(&lines.strips(0, Some(scale))?));
    let found = search.bracket(lines, None, &met)?;
    let Some((scale, point)) = found.met else {
        return Ok(
            Optimum { stopped: found.stopped.or_else(|| Some(not_found())), ..Optimum::some(plain.into()) }.into()
        );
    };
    if found.not.is_none() && is_unbounded_at(lines, level, &point)? {
        return Ok(Optimum::new(Best::Unbounded, Vec::new(), point.into(), None).into());
    }
    let (value, stopped) = bracketed(level, &scale, found.not, found.stopped);
    let at = point.iter().map(|x| Place::Exact(x.clone().into())).collect();
    let optimum = Optimum::new(value, at, point.into(), Some(scale));
    Ok(Optimum { binding: vec![level.name().to_owned()], stopped, ..optimum }.into())
}
