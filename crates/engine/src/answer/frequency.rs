//! The frequency of the complex pair at an end of a stable interval.

use crate::problem::Problem;
use crate::stability::{ComplexPair, End, Shape, Side};
use jurist_algebra::limits::doubling;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::UniPoly;
use jurist_algebra::real::Real;

/// Certified enclosures of where a complex pair sits on the boundary.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let answer = model.ask().free("K").stable_set(&Budget::unlimited())?;
/// let upper = answer.value().intervals()[0].upper.as_ref().unwrap(); // K = 2: z^2 - z + 1
/// let frequency = answer.problem().frequency(upper, 64).unwrap();
/// assert_eq!(frequency.angle.unwrap().decimal(10).unwrap(), "1.047197551"); // pi/3
/// assert!(frequency.hertz.is_none(), "there is no sample time");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Frequency {
    /// The angle of the upper root in radians, discrete time only.
    pub angle: Option<Enclosure>,
    /// In radians per second: continuous time, or discrete time with a sample time.
    pub radians_per_second: Option<Enclosure>,
    /// In hertz: continuous time, or discrete time with a sample time.
    pub hertz: Option<Enclosure>,
}

impl Frequency {
    /// From the angle and the sample time on the unit circle, or from the angular frequency on the imaginary axis.
    pub(crate) fn new(
        angle: Option<Enclosure>,
        step: Option<&Enclosure>,
        on_axis: Option<Enclosure>,
        bits: u64,
    ) -> Frequency {
        let working = bits + 16;
        let rate = match (&angle, step) {
            (Some(angle), Some(step)) => angle.div(step, working),
            _ => on_axis,
        };
        let two_pi = Enclosure::pi(working).mul(&Enclosure::from_rational(Rational::from(2)), working);
        let hertz = rate.as_ref().and_then(|w| w.div(&two_pi, bits));
        let rounded = |e: Enclosure| e.rounded(bits);
        Frequency { angle: angle.map(rounded), radians_per_second: rate.map(rounded), hertz }
    }
}

impl Frequency {
    /// Where a complex pair is, with a sample time that is a number.
    pub(crate) fn of_pair(pair: &ComplexPair, sample_time: Option<&Rational>, bits: u64) -> Frequency {
        let working = bits + 16;
        let step = sample_time.filter(|t| t.sign().is_gt()).map(|t| Enclosure::from_rational(t.clone()));
        let [angle, rate] = [pair.angle(working), pair.angular_frequency(working)].map(|e| e.map(|e| on_side(pair, e)));
        Frequency::new(angle, step.as_ref(), rate, bits)
    }
}

impl Problem {
    /// The frequency of the complex pair at an end of the stable set, enclosed with about `bits` significant bits; `None`
    /// when no complex pair is there. Without a positive sample time a discrete loop has only the angle.
    ///
    /// Cost: that of refining the end to twice as many bits.
    pub fn frequency(&self, end: &End, bits: u64) -> Option<Frequency> {
        let pair = end.pair.as_ref()?;
        let working = bits + 16;
        Some(match pair.region() {
            Shape::LeftHalfPlane => {
                Frequency::new(None, None, pair.angular_frequency(working).map(|rate| on_side(pair, rate)), bits)
            }
            Shape::UnitDisc => {
                let angle = on_side(pair, pair.angle(working)?);
                let step = self.sample_time().and_then(|t| positive_value_at(&t, &end.value, working));
                Frequency::new(Some(angle), step.as_ref(), None, bits)
            }
        })
    }
}

/// An angle or a rate with the sign of the side that the root is on, where it comes alone.
fn on_side(pair: &ComplexPair, size: Enclosure) -> Enclosure {
    if pair.side() == Side::Lower { size.neg() } else { size }
}

/// Doublings of precision after which a value at a number that is not algebraic is given up.
const MOST_DOUBLINGS: usize = 10;

/// An enclosure of `numerator/denominator` at a real number, of relative width about `2^-bits`;
/// `None` unless the value is finite and positive.
fn positive_value_at(f: &(UniPoly, UniPoly), at: &Real, bits: u64) -> Option<Enclosure> {
    if let Some(at) = at.algebraic() {
        let (numerator, denominator) = (at.sign_of(&f.0), at.sign_of(&f.1));
        if numerator.is_eq() || numerator != denominator {
            return None;
        }
    }
    // An algebraic number has a positive value there, which shows in the end.
    let attempts = if at.algebraic().is_some() { usize::MAX } else { 1 + MOST_DOUBLINGS };
    doubling(2 * bits).take(attempts).find_map(|working| {
        let (lo, hi) = at.refined(&Rational::dyadic(&Integer::ONE, working)).enclosure();
        let x = Enclosure::new(lo, hi);
        let value = |p: &UniPoly| p.eval_enclosure(&x, working);
        value(&f.0).div(&value(&f.1), working).filter(|quotient| {
            let width = (quotient.upper() - quotient.lower()) * Rational::from(&Integer::ONE << bits);
            quotient.lower().sign().is_gt() && width <= *quotient.lower()
        })
    })
}
