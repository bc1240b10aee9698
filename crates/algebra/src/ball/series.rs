//! Truncated power series whose coefficients are balls: values of functions near a point, or, with balls as wide as an
//! interval, bounds of their derivatives on it.

use super::{Ball, BallMatrix, exp, exponential};
use crate::limits::checkpoint;
use crate::number::Integer;

/// `c_0 + c_1 x + ... + c_(n-1) x^(n-1)`, everything from `x^n` on left out.
///
/// ```
/// use jurist_algebra::ball::{Ball, Series};
/// use jurist_algebra::number::Rational;
/// // exp(1 + x) to three terms: e, e, e/2
/// let point = Series::linear(&Ball::from_integer(&1.into(), 64), &Ball::from_integer(&1.into(), 64), 3);
/// let e = point.exp();
/// let twice = e.coefficients()[2].scaled(&2.into());
/// assert!(twice.intersection(&e.coefficients()[0]).is_some());
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Series {
    coefficients: Vec<Ball>,
}

impl Series {
    /// From all coefficients, at least one.
    ///
    /// # Panics
    /// When there is none.
    pub fn new(coefficients: Vec<Ball>) -> Series {
        assert!(!coefficients.is_empty(), "a series has a constant term");
        Series { coefficients }
    }

    /// A constant with so many terms.
    pub fn constant(c: &Ball, terms: usize) -> Series {
        let mut coefficients = vec![Ball::zero(c.bits()); terms];
        coefficients[0] = c.clone();
        Series { coefficients }
    }

    /// `c + r x` with so many terms.
    pub fn linear(c: &Ball, r: &Ball, terms: usize) -> Series {
        let mut out = Series::constant(c, terms);
        if terms > 1 {
            out.coefficients[1] = r.clone();
        }
        out
    }

    /// The coefficients from the constant term up.
    pub fn coefficients(&self) -> &[Ball] {
        &self.coefficients
    }

    /// The number of terms.
    pub fn terms(&self) -> usize {
        self.coefficients.len()
    }

    fn bits(&self) -> u64 {
        self.coefficients[0].bits()
    }

    fn map(&self, f: impl Fn(&Ball) -> Ball) -> Series {
        Series { coefficients: self.coefficients.iter().map(f).collect() }
    }

    fn with(&self, other: &Series, f: impl Fn(&Ball, &Ball) -> Ball) -> Series {
        Series { coefficients: self.coefficients.iter().zip(&other.coefficients).map(|(a, b)| f(a, b)).collect() }
    }

    /// The sum.
    pub fn add(&self, other: &Series) -> Series {
        self.with(other, Ball::add)
    }

    /// The difference.
    pub fn sub(&self, other: &Series) -> Series {
        self.with(other, Ball::sub)
    }

    /// The negative.
    pub fn neg(&self) -> Series {
        self.map(Ball::neg)
    }

    /// The product with an integer.
    pub fn scaled(&self, n: &Integer) -> Series {
        self.map(|c| c.scaled(n))
    }

    /// The product: `n^2 / 2` products of balls.
    pub fn mul(&self, other: &Series) -> Series {
        let n = self.terms();
        checkpoint(n as u64);
        let coefficient = |k: usize| {
            Ball::sum_of_products((0..=k).map(|j| (&self.coefficients[j], &other.coefficients[k - j])), self.bits())
        };
        Series { coefficients: (0..n).map(coefficient).collect() }
    }

    /// The quotient; `None` where the divisor's constant term may be zero.
    pub fn div(&self, other: &Series) -> Option<Series> {
        let mut out: Vec<Ball> = Vec::with_capacity(self.terms());
        for k in 0..self.terms() {
            let mut rest = self.coefficients[k].clone();
            for (j, q) in out.iter().enumerate() {
                rest = rest.sub(&q.mul(&other.coefficients[k - j]));
            }
            out.push(rest.div(&other.coefficients[0])?);
        }
        Some(Series { coefficients: out })
    }

    /// The square root; `None` where the constant term may not be positive.
    pub fn sqrt(&self) -> Option<Series> {
        let first = self.coefficients[0].sqrt().filter(|r| r.sign().is_some_and(|s| s.is_gt()))?;
        let divisor = first.add(&first);
        let mut out = vec![first];
        for k in 1..self.terms() {
            let mut rest = self.coefficients[k].clone();
            for j in 1..k {
                rest = rest.sub(&out[j].mul(&out[k - j]));
            }
            out.push(rest.div(&divisor)?);
        }
        Some(Series { coefficients: out })
    }

    /// The exponential: with `y' = x' y`, one coefficient after the other.
    pub fn exp(&self) -> Series {
        let mut out = vec![exp(&self.coefficients[0])];
        for k in 1..self.terms() {
            let mut sum = Ball::zero(self.bits());
            for j in 1..=k {
                sum = sum.add(&self.coefficients[j].scaled(&Integer::from(j as u64)).mul(&out[k - j]));
            }
            out.push(sum.divided_by(k as u64));
        }
        Series { coefficients: out }
    }

    /// The power with a natural exponent.
    pub fn power(&self, exponent: u64) -> Series {
        let one = Ball::from_integer(&Integer::ONE, self.bits());
        let mut out = Series::constant(&one, self.terms());
        let (mut base, mut rest) = (self.clone(), exponent);
        while rest > 0 {
            if rest % 2 == 1 {
                out = out.mul(&base);
            }
            rest /= 2;
            if rest > 0 {
                base = base.mul(&base);
            }
        }
        out
    }

    /// The sum of the greatest absolute values of the coefficients: a norm in which a product is at most the product.
    fn norm_units(&self) -> Integer {
        self.coefficients.iter().fold(Integer::ZERO, |sum, c| sum + c.magnitude_units())
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
    let is_constant = |s: &Series| s.coefficients[1..].iter().all(Ball::is_zero);
    if !coefficients.iter().all(is_constant) {
        return solutions_by_taylor(coefficients, time);
    }
    let last: Vec<&Ball> = coefficients.iter().map(|c| &c.coefficients[0]).collect();
    let at = |t: &Ball| {
        exponential(&BallMatrix::from_fn(n, |i, j| {
            if i + 1 == n {
                last[j].mul(t).neg()
            } else if j == i + 1 {
                t.clone()
            } else {
                Ball::zero(bits)
            }
        }))
    };
    // A wide time as its middle and what is around it: the exponentials of multiples of one matrix commute.
    let t = &time.coefficients[0];
    let middle = Ball::from_units(t.middle_units(), t.middle_units(), bits);
    let around = t.sub(&middle);
    let e = if around.is_zero() { at(&middle) } else { at(&middle).mul(&at(&around)) };
    let mut rows: Vec<Vec<Ball>> = vec![(0..n).map(|j| e.at(0, j).clone()).collect()];
    for k in 1..terms {
        checkpoint((n * k) as u64);
        let mut row = vec![Ball::zero(bits); n];
        for j in 1..=k {
            let step = time.coefficients[j].scaled(&Integer::from(j as u64));
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
    (0..n).map(|j| Series { coefficients: rows.iter().map(|row| row[j].clone()).collect() }).collect()
}

/// As [`fundamental_solutions`]: `exp(t s)` modulo the polynomial, whose coefficients are the first row of the exponential of its
/// companion matrix. The unit of time is such that the roots are about 1 at most; scaled and squared as in
/// [`exponential`](super::exponential()), in the norm that sums coefficients, so that the rest of the Taylor series is bounded in every
/// coefficient at once.
fn solutions_by_taylor(coefficients: &[Series], time: &Series) -> Vec<Series> {
    let (n, bits, terms) = (coefficients.len(), time.bits(), time.terms());
    // 2^octaves is at least each |c_j|^(1/(n - j)).
    let octaves = |(j, c): (usize, &Series)| {
        (c.norm_units().bit_length() as i64 - bits as i64).max(0).unsigned_abs().div_ceil((n - j) as u64)
    };
    let octaves = coefficients.iter().enumerate().map(octaves).max().unwrap_or(0);
    let first_bits = bits + octaves + 16;
    let at = |s: &Series, bits: u64, exponent: i64| s.map(|c| c.with_bits(bits).shifted(exponent));
    let scaled = |bits: u64| -> Vec<Series> {
        let one = |(j, c): (usize, &Series)| at(c, bits, -((octaves * (n - j) as u64) as i64));
        coefficients.iter().enumerate().map(one).collect()
    };
    let whole = at(time, first_bits, octaves as i64);
    let last_row = scaled(first_bits).iter().fold(Integer::ZERO, |sum, c| sum + c.mul(&whole).norm_units());
    // 2^halvings >= 4 norm.
    let halvings = (last_row.max(whole.norm_units()).bit_length() + 2).saturating_sub(first_bits);
    let working = first_bits + 2 * halvings;
    let polynomial = scaled(working);
    let t = at(time, working, octaves as i64 - halvings as i64);
    let steps: Vec<Series> = polynomial.iter().map(|c| c.mul(&t)).collect();
    let mut term = vec![Series::constant(&Ball::zero(working), terms); n];
    term[0] = Series::constant(&Ball::from_integer(&Integer::ONE, working), terms);
    let mut sum = term.clone();
    // The term of power k is at most 2^-small.
    let (mut k, mut small) = (0u64, 0u64);
    while small < working + 1 {
        k += 1;
        let highest = term[n - 1].clone();
        let next = |j: usize| {
            let carried = highest.mul(&steps[j]);
            let next = if j == 0 { carried.neg() } else { term[j - 1].mul(&t).sub(&carried) };
            next.map(|c| c.divided_by(k))
        };
        term = (0..n).map(next).collect();
        sum = sum.iter().zip(&term).map(|(s, t)| s.add(t)).collect();
        small += 2 + u64::from(k.ilog2());
    }
    // All rows: each is the one before times the companion matrix, which cancels nothing at so short a time.
    let mut rows = vec![sum.iter().map(|s| s.map(|c| c.widened(&Integer::ONE))).collect::<Vec<Series>>()];
    for i in 1..if halvings > 0 { n } else { 1 } {
        let before = &rows[i - 1];
        let next = |j: usize| {
            let carried = before[n - 1].mul(&polynomial[j]);
            if j == 0 { carried.neg() } else { before[j - 1].sub(&carried) }
        };
        rows.push((0..n).map(next).collect());
    }
    for left in (0..halvings).rev() {
        let entry = |i: usize, j: usize| {
            let products = (0..n).map(|k| rows[i][k].mul(&rows[k][j]));
            products.reduce(|s, t| s.add(&t)).expect("an equation of some order")
        };
        // Of the last square, the first row is all that is needed.
        rows = (0..if left > 0 { n } else { 1 }).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    }
    let out = &rows[0];
    out.iter().enumerate().map(|(j, s)| s.map(|c| c.shifted(-((octaves * j as u64) as i64)).with_bits(bits))).collect()
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
    fn quotients_roots_and_powers_undo_products() {
        let (a, b) = (at("3/2", "1/3", 8), at("7/5", "-1/4", 8).power(3));
        let same = |x: &Series, y: &Series| {
            x.coefficients()
                .iter()
                .zip(y.coefficients())
                .all(|(a, b)| a.intersection(b).is_some() && a.union(b).width_units().bit_length() < 20)
        };
        assert!(same(&a.mul(&b).div(&b).unwrap(), &a));
        let root = b.sqrt().unwrap();
        assert!(same(&root.mul(&root), &b));
        assert!(same(&a.exp().mul(&a.neg().exp()), &a.power(0)));
        assert!(at("0", "1", 3).div(&at("0", "1", 3)).is_none());
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
