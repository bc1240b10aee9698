//! How much delay a stable loop bears.

use super::Place;
use super::crossings::{Crossings, Direction, GainCrossing};
use super::ground::{Ground, at_end};
use super::open_loop::{OpenLoop, Parts, with_parts};
use super::place::modulus_squared;
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted, try_until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, Poly};

/// The delay margin: how much delay at the cut a stable loop bears.
#[derive(Clone, Debug)]
pub enum DelayMargin {
    /// Any.
    Unbounded,
    /// Continuous time: none, as the modulus of the open loop does not fall below one at high frequencies.
    Zero,
    /// Continuous time: less than the delay of this crossing, which is the first.
    DeadTime(usize),
    /// Discrete time: so many whole samples and no more.
    Samples(u64),
    /// Discrete time: at least so many whole samples; the modulus only touches one.
    SamplesAtLeast(u64),
}

/// Whole samples up to which a loop is followed whose modulus touches one and never goes above.
const FOLLOWED_SAMPLES: u64 = 10_000;

/// Bits with which two delays of crossings are compared, which may be equal.
const COMPARED_BITS: u64 = 256;

impl DelayMargin {
    /// Of a stable loop.
    pub(super) fn of(open_loop: &OpenLoop, crossings: &Crossings, budget: &Budget) -> Result<DelayMargin, Exhausted> {
        with_parts!(open_loop, parts => DelayMargin::over(parts, crossings, budget))
    }

    pub(super) fn over<G: Ground>(
        parts: &Parts<G>,
        crossings: &Crossings,
        budget: &Budget,
    ) -> Result<DelayMargin, Exhausted> {
        let r = &parts.reduced;
        // Whether the modulus is one or more at the highest frequency.
        let (above, below) = at_end(&r.numerator_squared, &r.denominator_squared, &Place::Highest, parts.shape);
        // Polynomials in s^2 < 0 have leading coefficients of either sign.
        let is_above = parts.ground.sign(&above.minus(&below).times(&below), budget)?.is_ge();
        match parts.shape {
            Shape::LeftHalfPlane if is_above => Ok(DelayMargin::Zero),
            Shape::LeftHalfPlane => {
                let mut first: Option<(usize, Enclosure)> = None;
                for (i, crossing) in crossings.gain.iter().enumerate() {
                    let delay = budget.enter(|| crossing.delay(parts.shape, COMPARED_BITS))?;
                    let Some(delay) = delay else { continue };
                    if first.as_ref().is_none_or(|(_, known)| delay.upper() < known.lower()) {
                        first = Some((i, delay));
                    }
                }
                Ok(first.map_or(DelayMargin::Unbounded, |(i, _)| DelayMargin::DeadTime(i)))
            }
            Shape::UnitDisc if is_above => by_counts(parts, budget).map(DelayMargin::Samples),
            Shape::UnitDisc => samples(parts, crossings, budget),
        }
    }
}

/// `z^m D0 + N`.
fn delayed<G: Ground>(parts: &Parts<G>, m: u64) -> Poly<G::Number> {
    parts.denominator.shifted_up(m as usize).plus(&parts.numerator)
}

/// One root count for each number of samples: where the modulus is one or more at half the sampling frequency, few are
/// borne. The delay turns the arc above one by half a turn or more for each sample, so the search ends.
fn by_counts<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<u64, Exhausted> {
    let mut m = 1;
    while parts.ground.is_stable(&delayed(parts, m), parts.shape, budget)? {
        m += 1;
    }
    Ok(m - 1)
}

/// Where the modulus is below one at half the sampling frequency, the roots outside after `m` samples are counted by the
/// crossings: with a delay that grows, `L` at a crossing passes -1 whenever the delay is `(phi + 2 pi i)/theta`; a pair leaves
/// the disc where the modulus is falling, and comes back where it is rising. A curve that the delay does not close is closed
/// inside of the unit circle, so the count holds at whole samples.
fn samples<G: Ground>(parts: &Parts<G>, crossings: &Crossings, budget: &Budget) -> Result<DelayMargin, Exhausted> {
    let inside: Vec<&GainCrossing> = crossings.gain.iter().filter(|c| matches!(c.place, Place::Inside(_))).collect();
    if inside.is_empty() {
        return Ok(DelayMargin::Unbounded);
    }
    let only_touches = inside.iter().all(|c| c.direction == Direction::Touching);
    let delays = |bits| inside.iter().filter_map(|c| c.delay(Shape::UnitDisc, bits)).collect::<Vec<_>>();
    let first = budget.enter(|| delays(COMPARED_BITS))?;
    let least = first.iter().map(Enclosure::lower).min().cloned().unwrap_or(Rational::ZERO);
    let mut m = least.ceil().to_i64().map_or(u64::MAX, |m| m.max(1) as u64);
    loop {
        if only_touches && m > FOLLOWED_SAMPLES {
            return Ok(DelayMargin::SamplesAtLeast(FOLLOWED_SAMPLES));
        }
        let mut outside = 0i64;
        let mut touches = false;
        for crossing in &inside {
            match passes(parts, crossing, m, budget)? {
                None => touches = true,
                Some(passes) => match crossing.direction {
                    Direction::Falling => outside += passes,
                    Direction::Rising => outside -= passes,
                    Direction::Touching => {}
                },
            }
        }
        if touches || outside != 0 {
            return Ok(DelayMargin::Samples(m - 1));
        }
        m += 1;
    }
}

/// How often the crossing has passed -1 before `m` samples; `None` if it is there just then.
fn passes<G: Ground>(
    parts: &Parts<G>,
    crossing: &GainCrossing,
    m: u64,
    budget: &Budget,
) -> Result<Option<i64>, Exhausted> {
    let mut decided_apart = false;
    try_until_shown(64 + 2 * u64::from(64 - m.leading_zeros()), |bits| {
        let turns = budget.enter(|| {
            let angle = crossing.place.frequency(Shape::UnitDisc, None, bits)?.angle?;
            let turned = angle.mul(&Enclosure::from_rational(Rational::from(m)), bits).sub(&crossing.lag(bits), bits);
            let turn = Enclosure::pi(bits).mul(&Enclosure::from_rational(Rational::from(2)), bits);
            turned.div(&turn, bits)
        })?;
        let Some(turns) = turns else { return Ok(Some(None)) };
        let (lo, hi) = (turns.lower().floor(), turns.upper().floor());
        if lo == hi && turns.lower() != &Rational::from(&lo) {
            return Ok(Some((&lo + &Integer::ONE).to_i64().map(|passed| passed.max(0))));
        }
        // Either it is at -1, which the polynomial tells, or narrower enclosures part them.
        if !decided_apart && is_root(parts, crossing, m, budget)? {
            return Ok(Some(None));
        }
        decided_apart = true;
        Ok(None)
    })
}

/// Whether `z^m D0 + N` has a root at the crossing.
fn is_root<G: Ground>(parts: &Parts<G>, crossing: &GainCrossing, m: u64, budget: &Budget) -> Result<bool, Exhausted> {
    let Place::Inside(x) = &crossing.place else { return Ok(false) };
    let r = &parts.reduced;
    let delayed = r.denominator.shifted_up(m as usize).plus(&r.numerator);
    let squared = modulus_squared(&delayed, r.degree + m as usize, Shape::UnitDisc);
    Ok(parts.ground.sign_at(&squared, x, budget)?.is_eq())
}
