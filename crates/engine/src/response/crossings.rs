//! Where the open loop has modulus one, and where it is real and negative.

use super::open_loop::{OpenLoop, Reduced};
use super::place::inner;
use super::{Place, Value};
use crate::stability::{Shape, zeros_in};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, RealAlgebraic, UniPoly, rational_between};
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
        let (r, shape) = (open_loop.reduced(), open_loop.shape());
        let excess = r.numerator_squared.minus(&r.denominator_squared);
        let (gain_everywhere, phase_everywhere) = (excess.is_zero(), r.imaginary.is_zero());
        let gain = if gain_everywhere { Vec::new() } else { gain_crossings(r, &excess, shape, budget)? };
        let phase = if phase_everywhere { Vec::new() } else { phase_crossings(r, shape, budget)? };
        Ok(Crossings { gain, gain_everywhere, phase, phase_everywhere })
    }
}

fn gain_crossings(
    r: &Reduced,
    excess: &UniPoly,
    shape: Shape,
    budget: &Budget,
) -> Result<Vec<GainCrossing>, Exhausted> {
    let one = |place: &Place| {
        let modulus = Value::at_place(&r.numerator_squared, &r.denominator_squared, place, shape);
        matches!(modulus, Some(Value::Number(x)) if x.exact() == Some(Rational::ONE))
    };
    let mut found = Vec::new();
    let mut add = |place: Place, direction| -> Result<(), Exhausted> {
        let tangent_squared = budget.enter(|| Value::at_place(&r.sum_squared, &r.difference_squared, &place, shape))?;
        let side = match &place {
            // -L has the opposite imaginary part.
            Place::Inside(x) => budget.enter(|| x.sign_of(&r.imaginary).reverse())?,
            _ => Ordering::Equal,
        };
        found.push(GainCrossing { place, tangent_squared, side, direction });
        Ok(())
    };
    if one(&Place::Lowest) {
        add(Place::Lowest, Direction::Touching)?;
    }
    let zeros = zeros_in(excess, &inner(shape), budget)?;
    let samples = samples_between(&zeros, shape);
    for (i, x) in zeros.into_iter().enumerate().rev() {
        let direction = match (excess.sign_at(&samples[i + 1]), excess.sign_at(&samples[i])) {
            (Ordering::Greater, Ordering::Less) => Direction::Falling,
            (Ordering::Less, Ordering::Greater) => Direction::Rising,
            _ => Direction::Touching,
        };
        add(Place::Inside(x), direction)?;
    }
    if one(&Place::Highest) {
        add(Place::Highest, Direction::Touching)?;
    }
    Ok(found)
}

/// A rational number below, between and above ascending zeros, all in the range of `x`.
fn samples_between(zeros: &[RealAlgebraic], shape: Shape) -> Vec<Rational> {
    let end = |r: Option<Rational>| r.map(RealAlgebraic::from_rational);
    let range = inner(shape);
    let (lowest, highest) = (end(range.lower), end(range.upper));
    let ends: Vec<Option<&RealAlgebraic>> =
        std::iter::once(lowest.as_ref()).chain(zeros.iter().map(Some)).chain([highest.as_ref()]).collect();
    let between = |pair: &[Option<&RealAlgebraic>]| match (pair[0], pair[1]) {
        (Some(a), Some(b)) => rational_between(a, b).expect("they differ"),
        (None, Some(b)) => b.rational_below(),
        _ => unreachable!("the range of x ends above"),
    };
    ends.windows(2).map(between).collect()
}

fn phase_crossings(r: &Reduced, shape: Shape, budget: &Budget) -> Result<Vec<PhaseCrossing>, Exhausted> {
    // k = -1/L = -|D0|^2 / Re(N conj(D0))
    let above = r.denominator_squared.scaled(&Integer::from(-2));
    let zeros = zeros_in(&r.imaginary, &inner(shape), budget)?;
    let mut found = Vec::new();
    let inside = zeros.into_iter().rev().map(Place::Inside);
    for place in std::iter::once(Place::Lowest).chain(inside).chain([Place::Highest]) {
        let negative = match &place {
            Place::Inside(x) => budget.enter(|| x.sign_of(&r.twice_real).is_lt())?,
            end => negative_at_end(r, end, shape),
        };
        if negative && let Some(factor) = budget.enter(|| Value::at_place(&above, &r.twice_real, &place, shape))? {
            found.push(PhaseCrossing { place, factor });
        }
    }
    Ok(found)
}

/// Whether the open loop is finite and negative at an end of the range of frequencies.
fn negative_at_end(r: &Reduced, end: &Place, shape: Shape) -> bool {
    let at = |x: i64| {
        let x = Rational::from(x);
        (r.numerator.eval_rational(&x), r.denominator.eval_rational(&x))
    };
    let (above, below) = match (end, shape) {
        (Place::Lowest, Shape::UnitDisc) => at(1),
        (Place::Highest, Shape::UnitDisc) => at(-1),
        (Place::Lowest, Shape::LeftHalfPlane) => at(0),
        _ => (Rational::from(r.numerator.coeff(r.degree)), Rational::from(r.denominator.coeff(r.degree))),
    };
    above.checked_div(&below).is_some_and(|value| value.is_negative())
}

impl GainCrossing {
    /// `phi` in radians, in `(-pi, pi]`, enclosed with about `bits` bits.
    pub fn phase(&self, bits: u64) -> Enclosure {
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
        if self.side.is_lt() && self.tangent_squared.is_some() {
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
