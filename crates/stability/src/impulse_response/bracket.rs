//! The sum of absolute values between two numbers.

use super::AbsoluteSum;
use super::coefficients::Monic;
use super::powers::{Powers, Rounded};
use super::recursion::{Samples, SlidingMaximum};
use crate::precisions::IMPULSE_RESPONSE;
use jurist_algebra::limits::{Exhausted, until_shown};
use jurist_algebra::number::{Integer, Rational};

/// Fewest windows between two looks at the bracket: a look costs as much as a few samples.
const LEAST_BLOCK: u64 = 32;

/// The digits with which signs are told.
const DIGITS_OF_SIGNS: usize = 30;

/// A transfer function by its coefficients with any number of bits, and what is known of the powers of its companion matrix.
pub(super) struct Brackets<'a> {
    coefficients: &'a dyn Fn(u64) -> Option<Monic>,
    powers: Powers,
}

/// What an attempt gave.
enum Attempt {
    Found(AbsoluteSum),
    MoreBits(u64),
}

impl<'a> Brackets<'a> {
    /// Finds the power whose norm is below a half; without end where the denominator is not stable.
    pub fn new(coefficients: &'a dyn Fn(u64) -> Option<Monic>) -> Brackets<'a> {
        let powers = until_shown(IMPULSE_RESPONSE.first, |bits| Powers::of(Rounded::companion(&coefficients(bits)?)));
        Brackets { coefficients, powers }
    }

    /// The sum to so many digits and two more.
    pub fn sum(&self, digits: usize) -> Result<AbsoluteSum, Exhausted> {
        let mut bits = self.first_bits(digits);
        let last = bits + IMPULSE_RESPONSE.last;
        loop {
            if bits > last {
                return Err(IMPULSE_RESPONSE.exhausted("impulse response"));
            }
            bits = match (self.coefficients)(bits).map(|monic| self.attempt(&monic, digits)) {
                Some(Attempt::Found(sum)) => return Ok(sum),
                Some(Attempt::MoreBits(more)) => bits + more,
                None => 2 * bits,
            };
        }
    }

    /// The signs of the first samples, 0 where an error hides them.
    pub fn signs(&self, count: usize) -> Vec<i8> {
        let bits = self.first_bits(DIGITS_OF_SIGNS);
        let monic = until_shown(bits, self.coefficients);
        let mut samples = Samples::new(&monic);
        let sign = |_| {
            let sample = samples.advance();
            let is_known = sample.abs() > samples.error(&self.powers.total);
            if is_known { if sample.is_negative() { -1 } else { 1 } } else { 0 }
        };
        (0..count).map(sign).collect()
    }

    /// Bits that are enough where the sum is about as great as the greatest coefficient of the numerator, and a billion samples are.
    fn first_bits(&self, digits: usize) -> u64 {
        let first = IMPULSE_RESPONSE.first;
        let greatest = (self.coefficients)(first).into_iter().flat_map(|monic| monic.above);
        let length = greatest.map(|b| b.magnitude_units().bit_length()).max().unwrap_or(first);
        // log2(10) < 10/3
        self.powers.total.bit_length() + (digits as u64 + 2) * 10 / 3 + 36 + first.saturating_sub(length)
    }

    /// Blocks of samples until the bracket is narrow, or only errors keep it wide.
    fn attempt(&self, monic: &Monic, digits: usize) -> Attempt {
        let accuracy = Integer::from(10).pow(digits as u64 + 2);
        let mut walk = Walk::new(monic, &self.powers);
        loop {
            let Ends { lower, upper, tail, error } = walk.after_block();
            if &(&upper - &lower) * &accuracy <= lower {
                return Attempt::Found(found(&lower, &upper, monic.bits(), walk.samples.count));
            }
            let asked = lower.max(Integer::ZERO).div_mod_floor(&accuracy).0;
            if &tail << 1 <= asked || tail <= error {
                let errors = (&error * Integer::from(walk.order + 3)).bit_length();
                let lacking = errors.saturating_sub(asked.bit_length()) + 3;
                return Attempt::MoreBits(if asked.is_zero() { lacking.max(monic.bits()) } else { lacking });
            }
        }
    }
}

/// A bound of the sum, above it by a factor of about the order at most; `None` where the coefficients have too few bits.
pub(super) fn rough_bound(monic: &Monic) -> Option<Rational> {
    let powers = Powers::of(Rounded::companion(monic))?;
    Some(Rational::dyadic(&Walk::new(monic, &powers).after_block().upper, monic.bits()))
}

/// Samples in blocks of windows.
struct Walk<'p> {
    samples: Samples,
    window: SlidingMaximum,
    order: u64,
    block: u64,
    powers: &'p Powers,
}

/// What is known after a block, in units of the samples.
struct Ends {
    lower: Integer,
    upper: Integer,
    /// A bound of what follows, as if the samples were exact.
    tail: Integer,
    /// A bound of the errors of all samples.
    error: Integer,
}

impl<'p> Walk<'p> {
    fn new(monic: &Monic, powers: &'p Powers) -> Walk<'p> {
        Walk {
            samples: Samples::new(monic),
            window: SlidingMaximum::new(monic.order()),
            order: monic.order() as u64,
            // The norm of a power of this power is no greater.
            block: powers.exponent.saturating_mul(LEAST_BLOCK.div_ceil(powers.exponent)),
            powers,
        }
    }

    /// Goes on by a block.
    fn after_block(&mut self) -> Ends {
        let (mut windows, mut sum) = (0, Integer::ZERO);
        while windows < self.block {
            self.window.push(self.samples.advance().abs());
            // The first window that the recursion alone moves begins at h_1.
            if self.samples.count > self.order {
                sum += self.window.greatest();
                windows += 1;
            }
        }
        let error = self.samples.error(&self.powers.total);
        let tail = self.powers.after(&sum);
        // A sample is in as many windows as the order is, so its error is.
        let above = self.powers.after(&(sum + &error * Integer::from(self.order)));
        let (lower, upper) = (&self.samples.sum - &error, &self.samples.sum + &error + above);
        Ends { lower, upper, tail, error }
    }
}

/// The bracket as rational numbers.
pub(super) fn found(lower: &Integer, upper: &Integer, bits: u64, count: u64) -> AbsoluteSum {
    let [lower, upper] = [lower, upper].map(|units| Rational::dyadic(units, bits));
    AbsoluteSum { lower, upper, exact: None, terms: usize::try_from(count).unwrap_or(usize::MAX) }
}
