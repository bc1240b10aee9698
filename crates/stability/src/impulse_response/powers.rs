//! Norms of powers of a matrix.
//!
//! The norm is the greatest sum of absolute values in a row, for which `||A B|| <= ||A|| ||B||`. With `p = 2^m` each `i < p` is a sum
//! of different `2^j` with `j < m`, so `||A^0|| + ... + ||A^(p-1)|| <= (1 + ||A||) (1 + ||A^2||) ... (1 + ||A^(p/2)||)`; and with
//! `||A^p|| = c < 1` the sum of all norms is at most `1/(1 - c)` times that.

use super::coefficients::Monic;
use jurist_algebra::ball::BallMatrix;
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::Integer;

/// A power with a norm of at most a half.
#[derive(Clone, Debug)]
pub(super) struct Powers {
    /// `p`.
    pub exponent: u64,
    /// A bound of `||A^p||`, in units of `2^-bits`.
    pub norm: Integer,
    pub bits: u64,
    /// A bound of the sum of the norms of all powers.
    pub total: Integer,
}

impl Powers {
    /// `None` where the matrix is known with too few bits.
    pub fn of(mut matrix: Rounded) -> Option<Powers> {
        let bits = matrix.bits;
        let one = Integer::ONE << bits;
        let (mut exponent, mut total) = (1u64, Integer::ONE);
        loop {
            let norm = matrix.norm();
            if &norm << 1 <= one {
                // 1/(1 - c) is at most 2.
                return Some(Powers { exponent, norm, bits, total: total << 1 });
            }
            // An error of more than an eighth hides what is looked for.
            if &matrix.error << 3 > one {
                return None;
            }
            total = ceiling_shift(&(total * (&one + norm)), bits);
            exponent = exponent.saturating_mul(2);
            matrix = matrix.squared();
        }
    }

    /// A bound of what all windows after a block of them sum up to, from a bound of the sum of the block: `c/(1 - c)` times that.
    pub fn after(&self, block: &Integer) -> Integer {
        let rest = (Integer::ONE << self.bits) - &self.norm;
        ceiling_quotient(&(&self.norm * block), &rest)
    }
}

/// A square matrix of integers over `2^bits`, and a bound of the norm of its error in the same units.
#[derive(Clone, Debug)]
pub(super) struct Rounded {
    entries: Vec<Integer>,
    size: usize,
    bits: u64,
    error: Integer,
}

impl Rounded {
    /// The middles of the entries.
    pub fn of(matrix: &BallMatrix, bits: u64) -> Rounded {
        let size = matrix.size();
        let places = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
        let entries = places.map(|(i, j)| matrix.at(i, j).middle_units()).collect();
        let widths = |i| (0..size).fold(Integer::ZERO, |sum, j| sum + matrix.at(i, j).width_units());
        Rounded { entries, size, bits, error: (0..size).map(widths).max().unwrap_or(Integer::ZERO) }
    }

    /// The product with a vector in the same units, each entry rounded down.
    pub fn times(&self, vector: &[Integer]) -> Vec<Integer> {
        checkpoint((self.size * self.size) as u64 * (2 + self.bits / 32));
        let row = |row: &[Integer]| {
            let mut sum = Integer::ZERO;
            for (a, x) in row.iter().zip(vector) {
                sum.add_mul_assign(a, x);
            }
            sum >> self.bits
        };
        self.entries.chunks(self.size.max(1)).map(row).collect()
    }

    /// A bound of the error of [`Self::times`], from a bound of the vector's norm.
    pub fn error_of(&self, norm: &Integer) -> Integer {
        ceiling_shift(&(&self.error * norm), self.bits) + Integer::ONE
    }

    /// Row `i` shifts the window, the last one is the recursion.
    pub fn companion(coefficients: &Monic) -> Rounded {
        let (n, bits) = (coefficients.order(), coefficients.bits());
        let mut entries = vec![Integer::ZERO; n * n];
        for i in 1..n {
            entries[(i - 1) * n + i] = Integer::ONE << bits;
        }
        let mut error = Integer::ZERO;
        for (k, a) in coefficients.below.iter().enumerate() {
            entries[n * n - 1 - k] = -a.middle_units();
            error += a.width_units();
        }
        Rounded { entries, size: n, bits, error }
    }

    /// A bound of the norm of what is enclosed.
    fn norm(&self) -> Integer {
        let rows = self.entries.chunks(self.size.max(1));
        let sums = rows.map(|row| row.iter().fold(Integer::ZERO, |sum, x| sum + x.abs()));
        sums.max().unwrap_or(Integer::ZERO) + &self.error
    }

    /// With `X = M + E`: `||X^2 - M^2|| <= 2 ||M|| ||E|| + ||E||^2 <= (2 ||X|| + 2 ||E||) ||E||` by the bound of `||X||`, and a unit for
    /// each entry of a row.
    fn squared(&self) -> Rounded {
        let n = self.size;
        let mut entries = Vec::with_capacity(n * n);
        for i in 0..n {
            for j in 0..n {
                checkpoint(2 * n as u64 * (1 + self.bits / 64));
                let mut sum = Integer::ZERO;
                for k in 0..n {
                    let (a, b) = (&self.entries[i * n + k], &self.entries[k * n + j]);
                    if !a.is_zero() && !b.is_zero() {
                        sum.add_mul_assign(a, b);
                    }
                }
                entries.push(sum >> self.bits);
            }
        }
        let spread = (&self.norm() + &self.error) << 1;
        let carried = if self.error.is_zero() { Integer::ZERO } else { spread * &self.error };
        // Of what is exact, as shifts, nothing is cut off.
        let error = ceiling_shift(&carried, self.bits) + Integer::from(n as u64);
        Rounded { entries, size: n, bits: self.bits, error }
    }
}

/// A quotient by a positive number, rounded up.
pub(super) fn ceiling_quotient(a: &Integer, b: &Integer) -> Integer {
    -(-a).div_mod_floor(b).0
}

/// A quotient by a power of two, rounded up.
pub(super) fn ceiling_shift(a: &Integer, bits: u64) -> Integer {
    -(-a >> bits)
}
