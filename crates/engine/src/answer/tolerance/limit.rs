//! The range of one parameter that is safe for all values of the others.

use super::family_box::FamilyBox;
use super::{LimitSide, ToleranceLimit};
use crate::error::Error;
use crate::stability::AtPoint;
use crate::stability::boxes::{Family, Side, ToleranceProblem};
use jurist_algebra::number::Rational;

impl<F: Family> FamilyBox<'_, F> {
    /// How far one parameter may go on either side while the others keep their tolerances.
    pub(super) fn limit(&self, name: &str) -> Result<ToleranceLimit, Error> {
        let at = self.problem.free().iter().position(|free| free.name == name).expect("the limit's parameter is free");
        let sides = [self.limit_towards(at, false)?, self.limit_towards(at, true)?];
        Ok(ToleranceLimit { parameter: name.to_owned(), nominal: self.sides[at].nominal().clone(), sides })
    }

    /// The same of one side; `None` where the others' tolerances are too much at the nominal value.
    fn limit_towards(&self, at: usize, upward: bool) -> Result<Option<LimitSide>, Error> {
        let (p, budget) = (self.p, self.budget);
        let nominal = self.sides[at].nominal();
        let unit = if nominal.is_zero() { Rational::ONE } else { nominal.abs() };
        let mut own: Vec<Side> =
            self.sides.iter().map(|s| Side::fixed(s.nominal().clone(), s.widths().clone())).collect();
        let mut widths = [Rational::ZERO, Rational::ZERO];
        widths[usize::from(upward)] = unit.clone();
        own[at] = Side::scaled(nominal.clone(), widths);
        let Some(boxes) = ToleranceProblem::new(p, self.truth.beside(&own)) else { return Ok(None) };
        if !boxes.decide(&Rational::ZERO, budget)?.is_stable() {
            return Ok(None);
        }
        let signed = if upward { unit.clone() } else { -&unit };
        let value = |factor: &Rational| nominal + &(&signed * factor);
        let domain = &self.problem.free()[at].domain;
        let end = if upward { &domain.upper } else { &domain.lower };
        let most = end.as_ref().and_then(|end| (end - nominal).checked_div(&signed));
        let asked = &self.request().gap;
        // The gap is one of the parameter's value, not of how far it has moved.
        let gap = |factor: &Rational| {
            let moved = &unit * factor;
            let share = value(factor).abs().checked_div(&moved).unwrap_or(Rational::ONE);
            // The domain's own end is reached.
            let least = if most.as_ref() == Some(factor) { Rational::ZERO } else { p.least_gap() };
            (asked * &share).max(least).min(asked.clone())
        };
        let factor = boxes.bracket(boxes.searched(budget)?, None, &gap, most.as_ref(), budget)?;
        let mut factor = self.truth.factor(&boxes, p, factor, budget)?;
        let is_undefined = factor.witness.as_ref().is_some_and(|witness| witness.at == Some(AtPoint::Undefined));
        if is_undefined && most.as_ref().is_some_and(|most| factor.lower >= *most) {
            // Beyond the domain there is no loop, as with a negative dead time.
            (factor.upper, factor.direction, factor.shares, factor.witness) = (None, None, None, None);
        }
        let worst = self.problem.worst_end(&own, &factor, budget)?.map(|(worst, _)| worst);
        let (safe, unsafe_at) = (value(&factor.lower), factor.upper.as_ref().map(value));
        Ok(Some(LimitSide { safe, unsafe_at, factor, worst }))
    }
}
