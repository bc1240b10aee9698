//! By how much an open loop with complex coefficients may turn in each sense.
//!
//! With `L = -exp(j phi)` the open loop is -1 after a lag of `phi`, from 0 to one turn, and after a lead of one turn less `phi`. The cotangent of `phi/2` is
//! `-2 Im(N conj(D0))/|D0 + N|^2`, falls as `phi` grows, and is finite where the loop is stable. So the greatest cotangent is that of the least lag,
//! and the least one is that of the least lead.

use super::crossings::{COMPARED_BITS, Crossings, GainCrossing};
use super::disk::degrees;
use super::enclosed::{enclosed, greater, within};
use super::extreme::extreme_over;
use super::ground::Ground;
use super::open_loop::OpenLoop;
use super::parts::{Parts, with_parts};
use super::value::reciprocal;
use super::{PhaseMargin, Place, Value};
use jurist_algebra::ball::{Ball, cos_sin};
use jurist_algebra::limits::{Budget, Exhausted, Stop};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, Poly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;

/// The smallest rotations that bring a stable loop to the boundary.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct OneSided {
    /// In the sense of a delay; `None` where the modulus is nowhere one.
    pub lag: Option<Rotation>,
    /// In the other sense.
    pub lead: Option<Rotation>,
}

/// A rotation by less than one turn.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Rotation {
    /// The cotangent of half its angle: negative beyond 180 degrees.
    pub cotangent: Real,
    /// The frequency at which it binds; `None` where that is all.
    pub place: Option<Place>,
}

impl OneSided {
    /// Of a stable loop; `None` where its coefficients are real.
    pub(super) fn of(
        open_loop: &OpenLoop,
        crossings: &Crossings,
        budget: &Budget,
    ) -> Result<Option<OneSided>, Exhausted> {
        if !open_loop.frequencies().are_signed() {
            return Ok(None);
        }
        with_parts!(open_loop, parts => OneSided::over(parts, crossings, budget)).map(Some)
    }

    fn over<G: Ground>(parts: &Parts<G>, crossings: &Crossings, budget: &Budget) -> Result<OneSided, Exhausted> {
        let greatest = |factor: i64| {
            let above = parts.reduced.imaginary.scaled(&G::Number::from_integer(&Integer::from(factor)));
            Rotation::of_greatest(&above, parts, crossings, budget)
        };
        Ok(OneSided { lag: greatest(-2)?, lead: greatest(2)? })
    }

    /// Of a stable loop with dead time, whose crossings know it.
    pub(super) fn with_dead_time<G: Ground>(
        parts: &Parts<G>,
        crossings: &Crossings,
        budget: &Budget,
    ) -> Result<OneSided, Exhausted> {
        Ok(OneSided {
            lag: Rotation::of_least(GainCrossing::lag, -2, parts, crossings, budget)?,
            lead: Rotation::of_least(GainCrossing::lead, 2, parts, crossings, budget)?,
        })
    }

    /// The smaller of both, which is at most 180 degrees; where enclosures do not tell which it is, as where both are the same, the lag.
    pub(super) fn smaller(&self, budget: &Budget) -> Result<PhaseMargin, Exhausted> {
        let (Some(lag), Some(lead)) = (&self.lag, &self.lead) else { return Ok(PhaseMargin::Unbounded) };
        if let Some(both) = budget.enter(|| lag.nearly_as(lead))? {
            if budget.enter(|| within(&both, COMPARED_BITS))?.contains(&Rational::ZERO) {
                return Err(Exhausted::new(Stop::Separation, "a phase margin of 180 degrees"));
            }
            return Ok(PhaseMargin::Angle { tangent: Some(Box::new(both.recip())), place: lag.place.clone() });
        }
        let is_lead = match lead.cotangent.compare(&lag.cotangent, budget) {
            Err(stopped) if stopped.stop.is_precision() => false,
            order => order?.is_gt(),
        };
        let Rotation { cotangent, place } = if is_lead { lead } else { lag };
        let tangent = match budget.enter(|| cotangent.sign())? {
            Sign::Equal => None,
            _ => Some(Box::new(reciprocal(cotangent, budget)?)),
        };
        Ok(PhaseMargin::Angle { tangent, place: place.clone() })
    }
}

impl OneSided {
    /// Whether both are at least the angle whose half has this cotangent.
    pub(super) fn are_at_least(&self, cotangent: &Real, budget: &Budget) -> Result<bool, Exhausted> {
        for rotation in [&self.lag, &self.lead].into_iter().flatten() {
            if rotation.cotangent.compare(cotangent, budget)?.is_gt() {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

impl Rotation {
    /// By the least angle, in one sense, of all crossings of a loop with dead time.
    fn of_least<G: Ground>(
        angle: fn(&GainCrossing, u64) -> Enclosure,
        factor: i64,
        parts: &Parts<G>,
        crossings: &Crossings,
        budget: &Budget,
    ) -> Result<Option<Rotation>, Exhausted> {
        let Some(crossing) = crossings.least(angle, budget)?.cloned() else { return Ok(None) };
        let place = Some(crossing.place.clone());
        if crossing.is_at_rest() {
            let r = &parts.reduced;
            let above = r.imaginary.scaled(&G::Number::from_integer(&Integer::from(factor)));
            let value = parts.ground.value(&above, &r.sum_squared, &crossing.place, r.frequencies, budget)?;
            let cotangent = value.expect("a stable loop is nowhere -1").number(budget)?;
            return Ok(Some(Rotation { cotangent, place }));
        }
        let two = Enclosure::from_rational(Rational::from(2));
        let cotangent = enclosed("cotangent of half of an angle", move |bits| {
            let half = angle(&crossing, bits).div(&two, bits)?;
            let (cosine, sine) = cos_sin(&Ball::from_enclosure(&half, bits));
            Some(cosine.div(&sine)?.to_enclosure())
        });
        Ok(Some(Rotation { cotangent, place }))
    }

    /// The greater cotangent of two that enclosures hardly tell apart, as those of a loop that is a real one seen from a frame that turns.
    fn nearly_as(&self, other: &Rotation) -> Option<Real> {
        let (own, other) = (self.cotangent.clone(), other.cotangent.clone());
        if own.algebraic().is_some() || other.algebraic().is_some() {
            return None;
        }
        let [a, b] = [within(&own, COMPARED_BITS), within(&other, COMPARED_BITS)];
        if a.upper() < b.lower() || b.upper() < a.lower() {
            return None;
        }
        Some(greater(own, other))
    }

    /// With the greatest cotangent `above/|D0 + N|^2` where the modulus is one.
    fn of_greatest<G: Ground>(
        above: &Poly<G::Number>,
        parts: &Parts<G>,
        crossings: &Crossings,
        budget: &Budget,
    ) -> Result<Option<Rotation>, Exhausted> {
        const FINITE: &str = "a stable loop is nowhere -1";
        let (r, ground) = (&parts.reduced, &parts.ground);
        let mut best: Option<(Value, Option<Place>)> = None;
        if crossings.gain_everywhere {
            let common = |a: &_, b: &_| r.common(a, b);
            let quotient = [above, &r.sum_squared];
            let extreme = extreme_over(ground, quotient, &common, r.frequencies, Ordering::Greater, budget)?;
            best = Some((extreme.value().expect(FINITE), extreme.place().cloned()));
        }
        for crossing in &crossings.gain {
            let value = ground.value(above, &r.sum_squared, &crossing.place, r.frequencies, budget)?.expect(FINITE);
            let better = match &best {
                None => true,
                Some((known, _)) => value.compare(known, budget)?.is_gt(),
            };
            if better {
                best = Some((value, Some(crossing.place.clone())));
            }
        }
        best.map(|(value, place)| Ok(Rotation { cotangent: value.number(budget)?, place })).transpose()
    }

    /// The angle in degrees, in `(0, 360)`.
    pub fn degrees(&self, bits: u64) -> Enclosure {
        let working = bits + 16;
        if let Some(degrees) = self.known_degrees() {
            return Enclosure::from_rational(Rational::from(degrees));
        }
        degrees(&self.half(working).mul(&Enclosure::from_rational(Rational::from(2)), working), bits)
    }

    /// Half the angle in radians.
    fn half(&self, working: u64) -> Enclosure {
        let near = within(&self.cotangent, working);
        if near.lower().abs() < Rational::ONE && near.upper().abs() < Rational::ONE {
            // It may be 0, which enclosures do not tell.
            let quarter =
                Enclosure::pi(working).mul(&Enclosure::from_rational(Rational::new(1.into(), 2.into())), working);
            return quarter.sub(&near.atan(working), working);
        }
        let cotangent = Value::Number(self.cotangent.clone()).enclosure(working);
        let one = Enclosure::from_rational(Rational::ONE);
        let tangent = one.div(&cotangent, working).expect("digits tell a number from zero");
        let half = tangent.atan(working);
        match half.upper().sign() {
            Ordering::Less => Enclosure::pi(working).add(&half, working),
            _ => half,
        }
    }

    /// The angle where its cosine is rational.
    fn known_degrees(&self) -> Option<i64> {
        let coefficients: Vec<Option<i64>> =
            self.cotangent.algebraic()?.polynomial().coeffs().iter().map(|c| c.to_i64()).collect();
        let is_negative = self.cotangent.sign().is_lt();
        let within = match coefficients.as_slice() {
            [Some(0), Some(1)] => 180,
            [Some(-1), Some(1)] | [Some(1), Some(1)] => 90,
            [Some(-3), Some(0), Some(1)] => 60,
            [Some(-1), Some(0), Some(3)] => 120,
            _ => return None,
        };
        Some(if is_negative { 360 - within } else { within })
    }
}
