//! The exponential of a matrix: the one primitive that all transcendental constants come from.

use super::Ball;
use crate::limits::checkpoint;
use crate::matrix::Matrix;
use crate::number::{Integer, Rational};

/// Exponentials of matrices of a larger norm, in bits, may have too many bits to be of use.
pub(super) const LARGEST_BITS: u64 = 13;

/// A square matrix of balls, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BallMatrix {
    size: usize,
    entries: Vec<Ball>,
}

impl BallMatrix {
    /// The matrix whose entry in row `i`, column `j` is `f(i, j)`.
    pub fn from_fn(size: usize, mut f: impl FnMut(usize, usize) -> Ball) -> Self {
        let entries = (0..size * size).map(|k| f(k / size, k % size)).collect();
        BallMatrix { size, entries }
    }

    /// The number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The entry in row `i`, column `j`.
    pub fn at(&self, i: usize, j: usize) -> &Ball {
        &self.entries[i * self.size + j]
    }

    fn map(&self, f: impl Fn(&Ball) -> Ball) -> Self {
        BallMatrix { size: self.size, entries: self.entries.iter().map(f).collect() }
    }

    /// The sum.
    pub fn add(&self, other: &BallMatrix) -> BallMatrix {
        BallMatrix::from_fn(self.size, |i, j| self.at(i, j).add(other.at(i, j)))
    }

    /// The product: `n^3` products of balls.
    pub fn mul(&self, other: &BallMatrix) -> BallMatrix {
        BallMatrix::from_fn(self.size, |i, j| {
            Ball::sum_of_products((0..self.size).map(|k| (self.at(i, k), other.at(k, j))), self.at(i, j).bits)
        })
    }

    /// [`balancing_units`] of the entries.
    fn balancing_units(&self) -> Vec<i64> {
        balancing_units(self.size, &self.entry_sizes())
    }

    /// Whether the exponential has not too many bits to be of use.
    pub(super) fn is_of_use(&self) -> bool {
        let units = self.balancing_units();
        let row = |i: usize| {
            let size = |j: usize| self.at(i, j).shifted(units[j] - units[i]).magnitude_units();
            (0..self.size).fold(Integer::ZERO, |sum, j| sum + size(j))
        };
        let norm = (0..self.size).map(row).max().unwrap_or(Integer::ZERO);
        self.entries.first().is_none_or(|entry| norm.bit_length() <= entry.bits + LARGEST_BITS)
    }

    fn entry_sizes(&self) -> Vec<Option<i64>> {
        let size = |b: &Ball| (!b.is_zero()).then(|| b.magnitude_units().bit_length() as i64);
        self.entries.iter().map(size).collect()
    }

    /// An upper bound of the greatest row sum of absolute values, in units of `2^-bits`.
    fn norm_units(&self) -> Integer {
        let row = |i: usize| (0..self.size).fold(Integer::ZERO, |sum, j| sum + self.at(i, j).magnitude_units());
        (0..self.size).map(row).max().unwrap_or(Integer::ZERO)
    }
}

/// Exponents `d` with which entries `m_ij 2^(d_j - d_i)` of about so many bits, row by row, have rows and columns of about the same size, so that
/// the norm is small ([ParlettReinsch1969](crate::bibliography#parlettreinsch1969)).
pub(super) fn balancing_units(n: usize, sizes: &[Option<i64>]) -> Vec<i64> {
    let mut units = vec![0i64; n];
    for _ in 0..2 * n {
        let before = units.clone();
        for i in 0..n {
            let at = |row: usize, column: usize| {
                sizes[row * n + column].map(|size| size + units[column] - units[row]).filter(|_| row != column)
            };
            let row = (0..n).filter_map(|j| at(i, j)).max();
            let column = (0..n).filter_map(|j| at(j, i)).max();
            // A row without entries may be scaled as one likes, and is not.
            if let (Some(row), Some(column)) = (row, column) {
                units[i] += (row - column) / 2;
            }
        }
        if units == before {
            break;
        }
    }
    units
}

/// An enclosure of `exp(M)` for every matrix `M` in the given one.
///
/// `M` is balanced, and scaled by a power of two until its norm is at most 1/4; then the Taylor series is summed, whose rest after the
/// power `k` is at most `(1/4)^(k+1)/(k+1)! 4/3`; then the sum is squared as often as it was halved. Entries are as wide as
/// those of `M`, times the norm of the exponential, and some bits more.
///
/// Cost: `O(n^3)` products of balls for each of `O(bits/log bits)` terms and for each squaring.
pub fn exponential(m: &BallMatrix) -> BallMatrix {
    let n = m.size;
    if n == 0 {
        return m.clone();
    }
    let bits = m.at(0, 0).bits;
    if m.norm_units().is_zero() {
        // Exactly, so that what vanishes at the time 0 is seen to.
        let one = Ball::from_integer(&Integer::ONE, bits);
        return BallMatrix::from_fn(n, |i, j| if i == j { one.clone() } else { Ball::zero(bits) });
    }
    // The same matrix in other units, exactly; what is multiplied in the end needs as many bits more.
    let units = m.balancing_units();
    let spread = units.iter().max().zip(units.iter().min()).map_or(0, |(most, least)| (most - least) as u64);
    let in_units = |sign: i64, i: usize, j: usize| sign * (units[j] - units[i]);
    let more = bits + spread;
    let balanced = BallMatrix::from_fn(n, |i, j| m.at(i, j).with_bits(more).shifted(in_units(1, i, j)));
    // 2^halvings >= 4 norm.
    let halvings = (balanced.norm_units().bit_length() + 2).saturating_sub(more);
    let working = more + 2 * halvings + 16;
    let x = balanced.map(|b| b.with_bits(working).shifted(-(halvings as i64)));
    let one = Ball::from_integer(&Integer::ONE, working);
    let zero = Ball::zero(working);
    let identity = BallMatrix::from_fn(n, |i, j| if i == j { one.clone() } else { zero.clone() });
    let mut sum = identity.add(&x);
    let mut term = x.clone();
    // The term of power k is at most 2^-small.
    let (mut k, mut small) = (1u64, 2u64);
    while small < working + 1 {
        checkpoint((n * n) as u64);
        k += 1;
        term = term.mul(&x).map(|b| b.divided_by(k));
        sum = sum.add(&term);
        small += 2 + u64::from(k.ilog2());
    }
    // The first term left out is at most 2^-(working + 3), all of them 4/3 of it.
    let mut out = sum.map(|b| b.widened(&Integer::ONE));
    for _ in 0..halvings {
        out = out.mul(&out);
    }
    BallMatrix::from_fn(n, |i, j| out.at(i, j).shifted(in_units(-1, i, j)).with_bits(bits))
}

/// Bits that are added when an exponential turned out too wide.
const MORE_BITS: u64 = 64;

/// An enclosure of `exp(M)` for a square matrix of rational numbers, each entry of width at most `3 2^-bits`.
///
/// ```
/// use jurist_algebra::ball::exponential_of_rationals;
/// use jurist_algebra::matrix::Matrix;
/// use jurist_algebra::number::Rational;
/// let nilpotent = Matrix::from_fn(2, 2, |i, j| Rational::from(i32::from(i == 0 && j == 1) * 3));
/// let e = exponential_of_rationals(&nilpotent, 64);
/// assert!(e.at(0, 1).contains(&3.into()) && e.at(1, 0).contains(&0.into()));
/// ```
///
/// Cost: that of [`exponential`], more than once where the exponential is large.
///
/// # Panics
/// Unless the matrix is square.
pub fn exponential_of_rationals(m: &Matrix<Rational>, bits: u64) -> BallMatrix {
    assert!(m.is_square(), "the exponential of a square matrix");
    let narrow = Integer::ONE;
    let mut working = bits + 24;
    loop {
        let balls = BallMatrix::from_fn(m.rows(), |i, j| Ball::from_rational(&m[(i, j)], working));
        let e = exponential(&balls);
        let out = e.map(|b| b.with_bits(bits + 2));
        if out.entries.iter().all(|b| b.width_units() <= (&narrow << 2)) {
            return out.map(|b| b.with_bits(bits));
        }
        let excess = e.entries.iter().map(|b| b.width_units().bit_length()).max().unwrap_or(0);
        working += MORE_BITS.max(excess.saturating_sub(working - bits) + 16);
    }
}
