//! Values of a polynomial on the unit interval in fixed point, with a bound of the error.

use super::limbs::{add_assign, is_negative, negate, within, write_shifted};
use crate::number::Integer;
use std::collections::BTreeMap;

/// `p(2^scale t)` for `t` from 0 to 1, by Horner's rule in as many limbs as the sign needs.
pub struct Evaluator {
    coeffs: Vec<Integer>,
    scale: i64,
    /// The bits of the largest coefficient of `p(2^scale t)`.
    top: i64,
    /// Free bits above: the sum of all terms cannot overflow.
    headroom: u64,
    /// The coefficients by width.
    tables: BTreeMap<usize, Vec<u64>>,
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
    pub fn new(coeffs: &[Integer], scale: i64) -> Evaluator {
        let bits = |(i, c): (usize, &Integer)| c.bit_length() as i64 + scale * i as i64;
        let top = coeffs.iter().enumerate().filter(|(_, c)| !c.is_zero()).map(bits).max().unwrap_or(0);
        let headroom = u64::from(usize::BITS - coeffs.len().leading_zeros()) + 2;
        Evaluator { coeffs: coeffs.to_vec(), scale, top, headroom, tables: BTreeMap::new() }
    }

    /// Whether the value at `numerator / 2^bits`, in the unit interval, is positive; it must not be 0.
    pub fn positive_at(&mut self, numerator: &Integer, bits: u64) -> bool {
        let mut limbs = 2;
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
        let value = match limbs {
            2 => horner::<2>(table, x),
            3 => horner::<3>(table, x),
            4 => horner::<4>(table, x),
            5 => horner::<5>(table, x),
            6 => horner::<6>(table, x),
            7 => horner::<7>(table, x),
            8 => horner::<8>(table, x),
            _ => horner_any(table, limbs, x),
        };
        // A step adds a unit for the coefficient, a unit for the argument, and x.len() + 1 for the product.
        Value { limbs: value, error: (n as u64 + 1) * (x.len() as u64 + 3) }
    }
}

fn horner<const L: usize>(table: &[u64], x: &[u64]) -> Vec<u64> {
    let mut acc = [0u64; L];
    let mut scratch = vec![0u64; L + x.len()];
    for c in table.as_chunks::<L>().0.iter().rev() {
        product_high(&mut acc, x, &mut scratch);
        add_assign(&mut acc, c);
    }
    acc.to_vec()
}

fn horner_any(table: &[u64], limbs: usize, x: &[u64]) -> Vec<u64> {
    let mut acc = vec![0u64; limbs];
    let mut scratch = vec![0u64; limbs + x.len()];
    for c in table.chunks_exact(limbs).rev() {
        product_high(&mut acc, x, &mut scratch);
        add_assign(&mut acc, c);
    }
    acc
}

/// `acc = acc x / 2^(64 x.len())` for a signed `acc` not shorter than `x`, which is a fraction of 1;
/// less than `x.len() + 1` units wrong.
#[inline(always)]
fn product_high(acc: &mut [u64], x: &[u64], scratch: &mut [u64]) {
    let (n, m) = (acc.len(), x.len());
    let negative = is_negative(acc);
    if negative {
        negate(acc);
    }
    if m == 1 {
        let mut carry = 0;
        for a in acc.iter_mut() {
            let t = u128::from(*a) * u128::from(x[0]) + u128::from(carry);
            (*a, carry) = (carry_low(t), (t >> 64) as u64);
        }
        // The lowest limb is the fraction that goes.
        acc.copy_within(1.., 0);
        acc[n - 1] = carry;
    } else {
        scratch.fill(0);
        for (j, &y) in x.iter().enumerate() {
            // Products below the limb before the last dropped one hardly matter.
            let skip = (m - 1).saturating_sub(j + 1).min(n);
            let mut carry = 0;
            for i in skip..n {
                let t = u128::from(acc[i]) * u128::from(y) + u128::from(scratch[i + j]) + u128::from(carry);
                (scratch[i + j], carry) = (carry_low(t), (t >> 64) as u64);
            }
            scratch[j + n] = carry;
        }
        acc.copy_from_slice(&scratch[m..m + n]);
    }
    if negative {
        negate(acc);
    }
}

#[inline(always)]
fn carry_low(t: u128) -> u64 {
    t as u64
}
