//! A polynomial on the unit interval and its Bernstein coefficients on parts of it, as exact as asked
//! for.

use super::evaluate::Evaluator;
use super::limbs::{max_bits, rescale, write_shifted};
use super::triangle::{HEADROOM, fitting_width, shift_by_one, sum_differences, sum_from_both_ends, summing_width};
use crate::limits::checkpoint;
use crate::number::{Integer, Sign};
use std::rc::Rc;

/// The interval `[lo, lo + 2^log_width] / 2^bits` inside the unit interval.
#[derive(Clone, Debug)]
pub struct Cell {
    pub lo: Integer,
    pub log_width: u64,
    pub bits: u64,
}

impl Cell {
    /// The unit interval.
    pub fn unit() -> Cell {
        Cell { lo: Integer::ZERO, log_width: 0, bits: 0 }
    }

    /// The upper end, times `2^bits`.
    pub fn hi(&self) -> Integer {
        &self.lo + &(&Integer::ONE << self.log_width)
    }

    /// How many halvings of the unit interval lead to its width.
    pub fn depth(&self) -> u64 {
        self.bits - self.log_width
    }

    /// The order of the lower ends.
    pub fn compare(&self, other: &Cell) -> Sign {
        let bits = self.bits.max(other.bits);
        (&self.lo << (bits - self.bits)).cmp(&(&other.lo << (bits - other.bits)))
    }

    /// Both halves.
    pub fn halves(&self) -> (Cell, Cell) {
        let (lo, log_width, bits) = match self.log_width.checked_sub(1) {
            Some(log_width) => (self.lo.clone(), log_width, self.bits),
            None => (&self.lo << 1, 0, self.bits + 1),
        };
        let middle = &lo + &(&Integer::ONE << log_width);
        (Cell { lo, log_width, bits }, Cell { lo: middle, log_width, bits })
    }

    /// The part from `j / 2^k` to `(j + 2) / 2^k` of this interval.
    pub fn zoomed(&self, j: &Integer, k: u64) -> Cell {
        let lo = &(&self.lo << k) + &(j << self.log_width);
        Cell { lo, log_width: self.log_width + 1, bits: self.bits + k }
    }
}

/// Bernstein coefficients `2^scale` times those stored, each up to `error` units of the last place.
#[derive(Clone, Debug)]
pub struct Bernstein {
    pub flat: Vec<u64>,
    pub limbs: usize,
    pub error: u64,
    /// Bits of the largest coefficient stored.
    pub height: u64,
    pub scale: i64,
}

impl Bernstein {
    /// How many bits of the largest coefficient are certain.
    pub fn precision(&self) -> u64 {
        self.height.saturating_sub(u64::from(64 - self.error.leading_zeros()))
    }
}

/// `p(2^scale t)` for `t` from 0 to 1, `p` without rational roots.
pub struct Piece {
    pub coeffs: Rc<[Integer]>,
    pub scale: i64,
    binomials: Rc<Vec<Integer>>,
    evaluator: Evaluator,
}

/// The binomial coefficients of one row of Pascal's triangle.
pub fn binomial_row(n: usize) -> Vec<Integer> {
    let mut row = Vec::with_capacity(n + 1);
    checkpoint(4 * n as u64);
    let mut c = Integer::ONE;
    for k in 0..=n {
        row.push(c.clone());
        c = (&c * &Integer::from(n - k)).div_exact(&Integer::from(k + 1));
    }
    row
}

impl Piece {
    pub fn new(coeffs: Rc<[Integer]>, scale: i64, binomials: Rc<Vec<Integer>>) -> Piece {
        let evaluator = Evaluator::new(Rc::clone(&coeffs), scale);
        Piece { coeffs, scale, binomials, evaluator }
    }

    pub fn degree(&self) -> usize {
        self.coeffs.len() - 1
    }

    /// Whether the polynomial is positive at `numerator / 2^bits`.
    pub fn positive_at(&mut self, numerator: &Integer, bits: u64) -> bool {
        if numerator.is_zero() {
            return !self.coeffs[0].is_negative();
        }
        self.evaluator.positive_at(numerator, bits)
    }

    /// The Bernstein coefficients on a cell with `precision` certain bits of the largest, computed from
    /// the polynomial itself; `hint` is a guess at the binary logarithm of the largest.
    pub fn bernstein(&self, cell: &Cell, precision: u64, hint: Option<i64>) -> Bernstein {
        let n = self.degree() as u64;
        let top = self.top_bits();
        let at_zero = cell.lo.is_zero();
        let lost = if at_zero { self.lost_at_zero() } else { n + u64::from(u64::BITS - (2 * n + 5).leading_zeros()) };
        let mut fraction = precision as i64 + lost as i64 + 4 - hint.unwrap_or(top);
        loop {
            checkpoint(32 * n);
            let g = if at_zero {
                self.differences_at_zero(cell.bits - cell.log_width, fraction)
            } else {
                self.differences_at(cell, fraction, top)
            };
            let (mut exact, limbs) = self.laid_out(&g);
            sum_differences(&mut exact, limbs);
            let height = max_bits(&exact, limbs);
            let certain = height.saturating_sub(lost);
            if certain + 8 >= precision {
                return stored(&exact, limbs, height, lost, fraction, precision);
            }
            fraction += (precision - certain) as i64 + if height == 0 { fraction.abs() } else { 0 };
        }
    }

    /// The Bernstein coefficients on the unit interval, and those of the reversal (of the coefficients and the sign
    /// of `scale`) there, with `precision` certain bits of the largest of each.
    ///
    /// With `a_i / C(n, i)` for numbers, the left side of the triangle of their sums has the former, the right side the latter:
    /// as Bernstein coefficients from 0 to infinity they are divided at 1.
    pub fn bernstein_of_both(&self, precision: u64) -> (Bernstein, Bernstein) {
        let n = self.degree() as u64;
        let lost = self.lost_at_zero();
        let mut fraction = precision as i64 + lost as i64 + 4 - self.least_height();
        loop {
            checkpoint(32 * n);
            let g = self.differences_at_zero(0, fraction);
            let (mut work, limbs) = self.laid_out(&g);
            let (mut left, mut right) = (vec![0; work.len()], vec![0; work.len()]);
            sum_from_both_ends(&mut work, limbs, &mut left, &mut right);
            let heights = (max_bits(&left, limbs), max_bits(&right, limbs));
            let certain = heights.0.min(heights.1).saturating_sub(lost);
            if certain + 8 >= precision {
                let direct = stored(&left, limbs, heights.0, lost, fraction, precision);
                let mut reversed = stored(&right, limbs, heights.1, lost, fraction, precision);
                reversed.scale -= self.scale * n as i64;
                return (direct, reversed);
            }
            // The bound was rounded.
            fraction += (precision - certain) as i64 + if certain == 0 { fraction.abs() } else { 0 };
        }
    }

    /// The bits of the units that sums lose at 0: differences are less than a unit wrong, and `2^n` of them are summed at most.
    fn lost_at_zero(&self) -> u64 {
        self.degree() as u64
    }

    /// A number that the logarithm of the largest coefficient, here as of the reversal, hardly falls below: differences
    /// of order `i` are `2^i` times as large at most.
    fn least_height(&self) -> i64 {
        let n = self.degree();
        let terms = || self.coeffs.iter().zip(self.binomials.iter()).enumerate().filter(|(_, (c, _))| !c.is_zero());
        let height = |i: usize, c: &Integer, b: &Integer, order: usize| {
            c.bit_length() as i64 + self.scale * i as i64 - b.bit_length() as i64 - order as i64
        };
        let direct = terms().map(|(i, (c, b))| height(i, c, b, i)).max();
        let reversed = terms().map(|(i, (c, b))| height(i, c, b, n - i)).max();
        direct.min(reversed).unwrap_or(0)
    }

    /// Differences in as many limbs as hold their sums.
    fn laid_out(&self, g: &[Integer]) -> (Vec<u64>, usize) {
        // A sum holds no difference more often than the binomial coefficient says; and there is a sign.
        let bits = |(c, b): (&Integer, &Integer)| c.bit_length() + b.bit_length();
        let most = g.iter().zip(self.binomials.iter()).map(bits).max().unwrap_or(0);
        let room = most + u64::from(usize::BITS - g.len().leading_zeros()) + 1;
        let limbs = summing_width(room.div_ceil(64) as usize);
        let mut flat = vec![0; g.len() * limbs];
        for (c, place) in g.iter().zip(flat.chunks_exact_mut(limbs)) {
            write_shifted(c, 0, place);
        }
        (flat, limbs)
    }

    /// A bound of the logarithm of the coefficients of `p(2^scale t)`.
    fn top_bits(&self) -> i64 {
        let bits = |(i, c): (usize, &Integer)| c.bit_length() as i64 + self.scale * i as i64;
        self.coeffs.iter().enumerate().filter(|(_, c)| !c.is_zero()).map(bits).max().unwrap_or(0)
    }

    /// `2^fraction` times the forward differences of the Bernstein coefficients on `[0, 2^-depth]`,
    /// each less than a unit wrong.
    fn differences_at_zero(&self, depth: u64, fraction: i64) -> Vec<Integer> {
        let per_power = self.scale - depth as i64;
        let terms = self.coeffs.iter().zip(self.binomials.iter()).enumerate();
        terms.map(|(i, (c, b))| divided(&shifted(c, fraction + per_power * i as i64), b)).collect()
    }

    /// The same on a cell away from 0, up to `2 (n + 1) + 3` units wrong, so that sums lose `(2 n + 5) 2^n`.
    ///
    /// With the cell `[c, c + w]`, `w <= c`: `p(c (1 + s))` has the coefficients `a_i c^i` shifted by one,
    /// by additions alone; then `s = (w / c) t`.
    fn differences_at(&self, cell: &Cell, fraction: i64, top: i64) -> Vec<Integer> {
        let n = self.coeffs.len() - 1;
        // The powers of c are within n units of 2^-guard, so that terms are within two units.
        let guard = (fraction + top).max(0) as u64 + u64::from(usize::BITS - n.leading_zeros()) + 1;
        let mut power = &Integer::ONE << guard;
        let mut s = Vec::with_capacity(n + 1);
        for (i, a) in self.coeffs.iter().enumerate() {
            s.push(shifted(&(a * &power), fraction + self.scale * i as i64 - guard as i64));
            power = &(&power * &cell.lo) >> cell.bits;
        }
        // Sums of at most 2^n terms.
        let room = s.iter().map(Integer::bit_length).max().unwrap_or(0) + n as u64 + 2;
        let limbs = summing_width(room.div_ceil(64) as usize);
        let mut flat = vec![0; s.len() * limbs];
        for (c, place) in s.iter().rev().zip(flat.chunks_exact_mut(limbs)) {
            write_shifted(c, 0, place);
        }
        shift_by_one(&mut flat, limbs);
        let height = max_bits(&flat, limbs);
        let guard = height + u64::from(usize::BITS - n.leading_zeros()) + 1;
        let one = &Integer::ONE << guard;
        let mut power = one;
        let mut out = Vec::with_capacity(n + 1);
        for (k, s) in flat.chunks_exact(limbs).rev().enumerate() {
            if power.is_zero() {
                out.push(Integer::ZERO);
                continue;
            }
            let s = Integer::from_twos_complement(s);
            out.push(divided(&(&(&s * &power) >> guard), &self.binomials[k]));
            power = (&power << cell.log_width).div_mod_floor(&cell.lo).0;
        }
        out
    }
}

/// `floor(c 2^by)`.
fn shifted(c: &Integer, by: i64) -> Integer {
    if by >= 0 { c << by as u64 } else { c >> by.unsigned_abs() }
}

fn divided(c: &Integer, by: &Integer) -> Integer {
    if by.is_one() { c.clone() } else { c.div_mod_floor(by).0 }
}

/// The numbers cut down to the bits that are certain and asked for.
fn stored(exact: &[u64], width: usize, height: u64, lost: u64, fraction: i64, precision: u64) -> Bernstein {
    let wanted = (height - lost.min(height)).min(precision) + 6;
    let limbs = fitting_width((wanted + HEADROOM).div_ceil(64) as usize);
    // The unit of the store: 2^drop units of the numbers.
    let drop = (height as i64 - wanted as i64).max(0);
    let flat = rescale(exact, width, limbs, drop);
    let error = if drop as u64 >= lost { 2 } else { 1 + (1 << (lost - drop as u64)) };
    let height = max_bits(&flat, limbs);
    Bernstein { flat, limbs, error, height, scale: drop - fraction }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of both ends from one triangle, against those of each from its own, for polynomials whose largest
    /// coefficients are at any place.
    #[test]
    fn coefficients_of_both_halves_are_those_of_each() {
        let mut state = 11u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state >> 33
        };
        for case in 0..60 {
            let n = 2 + case % 40;
            let coeffs: Vec<Integer> = (0..=n)
                .map(|i| {
                    let c = (Integer::from(next() as i64 - (1 << 30)) << (next() % 200)) + Integer::ONE;
                    if i > 0 && i < n && next() % 4 == 0 { Integer::ZERO } else { c }
                })
                .collect();
            let (scale, precision) = (next() as i64 % 9 - 4, 60 + next() % 100);
            let row = Rc::new(binomial_row(n));
            let piece = Piece::new(coeffs.clone().into(), scale, Rc::clone(&row));
            let reversed = Piece::new(coeffs.into_iter().rev().collect(), -scale, row);
            let both = piece.bernstein_of_both(precision);
            for (got, of) in [(both.0, piece), (both.1, reversed)] {
                assert!(got.precision() + 9 >= precision, "{} of {precision} bits", got.precision());
                let want = of.bernstein(&Cell::unit(), precision + 20, None);
                let numbers = |b: &Bernstein, scale: i64| -> Vec<Integer> {
                    let shift = (b.scale - scale) as u64;
                    b.flat.chunks_exact(b.limbs).map(|c| Integer::from_twos_complement(c) << shift).collect()
                };
                let least = got.scale.min(want.scale);
                let unit = |b: &Bernstein| Integer::from(b.error) << (b.scale - least) as u64;
                let error = unit(&got) + unit(&want);
                for (x, y) in numbers(&got, least).into_iter().zip(numbers(&want, least)) {
                    assert!((x - y).abs() <= error, "degree {n}, scale {scale}");
                }
            }
        }
    }
}
