//! Loops with dead time and a free parameter inside of functions.

use super::beside_dead_time::{Beside, refused_beside, refused_in_delay};
use super::delayed::{BaseDelay, base_delay, sorted};
use super::region::Bound;
use super::resolved::Problem;
use crate::coverage::CoefficientRing;
use crate::error::Error;
use crate::stability::dead_time::{Line, MovingLoop};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly};

/// A loop with dead time and functions of the free parameter.
pub(crate) struct DelayedFunctions {
    pub family: MovingLoop,
    /// Where the dead time depends on the parameter, the value at which it is 0, and whether it grows from there.
    pub without_dead_time: Option<(Rational, bool)>,
}

impl Problem {
    /// The loop with dead time whose only free parameter is inside of functions; `None` for any other loop, and where it is undefined or vanishes for all
    /// values.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and a common denominator.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for dead times that are inside of functions, too.
    pub(crate) fn delayed_functions(&self, budget: &Budget) -> Result<Option<DelayedFunctions>, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let is_meant = CoefficientRing::of(algebra.symbols()) == CoefficientRing::DeadTimeBesideFunctions;
        let Some(polynomial) = algebra.polynomial().filter(|_| is_meant && self.free().len() == 1) else {
            return Ok(None);
        };
        let beside = Beside::of(algebra.symbols(), 1)?;
        if beside.delays.iter().flat_map(|(_, time)| time.variables()).any(|v| v > 0) {
            return Err(refused_in_delay());
        }
        let (delay, powers) = base_delay(&beside.delays)?;
        let Bound::Number(decay) = self.region().bound() else { return Err(refused_beside()) };
        budget.enter(|| {
            let coefficients: Vec<_> = polynomial.coefficients.iter().map(|c| beside.placed(c)).collect();
            let count = beside.symbols.len();
            let position = |v: usize| (1..=count).contains(&v).then(|| v - 1);
            let power_of = |v: usize| beside.delays.iter().position(|(own, _)| *own == v).map(|i| powers[i]);
            let (mut parts, common) = sorted(&coefficients, count, position, power_of)?;
            let content = parts.iter().flatten().fold(MultiPoly::zero(), |g, p| g.gcd(p));
            if content.is_zero() {
                return Ok(None);
            }
            parts.iter_mut().flatten().for_each(|p| *p = p.div_exact(&content).expect("the content divides"));
            // What contains a delay is an operator, and has no zeros among the values.
            let poles = polynomial.poles.iter().map(|p| beside.placed_polynomial(p)).chain([common, content]);
            let is_pole = |p: &MultiPoly| !p.is_constant() && p.variables().iter().all(|v| *v <= count);
            let poles = poles.filter(is_pole).collect();
            let (tau, without_dead_time) = match delay {
                BaseDelay::Number(tau) => (Line::constant(tau), None),
                BaseDelay::Line { slope, offset } => {
                    let zero = -&offset / &slope;
                    let grows = slope.sign().is_gt();
                    (Line { slope, offset }, Some((zero, grows)))
                }
            };
            let family = MovingLoop::new(parts, poles, beside.symbols.clone(), tau, Line::constant(decay.clone()));
            Ok(Some(DelayedFunctions { family, without_dead_time }))
        })?
    }
}
