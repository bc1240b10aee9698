//! The scales of a parameter: how far from its usual value an interval is, and where one is divided.

use crate::number::Rational;

/// The exponent of the power of two near to a number that is not zero.
pub(super) fn exponent(x: &Rational) -> i64 {
    x.numerator().bit_length() as i64 - x.denominator().bit_length() as i64
}

/// Ends on a side of zero are far apart from this many octaves on.
const FAR: i64 = 3;

/// What is nearer to zero than the usual value by this many octaves is divided from what is not.
const SMALL: i64 = 8;

/// A number about the geometric mean of ends that are far apart, as what happens at small values of a parameter happens on a
/// small scale; none where they are not.
pub(super) fn between_scales(lo: &Rational, hi: &Rational, near: &Rational) -> Option<Rational> {
    let power = |exponent: i64| Rational::from(2).pow(exponent).expect("two is not zero");
    let small = if near.is_zero() { 0 } else { exponent(near) } - SMALL;
    let of_positive = |lo: &Rational, hi: &Rational| {
        let high = exponent(hi);
        let low = if lo.is_zero() { small.min(high - FAR) } else { exponent(lo) };
        (high - low >= FAR).then(|| power((low + high).div_euclid(2)))
    };
    if !lo.is_negative() {
        return of_positive(lo, hi);
    }
    if hi.sign().is_le() {
        return of_positive(&-hi, &-lo).map(|x| -x);
    }
    // Zero stays inside of a small interval: there may be a pole or a zero.
    let [above, below] = [hi, &-lo].map(|end| exponent(end) > small + 1);
    (above || below).then(|| if above { power(small) } else { -power(small) })
}

/// How many octaves an interval is away from a number; many where zero lies between.
pub(super) fn octaves(lo: &Rational, hi: &Rational, near: &Rational) -> i64 {
    const OTHER_SIDE: i64 = 12;
    if lo <= near && near <= hi {
        return 0;
    }
    let closest = if near < lo { lo } else { hi };
    match (closest.sign(), near.sign()) {
        (a, b) if a == b && a.is_ne() => (exponent(closest) - exponent(near)).abs(),
        _ => OTHER_SIDE,
    }
}

/// Intervals that touch, as one.
pub(super) fn joined(intervals: Vec<(Rational, Rational)>) -> Vec<(Rational, Rational)> {
    let mut out: Vec<(Rational, Rational)> = Vec::new();
    for (lo, hi) in intervals {
        match out.last_mut() {
            Some(last) if last.1 >= lo => last.1 = hi.max(last.1.clone()),
            _ => out.push((lo, hi)),
        }
    }
    out
}
