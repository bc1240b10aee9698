//! Where the open loop has modulus one, and where it is real and negative.

use super::ground::{Ground, at_end};
use super::open_loop::OpenLoop;
use super::parts::{Parts, with_parts};
use super::{Frequencies, Place, Value};
use crate::stability::{RealInterval, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, Poly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// How the modulus of the open loop goes through one as the frequency grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// From above one to below.
    Falling,
    /// From below one to above.
    Rising,
    /// It touches one, or begins or ends there.
    Touching,
}

/// A frequency at which the open loop has modulus one: `L = -exp(j phi)`.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GainCrossing {
    /// The frequency.
    pub place: Place,
    /// `tan(phi/2)^2`; `None` where `phi` is 180 degrees.
    pub tangent_squared: Option<Value>,
    /// The sign of `phi`: greater where a lag of `phi` leads to -1.
    pub side: Sign,
    /// How the modulus goes through one.
    pub direction: Direction,
    /// Dead time of the open loop, which turns it further; the tangent and the side are those without it.
    pub dead_time: Option<Rational>,
    /// The frequencies that were looked at.
    pub(super) frequencies: Frequencies,
}

/// A frequency at which the open loop is real and negative: with the factor `k = -1/L` it is -1.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct PhaseCrossing {
    /// The frequency.
    pub place: Place,
    /// The factor.
    pub factor: Value,
}

/// All crossings by ascending frequency.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Crossings {
    /// Modulus one.
    pub gain: Vec<GainCrossing>,
    /// Whether the modulus is one at all frequencies; none is listed then.
    pub gain_everywhere: bool,
    /// Real and negative.
    pub phase: Vec<PhaseCrossing>,
    /// Whether the open loop is real at all frequencies: a constant; none is listed then.
    pub phase_everywhere: bool,
}

impl Crossings {
    /// The one of modulus one with the least angle, the first of those that enclosures do not tell apart.
    pub(super) fn least(
        &self,
        angle: impl Fn(&GainCrossing, u64) -> Enclosure,
        budget: &Budget,
    ) -> Result<Option<&GainCrossing>, Exhausted> {
        let mut least: Option<(&GainCrossing, Enclosure)> = None;
        for crossing in &self.gain {
            let own = budget.enter(|| angle(crossing, COMPARED_BITS))?;
            if least.as_ref().is_none_or(|(_, known)| own.upper() < known.lower()) {
                least = Some((crossing, own));
            }
        }
        Ok(least.map(|(crossing, _)| crossing))
    }

    pub(super) fn of(open_loop: &OpenLoop, budget: &Budget) -> Result<Crossings, Exhausted> {
        with_parts!(open_loop, parts => Crossings::over(parts, budget))
    }

    fn over<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<Crossings, Exhausted> {
        let r = &parts.reduced;
        let excess = r.numerator_squared.minus(&r.denominator_squared);
        let (gain_everywhere, phase_everywhere) = (excess.is_zero(), r.imaginary.is_zero());
        let gain = if gain_everywhere { Vec::new() } else { gain_crossings(parts, &excess, budget)? };
        let phase = if phase_everywhere { Vec::new() } else { phase_crossings(parts, budget)? };
        Ok(Crossings { gain, gain_everywhere, phase, phase_everywhere })
    }
}

/// Bits with which angles, and delays, of crossings are compared, which may be equal.
pub(super) const COMPARED_BITS: u64 = 256;

fn gain_crossings<G: Ground>(
    parts: &Parts<G>,
    excess: &Poly<G::Number>,
    budget: &Budget,
) -> Result<Vec<GainCrossing>, Exhausted> {
    let (r, frequencies, ground) = (&parts.reduced, parts.frequencies(), &parts.ground);
    let zeros = ground.zeros(excess, &frequencies.inner(), budget)?;
    let sign = |sample| ground.sign_at(excess, &Real::from(sample), budget);
    let signs = samples_between(&zeros, frequencies, budget)?.into_iter().map(sign).collect::<Result<Vec<_>, _>>()?;
    let signs = frequencies.ascending(signs);
    let mut found = Vec::new();
    let mut passed = 0;
    for place in frequencies.places(zeros) {
        let direction = match &place {
            Place::Inside(_) => {
                passed += 1;
                Direction::of(signs[passed - 1], signs[passed])
            }
            // At z = -1 both ends of the range of frequencies meet.
            Place::Highest if frequencies == Frequencies::Signed(Shape::UnitDisc) => {
                Direction::of(signs[passed], signs[0])
            }
            _ => Direction::Touching,
        };
        if !matches!(place, Place::Inside(_)) {
            let (excess, below) = at_end(excess, &r.denominator_squared, &place, frequencies);
            if ground.sign(&excess, budget)?.is_ne() || ground.sign(&below, budget)?.is_eq() {
                continue;
            }
        }
        let tangent_squared = ground.value(&r.sum_squared, &r.difference_squared, &place, frequencies, budget)?;
        // -L has the opposite imaginary part.
        let side = match &place {
            Place::Inside(x) => ground.sign_at(&r.imaginary, x, budget)?.reverse(),
            Place::Highest if frequencies.are_signed() => {
                let (imaginary, _) = at_end(&r.imaginary, &r.denominator_squared, &place, frequencies);
                ground.sign(&imaginary, budget)?.reverse()
            }
            _ => Ordering::Equal,
        };
        found.push(GainCrossing { place, tangent_squared, side, direction, dead_time: None, frequencies });
    }
    Ok(found)
}

impl Direction {
    /// From the signs of the modulus less one before and after a crossing.
    fn of(before: Sign, after: Sign) -> Direction {
        match (before, after) {
            (Ordering::Greater, Ordering::Less) => Direction::Falling,
            (Ordering::Less, Ordering::Greater) => Direction::Rising,
            _ => Direction::Touching,
        }
    }
}

/// A rational number below, between and above ascending zeros, all in the range of `x`.
pub(super) fn samples_between(
    zeros: &[Real],
    frequencies: Frequencies,
    budget: &Budget,
) -> Result<Vec<Rational>, Exhausted> {
    RealInterval::from(frequencies.inner()).cut(zeros).iter().map(|cell| cell.sample(budget)).collect()
}

fn phase_crossings<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<Vec<PhaseCrossing>, Exhausted> {
    let (r, frequencies, ground) = (&parts.reduced, parts.frequencies(), &parts.ground);
    // Where the open loop is zero or infinite both parts of N conj(D0) vanish.
    let common = budget.enter(|| r.common(&r.imaginary, &r.twice_real))?;
    let divided = |p: &Poly<G::Number>| p.div_exact(&common).expect("a gcd divides");
    let (imaginary, real) = (divided(&r.imaginary), divided(&r.twice_real));
    let imaginary = budget.enter(|| imaginary.div_exact(&r.common(&imaginary, &common)).expect("a gcd divides"))?;
    // k = -1/L = -|D0|^2 / Re(N conj(D0))
    let above = r.denominator_squared.scaled(&G::Number::from_integer(&Integer::from(-2)));
    let zeros = ground.zeros(&imaginary, &frequencies.inner(), budget)?;
    let mut found = Vec::new();
    for place in frequencies.places(zeros) {
        let negative = match &place {
            Place::Inside(x) => match ground.sign_at(&common, x, budget)? {
                Ordering::Equal => false,
                Ordering::Greater => ground.sign_at(&real, x, budget)?.is_lt(),
                Ordering::Less => ground.sign_at(&real, x, budget)?.is_gt(),
            },
            end => is_negative_at_end(parts, end, budget)?,
        };
        if negative && let Some(factor) = ground.value(&above, &r.twice_real, &place, frequencies, budget)? {
            found.push(PhaseCrossing { place, factor });
        }
    }
    Ok(found)
}

/// Whether the open loop is real and negative at an end of the range of frequencies.
fn is_negative_at_end<G: Ground>(parts: &Parts<G>, end: &Place, budget: &Budget) -> Result<bool, Exhausted> {
    let (r, frequencies, ground) = (&parts.reduced, parts.frequencies(), &parts.ground);
    let (_, below) = at_end(&r.numerator_squared, &r.denominator_squared, end, frequencies);
    if ground.sign(&below, budget)?.is_eq() {
        return Ok(false);
    }
    if frequencies.are_signed() {
        let (imaginary, _) = at_end(&r.imaginary, &r.denominator_squared, end, frequencies);
        if ground.sign(&imaginary, budget)?.is_ne() {
            return Ok(false);
        }
    }
    let (real, below) = at_end(&r.twice_real, &r.denominator_squared, end, frequencies);
    Ok(ground.sign(&real.times(&below), budget)?.is_lt())
}

impl GainCrossing {
    /// `phi` in radians, in `(-pi, pi]`, enclosed with about `bits` bits.
    pub fn phase(&self, bits: u64) -> Enclosure {
        let working = bits + 64;
        let turned = self.dead_time.as_ref().and_then(|tau| {
            let rate = self.place.frequency(self.frequencies, None, working)?.radians_per_second?;
            Some(rate.mul(&Enclosure::from_rational(tau.clone()), working))
        });
        let own = self.phase_without_dead_time(working);
        let Some(turned) = turned else { return own.rounded(bits) };
        let phase = own.sub(&turned, working);
        // Back into one turn.
        let (half, two) = (Enclosure::pi(working), Enclosure::from_rational(Rational::from(2)));
        let turn = half.mul(&two, working);
        let turns = phase.add(&half, working).div(&turn, working).map(|t| t.lower().midpoint(t.upper()).floor());
        let turns = Enclosure::from_rational(Rational::from(turns.unwrap_or(Integer::ZERO)));
        phase.sub(&turn.mul(&turns, working), bits)
    }

    fn phase_without_dead_time(&self, bits: u64) -> Enclosure {
        let working = bits + 16;
        let size = match &self.tangent_squared {
            None => return Enclosure::pi(bits),
            Some(tangent) => {
                let half = tangent.enclosure(working).sqrt(working).atan(working);
                half.mul(&Enclosure::from_rational(Rational::from(2)), bits)
            }
        };
        if self.side.is_lt() { size.neg() } else { size }
    }

    /// By how much the open loop has to lag to be -1, in radians in `(0, 2 pi)`; 0 where it is -1.
    pub fn lag(&self, bits: u64) -> Enclosure {
        let phase = self.phase(bits + 16);
        let is_lead = match self.dead_time {
            Some(_) => phase.upper().is_negative(),
            None => self.side.is_lt() && self.tangent_squared.is_some(),
        };
        if is_lead {
            let turn = Enclosure::pi(bits + 16).mul(&Enclosure::from_rational(Rational::from(2)), bits + 16);
            turn.add(&phase, bits)
        } else {
            phase.rounded(bits)
        }
    }

    /// The first dead time with which the open loop is -1 there, in samples, or in units of time; `None` at the ends of the range, and at the
    /// frequency 0, which dead time does not turn.
    pub fn delay(&self, frequencies: impl Into<Frequencies>, bits: u64) -> Option<Enclosure> {
        let [angle, rate] = self.turning(frequencies.into(), bits + 16)?;
        angle.div(&rate, bits)
    }

    /// By how much the open loop has to turn to be -1, and how fast dead time turns it: at a negative frequency it leads.
    pub(super) fn turning(&self, frequencies: Frequencies, bits: u64) -> Option<[Enclosure; 2]> {
        if !matches!(self.place, Place::Inside(_)) {
            return None;
        }
        let frequency = self.place.frequency(frequencies, None, bits)?;
        let rate = frequency.angle.or(frequency.radians_per_second)?;
        match rate.lower().sign() {
            Ordering::Less => Some([self.lead(bits), rate.neg()]),
            Ordering::Greater => Some([self.lag(bits), rate]),
            Ordering::Equal => None,
        }
    }

    /// Whether it is at the frequency 0, which dead time does not turn.
    pub(super) fn is_at_rest(&self) -> bool {
        self.place.is_at_rest(self.frequencies)
    }

    /// How the modulus goes through one where the size of the frequency grows.
    pub(super) fn outward(&self, frequencies: Frequencies) -> Direction {
        let is_lower = match &self.place {
            Place::Inside(x) => frequencies.are_signed() && x.sign().is_lt(),
            _ => false,
        };
        match self.direction {
            Direction::Falling if is_lower => Direction::Rising,
            Direction::Rising if is_lower => Direction::Falling,
            direction => direction,
        }
    }

    /// By how much the open loop has to lead to be -1, in radians in `(0, 2 pi)`; 0 where it is -1.
    pub fn lead(&self, bits: u64) -> Enclosure {
        let lag = self.lag(bits + 16);
        if lag.lower().is_zero() && lag.upper().is_zero() {
            return lag;
        }
        Enclosure::pi(bits + 16).mul(&Enclosure::from_rational(Rational::from(2)), bits + 16).sub(&lag, bits)
    }
}
