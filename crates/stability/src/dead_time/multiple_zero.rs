//! Values of a parameter at which a multiple root is at `s = 0`.

use super::family::FamilyLoop;
use crate::Range;
use jurist_algebra::number::{Integer, Rational};

/// At an end with a multiple root such a part of a range is left out.
const BITS_OF_LEFT_OUT: u64 = 24;

impl FamilyLoop {
    /// Whether a root at `s = 0` is a multiple one at a value, on the axis: it is no regular zero of frequency and parameter.
    pub(super) fn has_multiple_zero_at(&self, value: &Rational) -> bool {
        let Some(p) = self.at(value).filter(|_| self.growth(value).is_zero()) else { return false };
        let tau = self.tau.at(value);
        let size = value.abs();
        let is_exact = self.errors().iter().all(|part| part.iter().take(2).all(|e| e.sign_at(&size).is_eq()));
        let slope = p.parts().iter().enumerate().map(|(k, part)| {
            Rational::from(&part.coeff(1)) - Rational::from(&part.coeff(0)) * &tau * Rational::from(k as i64)
        });
        is_exact && p.without_delay().coeff(0).is_zero() && slope.fold(Rational::ZERO, |sum, x| sum + x).is_zero()
    }

    /// A range of the parameter, without the parts next to those of its ends that have a multiple root at `s = 0`; and these parts, each with its lower and its
    /// upper end. A part is `2^-24` of the range. A range without both ends stays as it is.
    ///
    /// Cost: the coefficients at both ends.
    ///
    /// ```
    /// use jurist_algebra::poly::UniPoly;
    /// use jurist_stability::Range;
    /// use jurist_stability::dead_time::{FamilyLoop, Line};
    /// // s^2 + p^2 exp(-s): twice s = 0 at p = 0
    /// let c = |c: &[i64]| UniPoly::from_i64(c);
    /// let parts = vec![vec![c(&[]), c(&[]), c(&[1])], vec![c(&[0, 0, 1])]];
    /// let family = FamilyLoop::new(parts, Line::constant(1.into()), Line::constant(0.into()));
    /// let (rest, parts) = family.apart_from_multiple_zeros(&Range::between(Some(0.into()), Some(1.into())));
    /// assert_eq!((rest.lower, parts.len()), (Some(parts[0][1].clone()), 1));
    /// ```
    pub fn apart_from_multiple_zeros(&self, range: &Range) -> (Range, Vec<[Rational; 2]>) {
        let (Some(lower), Some(upper)) = (&range.lower, &range.upper) else { return (range.clone(), Vec::new()) };
        let part = (upper - lower) * Rational::dyadic(&Integer::ONE, BITS_OF_LEFT_OUT);
        let (mut rest, mut parts) = (range.clone(), Vec::new());
        if self.has_multiple_zero_at(lower) {
            parts.push([lower.clone(), lower + &part]);
            rest.lower = Some(lower + &part);
        }
        if self.has_multiple_zero_at(upper) {
            parts.push([upper - &part, upper.clone()]);
            rest.upper = Some(upper - &part);
        }
        (rest, parts)
    }
}
