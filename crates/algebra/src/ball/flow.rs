//! Exponentials of matrices of functions.

use super::exponential::{LARGEST_BITS, balancing_units};
use super::solutions::Scaled;
use super::{Ball, BallMatrix, Elementary, Enclosed, exponential};
use crate::limits::checkpoint;
use crate::number::{Integer, Rational};

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

/// `exp(R u)` with the matrix `R` of so many rows of numbers, given row by row, and `u` a line `a + b y`: the coefficients of the powers of `y` are
/// `exp(R a) (R b)^k/k!`. `None` where `u` is no line, or where so many powers count that this is of no use.
///
/// Cost: an exponential of balls, and a product of matrices of balls for each power.
pub(crate) fn exponential_along<S: Elementary>(n: usize, rates: &[Rational], u: &S) -> Option<Vec<S>> {
    let line = u.line()?;
    let bits = line.first.bits();
    let with_bits = |bits: u64| -> Vec<Ball> { rates.iter().map(|r| Ball::from_rational(r, bits)).collect() };
    let sizes: Vec<Option<i64>> =
        with_bits(bits).iter().map(|b| (!b.is_zero()).then(|| b.magnitude_units().bit_length() as i64)).collect();
    let units = balancing_units(n, &sizes);
    let spread = units.iter().max().zip(units.iter().min()).map_or(0, |(most, least)| (most - least) as u64);
    let working = bits + spread + GUARD_BITS;
    let in_units = |sign: i64, k: usize| sign * (units[k % n] - units[k / n]);
    let balanced: Vec<Ball> = with_bits(working).iter().enumerate().map(|(k, b)| b.shifted(in_units(1, k))).collect();
    let [first, slope] = [&line.first, &line.slope].map(|b| b.with_bits(working));
    let times = |b: &Ball| BallMatrix::from_fn(n, |i, j| balanced[i * n + j].mul(b));
    let step = times(&slope);
    let step: Vec<Ball> = (0..n * n).map(|k| step.at(k / n, k % n).clone()).collect();
    if norm_units(n, &step).bit_length() > working + MOST_REACH_BITS {
        return None;
    }
    // A wide time as its middle and what is around it: multiples of one matrix commute.
    let middle = Ball::from_units(first.middle_units(), first.middle_units(), working);
    let around = first.sub(&middle);
    let whole = times(&middle);
    let mut e = whole.is_of_use().then(|| exponential(&whole))?;
    if !around.is_zero() {
        e = e.mul(&exponential(&times(&around)));
    }
    let start: Vec<Ball> = (0..n * n).map(|k| e.at(k / n, k % n).clone()).collect();
    let (mut powers, left) = powers_along(n, start, &step, line.terms);
    // exp(R (u + e)) = exp(R u) exp(R e), and the second is off the identity by at most 2 |R| |e| where that is less than 2.
    let off = -(-(norm_units(n, &balanced) * (&line.rest << (working - bits))) >> working);
    if off.bit_length() > working {
        return None;
    }
    let total = powers.iter().fold(left.clone(), |sum, m| sum + norm_units(n, m));
    let left = left - (-((total << 1) * off) >> working);
    let all = powers.iter_mut().fold(vec![Vec::new(); n * n], |mut all: Vec<Vec<Ball>>, power| {
        all.iter_mut().zip(power.drain(..)).for_each(|(own, c)| own.push(c));
        all
    });
    let model = |(k, mut own): (usize, Vec<Ball>)| {
        own.push(Ball::from_units(-&left, left.clone(), working));
        let own: Vec<Ball> = own.iter().map(|b| b.shifted(in_units(-1, k)).with_bits(bits)).collect();
        u.of_powers(line.variable, &own)
    };
    Some(all.into_iter().enumerate().map(model).collect())
}

/// The matrices `E S^k/k!` from `E` on, at least as many as are asked for, and a bound of the norm of the sum of all later ones, in units.
fn powers_along(n: usize, start: Vec<Ball>, step: &[Ball], terms: usize) -> (Vec<Vec<Ball>>, Integer) {
    let bits = start[0].bits();
    let reach = norm_units(n, step);
    let mut size = norm_units(n, &start);
    let mut powers = vec![start];
    for k in 1.. {
        checkpoint((n * n) as u64);
        // A bound of the norm of this power, by those of the first matrix and of the step.
        size = -(-(&size * &reach) >> bits).div_mod_floor(&Integer::from(k)).0;
        let is_halved = Integer::from(k) << bits >= &reach << 1;
        if powers.len() >= terms && size <= Integer::from(2) && is_halved {
            break;
        }
        let next = product(n, &powers[powers.len() - 1], step);
        powers.push(next.iter().map(|b| b.divided_by(k)).collect());
    }
    // Each of them is at most half the one before.
    (powers, size << 1)
}

/// An upper bound of the greatest row sum of absolute values, in units.
fn norm_units(n: usize, m: &[Ball]) -> Integer {
    let row = |i: usize| (0..n).fold(Integer::ZERO, |sum, j| sum + m[i * n + j].magnitude_units());
    (0..n).map(row).max().unwrap_or(Integer::ZERO)
}

/// Bits of [`exponential_along`] beside those of the result.
const GUARD_BITS: u64 = 64;

/// The step along the line times the matrix has a norm of at most so many bits.
const MOST_REACH_BITS: u64 = 4;

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
    use super::super::{MultiTaylorModel, Series, TaylorModel};
    use super::*;
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

    /// The value of a model in two variables where the second one is `at/4`.
    fn value(model: &MultiTaylorModel, at: i64) -> Ball {
        let term = |(e, c): (&[u32], &Integer)| match e[0] {
            0 => ball(at, 4).power(u64::from(e[1])).mul(&Ball::from_units(c.clone(), c.clone(), BITS)),
            _ => Ball::zero(BITS),
        };
        let sum = model.terms().map(term).fold(Ball::zero(BITS), |sum, t| sum.add(&t));
        sum.widened(model.rest_units())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if std::env::var_os("JURIST_THOROUGH").is_some() { 24 } else { 6 }))]

        /// `exp(R u)`, `u = c + b y`, holds the exponentials at numbers, also where `u` is wide or wrong by something, and is that of a matrix of functions.
        #[test]
        #[ignore = "long: CI runs it"]
        fn an_exponential_along_a_line_is_that_of_its_matrices(r in prop::collection::vec(-40i64..40, 9), c in -3i64..20, b in -6i64..7, far in any::<bool>()) {
            let rate = |k: usize| Rational::new((r[k] * if far && k / 3 == 2 && k % 3 < 2 { 500 } else { 1 }).into(), 8.into());
            let rates: Vec<Rational> = (0..9).map(rate).collect();
            let at_number = |u: &Ball| exponential(&BallMatrix::from_fn(3, |i, j| Ball::from_rational(&rates[3 * i + j], BITS).mul(u)));
            let (first, slope) = (ball(c, 8), ball(b, 64));
            let line = TaylorModel::linear(&first, &slope, 4);
            if exponential_along(3, &rates, &line).is_none() {
                // So many powers count that functions are quicker.
                prop_assert!(far);
                return Ok(());
            }
            let generic = |u: &Series| {
                let entries = rates.iter().map(|r| u.mul(&u.constant(&Ball::from_rational(r, BITS)))).collect::<Vec<_>>();
                exponential_of(3, &entries).unwrap()
            };
            for terms in [1, 2, 5, 60] {
                let u = Series::linear(&first, &slope, terms);
                for (own, other) in exponential_along(3, &rates, &u).unwrap().iter().zip(generic(&u)) {
                    prop_assert!(own.coefficients().iter().zip(other.coefficients()).all(|(x, y)| x.intersection(y).is_some()));
                    prop_assert!(far || own.coefficients().iter().all(|x| x.width_units().bit_length() < 60));
                }
            }
            let wide = Series::constant(&first.union(&first.add(&ball(1, 9))), 2);
            let model = &MultiTaylorModel::linear(&[(ball(0, 1), ball(1, 1)), (first.clone(), slope.clone())], 3)[1];
            let off = ball(1, 1 << 20);
            let wrong = model.add(&model.constant(&off.union(&off.neg())));
            let [of_wide, of_model, of_wrong, of_line] = [
                exponential_along(3, &rates, &wide).unwrap().iter().map(|s| s.range()).collect::<Vec<_>>(),
                exponential_along(3, &rates, model).unwrap().iter().map(|m| value(m, 3)).collect(),
                exponential_along(3, &rates, &wrong).unwrap().iter().map(|m| value(m, 3)).collect(),
                exponential_along(3, &rates, &line).unwrap().iter().map(|m| m.range()).collect(),
            ];
            let three_quarters = first.add(&slope.mul(&ball(3, 4)));
            for (found, u) in [
                (&of_wide, first.clone()),
                (&of_wide, first.add(&ball(1, 9))),
                (&of_model, three_quarters.clone()),
                (&of_wrong, three_quarters.add(&off)),
                (&of_wrong, three_quarters.sub(&off)),
                (&of_line, first.sub(&slope)),
                (&of_line, three_quarters.clone()),
            ] {
                let exact = at_number(&u);
                prop_assert!((0..9).all(|k| found[k].intersection(exact.at(k / 3, k % 3)).is_some()));
            }
            // The middle of what is wrong by nothing is not wide.
            let narrow = |x: &Ball| x.width_units() << 12 <= (x.magnitude_units() + (Integer::ONE << BITS));
            prop_assert!(b != 0 || of_model.iter().all(narrow));
        }
    }

    #[test]
    fn what_is_no_line_has_no_exponential_along_it() {
        let x = &MultiTaylorModel::linear(&[(ball(1, 1), ball(1, 2)), (ball(0, 1), ball(1, 2))], 3);
        let rates = [Rational::ONE];
        assert!(exponential_along(1, &rates, &x[0].mul(&x[0])).is_none());
        assert!(exponential_along(1, &rates, &x[0].add(&x[1])).is_none());
        assert!(exponential_along(1, &rates, &x[0]).is_some());
        // Too far, and too large.
        assert!(exponential_along(1, &[Rational::from(100)], &x[0]).is_none());
        let large = Series::constant(&ball(1 << 14, 1), 1);
        assert!(exponential_along(1, &rates, &large).is_none());
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
