//! Which share of a box is stable, by halving it.

use super::factor::ToleranceProblem;
use super::polynomial::Bundle;
use super::prove::{Cell, keeps_sign, signs_at};
use super::separate::separating_vector;
use super::sides::at_factor;
use super::tensor::{FrequencyScale, Tensor};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use std::collections::VecDeque;

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
        let whole = at_factor(&self.sides, factor);
        let mut waiting = VecDeque::from([(whole, 0u64)]);
        let mut volume = BoxVolume { undecided: Rational::ONE, ..BoxVolume::default() };
        while volume.undecided > *goal && volume.boxes + waiting.len() < MOST_BOXES {
            let Some((sides, halvings)) = waiting.pop_front() else { break };
            let Ok(verdict) = budget.enter(|| self.verdict_of(&sides, budget)) else { break };
            let share = Rational::dyadic(&Integer::ONE, halvings);
            match verdict {
                Err(Undecided { axis }) => {
                    let middle = sides[axis][0].midpoint(&sides[axis][1]);
                    let (mut low, mut high) = (sides.clone(), sides);
                    (low[axis][1], high[axis][0]) = (middle.clone(), middle);
                    waiting.extend([(low, halvings + 1), (high, halvings + 1)]);
                }
                Ok(is_stable) => {
                    volume.boxes += 1;
                    volume.undecided = &volume.undecided - &share;
                    let part = if is_stable { &mut volume.stable } else { &mut volume.unstable };
                    *part += &share;
                }
            }
            budget.advance(volume.boxes as u64, (volume.boxes + waiting.len()) as u64);
        }
        Ok(volume)
    }

    /// Whether a box is stable everywhere or nowhere, or along which axis to halve it.
    fn verdict_of(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<bool, Undecided> {
        let (tensor, _) = Tensor::of_pair(&self.p.pair(), sides, FrequencyScale(2 * self.scale));
        let undecided = Undecided { axis: tensor.steepest_parameter() };
        let middle: Vec<Rational> = sides.iter().map(|[low, high]| low.midpoint(high)).collect();
        let Some((signs, _)) = signs_at(self.p, &middle) else { return Err(undecided) };
        for ((_, f), sign) in self.p.certain.iter().zip(signs) {
            let kept = keeps_sign(&Bundle::new(&[f], sides.len()), sides, sign, 1, budget);
            if !matches!(kept, Ok(Ok(_))) {
                return Err(undecided);
            }
        }
        let frequency = sides.len();
        let mut stack = vec![Cell::whole(tensor)];
        let mut cells = 0;
        while let Some(cell) = stack.pop() {
            let [x, y] = cell.tensor.planes.as_slice() else { unreachable!("a pair") };
            cells += 1;
            if separating_vector(x, y, cell.tensor.error).is_none() {
                if cells + stack.len() > FREQUENCIES || cell.tensor.best_axis_of(&[frequency]).is_none() {
                    return Err(undecided);
                }
                stack.extend(cell.halves(frequency));
            }
        }
        Ok(self.p.is_stable_at(&middle))
    }
}

/// Along which axis a box is halved that is not decided.
struct Undecided {
    axis: usize,
}
