//! Fundamental solutions of linear differential equations at times that are series.

use super::{Ball, BallMatrix, Elementary, Enclosed, Series, exponential};
use crate::limits::checkpoint;
use crate::number::Integer;

/// What the Taylor series of an exponential is summed in: a normed algebra of enclosures in fixed point.
pub(super) trait Summed: Enclosed {
    /// One, of the same kind as this value.
    fn one(&self) -> Self;
    /// The quotient by an integer.
    fn divided_by(&self, n: u64) -> Self;
    /// With all that has at most the norm of one unit added.
    fn widened(&self) -> Self;
}

/// The same, with any number of bits.
pub(super) trait Scaled: Summed + Elementary {
    /// A bound of the norm in units, in which a product is at most the product.
    fn norm_units(&self) -> Integer;
    /// Times a power of two, with so many bits.
    fn rescaled(&self, bits: u64, exponent: i64) -> Self;
}

impl Summed for Series {
    fn one(&self) -> Series {
        self.integer(&Integer::ONE)
    }
    fn divided_by(&self, n: u64) -> Series {
        self.map(|c| c.divided_by(n))
    }
    fn widened(&self) -> Series {
        self.map(|c| c.widened(&Integer::ONE))
    }
}

impl Scaled for Series {
    fn norm_units(&self) -> Integer {
        Series::norm_units(self)
    }
    fn rescaled(&self, bits: u64, exponent: i64) -> Series {
        let more = bits >= self.bits();
        self.map(|c| if more { c.with_bits(bits).shifted(exponent) } else { c.shifted(exponent).with_bits(bits) })
    }
}

/// The fundamental solutions of a linear differential equation at a time that is a series: the first row of
/// `exp(companion * time)`, the companion matrix being that of the monic polynomial with these coefficients from the constant
/// term up, the leading one left out.
///
/// Where the coefficients are constants, `row' = row companion time'` gives one coefficient after the other from one
/// exponential of balls: `O(m n^2)` products, `m` the order and `n` the number of terms. Else `O(m n^2)` for each term of the Taylor
/// series and `O(m^3 n^2)` for each time that it is squared.
pub fn fundamental_solutions(coefficients: &[Series], time: &Series) -> Vec<Series> {
    let (n, bits, terms) = (coefficients.len(), time.bits(), time.terms());
    let is_constant = |s: &Series| s.coefficients()[1..].iter().all(Ball::is_zero);
    if !coefficients.iter().all(is_constant) {
        return solutions_by_taylor(coefficients, time);
    }
    let last: Vec<&Ball> = coefficients.iter().map(|c| &c.coefficients()[0]).collect();
    // A wide time as its middle and what is around it: the exponentials of multiples of one matrix commute.
    let t = &time.coefficients()[0];
    let middle = Ball::from_units(t.middle_units(), t.middle_units(), bits);
    let around = t.sub(&middle);
    let constants: Vec<Series> = last.iter().map(|c| Series::constant(c, 1)).collect();
    let at_middle = solutions_by_taylor(&constants, &Series::constant(&middle, 1));
    let mut first: Vec<Ball> = at_middle.iter().map(|s| s.coefficients()[0].clone()).collect();
    if !around.is_zero() {
        let e = exponential(&BallMatrix::from_fn(n, |i, j| {
            if i + 1 == n {
                last[j].mul(&around).neg()
            } else if j == i + 1 {
                around.clone()
            } else {
                Ball::zero(bits)
            }
        }));
        let entry = |j: usize| (0..n).fold(Ball::zero(bits), |sum, i| sum.add(&first[i].mul(e.at(i, j))));
        first = (0..n).map(entry).collect();
    }
    let mut rows: Vec<Vec<Ball>> = vec![first];
    for k in 1..terms {
        checkpoint((n * k) as u64);
        let mut row = vec![Ball::zero(bits); n];
        for j in 1..=k {
            let step = time.coefficients()[j].scaled(&Integer::from(j as u64));
            if step.is_zero() {
                continue;
            }
            let before = &rows[k - j];
            for (column, sum) in row.iter_mut().enumerate() {
                let mut value = before[n - 1].mul(last[column]).neg();
                if column > 0 {
                    value = value.add(&before[column - 1]);
                }
                *sum = sum.add(&value.mul(&step));
            }
        }
        rows.push(row.iter().map(|b| b.divided_by(k as u64)).collect());
    }
    (0..n).map(|j| Series::new(rows.iter().map(|row| row[j].clone()).collect())).collect()
}

/// As [`fundamental_solutions`]: `exp(t s)` modulo the polynomial, whose coefficients are the first row of the exponential of its
/// companion matrix. The unit of time is such that the roots are about 1 at most; scaled and squared as in
/// [`exponential`](super::exponential()), in the norm that sums coefficients, so that the rest of the Taylor series is bounded in every
/// coefficient at once.
pub(super) fn solutions_by_taylor<S: Scaled>(coefficients: &[S], time: &S) -> Vec<S> {
    let bits = time.bits();
    let units = Units::of(coefficients, time);
    let working = bits + units.octaves + 16 + 2 * units.halvings;
    let scaled = |(j, c): (usize, &S)| c.rescaled(working, -(units.of_coefficient(coefficients.len(), j) as i64));
    let polynomial: Vec<S> = coefficients.iter().enumerate().map(scaled).collect();
    let t = time.rescaled(working, units.octaves as i64 - units.halvings as i64);
    let row = row_by_taylor(&polynomial, &t, working, units.halvings);
    row.iter().enumerate().map(|(j, s)| s.rescaled(bits, -((units.octaves * j as u64) as i64))).collect()
}

/// The powers of two that an equation is scaled by.
pub(super) struct Units {
    /// In time by `2^-octaves` the roots are about 1 at most: it is at least each `|c_j|^(1/(n - j))`.
    pub octaves: u64,
    /// A time as short as that over `2^halvings` has an exponential with a quick Taylor series.
    pub halvings: u64,
}

impl Units {
    pub fn of<S: Scaled>(coefficients: &[S], time: &S) -> Units {
        let (n, bits) = (coefficients.len(), time.bits());
        let octaves = |(j, c): (usize, &S)| {
            (c.norm_units().bit_length() as i64 - bits as i64).max(0).unsigned_abs().div_ceil((n - j) as u64)
        };
        let octaves = coefficients.iter().enumerate().map(octaves).max().unwrap_or(0);
        let first_bits = bits + octaves + 16;
        let scaled = |(j, c): (usize, &S)| c.rescaled(first_bits, -((octaves * (n - j) as u64) as i64));
        let whole = time.rescaled(first_bits, octaves as i64);
        let last_row = coefficients
            .iter()
            .enumerate()
            .map(scaled)
            .fold(Integer::ZERO, |sum, c| sum + c.times(&whole).norm_units());
        // 2^halvings >= 4 norm.
        let halvings = (last_row.max(whole.norm_units()).bit_length() + 2).saturating_sub(first_bits);
        Units { octaves, halvings }
    }

    /// The exponent of the power of two that a coefficient is divided by.
    pub fn of_coefficient(&self, order: usize, j: usize) -> u64 {
        self.octaves * (order - j) as u64
    }
}

/// The first row of the exponential of the companion matrix at `2^halvings` times a short time.
pub(super) fn row_by_taylor<S: Summed>(polynomial: &[S], t: &S, working: u64, halvings: u64) -> Vec<S> {
    let n = polynomial.len();
    let steps: Vec<S> = polynomial.iter().map(|c| c.times(t)).collect();
    let mut term = vec![t.nothing(); n];
    term[0] = t.one();
    let mut sum = term.clone();
    // The term of power k is at most 2^-small.
    let (mut k, mut small) = (0u64, 0u64);
    while small < working + 1 {
        k += 1;
        let highest = term[n - 1].clone();
        let next = |j: usize| {
            let carried = highest.times(&steps[j]);
            let next = if j == 0 { t.nothing().minus(&carried) } else { term[j - 1].times(t).minus(&carried) };
            next.divided_by(k)
        };
        term = (0..n).map(next).collect();
        sum = sum.iter().zip(&term).map(|(s, t)| s.plus(t)).collect();
        small += 2 + u64::from(k.ilog2());
    }
    // All rows: each is the one before times the companion matrix, which cancels nothing at so short a time.
    let mut rows = vec![sum.iter().map(S::widened).collect::<Vec<S>>()];
    for i in 1..if halvings > 0 { n } else { 1 } {
        let before = &rows[i - 1];
        let next = |j: usize| {
            let carried = before[n - 1].times(&polynomial[j]);
            if j == 0 { t.nothing().minus(&carried) } else { before[j - 1].minus(&carried) }
        };
        rows.push((0..n).map(next).collect());
    }
    for left in (0..halvings).rev() {
        let entry = |i: usize, j: usize| {
            let products = (0..n).map(|k| rows[i][k].times(&rows[k][j]));
            products.reduce(|s, t| s.plus(&t)).expect("an equation of some order")
        };
        // Of the last square, the first row is all that is needed.
        rows = (0..if left > 0 { n } else { 1 }).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    }
    rows.swap_remove(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{Rational, parse_number};

    fn at(text: &str, radius: &str, terms: usize) -> Series {
        let ball = |t: &str| Ball::from_rational(&parse_number(t).unwrap(), 128);
        Series::linear(&ball(text), &ball(radius), terms)
    }

    #[test]
    fn exponentials_of_matrices_of_series_are_cosine_and_sine() {
        // exp([[0, v], [-v, 0]]) with v = 2 + x/2: cos(2), -sin(2)/2, -cos(2)/8, ...
        let v = at("2", "1/2", 6);
        let zero = at("0", "0", 6);
        let e = exponential_of_series(2, &[zero.clone(), v.clone(), v.neg(), zero]);
        let (cos, sin) = super::super::cos_sin(&v.coefficients()[0]);
        let expected = [cos.clone(), sin.neg().shifted(-1), cos.neg().shifted(-3)];
        for (found, expected) in e[0].coefficients().iter().zip(expected) {
            assert!(found.union(&expected).width_units().bit_length() < 20, "{found:?} {expected:?}");
        }
        // cos^2 + sin^2 = 1 in every coefficient.
        let one = e[0].mul(&e[0]).add(&e[1].mul(&e[1]));
        assert!(one.coefficients()[0].contains(&Rational::ONE));
        assert!(one.coefficients()[1..].iter().all(|c| c.contains_zero() && c.width_units().bit_length() < 24));
    }

    #[test]
    fn solutions_by_recurrence_are_those_by_the_exponential_of_series() {
        let time = at("7/5", "1/2", 7).power(2);
        let constant = |t: &str| at(t, "0", 7);
        let coefficients = [constant("2/3"), constant("-1/4"), constant("3")];
        let by_recurrence = fundamental_solutions(&coefficients, &time);
        let zero = constant("0");
        let last: Vec<Series> = coefficients.iter().map(|c| c.mul(&time).neg()).collect();
        let entries = [
            [zero.clone(), time.clone(), zero.clone()].to_vec(),
            [zero.clone(), zero.clone(), time.clone()].to_vec(),
            last,
        ];
        let by_series = exponential_of_series(3, &entries.concat());
        for (a, b) in by_recurrence.iter().zip(&by_series) {
            for (x, y) in a.coefficients().iter().zip(b.coefficients()) {
                assert!(x.intersection(y).is_some() && x.union(y).width_units().bit_length() < 40, "{x:?} {y:?}");
            }
        }
    }

    #[test]
    fn solutions_with_moving_coefficients_are_those_by_the_exponential_of_series() {
        // Slow, fast and stiff: roots about 1, 1000, and 1 and 4000.
        for list in [["2/3", "-1/4", "3"], ["1000000000", "2000000", "3000"], ["5000", "4001", "4001"]] {
            let time = at("1/100", "0", 7);
            let coefficients = list.map(|c| at(c, "1/16", 7));
            let zero = at("0", "0", 7);
            let last: Vec<Series> = coefficients.iter().map(|c| c.mul(&time).neg()).collect();
            let entries =
                [vec![zero.clone(), time.clone(), zero.clone()], vec![zero.clone(), zero, time.clone()], last];
            let by_series = exponential_of_series(3, &entries.concat());
            for (a, b) in fundamental_solutions(&coefficients, &time).iter().zip(&by_series) {
                for (x, y) in a.coefficients().iter().zip(b.coefficients()) {
                    assert!(x.intersection(y).is_some() && x.width_units().bit_length() < 48, "{list:?} {x:?} {y:?}");
                }
            }
        }
    }

    /// The exponential of a square matrix of series, row by row: as [`exponential`](super::super::exponential), in the norm that sums
    /// the coefficients, so that the rest of the Taylor series is bounded in every coefficient at once.
    ///
    /// Cost: `O(m^3 n^2)` products of balls for each term and each squaring, `m` the size and `n` the number of terms.
    ///
    /// # Panics
    /// Unless there are `size^2` entries.
    fn exponential_of_series(size: usize, entries: &[Series]) -> Vec<Series> {
        assert_eq!(entries.len(), size * size, "a square matrix");
        let Some(first) = entries.first() else { return Vec::new() };
        let (bits, terms) = (first.bits(), first.terms());
        let row = |i: usize| (0..size).fold(Integer::ZERO, |sum, j| sum + entries[i * size + j].norm_units());
        let norm = (0..size).map(row).max().unwrap_or(Integer::ZERO);
        // 2^halvings >= 4 norm.
        let halvings = (norm.bit_length() + 2).saturating_sub(bits);
        let working = bits + 2 * halvings + 16;
        let x: Vec<Series> =
            entries.iter().map(|s| s.map(|c| c.with_bits(working).shifted(-(halvings as i64)))).collect();
        let one = Series::constant(&Ball::from_integer(&Integer::ONE, working), terms);
        let product = |a: &[Series], b: &[Series]| -> Vec<Series> {
            let entry = |i: usize, j: usize| {
                let products = (0..size).map(|k| a[i * size + k].mul(&b[k * size + j]));
                products.reduce(|s, t| s.add(&t)).expect("the size is positive")
            };
            (0..size * size).map(|k| entry(k / size, k % size)).collect()
        };
        let mut sum: Vec<Series> =
            x.iter().enumerate().map(|(k, s)| if k / size == k % size { s.add(&one) } else { s.clone() }).collect();
        let mut term = x.clone();
        // The term of power k is at most 2^-small.
        let (mut k, mut small) = (1u64, 2u64);
        while small < working + 1 {
            k += 1;
            term = product(&term, &x).iter().map(|s| s.map(|c| c.divided_by(k))).collect();
            sum = sum.iter().zip(&term).map(|(s, t)| s.add(t)).collect();
            small += 2 + u64::from(k.ilog2());
        }
        let mut out: Vec<Series> = sum.iter().map(|s| s.map(|c| c.widened(&Integer::ONE))).collect();
        for _ in 0..halvings {
            out = product(&out, &out);
        }
        out.iter().map(|s| s.map(|c| c.with_bits(bits))).collect()
    }
}
