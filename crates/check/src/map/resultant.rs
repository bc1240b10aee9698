//! Resultants with respect to `y` of polynomials in two parameters, by their values at integers.

use crate::clock::Clock;
use crate::number::Z;
use crate::univariate::Uni;
use num_traits::{One, Zero};

/// Resultants of a higher degree are refused.
const MAX_DEGREE: i64 = 20_000;

/// The resultant of two polynomials in `y`, coefficients from the constant term up, which are polynomials in `x`. Neither is
/// constant in `y`.
///
/// It is known by its values at more integers than its degree. At one where no leading coefficient vanishes the value is the
/// resultant of two polynomials over the integers, by subresultants \[BrownTraub1971\].
pub(super) fn resultant(f: &[Uni], g: &[Uni], clock: &Clock) -> Result<Uni, String> {
    let degree = degree_bound(f, g);
    if degree > MAX_DEGREE {
        return Err("a resultant has too high a degree".into());
    }
    let (mut nodes, mut values) = (Vec::new(), Vec::new());
    let mut next = Z::zero();
    while (values.len() as i64) <= degree {
        let at = |p: &[Uni]| p.iter().map(|c| value(c, &next, clock)).collect::<Result<Vec<Z>, _>>();
        let (a, b) = (at(f)?, at(g)?);
        if ![&a, &b].iter().any(|p| p.last().is_none_or(Zero::is_zero)) {
            values.push(of_numbers(a, b, clock)?);
            nodes.push(next.clone());
        }
        // 0, 1, -1, 2, -2, ...
        next = if next > Z::zero() { -next } else { Z::one() - next };
    }
    interpolated(&nodes, values, clock)
}

/// No less than the degree in `x`. With `l` as the weight of `y`, the coefficient of `y^k` has at most the degree `w - l k`, and a product of
/// entries of the Sylvester matrix, one in each row and column, at most `n w_f + m w_g - l m n`.
fn degree_bound(f: &[Uni], g: &[Uni]) -> i64 {
    let (m, n) = (f.len() as i64 - 1, g.len() as i64 - 1);
    let parts = |p: &[Uni]| -> Vec<(i64, i64)> {
        let there = p.iter().zip(0..).filter(|(c, _)| !c.is_zero());
        there.map(|(c, k)| (c.degree() as i64, k)).collect()
    };
    let (f, g) = (parts(f), parts(g));
    let steepest = f.iter().chain(&g).map(|(d, _)| *d).max().unwrap_or(0);
    let weight = |p: &[(i64, i64)], l: i64| p.iter().map(|(d, k)| d + l * k).max().unwrap_or(0);
    let bounds = (-steepest..=steepest).map(|l| n * weight(&f, l) + m * weight(&g, l) - l * m * n);
    bounds.min().unwrap_or(0)
}

fn value(p: &Uni, x: &Z, clock: &Clock) -> Result<Z, String> {
    clock.spend(p.0.len(), p.0.last().map_or(0, Z::bits), x.bits())?;
    Ok(p.0.iter().rev().fold(Z::zero(), |sum, c| sum * x + c))
}

/// The resultant of two polynomials over the integers whose leading coefficients are not zero.
fn of_numbers(mut a: Vec<Z>, mut b: Vec<Z>, clock: &Clock) -> Result<Z, String> {
    let both_odd = |a: &[Z], b: &[Z]| a.len().is_multiple_of(2) && b.len().is_multiple_of(2);
    let mut negative = false;
    if a.len() < b.len() {
        negative = both_odd(&a, &b);
        std::mem::swap(&mut a, &mut b);
    }
    let (mut g, mut h) = (Z::one(), Z::one());
    while b.len() > 1 {
        let excess = (a.len() - b.len()) as u32;
        negative ^= both_odd(&a, &b);
        let rest = pseudo_remainder(a, &b, clock)?;
        let divisor = &g * h.pow(excess);
        a = std::mem::replace(&mut b, rest.into_iter().map(|c| c / &divisor).collect());
        if b.is_empty() {
            return Ok(Z::zero());
        }
        g = a[a.len() - 1].clone();
        h = power_over(&g, &h, excess);
    }
    let result = power_over(&b[0], &h, a.len() as u32 - 1);
    Ok(if negative { -result } else { result })
}

/// `g^k h^(1 - k)`, which is an integer.
fn power_over(g: &Z, h: &Z, k: u32) -> Z {
    if k == 0 { h.clone() } else { g.pow(k) / h.pow(k - 1) }
}

/// The remainder of the leading coefficient of `b`, to the power of the difference of the degrees and one, times `a`; without zeros at the
/// top.
fn pseudo_remainder(mut a: Vec<Z>, b: &[Z], clock: &Clock) -> Result<Vec<Z>, String> {
    let (lead, below) = b.split_last().ok_or("internal: a division by zero")?;
    while a.len() >= b.len() {
        let Some(top) = a.pop() else { break };
        clock.spend(2 * a.len(), top.bits(), lead.bits())?;
        let shift = a.len() - below.len();
        for (k, c) in a.iter_mut().enumerate() {
            *c *= lead;
            if k >= shift {
                *c -= &top * &below[k - shift];
            }
        }
    }
    while a.last().is_some_and(Zero::is_zero) {
        a.pop();
    }
    Ok(a)
}

/// The polynomial with integer coefficients that has these values, by Newton's divided differences: they are integers.
fn interpolated(nodes: &[Z], mut d: Vec<Z>, clock: &Clock) -> Result<Uni, String> {
    let n = d.len();
    for k in 1..n {
        clock.spend(n - k, d[n - 1].bits(), 64)?;
        for i in (k..n).rev() {
            d[i] = (&d[i] - &d[i - 1]) / (&nodes[i] - &nodes[i - k]);
        }
    }
    let mut out: Vec<Z> = Vec::with_capacity(n);
    for (d, node) in d.into_iter().zip(nodes).rev() {
        // out (x - node) + d
        clock.spend(out.len(), d.bits(), 64)?;
        out.insert(0, Z::zero());
        for k in 1..out.len() {
            let step = &out[k] * node;
            out[k - 1] -= step;
        }
        out[0] += d;
    }
    Ok(Uni::new(out))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn uni(c: &[i64]) -> Uni {
        Uni::new(c.iter().map(|&c| Z::from(c)).collect())
    }

    /// The determinant of the Sylvester matrix, expanded along its first row.
    fn sylvester(f: &[Uni], g: &[Uni]) -> Uni {
        let (m, n) = (f.len() - 1, g.len() - 1);
        let row = |p: &[Uni], shift: usize| -> Vec<Uni> {
            let mut row = vec![Uni::default(); m + n];
            p.iter().rev().enumerate().for_each(|(k, c)| row[shift + k] = c.clone());
            row
        };
        let rows = (0..n).map(|i| row(f, i)).chain((0..m).map(|i| row(g, i))).collect();
        determinant(rows)
    }

    fn determinant(rows: Vec<Vec<Uni>>) -> Uni {
        let Some((first, rest)) = rows.split_first() else { return uni(&[1]) };
        let minor = |j: usize| {
            let without =
                |row: &Vec<Uni>| row.iter().enumerate().filter(|(k, _)| *k != j).map(|(_, c)| c.clone()).collect();
            determinant(rest.iter().map(without).collect())
        };
        first.iter().enumerate().fold(Uni::default(), |sum, (j, c)| {
            let term = if c.is_zero() { Uni::default() } else { c.times(&minor(j)) };
            if j % 2 == 0 { sum.plus(&term) } else { sum.minus(&term) }
        })
    }

    #[test]
    fn it_is_the_determinant_of_the_sylvester_matrix() {
        let clock = Clock::new(Duration::MAX);
        let polynomials = [
            vec![uni(&[1, 2]), uni(&[-3]), uni(&[0, 0, 5])],
            vec![uni(&[0, 1]), uni(&[1])],
            vec![uni(&[-7, 0, 1]), uni(&[]), uni(&[2, -1]), uni(&[0, 3])],
            vec![uni(&[4]), uni(&[]), uni(&[]), uni(&[]), uni(&[-1, 1])],
            vec![uni(&[0, 0, 0, 1]), uni(&[-1, 1])],
            // A remainder that loses more than one degree.
            vec![uni(&[1]), uni(&[2]), uni(&[]), uni(&[]), uni(&[1])],
        ];
        for f in &polynomials {
            for g in &polynomials {
                assert_eq!(resultant(f, g, &clock).unwrap(), sylvester(f, g), "{f:?} {g:?}");
            }
        }
        // A common factor: x y + 1.
        let (f, g) = (vec![uni(&[1]), uni(&[1, 1]), uni(&[0, 1])], vec![uni(&[2]), uni(&[1, 2]), uni(&[0, 1])]);
        assert!(resultant(&f, &g, &clock).unwrap().is_zero());
    }
}
