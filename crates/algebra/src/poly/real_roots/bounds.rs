//! Bounds of the real roots, as powers of two.

use crate::number::Integer;
use crate::poly::UniPoly;

/// The least `k` such a simple test finds with every positive root below `2^k`; `None` when the
/// signs show that there is no positive root (or the polynomial is constant).
///
/// With `c` the leading coefficient, every positive
/// root is below `2 max (|c_{n-i}| / |c|)^{1/i}` over the coefficients of the other sign
/// [Kioustelidis1986](crate::bibliography#kioustelidis1986); bit lengths stand for the logarithms, rounded up.
pub fn positive_root_bound_bits(p: &UniPoly) -> Option<i64> {
    positive_root_bound_from_top(p.coeffs().iter().rev())
}

/// The same from the coefficients, the leading one first; from the constant term up it bounds the
/// reciprocals of the positive roots.
pub fn positive_root_bound_from_top<'a>(mut coeffs: impl Iterator<Item = &'a Integer>) -> Option<i64> {
    let lead = coeffs.next()?;
    let mut best: Option<i64> = None;
    for (i, c) in (1i64..).zip(coeffs) {
        if c.is_zero() || c.is_negative() == lead.is_negative() {
            continue;
        }
        // |c| < 2^bits(c), |lead| >= 2^(bits(lead) - 1).
        let bits = c.bit_length() as i64 - (lead.bit_length() as i64 - 1);
        let k = bits.div_euclid(i) + i64::from(bits.rem_euclid(i) != 0);
        best = best.max(Some(k));
    }
    best.map(|k| k + 1)
}

/// As [`positive_root_bound_bits`] for the magnitude of negative roots.
pub fn negative_root_bound_bits(p: &UniPoly) -> Option<i64> {
    positive_root_bound_bits(&p.negated_argument())
}

/// A `k` with every real root strictly between `-2^k` and `2^k`; 0 when there is none to bound.
pub fn root_bound_bits(p: &UniPoly) -> i64 {
    let best = positive_root_bound_bits(p).max(negative_root_bound_bits(p));
    best.unwrap_or(0)
}
