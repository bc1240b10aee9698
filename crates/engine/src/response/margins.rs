//! All margins of a loop cut at one signal.

use super::crossings::Crossings;
use super::dead_time::DeadTime;
use super::extreme::{complementary_extreme, extreme_over, modulus_extreme};
use super::ground::Ground;
use super::open_loop::OpenLoop;
use super::parts::{Parts, with_parts};
use super::value::{reciprocal, square_root};
use super::{DelayMargin, DiskMargin, Extreme, HeldDelay, OneSided, Place, Value};
use crate::answer::{Answer, Frequency, PointVerdict, Verdict};
use crate::error::Error;
use crate::problem::{Problem, Question};
use crate::stability::{End, StableSet};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::Domain;
use jurist_algebra::real::Real;
use std::cmp::Ordering;
use std::sync::Arc;

/// How far a loop is from instability, with respect to what happens at one signal.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_engine::model::{BlockBuilder, Model, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .inputs(["r"])
///     .outputs(["y"])
///     .block(BlockBuilder::new("controller", "r - y", "u").gain("1/2"))
///     .block(BlockBuilder::new("plant", "u", "y").transfer("1/z"))
///     .build()?;
/// let answer = model.ask().margins(None, &Rational::ZERO, &Budget::unlimited())?; // 0.5/z
/// let margins = answer.value().stable.as_ref().unwrap();
/// assert_eq!(margins.gain.upper.as_ref().unwrap().value.decimal(6), "2");
/// assert_eq!(margins.modulus.decimal(6), "0.5");
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Margins {
    /// The open loop.
    pub open_loop: OpenLoop,
    /// The closed loop's verdict: only a stable loop has margins.
    pub verdict: PointVerdict,
    /// The margins of a stable loop.
    pub stable: Option<StableMargins>,
    /// The dead time that a stable loop through a plant behind a hold bears.
    pub held_delay: Option<HeldDelay>,
    /// All crossings, also of an unstable loop.
    pub crossings: Crossings,
}

/// The margins of a stable loop.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct StableMargins {
    /// The stable factors.
    pub gain: GainMargin,
    /// By how much the open loop may turn, either way.
    pub phase: PhaseMargin,
    /// The same each way, of a loop with complex coefficients.
    pub one_sided: Option<OneSided>,
    /// How much delay is borne.
    pub delay: DelayMargin,
    /// The modulus margin: the least value of `|1 + L|`.
    pub modulus: Real,
    /// Its inverse, the peak of the sensitivity `1/(1 + L)`.
    pub peak_sensitivity: Real,
    /// Where: the extreme of the square of the modulus margin.
    pub modulus_at: Extreme,
    /// The peak of the complementary sensitivity `L/(1 + L)`.
    pub peak_complementary: Real,
    /// Where: the extreme of its square.
    pub complementary_at: Extreme,
    /// The disk margin.
    pub disk: DiskMargin,
}

/// For which factors at the cut the loop is stable.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GainMargin {
    /// All of them, the negative ones too.
    pub set: StableSet,
    /// The least factor above 1 at which it is not; `None` if there is none.
    pub upper: Option<End>,
    /// The greatest factor below 1 at which it is not, not below 0; `None` if there is none.
    pub lower: Option<End>,
}

/// By how much the open loop may be turned around 0 before it meets -1.
#[derive(Clone, Debug)]
pub enum PhaseMargin {
    /// Any angle: the modulus is nowhere one.
    Unbounded,
    /// Less than an angle.
    Angle {
        /// `tan(phi/2)`; `None` for 180 degrees.
        tangent: Option<Box<Real>>,
        /// The frequency; `None` where it is all.
        place: Option<Place>,
    },
}

impl PhaseMargin {
    /// The angle in degrees; `None` where there is no bound.
    pub fn degrees(&self, bits: u64) -> Option<Enclosure> {
        let tangent = match self {
            PhaseMargin::Unbounded => return None,
            PhaseMargin::Angle { tangent: None, .. } => return Some(Enclosure::from_rational(Rational::from(180))),
            PhaseMargin::Angle { tangent: Some(tangent), .. } => tangent,
        };
        // tan(phi/2) of the angles whose cosine is rational.
        let coefficients = tangent.algebraic().map(|t| t.polynomial().coeffs().iter().map(|c| c.to_i64()).collect());
        let known = match coefficients.unwrap_or_else(Vec::new).as_slice() {
            [Some(-1), Some(0), Some(3)] => Some(60),
            [Some(-1), Some(1)] => Some(90),
            [Some(-3), Some(0), Some(1)] => Some(120),
            _ => None,
        };
        if let Some(degrees) = known {
            return Some(Enclosure::from_rational(Rational::from(degrees)));
        }
        let working = bits + 16;
        let half = Value::Number((**tangent).clone()).enclosure(working).atan(working);
        Some(super::disk::degrees(&half.mul(&Enclosure::from_rational(Rational::from(2)), working), bits))
    }
}

impl Question {
    /// The margins of the loop cut at a signal, a block's input, or a gain ([`Model::cut`](crate::model::Model::cut)), with every parameter at its set or
    /// nominal value; the disk margin with a skew, 0 for the balanced one.
    ///
    /// Cost: that of [`Problem::margins`].
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`] and [`OpenLoop::of`], undefined, or stopped.
    ///
    /// # Panics
    /// When a name is free.
    pub fn margins(self, at: Option<&str>, skew: &Rational, budget: &Budget) -> Result<Answer<Margins>, Error> {
        Problem::margins(&self.problem()?, at, skew, budget)
    }
}

impl Problem {
    /// The margins of the loop cut at a signal.
    ///
    /// Cost: that of [`OpenLoop::of`], of the stable set of the factor, and for each of the phase, modulus and disk margins of
    /// isolating the zeros of a polynomial of at most twice the order and one resultant.
    ///
    /// # Errors
    /// [`Error`]: refused or undefined as [`OpenLoop::of`], or stopped.
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn margins(
        self: &Arc<Self>,
        at: Option<&str>,
        skew: &Rational,
        budget: &Budget,
    ) -> Result<Answer<Margins>, Error> {
        self.margins_with(at, skew, true, budget)
    }

    /// The same without the dead time behind a hold ([`Margins::held_delay`]), which takes the longest.
    ///
    /// Cost: that of [`Problem::margins`] but for that dead time.
    ///
    /// # Errors
    /// As [`Problem::margins`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn margins_without_held_delay(
        self: &Arc<Self>,
        at: Option<&str>,
        skew: &Rational,
        budget: &Budget,
    ) -> Result<Answer<Margins>, Error> {
        self.margins_with(at, skew, false, budget)
    }

    /// The dead time behind a hold takes the longest, and is left out where nobody asks for it.
    pub(super) fn margins_with(
        self: &Arc<Self>,
        at: Option<&str>,
        skew: &Rational,
        with_held_delay: bool,
        budget: &Budget,
    ) -> Result<Answer<Margins>, Error> {
        budget.enter(|| {
            let verdict = self.verdict(budget)?.into_value();
            let open_loop = OpenLoop::of(self, at, budget)?;
            let is_enclosed = open_loop.is_enclosed();
            match self.margins_of(open_loop, verdict.clone(), skew, with_held_delay, budget) {
                // Exact polynomials may show an identity that enclosures do not.
                Err(Error::Stopped(stopped)) if is_enclosed && stopped.stop.is_precision() => {
                    self.margins_of(OpenLoop::exact(self, at, budget)?, verdict, skew, with_held_delay, budget)
                }
                found => found,
            }
        })?
    }

    fn margins_of(
        self: &Arc<Self>,
        open_loop: OpenLoop,
        verdict: PointVerdict,
        skew: &Rational,
        with_held_delay: bool,
        budget: &Budget,
    ) -> Result<Answer<Margins>, Error> {
        budget.enter(|| {
            budget.step("crossings");
            let crossings = Crossings::of(&open_loop, budget)?;
            let is_stable = verdict.verdict == Verdict::Stable;
            let (crossings, stable) = match open_loop.dead_time() {
                Some(tau) => with_parts!(open_loop, parts => {
                    let dead_time = DeadTime::new(parts, tau);
                    let crossings = dead_time.crossings(crossings, budget)?;
                    let stable = is_stable.then(|| dead_time.margins(&crossings, skew, budget)).transpose()?;
                    (crossings, stable)
                }),
                None => {
                    let stable = is_stable.then(|| StableMargins::of(&open_loop, &crossings, skew, budget));
                    let stable = stable.transpose()?;
                    (crossings, stable)
                }
            };
            let held_delay = match &stable {
                Some(stable) if with_held_delay && stable.delay.is_in_samples(&open_loop) => {
                    budget.step("dead time behind the hold");
                    HeldDelay::of(self, &open_loop, budget)?
                }
                _ => None,
            };
            Ok(Answer::new(Arc::clone(self), Margins { open_loop, verdict, stable, held_delay, crossings }))
        })?
    }
}

impl Margins {
    /// The frequency at which a gain margin binds; `None` in the limit of high frequencies, and at a pole.
    pub fn frequency_of(&self, end: &End, bits: u64) -> Option<Frequency> {
        let pair = end.pair.as_ref()?;
        Some(Frequency::of_pair(pair, self.open_loop.sample_time(), bits))
    }

    /// The dead time that is not borne any more, in units of time; `None` where any is borne, and of a loop that has no margins.
    pub fn delay_seconds(&self, bits: u64) -> Option<Enclosure> {
        match (&self.stable.as_ref()?.delay, &self.held_delay) {
            (DelayMargin::Zero, _) => Some(Enclosure::from_rational(Rational::ZERO)),
            (DelayMargin::DeadTime(i), _) => self.crossings.gain[*i].delay(self.open_loop.frequencies(), bits),
            (_, Some(held)) => held.seconds(bits),
            _ => None,
        }
    }

    /// A frequency with the loop's sample time; `None` in the limit of high frequencies.
    pub fn frequency(&self, place: &Place, bits: u64) -> Option<Frequency> {
        place.frequency(self.open_loop.frequencies(), self.open_loop.sample_time(), bits)
    }
}

impl StableMargins {
    pub(super) fn of(
        open_loop: &OpenLoop,
        crossings: &Crossings,
        skew: &Rational,
        budget: &Budget,
    ) -> Result<Self, Exhausted> {
        budget.step("gain margin");
        let gain = GainMargin::of(open_loop, budget)?;
        budget.step("phase margin");
        let one_sided = OneSided::of(open_loop, crossings, budget)?;
        let phase = PhaseMargin::with(open_loop, crossings, one_sided.as_ref(), budget)?;
        budget.step("delay margin");
        let delay = DelayMargin::of(open_loop, crossings, budget)?;
        budget.step("modulus margin");
        let modulus_at = modulus_extreme(open_loop, budget)?;
        let modulus = modulus_at.root(budget)?;
        let peak_sensitivity = reciprocal(&modulus, budget)?;
        budget.step("peak of the complementary sensitivity");
        let complementary_at = complementary_extreme(open_loop, budget)?;
        // No root of a stable loop is on the boundary, where this would be infinite.
        let peak_complementary = complementary_at.root(budget)?;
        budget.step("disk margin");
        let disk = DiskMargin::of(open_loop, skew, budget)?;
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
}

impl GainMargin {
    pub(super) fn of(open_loop: &OpenLoop, budget: &Budget) -> Result<Self, Exhausted> {
        let set = with_parts!(open_loop, parts => {
            let mut set = parts.ground.stable_factors(&parts.in_factor(), &parts.poles, parts.shape, budget)?;
            if parts.frequencies().are_signed() {
                GainMargin::sided(parts, &mut set, budget)?;
            }
            set
        });
        Ok(GainMargin::of_set(set))
    }

    /// The ends around the factor 1.
    pub(super) fn of_set(set: StableSet) -> Self {
        let (mut upper, mut lower) = (None, None);
        for interval in set.intervals() {
            let above = |end: &End| end.value.compare_rational(&Rational::ONE).is_gt();
            let below = |end: &End| end.value.compare_rational(&Rational::ONE).is_lt();
            if interval.lower.as_ref().is_none_or(below) && interval.upper.as_ref().is_none_or(above) {
                upper = interval.upper.clone();
                lower = interval.lower.clone().filter(|end| end.value.sign().is_ge());
            }
        }
        GainMargin { set, upper, lower }
    }
}

impl PhaseMargin {
    /// Of any loop.
    pub(super) fn of(open_loop: &OpenLoop, crossings: &Crossings, budget: &Budget) -> Result<Self, Exhausted> {
        let one_sided = OneSided::of(open_loop, crossings, budget)?;
        PhaseMargin::with(open_loop, crossings, one_sided.as_ref(), budget)
    }

    /// The rotation at which a stable loop first meets -1 belongs to a crossing, the one with the least angle.
    fn with(
        open_loop: &OpenLoop,
        crossings: &Crossings,
        one_sided: Option<&OneSided>,
        budget: &Budget,
    ) -> Result<Self, Exhausted> {
        if let Some(one_sided) = one_sided {
            return one_sided.smaller(budget);
        }
        if crossings.gain_everywhere {
            return with_parts!(open_loop, parts => PhaseMargin::of_modulus_one(parts, budget));
        }
        let mut least: Option<(&Place, &Value)> = None;
        for crossing in &crossings.gain {
            let Some(tangent) = &crossing.tangent_squared else { continue };
            let better = match least {
                None => true,
                Some((_, known)) => tangent.compare(known, budget)?.is_lt(),
            };
            if better {
                least = Some((&crossing.place, tangent));
            }
        }
        match (least, crossings.gain.first()) {
            (Some((place, square)), _) => {
                let tangent = Some(Box::new(square_root(&square.number(budget)?, budget)?));
                Ok(PhaseMargin::Angle { tangent, place: Some(place.clone()) })
            }
            (None, Some(opposite)) => Ok(PhaseMargin::Angle { tangent: None, place: Some(opposite.place.clone()) }),
            (None, None) => Ok(PhaseMargin::Unbounded),
        }
    }

    /// Where the modulus is one at all frequencies.
    fn of_modulus_one<G: Ground>(parts: &Parts<G>, budget: &Budget) -> Result<Self, Exhausted> {
        let r = &parts.reduced;
        if r.difference_squared.is_zero() {
            return Ok(PhaseMargin::Angle { tangent: None, place: None });
        }
        let quotient = [&r.sum_squared, &r.difference_squared];
        let common = |a: &_, b: &_| r.common(a, b);
        let least = extreme_over(&parts.ground, quotient, &common, r.frequencies, Ordering::Less, budget)?;
        let square = least.value().expect("not infinite everywhere").number(budget)?;
        let tangent = Some(Box::new(square_root(&square, budget)?));
        Ok(PhaseMargin::Angle { tangent, place: least.place().cloned() })
    }
}
