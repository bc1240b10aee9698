//! Zeros of functions of Taylor models.
//!
//! The models are sets of elements of an algebra with a norm, in which Newton's method is as good as in numbers: with `y` about one over the slope and
//! `|y f(d)| + |1 - y f'(d + e)| r <= r` for all `e` of a norm up to `r`, there is one zero `d + e` with such an `e`.

use super::{Ball, Elementary};
use crate::number::Integer;

/// The radius is doubled so often before the zero is given up.
const MOST_DOUBLINGS: usize = 6;

/// Taylor models, for Newton's method.
pub(super) trait Approximate: Elementary {
    /// A polynomial near to the model, with nothing left out.
    fn near(&self) -> Self;
    /// The model with all that has at most this norm, in units, added.
    fn around(&self, radius: &Integer) -> Self;
    /// A bound of the norm, in units.
    fn size(&self) -> Integer;
}

/// The zero of a function near the number in the middle of a ball, for models with so many terms.
pub(super) fn implicit<S: Approximate>(
    like: &S,
    start: &Ball,
    terms: usize,
    f: &dyn Fn(&S) -> Option<[S; 2]>,
) -> Option<S> {
    let mut near = like.constant(&Ball::from_units(start.middle_units(), start.middle_units(), start.bits()));
    // Each step doubles the number of terms; two more make the first one certain.
    for _ in 0..terms.next_power_of_two().ilog2() + 2 {
        let [value, slope] = f(&near)?;
        near = near.minus(&value.over(&slope)?).near();
    }
    let [value, slope] = f(&near)?;
    let inverse = slope.reciprocal()?.near();
    let missed = inverse.times(&value).size();
    let mut radius = &missed + &missed + Integer::from(4);
    for _ in 0..MOST_DOUBLINGS {
        let around = near.around(&radius);
        let [_, slope] = f(&around)?;
        let left = like.integer(&Integer::ONE).minus(&inverse.times(&slope)).size();
        let moved = -(-(&left * &radius) >> like.bits());
        if &missed + &moved <= radius {
            return Some(around);
        }
        radius = &radius + &radius;
    }
    None
}
