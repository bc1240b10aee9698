//! How much delay a stable loop bears.

use super::crossings::{Crossings, Direction, GainCrossing};
use super::open_loop::OpenLoop;
use super::place::modulus_squared;
use super::{Place, Value};
use crate::stability::{Shape, is_stable};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};

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
        let r = open_loop.reduced();
        let above_one_at_the_end =
            match Value::at_place(&r.numerator_squared, &r.denominator_squared, &Place::Highest, open_loop.shape()) {
                Some(Value::Number(x)) => x.compare_rational(&Rational::ONE),
                _ => std::cmp::Ordering::Greater,
            };
        match open_loop.shape() {
            Shape::LeftHalfPlane if above_one_at_the_end.is_ge() => Ok(DelayMargin::Zero),
            Shape::LeftHalfPlane => {
                let mut first: Option<(usize, Enclosure)> = None;
                for (i, crossing) in crossings.gain.iter().enumerate() {
                    let delay = budget.enter(|| crossing.delay(open_loop.shape(), COMPARED_BITS))?;
                    let Some(delay) = delay else { continue };
                    if first.as_ref().is_none_or(|(_, known)| delay.upper() < known.lower()) {
                        first = Some((i, delay));
                    }
                }
                Ok(first.map_or(DelayMargin::Unbounded, |(i, _)| DelayMargin::DeadTime(i)))
            }
            Shape::UnitDisc if above_one_at_the_end.is_ge() => by_counts(open_loop, budget).map(DelayMargin::Samples),
            Shape::UnitDisc => samples(open_loop, crossings, budget),
        }
    }
}

/// `z^m D0 + N`.
fn delayed(open_loop: &OpenLoop, m: u64) -> UniPoly {
    open_loop.denominator().shifted_up(m as usize).plus(open_loop.numerator())
}

/// One root count for each number of samples: where the modulus is one or more at half the sampling frequency, few are
/// borne. The delay turns the arc above one by half a turn or more for each sample, so the search ends.
fn by_counts(open_loop: &OpenLoop, budget: &Budget) -> Result<u64, Exhausted> {
    let mut m = 1;
    while budget.enter(|| is_stable(&delayed(open_loop, m), open_loop.shape()))? {
        m += 1;
    }
    Ok(m - 1)
}

/// Where the modulus is below one at half the sampling frequency, the roots outside after `m` samples are counted by the
/// crossings: with a delay that grows, `L` at a crossing passes -1 whenever the delay is `(phi + 2 pi i)/theta`; a pair leaves
/// the disc where the modulus is falling, and comes back where it is rising. A curve that the delay does not close is closed
/// inside of the unit circle, so the count holds at whole samples.
fn samples(open_loop: &OpenLoop, crossings: &Crossings, budget: &Budget) -> Result<DelayMargin, Exhausted> {
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
            match budget.enter(|| passes(open_loop, crossing, m))? {
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
fn passes(open_loop: &OpenLoop, crossing: &GainCrossing, m: u64) -> Option<i64> {
    let mut bits = 64 + 2 * u64::from(64 - m.leading_zeros());
    let mut decided_apart = false;
    loop {
        let angle = crossing.place.frequency(Shape::UnitDisc, None, bits)?.angle?;
        let turned = angle.mul(&Enclosure::from_rational(Rational::from(m)), bits).sub(&crossing.lag(bits), bits);
        let turn = Enclosure::pi(bits).mul(&Enclosure::from_rational(Rational::from(2)), bits);
        let turns = turned.div(&turn, bits)?;
        let (lo, hi) = (turns.lower().floor(), turns.upper().floor());
        if lo == hi && turns.lower() != &Rational::from(&lo) {
            return Some((&lo + &Integer::ONE).to_i64()?.max(0));
        }
        // Either it is at -1, which the polynomial tells, or narrower enclosures part them.
        if !decided_apart && is_root(open_loop, crossing, m) {
            return None;
        }
        decided_apart = true;
        bits *= 2;
    }
}

/// Whether `z^m D0 + N` has a root at the crossing.
fn is_root(open_loop: &OpenLoop, crossing: &GainCrossing, m: u64) -> bool {
    let Place::Inside(x) = &crossing.place else { return false };
    let r = open_loop.reduced();
    let delayed = r.denominator.shifted_up(m as usize).plus(&r.numerator);
    x.sign_of(&modulus_squared(&delayed, r.degree + m as usize, Shape::UnitDisc)).is_eq()
}
