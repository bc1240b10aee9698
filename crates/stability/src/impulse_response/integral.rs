//! The integral of the modulus of an impulse response in continuous time, between two numbers.
//!
//! With `g` for the response without its impulse at 0 the window `w = (g, g', ..., g^(n-1))` obeys `w' = A w` with the companion matrix `A` of `D`,
//! and begins with the coefficients of `N/D` at infinity. A power of two as unit of time makes the sum of the moduli of the coefficients of `D`
//! at most 1, so `||A|| <= 1`. Windows are computed in steps of half a unit by `exp(A/2)`, in fixed point (`recursion` has the bound of the errors).
//!
//! Where Taylor's polynomial and its rest show that `g` has one sign, the integral of `|g|` is a difference of the integral of `g`, which is linear in
//! the window as `D` has no root 0. Other pieces are halved; what is left of a simple zero after `d` halvings is of the order of `4^-d`. What follows
//! after a block of steps is bounded by the block, as in discrete time.

use super::AbsoluteSum;
use super::bracket::found;
use super::coefficients::Monic;
use super::powers::{Powers, Rounded, ceiling_shift};
use crate::precisions::IMPULSE_RESPONSE;
use jurist_algebra::ball::{Ball, BallMatrix, exponential};
use jurist_algebra::limits::{Exhausted, checkpoint};
use jurist_algebra::number::Integer;

/// Fewest steps between two looks at the bracket.
const LEAST_BLOCK: u64 = 32;

/// The integral of the modulus to so many digits and two more, and the modulus of what is direct.
pub(super) fn integral(coefficients: &dyn Fn(u64) -> Option<Monic>, digits: usize) -> Result<AbsoluteSum, Exhausted> {
    // log2(10) < 10/3, and a zero needs half as many halvings as there are bits.
    let asked = (digits as u64 + 2) * 10 / 3;
    let (mut bits, mut depth) = (IMPULSE_RESPONSE.first + asked, asked as usize / 2 + 8);
    let last = bits + IMPULSE_RESPONSE.last;
    while bits <= last {
        let attempt = coefficients(bits).and_then(|monic| Motion::of(&monic, depth));
        let more = match attempt.map(|motion| motion.bracket(digits)) {
            Some(Ok(sum)) => return Ok(sum),
            Some(Err(Lacking(more))) => more,
            None => bits,
        };
        bits += more;
        depth += more.min(asked) as usize / 2;
    }
    Err(IMPULSE_RESPONSE.exhausted("impulse response"))
}

/// Bits that are to be added.
struct Lacking(u64);

/// Windows along the time, in a unit of time of its own.
struct Motion {
    bits: u64,
    /// The modulus of what is direct.
    direct: Ball,
    /// The window at the time 0.
    first: Vec<Ball>,
    /// The integral of `g` up to a constant is the sum of these times the window.
    integral: Vec<Ball>,
    /// `exp(A/2)`, `exp(A/4)`, ...
    steps: Vec<BallMatrix>,
    rounded: Rounded,
    powers: Powers,
}

impl Motion {
    /// `None` where the coefficients have too few bits.
    fn of(monic: &Monic, depth: usize) -> Option<Motion> {
        let (n, bits) = (monic.order(), monic.bits());
        let unit = unit_of_time(&monic.below, bits);
        let scaled = |b: &Ball, k: usize| b.shifted(-unit * k as i64);
        let below: Vec<Ball> = monic.below.iter().enumerate().map(|(k, a)| scaled(a, k + 1)).collect();
        let above: Vec<Ball> = monic.above.iter().enumerate().map(|(k, b)| scaled(b, k)).collect();
        let steps =
            (0..=depth).map(|level| exponential(&companion(&below, level as i64 + 1, bits))).collect::<Vec<_>>();
        let rounded = Rounded::of(&steps[0], bits);
        Some(Motion {
            bits,
            direct: above[0].clone(),
            first: at_infinity(&above, &below).split_off(1),
            integral: integral_of_window(&below, n)?,
            powers: Powers::of(rounded.clone())?,
            steps,
            rounded,
        })
    }

    /// Blocks of steps until the bracket is narrow, or more bits and halvings are needed.
    fn bracket(&self, digits: usize) -> Result<AbsoluteSum, Lacking> {
        let accuracy = Integer::from(10).pow(digits as u64 + 2);
        let block = self.powers.exponent.saturating_mul(LEAST_BLOCK.div_ceil(self.powers.exponent));
        let mut walk = Walk::new(self);
        loop {
            let mut windows = Integer::ZERO;
            for _ in 0..block {
                windows += walk.step();
            }
            // On a step of half a unit `|g|` is at most twice the norm of the window.
            let tail = self.powers.after(&windows);
            let [lower, upper] = [&walk.lower, &(&walk.upper + &tail)].map(Clone::clone);
            if &(&upper - &lower) * &accuracy <= lower {
                return Ok(found(&lower, &upper, self.bits, walk.count));
            }
            let asked = lower.div_mod_floor(&accuracy).0;
            let open = &walk.upper - &walk.lower;
            if &tail << 1 <= asked || tail <= open {
                let lacking = open.bit_length().saturating_sub(asked.bit_length()) + 3;
                return Err(Lacking(if asked.is_zero() { lacking.max(self.bits) } else { lacking }));
            }
        }
    }
}

/// The exponent of two by which frequencies are divided: then the moduli of the coefficients have a sum of at most 1.
fn unit_of_time(below: &[Ball], bits: u64) -> i64 {
    let more = below.len().next_power_of_two().ilog2() as i64;
    let exponent = |(k, a): (usize, &Ball)| {
        let length = a.magnitude_units().bit_length() as i64 - bits as i64 + more;
        -(-length).div_euclid(k as i64 + 1)
    };
    below.iter().enumerate().map(exponent).max().unwrap_or(0)
}

/// The companion matrix, divided by a power of two.
fn companion(below: &[Ball], halvings: i64, bits: u64) -> BallMatrix {
    let n = below.len();
    let one = Ball::from_integer(&Integer::ONE, bits);
    BallMatrix::from_fn(n, |i, j| {
        if i + 1 == n {
            below[n - 1 - j].neg().shifted(-halvings)
        } else if j == i + 1 {
            one.shifted(-halvings)
        } else {
            Ball::zero(bits)
        }
    })
}

/// The first coefficients of `N/D` at infinity: what is direct, and the derivatives of the response at the time 0.
fn at_infinity(above: &[Ball], below: &[Ball]) -> Vec<Ball> {
    let mut out: Vec<Ball> = Vec::with_capacity(above.len());
    for (k, b) in above.iter().enumerate() {
        let past = below.iter().zip(out.iter().rev());
        let value = past.fold(b.clone(), |sum, (a, h)| sum.sub(&a.mul(h)));
        debug_assert_eq!(out.len(), k);
        out.push(value);
    }
    out
}

/// From `g^(n) + a_1 g^(n-1) + ... + a_n g = 0`; `None` where `a_n` may be 0.
fn integral_of_window(below: &[Ball], n: usize) -> Option<Vec<Ball>> {
    let Some(last) = below.last() else { return Some(Vec::new()) };
    let one = Ball::from_integer(&Integer::ONE, last.bits());
    let factor = |k: usize| if k + 1 == n { &one } else { &below[n - 2 - k] };
    (0..n).map(|k| Some(factor(k).div(last)?.neg())).collect()
}

/// Windows one after another, and the integral so far.
struct Walk<'m> {
    motion: &'m Motion,
    /// The window, in units of `2^-bits`.
    window: Vec<Integer>,
    /// The greatest further input of the recursion by rounding and errors.
    input: Integer,
    lower: Integer,
    upper: Integer,
    count: u64,
}

impl<'m> Walk<'m> {
    fn new(motion: &'m Motion) -> Self {
        Walk {
            window: motion.first.iter().map(Ball::middle_units).collect(),
            input: motion.first.iter().map(Ball::width_units).max().unwrap_or(Integer::ZERO),
            lower: motion.direct.least_magnitude_units(),
            upper: motion.direct.magnitude_units(),
            count: 0,
            motion,
        }
    }

    /// Goes on by a step: a bound of the norm of the window before it.
    fn step(&mut self) -> Integer {
        let (before, norm) = (self.enclosed(), self.norm());
        let matrix = &self.motion.rounded;
        self.window = matrix.times(&self.window);
        self.input = (&self.input).max(&matrix.error_of(&norm)).clone();
        let after = self.enclosed();
        let piece = self.motion.piece(0, &before, &after);
        self.lower += piece.0;
        self.upper += piece.1;
        self.count += 1;
        norm + self.error()
    }

    fn norm(&self) -> Integer {
        self.window.iter().map(Integer::abs).max().unwrap_or(Integer::ZERO)
    }

    /// A bound of the error of a window: the greatest input times the sum of the norms of all powers.
    fn error(&self) -> Integer {
        ceiling_shift(&(&self.input * &self.motion.powers.total), self.motion.powers.bits)
    }

    fn enclosed(&self) -> Vec<Ball> {
        let error = self.error();
        self.window.iter().map(|x| Ball::from_units(x - &error, x + &error, self.motion.bits)).collect()
    }
}

impl Motion {
    /// Bounds of the integral of `|g|` over `2^-(level + 1)` units of time, from the windows before and after.
    fn piece(&self, level: usize, before: &[Ball], after: &[Ball]) -> (Integer, Integer) {
        let Some(start) = before.first() else { return (Integer::ZERO, Integer::ZERO) };
        let reach = self.reach(level, before);
        if start.least_magnitude_units() > reach {
            let difference = self.difference(before, after);
            return (difference.least_magnitude_units(), difference.magnitude_units());
        }
        // Where the error of the window hides the sign, halving does not tell it.
        if level + 1 == self.steps.len() || reach <= start.width_units() << 2 {
            let most = start.magnitude_units() + reach;
            return (Integer::ZERO, -(-most >> (level as u64 + 1)));
        }
        let middle = times(&self.steps[level + 1], before);
        let (first, second) = (self.piece(level + 1, before, &middle), self.piece(level + 1, &middle, after));
        (first.0 + second.0, first.1 + second.1)
    }

    /// How far `g` is from its value at the start on a piece: Taylor's polynomial, and a rest with `|g^(n)| <= ||w|| <= 2 ||w(start)||`.
    fn reach(&self, level: usize, window: &[Ball]) -> Integer {
        let by = level as u64 + 1;
        let sizes: Vec<Integer> = window.iter().map(Ball::magnitude_units).collect();
        let rest = sizes.iter().max().expect("a window of an order above 0") << 1;
        // By Horner's scheme: h/1 (|w_1| + h/2 (|w_2| + ... + h/n rest)), each quotient rounded up.
        (1..=sizes.len()).rev().fold(rest, |sum, k| {
            let sum = if k == sizes.len() { sum } else { sum + &sizes[k] };
            -(-sum).div_mod_floor(&(Integer::from(k as u64) << by)).0
        })
    }

    /// The integral of `g` between two windows.
    fn difference(&self, before: &[Ball], after: &[Ball]) -> Ball {
        let terms = self.integral.iter().zip(before.iter().zip(after));
        terms.fold(Ball::zero(self.bits), |sum, (c, (x, y))| sum.add(&c.mul(&y.sub(x))))
    }
}

fn times(matrix: &BallMatrix, window: &[Ball]) -> Vec<Ball> {
    let n = window.len();
    checkpoint(2 * (n * n) as u64);
    let entry = |i: usize| {
        let terms = window.iter().enumerate().map(|(j, x)| matrix.at(i, j).mul(x));
        terms.reduce(|sum, x| sum.add(&x)).expect("an order above 0")
    };
    (0..n).map(entry).collect()
}
