//! Margins of continuous loops with dead time, `L = N/D0 exp(-tau s)`.
//!
//! The modulus of the exponential is one on the axis, so the crossings of modulus one are algebraic; the phase turns by
//! `-omega tau`. Where the open loop is real, and the extremes of `|1 + L|`, are zeros of polynomials in `omega`,
//! `cos(tau omega)` and `sin(tau omega)`: isolated with enclosures ([`MovingSymbols::zeros_in`]) up to a frequency beyond
//! which the modulus of the open loop tells that there is nothing to find.

use super::crossings::{Crossings, PhaseCrossing};
use super::delayed_axis::{DelayedAxis, place_of};
use super::delayed_peak::DelayedQuotient;
use super::enclosed::enclosed;
use super::ground::Ground;
use super::margins::{GainMargin, PhaseMargin, StableMargins};
use super::met::{has_gain_margin, has_phase_margin};
use super::open_loop::OpenLoop;
use super::parts::Parts;
use super::requirement::{Requirement, Rule};
use super::value::reciprocal;
use super::{DelayMargin, DiskMargin, Extreme, Place, Value};
use crate::error::Error;
use crate::problem::refused;
use crate::stability::Range;
use jurist_algebra::ball::{Ball, tan};
use jurist_algebra::limits::{Budget, Exhausted, try_until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use std::cmp::Ordering;

/// The rational factor of the open loop and its dead time.
pub(super) struct DeadTime<'a, G: Ground> {
    parts: &'a Parts<G>,
    tau: &'a Rational,
    axis: DelayedAxis<G>,
}

/// Phase crossings are listed where the open loop's modulus is above one over this.
const LISTED: i64 = 100;

impl<'a, G: Ground> DeadTime<'a, G> {
    pub fn new(parts: &'a Parts<G>, tau: &'a Rational) -> DeadTime<'a, G> {
        DeadTime { parts, tau, axis: DelayedAxis::new(&parts.ground, tau.clone()) }
    }

    /// Twice the real part of `N conj(D0) exp(-j omega tau)`.
    fn twice_real(&self) -> MultiPoly {
        let r = &self.parts.reduced;
        let turned = self.axis.of_square(&r.imaginary).times(&MultiPoly::variable(0)).scaled_by(&Integer::from(2));
        let along = self.axis.of_square(&r.twice_real).times(&MultiPoly::variable(1));
        along.plus(&turned.times(&MultiPoly::variable(2)))
    }

    /// Twice its imaginary part, from twice the real part of `N conj(D0)` and from the imaginary part over `omega`.
    fn twice_imaginary(&self, along: &Poly<G::Number>, across: &Poly<G::Number>) -> MultiPoly {
        let turned = self.axis.of_square(across).times(&MultiPoly::variable(0)).scaled_by(&Integer::from(2));
        turned.times(&MultiPoly::variable(1)).minus(&self.axis.of_square(along).times(&MultiPoly::variable(2)))
    }

    /// An angular frequency beyond which the modulus of the open loop is below a hundredth, or where it does not fall as far, below a number between its limit
    /// and one.
    fn beyond(&self, budget: &Budget) -> Result<Rational, Error> {
        let Some(level) = self.level(budget)? else {
            let help = "such a loop bears no delay, and its gain margin is a limit of 'intervals'";
            return Err(refused(
                "the modulus of the open loop with dead time is one or more at high frequencies",
                help,
            ));
        };
        let r = &self.parts.reduced;
        let [up, down] = [level.numerator(), level.denominator()].map(|c| G::Number::from_integer(&c));
        let excess = r.numerator_squared.scaled(&down).minus(&r.denominator_squared.scaled(&up));
        let zeros = self.parts.ground.zeros(&excess, &Range::between(None, Some(Rational::ZERO)), budget)?;
        Ok(match zeros.first() {
            // x = -omega^2 of the highest frequency.
            Some(x) => {
                let (lowest, _) = x.refined(&Rational::ONE).enclosure();
                Enclosure::from_rational(-lowest).sqrt(32).upper() + &Rational::ONE
            }
            None => Rational::ONE,
        })
    }

    /// A number below one and above the limit of the squared modulus at high frequencies; `None` where that limit is one or more.
    fn level(&self, budget: &Budget) -> Result<Option<Rational>, Error> {
        let r = &self.parts.reduced;
        let (above, below) = (&r.numerator_squared, &r.denominator_squared);
        let beside =
            |limit: &Rational, part: i64| limit + &(&(Rational::ONE - limit) * &Rational::new(1.into(), part.into()));
        match above.degree().cmp(&below.degree()) {
            Ordering::Less => return Ok(Some(beside(&Rational::ZERO, LISTED * LISTED))),
            Ordering::Greater => return Ok(None),
            Ordering::Equal => {}
        }
        let [above, below] = [above, below].map(|p| p.leading().cloned().expect("not zero"));
        let ground = &self.parts.ground;
        // Leading coefficients of polynomials in s^2 < 0 have either sign.
        if ground.sign(&above.minus(&below).times(&below), budget)?.is_ge() {
            return Ok(None);
        }
        // Toward a limit that is not 0 crossings go on without end.
        let limit = ground.quotient(&above, &below, budget)?;
        let level = try_until_shown(64, |bits| -> Result<Option<Rational>, Exhausted> {
            budget.check()?;
            let limit = budget.enter(|| limit.enclosure(bits))?;
            Ok(Some(beside(limit.upper(), LISTED)).filter(|_| *limit.upper() < Rational::ONE))
        })?;
        Ok(Some(level))
    }

    /// All crossings of modulus one, and those of the negative real axis down to a hundredth.
    pub fn crossings(&self, rational: Crossings, budget: &Budget) -> Result<Crossings, Error> {
        let mut rational = self.turned_by_all(rational);
        rational.phase.retain(|c| matches!(c.place, Place::Lowest));
        rational.phase_everywhere = false;
        let end = self.beyond(budget)?;
        // At a zero of the open loop on the axis both parts vanish: no factor makes it -1 there.
        let r = &self.parts.reduced;
        let common = budget.enter(|| r.twice_real.gcd(&r.imaginary))?;
        let [along, across] =
            [&r.twice_real, &r.imaginary].map(|p| p.div_exact(&common).expect("a gcd divides both parts"));
        let imaginary = self.twice_imaginary(&along, &across);
        let real = self.twice_real();
        let below = self.axis.of_square(&self.parts.reduced.denominator_squared).scaled_by(&Integer::from(-2));
        for omega in self.axis.zeros(&imaginary, &end, budget)? {
            let factor = self.axis.quotient(&below, &real, &omega);
            if budget.enter(|| factor.sign())?.is_gt() {
                rational.phase.push(PhaseCrossing { place: place_of(&omega), factor: Value::Number(factor) });
            }
        }
        Ok(rational)
    }

    /// The margins of a stable loop.
    pub fn margins(&self, crossings: &Crossings, skew: &Rational, budget: &Budget) -> Result<StableMargins, Error> {
        budget.step("gain margin");
        let gain = self.gain(budget)?;
        budget.step("phase margin");
        let phase = self.phase(crossings, budget)?;
        budget.step("delay margin");
        let delay = DelayMargin::over(self.parts, crossings, budget)?;
        budget.step("modulus margin");
        let [d, n] = [&self.parts.denominator.re, &self.parts.numerator.re];
        let sensitivity = self.peak(vec![d.clone()], budget)?;
        let peak_sensitivity = sensitivity.root(budget)?;
        let modulus = reciprocal(&peak_sensitivity, budget)?;
        let modulus_at = inverse(sensitivity, &Rational::ONE, budget)?;
        budget.step("peak of the complementary sensitivity");
        let complementary_at = self.peak(vec![Poly::zero(), n.clone()], budget)?;
        let peak_complementary = complementary_at.root(budget)?;
        budget.step("disk margin");
        let disk = self.disk(skew, budget)?;
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

    /// Whether a stable loop meets a requirement on a margin; no other margins are computed.
    pub fn meets(&self, requirement: &Requirement, open_loop: &OpenLoop, budget: &Budget) -> Result<bool, Error> {
        Ok(match requirement.rule() {
            Rule::Factors(factor) => has_gain_margin(&self.gain(budget)?, factor, budget)?,
            Rule::Turned { twice_cosine } => {
                let crossings = self.turned_by_all(Crossings::of(open_loop, budget)?);
                has_phase_margin(&self.phase(&crossings, budget)?, twice_cosine, budget)?
            }
            Rule::Circle(circle) => {
                let [u, v] = circle.combined().map(|c| G::Number::from_integer(&c.into()));
                let [d, n] = [&self.parts.denominator.re, &self.parts.numerator.re];
                let peak = self.peak(vec![d.scaled(&u), n.scaled(&v)], budget)?;
                match ((circle.least() * circle.least()).recip(), peak.value()) {
                    (Some(most), Some(peak)) => peak.compare(&Value::from(most), budget)?.is_le(),
                    (least, _) => least.is_none(),
                }
            }
            Rule::Sector(_) | Rule::Modulus { .. } | Rule::DeadTime(_) => unreachable!("about roots, or of all loops"),
        })
    }

    /// The crossings of modulus one with the dead time.
    fn turned_by_all(&self, mut rational: Crossings) -> Crossings {
        for crossing in &mut rational.gain {
            crossing.dead_time = Some(self.tau.clone());
        }
        rational
    }

    /// The stable factors.
    fn gain(&self, budget: &Budget) -> Result<GainMargin, Error> {
        let parts = [&self.parts.denominator.re, &self.parts.numerator.re];
        Ok(GainMargin::of_set(self.parts.ground.stable_factors_with_delay(parts, self.tau, budget)?))
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

    /// The greatest modulus of a quotient whose denominator is that of the closed loop.
    fn peak(&self, above: Vec<Poly<G::Number>>, budget: &Budget) -> Result<Extreme, Exhausted> {
        let below = vec![self.parts.denominator.re.clone(), self.parts.numerator.re.clone()];
        DelayedQuotient::new(&self.parts.ground, self.tau.clone(), above, below).peak(budget)
    }

    /// The least `2 |1 + L|/|(1 + skew) - (1 - skew) L|`.
    fn disk(&self, skew: &Rational, budget: &Budget) -> Result<DiskMargin, Exhausted> {
        let (p, q) = (skew.numerator(), skew.denominator());
        let [d, n] = [&self.parts.denominator.re, &self.parts.numerator.re];
        let [sum, difference] = [&q + &p, &p - &q].map(|c| G::Number::from_integer(&c));
        let peak = self.peak(vec![d.scaled(&sum), n.scaled(&difference)], budget)?;
        let extreme = inverse(peak, &Rational::from(Integer::from(4) * &(&q * &q)), budget)?;
        let alpha = Some(extreme.root(budget)?);
        Ok(DiskMargin { skew: skew.clone(), alpha, extreme: Some(extreme) })
    }
}

/// A number over an extreme value that is not zero, as an extreme.
fn inverse(extreme: Extreme, number: &Rational, budget: &Budget) -> Result<Extreme, Exhausted> {
    let over = |value: Value| -> Result<Value, Exhausted> {
        let inverse = reciprocal(&value.number(budget)?, budget)?;
        if let Some(exact) = inverse.exact() {
            return Ok(Value::from(&exact * number));
        }
        let factor = Enclosure::from_rational(number.clone());
        Ok(Value::Number(enclosed("a number over an extreme", move |bits| {
            Some(super::enclosed::within(&inverse, bits).mul(&factor, bits))
        })))
    };
    Ok(match extreme {
        Extreme::Constant(value) => Extreme::Constant(over(value)?),
        Extreme::At { place, value, attained } => Extreme::At { place, value: over(value)?, attained },
        Extreme::Infinite(_) => unreachable!("a stable loop has no pole on the axis"),
    })
}
