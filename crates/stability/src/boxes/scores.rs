//! Along which axis a cell is halved: a matter of speed alone, so the coefficients are rounded to machine words.

use super::tensor::Tensor;

/// Bits of a rounded coefficient: differences of two differences still fit.
const BITS: u32 = 58;

/// The coefficients of a tensor, rounded, those of each polynomial and frequency side by side.
pub(super) struct Scores<'a> {
    tensor: &'a Tensor,
    /// For each polynomial, for each frequency.
    lanes: Vec<Vec<Vec<i64>>>,
    /// How far a rounded coefficient may be from the true one, in its own unit.
    error: i64,
}

impl<'a> Scores<'a> {
    pub fn of(tensor: &'a Tensor) -> Scores<'a> {
        let all = tensor.planes.iter().flatten();
        let bits = i128::BITS - all.fold(0, |bits, v| bits | v.unsigned_abs()).leading_zeros();
        let shift = bits.saturating_sub(BITS);
        let frequencies = tensor.count(tensor.axes() - 1);
        let lane =
            |plane: &[i128], f: usize| plane[f..].iter().step_by(frequencies).map(|v| (v >> shift) as i64).collect();
        let lanes = tensor.planes.iter().map(|plane| (0..frequencies).map(|f| lane(plane, f)).collect()).collect();
        let error = (tensor.error >> shift).min(1 << BITS) as i64 + i64::from(shift > 0);
        Scores { tensor, lanes, error }
    }

    /// The axis with the greatest score; `None` where none has any.
    pub fn best_of(&self, axes: &[usize]) -> Option<usize> {
        let last = self.tensor.axes() - 1;
        let mut best = (0, None);
        for &axis in axes {
            let score = if axis == last { self.variation() } else { self.curvature(axis) };
            if score > best.0 {
                best = (score, Some(axis));
            }
        }
        best.1
    }

    /// The sum over neighbouring frequencies of the greatest difference.
    fn variation(&self) -> i128 {
        let between = |pair: usize| {
            let greatest = |lanes: &Vec<Vec<i64>>| {
                let (here, next) = (&lanes[pair], &lanes[pair + 1]);
                here.iter().zip(next).fold(0, |g, (a, b)| (b - a).abs().max(g))
            };
            i128::from(self.lanes.iter().map(greatest).max().unwrap_or(0))
        };
        (0..self.lanes[0].len().saturating_sub(1)).map(between).sum()
    }

    /// The greatest range, over the frequencies, of the derivative by a parameter.
    fn curvature(&self, axis: usize) -> i128 {
        let count = self.tensor.count(axis);
        if count == 1 {
            return 0;
        }
        let frequencies = self.lanes[0].len();
        let stride = self.tensor.stride(axis) / frequencies;
        let of = |f: usize| -> i128 {
            let range = |lanes: &Vec<Vec<i64>>| {
                let (low, high) = range_of_differences(&lanes[f], stride, count);
                // The differences carry the error of two coefficients each.
                (i128::from(high) - i128::from(low) - 4 * i128::from(self.error)).max(0)
            };
            self.lanes.iter().map(range).sum()
        };
        (0..frequencies).map(of).max().unwrap_or(0) * (count as i128 - 1)
    }
}

/// The least and the greatest difference of neighbours along an axis.
fn range_of_differences(lane: &[i64], stride: usize, count: usize) -> (i64, i64) {
    let (mut low, mut high) = (i64::MAX, i64::MIN);
    let mut start = 0;
    while start < lane.len() {
        let end = start + stride * count;
        // Plain indices: the stretches are often two long.
        for at in start..end - stride {
            let difference = lane[at + stride] - lane[at];
            low = low.min(difference);
            high = high.max(difference);
        }
        start = end;
    }
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::super::polynomial::Bundle;
    use super::*;
    use jurist_algebra::number::Rational;
    use jurist_algebra::poly::{Domain, MultiPoly};

    /// Of `1000 x y + z` over the unit cube, `z` is affine and the value set is not affine in the two others.
    #[test]
    fn a_parameter_in_which_everything_is_affine_is_never_halved() {
        let [x, y, z] = [0, 1, 2].map(MultiPoly::variable);
        let f = x.times(&y).scaled_by(&1000.into()).plus(&z);
        let sides = vec![[Rational::ZERO, Rational::ONE]; 3];
        let tensor = Tensor::of_one(&Bundle::new(&[&f], 3), &sides);
        let scores = Scores::of(&tensor);
        assert_eq!(scores.best_of(&[2]), None);
        assert!(scores.best_of(&[0, 1, 2]).is_some_and(|axis| axis < 2));
        // In x it is affine for every y, but its slope varies with y: both axes are curved.
        assert_eq!([scores.best_of(&[0]), scores.best_of(&[1])], [Some(0), Some(1)]);
        let affine = Tensor::of_one(&Bundle::new(&[&z.plus(&x)], 3), &sides);
        assert_eq!(affine.best_axis(), None);
    }
}
