//! The best value of a level over one gain: exactly where its boundary is algebraic, else in a bracket.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::critical::Curves;
use crate::lines::Lines;
use crate::near::{Near, approach, is_attained, toward};
use crate::one_gain::{GAIN, nothing};
use crate::search::Search;
use crate::seed::seed;
use crate::sets::{bound_of, on_bound, outer, point_inside, widest};
use crate::typed::named;
use jurist_algebra::limits::{Exhausted, apart};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{RealAlgebraic, rational_between};
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::response::{Level, RequiredEnd, RequiredInterval, RequiredSet};

/// The best value of a level.
///
/// # Errors
/// As `Lines::set`.
pub(crate) fn best_level(lines: &Lines<'_>, level: Level) -> Result<Outcome, Error> {
    let plain = lines.set(GAIN, None, None)?.into_value();
    if let Some(nothing) = nothing(&plain) {
        return Ok(nothing);
    }
    match lines.part(|| best_within(lines, level, &plain)) {
        // Some gains are stable, whatever level they have.
        Err(Error::Stopped(stopped)) => Ok(apart(|| Optimum { stopped: Some(stopped), ..some(&plain) }.into())),
        found => found,
    }
}

/// The best value, some gains being stable.
fn best_within(lines: &Lines<'_>, level: Level, plain: &RequiredSet) -> Result<Outcome, Error> {
    let ends = scale(lines, level);
    let curves = lines.problem()?.boundary_in_level(
        (level, lines.asked.between()),
        &lines.asked.requirements.list,
        lines.at(),
        lines.budget,
    )?;
    let Some(curves) = curves else { return bracket(lines, level, plain, &ends) };
    lines.budget.step("critical values");
    let curves = Curves::new(&curves, lines.budget)?;
    let walls = Walls::new(lines, level, &curves, ends)?;
    let set_at =
        |scale: &Rational| -> Result<RequiredSet, Error> { Ok(lines.set(GAIN, None, Some(scale))?.into_value()) };
    let halved = walls.halved(lines, &set_at)?;
    let Some((cell, interval)) = &halved.met else {
        return Ok(Optimum { stopped: halved.stopped.or_else(|| Some(not_found())), ..some(plain) }.into());
    };
    if let Some(stopped) = halved.stopped.clone() {
        return Ok(apart(|| walls.so_far(level, (*cell, interval), halved.not, stopped)).into());
    }
    let sample = walls.inside(*cell);
    if walls.is_far(level, *cell) {
        let far = far_away(&sample, level, &walls.ends);
        let set = set_at(&far)?;
        let near = widest(&set).map_or((interval, sample.clone()), |near| (near, far));
        return Ok(best_far(lines, level, near, (interval, sample))?.into());
    }
    let value = Real::from(walls.walls[cell + 1].clone());
    let found = lines.part(|| {
        let places = curves.places(lines.range(GAIN), lines.budget)?;
        let near = approach(lines, &value, &sample, &places, &set_at)?;
        at_wall(lines, (level, &value), near, plain)
    });
    match found {
        // The value is known, and where it is had is not.
        Err(Error::Stopped(stopped)) => {
            let found = apart(|| vec![point_inside(interval)]);
            let optimum = Optimum::new(Best::Exact(value), Vec::new(), found, Some(sample));
            Ok(Optimum { stopped: Some(stopped), ..optimum }.into())
        }
        found => Ok(found?.into()),
    }
}

/// What is known at a best value that is known exactly.
fn at_wall(
    lines: &Lines<'_>,
    (level, value): (Level, &Real),
    mut near: Near,
    plain: &RequiredSet,
) -> Result<Optimum, Error> {
    let mut attained = is_attained(lines, &near.place, plain)?;
    // On a plateau all gains of an interval have the best value; else it may be had at no one of them.
    if !near.is_point() {
        let inside = point_inside(&near.interval);
        attained = has_level(lines, level, value, &inside)?;
        if attained == Some(true) {
            near.place = plateau(lines, level, value, &inside)?;
        }
    }
    let binding = binding(lines, level, &near);
    let on_bound = if let Place::Exact(x) = &near.place { on_bound(x, &binding, attained) } else { None };
    // The gain on its bound has the best value itself.
    let height = if on_bound.is_some() { toward(value, &near.height, 12) } else { near.height };
    let found = vec![on_bound.unwrap_or_else(|| point_inside(&near.interval))];
    let optimum = Optimum::new(Best::Exact(value.clone()), vec![near.place], found, Some(height));
    Ok(Optimum { attained, binding, ..optimum })
}

/// All gains of an interval that have the best value, where that is known of each of them; else a gain inside that has it.
fn plateau(lines: &Lines<'_>, level: Level, value: &Real, inside: &Rational) -> Result<Place, Error> {
    let one = || Place::Exact(inside.clone().into());
    // What is required of a margin is met with equality too; a region has its roots strictly inside.
    let exact = value.exact().filter(|_| !matches!(level, Level::Decay | Level::Radius));
    let Some(value) = exact else { return Ok(one()) };
    let set = lines.set(GAIN, None, Some(&value))?.into_value();
    let found = set.intervals.iter().find(|interval| interval.contains(inside));
    Ok(found.map_or_else(one, |interval| Place::From(outer(interval))))
}

/// Critical values of a level, from the worst to the best.
struct Walls {
    walls: Vec<RealAlgebraic>,
    /// The ends of the scale that is looked at.
    ends: [Rational; 2],
}

/// The last cell between two walls that some gains have, with such gains, and the first one that none have, where one was asked.
struct Halved {
    met: Option<(usize, RequiredInterval)>,
    not: Option<usize>,
    stopped: Option<Exhausted>,
}

impl Walls {
    fn new(lines: &Lines<'_>, level: Level, curves: &Curves, ends: [Rational; 2]) -> Result<Walls, Error> {
        let [low, high] = &ends;
        let top = if is_without_end(level) { None } else { Some(high) };
        let heights = curves.heights(lines.range(GAIN), [Some(low), top], lines.budget)?;
        // Beyond the last critical value nothing changes: what is met there is met without end.
        let above = |last: &RealAlgebraic| Rational::from(last.floor()) * Rational::from(2) + Rational::from(2);
        let ends = match heights.last() {
            Some(last) if top.is_none() => [low.clone(), above(last).max(high.clone())],
            _ => ends,
        };
        let mut walls = vec![RealAlgebraic::from_rational(ends[0].clone())];
        walls.extend(heights);
        walls.push(RealAlgebraic::from_rational(ends[1].clone()));
        if !level.is_rising() {
            walls.reverse();
        }
        Ok(Walls { walls, ends })
    }

    fn inside(&self, cell: usize) -> Rational {
        rational_between(&self.walls[cell], &self.walls[cell + 1]).expect("they differ")
    }

    /// What is met with more is met with less: the best cell by halving.
    fn halved(
        &self,
        lines: &Lines<'_>,
        set_at: &dyn Fn(&Rational) -> Result<RequiredSet, Error>,
    ) -> Result<Halved, Error> {
        let mut out = Halved { met: None, not: None, stopped: None };
        let (mut first, mut last) = (0, self.walls.len() - 1);
        while first < last {
            let middle = (first + last) / 2;
            lines.budget.step("whether any gain has a level");
            let set = match lines.part(|| set_at(&self.inside(middle))) {
                Err(Error::Stopped(stopped)) => return Ok(Halved { stopped: Some(stopped), ..out }),
                set => set?,
            };
            match (widest(&set), nothing(&set)) {
                (Some(interval), _) => {
                    out.met = Some((middle, interval.clone()));
                    first = middle + 1;
                }
                (None, Some(Outcome::Open { stopped, .. })) => return Ok(Halved { stopped: Some(stopped), ..out }),
                (None, _) => {
                    out.not = Some(middle);
                    last = middle;
                }
            }
        }
        Ok(out)
    }

    /// The bracket between a cell that some gains have and one that none have.
    fn so_far(
        &self,
        level: Level,
        (cell, interval): (usize, &RequiredInterval),
        not: Option<usize>,
        stopped: Exhausted,
    ) -> Optimum {
        let (sample, not) = (self.inside(cell), not.map(|cell| self.inside(cell)));
        let (value, stopped) = bracketed(level, &sample, not, Some(stopped));
        let found = point_inside(interval);
        let optimum = Optimum::new(value, vec![Place::Exact(found.clone().into())], vec![found], Some(sample));
        Optimum { stopped, ..optimum }
    }

    /// Whether a cell is the last one of a scale that has no end.
    fn is_far(&self, level: Level, cell: usize) -> bool {
        cell + 2 == self.walls.len() && (is_without_end(level) || level == Level::PhaseMargin)
    }
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
                Some(Exhausted::by_method(
                    "some gains have the last value that is tried, and no bound was found",
                    beyond,
                )),
            )
        }
    }
}

/// Whether gains have every value of a margin: nothing limits it there.
pub(crate) fn is_unbounded_at(lines: &Lines<'_>, level: Level, gains: &[Rational]) -> Result<bool, Error> {
    let may_be = matches!(level, Level::PhaseMargin | Level::GainMargin | Level::DelayMargin);
    Ok(may_be && lines.has_no_bound(&named(lines, gains), level)?)
}

/// A value of the scale far beyond one, or close to the end of the scale.
fn far_away(sample: &Rational, level: Level, [low, high]: &[Rational; 2]) -> Rational {
    let million = Rational::from(1 << 20);
    if level == Level::PhaseMargin {
        return low + (sample - low) / million;
    }
    let far = sample.abs() * &million + million;
    far.min((sample + high) * Rational::new(1.into(), 2.into()))
}

/// The best value at the end of a scale, with an interval that comes near to it; an example of gains is one that has it, else one with the value of a sample.
fn best_far(
    lines: &Lines<'_>,
    level: Level,
    (near, far): (&RequiredInterval, Rational),
    (interval, sample): (&RequiredInterval, Rational),
) -> Result<Optimum, Error> {
    let named = |x: &Rational| [(lines.asked.gains[GAIN].name.clone(), x.clone())];
    let value = best_at_end(level);
    if matches!(value, Best::Zero) {
        let zero = Rational::ZERO;
        let is_zero = |peak: Enclosure| peak.lower().is_zero() && peak.upper().is_zero();
        // An open loop of zero has no peak of its own.
        if lines.is_met(&named(&zero), Some(&sample))?
            && (lines.level_at(&named(&zero), level)?.is_some_and(is_zero)
                || lines.has_no_bound(&named(&zero), level)?)
        {
            return Ok(Optimum::new(value, vec![Place::Exact(zero.clone().into())], vec![zero], None));
        }
    } else if matches!(level, Level::PhaseMargin | Level::GainMargin) {
        let inside = point_inside(near);
        if lines.is_met(&named(&inside), None)? && lines.has_no_bound(&named(&inside), level)? {
            return Ok(Optimum::new(value, Vec::new(), vec![inside], None));
        }
    }
    // Close to 180 degrees: whether no phase limits some other loop is not known.
    Ok(match level {
        Level::PhaseMargin => Optimum::new(Best::Nothing, Vec::new(), vec![point_inside(near)], Some(far)),
        _ => Optimum::new(value, Vec::new(), vec![point_inside(interval)], Some(sample)),
    })
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

/// What binds at a best value: a bound of the gain, else the level and the requirements beside it.
fn binding(lines: &Lines<'_>, level: Level, near: &Near) -> Vec<String> {
    let range = lines.range(GAIN);
    let is_at = |end: &Option<Rational>| match (&near.place, end) {
        (Place::Exact(x), Some(end)) => x.compare_rational(end).is_eq(),
        _ => false,
    };
    if is_at(&range.lower) || is_at(&range.upper) {
        return vec![bound_of(&lines.asked.gains[GAIN].name)];
    }
    with_level(level, &near.interval)
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
    // Gains with a level are stable ones.
    let reach = |one: Option<&RequiredInterval>, by: i64, is_upper: bool| {
        let (low, high) = one.map(outer)?;
        Some(Rational::from(if is_upper { high } else { low }?.floor()) + Rational::from(by))
    };
    let ends_of_stable = [reach(plain.intervals.first(), -1, false), reach(plain.intervals.last(), 2, true)];
    let lines =
        &if plain.undecided.is_empty() { lines.within(GAIN, ends_of_stable) } else { lines.within(GAIN, [None, None]) };
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
            let gain = point_inside(interval);
            (Place::Exact(gain.clone().into()), gain, with_level(level, interval))
        }
    };
    if found.not.is_none() && is_unbounded_at(lines, level, std::slice::from_ref(&found_at))? {
        return Ok(Optimum::new(Best::Unbounded, Vec::new(), vec![found_at], None).into());
    }
    let (value, stopped) = bracketed(level, &scale, found.not, found.stopped);
    let optimum = Optimum::new(value, vec![place], vec![found_at], Some(scale));
    Ok(Optimum { binding, stopped, ..optimum }.into())
}
