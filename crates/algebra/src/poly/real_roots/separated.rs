//! Disjoint enclosures.

use crate::poly::algebraic::RealAlgebraic;

/// The roots in ascending order, irrational ones refined until all enclosures are disjoint.
pub(super) fn separated(mut roots: Vec<RealAlgebraic>) -> Vec<RealAlgebraic> {
    roots.sort();
    for i in 1..roots.len() {
        let (left, right) = roots.split_at_mut(i);
        let (left, right) = (&mut left[i - 1], &mut right[0]);
        while left.enclosure().1 >= right.enclosure().0 {
            left.narrow_further();
            right.narrow_further();
        }
    }
    roots
}
