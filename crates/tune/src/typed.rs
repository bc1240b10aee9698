//! The gains that are typed in: few digits, and what they cost.

use crate::answer::{Best, Optimum, Place};
use crate::asked::Objective;
use crate::centre::{Centre, Measure};
use crate::decimals::{first_power, power, shortest};
use crate::lines::Lines;
use crate::parts::Parts;
use crate::reading::Reading;
use crate::sets::{inner, outer};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::real::Real;
use jurist_engine::error::Error;
use jurist_engine::response::{Level, RequiredEnd, RequiredInterval, RequirementMet};
use std::rc::Rc;

/// Gains of few digits that meet all requirements.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Typed {
    /// The gains, in the order in which they were asked for.
    pub values: Vec<Rational>,
    /// What they have of the level, or the gain itself, enclosed; `None` where that is not a number.
    pub value: Option<Enclosure>,
    /// The requirements there.
    pub requirements: Vec<RequirementMet>,
}

/// Bits of enclosures.
const BITS: u64 = 64;

/// What is given up where nothing else is said: a hundredth.
const LOSS: (i64, i64) = (1, 100);

/// Short gains near an optimum; `None` where the optimum is no number.
pub(crate) fn typed(lines: &Lines<'_>, optimum: &Optimum) -> Result<Option<Typed>, Error> {
    let loss = lines.asked.loss.clone().unwrap_or_else(|| Rational::new(LOSS.0.into(), LOSS.1.into()));
    let (Some(inside), Some(best)) = (&optimum.found_value, best_of(optimum)) else { return Ok(None) };
    for values in candidates(lines, optimum, (inside, &best), &loss)? {
        if !lines.asked.for_all.is_empty() {
            // What a level is with the worst plant is not known.
            let value = if lines.asked.level().is_none() { value_at(lines, &values)? } else { None };
            return Ok(Some(Typed { values, value, requirements: Vec::new() }));
        }
        let named = named(lines, &values);
        if !lines.is_met(&named, None)? {
            continue;
        }
        let (_, requirements) = lines.point(&named, None)?;
        let value = value_at(lines, &values)?;
        return Ok(Some(Typed { values, value, requirements }));
    }
    Ok(None)
}

/// Short gains that give up a share of the best value at most, the shortest first.
fn candidates(
    lines: &Lines<'_>,
    optimum: &Optimum,
    (inside, best): (&Rational, &Rational),
    loss: &Rational,
) -> Result<Vec<Vec<Rational>>, Error> {
    let given_up_of_gain = || best - best.abs() * signed(&lines.asked.objective, loss);
    let found = match (&lines.asked.objective, lines.asked.gains.len()) {
        (Objective::Greatest(gain) | Objective::Least(gain), _) if optimum.cells.is_some() => {
            let (low, high) = sorted(given_up_of_gain(), best.clone());
            by_trial(lines, &optimum.found, None, |values| low <= values[*gain] && values[*gain] <= high)?
        }
        (Objective::Greatest(gain) | Objective::Least(gain), _) if best.is_zero() && optimum.attained != Some(true) => {
            return near_zero(lines, *gain, inside, optimum);
        }
        (Objective::Greatest(gain) | Objective::Least(gain), count) => {
            // The best value itself, where it is one that gains have.
            let nearest = match &optimum.value {
                Best::Exact(value) if optimum.attained == Some(true) && count == 1 => {
                    value.exact().unwrap_or_else(|| inside.clone())
                }
                _ => inside.clone(),
            };
            let (low, high) = sorted(given_up_of_gain(), nearest.clone());
            let Some(height) = shortest(&low, &high, &nearest) else { return Ok(Vec::new()) };
            if count > 1 {
                return beside(lines, *gain, &height, optimum);
            }
            Some(vec![height])
        }
        (Objective::Formula { is_greatest, .. }, _) => {
            let given_up = given_up_of_gain();
            let value = |values: &[Rational]| lines.formula.as_ref().and_then(|formula| formula.at(values));
            let is_enough = |x: Rational| if *is_greatest { x >= given_up } else { x <= given_up };
            by_trial(lines, &optimum.found, None, |values| value(values).is_some_and(is_enough))?
        }
        (Objective::Level(_) | Objective::SettlingTime(_) | Objective::Norm(_), count) => {
            let level = lines.asked.level().expect("one of these");
            let scale = given_up((level, &Reading::of(lines.asked)), inside, best, loss);
            if count == 1 && matches!(optimum.value, Best::Exact(_)) {
                let set = lines.set(0, None, Some(&scale))?;
                // Where gains go to infinity the least ones are enough.
                let near = optimum.at.first().and_then(middle).unwrap_or(Rational::ZERO);
                return Ok(short_in(&set.value().intervals, &near).into_iter().map(|x| vec![x]).collect());
            }
            by_trial(lines, &optimum.found, Some(&scale), |_| true)?
        }
        (Objective::Tolerance(measure), _) => {
            let value = best - (best - measure.least()) * loss;
            if lines.asked.gains.len() == 1 {
                return Ok(middle_of_one(lines, *measure, (&value, &optimum.found[0]))?.into_iter().collect());
            }
            by_trial(lines, &optimum.found, Some(&value.min(inside.clone())), |_| true)?
        }
        (Objective::Anything, _) => None,
    };
    Ok(found.into_iter().collect())
}

/// Distances from a best value of 0 that are tried, as powers of ten: 0 has no share that may be lost.
const NEAR_ZERO: [i64; 5] = [-2, -4, -6, -9, -12];

/// Short gains beside a best value of 0 that no gain has, the farthest first.
fn near_zero(
    lines: &Lines<'_>,
    gain: usize,
    inside: &Rational,
    optimum: &Optimum,
) -> Result<Vec<Vec<Rational>>, Error> {
    let range = lines.range(gain);
    let size = match (&range.lower, &range.upper) {
        (Some(low), Some(high)) => (high - low).min(Rational::ONE),
        _ => Rational::ONE,
    };
    let mut all = Vec::new();
    for exponent in NEAR_ZERO {
        let far = &size * &power(exponent);
        let far = if inside.is_negative() { -far } else { far };
        let (low, high) = sorted(&far * &Rational::new(1.into(), 2.into()), far.clone());
        let Some(height) = shortest(&low, &high, &far) else { continue };
        match lines.asked.gains.len() {
            1 => all.push(vec![height]),
            _ => all.extend(beside(lines, gain, &height, optimum)?),
        }
        if lines.asked.gains.len() > 1 && !all.is_empty() {
            break;
        }
    }
    Ok(all)
}

/// What gains have of the objective, enclosed; `None` where that is not a number.
fn value_at(lines: &Lines<'_>, values: &[Rational]) -> Result<Option<Enclosure>, Error> {
    let named = named(lines, values);
    Ok(match lines.asked.objective {
        Objective::Greatest(gain) | Objective::Least(gain) => Some(Enclosure::from_rational(values[gain].clone())),
        Objective::Formula { .. } => {
            let value = lines.formula.as_ref().and_then(|formula| formula.at(values));
            value.map(Enclosure::from_rational)
        }
        Objective::Level(level) => level_at(lines, level, &named)?,
        Objective::Norm(_) => level_at(lines, Level::Norm, &named)?,
        Objective::SettlingTime(level) => {
            let found = level_at(lines, level, &named)?;
            found.and_then(|x| Reading::of(lines.asked).enclosure(&x, BITS))
        }
        // How far its neighbours are good is not looked up again.
        Objective::Tolerance(_) | Objective::Anything => None,
    })
}

/// The shortest gain that has a tolerance, near to one that does.
fn middle_of_one(
    lines: &Lines<'_>,
    measure: Measure,
    (value, near): (&Rational, &Rational),
) -> Result<Option<Vec<Rational>>, Error> {
    let set = lines.set(0, None, None)?;
    let interval = set.value().intervals.iter().find(|interval| interval.contains(near));
    let Some((Some(low), Some(high))) = interval.map(inner) else { return Ok(None) };
    // What has exactly this tolerance at either end.
    let other = |share: Rational, x: &Rational| x.checked_div(&share);
    let ends = match measure {
        Measure::Absolute => [Some(&low + value), Some(&high - value)],
        Measure::Ratio if high.sign().is_gt() => [Some(&low * value), other(value.clone(), &high)],
        Measure::Ratio => [other(value.clone(), &low), Some(&high * value)],
        Measure::Relative if high.sign().is_gt() => {
            [other(Rational::ONE - value, &low), other(Rational::ONE + value, &high)]
        }
        Measure::Relative => [other(Rational::ONE + value, &low), other(Rational::ONE - value, &high)],
    };
    let [Some(from), Some(to)] = ends else { return Ok(None) };
    // 0 is the shortest number, and no gain with a tolerance.
    let half = || near * &Rational::new(1.into(), 2.into());
    let (from, to) = (if from.is_zero() { half() } else { from }, if to.is_zero() { half() } else { to });
    Ok(shortest(&from, &to, near).filter(|_| from <= to).map(|x| vec![x]))
}

pub(crate) fn named(lines: &Lines<'_>, values: &[Rational]) -> Vec<(String, Rational)> {
    lines.asked.gains.iter().map(|gain| gain.name.clone()).zip(values.iter().cloned()).collect()
}

/// The best value as a number near to it.
fn best_of(optimum: &Optimum) -> Option<Rational> {
    match &optimum.value {
        Best::Exact(value) => {
            let (low, high) = value.refined_to_digits(20).enclosure();
            Some((low + high) * Rational::new(1.into(), 2.into()))
        }
        Best::Between([found, _]) => Some(found.clone()),
        Best::Unbounded | Best::Zero | Best::Nothing => None,
    }
}

fn signed(objective: &Objective, loss: &Rational) -> Rational {
    if matches!(objective, Objective::Least(_) | Objective::Formula { is_greatest: false, .. }) {
        -loss
    } else {
        loss.clone()
    }
}

fn sorted(a: Rational, b: Rational) -> (Rational, Rational) {
    if a <= b { (a, b) } else { (b, a) }
}

/// A value of the scale at which a share of the level is given up, or less; between one that is found and the worst end.
fn given_up((level, reading): (Level, &Reading), found: &Rational, best: &Rational, loss: &Rational) -> Rational {
    /// Halvings.
    const HALVINGS: usize = 24;
    let shown = |scale: &Rational| reading.enclosure(&Enclosure::from_rational(scale.clone()), BITS);
    let Some(best) = shown(best) else { return found.clone() };
    let share = if reading.is_greatest_best() { Rational::ONE - loss } else { Rational::ONE + loss };
    let wanted = best.mul(&Enclosure::from_rational(share), BITS);
    let is_enough = |scale: &Rational| {
        shown(scale).is_some_and(|x| match reading.is_greatest_best() {
            true => x.lower() >= wanted.upper(),
            false => x.upper() <= wanted.lower(),
        })
    };
    let [low, high] = level.scale();
    let mut bad = if level.is_rising() { low } else { high };
    let mut good = found.clone();
    let half = Rational::new(1.into(), 2.into());
    for _ in 0..HALVINGS {
        let middle = (&bad + &good) * &half;
        if is_enough(&middle) { good = middle } else { bad = middle }
    }
    good
}

/// The middle of where a gain is.
fn middle(place: &Place) -> Option<Rational> {
    let half = Rational::new(1.into(), 2.into());
    match place {
        Place::Exact(x) => {
            let (low, high) = x.refined_to_digits(12).enclosure();
            Some((low + high) * half)
        }
        Place::Between([low, high]) => Some((low + high) * half),
        Place::From((Some(low), Some(high))) => Some((low + high) * half),
        Place::From(_) | Place::Unbounded => None,
    }
}

/// The shortest decimals in the interval that holds a number, or in the first one: with its ends, which may be in the set, and strictly inside.
fn short_in(intervals: &[RequiredInterval], near: &Rational) -> Vec<Rational> {
    let Some(interval) = intervals.iter().find(|interval| interval.contains(near)).or(intervals.first()) else {
        return Vec::new();
    };
    [true, false].into_iter().filter_map(|with_ends| short_inside(interval, near, with_ends)).collect()
}

fn short_inside(interval: &RequiredInterval, near: &Rational, with_ends: bool) -> Option<Rational> {
    let (low, high) = outer(interval);
    let thousandth = Rational::new(1.into(), 1000.into());
    // How far inside of an end: an end of stability is not in the set, and one that is irrational is no decimal.
    let off = |end: &Option<RequiredEnd>, step: Rational| {
        let is_number = end.as_ref().is_some_and(|end| end.value().exact().is_some());
        if with_ends && is_number { Rational::ZERO } else { step }
    };
    // An end at 0 has no size of its own.
    let size = |end: &Rational| if end.is_zero() { Rational::ONE } else { end.abs() };
    let (low, high) = match (low, high) {
        (Some(low), Some(high)) => {
            let step = (&high - &low) * thousandth;
            (low + off(&interval.lower, step.clone()), high - off(&interval.upper, step))
        }
        (Some(low), None) => {
            let from = &low + off(&interval.lower, size(&low) * &thousandth);
            (from, near.abs() + low.abs() * Rational::from(2) + Rational::ONE)
        }
        (None, Some(high)) => {
            let to = &high - off(&interval.upper, size(&high) * &thousandth);
            (-(near.abs() + high.abs() * Rational::from(2) + Rational::ONE), to)
        }
        (None, None) => return Some(Rational::ZERO),
    };
    let near = near.clone().max(low.clone()).min(high.clone());
    shortest(&low, &high, &near)
}

/// The other gain, short, for a value of the one that is best.
fn beside(lines: &Lines<'_>, gain: usize, height: &Rational, optimum: &Optimum) -> Result<Vec<Vec<Rational>>, Error> {
    let set = lines.set(1 - gain, Some((gain, height)), None)?;
    let near = optimum.at.get(1 - gain).and_then(middle).unwrap_or_else(|| optimum.found[1 - gain].clone());
    let others = short_in(&set.value().intervals, &near).into_iter();
    let both = |other| if gain == 0 { vec![height.clone(), other] } else { vec![other, height.clone()] };
    Ok(others.map(both).collect())
}

/// A gain below this power of ten of its bounds, or of 1, is tried as 0.
const TINY: i64 = -6;

/// The nearest points of few digits within the bounds, until one is good and meets all.
fn by_trial(
    lines: &Lines<'_>,
    found: &[Rational],
    scale: Option<&Rational>,
    is_good: impl Fn(&[Rational]) -> bool,
) -> Result<Option<Vec<Rational>>, Error> {
    let is_within = |values: &[Rational]| {
        let mut all = values.iter().enumerate().map(|(i, x)| (lines.range(i), x));
        all.all(|(range, x)| {
            range.lower.as_ref().is_none_or(|low| low <= x) && range.upper.as_ref().is_none_or(|high| x <= high)
        })
    };
    /// Significant digits.
    const DIGITS: std::ops::RangeInclusive<i64> = 1..=8;
    let parts = match (lines.asked.for_all.is_empty(), &lines.asked.objective) {
        (_, Objective::Tolerance(measure)) => {
            let mut parts = Parts::new(lines, 0)?;
            parts.centre = Some(Rc::new(Centre::new(*measure, &parts.whole)));
            Some(parts)
        }
        (true, _) => None,
        (false, _) => Some(Parts::new(lines, 0)?),
    };
    let is_met = |values: &[Rational]| match &parts {
        Some(parts) => parts.is_met(values, scale),
        None => lines.is_met_in_order(&named(lines, values), scale),
    };
    let size = |i: usize| {
        let range = lines.range(i);
        [&range.lower, &range.upper].into_iter().flatten().map(Rational::abs).max().unwrap_or(Rational::ONE)
    };
    // A gain that is nearly 0 is 0.
    let tiny = |i: usize| size(i) * power(TINY);
    let near_zero = |i: usize, x: &Rational| if x.abs() <= tiny(i) { Some(Rational::ZERO) } else { None };
    for digits in DIGITS {
        let choices = |(i, x): (usize, &Rational)| near_zero(i, x).into_iter().chain(rounded(x, digits)).collect();
        let near: Vec<Vec<Rational>> = found.iter().enumerate().map(choices).collect();
        let mut points: Vec<Vec<Rational>> = vec![Vec::new()];
        for choices in &near {
            let longer = points
                .iter()
                .flat_map(|point| choices.iter().map(|choice| point.iter().cloned().chain([choice.clone()]).collect()));
            points = longer.collect();
        }
        for values in points {
            if is_within(&values) && is_good(&values) && is_met(&values)? {
                return Ok(Some(values));
            }
        }
    }
    Ok(None)
}

/// The three decimals of so many digits that are nearest to a number.
fn rounded(x: &Rational, digits: i64) -> Vec<Rational> {
    if x.is_zero() {
        return vec![Rational::ZERO];
    }
    let unit = power(first_power(&x.abs()) - digits);
    let steps = x.checked_div(&unit).expect("a power is not zero");
    let half = Rational::new(1.into(), 2.into());
    let nearest = Rational::from((steps + half).floor());
    [0, -1, 1].map(|k| (&nearest + &Rational::from(k)) * &unit).into()
}

/// The level of a point, where a number is known for it.
fn level_at(lines: &Lines<'_>, level: Level, values: &[(String, Rational)]) -> Result<Option<Enclosure>, Error> {
    match level {
        Level::Decay | Level::Radius => {
            let enclosed = |x: Real| {
                let (low, high) = x.refined_to_digits(20).enclosure();
                Enclosure::new(low, high)
            };
            Ok(lines.bound_at(values, level)?.map(enclosed))
        }
        _ => lines.level_at(values, level),
    }
}
