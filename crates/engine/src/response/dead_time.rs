//! Margins of continuous loops with dead time, `L = N/D0 exp(-tau s)`.
//!
//! The modulus of the exponential is one on the axis, so the crossings of modulus one are algebraic; the phase turns by
//! `-omega tau`. Where the open loop is real, and the extremes of `|1 + L|`, are zeros of polynomials in `omega`,
//! `cos(tau omega)` and `sin(tau omega)`: isolated with enclosures ([`MovingSymbols::zeros_in`]) up to a frequency beyond
//! which the modulus of the open loop tells that there is nothing to find.

use super::crossings::{Crossings, PhaseCrossing};
use super::delayed_axis::DelayedAxis;
use super::enclosed::enclosed;
use super::ground::Integers;
use super::margins::{GainMargin, PhaseMargin, StableMargins};
use super::parts::Parts;
use super::value::{reciprocal, square_root};
use super::{DelayMargin, DiskMargin, Extreme, Place, Value};
use crate::answer::stable_factors;
use crate::error::Error;
use crate::problem::refused;
use crate::stability::dead_time::GainLoop;
use crate::stability::{Range, zeros_in};
use jurist_algebra::ball::{Ball, tan};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, UniPoly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// The rational factor of the open loop and its dead time.
pub(super) struct DeadTime<'a> {
    parts: &'a Parts<Integers>,
    tau: &'a Rational,
    axis: DelayedAxis,
}

/// Phase crossings are listed where the open loop's modulus is above one over this.
const LISTED: i64 = 100;

impl<'a> DeadTime<'a> {
    pub fn new(parts: &'a Parts<Integers>, tau: &'a Rational) -> DeadTime<'a> {
        DeadTime { parts, tau, axis: DelayedAxis::new(tau.clone()) }
    }

    /// Twice the real part of `N conj(D0) exp(-j omega tau)`.
    fn twice_real(&self) -> MultiPoly {
        let r = &self.parts.reduced;
        let turned = DelayedAxis::of_square(&r.imaginary).times(&MultiPoly::variable(0)).scaled_by(&Integer::from(2));
        let along = DelayedAxis::of_square(&r.twice_real).times(&MultiPoly::variable(1));
        along.plus(&turned.times(&MultiPoly::variable(2)))
    }

    /// Twice its imaginary part, from twice the real part of `N conj(D0)` and from the imaginary part over `omega`.
    fn twice_imaginary(along: &UniPoly, across: &UniPoly) -> MultiPoly {
        let turned = DelayedAxis::of_square(across).times(&MultiPoly::variable(0)).scaled_by(&Integer::from(2));
        turned.times(&MultiPoly::variable(1)).minus(&DelayedAxis::of_square(along).times(&MultiPoly::variable(2)))
    }

    /// An angular frequency beyond which the modulus of the open loop is below `1/ratio`.
    fn beyond(&self, ratio: i64, budget: &Budget) -> Result<Rational, Error> {
        let r = &self.parts.reduced;
        let square = Integer::from(ratio) * &Integer::from(ratio);
        let excess = r.numerator_squared.scaled(&square).minus(&r.denominator_squared);
        if r.numerator_squared.degree() >= r.denominator_squared.degree() {
            let help = "such a loop bears no delay, or its margins are those of its modulus alone";
            return Err(refused("margins with dead time are known where the open loop's modulus falls to zero", help));
        }
        let below_zero = Range::between(None, Some(Rational::ZERO));
        let zeros = zeros_in(&excess, &below_zero, budget)?;
        Ok(match zeros.first() {
            // x = -omega^2 of the highest frequency.
            Some(x) => {
                let (lowest, _) = x.refined(&Rational::ONE).enclosure();
                Enclosure::from_rational(-lowest).sqrt(32).upper() + &Rational::ONE
            }
            None => Rational::ONE,
        })
    }

    /// All crossings of modulus one, and those of the negative real axis down to a hundredth.
    pub fn crossings(&self, mut rational: Crossings, budget: &Budget) -> Result<Crossings, Error> {
        for crossing in &mut rational.gain {
            crossing.dead_time = Some(self.tau.clone());
        }
        rational.phase.retain(|c| matches!(c.place, Place::Lowest));
        rational.phase_everywhere = false;
        let end = self.beyond(LISTED, budget)?;
        // At a zero of the open loop on the axis both parts vanish: no factor makes it -1 there.
        let r = &self.parts.reduced;
        let common = budget.enter(|| r.twice_real.gcd(&r.imaginary))?;
        let [along, across] =
            [&r.twice_real, &r.imaginary].map(|p| p.div_exact(&common).expect("a gcd divides both parts"));
        let imaginary = DeadTime::twice_imaginary(&along, &across);
        let real = self.twice_real();
        let below = DelayedAxis::of_square(&self.parts.reduced.denominator_squared).scaled_by(&Integer::from(-2));
        for omega in self.axis.zeros(&imaginary, &end, budget)? {
            let factor = self.axis.quotient(&below, &real, &omega);
            if budget.enter(|| factor.sign())?.is_gt() {
                rational.phase.push(PhaseCrossing { place: DelayedAxis::place(&omega), factor: Value::Number(factor) });
            }
        }
        Ok(rational)
    }

    /// The margins of a stable loop.
    pub fn margins(&self, crossings: &Crossings, skew: &Rational, budget: &Budget) -> Result<StableMargins, Error> {
        let zero = UniPoly::zero();
        let (d, n) = (self.parts.denominator.re.clone(), self.parts.numerator.re.clone());
        budget.step("gain margin");
        let gain = GainLoop::new(vec![d, zero.clone()], vec![zero, n], self.tau.clone());
        let gain = GainMargin::of_set(stable_factors(&gain, budget)?);
        budget.step("phase margin");
        let phase = self.phase(crossings, budget)?;
        budget.step("delay margin");
        let delay = DelayMargin::over(self.parts, crossings, budget)?;
        budget.step("modulus margin");
        let r = &self.parts.reduced;
        let both = DelayedAxis::of_square(&r.numerator_squared.plus(&r.denominator_squared));
        let sum = both.plus(&self.twice_real());
        let denominator = DelayedAxis::of_square(&r.denominator_squared);
        let modulus_at = self.extreme([&sum, &denominator], Ordering::Less, |r| Rational::ONE - r, budget)?;
        let modulus = modulus_at.root(budget)?;
        let peak_sensitivity = reciprocal(&modulus, budget)?;
        budget.step("peak of the complementary sensitivity");
        let numerator = DelayedAxis::of_square(&r.numerator_squared);
        let most = |r: &Rational| r / &(Rational::ONE - r);
        let complementary_at = self.extreme([&numerator, &sum], Ordering::Greater, most, budget)?;
        let peak_complementary = complementary_at.root(budget)?;
        budget.step("disk margin");
        let disk = self.disk(&sum, skew, budget)?;
        Ok(StableMargins {
            gain,
            phase,
            one_sided: None,
            delay,
            modulus,
            peak_sensitivity,
            modulus_at,
            peak_complementary,
            complementary_at,
            disk,
        })
    }

    /// The least angle of all crossings.
    fn phase(&self, crossings: &Crossings, budget: &Budget) -> Result<PhaseMargin, Exhausted> {
        /// Bits with which angles are compared.
        const BITS: u64 = 256;
        let size = |e: Enclosure| if e.lower().is_negative() { e.neg() } else { e };
        let mut least: Option<(usize, Enclosure)> = None;
        for (i, crossing) in crossings.gain.iter().enumerate() {
            let angle = size(budget.enter(|| crossing.phase(BITS))?);
            if least.as_ref().is_none_or(|(_, known)| angle.upper() < known.lower()) {
                least = Some((i, angle));
            }
        }
        let Some((i, _)) = least else { return Ok(PhaseMargin::Unbounded) };
        let crossing = crossings.gain[i].clone();
        let place = Some(crossing.place.clone());
        if matches!(crossing.place, Place::Lowest) && crossing.tangent_squared.is_none() {
            // Nothing turns there: exactly 180 degrees, of which half has no tangent.
            return Ok(PhaseMargin::Angle { tangent: None, place });
        }
        let tangent = enclosed("tangent of half of an angle", move |bits| {
            let half = size(crossing.phase(bits)).div(&Enclosure::from_rational(Rational::from(2)), bits)?;
            Some(tan(&Ball::from_enclosure(&half, bits))?.to_enclosure())
        });
        Ok(PhaseMargin::Angle { tangent: Some(Box::new(tangent)), place })
    }

    /// The value of `above/below`, squares of moduli in `omega`, that is `wanted` of all others; where the modulus of the open loop is below
    /// `r`, the root of the quotient is not beyond `bound(r)`, which goes to its limit as `r` falls.
    fn extreme(
        &self,
        [above, below]: [&MultiPoly; 2],
        wanted: Ordering,
        bound: impl Fn(&Rational) -> Rational,
        budget: &Budget,
    ) -> Result<Extreme, Error> {
        let below_zero = Range::between(None, Some(Rational::ZERO));
        if !zeros_in(&self.parts.reduced.denominator_squared, &below_zero, budget)?.is_empty() {
            let help = "the gain, phase and delay margins of such a loop are limits of 'intervals'";
            return Err(refused("the open loop with dead time has poles on the imaginary axis beside 0", help));
        }
        let slope = self.axis.derivative(above).times(below).minus(&above.times(&self.axis.derivative(below)));
        let at_zero = |p: &MultiPoly| {
            let p = p.substitute(0, &Rational::ZERO).0.substitute(1, &Rational::ONE).0;
            p.substitute(2, &Rational::ZERO).0.as_constant().expect("a number")
        };
        let (a, b) = (at_zero(above), at_zero(below));
        let mut ratio = 4;
        loop {
            let end = self.beyond(ratio, budget)?;
            let mut best: Option<(Place, Real)> = None;
            if !b.is_zero() {
                best = Some((Place::Lowest, Real::from(Rational::new(a.clone(), b.clone()))));
            }
            for omega in self.axis.zeros(&slope, &end, budget)? {
                let value = self.axis.quotient(above, below, &omega);
                let better = match &best {
                    None => true,
                    Some((_, known)) => value.compare(known, budget)? == wanted,
                };
                if better {
                    best = Some((DelayedAxis::place(&omega), value));
                }
            }
            let bound = bound(&Rational::new(Integer::ONE, Integer::from(ratio)));
            let square = &bound * &bound;
            if let Some((place, value)) = best
                && budget.enter(|| value.compare_rational(&square))? == wanted
            {
                return Ok(Extreme::At { place, value: Value::Number(value), attained: true });
            }
            ratio *= 4;
        }
    }

    /// The least `2 |1 + L|/|(1 + skew) - (1 - skew) L|`.
    fn disk(&self, sum: &MultiPoly, skew: &Rational, budget: &Budget) -> Result<DiskMargin, Error> {
        let r = &self.parts.reduced;
        let (p, q) = (skew.numerator(), skew.denominator());
        let (of_one, of_loop) = (&q + &p, &q - &p);
        let squares = r
            .denominator_squared
            .scaled(&(&of_one * &of_one))
            .plus(&r.numerator_squared.scaled(&(&of_loop * &of_loop)));
        let below = DelayedAxis::of_square(&squares).minus(&self.twice_real().scaled_by(&(&of_one * &of_loop)));
        let four = Integer::from(4) * &(&q * &q);
        let (one, other) = (Rational::from(&of_one), Rational::from(&of_loop).abs());
        if of_one.is_zero() {
            return Err(refused(
                "the disk margin of a loop with dead time is known for skews other than -1",
                "--skew 0",
            ));
        }
        let twice = Rational::from(2) * Rational::from(&q);
        let floor = |r: &Rational| &(&twice * &(Rational::ONE - r)) / &(one.abs() + &other * r);
        let extreme = self.extreme([&sum.scaled_by(&four), &below], Ordering::Less, floor, budget)?;
        let square = extreme.value().expect("finite somewhere").number(budget)?;
        let alpha = Some(square_root(&square, budget)?);
        Ok(DiskMargin { skew: skew.clone(), alpha, extreme: Some(extreme) })
    }
}
