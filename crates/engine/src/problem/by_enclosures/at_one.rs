//! Rational values of the parameter `K` at which a part of a loop over its hyperperiod rests: `D(1; K)` is zero there, though its coefficients are
//! known by enclosures only. An example is `K = -1` where a controller that integrates is driven by `(1 + K) y`.

use super::origin::vanishing_on;
use super::steady_state::{Form, at_rest};
use crate::model::{Samples, SamplesPart};
use crate::stability::{Range, zeros_in};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, RationalFunction, UniPoly, simplest_between};

/// Numerators and denominators with more bits are not tried.
const MOST_BITS: u64 = 48;

/// Bits of a zero that its simplest neighbour has to share.
const NEAR_BITS: u64 = 192;

/// The polynomial `d(K)` with such values, other than 0, as its zeros, from the coefficients of `D(1; K)`.
///
/// A value is tried where an approximate polynomial or its derivative has a zero. It is a zero as many times as independent states are found that
/// stay what they are in all samples.
pub(super) fn zeros_at_one(
    sums: &[Ball],
    samples: &Samples,
    of: &SamplesPart,
    budget: &Budget,
) -> Result<UniPoly, Exhausted> {
    let near = UniPoly::new(sums.iter().map(Ball::middle_units).collect());
    let mut known = UniPoly::constant(Integer::ONE);
    if near.is_zero() {
        return Ok(known);
    }
    let (width, share) = (Rational::dyadic(&Integer::ONE, NEAR_BITS + 8), Rational::dyadic(&Integer::ONE, NEAR_BITS));
    let mut tried = vec![Rational::ZERO];
    // Zeros that are near to each other, as those of a complex loop and its conjugate, are seen by the derivative.
    for zero in
        [zeros_in(&near, &Range::default(), budget)?, zeros_in(&near.derivative(), &Range::default(), budget)?].concat()
    {
        let (lower, upper) = zero.refined(&width).enclosure();
        let Some(value) = simplest_between(&(lower - &share), &(upper + &share)) else { continue };
        let is_short = [value.numerator(), value.denominator()].iter().all(|x| x.bit_length() <= MOST_BITS);
        if is_short && !tried.contains(&value) {
            let linear = UniPoly::new(vec![-value.numerator(), value.denominator()]);
            known = (0..resting(samples, of, &value)).fold(known, |known, _| known.times(&linear));
            tried.push(value);
        }
    }
    Ok(known)
}

/// How many independent states are found that stay what they are in all samples.
fn resting(samples: &Samples, of: &SamplesPart, value: &Rational) -> usize {
    samples.resting(of, value).max(plants_at_rest(samples, of, value).unwrap_or(0))
}

/// The same with plants behind holds by their differential equations; `None` where rows have another form.
fn plants_at_rest(samples: &Samples, of: &SamplesPart, value: &Rational) -> Option<usize> {
    let rows = samples.patterns.iter().map(|m| {
        let [a, b] = m.each_ref().map(|m| m.principal(&of.at_sample));
        at_rest(&a, &b, &samples.symbols)
    });
    let rows: Vec<Form> = rows.collect::<Option<Vec<_>>>()?.into_iter().flatten().collect();
    let column = |j: usize| rows.iter().map(|row| RationalFunction::from(&row[j][0] + &(&row[j][1] * value))).collect();
    // Columns that depend on each other have a combination of states.
    let columns = (0..of.at_sample.len()).map(column).collect();
    Some(vanishing_on(columns, &(0..rows.len()).collect::<Vec<_>>()).len())
}
