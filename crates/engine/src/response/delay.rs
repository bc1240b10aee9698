//! How much delay a stable loop bears.

use super::Place;
use super::complex_poly::ComplexPoly;
use super::crossings::{COMPARED_BITS, Crossings, Direction, GainCrossing};
use super::ground::{Ground, at_end};
use super::open_loop::OpenLoop;
use super::parts::{Parts, with_parts};
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted, try_until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, Poly};

/// The delay margin: how much delay at the cut a stable loop bears.
#[derive(Clone, Debug)]
pub enum DelayMargin {
    /// Any; in discrete time any number of whole samples.
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

impl DelayMargin {
    /// Whether it counts whole samples: dead time between them makes another loop of a plant behind a hold.
    pub fn is_in_samples(&self, open_loop: &OpenLoop) -> bool {
        match self {
            DelayMargin::Samples(_) | DelayMargin::SamplesAtLeast(_) => true,
            DelayMargin::Unbounded => open_loop.sample_time().is_some(),
            DelayMargin::Zero | DelayMargin::DeadTime(_) => false,
        }
    }

    /// Of a stable loop.
    pub(super) fn of(open_loop: &OpenLoop, crossings: &Crossings, budget: &Budget) -> Result<DelayMargin, Exhausted> {
        with_parts!(open_loop, parts => DelayMargin::over(parts, crossings, budget))
    }

    pub(super) fn over<G: Ground>(
        parts: &Parts<G>,
        crossings: &Crossings,
        budget: &Budget,
    ) -> Result<DelayMargin, Exhausted> {
        match parts.shape {
            Shape::LeftHalfPlane if excess_at_highest(parts, budget)?.is_ge() => Ok(DelayMargin::Zero),
            Shape::LeftHalfPlane => {
                let mut first: Option<(usize, Enclosure)> = None;
                for (i, crossing) in crossings.gain.iter().enumerate() {
                    let delay = budget.enter(|| crossing.delay(parts.frequencies(), COMPARED_BITS))?;
                    let Some(delay) = delay else { continue };
                    if first.as_ref().is_none_or(|(_, known)| delay.upper() < known.lower()) {
                        first = Some((i, delay));
                    }
                }
                Ok(first.map_or(DelayMargin::Unbounded, |(i, _)| DelayMargin::DeadTime(i)))
            }
            Shape::UnitDisc if is_above_at_highest(parts, crossings, budget)? => {
                by_counts(parts, budget).map(DelayMargin::Samples)
            }
            Shape::UnitDisc => samples(parts, crossings, budget),
        }
    }
}

/// The sign of the modulus less one at the highest frequency.
fn excess_at_highest<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<Sign, Exhausted> {
    let r = &parts.reduced;
    let (above, below) = at_end(&r.numerator_squared, &r.denominator_squared, &Place::Highest, parts.frequencies());
    // Polynomials in s^2 < 0 have leading coefficients of either sign.
    parts.ground.sign(&above.minus(&below).times(&below), budget)
}

/// Whether the modulus is one or more at half the sampling frequency. Of a complex loop it may be one there and the open loop any number of
/// that modulus: then it counts what the modulus is around it.
fn is_above_at_highest<G: Ground>(parts: &Parts<G>, crossings: &Crossings, budget: &Budget) -> Result<bool, Exhausted> {
    let excess = excess_at_highest(parts, budget)?;
    if excess.is_ne() || !parts.frequencies().are_signed() || crossings.gain_everywhere {
        return Ok(excess.is_ge());
    }
    let r = &parts.reduced;
    let excess = r.numerator_squared.minus(&r.denominator_squared);
    let leading = |p: &Poly<G::Number>| p.coeffs().last().cloned().unwrap_or_else(G::Number::zero);
    // The signs for t to plus and to minus infinity.
    let after = parts.ground.sign(&leading(&excess), budget)?;
    let is_odd = excess.degree().is_some_and(|degree| degree % 2 == 1);
    Ok(is_odd || after.is_gt())
}

/// `z^m D0 + N`.
pub(super) fn delayed<G: Ground>(parts: &Parts<G>, m: u64) -> ComplexPoly<G::Number> {
    parts.denominator.shifted_up(m as usize).plus(&parts.numerator)
}

/// One root count for each number of samples: where the modulus is one or more at half the sampling frequency, few are
/// borne. The delay turns the arc above one by half a turn or more for each sample, so the search ends.
fn by_counts<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<u64, Exhausted> {
    let mut m = 1;
    while parts.ground.is_stable(&delayed(parts, m).with_conjugate(), parts.shape, budget)? {
        m += 1;
    }
    Ok(m - 1)
}

/// Where the modulus is below one at half the sampling frequency, the roots outside after `m` samples are counted by the
/// crossings: with a delay that grows, `L` at a crossing passes -1 whenever the delay is `(phi + 2 pi i)/theta`; a pair leaves
/// the disc where the modulus is falling, and comes back where it is rising. A curve that the delay does not close is closed
/// inside of the unit circle, so the count holds at whole samples. Of a complex loop each crossing is of one root, and at negative frequencies the
/// delay leads: there all is as in the mirror image.
fn samples<G: Ground>(parts: &Parts<G>, crossings: &Crossings, budget: &Budget) -> Result<DelayMargin, Exhausted> {
    let frequencies = parts.frequencies();
    let is_turned = |c: &&GainCrossing| matches!(&c.place, Place::Inside(_)) && !c.is_at_rest();
    let inside: Vec<&GainCrossing> = crossings.gain.iter().filter(is_turned).collect();
    let at_highest = meets_at_highest(parts, budget)?;
    if inside.is_empty() {
        let first = at_highest.iter().position(|meets| *meets);
        return Ok(first.map_or(DelayMargin::Unbounded, |borne| DelayMargin::Samples(borne as u64)));
    }
    let only_touches = inside.iter().all(|c| c.direction == Direction::Touching);
    let delays = |bits| inside.iter().filter_map(|c| c.delay(frequencies, bits)).collect::<Vec<_>>();
    let first = budget.enter(|| delays(COMPARED_BITS))?;
    let least = first.iter().map(Enclosure::lower).min().cloned().unwrap_or(Rational::ZERO);
    let mut m = least.ceil().to_i64().map_or(u64::MAX, |m| m.max(1) as u64);
    if at_highest.contains(&true) {
        m = 1;
    }
    loop {
        if only_touches && m > FOLLOWED_SAMPLES {
            return Ok(DelayMargin::SamplesAtLeast(FOLLOWED_SAMPLES));
        }
        let mut outside = 0i64;
        let mut touches = at_highest[(m as usize + 1) % 2];
        for crossing in &inside {
            match passes(parts, crossing, m, budget)? {
                None => touches = true,
                Some(passes) => match crossing.outward(frequencies) {
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

/// Whether `z^m D0 + N` has a root at `z = -1` for odd and for even `m`, of a complex loop whose modulus only touches one there.
fn meets_at_highest<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<[bool; 2], Exhausted> {
    if !parts.frequencies().are_signed() {
        return Ok([false; 2]);
    }
    let mut meets = [false; 2];
    for (meets, m) in meets.iter_mut().zip([1, 2]) {
        let delayed = delayed(parts, m);
        let at = |p: &Poly<G::Number>| p.eval(&G::Number::from_integer(&-Integer::ONE));
        *meets = parts.ground.sign(&at(&delayed.re), budget)?.is_eq()
            && parts.ground.sign(&at(&delayed.im), budget)?.is_eq();
    }
    Ok(meets)
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
            let [angle, rate] = crossing.turning(parts.frequencies(), bits)?;
            let turned = rate.mul(&Enclosure::from_rational(Rational::from(m)), bits).sub(&angle, bits);
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
    // A mode that the cut hides is on the boundary of no stable loop.
    let delayed = delayed(parts, m);
    let squared = delayed.modulus_squared(delayed.len() - 1, parts.frequencies());
    Ok(parts.ground.sign_at(&squared, x, budget)?.is_eq())
}
