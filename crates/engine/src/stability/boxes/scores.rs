//! Along which axis a cell is halved: a matter of speed alone, so the coefficients are rounded to machine words.

use super::tensor::Tensor;

/// Bits of a rounded coefficient: differences of two differences still fit.
const BITS: u32 = 58;

/// The coefficients of a tensor, rounded.
pub(super) struct Scores<'a> {
    tensor: &'a Tensor,
    planes: Vec<Vec<i64>>,
    /// How far a rounded coefficient may be from the true one, in its own unit.
    error: i64,
}

impl<'a> Scores<'a> {
    pub fn of(tensor: &'a Tensor) -> Scores<'a> {
        let all = tensor.planes.iter().flatten();
        let bits = i128::BITS - all.fold(0, |bits, v| bits | v.unsigned_abs()).leading_zeros();
        let shift = bits.saturating_sub(BITS);
        let rounded = |plane: &Vec<i128>| plane.iter().map(|v| (v >> shift) as i64).collect();
        let error = (tensor.error >> shift).min(1 << BITS) as i64 + i64::from(shift > 0);
        Scores { tensor, planes: tensor.planes.iter().map(rounded).collect(), error }
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
        let count = self.tensor.count(self.tensor.axes() - 1);
        let mut greatest = vec![0i64; count.saturating_sub(1)];
        for plane in &self.planes {
            for lane in plane.chunks_exact(count) {
                for (g, pair) in greatest.iter_mut().zip(lane.windows(2)) {
                    *g = (*g).max((pair[1] - pair[0]).abs());
                }
            }
        }
        greatest.iter().map(|g| i128::from(*g)).sum()
    }

    /// The greatest range, over the frequencies, of the derivative by a parameter.
    fn curvature(&self, axis: usize) -> i128 {
        let (stride, count) = (self.tensor.stride(axis), self.tensor.count(axis));
        if count == 1 {
            return 0;
        }
        let frequencies = self.tensor.count(self.tensor.axes() - 1);
        let mut sum = vec![0i128; frequencies];
        for plane in &self.planes {
            let (mut low, mut high) = (vec![i64::MAX; frequencies], vec![i64::MIN; frequencies]);
            for block in plane.chunks_exact(stride * count) {
                // Neighbours along the axis are one stride apart; a stride has whole lanes of frequencies.
                let lanes = block.chunks_exact(frequencies).zip(block[stride..].chunks_exact(frequencies));
                for (here, next) in lanes {
                    for ((low, high), (a, b)) in low.iter_mut().zip(&mut high).zip(here.iter().zip(next)) {
                        let difference = b - a;
                        *low = (*low).min(difference);
                        *high = (*high).max(difference);
                    }
                }
            }
            for (s, (low, high)) in sum.iter_mut().zip(low.into_iter().zip(high)) {
                // The differences carry the error of two coefficients each.
                *s += (i128::from(high) - i128::from(low) - 4 * i128::from(self.error)).max(0);
            }
        }
        sum.into_iter().max().unwrap_or(0) * (count as i128 - 1)
    }
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
        let affine = Tensor::of_one(&Bundle::new(&[&z.plus(&x)], 3), &sides);
        assert_eq!(affine.best_axis(), None);
    }
}
