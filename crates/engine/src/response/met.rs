//! Whether a loop meets requirements at a point.

use super::crossings::Crossings;
use super::ground::{Constants, Ground};
use super::margins::{GainMargin, PhaseMargin, StableMargins, modulus_extreme};
use super::open_loop::OpenLoop;
use super::requirement::{Requirement, in_sector, scaled_by_exponential};
use super::spiral::OnSpiral;
use super::value::{Value, square_root};
use crate::stability::Shape;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RealAlgebraic, UniPoly};
use jurist_algebra::real::Real;

/// A stable loop at a point; each margin is computed once, when it is first asked for.
pub(super) struct AtPoint<'a> {
    open_loop: Option<&'a OpenLoop>,
    /// The closed loop's polynomial, all its roots as they are.
    closed: &'a UniPoly,
    shape: Shape,
    gain: Option<GainMargin>,
    phase: Option<PhaseMargin>,
    modulus: Option<Value>,
}

impl<'a> AtPoint<'a> {
    pub fn new(open_loop: Option<&'a OpenLoop>, closed: &'a UniPoly, shape: Shape) -> Self {
        AtPoint { open_loop, closed, shape, gain: None, phase: None, modulus: None }
    }

    /// Whether it meets a requirement.
    pub fn meets(&mut self, requirement: &Requirement, budget: &Budget) -> Result<bool, Exhausted> {
        let cut = || self.open_loop.expect("a margin is taken at a cut");
        match requirement {
            Requirement::GainMargin { factor, .. } => {
                let gain = match self.gain.take() {
                    Some(gain) => gain,
                    None => GainMargin::of(cut(), budget)?,
                };
                has_gain_margin(self.gain.insert(gain), factor, budget)
            }
            Requirement::PhaseMargin { twice_cosine, .. } => {
                let phase = match self.phase.take() {
                    Some(phase) => phase,
                    None => PhaseMargin::of(cut(), &Crossings::of(cut(), budget)?, budget)?,
                };
                has_phase_margin(self.phase.insert(phase), twice_cosine, budget)
            }
            Requirement::ModulusMargin(least) => {
                let modulus = match self.modulus.take() {
                    Some(modulus) => modulus,
                    None => modulus_extreme(cut(), budget)?.value().expect("finite somewhere").clone(),
                };
                let square = Value::from(least * least);
                Ok(self.modulus.insert(modulus).compare(&square, budget)?.is_ge())
            }
            Requirement::Damping(least) if self.shape == Shape::UnitDisc => {
                let inside = OnSpiral::without_parameter(self.closed, least).count_at(&Rational::ZERO, budget)?;
                Ok(Some(inside) == self.closed.degree())
            }
            Requirement::Damping(least) => {
                // On the sector's edge a root is damped enough.
                let count = crate::stability::count_roots(&in_sector(self.closed, least), self.shape);
                Ok(count.outside == 0)
            }
            Requirement::SettlingTime { exponent, .. } => {
                let coefficients = self.closed.coeffs().iter().cloned().map(MultiPoly::constant);
                let (symbols, scaled) = scaled_by_exponential(coefficients, exponent);
                // No root has a transcendental modulus, so none is on the circle.
                Constants(symbols).is_stable(&scaled, self.shape, budget)
            }
            // Of the whole answer, with the dead time behind a hold.
            Requirement::DelayMargin(_) => Ok(false),
        }
    }
}

/// Whether the loop is stable for all factors from the inverse of one to itself.
fn has_gain_margin(gain: &GainMargin, factor: &RealAlgebraic, budget: &Budget) -> Result<bool, Exhausted> {
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
fn has_phase_margin(phase: &PhaseMargin, twice_cosine: &RealAlgebraic, budget: &Budget) -> Result<bool, Exhausted> {
    let PhaseMargin::Angle { tangent: Some(tangent), .. } = phase else { return Ok(true) };
    Ok(tangent.compare(&half_tangent(twice_cosine, budget)?, budget)?.is_ge())
}

/// The tangent of half the angle whose cosine is half of this.
pub(crate) fn half_tangent(twice_cosine: &RealAlgebraic, budget: &Budget) -> Result<Real, Exhausted> {
    let square = Value::quotient(&UniPoly::from_i64(&[2, -1]), &UniPoly::from_i64(&[2, 1]), twice_cosine);
    square_root(&square.number(budget)?, budget)
}

impl Requirement {
    /// Whether margins that are known meet it; `None` where it is not about them.
    pub(crate) fn is_met_by(&self, margins: &StableMargins, budget: &Budget) -> Result<Option<bool>, Exhausted> {
        Ok(match self {
            Requirement::GainMargin { factor, .. } => Some(has_gain_margin(&margins.gain, factor, budget)?),
            Requirement::PhaseMargin { twice_cosine, .. } => {
                Some(has_phase_margin(&margins.phase, twice_cosine, budget)?)
            }
            Requirement::ModulusMargin(least) => {
                Some(budget.enter(|| margins.modulus.compare_rational(least).is_ge())?)
            }
            Requirement::Damping(_) | Requirement::DelayMargin(_) | Requirement::SettlingTime { .. } => None,
        })
    }
}
