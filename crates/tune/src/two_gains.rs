//! The best value of one of two gains, or of a level over both.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::asked::Objective;
use crate::lines::Lines;
use crate::near::toward;
use crate::one_gain::{bracketed, is_without_end, not_found, scale};
use crate::search::Search;
use crate::sets::{is_closed, names, outer, point_inside, widest};
use jurist_algebra::number::Rational;
use jurist_engine::error::Error;
use jurist_engine::response::Level;
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
        // Of an expression and of a peak gain boxes are searched.
        Objective::Norm(_) | Objective::Formula { .. } | Objective::Anything => anything(lines),
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

/// So many digits of the best value are gone towards.
const DIGITS: [usize; 2] = [6, 36];

/// The last strip of the map, with the gain as its first axis, in which something is met: its outer end is the best value.
fn best_gain(lines: &Lines<'_>, gain: usize, is_greatest: bool) -> Result<Outcome, Error> {
    let strips = lines.strips(gain, None)?;
    let is_met = |strip: &&Strip| strip.cells.iter().any(|cell| cell.stable);
    let strip = if is_greatest { strips.iter().rfind(is_met) } else { strips.iter().find(is_met) };
    let Some(strip) = strip else { return Ok(Outcome::Infeasible { conflict: Vec::new(), cells: None }) };
    let in_order =
        |height: Rational, place: Rational| if gain == 0 { vec![height, place] } else { vec![place, height] };
    let end = if is_greatest { &strip.x.upper } else { &strip.x.lower };
    let Some(value) = end else {
        let cell = strip.cells.iter().find(|cell| cell.stable).expect("it is met");
        let found = in_order(strip.sample.clone(), cell.sample.clone());
        let places = vec![Place::Unbounded, Place::Unbounded];
        return Ok(Optimum::new(Best::Unbounded, places, found, Some(strip.sample.clone())).into());
    };
    let mut near = None;
    for digits in DIGITS {
        lines.budget.step("gains near the best value");
        let height = toward(value, &strip.sample, digits);
        let set = lines.set(1 - gain, Some((gain, &height)), None)?.into_value();
        let Some(interval) = widest(&set) else { break };
        near = Some((height, interval.clone()));
    }
    let (height, interval) = near.expect("the strip is met");
    let place = match outer(&interval) {
        (Some(low), Some(high)) if low == high => Place::Exact(low.into()),
        (Some(low), Some(high)) => Place::Between([low, high]),
        _ => Place::Unbounded,
    };
    let ends: Vec<_> = [&interval.lower, &interval.upper].into_iter().flatten().collect();
    let is_bound = {
        let range = lines.range(gain);
        let bound = if is_greatest { &range.upper } else { &range.lower };
        bound.as_ref().is_some_and(|bound| value.compare_rational(bound).is_eq())
    };
    let mut binding: Vec<String> = match is_bound {
        true => vec![format!("bound of {}", lines.asked.gains[gain].name)],
        false => ends.iter().flat_map(|end| names(end)).collect(),
    };
    binding.sort();
    binding.dedup();
    let attained = match is_bound {
        true => {
            let bound = value.exact().expect("a bound is a number");
            !lines.set(1 - gain, Some((gain, &bound)), None)?.value().intervals.is_empty()
        }
        false => !ends.is_empty() && ends.iter().all(|end| is_closed(end)),
    };
    let mut at = vec![Place::Exact(value.clone()), place];
    if gain == 1 {
        at.reverse();
    }
    let found = in_order(height.clone(), point_inside(&interval));
    let optimum = Optimum::new(Best::Exact(value.clone()), at, found, Some(height));
    Ok(Optimum { attained: Some(attained), binding, ..optimum }.into())
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
    let (value, stopped) = bracketed(level, &scale, found.not, found.stopped);
    let at = point.iter().map(|x| Place::Exact(x.clone().into())).collect();
    let optimum = Optimum::new(value, at, point.into(), Some(scale));
    Ok(Optimum { binding: vec![level.name().to_owned()], stopped, ..optimum }.into())
}
