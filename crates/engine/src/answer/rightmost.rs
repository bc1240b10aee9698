//! The rightmost roots of a loop with dead time.

use super::dead_time::not_counted;
use super::roots::{BeyondRoots, ClosedLoopRoot, Roots};
use crate::coverage::refusals::ADVANCED;
use crate::error::Error;
use crate::model::Time;
use crate::stability::dead_time::{ConstantParts, QuasiPolynomial, rightmost_roots, rightmost_roots_over};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

/// The characteristic function of a loop with a dead time.
pub(super) enum WithDelay {
    Exact(QuasiPolynomial),
    /// With constants that are not rational.
    Over(ConstantParts),
}

/// The roots right of a line, so many or some more, and the line.
pub(super) fn rightmost(
    p: &WithDelay,
    tau: &Rational,
    wanted: usize,
    narrow: &Rational,
    degree: usize,
    budget: &Budget,
) -> Result<Roots, Error> {
    let found = match p {
        WithDelay::Exact(p) => rightmost_roots(p, tau, wanted, narrow, budget),
        WithDelay::Over(constants) => rightmost_roots_over(constants, tau, wanted, narrow, budget).map(Some),
    };
    let found = found.map_err(not_counted)?.ok_or_else(|| ADVANCED.diagnostic(&[]))?;
    let root = |disc| ClosedLoopRoot { disc, time: Time::Continuous, period: None, is_on_boundary: false };
    let beyond = BeyondRoots { wanted, others_left_of: found.others_left_of, chain: found.chain };
    let list = found.list.into_iter().map(root).collect();
    Ok(Roots { degree, infinite: 0, list, beyond: Some(beyond) })
}
