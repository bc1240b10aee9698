//! Determinants of polynomial matrices by evaluation and interpolation.

use super::clock::Clock;
use super::number::Z;
use super::univariate::Uni;
use num_traits::{One, Zero};

/// A polynomial in variable 0, coefficients from the constant term up, each a polynomial in the parameter.
#[derive(Clone, Debug)]
pub(super) struct Entry(pub Vec<Uni>);

impl Entry {
    fn degree(&self) -> Option<usize> {
        self.0.iter().rposition(|c| !c.is_zero())
    }

    fn parameter_degree(&self) -> Option<usize> {
        self.0.iter().filter(|c| !c.is_zero()).map(Uni::degree).max()
    }
}

/// Determinants that would take more values are refused.
const MAX_VALUES: usize = 1 << 20;

/// The determinant of a square matrix, coefficients of variable 0 from the constant term up.
///
/// Degrees are bounded by the sums over rows, or columns, of the largest degrees; that many values at small
/// integers determine the polynomial.
pub(super) fn determinant(m: &[Vec<Entry>], clock: &Clock) -> Result<Vec<Uni>, String> {
    if let [row] = m
        && let [entry] = row.as_slice()
    {
        return Ok(entry.0[..entry.degree().map_or(0, |d| d + 1)].to_vec());
    }
    let (Some(z_bound), Some(p_bound)) = (bound(m, Entry::degree), bound(m, Entry::parameter_degree)) else {
        return Ok(Vec::new());
    };
    if (z_bound + 1).saturating_mul(p_bound + 1) > MAX_VALUES {
        return Err(clock.refuse("the model is too large for the check"));
    }
    let mut by_power: Vec<Vec<Z>> = vec![Vec::new(); z_bound + 1];
    for p in points(p_bound + 1) {
        let at_p: Vec<Vec<Vec<Z>>> =
            m.iter().map(|row| row.iter().map(|e| e.0.iter().map(|c| value(&c.0, p)).collect()).collect()).collect();
        let terms = at_p.iter().flatten().map(Vec::len).sum();
        let longest_entry = at_p.iter().flatten().map(|c| longest(c)).max().unwrap_or(0);
        let mut values = Vec::with_capacity(z_bound + 1);
        for z in points(z_bound + 1) {
            clock.spend(terms, longest_entry.saturating_add(32 * (z_bound as u64)), 32)?;
            let numbers = at_p.iter().map(|row| row.iter().map(|c| value(c, z)).collect()).collect();
            values.push(bareiss(numbers, clock)?);
            clock.hold(values.len() * (p_bound + 1), values[0].bits())?;
        }
        for (k, c) in interpolated(&values, clock)?.into_iter().enumerate() {
            by_power[k].push(c);
        }
    }
    let uni = |values: &Vec<_>| interpolated(values, clock).map(Uni::new);
    let mut out = by_power.iter().map(uni).collect::<Result<Vec<_>, _>>()?;
    while out.last().is_some_and(Uni::is_zero) {
        out.pop();
    }
    Ok(out)
}

/// The smaller of the row bound and the column bound; `None` when a row or a column is zero.
fn bound(m: &[Vec<Entry>], degree: impl Fn(&Entry) -> Option<usize>) -> Option<usize> {
    let rows: Option<usize> = m.iter().map(|row| row.iter().filter_map(&degree).max()).sum();
    let columns: Option<usize> = (0..m.len()).map(|j| m.iter().filter_map(|row| degree(&row[j])).max()).sum();
    Some(rows?.min(columns?))
}

/// `0, 1, -1, 2, -2, ...`
fn points(n: usize) -> impl Iterator<Item = i64> {
    (0..n as i64).map(|i| if i % 2 == 1 { i / 2 + 1 } else { -i / 2 })
}

fn value(coefficients: &[Z], at: i64) -> Z {
    coefficients.iter().rev().fold(Z::zero(), |sum, c| sum * at + c)
}

/// Fraction-free elimination: every division is exact.
fn bareiss(mut m: Vec<Vec<Z>>, clock: &Clock) -> Result<Z, String> {
    let n = m.len();
    let mut previous = Z::one();
    let mut negative = false;
    for k in 0..n {
        // All are minors of one order: the row in turn tells how long they are.
        let bits = previous.bits().max(longest(&m[k]));
        clock.spend((n - k) * (n - k), bits, bits)?;
        let Some(pivot) = (k..n).find(|&i| !m[i][k].is_zero()) else { return Ok(Z::zero()) };
        if pivot != k {
            m.swap(pivot, k);
            negative = !negative;
        }
        let (top, below) = m.split_at_mut(k + 1);
        let pivot_row = &top[k];
        for row in below {
            for j in k + 1..n {
                let cross = &pivot_row[k] * &row[j] - &row[k] * &pivot_row[j];
                row[j] = cross / &previous;
            }
            row[k] = Z::zero();
        }
        previous = m[k][k].clone();
    }
    Ok(if negative { -previous } else { previous })
}

/// The coefficients of the polynomial with these values at [`points`], by Newton's divided differences. Those of a polynomial with
/// integer coefficients at integers are integers: `x^n` has the complete symmetric polynomials of the points as differences.
fn interpolated(values: &[Z], clock: &Clock) -> Result<Vec<Z>, String> {
    let at: Vec<i64> = points(values.len()).collect();
    let mut differences = values.to_vec();
    for k in 1..differences.len() {
        clock.spend(differences.len() - k, longest(&differences), 32)?;
        for i in (k..differences.len()).rev() {
            let (difference, step) = (&differences[i] - &differences[i - 1], at[i] - at[i - k]);
            let quotient = &difference / step;
            if &quotient * step != difference {
                return Err("internal: a determinant is not integral".into());
            }
            differences[i] = quotient;
        }
    }
    let mut out: Vec<Z> = Vec::with_capacity(values.len());
    for (difference, point) in differences.iter().zip(&at).rev() {
        clock.spend(out.len(), longest(&out), 32)?;
        // out <- out (x - point) + difference
        out.push(Z::zero());
        for i in (0..out.len()).rev() {
            let before = if i > 0 { out[i - 1].clone() } else { difference.clone() };
            out[i] = before - &out[i] * *point;
        }
    }
    Ok(out)
}

fn longest(numbers: &[Z]) -> u64 {
    numbers.iter().map(Z::bits).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn determinant_of_a_known_product() {
        // diag(z - p, z^2 + p^3 + 1) with a row added to the other
        let clock = Clock::new(Duration::MAX);
        let uni = |c: &[i64]| Uni::new(c.iter().map(|&c| Z::from(c)).collect());
        let a = vec![uni(&[0, -1]), uni(&[1])];
        let b = vec![uni(&[1, 0, 0, 1]), uni(&[]), uni(&[1])];
        let m = vec![vec![Entry(a.clone()), Entry(b.clone())], vec![Entry(vec![]), Entry(b.clone())]];
        let d = determinant(&m, &clock).unwrap();
        let expected = [uni(&[0, -1, 0, 0, -1]), uni(&[1, 0, 0, 1]), uni(&[0, -1]), uni(&[1])];
        assert_eq!(d, expected);
        let swapped = vec![m[1].clone(), m[0].clone()];
        let d = determinant(&swapped, &clock).unwrap();
        assert_eq!(d, expected.map(|c| c.scaled(&Z::from(-1))));
        assert!(determinant(&[vec![Entry(vec![])]], &clock).unwrap().is_empty());
        assert_eq!(determinant(&[], &clock).unwrap(), [uni(&[1])]);
    }

    #[test]
    fn interpolation_gives_back_the_coefficients() {
        let clock = Clock::new(Duration::MAX);
        for n in 0..40_i64 {
            let wanted: Vec<Z> =
                (0..n).map(|k| Z::from((k * k * 7919 + 31 * n) % 1009 - 500).pow(1 + k as u32 % 3)).collect();
            let values: Vec<Z> = points(wanted.len()).map(|x| value(&wanted, x)).collect();
            assert_eq!(interpolated(&values, &clock).unwrap(), wanted);
        }
        // z^2/2 + z/2 has integers at integers and is refused.
        let halves: Vec<Z> = points(3).map(|x| Z::from(x * (x + 1) / 2)).collect();
        assert!(interpolated(&halves, &clock).is_err());
    }
}
