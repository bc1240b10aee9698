//! An irrational root between two dyadic numbers, and its refinement.

use crate::limits::checkpoint;
use crate::number::{Integer, Rational, Sign};
use crate::poly::UniPoly;
use std::cmp::Ordering;

/// The only root of a polynomial between `lo / 2^bits` and `hi / 2^bits`; neither end is a root,
/// the root is irrational and the signs at the ends are opposite.
#[derive(Clone, Debug)]
pub(crate) struct Bracket {
    pub lo: Integer,
    pub hi: Integer,
    pub bits: u64,
    /// Whether the polynomial is positive at `hi`.
    pub rising: bool,
}

/// `2^(k n) p(a / 2^k)` for `n` the degree: an integer of the sign of `p(a / 2^k)`.
pub(crate) fn eval_dyadic(p: &UniPoly, a: &Integer, k: u64) -> Integer {
    checkpoint(8 * p.coeffs().len() as u64);
    let mut acc = Integer::ZERO;
    for (i, c) in p.coeffs().iter().rev().enumerate() {
        acc = &acc * a;
        if !c.is_zero() {
            acc += &(c << (k * i as u64));
        }
    }
    acc
}

impl Bracket {
    pub fn lo(&self) -> Rational {
        Rational::dyadic(&self.lo, self.bits)
    }

    pub fn hi(&self) -> Rational {
        Rational::dyadic(&self.hi, self.bits)
    }

    /// Whether the width is at most `2^-target`.
    fn narrow_enough(&self, target: i64) -> bool {
        self.bits_missing(target) == 0
    }

    /// How many halvings lead to a width of at most `2^-target`.
    pub fn bits_missing(&self, target: i64) -> u64 {
        let width = &self.hi - &self.lo;
        // width <= 2^ceil(log2 width).
        let exact = width.trailing_zeros() == Some(width.bit_length() - 1);
        let log = width.bit_length() as i64 - i64::from(exact);
        u64::try_from(log - self.bits as i64 + target).unwrap_or(0)
    }

    /// The reference: quadratic interval refinement [Abbott2014](crate::bibliography#abbott2014) in exact integers. The secant predicts a cell of a grid of `2^m` cells, the signs at its ends
    /// certify it; `m` doubles on success and halves on failure.
    pub fn refine_exact(&mut self, p: &UniPoly, target: i64) {
        if self.narrow_enough(target) {
            return;
        }
        let n = p.coeffs().len() as u64 - 1;
        let mut at_lo = eval_dyadic(p, &self.lo, self.bits);
        let mut at_hi = eval_dyadic(p, &self.hi, self.bits);
        let mut m = 1u64;
        loop {
            let missing = self.bits_missing(target);
            if missing == 0 {
                return;
            }
            m = m.min(missing).max(1);
            let cells = &Integer::ONE << m;
            let guess = secant(&at_lo, &at_hi, m, &cells);
            let width = &self.hi - &self.lo;
            let bits = self.bits + m;
            let lo = &self.lo << m;
            let left_sign = if self.rising { Ordering::Less } else { Ordering::Greater };
            let at = |j: &Integer| {
                let a = &lo + &(&width * j);
                let value = eval_dyadic(p, &a, bits);
                (a, value)
            };
            let (a, value) = at(&guess);
            debug_assert!(value.sign().is_ne(), "the root is irrational");
            let right = value.sign() == left_sign;
            let neighbour = if right { &guess + &Integer::ONE } else { &guess - &Integer::ONE };
            let outside = neighbour.is_zero() || neighbour == cells;
            let (b, other) = if outside {
                let (end, value) = if right { (&self.hi, &at_hi) } else { (&self.lo, &at_lo) };
                (end << m, value << (m * n))
            } else {
                at(&neighbour)
            };
            let success = (other.sign() == left_sign) != right;
            self.bits = bits;
            if success {
                (self.lo, at_lo, self.hi, at_hi) = if right { (a, value, b, other) } else { (b, other, a, value) };
                m *= 2;
            } else {
                // The root is beyond the neighbour: keep that side.
                if right {
                    (self.lo, at_lo) = (b, other);
                    (self.hi, at_hi) = (&self.hi << m, &at_hi << (m * n));
                } else {
                    (self.hi, at_hi) = (b, other);
                    (self.lo, at_lo) = (&self.lo << m, &at_lo << (m * n));
                }
                m /= 2;
            }
        }
    }

    /// One halving.
    pub fn halve(&mut self, p: &UniPoly) {
        let middle = &self.lo + &self.hi;
        let sign = eval_dyadic(p, &middle, self.bits + 1).sign();
        self.bits += 1;
        let positive = sign == Sign::Greater;
        (self.lo, self.hi) = if positive == self.rising { (&self.lo << 1, middle) } else { (middle, &self.hi << 1) };
    }
}

/// The grid point, from 1 to `cells - 1`, nearest to where the chord crosses zero.
pub(super) fn secant(at_lo: &Integer, at_hi: &Integer, m: u64, cells: &Integer) -> Integer {
    let (a, b) = (at_lo.abs(), at_hi.abs());
    // Leading bits are enough for a guess.
    let drop = a.bit_length().max(b.bit_length()).saturating_sub(m + 64);
    let (a, b) = (&a >> drop, &b >> drop);
    let sum = &a + &b;
    let guess = (&(&a << (m + 1)) + &sum).div_mod_floor(&(&sum << 1)).0;
    let last = cells - &Integer::ONE;
    guess.max(Integer::ONE).min(last)
}
