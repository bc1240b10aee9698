//! Products of polynomials as products of integers ([Kronecker1882](crate::bibliography#kronecker1882)).

use crate::limits::{checkpoint, claim};
use crate::number::Integer;

/// The polynomials are multiplied as integers when the shorter one has at least this many
/// coefficients; not yet measured, chosen low enough to matter and high enough not to harm.
pub const KRONECKER_MIN_LENGTH: usize = 16;

/// The schoolbook product of two non-empty coefficient lists: `O(n m)` products, the reference.
pub fn convolve_schoolbook(a: &[Integer], b: &[Integer]) -> Vec<Integer> {
    claim(((a.len() + b.len()) * size_of::<Integer>()) as u64);
    let mut out = vec![Integer::ZERO; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        checkpoint(2 * b.len() as u64);
        for (j, y) in b.iter().enumerate() {
            out[i + j].add_mul_assign(x, y);
        }
    }
    out
}

/// The product of two non-empty coefficient lists through one product of integers: each
/// polynomial is evaluated at a power of `2^64` so large that the coefficients of the product can
/// be read off.
///
/// A coefficient of the product is below `min(n, m) 2^(bits(a) + bits(b))` in magnitude; one bit
/// more keeps the sign.
pub fn convolve_kronecker(a: &[Integer], b: &[Integer]) -> Vec<Integer> {
    let height = |p: &[Integer]| p.iter().map(Integer::bit_length).max().unwrap_or(0);
    let terms = u64::from(usize::BITS - a.len().min(b.len()).leading_zeros());
    let bits = height(a) + height(b) + terms + 1;
    let width = usize::try_from(bits.div_ceil(64)).expect("a coefficient fits into memory");
    checkpoint(((a.len() + b.len()) * (width / 2 + 8)) as u64);
    // Both parts of each factor, and the product.
    claim(24 * (a.len() + b.len()) as u64 * width as u64);
    let product = &pack(a, width) * &pack(b, width);
    unpack(&product, width, a.len() + b.len() - 1)
}

/// The value at `2^(64 width)`: the positive part less the negative part.
fn pack(p: &[Integer], width: usize) -> Integer {
    let mut positive = vec![0u64; p.len() * width];
    let mut negative = vec![0u64; p.len() * width];
    for (k, c) in p.iter().enumerate() {
        let part = if c.is_negative() { &mut negative } else { &mut positive };
        for (place, limb) in part[k * width..].iter_mut().zip(c.limbs()) {
            *place = limb;
        }
    }
    Integer::from_limbs(positive) - Integer::from_limbs(negative)
}

/// The coefficients of magnitude below `2^(64 width - 1)` of a value at `2^(64 width)`.
fn unpack(value: &Integer, width: usize, length: usize) -> Vec<Integer> {
    let negative = value.is_negative();
    let mut limbs = value.limbs();
    limbs.resize(length * width, 0);
    let bits = 64 * width as u64;
    let modulus = &Integer::ONE << bits;
    let mut out = Vec::with_capacity(length);
    // A negative coefficient has borrowed one from the next digit.
    let mut borrowed = false;
    for digit in limbs.chunks(width) {
        let mut c = Integer::from_limbs(digit.to_vec());
        if borrowed {
            c += Integer::ONE;
        }
        borrowed = c.bit_length() >= bits;
        if borrowed {
            c -= &modulus;
        }
        out.push(if negative { -c } else { c });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of varied size, sign and sparsity from a small generator of pseudorandom numbers.
    fn coefficients(length: usize, max_bits: u64, state: &mut u64) -> Vec<Integer> {
        let mut next = || {
            *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            *state >> 16
        };
        let mut one = || {
            let size = next() % (max_bits + 1);
            let mut c = Integer::ZERO;
            while c.bit_length() < size {
                c = &(&c << 48) + &Integer::from(next() | 1);
            }
            let c = &c >> (c.bit_length() - size);
            if next() % 2 == 0 { -c } else { c }
        };
        (0..length).map(|_| one()).collect()
    }

    #[test]
    fn kronecker_is_the_schoolbook() {
        let mut state = 1;
        for round in 0..300 {
            let a = coefficients(1 + round % 37, [3, 31, 64, 200, 700][round % 5], &mut state);
            let b = coefficients(1 + round % 23, [64, 2, 127, 300][round % 4], &mut state);
            assert_eq!(convolve_kronecker(&a, &b), convolve_schoolbook(&a, &b), "round {round}");
        }
    }

    #[test]
    fn extreme_coefficients() {
        for bits in [1, 30, 31, 32, 62, 63, 64, 65, 128] {
            let top = &(&Integer::ONE << bits) - &Integer::ONE;
            for (x, y) in [(top.clone(), top.clone()), (-&top, top.clone()), (-&top, -&top)] {
                for n in [1, 2, 15, 16, 17, 64] {
                    let (a, b) = (vec![x.clone(); n], vec![y.clone(); 16]);
                    assert_eq!(convolve_kronecker(&a, &b), convolve_schoolbook(&a, &b), "{bits} bits, {n} terms");
                }
            }
        }
        let zero = vec![Integer::ZERO; 3];
        assert_eq!(convolve_kronecker(&zero, &zero), vec![Integer::ZERO; 5]);
    }
}
