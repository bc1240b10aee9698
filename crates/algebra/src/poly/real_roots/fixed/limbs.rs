//! Two's complement numbers of a fixed count of 64-bit limbs, least significant first, laid out one
//! after the other in flat arrays.

use crate::number::Integer;

/// The sum, modulo `2^(64 L)`.
#[inline(always)]
pub fn add<const L: usize>(a: &[u64; L], b: &[u64; L]) -> [u64; L] {
    let mut out = [0; L];
    let mut carry = false;
    for k in 0..L {
        let (sum, first) = a[k].overflowing_add(b[k]);
        let (sum, second) = sum.overflowing_add(u64::from(carry));
        out[k] = sum;
        carry = first | second;
    }
    out
}

/// `a += b`, modulo `2^64` to the common length.
pub fn add_assign(a: &mut [u64], b: &[u64]) {
    let mut carry = false;
    for (x, y) in a.iter_mut().zip(b) {
        let (sum, first) = x.overflowing_add(*y);
        let (sum, second) = sum.overflowing_add(u64::from(carry));
        *x = sum;
        carry = first | second;
    }
}

/// `floor(a / 2^s)` for `s < 64`.
#[inline(always)]
pub fn shift_right<const L: usize>(a: &[u64; L], s: u32) -> [u64; L] {
    if s == 0 {
        return *a;
    }
    let mut out = [0; L];
    for k in 0..L - 1 {
        out[k] = a[k] >> s | a[k + 1] << (64 - s);
    }
    out[L - 1] = (a[L - 1] as i64 >> s) as u64;
    out
}

/// `a = floor(a / 2^s)` for `s < 64`.
pub fn shift_right_assign(a: &mut [u64], s: u32) {
    if s == 0 {
        return;
    }
    let top = a.len() - 1;
    for k in 0..top {
        a[k] = a[k] >> s | a[k + 1] << (64 - s);
    }
    a[top] = (a[top] as i64 >> s) as u64;
}

/// Whether the number is below zero.
#[inline(always)]
pub fn is_negative(a: &[u64]) -> bool {
    a.last().is_some_and(|top| (*top as i64) < 0)
}

/// `a = -a`.
pub fn negate(a: &mut [u64]) {
    let mut carry = true;
    for x in a {
        let (sum, over) = (!*x).overflowing_add(u64::from(carry));
        *x = sum;
        carry = over;
    }
}

/// The bits of the largest magnitude among numbers of `limbs` limbs, up to one for a negative power
/// of two.
pub fn max_bits(flat: &[u64], limbs: usize) -> u64 {
    let mut top = limbs;
    while top > 0 {
        let seen = flat.chunks_exact(limbs).fold(0, |acc, c| acc | (c[top - 1] ^ (c[limbs - 1] as i64 >> 63) as u64));
        if seen != 0 {
            return 64 * (top as u64 - 1) + u64::from(64 - seen.leading_zeros());
        }
        top -= 1;
    }
    // Zeros and minus ones.
    u64::from(flat.iter().any(|&x| x != 0))
}

/// Whether `|a| <= error`.
#[inline(always)]
pub fn within(a: &[u64], error: u64) -> bool {
    let (low, over) = a[0].overflowing_add(error);
    let mut carry = over;
    let mut rest = 0;
    for &x in &a[1..] {
        let (sum, over) = x.overflowing_add(u64::from(carry));
        rest |= sum;
        carry = over;
    }
    if a.len() == 1 {
        // One limb: the sum stays far from the limits of 64 bits.
        return low <= 2 * error;
    }
    rest == 0 && low <= 2 * error
}

/// `floor(a 2^-shift)` for every number, from `from` to `to` limbs; a negative shift multiplies.
/// The results must fit.
pub fn rescale(flat: &[u64], from: usize, to: usize, shift: i64) -> Vec<u64> {
    if from == to && shift == 0 {
        return flat.to_vec();
    }
    let (words, bits) = (shift.div_euclid(64), shift.rem_euclid(64) as u32);
    let mut out = Vec::with_capacity(flat.len() / from * to);
    for a in flat.chunks_exact(from) {
        let sign = (a[from - 1] as i64 >> 63) as u64;
        let word = |k: i64| match usize::try_from(k) {
            Err(_) => 0,
            Ok(k) => a.get(k).copied().unwrap_or(sign),
        };
        for k in 0..to as i64 {
            let low = word(k + words);
            out.push(if bits == 0 { low } else { low >> bits | word(k + words + 1) << (64 - bits) });
        }
    }
    out
}

/// `value 2^shift`, cut off towards zero, into zeroed limbs; it must fit.
pub fn write_shifted(value: &Integer, shift: i64, out: &mut [u64]) {
    let magnitude = value.as_limbs();
    let (words, bits) = (shift.div_euclid(64), shift.rem_euclid(64) as u32);
    let word = |k: i64| usize::try_from(k).ok().and_then(|k| magnitude.get(k).copied()).unwrap_or(0);
    for (k, place) in out.iter_mut().enumerate() {
        let k = k as i64 - words;
        *place = if bits == 0 { word(k) } else { word(k) << bits | word(k - 1) >> (64 - bits) };
    }
    if value.is_negative() {
        negate(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_survive_the_trip() {
        for text in ["0", "1", "-1", "18446744073709551616", "-340282366920938463463374607431768211457"] {
            let n = Integer::from_decimal(text).unwrap();
            for shift in [0i64, 1, 63, 64, 130] {
                let mut out = vec![0; 6];
                write_shifted(&n, shift, &mut out);
                assert_eq!(Integer::from_twos_complement(&out), &n << shift as u64);
                let back = rescale(&out, 6, 4, shift);
                assert_eq!(Integer::from_twos_complement(&back), n);
                let up = rescale(&back, 4, 6, -shift);
                assert_eq!(up, out);
            }
        }
    }

    #[test]
    fn small_is_told_from_large() {
        let flat = |n: i64, limbs: usize| {
            let mut out = vec![0; limbs];
            write_shifted(&Integer::from(n), 0, &mut out);
            out
        };
        for limbs in 1..4 {
            for error in [0u64, 1, 5, 1 << 40] {
                for n in [0i64, 1, -1, 5, -5, 6, -6, 1 << 40, -(1 << 40), (1 << 40) + 1, -(1 << 40) - 1] {
                    assert_eq!(within(&flat(n, limbs), error), n.unsigned_abs() <= error, "{n} {error} {limbs}");
                }
            }
        }
        assert!(!within(&[0, 1], 7) && !within(&[0, u64::MAX], 7));
    }

    #[test]
    fn bits_of_the_largest() {
        assert_eq!(max_bits(&[5, 0, u64::MAX, u64::MAX], 2), 3);
        assert_eq!(max_bits(&[0, 1], 2), 65);
        assert_eq!(max_bits(&[0, 0], 2), 0);
        assert_eq!(max_bits(&[u64::MAX, u64::MAX], 2), 1);
    }
}
