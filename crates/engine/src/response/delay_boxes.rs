//! The delay margin over boxes: the loop with a delay at the cut, which is one parameter more.
//!
//! A loop has a delay margin of a time at least where it is stable with all less delay at the cut. So a box is refuted by one delay with which
//! no point of it is stable.

use super::continuous_delay::ContinuousDelay;
use super::requirement_boxes::OverPoints;
use super::sampled_delay::SampledDelay;
use crate::error::Error;
use crate::model::Cut;
use crate::problem::Problem;
use crate::stability::Shape;
use crate::stability::boxes::{BoxPolynomial, DelayedFunction, MovingPolynomial};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// A delay with which a loop is unstable is made longer so much.
const LONGER: [(i64, i64); 4] = [(3, 2), (1, 1), (2, 1), (3, 1)];

/// The delays from zero to the greatest are not cut into more parts of a large box.
const MOST_PARTS: usize = 12;

/// So many parts, and cells of each, more for each halving of a small box: it is near to where a loop with one of the delays is not stable.
const MORE_PARTS: usize = 2;

/// Cells of frequency and parameters after which a box is rather halved: with one delay, and with a range of them.
const CELLS: [usize; 2] = [64, 12];

/// A delay margin that is asked of the loops near to a point of the free names.
#[derive(Clone, Copy)]
pub(crate) struct DelayAsked<'a> {
    pub problem: &'a Arc<Problem>,
    /// In units of time.
    pub least: &'a Rational,
    pub cut: &'a Cut,
    pub near: &'a [Rational],
}

/// Loops with a delay at the cut.
pub(super) trait Delays {
    /// Delays with which a loop may be unstable, from the greatest to the least; there is one at least.
    fn tried(&self) -> Vec<Rational>;

    /// Closed ranges of delays: a loop has the margin where it is stable with each of them.
    fn ranges(&self) -> Vec<[Rational; 2]>;

    /// Whether it is seen that no point of a closed box bears any delay at all.
    fn bears_none(&self, _: &[[Rational; 2]]) -> bool {
        false
    }

    /// Whether a delay is one that the loop is asked with.
    fn is_delay(&self, delay: &Rational) -> bool;

    /// Whether a point is stable with a delay, as far as that is seen; that it is not is certain.
    ///
    /// # Errors
    /// When the budget runs out.
    fn at(&self, point: &[Rational], delay: &Rational, budget: &Budget) -> Result<Option<bool>, Exhausted>;

    /// Whether all points of a closed box are stable with all delays of a range, or none is with any.
    ///
    /// # Errors
    /// When the budget runs out.
    fn over(
        &self,
        sides: &[[Rational; 2]],
        delays: &[Rational; 2],
        cells: usize,
        budget: &Budget,
    ) -> Result<OverPoints, Exhausted>;
}

/// A least delay margin over boxes.
pub(crate) enum DelayBoxes {
    Continuous(Box<ContinuousDelay>),
    Sampled(Box<SampledDelay>),
    /// No loop has it.
    Never,
}

/// A family whose stability is asked, in the parameters, where a range is given in the delay, and in constants.
pub(crate) struct DelayFamily<'a> {
    pub loops: DelayedLoops<'a>,
    pub delays: Option<[Rational; 2]>,
    /// Each constant is a parameter more in this range.
    pub constants: &'a [[Rational; 2]],
}

pub(crate) enum DelayedLoops<'a> {
    Delayed(&'a DelayedFunction),
    Polynomial(&'a BoxPolynomial),
    Moving(&'a MovingPolynomial),
}

impl DelayBoxes {
    /// `None` for a loop that vanishes identically.
    ///
    /// # Errors
    /// As [`OpenedLoop::of`](super::opened::OpenedLoop::of); `E-require` for loops of which boxes are not known.
    pub fn of(asked: DelayAsked<'_>, budget: &Budget) -> Result<Option<DelayBoxes>, Error> {
        if asked.problem.shape() == Shape::UnitDisc {
            let sampled = SampledDelay::of(asked, budget)?;
            return Ok(Some(sampled.map_or(DelayBoxes::Never, |one| DelayBoxes::Sampled(Box::new(one)))));
        }
        let continuous = ContinuousDelay::of(asked, budget)?;
        Ok(continuous.map(|one| DelayBoxes::Continuous(Box::new(one))))
    }

    /// The families of which each is stable over a box where all its points have the margin; `None` where no loop has it.
    pub fn families(&self) -> Option<Vec<DelayFamily<'_>>> {
        match self {
            DelayBoxes::Continuous(one) => Some(vec![one.family()]),
            DelayBoxes::Sampled(one) => Some(one.families()),
            DelayBoxes::Never => None,
        }
    }

    /// Whether all stable points of a closed box have the delay margin, or no point has it.
    ///
    /// Cost: that of a few dozen boxes with one parameter more.
    ///
    /// # Errors
    /// When the budget runs out.
    pub fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<OverPoints, Exhausted> {
        match self {
            DelayBoxes::Continuous(one) => look(one.as_ref(), sides, budget),
            DelayBoxes::Sampled(one) => look(one.as_ref(), sides, budget),
            DelayBoxes::Never => Ok(OverPoints::None),
        }
    }
}

fn look(loops: &impl Delays, sides: &[[Rational; 2]], budget: &Budget) -> Result<OverPoints, Exhausted> {
    if budget.enter(|| loops.bears_none(sides))? {
        return Ok(OverPoints::None);
    }
    let with_one = |delay: &Rational| loops.over(sides, &[delay.clone(), delay.clone()], CELLS[0], budget);
    let tried = loops.tried();
    let greatest = &tried[0];
    let with_all = with_one(greatest)?;
    if with_all == OverPoints::None {
        return Ok(OverPoints::None);
    }
    let middle: Vec<Rational> = sides.iter().map(|[low, high]| low.midpoint(high)).collect();
    let lost = without_stability(loops, &tried, &middle, budget)?;
    for delay in lost.iter().filter(|delay| *delay != greatest) {
        if with_one(delay)? == OverPoints::None {
            return Ok(OverPoints::None);
        }
    }
    if !lost.is_empty() {
        return Ok(OverPoints::Open { middle: Some(false) });
    }
    if with_all != OverPoints::All {
        return Ok(OverPoints::Open { middle: None });
    }
    for delays in loops.ranges() {
        if !is_stable_with(loops, sides, delays, budget)? {
            return Ok(OverPoints::Open { middle: None });
        }
    }
    Ok(OverPoints::All)
}

/// Delays with which a point is not stable: one that is near to the least such one, and longer ones. With a longer one further
/// roots may cross somewhere in a box, with a shorter one the first root may.
fn without_stability(
    loops: &impl Delays,
    tried: &[Rational],
    point: &[Rational],
    budget: &Budget,
) -> Result<Vec<Rational>, Exhausted> {
    let is_lost = |delay: &Rational| Ok::<bool, Exhausted>(loops.at(point, delay, budget)? == Some(false));
    let mut shortest = None;
    for delay in tried {
        match (is_lost(delay)?, &shortest) {
            (true, _) => shortest = Some(delay),
            (false, Some(_)) => break,
            (false, None) => {}
        }
    }
    let Some(shortest) = shortest else { return Ok(Vec::new()) };
    let mut out = Vec::new();
    for (above, below) in LONGER {
        let delay = shortest * &Rational::new(above.into(), below.into());
        if delay <= tried[0] && loops.is_delay(&delay) && is_lost(&delay)? {
            out.push(delay);
        }
    }
    Ok(out)
}

/// Whether all points are stable with all delays of a range; `false` where that is not seen.
fn is_stable_with(
    loops: &impl Delays,
    sides: &[[Rational; 2]],
    delays: [Rational; 2],
    budget: &Budget,
) -> Result<bool, Exhausted> {
    let more = MORE_PARTS * halvings(sides);
    let mut open = vec![delays];
    let mut looked = 0;
    while let Some(delays) = open.pop() {
        looked += 1;
        match loops.over(sides, &delays, CELLS[1] + more, budget)? {
            OverPoints::All => {}
            OverPoints::Open { .. } if looked < MOST_PARTS + more && delays[0] < delays[1] => {
                let [low, high] = delays;
                let middle = low.midpoint(&high);
                open.extend([[low, middle.clone()], [middle, high]]);
            }
            _ => return Ok(false),
        }
    }
    Ok(true)
}

/// How often a box was about halved along each of its sides, by how much farther from zero than long they are.
fn halvings(sides: &[[Rational; 2]]) -> usize {
    let of = |[low, high]: &[Rational; 2]| match (high - low).checked_div(&low.abs().max(high.abs())) {
        Some(share) if share.sign().is_gt() => {
            share.denominator().bit_length().saturating_sub(share.numerator().bit_length()) as usize
        }
        _ => MOST_HALVINGS,
    };
    sides.iter().map(of).min().unwrap_or(0).min(MOST_HALVINGS)
}

/// A box that was halved oftener is a point.
const MOST_HALVINGS: usize = 48;

/// Shares of the greatest delay with which a loop may be unstable, from the longest to the shortest.
const SHARES: [(i64, i64); 12] =
    [(1, 1), (7, 8), (3, 4), (5, 8), (1, 2), (3, 8), (1, 4), (1, 8), (1, 16), (1, 32), (1, 64), (1, 128)];

/// Delays up to the greatest that may be any number.
pub(super) fn shares_of(greatest: &Rational) -> Vec<Rational> {
    SHARES.iter().map(|&(above, below)| greatest * &Rational::new(above.into(), below.into())).collect()
}
