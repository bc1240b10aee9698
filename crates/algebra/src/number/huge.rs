//! Operations on integers of many thousand digits in pieces, so that a budget that ends in between is heeded.
//!
//! A product, a quotient, a divisor or a conversion of numbers of a million digits takes from a tenth of a second to
//! several seconds, and the library of big numbers cannot be interrupted. So where a budget holds on the thread, large
//! operands are cut until a piece takes a few milliseconds. Each function is given the size of a piece in bits, which
//! the tests make small.

use crate::limits::checkpoint;
use malachite_base::num::arithmetic::traits::{DivMod, Gcd, ModPowerOf2, UnsignedAbs};
use malachite_base::num::basic::traits::{One, Zero};
use malachite_base::num::logic::traits::SignificantBits;
use malachite_nz::integer::Integer;
use malachite_nz::natural::Natural;
use std::mem::swap;

/// Products and quotients up to this size (of the smaller operand) take about 3 ms.
pub(super) const PRODUCT_BITS: u64 = 1 << 19;

/// Greatest common divisors up to this size take about 5 ms.
pub(super) const GCD_BITS: u64 = 1 << 16;

/// Conversions from and to decimal digits up to this size take about 5 ms.
pub(super) const DIGITS_BITS: u64 = 1 << 18;

/// Below so many bits the steps of the Euclidean algorithm are computed word by word.
const WORDWISE_BITS: u64 = 1 << 12;

/// Units of work of a product of numbers of `n` and `m` limbs: by the schoolbook, or nearly linear.
pub(super) fn work_of_product(n: u64, m: u64) -> u64 {
    (n.saturating_mul(m) / 16).min(40 * n.max(m)) + 1
}

fn limbs(x: &Natural) -> u64 {
    x.limb_count()
}

/// The product: Karatsuba's three products of halves where the factors are alike.
pub(super) fn product(a: &Natural, b: &Natural, piece: u64) -> Natural {
    let (a, b) = if a.significant_bits() >= b.significant_bits() { (a, b) } else { (b, a) };
    let (n, m) = (a.significant_bits(), b.significant_bits());
    if m <= 1 || (m <= piece && n <= 4 * piece) || n <= piece {
        checkpoint(work_of_product(limbs(a), limbs(b)));
        return a * b;
    }
    let half = n / 2;
    let (low_a, high_a) = (a.mod_power_of_2(half), a >> half);
    if m <= half {
        return product(&low_a, b, piece) + (product(&high_a, b, piece) << half);
    }
    let (low_b, high_b) = (b.mod_power_of_2(half), b >> half);
    let low = product(&low_a, &low_b, piece);
    let high = product(&high_a, &high_b, piece);
    let middle = product(&(low_a + high_a), &(low_b + high_b), piece) - &low - &high;
    low + (middle << half) + (high << (2 * half))
}

/// The product with the sign.
fn product_signed(a: &Integer, b: &Integer, piece: u64) -> Integer {
    let magnitude = product(a.unsigned_abs_ref(), b.unsigned_abs_ref(), piece);
    Integer::from_sign_and_abs((*a < 0) == (*b < 0), magnitude)
}

/// The power, by squaring.
pub(super) fn power(x: &Natural, exponent: u64, piece: u64) -> Natural {
    let mut result = Natural::ONE;
    for k in (0..u64::BITS - exponent.leading_zeros()).rev() {
        result = product(&result, &result, piece);
        if exponent >> k & 1 == 1 {
            result = product(&result, x, piece);
        }
    }
    result
}

/// Quotient and remainder, by halves of the quotient [BurnikelZiegler1998](crate::bibliography#burnikelziegler1998).
///
/// # Panics
/// When `b` is zero.
pub(super) fn div_rem(a: &Natural, b: &Natural, piece: u64) -> (Natural, Natural) {
    if a < b {
        return (Natural::ZERO, a.clone());
    }
    let (n, m) = (a.significant_bits(), b.significant_bits());
    let k = n - m + 1;
    if n <= piece || (k.min(m) <= piece / 2 && n <= 4 * piece) || m <= 64 {
        checkpoint(2 * work_of_product(k / 64 + 1, limbs(b)));
        return a.div_mod(b);
    }
    if m > k + 64 {
        // The upper bits give the quotient, or up to a few more.
        let cut = m - k - 32;
        let (mut q, upper) = div_rem(&(a >> cut), &(b >> cut), piece);
        let rest = (upper << cut) + a.mod_power_of_2(cut);
        let mut rest = Integer::from(rest) - Integer::from(product(&q, &b.mod_power_of_2(cut), piece));
        while rest < 0 {
            q -= Natural::ONE;
            rest += Integer::from(b);
        }
        return (q, rest.unsigned_abs());
    }
    let half = k / 2;
    let (high, rest) = div_rem(&(a >> half), b, piece);
    let (low, rest) = div_rem(&((rest << half) + a.mod_power_of_2(half)), b, piece);
    ((high << half) + low, rest)
}

/// A matrix of determinant 1 or -1.
struct Unimodular([[Integer; 2]; 2]);

impl Unimodular {
    fn identity() -> Unimodular {
        Unimodular([[Integer::ONE, Integer::ZERO], [Integer::ZERO, Integer::ONE]])
    }

    /// The images of two numbers, made positive and put in descending order; the matrix is changed so that it gives
    /// them.
    fn apply(&mut self, x: &Natural, y: &Natural, piece: u64) -> (Natural, Natural) {
        let (a, b) = (Integer::from(x), Integer::from(y));
        let mut images = [Natural::ZERO, Natural::ZERO];
        for (row, image) in self.0.iter_mut().zip(&mut images) {
            let value = product_signed(&row[0], &a, piece) + product_signed(&row[1], &b, piece);
            if value < 0 {
                row.iter_mut().for_each(|c| *c = -&*c);
            }
            *image = value.unsigned_abs();
        }
        let [mut x, mut y] = images;
        if x < y {
            swap(&mut x, &mut y);
            self.0.swap(0, 1);
        }
        (x, y)
    }

    /// This one after another one.
    fn after(&self, first: &Unimodular, piece: u64) -> Unimodular {
        let entry = |i: usize, j: usize| {
            product_signed(&self.0[i][0], &first.0[0][j], piece) + product_signed(&self.0[i][1], &first.0[1][j], piece)
        };
        Unimodular([[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]])
    }

    /// A division step: `(x, y)` becomes `(y, x - q y)`.
    fn divide(&mut self, q: Natural, piece: u64) {
        let q = Integer::from(q);
        let [first, second] = &self.0;
        let next = [0, 1].map(|j| &first[j] - product_signed(&q, &second[j], piece));
        self.0 = [second.clone(), next];
    }
}

/// The greatest common divisor.
///
/// The quotients of Euclid's algorithm are those of the upper bits for a while; the matrix that they make shortens
/// both numbers. Any matrix of determinant 1 or -1 keeps the divisor, so that a quotient that the upper bits give wrong
/// does no harm; where a matrix does not shorten, a division does.
pub(super) fn gcd(a: &Natural, b: &Natural, piece: u64) -> Natural {
    let (mut x, mut y) = if a >= b { (a.clone(), b.clone()) } else { (b.clone(), a.clone()) };
    loop {
        if y == 0 {
            return x;
        }
        let (n, m) = (x.significant_bits(), y.significant_bits());
        if n <= piece {
            checkpoint(work_of_gcd(n / 64 + 1, m / 64 + 1));
            return x.gcd(y);
        }
        if n - m < n / 8 && m > WORDWISE_BITS {
            let cut = n / 2;
            let mut matrix = shortening(&(&x >> cut), &(&y >> cut), piece);
            let (shorter, other) = matrix.apply(&x, &y, piece);
            if shorter.significant_bits() < n {
                (x, y) = (shorter, other);
                continue;
            }
        }
        let rest = div_rem(&x, &y, piece).1;
        (x, y) = (y, rest);
    }
}

/// Units of work of a greatest common divisor of numbers of `n` and `m` limbs.
pub(super) fn work_of_gcd(n: u64, m: u64) -> u64 {
    (n.saturating_mul(m) / 4).min(400 * n.max(m)) + 1
}

/// A matrix that makes two numbers, `x >= y`, about half as long.
fn shortening(x: &Natural, y: &Natural, piece: u64) -> Unimodular {
    let n = x.significant_bits();
    let enough = n / 2 + 2;
    let (mut x, mut y) = (x.clone(), y.clone());
    let mut whole = Unimodular::identity();
    while y.significant_bits() > enough {
        let (now, other) = (x.significant_bits(), y.significant_bits());
        checkpoint(now / 64 + 1);
        if now <= WORDWISE_BITS || now - other > 32 {
            let mut step = by_words(&x, &y);
            let (shorter, rest) = step.apply(&x, &y, piece);
            if shorter.significant_bits() + rest.significant_bits() < now + other {
                (x, y, whole) = (shorter, rest, step.after(&whole, piece));
                continue;
            }
        } else {
            // Twice as many upper bits as are to go, at most half of all.
            let kept = (2 * (now - enough)).min(n / 2).max(64).min(now);
            let cut = now - kept;
            if kept < now {
                let mut step = shortening(&(&x >> cut), &(&y >> cut), piece);
                let (shorter, rest) = step.apply(&x, &y, piece);
                if shorter.significant_bits() + rest.significant_bits() < now + other {
                    (x, y, whole) = (shorter, rest, step.after(&whole, piece));
                    continue;
                }
            }
        }
        let (q, rest) = div_rem(&x, &y, piece);
        whole.divide(q, piece);
        (x, y) = (y, rest);
    }
    whole
}

/// The matrix of the quotients that the upper 62 bits give (Lehmer's idea).
fn by_words(x: &Natural, y: &Natural) -> Unimodular {
    let cut = x.significant_bits().saturating_sub(62);
    let word = |x: &Natural| i64::try_from(&(x >> cut)).expect("62 bits");
    let (mut a, mut b) = (word(x), word(y));
    let mut rows = [[1i64, 0], [0, 1]];
    // Half of the bits of the words are good for quotients.
    while b >= 1 << 31 {
        let q = a / b;
        (a, b) = (b, a - q * b);
        rows = [rows[1], [rows[0][0] - q * rows[1][0], rows[0][1] - q * rows[1][1]]];
    }
    Unimodular(rows.map(|row| row.map(Integer::from)))
}

/// The decimal digits, without a sign.
pub(super) fn to_digits(x: &Natural, piece: u64) -> String {
    // 10^(first 2^k) for k = 0, 1, ... below x.
    let first = (piece / 4).max(1);
    let mut powers = vec![power(&Natural::from(10u32), first, piece)];
    while let Some(last) = powers.last().filter(|p| 2 * p.significant_bits() <= x.significant_bits() + 2) {
        let next = product(last, last, piece);
        powers.push(next);
    }
    let mut out = String::new();
    push_digits(x, &powers, first as usize, piece, &mut out);
    let zeros = out.bytes().take_while(|&b| b == b'0').count().min(out.len() - 1);
    out.split_off(zeros)
}

/// Appends `2 first 2^(powers - 1)` digits, or more if the number has more.
fn push_digits(x: &Natural, powers: &[Natural], first: usize, piece: u64, out: &mut String) {
    match powers.split_last() {
        Some((power, smaller)) => {
            let (high, low) = div_rem(x, power, piece);
            push_digits(&high, smaller, first, piece, out);
            push_digits(&low, smaller, first, piece, out);
        }
        None => {
            checkpoint(10 * limbs(x) + 1);
            let digits = x.to_string();
            // Not by a format's width, which ends at 65535.
            out.extend(std::iter::repeat_n('0', first.saturating_sub(digits.len())));
            out.push_str(&digits);
        }
    }
}

/// The number with these digits; there is nothing else in the text.
pub(super) fn from_digits(digits: &str, piece: u64) -> Natural {
    let piece_digits = (piece / 4).max(1) as usize;
    if digits.len() <= piece_digits {
        checkpoint(digits.len() as u64 + 1);
        return digits.parse().expect("decimal digits");
    }
    // The lower part a piece times a power of two long, so that few powers are computed.
    let mut low = piece_digits;
    let mut powers = vec![power(&Natural::from(10u32), low as u64, piece)];
    while 2 * low < digits.len() {
        let next = product(&powers[powers.len() - 1], &powers[powers.len() - 1], piece);
        powers.push(next);
        low *= 2;
    }
    join_digits(digits, &powers, low, piece)
}

/// The value of digits; the last power is that of 10 to `low`.
fn join_digits(digits: &str, powers: &[Natural], low: usize, piece: u64) -> Natural {
    let Some((power, smaller)) = powers.split_last() else {
        checkpoint(digits.len() as u64 + 1);
        return digits.parse().expect("decimal digits");
    };
    if digits.len() <= low {
        return join_digits(digits, smaller, low / 2, piece);
    }
    let (high, rest) = digits.split_at(digits.len() - low);
    let high = join_digits(high, smaller, low / 2, piece);
    product(&high, power, piece) + join_digits(rest, smaller, low / 2, piece)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::{Budget, Exhausted};

    /// A number of about so many bits, with runs of zeros and ones.
    fn number(bits: u64, state: &mut u64) -> Natural {
        let mut next = || {
            *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            *state >> 7
        };
        let limbs = (0..bits / 64 + 1).map(|_| match next() % 4 {
            0 => 0,
            1 => u64::MAX,
            _ => next() ^ next() << 32,
        });
        Natural::from_owned_limbs_asc(limbs.collect()).mod_power_of_2(bits)
    }

    const SIZES: [u64; 9] = [0, 1, 63, 64, 200, 500, 1000, 3000, 9000];

    #[test]
    fn pieces_give_the_same_as_the_whole() {
        let mut state = 1;
        for n in SIZES {
            for m in SIZES {
                for piece in [64, 100, 700] {
                    let (a, b) = (number(n, &mut state), number(m, &mut state));
                    let c = &a * &b + number(m / 2, &mut state);
                    assert_eq!(product(&a, &b, piece), &a * &b, "{n} {m} {piece}");
                    if b != 0 {
                        for x in [&a, &c] {
                            assert_eq!(div_rem(x, &b, piece), x.div_mod(&b), "{n} {m} {piece}");
                        }
                    }
                }
            }
            let a = number(n, &mut state);
            assert_eq!(power(&a, 5, 100), &a * &a * &a * &a * &a);
            for piece in [64, 700] {
                assert_eq!(to_digits(&a, piece), a.to_string(), "{n} {piece}");
                assert_eq!(from_digits(&a.to_string(), piece), a, "{n} {piece}");
            }
        }
        assert_eq!(from_digits("000123", 8), 123);
    }

    #[test]
    fn divisors_in_pieces() {
        let mut state = 7;
        for n in [0, 64, 1000, 9000, 15_000] {
            for m in [0, 64, 1000, 9000, 15_000] {
                let (a, b, c) = (number(n, &mut state), number(m, &mut state), number(n / 3, &mut state));
                for (a, b) in [(&a * &c, &b * &c), (a.clone(), &a * &b), (&a * &a, &a * &b + &a), (a, b)] {
                    for piece in [64, 3000] {
                        assert_eq!(gcd(&a, &b, piece), (&a).gcd(&b), "{n} {m} {piece}");
                    }
                }
            }
        }
        // The longest sequence of quotients.
        let (mut a, mut b) = (Natural::ONE, Natural::ONE);
        for _ in 0..12_000 {
            (a, b) = (&a + &b, a);
        }
        assert_eq!(gcd(&a, &b, 64), 1);
    }

    /// The pieces that a budget asks for are of more digits than a format can be wide.
    #[test]
    fn digits_in_pieces_of_the_usual_size() {
        for zeros in [65_536, 66_000, 140_000, 300_000] {
            let x = power(&Natural::from(10u32), zeros, PRODUCT_BITS) + Natural::from(7u32);
            let text = to_digits(&x, DIGITS_BITS);
            assert_eq!(text, format!("1{}7", "0".repeat(zeros as usize - 1)));
            assert_eq!(from_digits(&text, DIGITS_BITS), x);
        }
    }

    #[test]
    fn a_budget_ends_each_operation() {
        let mut state = 3;
        let (a, b) = (number(1 << 17, &mut state), number(1 << 17, &mut state));
        let ended = |work: &dyn Fn()| {
            let end: Result<(), Exhausted> = Budget::with_work(100).enter(work);
            assert!(end.is_err());
        };
        ended(&|| drop(product(&a, &b, 1000)));
        ended(&|| drop(div_rem(&(&a * &b), &b, 1000)));
        ended(&|| drop(gcd(&a, &b, 1000)));
        ended(&|| drop(power(&a, 9, 1000)));
        ended(&|| drop(to_digits(&a, 1000)));
        let digits = "7".repeat(100_000);
        ended(&|| drop(from_digits(&digits, 1000)));
    }
}
