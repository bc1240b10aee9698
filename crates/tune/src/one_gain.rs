//! The best value of one gain, or of a level over one gain.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::asked::Objective;
use crate::critical::Curves;
use crate::decimals::shortest;
use crate::lines::Lines;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{RealAlgebraic, rational_between, simplest_between};
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::response::{Level, RequiredEnd, RequiredInterval, RequiredSet};
use std::cmp::Ordering;

/// The gain that is free.
const GAIN: usize = 0;

/// The best of what is asked over one gain.
///
/// # Errors
/// As `Lines::set`.
pub(crate) fn best(lines: &Lines<'_>) -> Result<Outcome, Error> {
    match lines.asked.objective {
        Objective::Greatest(_) => best_gain(lines, true),
        Objective::Least(_) => best_gain(lines, false),
        Objective::Level(level) => best_level(lines, level),
        Objective::Anything => anything(lines),
    }
}

/// What is known where a set is empty.
pub(crate) fn nothing(set: &RequiredSet) -> Option<Outcome> {
    if !set.intervals.is_empty() {
        return None;
    }
    Some(match set.undecided.first() {
        None => Outcome::Infeasible { conflict: Vec::new() },
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
    Ok(Outcome::Optimum(Box::new(Optimum {
        value: Best::Nothing,
        at: Vec::new(),
        attained: true,
        binding: Vec::new(),
        found: vec![inside],
        found_value: None,
        typed: None,
        stopped: None,
    })))
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
                false,
            ),
            None => (Best::Unbounded, Place::Unbounded, Vec::new(), false),
        },
        (None, _) => (Best::Unbounded, Place::Unbounded, Vec::new(), false),
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
            (Best::Exact(end.value()), Place::Exact(end.value()), binding, attained)
        }
    };
    let stopped = match (&value, open) {
        (Best::Between(_) | Best::Unbounded, Some(bracket)) => {
            Some(Exhausted::by_method(bracket.why.clone(), "gains beyond those that are found"))
        }
        _ => None,
    };
    Ok(Outcome::Optimum(Box::new(Optimum {
        value,
        at: vec![at],
        attained,
        binding,
        found: vec![found.clone()],
        found_value: Some(found),
        typed: None,
        stopped,
    })))
}

/// A level: exactly where its boundary is algebraic, else in a bracket.
fn best_level(lines: &Lines<'_>, level: Level) -> Result<Outcome, Error> {
    let plain = lines.set(GAIN, None, None)?.into_value();
    if let Some(nothing) = nothing(&plain) {
        return Ok(nothing);
    }
    let ends = scale(lines, level);
    let curves = lines.problem()?.boundary_in_level(level, &lines.asked.requirements.list, lines.at(), lines.budget)?;
    let Some(curves) = curves else { return bracket(lines, level, &plain, &ends) };
    lines.budget.step("critical values");
    let curves = Curves::new(&curves, lines.budget)?;
    let heights = curves.heights(lines.range(GAIN), &ends, lines.budget)?;
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
    let Some(cell) = met else { return Ok(Outcome::Infeasible { conflict: Vec::new() }) };
    let wall = &walls[cell + 1];
    let sample = inside(cell);
    let is_end = cell + 2 == walls.len();
    // Beyond 180 degrees there is no phase margin: the open loop is smaller than 1 everywhere.
    let far = is_end && (is_without_end(level) || level == Level::PhaseMargin);
    if far {
        let set = set_at(&sample)?;
        let interval = widest(&set).expect("the cell is met");
        let place = place_far(&far_away(&sample, &ends), level, interval, &set_at)?;
        return Ok(Outcome::Optimum(Box::new(Optimum {
            value: best_at_end(level),
            at: vec![place],
            attained: false,
            binding: Vec::new(),
            found: vec![point_inside(interval)],
            found_value: Some(sample),
            typed: None,
            stopped: None,
        })));
    }
    let places = curves.places(lines.range(GAIN), lines.budget)?;
    let value = Real::from(wall.clone());
    let mut near = approach(lines, &value, &sample, &places, &set_at)?;
    let binding = with_level(level, &near.interval);
    let mut attained = is_attained(lines, &near.place, &plain)?;
    // On a plateau all gains of an interval have the best value; else it may be had at no one of them.
    if !matches!(near.place, Place::Exact(_)) {
        attained = has_level(lines, level, &value, &point_inside(&near.interval))?;
        if attained && matches!(near.place, Place::Unbounded) {
            near.place = Place::From(outer(&near.interval));
        }
    }
    Ok(Outcome::Optimum(Box::new(Optimum {
        attained,
        value: Best::Exact(value),
        at: vec![near.place],
        binding,
        found: vec![point_inside(&near.interval)],
        found_value: Some(near.height),
        typed: None,
        stopped: None,
    })))
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
pub(crate) fn best_at_end(level: Level) -> Best {
    match level {
        Level::ComplementaryPeak => Best::Zero,
        _ if is_without_end(level) || level == Level::PhaseMargin => Best::Unbounded,
        _ => {
            Best::Exact(Real::from(if level.is_rising() { level.scale()[1].clone() } else { level.scale()[0].clone() }))
        }
    }
}

/// Whether a gain has the best value of a level.
fn has_level(lines: &Lines<'_>, level: Level, value: &Real, gain: &Rational) -> Result<bool, Error> {
    let named = [(lines.asked.gains[GAIN].name.clone(), gain.clone())];
    if matches!(level, Level::Decay | Level::Radius) {
        return Ok(match lines.bound_at(&named, level)? {
            Some(own) => own.compare(value, lines.budget)?.is_eq(),
            None => false,
        });
    }
    match value.exact() {
        // At the end of the scale of the damping all roots are real.
        Some(end) if level == Level::Damping && end == level.scale()[1] => Ok(true),
        Some(value) => lines.is_met(&named, Some(&value)),
        None => Ok(false),
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

/// What is near to a best value.
pub(crate) struct Near {
    /// A value that some gains have.
    pub height: Rational,
    /// Gains that have it.
    pub interval: RequiredInterval,
    /// The gain at the best value.
    pub place: Place,
}

/// Whether a gain is strictly within the set in which everything but the level is met: then it has the best value.
fn is_attained(lines: &Lines<'_>, place: &Place, plain: &RequiredSet) -> Result<bool, Error> {
    let Place::Exact(x) = place else { return Ok(matches!(place, Place::Between(_))) };
    if let Some(value) = x.exact() {
        if plain.intervals.iter().any(|interval| interval.contains(&value)) {
            return Ok(true);
        }
        // A bound that is given is included.
        let gain = &lines.asked.gains[GAIN];
        let is_bound = gain.bounds.iter().flatten().any(|bound| *bound == value);
        return Ok(is_bound && lines.is_met(&[(gain.name.clone(), value)], None)?);
    }
    for interval in &plain.intervals {
        let beyond = |end: &Option<RequiredEnd>, side: Ordering| -> Result<bool, Error> {
            Ok(match end {
                None => false,
                Some(end) => end.value().compare(x, lines.budget)? != side,
            })
        };
        if !beyond(&interval.lower, Ordering::Less)? && !beyond(&interval.upper, Ordering::Greater)? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// So many digits of the best value are gone towards.
const DIGITS: [usize; 4] = [4, 10, 20, 40];

/// Goes towards a best value from inside: the gains that have values near to it, until one of the places at which a curve turns or meets another one is
/// left among them.
///
/// # Errors
/// As `Lines::set`.
pub(crate) fn approach(
    lines: &Lines<'_>,
    value: &Real,
    inside: &Rational,
    places: &[RealAlgebraic],
    set_at: &dyn Fn(&Rational) -> Result<RequiredSet, Error>,
) -> Result<Near, Error> {
    let mut last = None;
    for digits in DIGITS {
        lines.budget.step("gains near the best value");
        let height = toward(value, inside, digits);
        let set = set_at(&height)?;
        let Some(interval) = widest(&set) else { break };
        let (low, high) = outer(interval);
        let ends = [lines.range(0).lower.clone(), lines.range(0).upper.clone()];
        let is_in = |x: &RealAlgebraic| {
            low.as_ref().is_none_or(|low| x.compare_rational(low).is_ge())
                && high.as_ref().is_none_or(|high| x.compare_rational(high).is_le())
        };
        let candidates: Vec<RealAlgebraic> = lines.budget.enter(|| {
            let ends = ends.into_iter().flatten().map(RealAlgebraic::from_rational);
            places.iter().cloned().chain(ends).filter(is_in).collect()
        })?;
        let place = match (&candidates[..], &low, &high) {
            ([one], Some(low), Some(high)) if (high - low).abs() < width_for(digits, one) => {
                Place::Exact(one.clone().into())
            }
            (_, Some(low), Some(high)) => Place::Between([low.clone(), high.clone()]),
            _ => Place::Unbounded,
        };
        let is_exact = matches!(place, Place::Exact(_));
        last = Some(Near { height, interval: interval.clone(), place });
        if is_exact {
            break;
        }
    }
    Ok(last.expect("what is inside is met"))
}

/// Gains near a smooth optimum are as far apart as the square root of what is lost.
fn width_for(digits: usize, place: &RealAlgebraic) -> Rational {
    let unit = Rational::from(10).pow(-(digits as i64) / 4).expect("ten is not zero");
    let (low, high) = place.enclosure();
    let size = low.abs().max(high.abs());
    if size.is_zero() { unit } else { size * unit }
}

/// A rational number between a value inside and the best one, near to the latter by so many digits.
pub(crate) fn toward(value: &Real, inside: &Rational, digits: usize) -> Rational {
    let (low, high) = value.refined_to_digits(digits + 4).enclosure();
    let share = Rational::from(10).pow(-(digits as i64)).expect("ten is not zero");
    let inner = if *inside < low { &low } else { &high };
    let step = (inner - inside) * &share;
    let nearest = inner - step;
    // Few digits, strictly between.
    let half = Rational::new(1.into(), 2.into());
    let middle = (&nearest + inner) * half;
    let (a, b) = if nearest < middle { (&nearest, &middle) } else { (&middle, &nearest) };
    simplest_between(a, b).unwrap_or(nearest)
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
        return Ok(Outcome::Optimum(Box::new(Optimum {
            value: Best::Nothing,
            at: Vec::new(),
            attained: false,
            binding: Vec::new(),
            found: vec![widest(plain).map(point_inside).expect("it is not empty")],
            found_value: None,
            typed: None,
            stopped: found.stopped,
        })));
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
    let value = match found.not {
        Some(not) => Best::Between([scale.clone(), not]),
        None if found.stopped.is_some() => Best::Nothing,
        None => best_at_end(level),
    };
    Ok(Outcome::Optimum(Box::new(Optimum {
        value,
        at: vec![place],
        attained: false,
        binding,
        found: vec![found_at],
        found_value: Some(scale),
        typed: None,
        stopped: found.stopped,
    })))
}

/// So many points are asked at first, and so often the two beside the best one are.
const POINTS: i64 = 5;
const CLOSER: usize = 5;

/// A good gain by its margins at some points, with a value of the scale that it has at least; `None` where the level is no margin.
fn seed(
    lines: &Lines<'_>,
    level: Level,
    plain: &RequiredSet,
    ends: &[Rational; 2],
) -> Result<Option<(Rational, Rational)>, Error> {
    let Some((Some(low), Some(high))) = widest(plain).map(inner) else { return Ok(None) };
    let scale_at = |gain: &Rational| -> Result<Option<Rational>, Error> {
        lines.budget.step("margins at some gains");
        let named = [(lines.asked.gains[GAIN].name.clone(), gain.clone())];
        Ok(lines.level_at(&named, level)?.and_then(|value| scale_of(level, &value, ends)))
    };
    let better = |a: &Rational, b: &Rational| if level.is_rising() { a > b } else { a < b };
    let whole = &high - &low;
    let at = |share: &Rational| short_near(&(&low + &whole * share), &(&whole * &Rational::new(1.into(), 256.into())));
    let mut step = Rational::new(1.into(), (POINTS + 1).into());
    let mut best: Option<(Rational, Rational, Rational)> = None;
    let ask = |share: Rational, best: &mut Option<(Rational, Rational, Rational)>| -> Result<(), Error> {
        if !share.sign().is_gt() || share >= Rational::ONE {
            return Ok(());
        }
        let gain = at(&share);
        if let Some(scale) = scale_at(&gain)?
            && best.as_ref().is_none_or(|(known, ..)| better(&scale, known))
        {
            *best = Some((scale, gain, share));
        }
        Ok(())
    };
    for k in 1..=POINTS {
        ask(&step * &Rational::from(k), &mut best)?;
    }
    for _ in 0..CLOSER {
        let Some((_, _, share)) = best.clone() else { return Ok(None) };
        step = &step * &Rational::new(1.into(), 2.into());
        ask(&share - &step, &mut best)?;
        ask(&share + &step, &mut best)?;
    }
    let Some((scale, gain, _)) = best else { return Ok(None) };
    let named = [(lines.asked.gains[GAIN].name.clone(), gain.clone())];
    Ok(lines.is_met(&named, Some(&scale))?.then_some((scale, gain)))
}

/// A rational number of few digits near to another one.
fn short_near(x: &Rational, distance: &Rational) -> Rational {
    simplest_between(&(x - distance), &(x + distance)).unwrap_or_else(|| x.clone())
}

/// A value of the scale that a loop of this level has, near to the best such one.
fn scale_of(level: Level, value: &Enclosure, [low, high]: &[Rational; 2]) -> Option<Rational> {
    /// Halvings, and bits of what is compared.
    const HALVINGS: usize = 30;
    const BITS: u64 = 64;
    let has = |scale: &Rational| {
        level.enclosure(&Enclosure::from_rational(scale.clone()), BITS).is_some_and(|asked| {
            match level.is_greatest_best() {
                true => asked.upper() <= value.lower(),
                false => asked.lower() >= value.upper(),
            }
        })
    };
    let (worst, best) = if level.is_rising() { (low, high) } else { (high, low) };
    let half = Rational::new(1.into(), 2.into());
    // Levels without end: far from the end at first.
    let mut good = worst.clone();
    let mut bad = best.clone();
    if is_without_end(level) {
        let mut distance = Rational::ONE;
        while has(&(worst + &distance)) && worst + &distance < *best {
            good = worst + &distance;
            distance = &distance + &distance;
        }
        bad = (worst + &distance).min(best.clone());
    }
    for _ in 0..HALVINGS {
        let middle = (&good + &bad) * &half;
        if has(&middle) { good = middle } else { bad = middle }
    }
    (good != *worst).then_some(good)
}

/// A search for the best value of a scale by halving.
pub(crate) struct Search {
    pub ends: [Rational; 2],
    pub is_rising: bool,
    pub is_without_end: bool,
}

/// Between what is met and what is not.
pub(crate) struct Bracketed<T> {
    /// A value that is met, and with what.
    pub met: Option<(Rational, T)>,
    /// A value that is not met; `None` where there is none.
    pub not: Option<Rational>,
    /// What ended the search before the gap was reached.
    pub stopped: Option<Exhausted>,
}

/// So often the first value is halved or doubled.
const DOUBLINGS: usize = 48;

impl Search {
    /// A value at a distance from the worst end.
    fn at(&self, distance: &Rational) -> Rational {
        if self.is_rising { &self.ends[0] + distance } else { &self.ends[1] - distance }
    }

    fn distance(&self, value: &Rational) -> Rational {
        if self.is_rising { value - &self.ends[0] } else { &self.ends[1] - value }
    }

    /// A distance that is less than the whole one.
    fn within(&self, distance: Rational, whole: &Rational) -> Rational {
        let half = Rational::new(1.into(), 2.into());
        let most = match self.is_without_end {
            true => whole.clone(),
            false => whole - tiny() * half,
        };
        distance.min(most)
    }

    /// Halves until the gap of the question is reached, or the work ends.
    ///
    /// # Errors
    /// Those of the question that are no end of the work.
    pub fn bracket<T>(
        &self,
        lines: &Lines<'_>,
        seed: Option<(Rational, T)>,
        met: &dyn Fn(&Rational) -> Result<Option<T>, Error>,
    ) -> Result<Bracketed<T>, Error> {
        let half = Rational::new(1.into(), 2.into());
        let whole = &self.ends[1] - &self.ends[0];
        // Distances from the worst end.
        let mut low = seed.as_ref().map(|(value, _)| self.distance(value));
        let mut high: Option<Rational> = None;
        // Beyond a good value by less than the gap at first, then by four times as much.
        let mut step = low.as_ref().map(|low| low * &lines.asked.gap * &half);
        let mut out = Bracketed { met: seed, not: None, stopped: None };
        let mut next = match (&low, &step) {
            (Some(low), Some(step)) => self.within(low + step, &whole),
            _ if self.is_without_end => Rational::ONE,
            _ => &whole * &half,
        };
        for _ in 0..2 * DOUBLINGS {
            lines.budget.step("a bracket of the best value");
            let value = self.at(&next);
            match met(&value) {
                Ok(Some(found)) => {
                    out.met = Some((value, found));
                    low = Some(next.clone());
                }
                Ok(None) => {
                    out.not = Some(value);
                    high = Some(next.clone());
                }
                Err(Error::Stopped(stopped)) => {
                    out.stopped = Some(stopped);
                    return Ok(out);
                }
                Err(error) => return Err(error),
            }
            next = match (&low, &high) {
                (None, Some(high)) if *high < tiny() => return Ok(out),
                (None, Some(high)) => high * &half,
                (Some(low), None) if step.is_some() && &whole - low > tiny() => {
                    let longer = step.as_ref().expect("it was just seen") * &Rational::from(4);
                    let next = self.within(low + &longer, &whole);
                    step = Some(longer);
                    next
                }
                (Some(low), None) if self.is_without_end => {
                    if *low >= &whole * &half {
                        return Ok(out);
                    }
                    low + low
                }
                (Some(low), None) if &whole - low < tiny() => return Ok(out),
                (Some(low), None) => (low + &whole) * &half,
                (Some(low), Some(high)) => {
                    let width = high - low;
                    if width <= high * &lines.asked.gap {
                        return Ok(out);
                    }
                    let third = &width * &Rational::new(1.into(), 3.into());
                    simplest_between(&(low + &third), &(high - &third)).expect("a third is left")
                }
                (None, None) => unreachable!("one of them was just found"),
            };
        }
        Ok(out)
    }
}

/// Distances below this are not looked for.
fn tiny() -> Rational {
    Rational::new(1.into(), jurist_algebra::number::Integer::ONE << 40_u64)
}

/// The interval of the greatest width.
pub(crate) fn widest(set: &RequiredSet) -> Option<&RequiredInterval> {
    let width = |interval: &&RequiredInterval| match outer(interval) {
        (Some(low), Some(high)) => Some(high - low),
        _ => None,
    };
    set.intervals.iter().max_by(|a, b| match (width(a), width(b)) {
        (None, None) => Ordering::Equal,
        (None, Some(_)) => Ordering::Greater,
        (Some(_), None) => Ordering::Less,
        (Some(a), Some(b)) => a.cmp(&b),
    })
}

/// Rational numbers outside of both ends.
pub(crate) fn outer(interval: &RequiredInterval) -> (Option<Rational>, Option<Rational>) {
    /// Digits of the ends.
    const DIGITS: usize = 24;
    let end = |end: &Option<RequiredEnd>| end.as_ref().map(|end| end.value().refined_to_digits(DIGITS).enclosure());
    (end(&interval.lower).map(|(low, _)| low), end(&interval.upper).map(|(_, high)| high))
}

/// The shortest decimal in the inner half, or the simplest rational number.
pub(crate) fn point_inside(interval: &RequiredInterval) -> Rational {
    let quarter = Rational::new(1.into(), 4.into());
    match inner(interval) {
        (Some(low), Some(high)) => {
            let step = (&high - &low) * quarter;
            let (from, to) = (&low + &step, &high - &step);
            shortest(&from, &to, &from).or_else(|| simplest_between(&from, &to)).unwrap_or(low)
        }
        (Some(low), None) => Rational::from(low.floor()) + Rational::from(2),
        (None, Some(high)) => Rational::from(high.floor()) - Rational::ONE,
        (None, None) => Rational::ZERO,
    }
}

/// Rational numbers inside of both ends, or on them.
fn inner(interval: &RequiredInterval) -> (Option<Rational>, Option<Rational>) {
    for digits in [12, 24, 48, 96] {
        let end = |end: &Option<RequiredEnd>| end.as_ref().map(|end| end.value().refined_to_digits(digits).enclosure());
        let ends = (end(&interval.lower).map(|(_, high)| high), end(&interval.upper).map(|(low, _)| low));
        match &ends {
            (Some(low), Some(high)) if low >= high => {}
            _ => return ends,
        }
    }
    let exact = |end: &Option<RequiredEnd>| end.as_ref().map(|end| end.value().enclosure().0);
    (exact(&interval.lower), exact(&interval.upper))
}

/// A rational number in the interval near to one of its ends.
fn near_end(interval: &RequiredInterval, is_upper: bool) -> Rational {
    let inside = point_inside(interval);
    match if is_upper { &interval.upper } else { &interval.lower } {
        Some(end) => toward(&end.value(), &inside, 6),
        None => inside,
    }
}

/// Whether the end itself is in the set.
pub(crate) fn is_closed(end: &RequiredEnd) -> bool {
    match end {
        RequiredEnd::Stability(end) => end.closed,
        RequiredEnd::Requirement { closed, .. } => *closed,
    }
}

/// What binds at an end.
pub(crate) fn names(end: &RequiredEnd) -> Vec<String> {
    match end {
        RequiredEnd::Stability(end) => vec![end.causes.to_string()],
        RequiredEnd::Requirement { names, .. } => names.iter().map(|name| (*name).to_owned()).collect(),
    }
}
