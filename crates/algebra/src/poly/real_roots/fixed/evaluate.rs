//! Values of a polynomial on the unit interval in fixed point, with a bound of the error.

use super::limbs::{add, add_assign, is_negative, within, write_shifted};
use crate::limits::checkpoint;
use crate::number::Integer;
use std::collections::BTreeMap;
use std::rc::Rc;

/// `p(2^scale t)` for `t` from 0 to 1, by Horner's rule in as many limbs as the sign needs.
pub struct Evaluator {
    coeffs: Rc<[Integer]>,
    scale: i64,
    /// The bits of the largest coefficient of `p(2^scale t)`.
    top: i64,
    /// Free bits above: the sum of all terms cannot overflow.
    headroom: u64,
    /// The coefficients by width.
    tables: BTreeMap<usize, Vec<u64>>,
    /// The coefficients in one word each, with `headroom` more free bits above for the derivative.
    words: Vec<i64>,
}

/// A value times `2^(64 limbs - unit)` up to `error` units.
pub struct Value {
    pub limbs: Vec<u64>,
    pub error: u64,
}

impl Value {
    /// Whether the value is positive, if its sign is certain.
    pub fn positive(&self) -> Option<bool> {
        (!within(&self.limbs, self.error)).then(|| !is_negative(&self.limbs))
    }

    /// The magnitude in units.
    pub fn magnitude(&self) -> Integer {
        Integer::from_twos_complement(&self.limbs).abs()
    }
}

impl Evaluator {
    pub fn new(coeffs: Rc<[Integer]>, scale: i64) -> Evaluator {
        let bits = |(i, c): (usize, &Integer)| c.bit_length() as i64 + scale * i as i64;
        let top = coeffs.iter().enumerate().filter(|(_, c)| !c.is_zero()).map(bits).max().unwrap_or(0);
        let headroom = u64::from(usize::BITS - coeffs.len().leading_zeros()) + 2;
        Evaluator { coeffs, scale, top, headroom, tables: BTreeMap::new(), words: Vec::new() }
    }

    /// Free bits of a word beyond those of a limb of [`value`](Self::value).
    pub fn word_extra(&self) -> i64 {
        self.headroom as i64
    }

    /// The coefficients of `p(2^scale t)` in one word each, rounded down: neither the value nor the
    /// derivative on the unit interval overflows.
    pub fn word_table(&mut self) -> &[i64] {
        if self.words.is_empty() {
            let up = 64 - 2 * self.headroom as i64 - self.top;
            let word = |(i, c): (usize, &Integer)| {
                let mut place = [0];
                write_shifted(c, up + self.scale * i as i64, &mut place);
                place[0] as i64
            };
            self.words = self.coeffs.iter().enumerate().map(word).collect();
        }
        &self.words
    }

    /// Whether the value at `numerator / 2^bits`, in the unit interval, is positive; it must not be 0.
    pub fn positive_at(&mut self, numerator: &Integer, bits: u64) -> bool {
        self.positive_from(numerator, bits, 2)
    }

    /// The same, with a guess of the limbs that tell it.
    pub fn positive_from(&mut self, numerator: &Integer, bits: u64, mut limbs: usize) -> bool {
        loop {
            if let Some(positive) = self.value(numerator, bits, limbs).positive() {
                return positive;
            }
            limbs += limbs.div_ceil(2);
        }
    }

    /// The value at `numerator / 2^bits`, in the unit interval, in at least two limbs.
    pub fn value(&mut self, numerator: &Integer, bits: u64, limbs: usize) -> Value {
        let n = self.coeffs.len() - 1;
        let (coeffs, scale) = (&self.coeffs, self.scale);
        let up = 64 * limbs as i64 - self.headroom as i64 - self.top;
        let table = self.tables.entry(limbs).or_insert_with(|| {
            let mut table = vec![0; coeffs.len() * limbs];
            for (i, (c, place)) in coeffs.iter().zip(table.chunks_exact_mut(limbs)).enumerate() {
                if !c.is_zero() {
                    write_shifted(c, up + scale * i as i64, place);
                }
            }
            table
        });
        if numerator.bit_length() > bits {
            // The argument is 1.
            let mut sum = vec![0; limbs];
            table.chunks_exact(limbs).for_each(|c| add_assign(&mut sum, c));
            return Value { limbs: sum, error: n as u64 + 1 };
        }
        let mut x = vec![0; (bits.div_ceil(64) as usize).clamp(1, limbs)];
        write_shifted(numerator, 64 * x.len() as i64 - bits as i64, &mut x);
        // Trailing zeros cost time.
        let zeros = x.iter().take_while(|&&l| l == 0).count().min(x.len() - 1);
        let x = &x[zeros..];
        macro_rules! by_width {
            ($($l:literal),*) => {
                match limbs {
                    $($l => horner::<$l>(table, x),)*
                    _ => horner_any(table, limbs, x),
                }
            };
        }
        let value = by_width!(2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 20, 24, 32);
        // A step adds a unit for the coefficient, a unit for the argument, and 2 x.len() + 1 for the product.
        Value { limbs: value, error: (n as u64 + 1) * (2 * x.len() as u64 + 3) }
    }
}

fn horner<const L: usize>(table: &[u64], x: &[u64]) -> Vec<u64> {
    macro_rules! by_width {
        ($($m:literal),*) => {
            match x.len() {
                $($m if $m <= L => horner_by::<L, $m>(table, x.try_into().expect("the width matched")),)*
                _ => horner_any(table, L, x),
            }
        };
    }
    by_width!(1, 2, 3, 4, 5, 6, 7, 8)
}

fn horner_by<const L: usize, const M: usize>(table: &[u64], x: &[u64; M]) -> Vec<u64> {
    checkpoint((table.len() * M / 16 + 1) as u64);
    let mut acc = [0u64; L];
    for c in table.as_chunks::<L>().0.iter().rev() {
        acc = add(&product_high(&acc, x), c);
    }
    acc.to_vec()
}

/// `a x / 2^(64 M)`, at most `M + 1` units below, for a signed `a` not shorter than `x`, a fraction of 1.
#[inline(always)]
fn product_high<const L: usize, const M: usize>(a: &[u64; L], x: &[u64; M]) -> [u64; L] {
    let mut t = [0u64; L];
    for (j, &y) in x.iter().enumerate() {
        // t = (t + a y) / 2^64 for unsigned a, without the products that are below a unit in the end.
        let skip = M - 1 - j;
        let mut carry = 0;
        for i in 0..L {
            if i < skip {
                continue;
            }
            let v = u128::from(a[i]) * u128::from(y) + u128::from(t[i]) + u128::from(carry);
            if i > 0 {
                t[i - 1] = v as u64;
            }
            carry = (v >> 64) as u64;
        }
        t[L - 1] = carry;
    }
    // A negative a is its unsigned value less 2^(64 L).
    let mask = if is_negative(a) { u64::MAX } else { 0 };
    let mut borrow = false;
    for (place, &y) in t[L - M.min(L)..].iter_mut().zip(x) {
        let (difference, first) = place.overflowing_sub(y & mask);
        let (difference, second) = difference.overflowing_sub(u64::from(borrow));
        *place = difference;
        borrow = first | second;
    }
    t
}

fn horner_any(table: &[u64], limbs: usize, x: &[u64]) -> Vec<u64> {
    let mut acc = vec![0u64; limbs];
    let mut scratch = vec![0u64; limbs + x.len()];
    for c in table.chunks_exact(limbs).rev() {
        checkpoint((limbs * x.len() / 16 + 1) as u64);
        product_high_any(&mut acc, x, &mut scratch);
        add_assign(&mut acc, c);
    }
    acc
}

/// The same for any width, less than two units below.
fn product_high_any(acc: &mut [u64], x: &[u64], scratch: &mut [u64]) {
    let (n, m) = (acc.len(), x.len());
    scratch.fill(0);
    for (j, &y) in x.iter().enumerate() {
        // Products two limbs below the last that stays hardly matter.
        let skip = m.saturating_sub(j + 2).min(n);
        let mut carry = 0;
        for (&a, place) in acc[skip..].iter().zip(&mut scratch[skip + j..]) {
            let t = u128::from(a) * u128::from(y) + u128::from(*place) + u128::from(carry);
            (*place, carry) = (t as u64, (t >> 64) as u64);
        }
        scratch[j + n] = carry;
    }
    if is_negative(acc) {
        subtract(&mut scratch[n..], x);
    }
    acc.copy_from_slice(&scratch[m..m + n]);
}

/// `a -= b`, of one length.
#[inline(always)]
fn subtract(a: &mut [u64], b: &[u64]) {
    let mut borrow = false;
    for (x, y) in a.iter_mut().zip(b) {
        let (difference, first) = x.overflowing_sub(*y);
        let (difference, second) = difference.overflowing_sub(u64::from(borrow));
        *x = difference;
        borrow = first | second;
    }
}
