//! Polynomials from their values at small integers.

use jurist_algebra::ball::Ball;
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::Integer;

/// How many more bits values need than so many coefficients.
pub(super) fn bits_for_interpolation(count: usize) -> u64 {
    16 + 2 * count as u64 * (u64::from(count.ilog2()) + 1)
}

/// So many coefficients of a polynomial, from its values.
///
/// Cost: that many values, and `O(count^2)` products by small integers.
pub(super) fn interpolated(count: usize, value: impl Fn(i64) -> Ball) -> Vec<Ball> {
    // 0, 1, -1, 2, -2, ...
    let nodes: Vec<i64> = (0..count as i64).map(|k| if k % 2 == 0 { -k / 2 } else { (k + 1) / 2 }).collect();
    let at = |node: &i64| {
        checkpoint(count as u64);
        value(*node)
    };
    let mut differences: Vec<Ball> = nodes.iter().map(at).collect();
    for order in 1..count {
        for k in (order..count).rev() {
            let step = nodes[k] - nodes[k - order];
            let difference = differences[k].sub(&differences[k - 1]).divided_by(step.unsigned_abs());
            differences[k] = if step < 0 { difference.neg() } else { difference };
        }
    }
    // Newton's form in powers.
    let mut out: Vec<Ball> = Vec::with_capacity(count);
    for (node, difference) in nodes.iter().zip(&differences).rev() {
        let minus = Integer::from(-node);
        out.insert(0, Ball::zero(difference.bits()));
        for i in 0..out.len() - 1 {
            out[i] = out[i].add(&out[i + 1].scaled(&minus));
        }
        out[0] = out[0].add(difference);
    }
    out
}
