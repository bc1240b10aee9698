//! The chooser between refinement in fixed point and in exact integers.

use super::bracket::Bracket;
use super::fixed::refine_bracket;
use crate::number::Sign;
use crate::poly::UniPoly;

/// From so many bits to gain on, refinement works in fixed point.
const FIXED_POINT_MIN_BITS: u64 = 16;

impl Bracket {
    /// Narrows the bracket to a width of at most `2^-target`: in fixed point, or exactly when little is
    /// missing or the bracket holds or touches zero.
    pub fn refine(&mut self, p: &UniPoly, target: i64) {
        let beside_zero = self.lo.sign() == Sign::Greater || self.hi.is_negative();
        if beside_zero && self.bits_missing(target) >= FIXED_POINT_MIN_BITS {
            refine_bracket(p, self, target);
        } else {
            self.refine_exact(p, target);
        }
    }

    /// About twice as many bits behind the point.
    pub fn refine_further(&mut self, p: &UniPoly) {
        let width = &self.hi - &self.lo;
        let now = self.bits as i64 - width.bit_length() as i64;
        self.refine(p, now.max(8).saturating_mul(2));
    }
}
