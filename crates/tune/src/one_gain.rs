//! The best value of one gain, or of a level over one gain.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::asked::Objective;
use crate::critical::Curves;
use crate::formula_of_one;
use crate::lines::Lines;
use crate::near::{approach, is_attained};
use crate::search::Search;
use crate::seed::seed;
use crate::sets::{is_closed, names, near_end, outer, point_inside, widest};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{RealAlgebraic, rational_between};
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::response::{Level, RequiredEnd, RequiredInterval, RequiredSet};
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
            Outcome::Open(Exhausted::by_method(bracket.why.clone(), "whether any gain meets what is required"))
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
            Some(far) => (
                Best::Between([found.clone(), far.clone()]),
                Place::Between([found.clone(), far.clone()]),
                Vec::new(),
                None,
            ),
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
            let binding = match is_bound {
                true => vec![format!("bound of {}", lines.asked.gains[GAIN].name)],
                false => names(end),
            };
            (Best::Exact(end.value()), Place::Exact(end.value()), binding, Some(attained))
        }
    };
    let stopped = match (&value, open) {
        (Best::Between(_) | Best::Nothing, Some(bracket)) => {
            Some(Exhausted::by_method(bracket.why.clone(), "gains beyond those that are found"))
        }
        _ => None,
    };
    let optimum = Optimum::new(value, vec![at], vec![found.clone()], Some(found));
    Ok(Optimum { attained, binding, stopped, ..optimum }.into())
}

/// A level: exactly where its boundary is algebraic, else in a bracket.
fn best_level(lines: &Lines<'_>, level: Level) -> Result<Outcome, Error> {
    let plain = lines.set(GAIN, None, None)?.into_value();
    if let Some(nothing) = nothing(&plain) {
        return Ok(nothing);
    }
    let ends = scale(lines, level);
    let curves = lines.problem()?.boundary_in_level(
        (level, lines.asked.between()),
        &lines.asked.requirements.list,
        lines.at(),
        lines.budget,
    )?;
    let Some(curves) = curves else { return bracket(lines, level, &plain, &ends) };
    lines.budget.step("critical values");
    let curves = Curves::new(&curves, lines.budget)?;
    let [low, high] = &ends;
    let top = if is_without_end(level) { None } else { Some(high) };
    let heights = curves.heights(lines.range(GAIN), [Some(low), top], lines.budget)?;
    // Beyond the last critical value nothing changes: what is met there is met without end.
    let above = |last: &RealAlgebraic| Rational::from(last.floor()) * Rational::from(2) + Rational::from(2);
    let ends = match heights.last() {
        Some(last) if top.is_none() => [low.clone(), above(last).max(high.clone())],
        _ => ends,
    };
    // From the worst to the best.
    let mut walls = vec![RealAlgebraic::from_rational(ends[0].clone())];
    walls.extend(heights);
    walls.push(RealAlgebraic::from_rational(ends[1].clone()));
    if !level.is_rising() {
        walls.reverse();
    }
    let inside = |k: usize| rational_between(&walls[k], &walls[k + 1]).expect("they differ");
    let set_at =
        |scale: &Rational| -> Result<RequiredSet, Error> { Ok(lines.set(GAIN, None, Some(scale))?.into_value()) };
    // What is met with more is met with less: the best cell by halving.
    let (mut met, mut not) = (None, walls.len() - 1);
    let mut first = 0;
    while first < not {
        let middle = (first + not) / 2;
        lines.budget.step("whether any gain has a level");
        let set = set_at(&inside(middle))?;
        if set.intervals.is_empty() {
            if let Some(Outcome::Open(stopped)) = nothing(&set) {
                return Ok(Outcome::Open(stopped));
            }
            not = middle;
        } else {
            met = Some(middle);
            first = middle + 1;
        }
    }
    let Some(cell) = met else { return Ok(Optimum { stopped: Some(not_found()), ..some(&plain) }.into()) };
    let wall = &walls[cell + 1];
    let sample = inside(cell);
    let is_end = cell + 2 == walls.len();
    // Beyond 180 degrees there is no phase margin: the open loop is smaller than 1 everywhere.
    let far = is_end && (is_without_end(level) || level == Level::PhaseMargin);
    if far {
        let set = set_at(&sample)?;
        let interval = widest(&set).expect("the cell is met");
        let place = place_far(&far_away(&sample, &ends), level, interval, &set_at)?;
        return Ok(Optimum::new(best_at_end(level), vec![place], vec![point_inside(interval)], Some(sample)).into());
    }
    let places = curves.places(lines.range(GAIN), lines.budget)?;
    let value = Real::from(wall.clone());
    let mut near = approach(lines, &value, &sample, &places, &set_at)?;
    let binding = with_level(level, &near.interval);
    let mut attained = is_attained(lines, &near.place, &plain)?;
    // On a plateau all gains of an interval have the best value; else it may be had at no one of them.
    if !matches!(near.place, Place::Exact(_)) {
        attained = has_level(lines, level, &value, &point_inside(&near.interval))?;
        if attained == Some(true) && matches!(near.place, Place::Unbounded) {
            near.place = Place::From(outer(&near.interval));
        }
    }
    let found = vec![point_inside(&near.interval)];
    let optimum = Optimum::new(Best::Exact(value), vec![near.place], found, Some(near.height));
    Ok(Optimum { attained, binding, ..optimum }.into())
}

/// Some gain of a set that is not empty.
fn some(plain: &RequiredSet) -> Optimum {
    Optimum::some(vec![widest(plain).map(point_inside).expect("it is not empty")])
}

/// That no gain with any value of a level was found, though some loops are stable.
pub(crate) fn not_found() -> Exhausted {
    Exhausted::by_method("no value of the level was found", "a bracket of the best value")
}

/// The best value between one that is found and one that no gain has; nothing is claimed where the search found no such one.
pub(crate) fn bracketed(
    level: Level,
    found: &Rational,
    not: Option<Rational>,
    stopped: Option<Exhausted>,
) -> (Best, Option<Exhausted>) {
    let [low, high] = level.scale();
    let end = if level.is_rising() { high } else { low };
    match not {
        Some(not) => (Best::Between([found.clone(), not]), stopped),
        None if stopped.is_some() => (Best::Nothing, stopped),
        // No damping is above 1, and no radius below 0.
        None if matches!(level, Level::Damping | Level::Radius) => (Best::Between([found.clone(), end]), None),
        None => {
            let beyond = "values beyond the ones that were tried";
            (
                Best::Nothing,
                Some(Exhausted::by_method("the search ends at a value of the level that some gains have", beyond)),
            )
        }
    }
}

/// A value of the scale far beyond one.
fn far_away(sample: &Rational, ends: &[Rational; 2]) -> Rational {
    let far = sample.abs() * Rational::from(1 << 20) + Rational::from(1 << 20);
    far.min((sample + &ends[1]) * Rational::new(1.into(), 2.into()))
}

/// Where gains are whose level has no bound: where they go as it grows, or all of an interval.
fn place_far(
    far: &Rational,
    level: Level,
    interval: &RequiredInterval,
    set_at: &dyn Fn(&Rational) -> Result<RequiredSet, Error>,
) -> Result<Place, Error> {
    if level == Level::PhaseMargin {
        return Ok(Place::From(outer(interval)));
    }
    let set = set_at(far)?;
    Ok(Place::From(outer(widest(&set).unwrap_or(interval))))
}

/// The best value at the end of a scale: a peak of zero, or none.
fn best_at_end(level: Level) -> Best {
    match level {
        Level::ComplementaryPeak | Level::Norm => Best::Zero,
        _ if is_without_end(level) || level == Level::PhaseMargin => Best::Unbounded,
        _ => {
            Best::Exact(Real::from(if level.is_rising() { level.scale()[1].clone() } else { level.scale()[0].clone() }))
        }
    }
}

/// Whether a gain has the best value of a level; `None` where that is not known.
fn has_level(lines: &Lines<'_>, level: Level, value: &Real, gain: &Rational) -> Result<Option<bool>, Error> {
    let named = [(lines.asked.gains[GAIN].name.clone(), gain.clone())];
    if matches!(level, Level::Decay | Level::Radius) {
        return Ok(match lines.bound_at(&named, level)? {
            Some(own) => Some(own.compare(value, lines.budget)?.is_eq()),
            None => Some(false),
        });
    }
    match value.exact() {
        // The ends of a scale are no requirements, nor are irrational numbers.
        Some(value) if !level.scale().contains(&value) => Ok(Some(lines.is_met(&named, Some(&value))?)),
        _ => Ok(None),
    }
}

/// Whether a level may grow without end.
pub(crate) fn is_without_end(level: Level) -> bool {
    level.scale()[1] > Rational::from(2)
}

/// The ends of the scale, the region that is asked for in any case among them.
pub(crate) fn scale(lines: &Lines<'_>, level: Level) -> [Rational; 2] {
    let [low, high] = level.scale();
    match (level, lines.least_bound()) {
        (Level::Decay, Some(least)) => [low.max(least.clone()), high],
        (Level::Radius, Some(most)) => [low, high.min(most.clone())],
        _ => [low, high],
    }
}

/// The level and what binds beside it.
fn with_level(level: Level, interval: &RequiredInterval) -> Vec<String> {
    let mut out = vec![level.name().to_owned()];
    for end in [&interval.lower, &interval.upper].into_iter().flatten() {
        if let RequiredEnd::Requirement { names, .. } = end {
            out.extend(names.iter().map(|name| (*name).to_owned()));
        }
    }
    out.sort();
    out.dedup();
    out
}

/// Where a value of a level was seen.
enum Spot {
    Point(Rational),
    Interval(Box<RequiredInterval>),
}

/// A bracket of a level: points first, since they are asked sooner than sets, then sets for what no gain has.
fn bracket(lines: &Lines<'_>, level: Level, plain: &RequiredSet, ends: &[Rational; 2]) -> Result<Outcome, Error> {
    let search = Search { ends: ends.clone(), is_rising: level.is_rising(), is_without_end: is_without_end(level) };
    let met = |scale: &Rational| -> Result<Option<Spot>, Error> {
        let set = lines.set(GAIN, None, Some(scale))?.into_value();
        match (widest(&set), set.undecided.first()) {
            (Some(interval), _) => Ok(Some(Spot::Interval(Box::new(interval.clone())))),
            (None, None) => Ok(None),
            (None, Some(bracket)) => {
                Err(Exhausted::by_method(bracket.why.clone(), "whether any gain has a level").into())
            }
        }
    };
    let seed = seed(lines, level, plain, ends)?.map(|(scale, gain)| (scale, Spot::Point(gain)));
    let found = search.bracket(lines, seed, &met)?;
    let Some((scale, spot)) = found.met else {
        // Some gains are stable, whatever level they have.
        return Ok(Optimum { stopped: found.stopped.or_else(|| Some(not_found())), ..some(plain) }.into());
    };
    let (place, found_at, binding) = match &spot {
        Spot::Point(gain) => (Place::Exact(gain.clone().into()), gain.clone(), vec![level.name().to_owned()]),
        Spot::Interval(interval) => {
            let place = match outer(interval) {
                (Some(low), Some(high)) => Place::Between([low, high]),
                _ => Place::Unbounded,
            };
            (place, point_inside(interval), with_level(level, interval))
        }
    };
    let (value, stopped) = bracketed(level, &scale, found.not, found.stopped);
    let optimum = Optimum::new(value, vec![place], vec![found_at], Some(scale));
    Ok(Optimum { binding, stopped, ..optimum }.into())
}
