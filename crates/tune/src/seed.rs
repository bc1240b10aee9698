//! A good gain by its margins at some points: they are asked sooner than sets.

use crate::level_of_one::is_without_end;
use crate::lines::Lines;
use crate::one_gain::GAIN;
use crate::sets::{inner, widest};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::simplest_between;
use jurist_engine::error::Error;
use jurist_engine::response::{Level, RequiredSet};

/// So many points are asked at first, and so often the two beside the best one are.
const POINTS: i64 = 5;
const CLOSER: usize = 5;

/// A good gain by its margins at some points, with a value of the scale that it has at least; `None` where the level is no margin.
pub(crate) fn seed(
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
            if level.is_greatest_best() { asked.upper() <= value.lower() } else { asked.lower() >= value.upper() }
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
