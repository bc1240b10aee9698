//! Samples of an impulse response in fixed point.
//!
//! `h_k = b_k - a_1 h_(k-1) - ... - a_n h_(k-n)` is computed with the middles of the coefficients and rounded to `2^-bits`. What is
//! computed obeys the exact recursion with a further input `e_k`: half a unit of rounding, the error of `b_k`, and the errors of the
//! `a_i` times samples that are known. So the sum of all errors of samples is at most the sum of the `|e_k|`, times the sum of the
//! absolute values of the impulse response of `z^n/D`. That starts from the window `(0, ..., 0, 1)`, so it is at most the sum of the norms of
//! the powers of the companion matrix.

use super::coefficients::Monic;
use super::powers::ceiling_shift;
use jurist_algebra::limits::checkpoint;
use jurist_algebra::number::Integer;
use std::collections::VecDeque;

/// The samples, one after another, in units of `2^-bits`.
pub(super) struct Samples {
    above: Vec<Integer>,
    below: Vec<Integer>,
    bits: u64,
    half: Integer,
    /// The last samples, the latest first.
    recent: VecDeque<Integer>,
    /// How many were computed.
    pub count: u64,
    /// The sum of their absolute values.
    pub sum: Integer,
    /// Bounds of the sums of the errors of coefficients.
    error_above: Integer,
    error_below: Integer,
}

impl Samples {
    pub fn new(coefficients: &Monic) -> Samples {
        let middles = |balls: &[jurist_algebra::ball::Ball]| balls.iter().map(|b| b.middle_units()).collect::<Vec<_>>();
        let widths =
            |balls: &[jurist_algebra::ball::Ball]| balls.iter().fold(Integer::ZERO, |sum, b| sum + b.width_units());
        let bits = coefficients.bits();
        Samples {
            above: middles(&coefficients.above),
            below: middles(&coefficients.below),
            bits,
            half: if bits == 0 { Integer::ZERO } else { Integer::ONE << (bits - 1) },
            recent: VecDeque::with_capacity(coefficients.order()),
            count: 0,
            sum: Integer::ZERO,
            error_above: widths(&coefficients.above),
            error_below: widths(&coefficients.below),
        }
    }

    /// The next sample.
    pub fn advance(&mut self) -> Integer {
        let n = self.below.len();
        checkpoint(4 + (n as u64 + 1) * (4 + self.bits / 32));
        let mut sum = self.half.clone();
        for (a, h) in self.below.iter().zip(&self.recent) {
            if !a.is_zero() {
                sum.sub_mul_assign(a, h);
            }
        }
        let mut sample = sum >> self.bits;
        if let Some(b) = usize::try_from(self.count).ok().and_then(|k| self.above.get(k)) {
            sample += b;
        }
        self.sum += sample.abs();
        self.count += 1;
        if self.recent.len() == n {
            self.recent.pop_back();
        }
        if n > 0 {
            self.recent.push_front(sample.clone());
        }
        sample
    }

    /// A bound of the sum of the errors of all samples so far, from a bound of the sum of the norms of all powers.
    pub fn error(&self, total: &Integer) -> Integer {
        let by_coefficients = ceiling_shift(&(&self.error_below * &self.sum), self.bits);
        let inputs = Integer::from(self.count) + &self.error_above + by_coefficients;
        inputs * total
    }
}

/// The greatest of the last `size` numbers that were pushed, none of which is negative.
pub(super) struct SlidingMaximum {
    size: u64,
    pushed: u64,
    /// Numbers that no later one reaches, each with its place, the greatest first.
    descending: VecDeque<(u64, Integer)>,
}

impl SlidingMaximum {
    pub fn new(size: usize) -> SlidingMaximum {
        SlidingMaximum { size: size as u64, pushed: 0, descending: VecDeque::new() }
    }

    pub fn push(&mut self, value: Integer) {
        while self.descending.back().is_some_and(|(_, last)| *last <= value) {
            self.descending.pop_back();
        }
        self.descending.push_back((self.pushed, value));
        self.pushed += 1;
        while self.descending.front().is_some_and(|(place, _)| place + self.size < self.pushed) {
            self.descending.pop_front();
        }
    }

    pub fn greatest(&self) -> Integer {
        self.descending.front().map_or(Integer::ZERO, |(_, value)| value.clone())
    }
}
