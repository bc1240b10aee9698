//! Where the open loop has modulus one, and where it is real and negative.

use super::ground::{Ground, at_end};
use super::open_loop::{OpenLoop, Parts, with_parts};
use super::place::inner;
use super::{Place, Value};
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

fn gain_crossings<G: Ground>(
    parts: &Parts<G>,
    excess: &Poly<G::Number>,
    budget: &Budget,
) -> Result<Vec<GainCrossing>, Exhausted> {
    let (r, shape, ground) = (&parts.reduced, parts.shape, &parts.ground);
    let one = |place: &Place| -> Result<bool, Exhausted> {
        let (excess, below) = at_end(excess, &r.denominator_squared, place, shape);
        Ok(ground.sign(&excess, budget)?.is_eq() && ground.sign(&below, budget)?.is_ne())
    };
    let mut found = Vec::new();
    let mut add = |place: Place, direction| -> Result<(), Exhausted> {
        let tangent_squared = ground.value(&r.sum_squared, &r.difference_squared, &place, shape, budget)?;
        let side = match &place {
            // -L has the opposite imaginary part.
            Place::Inside(x) => ground.sign_at(&r.imaginary, x, budget)?.reverse(),
            _ => Ordering::Equal,
        };
        found.push(GainCrossing { place, tangent_squared, side, direction, dead_time: None });
        Ok(())
    };
    if one(&Place::Lowest)? {
        add(Place::Lowest, Direction::Touching)?;
    }
    let zeros = ground.zeros(excess, &inner(shape), budget)?;
    let mut signs = Vec::with_capacity(zeros.len() + 1);
    for sample in samples_between(&zeros, shape, budget)? {
        signs.push(ground.sign_at(excess, &Real::from(sample), budget)?);
    }
    for (i, x) in zeros.into_iter().enumerate().rev() {
        let direction = match (signs[i + 1], signs[i]) {
            (Ordering::Greater, Ordering::Less) => Direction::Falling,
            (Ordering::Less, Ordering::Greater) => Direction::Rising,
            _ => Direction::Touching,
        };
        add(Place::Inside(x), direction)?;
    }
    if one(&Place::Highest)? {
        add(Place::Highest, Direction::Touching)?;
    }
    Ok(found)
}

/// A rational number below, between and above ascending zeros, all in the range of `x`.
pub(super) fn samples_between(zeros: &[Real], shape: Shape, budget: &Budget) -> Result<Vec<Rational>, Exhausted> {
    RealInterval::from(inner(shape)).cut(zeros).iter().map(|cell| cell.sample(budget)).collect()
}

fn phase_crossings<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<Vec<PhaseCrossing>, Exhausted> {
    let (r, shape, ground) = (&parts.reduced, parts.shape, &parts.ground);
    // Where the open loop is zero or infinite both parts of N conj(D0) vanish.
    let common = budget.enter(|| r.imaginary.gcd(&r.twice_real))?;
    let divided = |p: &Poly<G::Number>| p.div_exact(&common).expect("a gcd divides");
    let (imaginary, real) = (divided(&r.imaginary), divided(&r.twice_real));
    let imaginary = budget.enter(|| imaginary.div_exact(&imaginary.gcd(&common)).expect("a gcd divides"))?;
    // k = -1/L = -|D0|^2 / Re(N conj(D0))
    let above = r.denominator_squared.scaled(&G::Number::from_integer(&Integer::from(-2)));
    let zeros = ground.zeros(&imaginary, &inner(shape), budget)?;
    let mut found = Vec::new();
    let inside = zeros.into_iter().rev().map(Place::Inside);
    for place in std::iter::once(Place::Lowest).chain(inside).chain([Place::Highest]) {
        let negative = match &place {
            Place::Inside(x) => match ground.sign_at(&common, x, budget)? {
                Ordering::Equal => false,
                Ordering::Greater => ground.sign_at(&real, x, budget)?.is_lt(),
                Ordering::Less => ground.sign_at(&real, x, budget)?.is_gt(),
            },
            end => {
                let (above, below) = r.at_end(&r.numerator, end, shape);
                ground.sign(&above.times(&below), budget)?.is_lt()
            }
        };
        if negative && let Some(factor) = ground.value(&above, &r.twice_real, &place, shape, budget)? {
            found.push(PhaseCrossing { place, factor });
        }
    }
    Ok(found)
}

impl GainCrossing {
    /// `phi` in radians, in `(-pi, pi]`, enclosed with about `bits` bits.
    pub fn phase(&self, bits: u64) -> Enclosure {
        let working = bits + 64;
        let turned = self.dead_time.as_ref().and_then(|tau| {
            let rate = self.place.frequency(Shape::LeftHalfPlane, None, working)?.radians_per_second?;
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

    /// The lag divided by the frequency: in samples, or in units of time; `None` at the ends of the range.
    pub fn delay(&self, shape: Shape, bits: u64) -> Option<Enclosure> {
        if !matches!(self.place, Place::Inside(_)) {
            return None;
        }
        let working = bits + 16;
        let frequency = self.place.frequency(shape, None, working)?;
        let rate = frequency.angle.or(frequency.radians_per_second)?;
        self.lag(working).div(&rate, bits)
    }
}
