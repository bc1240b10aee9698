//! Which share of a box is stable, by halving it.

use super::family::Family;
use super::look::BoxLook;
use super::sides::{Side, at_factor};
use crate::subdivision::{BoxPart, Look, Order, Tally, subdivide};
use jurist_algebra::limits::{Budget, Stop};
use jurist_algebra::number::{Integer, Rational};

/// More parameters leave too much undecided in any time.
pub const MOST_PARAMETERS: usize = 6;

/// No more boxes are looked at.
const MOST_BOXES: usize = 1 << 16;

/// Shares of the volume of a box; they add up to 1.
///
/// ```
/// use jurist_stability::boxes::BoxVolume;
/// let nothing = BoxVolume::default();
/// assert!(nothing.stable.is_zero() && nothing.boxes == 0);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct BoxVolume {
    /// Stable at every point.
    pub stable: Rational,
    /// Stable at no point.
    pub unstable: Rational,
    /// Not decided.
    pub undecided: Rational,
    /// The number of boxes that were decided.
    pub boxes: usize,
    /// What stopped the subdivision before so little was undecided as was asked for; `None` where nothing did.
    pub stopped: Option<Stop>,
}

impl BoxVolume {
    /// How much of the box of a factor is stable: boxes are halved, the largest first, until at most the share `goal` of the
    /// volume is undecided, or the budget runs out, which leaves more of it undecided.
    ///
    /// The number of boxes grows exponentially with the parameters; more than [`MOST_PARAMETERS`] make no sense. Cost: a look at each box
    /// ([`Family::looks`]).
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::number::Rational;
    /// use jurist_engine::model::{Model, ParameterBuilder, Time};
    /// use jurist_engine::problem::Ask;
    /// use jurist_stability::boxes::{BoxPolynomial, BoxVolume, Side};
    /// let parameter = |name| ParameterBuilder::new(name).nominal("1");
    /// let builder = Model::builder(Time::Continuous).parameter(parameter("a")).parameter(parameter("b"));
    /// let (model, _) = builder.characteristic("s^2 + a*s + b").build()?;
    /// let problem = model.ask().free("a").free("b").problem()?;
    /// let budget = Budget::unlimited();
    /// let p = BoxPolynomial::new(problem.algebra(&budget)?.polynomial().unwrap(), problem.shape());
    /// // a and b from -1 to 3: stable where both are positive, which is the share (3/4)^2.
    /// let sides = [(); 2].map(|()| Side::scaled(1.into(), [2.into(), 2.into()]));
    /// let volume = BoxVolume::of(&p, &sides, &1.into(), &"1/100".parse().unwrap(), &budget);
    /// let share = Rational::new(9.into(), 16.into());
    /// assert!(volume.stable <= share && share <= &volume.stable + &volume.undecided);
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    pub fn of<F: Family>(p: &F, sides: &[Side], factor: &Rational, goal: &Rational, budget: &Budget) -> BoxVolume {
        budget.step("halving the box");
        let looks = p.looks();
        let mut volume = BoxVolume { undecided: Rational::ONE, ..BoxVolume::default() };
        let look = |part: &mut BoxPart, tally: Tally| {
            budget.advance(tally.decided as u64, (tally.decided + tally.waiting + 1) as u64);
            if volume.undecided <= *goal || tally.decided + tally.waiting + 1 >= MOST_BOXES {
                let many = Stop::Boxes { undecided: (tally.waiting + 1) as u64, halvings: part.halvings.iter().sum() };
                return Ok(Look::Open((volume.undecided > *goal).then_some(many)));
            }
            let share = Rational::dyadic(&Integer::ONE, part.halvings.iter().map(|&h| u64::from(h)).sum());
            let own = match looks(part, budget)? {
                BoxLook::Stable => &mut volume.stable,
                BoxLook::Unstable => &mut volume.unstable,
                BoxLook::Open(axis) if part.sides[axis][0] < part.sides[axis][1] => return Ok(Look::Cut(axis)),
                // Nothing is left to be halved.
                BoxLook::Open(_) => return Ok(Look::Decided(())),
            };
            *own += &share;
            volume.undecided -= &share;
            volume.boxes += 1;
            Ok(Look::Decided(()))
        };
        let ended = subdivide([BoxPart::whole(at_factor(sides, factor))], Order::Breadth, budget, look);
        let stopped = match ended {
            Ok(Ok(_)) => None,
            Ok(Err(many)) => many,
            Err(exhausted) => Some(exhausted.stop),
        };
        BoxVolume { stopped, ..volume }
    }
}
