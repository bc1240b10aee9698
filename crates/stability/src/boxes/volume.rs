//! Which share of a box is stable, by halving it.

use super::factor::ToleranceProblem;
use super::parts::middle;
use super::polynomial::Bundle;
use super::prove::{Cell, closed_by_constant, keeps_sign, signs_at};
use super::sides::at_factor;
use super::tensor::{FrequencyScale, Tensor};
use crate::subdivision::{BoxPart, Look, Order, Tally, subdivide};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};

/// More parameters leave too much undecided in any time.
pub const MOST_PARAMETERS: usize = 6;

/// Frequencies of one box are halved into so many parts at most.
const FREQUENCIES: usize = 48;

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
}

impl ToleranceProblem<'_> {
    /// How much of the box of a factor is stable: boxes are halved, the largest first, until at most the share `goal` of the
    /// volume is undecided, or the budget runs out. A box without zeros of the pair and of the certain polynomials has one
    /// number of stable roots, which its midpoint tells.
    ///
    /// The number of boxes grows exponentially with the parameters; more than [`MOST_PARAMETERS`] make no sense. Cost: the
    /// Bernstein coefficients of the pair for each box.
    ///
    /// # Errors
    /// None at present; a budget that runs out leaves more undecided.
    pub fn volume(&self, factor: &Rational, goal: &Rational, budget: &Budget) -> Result<BoxVolume, Exhausted> {
        budget.step("halving the box");
        let mut volume = BoxVolume { undecided: Rational::ONE, ..BoxVolume::default() };
        let look = |part: &mut BoxPart, tally: Tally| {
            budget.advance(tally.decided as u64, (tally.decided + tally.waiting + 1) as u64);
            if volume.undecided <= *goal || tally.decided + tally.waiting + 1 >= MOST_BOXES {
                return Ok(Look::Open(()));
            }
            let is_stable = match budget.enter(|| self.verdict_of(&part.sides, budget))? {
                Ok(is_stable) => is_stable,
                Err(Undecided { axis }) => return Ok(Look::Cut(axis)),
            };
            let share = Rational::dyadic(&Integer::ONE, part.halvings.iter().map(|&h| u64::from(h)).sum());
            volume.boxes += 1;
            volume.undecided -= &share;
            *(if is_stable { &mut volume.stable } else { &mut volume.unstable }) += &share;
            Ok(Look::Decided(()))
        };
        // A budget that runs out leaves the rest undecided.
        let whole = BoxPart::whole(at_factor(&self.sides, factor));
        let _ = subdivide([whole], Order::Breadth, budget, look);
        Ok(volume)
    }

    /// Whether a box is stable everywhere or nowhere, or along which axis to halve it.
    fn verdict_of(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<bool, Undecided> {
        let (tensor, _) = Tensor::of_pair(&self.p.pair(), sides, FrequencyScale(2 * self.scale));
        let undecided = Undecided { axis: tensor.steepest_parameter() };
        let middle = middle(sides);
        let Some((signs, _)) = signs_at(self.p, &middle) else { return Err(undecided) };
        for ((_, f), sign) in self.p.certain.iter().zip(signs) {
            let kept = keeps_sign(&Bundle::new(&[f], sides.len()), sides, sign, 1, budget);
            if !matches!(kept, Ok(Ok(_))) {
                return Err(undecided);
            }
        }
        let frequency = sides.len();
        let look = |cell: &mut Cell, tally: Tally| {
            if closed_by_constant(cell, tally.looks()).is_ok() {
                return Ok(Look::Decided(()));
            }
            let axis = cell.tensor.best_axis_of(&[frequency]).filter(|_| tally.cells() < FREQUENCIES);
            Ok(axis.map_or(Look::Open(()), Look::Cut))
        };
        match subdivide([Cell::whole(tensor)], Order::Depth, budget, look) {
            Ok(Ok(_)) => Ok(self.p.is_stable_at(&middle)),
            _ => Err(undecided),
        }
    }
}

/// Along which axis a box is halved that is not decided.
struct Undecided {
    axis: usize,
}
