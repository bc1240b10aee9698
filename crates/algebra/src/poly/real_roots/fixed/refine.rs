//! Narrow brackets by quadratic interval refinement with values in fixed point.

use super::super::bounds::positive_root_bound_from_top;
use super::super::bracket::{Bracket, secant};
use super::evaluate::{Evaluator, Value};
use super::newton::leap;
use crate::number::{Integer, Sign};
use crate::poly::UniPoly;
use std::collections::BTreeMap;
use std::rc::Rc;

/// A polynomial seen on the positive axis: signs and brackets there.
pub struct Half {
    /// The coefficients from the constant term up.
    pub coeffs: Rc<[Integer]>,
    /// Evaluators of `p(2^k t)` by `k`.
    evaluators: BTreeMap<i64, Evaluator>,
    /// No positive root is at or below `2^least`.
    least: Option<i64>,
}

/// The magnitude of a value, in the units of a width.
struct Size {
    magnitude: Integer,
    limbs: usize,
}

impl Half {
    pub fn new(poly: UniPoly) -> Half {
        Half { coeffs: poly.into_coeffs().into(), evaluators: BTreeMap::new(), least: None }
    }

    fn evaluator(&mut self, k: i64) -> &mut Evaluator {
        self.evaluators.entry(k).or_insert_with(|| Evaluator::new(Rc::clone(&self.coeffs), k))
    }

    /// Whether the polynomial is positive at `x / 2^bits > 0`, which is no root.
    pub fn positive_at(&mut self, x: &Integer, bits: u64) -> bool {
        let length = x.bit_length();
        self.evaluator(length as i64 - bits as i64).positive_at(x, length)
    }

    /// Narrows a bracket of positive ends (the lower one may be 0) to a width of at most
    /// `2^-relative` times the root.
    pub fn refine(&mut self, b: &mut Bracket, relative: u64) {
        self.narrow_to_binade(b);
        let exponent = b.lo.bit_length() as i64 - 1 - b.bits as i64;
        self.narrow(b, relative as i64 - exponent, 2);
    }

    /// Moves the ends until they are less than a factor of 4 apart and positive.
    fn narrow_to_binade(&mut self, b: &mut Bracket) {
        if b.lo.is_zero() {
            let coeffs = &self.coeffs;
            let least = *self.least.get_or_insert_with(|| -positive_root_bound_from_top(coeffs.iter()).unwrap_or(0));
            // The bound of the reciprocals is strict.
            align(b, least);
            b.lo = &Integer::ONE << (least + b.bits as i64) as u64;
        }
        loop {
            let bits = b.bits as i64;
            let low = b.lo.bit_length() as i64 - 1 - bits;
            let high = b.hi.bit_length() as i64 - bits;
            if high - low <= 2 {
                return;
            }
            let middle = (low + high).div_euclid(2);
            align(b, middle);
            let x = &Integer::ONE << (middle + b.bits as i64) as u64;
            if self.positive_at(&x, b.bits) == b.rising {
                b.hi = x;
            } else {
                b.lo = x;
            }
        }
    }

    /// Narrows a bracket of positive ends to a width of at most `2^-target` [Abbott2014](crate::bibliography#abbott2014): the secant
    /// predicts one of `2^m` parts, signs at its ends certify it, `m` doubles on success. The caller
    /// guesses the first `m`.
    pub fn narrow(&mut self, b: &mut Bracket, target: i64, first: u64) {
        if b.bits_missing(target) == 0 {
            return;
        }
        let k = b.hi.bit_length() as i64 - b.bits as i64;
        let evaluator = self.evaluator(k);
        leap(evaluator, k, b, target);
        if b.bits_missing(target) == 0 {
            return;
        }
        let mut qir = Qir { evaluator, k, limbs: 2 };
        let mut at_lo = qir.rough(&b.lo, b.bits);
        let mut at_hi = qir.rough(&b.hi, b.bits);
        let mut m = first;
        loop {
            let missing = b.bits_missing(target);
            if missing == 0 {
                return;
            }
            m = m.min(missing).max(1);
            qir.plan(&at_lo, &at_hi, m);
            let cells = &Integer::ONE << m;
            let guess = predicted(&at_lo, &at_hi, m, &cells);
            let width = &b.hi - &b.lo;
            let bits = b.bits + m;
            let lo = &b.lo << m;
            let point = |j: &Integer| &lo + &(&width * j);
            let a = point(&guess);
            let (positive, value) = qir.sure(&a, bits);
            let right = positive != b.rising;
            let neighbour = if right { &guess + &Integer::ONE } else { &guess - &Integer::ONE };
            let outside = neighbour.is_zero() || neighbour == cells;
            let (c, beyond, other) = if outside {
                let (end, size) = if right { (&b.hi, &at_hi) } else { (&b.lo, &at_lo) };
                (end << m, right == b.rising, size.copy())
            } else {
                let c = point(&neighbour);
                let (positive, value) = qir.sure(&c, bits);
                (c, positive, value)
            };
            b.bits = bits;
            if beyond != positive {
                (b.lo, at_lo, b.hi, at_hi) = if right { (a, value, c, other) } else { (c, other, a, value) };
                m *= 2;
            } else if right {
                // The root is beyond the neighbour: that side stays.
                (b.lo, at_lo, b.hi) = (c, other, &b.hi << m);
                m /= 2;
            } else {
                (b.hi, at_hi, b.lo) = (c, other, lo);
                m /= 2;
            }
        }
    }
}

/// Gives a bracket so many bits that `2^exponent` is a multiple of its unit.
fn align(b: &mut Bracket, exponent: i64) {
    let more = u64::try_from(-exponent - b.bits as i64).unwrap_or(0);
    if more > 0 {
        (b.lo, b.hi, b.bits) = (&b.lo << more, &b.hi << more, b.bits + more);
    }
}

struct Qir<'a> {
    evaluator: &'a mut Evaluator,
    k: i64,
    limbs: usize,
}

impl Qir<'_> {
    fn value(&mut self, x: &Integer, bits: u64) -> Value {
        let bits = bits as i64 + self.k;
        self.evaluator.value(x, bits as u64, self.limbs)
    }

    /// The size of a value whose sign is known otherwise: 0 when it is too small to tell.
    fn rough(&mut self, x: &Integer, bits: u64) -> Size {
        let value = self.value(x, bits);
        let magnitude = if value.positive().is_some() { value.magnitude() } else { Integer::ZERO };
        Size { magnitude, limbs: self.limbs }
    }

    /// Whether the value is positive, and its size.
    fn sure(&mut self, x: &Integer, bits: u64) -> (bool, Size) {
        loop {
            let value = self.value(x, bits);
            if let Some(positive) = value.positive() {
                return (positive, Size { magnitude: value.magnitude(), limbs: self.limbs });
            }
            self.limbs += self.limbs.div_ceil(3);
        }
    }

    /// Chooses a width that most likely tells the signs at the ends of the predicted part.
    fn plan(&mut self, a: &Size, b: &Size, m: u64) {
        let height = |s: &Size| s.magnitude.bit_length() as i64 - 64 * s.limbs as i64;
        let largest = [a, b].into_iter().filter(|s| !s.magnitude.is_zero()).map(height).max();
        if let Some(height) = largest {
            self.limbs = ((m as i64 - height + 20).max(1) as u64).div_ceil(64).max(2) as usize;
        }
    }
}

impl Size {
    fn copy(&self) -> Size {
        Size { magnitude: self.magnitude.clone(), limbs: self.limbs }
    }
}

/// Where the chord crosses zero, as a grid point from 1 to `cells - 1`.
fn predicted(a: &Size, b: &Size, m: u64, cells: &Integer) -> Integer {
    let limbs = a.limbs.max(b.limbs);
    let aligned = |s: &Size| &s.magnitude << (64 * (limbs - s.limbs) as u64);
    let (a, b) = (aligned(a), aligned(b));
    if a.is_zero() && b.is_zero() { &Integer::ONE << (m - 1) } else { secant(&a, &b, m, cells) }
}

/// Narrows a bracket that does not hold zero to a width of at most `2^-target`.
pub fn refine_bracket(p: &UniPoly, b: &mut Bracket, target: i64) {
    debug_assert!(b.lo.sign() == Sign::Greater || b.hi.sign() == Sign::Less, "zero is not in the bracket");
    if b.lo.is_negative() {
        let mut mirrored = Bracket { lo: -&b.hi, hi: -&b.lo, bits: b.bits, rising: !b.rising };
        Half::new(p.negated_argument()).narrow(&mut mirrored, target, 2);
        *b = Bracket { lo: -mirrored.hi, hi: -mirrored.lo, bits: mirrored.bits, rising: b.rising };
    } else {
        Half::new(p.clone()).narrow(b, target, 2);
    }
}
