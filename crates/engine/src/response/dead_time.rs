//! Margins of continuous loops with dead time, `L = N/D0 exp(-tau s)`.
//!
//! The modulus of the exponential is one on the axis, so the crossings of modulus one are algebraic; the phase turns by
//! `-omega tau`. Where the open loop is real, and the extremes of `|1 + L|`, are zeros of polynomials in `omega`,
//! `cos(tau omega)` and `sin(tau omega)`: isolated with enclosures ([`MovingSymbols::zeros_in`]) up to a frequency beyond
//! which the modulus of the open loop tells that there is nothing to find.

use super::complex_poly::ComplexPoly;
use super::crossings::{Crossings, PhaseCrossing};
use super::delayed_axis::DelayedAxis;
use super::delayed_factors::DelayedFactors;
use super::delayed_peak::DelayedQuotient;
use super::enclosed::{enclosed, within};
use super::ground::Ground;
use super::margins::{GainMargin, PhaseMargin, StableMargins};
use super::met::{has_gain_margin, has_phase_margin};
use super::open_loop::OpenLoop;
use super::parts::Parts;
use super::requirement::{Requirement, Rule};
use super::value::reciprocal;
use super::{DelayMargin, DiskMargin, Extreme, OneSided, Place, Value};
use crate::error::Error;
use crate::problem::refused;
use crate::stability::{Range, StableSet};
use jurist_algebra::ball::{Ball, tan};
use jurist_algebra::limits::{Budget, Exhausted, Stop, try_until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// The rational factor of the open loop and its dead time.
pub(super) struct DeadTime<'a, G: Ground> {
    pub(super) parts: &'a Parts<G>,
    pub(super) tau: &'a Rational,
    pub(super) axis: DelayedAxis<G>,
}

/// Phase crossings are listed where the open loop's modulus is above one over this.
const LISTED: i64 = 100;

impl<'a, G: Ground> DeadTime<'a, G> {
    pub fn new(parts: &'a Parts<G>, tau: &'a Rational) -> DeadTime<'a, G> {
        DeadTime { parts, tau, axis: DelayedAxis::new(&parts.ground, tau.clone(), parts.frequencies()) }
    }

    /// Twice the real part of `N conj(D0) exp(-j omega tau)`.
    fn twice_real(&self) -> MultiPoly {
        let r = &self.parts.reduced;
        let turned = self.axis.odd(&r.imaginary).scaled_by(&Integer::from(2));
        let along = self.axis.even(&r.twice_real).times(&MultiPoly::variable(1));
        along.plus(&turned.times(&MultiPoly::variable(2)))
    }

    /// Twice its imaginary part, without what both parts of `N conj(D0)` have in common. At a zero of the open loop on the axis both parts vanish: no factor
    /// makes it -1 there. And what they have in common.
    fn twice_imaginary(&self, budget: &Budget) -> Result<(MultiPoly, Poly<G::Number>), Exhausted> {
        let r = &self.parts.reduced;
        let common = budget.enter(|| r.twice_real.gcd(&r.imaginary))?;
        let [along, across] =
            [&r.twice_real, &r.imaginary].map(|p| p.div_exact(&common).expect("a gcd divides both parts"));
        let turned = self.axis.odd(&across).scaled_by(&Integer::from(2));
        let imaginary =
            turned.times(&MultiPoly::variable(1)).minus(&self.axis.even(&along).times(&MultiPoly::variable(2)));
        Ok((imaginary, common))
    }

    /// An angular frequency beyond which the modulus of the open loop is below one over a number, or where it does not fall as far, below a number between its
    /// limit and one; and the square of what it is below.
    fn beyond(&self, listed: &Integer, budget: &Budget) -> Result<[Rational; 2], Error> {
        let Some(level) = self.level(listed, budget)? else {
            let help = "such a loop bears no delay, and its gain margin is a limit of 'intervals'";
            return Err(refused(
                "the modulus of the open loop with dead time is one or more at high frequencies",
                help,
            ));
        };
        let r = &self.parts.reduced;
        let [up, down] = [level.numerator(), level.denominator()].map(|c| G::Number::from_integer(&c));
        let excess = r.numerator_squared.scaled(&down).minus(&r.denominator_squared.scaled(&up));
        Ok([self.beyond_zeros(&excess, budget)?, level])
    }

    /// An angular frequency beyond all zeros of a polynomial in the variable of the frequencies.
    fn beyond_zeros(&self, p: &Poly<G::Number>, budget: &Budget) -> Result<Rational, Exhausted> {
        let frequencies = self.parts.frequencies();
        let zeros = self.parts.ground.zeros(p, &frequencies.inner(), budget)?;
        let size = |x: &Real| {
            let (low, high) = x.refined(&Rational::ONE).enclosure();
            let size = low.abs().max(high.abs());
            // Else x is -omega^2.
            if frequencies.are_signed() { size } else { Enclosure::from_rational(size).sqrt(32).upper().clone() }
        };
        let furthest = zeros.first().into_iter().chain(zeros.last()).map(size).max();
        Ok(furthest.unwrap_or(Rational::ZERO) + Rational::ONE)
    }

    /// A number below one and above the limit of the squared modulus at high frequencies; `None` where that limit is one or more.
    fn level(&self, listed: &Integer, budget: &Budget) -> Result<Option<Rational>, Error> {
        let r = &self.parts.reduced;
        let (above, below) = (&r.numerator_squared, &r.denominator_squared);
        let beside = |limit: &Rational, part: &Integer| {
            limit + &(&(Rational::ONE - limit) * &Rational::new(1.into(), part.clone()))
        };
        match above.degree().cmp(&below.degree()) {
            Ordering::Less => return Ok(Some(beside(&Rational::ZERO, &(listed * listed)))),
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
            Ok(Some(beside(limit.upper(), listed)).filter(|_| *limit.upper() < Rational::ONE))
        })?;
        Ok(Some(level))
    }

    /// All crossings of modulus one, and those of the negative real axis down to a hundredth.
    pub fn crossings(&self, rational: Crossings, budget: &Budget) -> Result<Crossings, Error> {
        let mut rational = self.turned_by_all(rational);
        let frequencies = self.parts.frequencies();
        rational.phase.retain(|c| c.place.is_at_rest(frequencies));
        rational.phase_everywhere = false;
        let [end, _] = self.beyond(&Integer::from(LISTED), budget)?;
        let (mut below, mut above) = (Vec::new(), Vec::new());
        for (omega, factor) in self.factors(&end, budget)? {
            if budget.enter(|| factor.sign())?.is_gt() {
                let list = if omega.sign().is_lt() { &mut below } else { &mut above };
                list.push(PhaseCrossing { place: self.axis.place_of(&omega), factor: Value::Number(factor) });
            }
        }
        rational.phase = below.into_iter().chain(rational.phase).chain(above).collect();
        Ok(rational)
    }

    /// The frequencies other than 0 and up to a size at which the open loop is real, ascending, with the factors that make it -1 there.
    fn factors(&self, end: &Rational, budget: &Budget) -> Result<Vec<(Real, Real)>, Error> {
        let ((imaginary, common), real) = (self.twice_imaginary(budget)?, self.twice_real());
        let below = self.axis.even(&self.parts.reduced.denominator_squared).scaled_by(&Integer::from(-2));
        let zeros = self.axis.zeros(&imaginary, end, budget)?;
        // At a pole or a zero a root stays near the axis as the factor falls to 0, or grows.
        self.axis.keep_clear(&zeros, &common, self.parts.frequencies(), budget)?;
        Ok(zeros.into_iter().map(|omega| (omega.clone(), self.axis.quotient(&below, &real, &omega))).collect())
    }

    /// The margins of a stable loop.
    pub fn margins(&self, crossings: &Crossings, skew: &Rational, budget: &Budget) -> Result<StableMargins, Error> {
        budget.step("gain margin");
        let gain = self.gain(budget)?;
        budget.step("phase margin");
        let (one_sided, phase) = match self.parts.frequencies().are_signed() {
            true => {
                let one_sided = OneSided::with_dead_time(self.parts, crossings, budget)?;
                let phase = one_sided.smaller(budget)?;
                (Some(one_sided), phase)
            }
            false => (None, self.phase(crossings, budget)?),
        };
        budget.step("delay margin");
        let delay = DelayMargin::over(self.parts, crossings, budget)?;
        budget.step("modulus margin");
        let [d, n] = [&self.parts.denominator, &self.parts.numerator];
        let sensitivity = self.peak(vec![d.clone()], budget)?;
        let peak_sensitivity = sensitivity.root(budget)?;
        let modulus = reciprocal(&peak_sensitivity, budget)?;
        let modulus_at = inverse(sensitivity, &Rational::ONE, budget)?;
        budget.step("peak of the complementary sensitivity");
        let complementary_at = self.peak(vec![ComplexPoly::from(Poly::zero()), n.clone()], budget)?;
        let peak_complementary = complementary_at.root(budget)?;
        budget.step("disk margin");
        let disk = self.disk(skew, budget)?;
        Ok(StableMargins {
            gain,
            phase,
            one_sided,
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
                let [d, n] = [&self.parts.denominator, &self.parts.numerator];
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
        if self.parts.frequencies().are_signed() {
            return Ok(GainMargin::of_set(self.stable_factors(budget)?));
        }
        let parts = [&self.parts.denominator.re, &self.parts.numerator.re];
        let set = match self.parts.ground.stable_factors_with_delay(parts, self.tau, budget) {
            // Beside constants, where several roots are on the axis at one factor, as at the factor 0 with two integrators.
            Err(stopped @ Error::Stopped(Exhausted { stop: Stop::Method(_), .. })) => {
                match self.stable_factors(budget) {
                    Err(Error::Refused(_)) => return Err(stopped),
                    found => found?,
                }
            }
            found => found?,
        };
        Ok(GainMargin::of_set(set))
    }

    fn stable_factors(&self, budget: &Budget) -> Result<StableSet, Error> {
        let parts = self.parts;
        let family = parts.ground.family_of_factors(&parts.in_factor(), self.tau);
        let (open, back) = (vec![parts.denominator.clone()], (parts.numerator.clone(), 1));
        DelayedFactors::new(&parts.ground, self.tau.clone(), open, back, family).stable_set(&Range::all(), &[], budget)
    }

    /// The least angle of all crossings.
    fn phase(&self, crossings: &Crossings, budget: &Budget) -> Result<PhaseMargin, Exhausted> {
        let size = |e: Enclosure| if e.lower().is_negative() { e.neg() } else { e };
        let least = crossings.least(|crossing, bits| size(crossing.phase(bits)), budget)?;
        let Some(crossing) = least.cloned() else { return Ok(PhaseMargin::Unbounded) };
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
    fn peak(&self, above: Vec<ComplexPoly<G::Number>>, budget: &Budget) -> Result<Extreme, Exhausted> {
        let below = vec![self.parts.denominator.clone(), self.parts.numerator.clone()];
        DelayedQuotient::new(&self.parts.ground, self.tau.clone(), above, below).peak(budget)
    }

    /// The least `2 |1 + L|/|(1 + skew) - (1 - skew) L|`.
    fn disk(&self, skew: &Rational, budget: &Budget) -> Result<DiskMargin, Exhausted> {
        let (p, q) = (skew.numerator(), skew.denominator());
        let [d, n] = [&self.parts.denominator, &self.parts.numerator];
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
            Some(within(&inverse, bits).mul(&factor, bits))
        })))
    };
    Ok(match extreme {
        Extreme::Constant(value) => Extreme::Constant(over(value)?),
        Extreme::At { place, value, attained } => Extreme::At { place, value: over(value)?, attained },
        Extreme::Infinite(_) => unreachable!("a stable loop has no pole on the axis"),
    })
}
