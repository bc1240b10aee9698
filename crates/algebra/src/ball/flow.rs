//! Exponentials of matrices of functions.

use super::Enclosed;
use super::exponential::{LARGEST_BITS, balancing_units};
use super::solutions::Scaled;
use crate::limits::checkpoint;
use crate::number::Integer;

/// The exponential of a matrix of so many rows, given row by row; `None` where it may have too many bits to be of use.
///
/// The matrix is balanced and halved until its norm is at most 1/4; the powers of its series are made in groups
/// ([PatersonStockmeyer1973](crate::bibliography#patersonstockmeyer1973)), and the result is squared again.
///
/// Cost: some `2 sqrt(b/4) + h` products of matrices with `b` bits and `h` halvings.
pub(super) fn exponential_of<S: Scaled>(n: usize, matrix: &[S]) -> Option<Vec<S>> {
    let Some(first) = matrix.first() else { return Some(Vec::new()) };
    let bits = first.bits();
    let one = |like: &S| like.integer(&Integer::ONE);
    if matrix.iter().all(S::is_nothing) {
        return Some((0..n * n).map(|k| if k / n == k % n { one(first) } else { first.nothing() }).collect());
    }
    let sizes: Vec<Option<i64>> =
        matrix.iter().map(|s| (!s.is_nothing()).then(|| s.norm_units().bit_length() as i64)).collect();
    let units = balancing_units(n, &sizes);
    let spread = units.iter().max().zip(units.iter().min()).map_or(0, |(most, least)| (most - least) as u64);
    let in_units = |sign: i64, k: usize| sign * (units[k % n] - units[k / n]);
    let more = bits + spread;
    let balanced: Vec<S> = matrix.iter().enumerate().map(|(k, s)| s.rescaled(more, in_units(1, k))).collect();
    let row = |i: usize| (0..n).fold(Integer::ZERO, |sum, j| sum + balanced[i * n + j].norm_units());
    let norm = (0..n).map(row).max().unwrap_or(Integer::ZERO);
    if norm.bit_length() > more + LARGEST_BITS {
        return None;
    }
    // 2^halvings >= 4 norm.
    let halvings = (norm.bit_length() + 2).saturating_sub(more);
    let working = more + 2 * halvings + 16;
    let x: Vec<S> = balanced.iter().map(|s| s.rescaled(working, -(halvings as i64))).collect();
    let mut out = by_series(n, &x, working);
    for _ in 0..halvings {
        out = product(n, &out, &out);
    }
    Some(out.iter().enumerate().map(|(k, s)| s.rescaled(bits, in_units(-1, k))).collect())
}

/// The exponential of a matrix of norm 1/4 at most.
fn by_series<S: Scaled>(n: usize, x: &[S], working: u64) -> Vec<S> {
    // The term of power k is at most 2^-small.
    let (mut last, mut small) = (1u64, 2u64);
    while small < working + 1 {
        last += 1;
        small += 2 + u64::from(last.ilog2());
    }
    let group = (1..).find(|g| g * g > last).unwrap_or(1);
    let one = x[0].integer(&Integer::ONE);
    let identity: Vec<S> = (0..n * n).map(|k| if k / n == k % n { one.clone() } else { one.nothing() }).collect();
    let mut powers = vec![identity, x.to_vec()];
    while (powers.len() as u64) <= group {
        powers.push(product(n, &powers[powers.len() - 1], x));
    }
    // With q powers a group: S_g = sum of X^j (g q)!/(g q + j)! for j < q, and X^q (g q)!/((g + 1) q)! S_(g+1).
    let mut sum: Option<Vec<S>> = None;
    for first in (0..=last / group).rev().map(|g| g * group) {
        let weighed = |power: &[S], j: u64| -> Vec<S> {
            power.iter().map(|s| divided_by_all(s, first + 1..=first + j)).collect()
        };
        let mut own = match sum {
            Some(sum) => weighed(&product(n, &sum, &powers[group as usize]), group),
            None => vec![one.nothing(); n * n],
        };
        for (power, j) in powers[..group as usize].iter().zip(0..) {
            own = own.iter().zip(weighed(power, j)).map(|(s, p)| s.plus(&p)).collect();
        }
        sum = Some(own);
    }
    // The first term left out is at most 2^-(working + 3), all of them 4/3 of it.
    sum.unwrap_or_default().iter().map(S::widened).collect()
}

/// The quotient by the product of some numbers.
fn divided_by_all<S: Scaled>(s: &S, mut factors: impl Iterator<Item = u64>) -> S {
    let mut left = factors.next();
    let mut out = s.clone();
    while let Some(first) = left {
        let mut all = first;
        left = None;
        for factor in factors.by_ref() {
            match all.checked_mul(factor) {
                Some(more) => all = more,
                None => {
                    left = Some(factor);
                    break;
                }
            }
        }
        out = if all > 1 { out.divided_by(all) } else { out };
    }
    out
}

/// The product of two matrices of so many rows; entries that are zero cost nothing.
pub(super) fn product<S: Enclosed>(n: usize, a: &[S], b: &[S]) -> Vec<S> {
    let entry = |k: usize| {
        let (i, j) = (k / n, k % n);
        checkpoint(n as u64);
        a[0].sum_of_products((0..n).map(|l| (&a[i * n + l], &b[l * n + j])))
    };
    (0..n * n).map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Ball, BallMatrix, Elementary, MultiTaylorModel, Series, exponential};
    use super::*;
    use crate::number::Rational;
    use proptest::prelude::*;

    const BITS: u64 = 160;

    fn ball(n: i64, d: i64) -> Ball {
        Ball::from_rational(&Rational::new(n.into(), d.into()), BITS)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// The entries of `A + x B`, of three rows: as series in `x` they have the exponential at a point as their first coefficient; as Taylor models
        /// they hold those at all points.
        #[test]
        fn exponentials_of_functions_hold_those_of_numbers(a in prop::collection::vec(-40i64..40, 9), b in prop::collection::vec(-6i64..6, 9), far in any::<bool>()) {
            // Stiff ones have rows of other units.
            let unit = |k: usize| if far && k / 3 == 2 && k % 3 < 2 { 500 } else { 1 };
            let [x, zero] = [ball(1, 4), ball(0, 1)];
            let model = &MultiTaylorModel::linear(&[(zero.clone(), x.clone())], 4)[0];
            let entry = |k: usize| model.mul(&model.constant(&ball(b[k], 8))).add(&model.constant(&ball(a[k] * unit(k), 8)));
            let found = exponential_of(3, &(0..9).map(entry).collect::<Vec<_>>()).unwrap();
            for at in [-4i64, -1, 0, 3, 4] {
                let there = |i: usize, j: usize| ball(a[3 * i + j] * unit(3 * i + j), 8).add(&ball(b[3 * i + j], 8).mul(&ball(at, 16)));
                let exact = exponential(&BallMatrix::from_fn(3, there));
                for (k, model) in found.iter().enumerate() {
                    let value = model.terms().fold(zero.clone(), |sum, (e, c)| {
                        sum.add(&ball(at, 4).power(u64::from(e[0])).mul(&Ball::from_units(c.clone(), c.clone(), BITS)))
                    });
                    prop_assert!(value.widened(model.rest_units()).intersection(exact.at(k / 3, k % 3)).is_some());
                }
            }
            let series = |k: usize| Series::linear(&ball(a[k] * unit(k), 8), &ball(b[k], 8), 3);
            let found = exponential_of(3, &(0..9).map(series).collect::<Vec<_>>()).unwrap();
            let exact = exponential(&BallMatrix::from_fn(3, |i, j| ball(a[3 * i + j] * unit(3 * i + j), 8)));
            for (k, s) in found.iter().enumerate() {
                prop_assert!(s.coefficients()[0].intersection(exact.at(k / 3, k % 3)).is_some());
                prop_assert!(far || s.coefficients()[0].width_units().bit_length() < 60);
            }
        }
    }

    #[test]
    fn the_exponential_of_nothing_is_the_identity() {
        let zero = Series::constant(&ball(0, 1), 2);
        let found = exponential_of(2, &vec![zero.clone(); 4]).unwrap();
        let one = zero.integer(&Integer::ONE);
        assert_eq!(found, [one.clone(), zero.clone(), zero.clone(), one]);
        let large = |bits: u64| Series::constant(&Ball::from_integer(&Integer::from(2).pow(bits), BITS), 1);
        // In other units 2^20 is short, beside 2^-20.
        let short = Series::constant(&ball(1, 1 << 20), 1);
        for of in [exponential_of::<Series>, Series::exponential_of] {
            assert!(of(1, &[large(12)]).is_some() && of(1, &[large(14)]).is_none());
            assert!(
                of(
                    2,
                    &[zero.clone(), large(20), short.clone(), zero.clone()]
                        .map(|s| Series::constant(&s.coefficients()[0], 1))
                )
                .is_some()
            );
        }
        let many: Vec<u64> = (1..=40).collect();
        let factorial = Integer::from(2).pow(BITS);
        let s = Series::constant(
            &Ball::from_integer(&many.iter().fold(factorial, |p, k| &p * &Integer::from(*k)), BITS),
            1,
        );
        let left = divided_by_all(&s, many.into_iter());
        assert!(left.coefficients()[0].contains(&Rational::from(Integer::from(2).pow(BITS))));
    }
}
