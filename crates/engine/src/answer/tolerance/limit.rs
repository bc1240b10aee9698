//! The range of one parameter that is safe for all values of the others.

use super::held::Truth;
use super::{LimitSide, ToleranceLimit, ToleranceRequest};
use crate::error::Error;
use crate::problem::Problem;
use crate::stability::AtPoint;
use crate::stability::boxes::{Family, Side, ToleranceProblem};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use std::sync::Arc;

impl Problem {
    /// How far one parameter may go on either side while the others keep their tolerances.
    pub(super) fn tolerance_limit(
        self: &Arc<Self>,
        p: &impl Family,
        sides: &[Side],
        truth: &Truth,
        name: &str,
        request: &ToleranceRequest,
        budget: &Budget,
    ) -> Result<ToleranceLimit, Error> {
        let at = self.free().iter().position(|free| free.name == name).expect("the limit's parameter is free");
        let nominal = sides[at].nominal().clone();
        let unit = if nominal.is_zero() { Rational::ONE } else { nominal.abs() };
        let mut found = [None, None];
        for (upward, slot) in found.iter_mut().enumerate() {
            let mut own: Vec<Side> =
                sides.iter().map(|s| Side::fixed(s.nominal().clone(), s.widths().clone())).collect();
            let mut widths = [Rational::ZERO, Rational::ZERO];
            widths[upward] = unit.clone();
            own[at] = Side::scaled(nominal.clone(), widths);
            let Some(boxes) = ToleranceProblem::new(p, truth.beside(&own)) else { continue };
            if !boxes.decide(&Rational::ZERO, budget)?.is_stable() {
                continue;
            }
            let signed = if upward == 1 { unit.clone() } else { -&unit };
            let value = |factor: &Rational| &nominal + &(&signed * factor);
            let domain = &self.free()[at].domain;
            let end = if upward == 1 { &domain.upper } else { &domain.lower };
            let most = end.as_ref().and_then(|end| (end - &nominal).checked_div(&signed));
            // The gap is one of the parameter's value, not of how far it has moved.
            let gap = |factor: &Rational| {
                let moved = &unit * factor;
                let share = value(factor).abs().checked_div(&moved).unwrap_or(Rational::ONE);
                // The domain's own end is reached.
                let least = if most.as_ref() == Some(factor) { Rational::ZERO } else { p.least_gap() };
                (&request.gap * &share).max(least).min(request.gap.clone())
            };
            let factor = boxes.bracket(boxes.searched(budget)?, None, &gap, most.as_ref(), budget)?;
            let mut factor = truth.factor(&boxes, p, factor, budget)?;
            let is_undefined = factor.witness.as_ref().is_some_and(|witness| witness.at == Some(AtPoint::Undefined));
            if is_undefined && most.as_ref().is_some_and(|most| factor.lower >= *most) {
                // Beyond the domain there is no loop, as with a negative dead time.
                (factor.upper, factor.direction, factor.shares, factor.witness) = (None, None, None, None);
            }
            let worst = self.worst_end(&own, &factor, budget)?.map(|(worst, _)| worst);
            *slot = Some(LimitSide {
                safe: value(&factor.lower),
                unsafe_at: factor.upper.as_ref().map(value),
                factor,
                worst,
            });
        }
        Ok(ToleranceLimit { parameter: name.to_owned(), nominal, sides: found })
    }
}
