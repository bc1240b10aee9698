//! How much dead time a loop bears at the input of a plant behind a hold.

use super::open_loop::OpenLoop;
use crate::answer::{Frequency, Sides};
use crate::coverage::refusals::MANY_HELD_SAMPLES;
use crate::error::Error;
use crate::model::{MoreDeadTime, OnlyHold};
use crate::problem::{Beside, Problem, Region, fixed_symbols, moving_symbols};
use crate::stability::{AtPoint, ComplexPair, Range, StableSet, SymbolicPolynomial, symbolic_stable_set};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// The dead time that the input of the only block behind a hold may have more than it has.
///
/// Between two whole samples the loop is that of a plant with a fraction of a sample of dead time, whose coefficients are
/// exponentials of the fraction; each such stretch is decided as a stable set of the fraction, one after the other, until the
/// first at whose end the loop is not stable.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct HeldDelay {
    /// The block behind the hold or the modulator.
    pub block: String,
    /// The sample time.
    pub period: Rational,
    /// The dead time in samples at which the loop ceases to be stable; `None` where it is stable with all that were looked at, up to
    /// [`HeldDelay::MOST`] samples.
    pub samples: Option<Real>,
    /// The pair of roots on the unit circle there.
    pub pair: Option<ComplexPair>,
    /// True where a sample falls on an edge of the pulse with that dead time: the model is undefined there, and beyond it is another loop.
    pub is_on_edge: bool,
}

impl HeldDelay {
    /// Dead times up to so many samples are looked at: each sample is a root more.
    pub const MOST: u64 = 12;

    /// The same where it is asked whether so much is borne.
    pub const ASKED: u64 = 64;

    /// Of a stable loop; `None` where the cut is not that of a loop through the only block behind a hold, and where an end is not told from a tie.
    pub(super) fn of(problem: &Problem, open_loop: &OpenLoop, budget: &Budget) -> Result<Option<HeldDelay>, Error> {
        let Some(hold) = held(problem, open_loop, budget)? else { return Ok(None) };
        HeldDelay::up_to(&HeldDelay::MOST.into(), problem, &hold, budget)
    }

    /// Whether a stable loop bears all dead times less than one; `None` where the cut is not that of a loop through the only block behind a hold.
    ///
    /// # Errors
    /// `E-require` where the dead time is more than [`HeldDelay::ASKED`] samples; [`Error::Stopped`] where an end is not told from a tie.
    pub(super) fn is_borne(
        problem: &Problem,
        open_loop: &OpenLoop,
        least: &Rational,
        budget: &Budget,
    ) -> Result<Option<bool>, Error> {
        let Some(hold) = held(problem, open_loop, budget)? else { return Ok(None) };
        let needed = least.checked_div(&hold.period).expect("a sample time is positive");
        if needed > HeldDelay::ASKED.into() {
            return Err(MANY_HELD_SAMPLES.diagnostic(&[("most", &HeldDelay::ASKED.to_string())]).into());
        }
        match HeldDelay::up_to(&needed, problem, &hold, budget)?.map(|found| found.samples) {
            None => Err(Exhausted::by_method("an end is not told from a tie", "dead time behind the hold").into()),
            Some(None) => Ok(Some(true)),
            Some(Some(samples)) => Ok(Some(budget.enter(|| samples.compare_rational(&needed).is_ge())?)),
        }
    }

    /// Of the dead times up to a number of samples; `None` where an end is not told from a tie.
    fn up_to(most: &Rational, problem: &Problem, hold: &OnlyHold, budget: &Budget) -> Result<Option<HeldDelay>, Error> {
        let ended = |samples, pair, is_on_edge| {
            Ok(Some(HeldDelay { block: hold.block.clone(), period: hold.period.clone(), samples, pair, is_on_edge }))
        };
        let found = |samples, pair| ended(samples, pair, false);
        let mut from = Rational::ZERO;
        while from < *most {
            let Some(to) = hold.next_break(&from) else { return Ok(None) };
            let more = MoreDeadTime::Near(vec![from.midpoint(&to)]);
            let set = stable_fractions(problem, &more, Range::between(Some(from.clone()), Some(to.clone())), budget)?;
            let first = set.intervals().first();
            let begins = |end: &Real| end.compare_rational(&from).is_eq();
            let first = first.filter(|i| i.lower.as_ref().is_some_and(|l| begins(&l.value)));
            let Some(end) = first.and_then(|i| i.upper.as_ref()) else {
                let is_open = set.undecided().iter().any(|b| b.lower.as_ref().is_none_or(|lower| *lower <= from));
                return if is_open { Ok(None) } else { found(Some(from.into()), None) };
            };
            if let Some(bracket) = set.undecided().first()
                && bracket.lower.as_ref().is_none_or(|lower| end.value.compare_rational(lower).is_ge())
            {
                // Whether the loop touches the boundary there, or ends, is not known.
                return Ok(None);
            }
            if end.value.compare_rational(&to).is_lt() {
                return found(Some(end.value.clone()), end.pair.clone());
            }
            match is_stable_with(problem, &to, budget)? {
                None => return ended(Some(to.into()), None, true),
                Some(false) => return found(Some(to.into()), None),
                Some(true) => {}
            }
            from = to;
        }
        found(None, None)
    }

    /// The dead time in units of time, enclosed with about `bits` bits.
    pub fn seconds(&self, bits: u64) -> Option<Enclosure> {
        let (lo, hi) = self.samples.as_ref()?.refined_to_digits(bits as usize / 3 + 1).enclosure();
        Some(Enclosure::new(lo, hi).mul(&Enclosure::from_rational(self.period.clone()), bits + 16))
    }

    /// The frequency of the pair, enclosed with about `bits` bits.
    pub fn frequency(&self, bits: u64) -> Option<Frequency> {
        Some(Frequency::of_pair(self.pair.as_ref()?, Some(&self.period), bits))
    }
}

/// The only block behind a hold, if the loop is cut at its input.
fn held(problem: &Problem, open_loop: &OpenLoop, budget: &Budget) -> Result<Option<OnlyHold>, Error> {
    let Some(hold) = problem.model().only_hold(&[], problem.set(), budget)? else { return Ok(None) };
    match OpenLoop::of(problem, Some(&hold.block), budget) {
        Ok(at_hold) => Ok(Some(hold).filter(|_| open_loop.is_same(&at_hold))),
        Err(Error::Stopped(stopped)) => Err(Error::Stopped(stopped)),
        // A block with several inputs is no place to cut.
        Err(_) => Ok(None),
    }
}

/// For which dead times, in samples, the loop is stable.
fn stable_fractions(problem: &Problem, more: &MoreDeadTime, range: Range, budget: &Budget) -> Result<StableSet, Error> {
    let (closed_loop, symbols) = problem.model().with_dead_time(more, &[], problem.set(), budget)?;
    let (mut d, complex) = closed_loop.real_polynomial(&symbols, budget)?;
    d.poles = Vec::new();
    let p = match symbols.is_moving() {
        true => SymbolicPolynomial::with_moving(&d, &Arc::new(moving_symbols(&symbols)?)),
        false => SymbolicPolynomial::new(&d, 1, &Arc::new(fixed_symbols(&symbols)?)),
    };
    let mut set = symbolic_stable_set(&p, &range, problem.shape(), budget)?;
    if let Some(whole) = complex {
        let sides = Sides::new(whole, Beside::symbols(moving_symbols(&symbols)?), Region::of(problem.time()))?;
        for end in set.ends_mut() {
            budget.enter(|| sides.name(end))?;
        }
    }
    Ok(set)
}

/// Whether the loop is stable with a dead time that is a number of samples; `None` where a sample stands on an edge of a pulse.
pub(super) fn is_stable_with(problem: &Problem, samples: &Rational, budget: &Budget) -> Result<Option<bool>, Error> {
    let more = MoreDeadTime::Samples(samples.clone());
    let (closed_loop, symbols) = match problem.model().with_dead_time(&more, &[], problem.set(), budget) {
        Err(Error::Undefined(_)) => return Ok(None),
        found => found?,
    };
    let (mut d, _) = closed_loop.real_polynomial(&symbols, budget)?;
    d.poles = Vec::new();
    let p = SymbolicPolynomial::new(&d, 0, &Arc::new(fixed_symbols(&symbols)?));
    let found = p.at(&Rational::ZERO, problem.shape(), budget)?;
    Ok(Some(matches!(found, AtPoint::Defined { count, infinite: 0 } if count.inside == d.formal_degree)))
}
