//! Functions of balls, from the exponential of small matrices.

use super::{Ball, BallMatrix, exponential};
use crate::number::Integer;

/// The exponential of every number in the ball.
///
/// Cost: that of [`exponential`] of a number at either end.
pub fn exp(x: &Ball) -> Ball {
    // It grows, so that the ends are those of the ends.
    let at = |end: &Integer| {
        let point = Ball { lo: end.clone(), hi: end.clone(), bits: x.bits };
        exponential(&BallMatrix::from_fn(1, |_, _| point.clone())).at(0, 0).clone()
    };
    let (lower, upper) = (at(&x.lo), at(&x.hi));
    let lo = if lower.lo.is_negative() { Integer::ZERO } else { lower.lo };
    Ball { lo, hi: upper.hi, bits: x.bits }
}

/// Cosine and sine of every number in the ball.
///
/// Cost: that of [`exponential`] of a 2 x 2 matrix at the middle; neither function changes by more than its argument.
pub fn cos_sin(x: &Ball) -> (Ball, Ball) {
    let middle = x.middle_units();
    let radius = (&x.hi - &middle).max(&middle - &x.lo);
    let point = Ball { lo: middle.clone(), hi: middle, bits: x.bits };
    let turn = BallMatrix::from_fn(2, |i, j| match (i, j) {
        (0, 1) => point.clone(),
        (1, 0) => point.neg(),
        _ => Ball::zero(x.bits),
    });
    let e = exponential(&turn);
    let one = Ball::from_integer(&Integer::ONE, x.bits);
    let bounded = |b: &Ball| {
        let wide = b.widened(&radius);
        wide.intersection(&one.union(&one.neg())).unwrap_or(wide)
    };
    (bounded(e.at(0, 0)), bounded(e.at(0, 1)))
}

/// The tangent of every number in the ball; `None` where the cosine may vanish.
pub fn tan(x: &Ball) -> Option<Ball> {
    let (cos, sin) = cos_sin(x);
    sin.div(&cos)
}
