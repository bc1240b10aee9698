//! Whether a loop meets requirements at a point.

use super::crossings::Crossings;
use super::dead_time::DeadTime;
use super::extreme::{Extreme, extreme_over};
use super::margins::{GainMargin, Margins, PhaseMargin, StableMargins};
use super::open_loop::OpenLoop;
use super::parts::with_parts;
use super::requirement::{Circle, Found, Requirement, Rule};
use super::value::{Value, square_root};
use super::{DelayMargin, HeldDelay};
use crate::answer::Verdict;
use crate::coverage::refusals::{NO_DAMPING, NO_SAMPLE_TIME};
use crate::error::Error;
use crate::model::Time;
use crate::precisions::REQUIRED_DELAY;
use crate::problem::Problem;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction, RealAlgebraic, UniPoly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;
use std::sync::Arc;

/// The open loop of a stable loop at a point; each margin is computed once, when it is first asked for.
pub(super) struct AtPoint<'a> {
    open_loop: &'a OpenLoop,
    gain: Option<GainMargin>,
    phase: Option<PhaseMargin>,
    /// Of circles: the least `|1 + L|^2/|u + v L|^2` of each `u` and `v`.
    circles: Vec<([i64; 2], Option<Value>)>,
}

impl<'a> AtPoint<'a> {
    pub fn new(open_loop: &'a OpenLoop) -> Self {
        AtPoint { open_loop, gain: None, phase: None, circles: Vec::new() }
    }

    /// The names of the requirements on margins that an open loop does not meet.
    pub fn unmet(
        open_loop: &OpenLoop,
        requirements: &[Requirement],
        budget: &Budget,
    ) -> Result<Vec<&'static str>, Exhausted> {
        let mut here = AtPoint::new(open_loop);
        let mut out = Vec::new();
        for requirement in requirements {
            if !here.meets(requirement, budget)? {
                out.push(requirement.name());
            }
        }
        Ok(out)
    }

    /// Whether it meets a requirement on margins; none on roots is met by an open loop.
    pub fn meets(&mut self, requirement: &Requirement, budget: &Budget) -> Result<bool, Exhausted> {
        let open_loop = self.open_loop;
        match requirement.rule() {
            Rule::Factors(factor) => {
                let gain = match self.gain.take() {
                    Some(gain) => gain,
                    None => GainMargin::of(open_loop, budget)?,
                };
                has_gain_margin(self.gain.insert(gain), factor, budget)
            }
            Rule::Turned { twice_cosine } => {
                let phase = match self.phase.take() {
                    Some(phase) => phase,
                    None => PhaseMargin::of(open_loop, &Crossings::of(open_loop, budget)?, budget)?,
                };
                has_phase_margin(self.phase.insert(phase), twice_cosine, budget)
            }
            Rule::Circle(circle) => {
                let known = self.circles.iter().position(|(combined, _)| *combined == circle.combined());
                let place = match known {
                    Some(place) => place,
                    None => {
                        let extreme = circle_extreme(open_loop, circle, budget)?;
                        self.circles.push((circle.combined(), extreme.and_then(|extreme| extreme.value())));
                        self.circles.len() - 1
                    }
                };
                let Some(ratio) = &self.circles[place].1 else { return Ok(true) };
                let square = Value::from(circle.least() * circle.least());
                Ok(ratio.compare(&square, budget)?.is_ge())
            }
            // Of roots, or of the whole answer, with the dead time behind a hold.
            Rule::Sector(_) | Rule::Modulus { .. } | Rule::DeadTime(_) => Ok(false),
        }
    }
}

/// Whether the loop is stable for all factors from the inverse of one to itself.
pub(super) fn has_gain_margin(gain: &GainMargin, factor: &RealAlgebraic, budget: &Budget) -> Result<bool, Exhausted> {
    let factor = Real::from(factor.clone());
    let inverse = super::value::reciprocal(&factor, budget)?;
    let above = match &gain.upper {
        Some(end) => end.value.compare(&factor, budget)?.is_gt(),
        None => true,
    };
    let below = match &gain.lower {
        Some(end) => end.value.compare(&inverse, budget)?.is_lt(),
        None => true,
    };
    Ok(above && below)
}

/// Whether the angle is at least that of twice a cosine.
pub(super) fn has_phase_margin(
    phase: &PhaseMargin,
    twice_cosine: &RealAlgebraic,
    budget: &Budget,
) -> Result<bool, Exhausted> {
    let PhaseMargin::Angle { tangent: Some(tangent), .. } = phase else { return Ok(true) };
    Ok(tangent.compare(&half_tangent(twice_cosine, budget)?, budget)?.is_ge())
}

/// The tangent of half the angle whose cosine is half of this.
pub fn half_tangent(twice_cosine: &RealAlgebraic, budget: &Budget) -> Result<Real, Exhausted> {
    let square = Value::quotient(&UniPoly::from_i64(&[2, -1]), &UniPoly::from_i64(&[2, 1]), twice_cosine);
    square_root(&square.number(budget)?, budget)
}

impl Requirement {
    /// Whether margins that are known meet it; `None` where it is not about them.
    pub(crate) fn is_met_by(
        &self,
        all: &Margins,
        margins: &StableMargins,
        budget: &Budget,
    ) -> Result<Option<bool>, Exhausted> {
        Ok(match self.rule() {
            Rule::Factors(factor) => Some(has_gain_margin(&margins.gain, factor, budget)?),
            Rule::Turned { twice_cosine } => Some(match &margins.one_sided {
                Some(both) => {
                    let greatest = super::value::reciprocal(&half_tangent(twice_cosine, budget)?, budget)?;
                    both.are_at_least(&greatest, budget)?
                }
                None => has_phase_margin(&margins.phase, twice_cosine, budget)?,
            }),
            Rule::Circle(circle) => match self.found(all, margins) {
                Some(Found::Number(number)) => {
                    let order = budget.enter(|| number.compare_rational(circle.asked()))?;
                    Some(if self.is_least() { order.is_ge() } else { order.is_le() })
                }
                _ => Some(true),
            },
            Rule::Sector(_) | Rule::DeadTime(_) | Rule::Modulus { .. } => None,
        })
    }
}

/// The least `|1 + L|^2/|u + v L|^2`; `None` where `u + v L` is zero at all frequencies.
fn circle_extreme(open_loop: &OpenLoop, circle: &Circle, budget: &Budget) -> Result<Option<Extreme>, Exhausted> {
    with_parts!(open_loop, parts => {
        let r = &parts.reduced;
        let [u, v] = circle.combined().map(Integer::from);
        let below = r.combined_squared(&u, &v);
        if below.is_zero() {
            return Ok(None);
        }
        let quotient = [&r.sum_squared, &below];
        extreme_over(&parts.ground, quotient, &|a, b| r.common(a, b), r.frequencies, Ordering::Less, budget).map(Some)
    })
}

impl Problem {
    /// Whether a stable loop bears all dead times less than one, by its delay margin and, at the input of a plant behind a hold, its dead time there.
    fn bears(
        &self,
        (open_loop, crossings): (&OpenLoop, &Crossings),
        (margin, held): (&DelayMargin, Option<&HeldDelay>),
        least: &Rational,
        budget: &Budget,
    ) -> Result<bool, Error> {
        match (margin, held.and_then(|held| Some((held.samples.as_ref()?, &held.period)))) {
            (DelayMargin::Zero, _) => return Ok(false),
            (DelayMargin::DeadTime(i), _) => {
                let enclose = |bits| crossings.gain[*i].delay(open_loop.frequencies(), bits);
                return Ok(is_at_least(enclose, least, budget)?);
            }
            (_, Some((samples, period))) => {
                let needed = least.checked_div(period).expect("a sample time is positive");
                return Ok(budget.enter(|| samples.compare_rational(&needed).is_ge())?);
            }
            _ => {}
        }
        let borne = match margin {
            DelayMargin::Samples(m) | DelayMargin::SamplesAtLeast(m) => {
                let Some(step) = open_loop.sample_time() else { return Err(NO_SAMPLE_TIME.diagnostic(&[]).into()) };
                // With one whole sample more it is not stable, whatever is between.
                if matches!(margin, DelayMargin::Samples(_)) && &Rational::from(*m + 1) * step < *least {
                    return Ok(false);
                }
                &Rational::from(*m) * step >= *least
            }
            _ => true,
        };
        match margin.is_in_samples(open_loop) {
            true => Ok(HeldDelay::is_borne(self, open_loop, least, budget)?.unwrap_or(borne)),
            false => Ok(borne),
        }
    }

    /// Whether a loop with margins, if it is stable, bears all dead times less than one.
    pub(super) fn bears_with(&self, margins: &Margins, least: &Rational, budget: &Budget) -> Result<bool, Error> {
        let Some(stable) = &margins.stable else { return Ok(false) };
        let Margins { open_loop, crossings, held_delay, .. } = margins;
        self.bears((open_loop, crossings), (&stable.delay, held_delay.as_ref()), least, budget)
    }
}

fn is_at_least(
    enclose: impl Fn(u64) -> Option<Enclosure>,
    least: &Rational,
    budget: &Budget,
) -> Result<bool, Exhausted> {
    REQUIRED_DELAY.decide("comparing a delay with the required one", |bits| {
        Ok(match budget.enter(|| enclose(bits))? {
            Some(e) if e.lower() >= least => Some(true),
            Some(e) if e.upper() < least => Some(false),
            _ => None,
        })
    })
}

impl Problem {
    /// Whether the loop is stable and meets a requirement, with every parameter at its set or nominal value; no other margins are computed.
    ///
    /// # Errors
    /// As [`Problem::requirements_met`].
    pub(crate) fn meets(
        self: &Arc<Self>,
        requirement: &Requirement,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<bool, Error> {
        let is_at_cut = requirement.needs_cut() && requirement.signals().is_none();
        if !is_at_cut || (self.is_written_complex() && self.algebra_over_symbols(budget)?.is_complex()) {
            let met = self.requirements_met(std::slice::from_ref(requirement), at, budget)?;
            return Ok(met.iter().all(|found| found.met));
        }
        budget.enter(|| {
            if self.verdict(budget)?.value().verdict != Verdict::Stable {
                return Ok(false);
            }
            let open_loop = OpenLoop::of_any(self, at, budget)?;
            match self.has_margin(&open_loop, requirement, budget) {
                Err(Error::Stopped(stopped)) if open_loop.is_enclosed() && stopped.stop.is_precision() => {
                    self.has_margin(&OpenLoop::exact(self, at, budget)?, requirement, budget)
                }
                told => told,
            }
        })?
    }

    /// Whether a stable loop has a margin at its cut.
    pub(super) fn has_margin(
        &self,
        open_loop: &OpenLoop,
        requirement: &Requirement,
        budget: &Budget,
    ) -> Result<bool, Error> {
        match (requirement.rule(), open_loop.dead_time()) {
            _ if open_loop.is_zero() => Ok(true),
            (Rule::DeadTime(least), _) => self.bears_dead_time(open_loop, least, budget),
            (_, Some(tau)) => {
                with_parts!(open_loop, parts => DeadTime::new(parts, tau).meets(requirement, open_loop, budget))
            }
            _ => Ok(AtPoint::new(open_loop).meets(requirement, budget)?),
        }
    }

    /// Whether a stable loop bears all dead times less than one.
    fn bears_dead_time(&self, open_loop: &OpenLoop, least: &Rational, budget: &Budget) -> Result<bool, Error> {
        let mut crossings = Crossings::of(open_loop, budget)?;
        for crossing in &mut crossings.gain {
            crossing.dead_time = open_loop.dead_time().cloned();
        }
        let margin = DelayMargin::of(open_loop, &crossings, budget)?;
        self.bears((open_loop, &crossings), (&margin, None), least, budget)
    }

    /// Refuses a damping of a loop with dead time: `|exp(-tau s)|` grows with the distance of a root from the axis, that of a chain of roots only as the
    /// logarithm of their frequency.
    pub(crate) fn refuse_undamped(&self, requirements: &[Requirement], budget: &Budget) -> Result<(), Error> {
        let is_damping = requirements.iter().any(|one| matches!(one.rule(), Rule::Sector(_)));
        // The dead time of a discrete loop is that of a hold: states.
        if !is_damping || self.time() == Time::Discrete {
            return Ok(());
        }
        let algebra = self.algebra_over_symbols(budget)?;
        let delays = algebra.symbols().delays();
        let is_in = |f: &MultiPoly| delays.iter().any(|(variable, _)| f.degree_in(*variable) > 0);
        let coefficients = algebra.polynomial().into_iter().flat_map(|p| &p.coefficients);
        match coefficients.map(RationalFunction::numerator).any(is_in) {
            true => Err(NO_DAMPING.diagnostic(&[]).into()),
            false => Ok(()),
        }
    }
}
