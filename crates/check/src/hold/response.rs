//! `exp(A t)` and its integrals over the symbols of a certificate.
//!
//! `exp(M t) = sum_b b(t) Z_b`, where the `b` are a basis of the solutions of a linear differential equation whose polynomial
//! annihilates `M`: both sides solve it, and have the same derivatives at 0 if `sum_b b^(l)(0) Z_b = M^l` below its order
//! [Leonard1996]. With `M = [[A, I, 0], [0, 0, I/T], [0, 0, 0]]` the first row holds `exp(A t)` and its integrals, and `s^2` times
//! the characteristic polynomial of `A` annihilates it.

#![expect(clippy::needless_range_loop, reason = "matrix indices, as in the formulas")]

use super::{Entries, Hold, Numbers};
use crate::blocks::Values;
use crate::clock::Clock;
use crate::multivariate::{Fraction, Multi};
use crate::number::{Q, power};
use crate::univariate::common_denominator;
use num_traits::{One, Zero};

/// A product of rational numbers and a sum are so many operations: their common divisors are looked for.
const RATIONAL: usize = 20;

/// `exp(A t)`, its integral, and the integral's integral over `T`, all over one denominator.
pub(super) struct Response {
    pub parts: [Entries; 3],
    pub over: Multi,
}

/// A solution `t^power phi_index` for a factor.
struct Solution<'m> {
    monic: &'m [Q],
    power: usize,
    index: usize,
}

/// The characteristic polynomial, monic and without the leading coefficient, by Faddeev and LeVerrier; and the powers of the matrix
/// up to its size.
fn characteristic(a: &Numbers, clock: &Clock) -> Result<(Vec<Q>, Vec<Numbers>), String> {
    let n = a.len();
    let unit = |c: &Q| -> Numbers {
        (0..n).map(|i| (0..n).map(|j| if i == j { c.clone() } else { Q::zero() }).collect()).collect()
    };
    let mut powers = vec![unit(&Q::one())];
    let mut out = vec![Q::zero(); n];
    let mut m = unit(&Q::one());
    for k in 1..=n {
        let am = numbers_product(a, &m, clock)?;
        let trace = (0..n).fold(Q::zero(), |sum, i| sum + &am[i][i]);
        let c = -trace / Q::from(num_bigint::BigInt::from(k));
        out[n - k] = c.clone();
        m = am.iter().zip(unit(&c)).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x + y).collect()).collect();
        let last = &powers[k - 1];
        let next = numbers_product(a, last, clock)?;
        powers.push(next);
    }
    Ok((out, powers))
}

fn numbers_product(a: &Numbers, b: &Numbers, clock: &Clock) -> Result<Numbers, String> {
    let n = a.len();
    let mut out = vec![vec![Q::zero(); n]; n];
    for i in 0..n {
        for j in 0..n {
            for k in (0..n).filter(|&k| !a[i][k].is_zero() && !b[k][j].is_zero()) {
                clock.spend(RATIONAL, a[i][k].numer().bits() + a[i][k].denom().bits(), b[k][j].numer().bits())?;
                out[i][j] += &a[i][k] * &b[k][j];
            }
        }
    }
    Ok(out)
}

/// After a time; by what is divided is noted.
pub(super) fn response(
    a: &Numbers,
    hold: &Hold,
    span: &Q,
    values: &Values<'_>,
    divisors: &mut Vec<Multi>,
    clock: &Clock,
) -> Result<Response, String> {
    let n = a.len();
    let (monic, mut powers) = characteristic(a, clock)?;
    let zeros = if hold.is_first_order { 2 } else { 1 };
    let mut factors = values.table.factored(&monic)?;
    match factors.first_mut() {
        Some((monic, multiplicity)) if *monic == [Q::zero()] => *multiplicity += zeros,
        _ => factors.insert(0, (vec![Q::zero()], zeros)),
    }
    let mut solutions = Vec::new();
    for (monic, multiplicity) in &factors {
        for power in 0..*multiplicity {
            solutions.extend((0..monic.len()).map(|index| Solution { monic, power, index }));
        }
    }
    let order = solutions.len();
    let derivatives: Vec<Vec<Q>> = solutions.iter().map(|s| s.derivatives(order)).collect();
    let weights = inverse((0..order).map(|l| derivatives.iter().map(|d| d[l].clone()).collect()).collect(), clock)?;
    while powers.len() < order {
        let next = numbers_product(a, &powers[powers.len() - 1], clock)?;
        powers.push(next);
    }
    // The basis over one denominator.
    let basis = solutions.iter().map(|s| s.value(span, values, divisors, clock)).collect::<Result<Vec<_>, _>>()?;
    let over = Multi::common_multiple(basis.iter().map(|b| &b.scalar), clock)?;
    let top = |b: &Fraction| b.numerator.times(&over.quotient(&b.scalar, clock)?, clock);
    let tops = basis.iter().map(top).collect::<Result<Vec<_>, _>>()?;
    let z = first_rows(&weights, &powers, &hold.time, clock)?;
    let common = common_denominator(z.iter().flatten().flatten().flatten());
    let mut parts: [Entries; 3] = std::array::from_fn(|_| vec![vec![Multi::default(); n]; n]);
    for (j, entries) in parts.iter_mut().enumerate() {
        for r in 0..n {
            for c in 0..n {
                for b in (0..order).filter(|&b| !z[b][j][r][c].is_zero()) {
                    let q = &z[b][j][r][c];
                    entries[r][c] = entries[r][c].plus(&tops[b].scaled(&(q.numer() * (&common / q.denom()))));
                }
            }
        }
    }
    Ok(Response { parts, over: over.scaled(&common) })
}

/// `Z_b = sum_l weights[b][l] M^l`, whose first row is `A^l, A^(l-1), A^(l-2)/T`.
fn first_rows(weights: &Numbers, powers: &[Numbers], time: &Q, clock: &Clock) -> Result<Vec<[Numbers; 3]>, String> {
    let (n, order) = (powers[0].len(), weights.len());
    let part = |b: usize, j: usize, r: usize, c: usize| {
        let scale = if j == 2 { time.recip() } else { Q::one() };
        (j..order).fold(Q::zero(), |sum, l| sum + &weights[b][l] * &powers[l - j][r][c]) * scale
    };
    let mut z: Vec<[Numbers; 3]> = vec![std::array::from_fn(|_| vec![vec![Q::zero(); n]; n]); order];
    for b in 0..order {
        for j in 0..3 {
            for r in 0..n {
                for c in 0..n {
                    clock.spend(RATIONAL, 1, 1)?;
                    z[b][j][r][c] = part(b, j, r, c);
                }
            }
        }
    }
    Ok(z)
}

impl Solution<'_> {
    /// The derivatives at 0, from the function itself up: `(t^j phi)^(l) = l!/(l - j)! phi^(l - j)` there.
    fn derivatives(&self, count: usize) -> Vec<Q> {
        let d = self.monic.len();
        let mut phi: Vec<Q> = Vec::with_capacity(count);
        for l in 0..count {
            let value = match l.checked_sub(d) {
                None if l == self.index => Q::one(),
                None => Q::zero(),
                Some(rest) => (0..d).fold(Q::zero(), |sum, k| sum - &self.monic[k] * &phi[rest + k]),
            };
            phi.push(value);
        }
        let falling =
            |l: usize| (l - self.power + 1..=l).fold(Q::one(), |f, k| f * Q::from(num_bigint::BigInt::from(k)));
        (0..count).map(|l| if l < self.power { Q::zero() } else { &phi[l - self.power] * falling(l) }).collect()
    }

    /// The value over the symbols. A pair of conjugate rates is written by the tangent of half the angle: with `w = c - b^2/4` and
    /// `X = exp(-b t/2)` the solutions are `X 2x/(1 + w x^2)` and `X (1 - w x^2)/(1 + w x^2)` with `b/2` times the former.
    fn value(&self, t: &Q, values: &Values<'_>, divisors: &mut Vec<Multi>, clock: &Clock) -> Result<Fraction, String> {
        let half = Q::new(1.into(), 2.into());
        let Values { table, first, .. } = *values;
        let base = match self.monic {
            [rate] if rate.is_zero() => Fraction::number(&Q::one()),
            [rate] => table.exponential(&-(rate * t), first, clock)?,
            [c, b] if *c != b * b * &half * &half => {
                let w = c - b * b * &half * &half;
                let decay = table.exponential(&-(b * t * &half), first, clock)?;
                let (x, divided) = table.tangent(&w, &(t * &half), first, clock)?;
                divisors.extend(divided);
                let square = x.times(&x, clock)?.times(&Fraction::number(&w), clock)?;
                let one = Fraction::number(&Q::one());
                let below = one.plus(&square, clock)?;
                divisors.push(below.numerator.clone());
                let over = below.inverse(clock)?.times(&decay, clock)?;
                let sine = x.plus(&x, clock)?.times(&over, clock)?;
                if self.index == 1 {
                    sine
                } else {
                    let cosine = one.plus(&square.negated(), clock)?.times(&over, clock)?;
                    cosine.plus(&sine.times(&Fraction::number(&(b * &half)), clock)?, clock)?
                }
            }
            monic => table.solution(monic, t, self.index, first)?,
        };
        base.times(&Fraction::number(&power(t, self.power as u32)), clock)
    }
}

/// The inverse of a matrix of numbers.
fn inverse(mut m: Numbers, clock: &Clock) -> Result<Numbers, String> {
    let n = m.len();
    for (i, row) in m.iter_mut().enumerate() {
        row.extend((0..n).map(|j| if i == j { Q::one() } else { Q::zero() }));
    }
    for k in 0..n {
        let pivot = (k..n).find(|&i| !m[i][k].is_zero()).ok_or("the modes of a held block are not coprime")?;
        m.swap(k, pivot);
        let scale = m[k][k].recip();
        m[k].iter_mut().for_each(|x| *x *= &scale);
        for i in (0..n).filter(|&i| i != k) {
            let factor = m[i][k].clone();
            if factor.is_zero() {
                continue;
            }
            for j in k..2 * n {
                clock.spend(RATIONAL, 1, 1)?;
                let step = &factor * &m[k][j];
                m[i][j] -= step;
            }
        }
    }
    Ok(m.into_iter().map(|row| row[n..].to_vec()).collect())
}
