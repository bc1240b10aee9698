//! Polynomials in the parameter from their values at small multiples of a power of two.

use jurist_algebra::ball::Ball;
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::Integer;
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::symbols::Symbols;

/// The exponent of two at which the terms with the parameter are about as large as those without, of entries by powers of the
/// parameter.
pub(super) fn likely_scale<'e>(
    entries: impl Iterator<Item = &'e Vec<MultiPoly>> + Clone,
    symbols: &Symbols,
    bits: u64,
) -> i64 {
    let length = |k: usize| {
        let parts = entries.clone().filter_map(|c| c.get(k));
        parts.map(|p| symbols.enclose(p, bits).magnitude_units().bit_length()).max().unwrap_or(0) as i64
    };
    match (length(0), length(1)) {
        (0, _) | (_, 0) => 0,
        (without, with) => without - with,
    }
}

/// So many coefficients of a function of entries, which are given by powers of the parameter, from its values at small multiples of
/// `2^scale`.
///
/// Cost: that of [`interpolated`], and of the entries.
pub(super) fn coefficients_of<'e>(
    entries: impl Iterator<Item = &'e Vec<MultiPoly>>,
    symbols: &Symbols,
    (scale, count, bits): (i64, usize, u64),
    function: impl Fn(Vec<Ball>) -> Ball,
) -> Vec<Ball> {
    let working = bits + bits_for_interpolation(count);
    let scaled = |(k, c): (usize, &MultiPoly)| symbols.enclose(c, working).shifted(scale * k as i64);
    let enclosed: Vec<Vec<Ball>> = entries.map(|c| c.iter().enumerate().map(scaled).collect()).collect();
    let value = |node: i64| {
        let node = Integer::from(node);
        let horner = |c: &Vec<Ball>| c.iter().rev().fold(Ball::zero(working), |sum, c| sum.scaled(&node).add(c));
        function(enclosed.iter().map(horner).collect())
    };
    let found = interpolated(count, value);
    found.iter().enumerate().map(|(k, c)| c.shifted(-scale * k as i64)).collect()
}

/// How many more bits values need than so many coefficients.
fn bits_for_interpolation(count: usize) -> u64 {
    16 + 2 * count as u64 * (u64::from(count.ilog2()) + 1)
}

/// So many coefficients of a polynomial, from its values.
///
/// Cost: that many values, and `O(count^2)` products by small integers.
fn interpolated(count: usize, value: impl Fn(i64) -> Ball) -> Vec<Ball> {
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
