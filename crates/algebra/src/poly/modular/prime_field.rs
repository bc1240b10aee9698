//! Arithmetic modulo a prime that fits a machine word.

use crate::limits::checkpoint;
use std::sync::{Mutex, PoisonError};

/// The integers modulo an odd prime `p < 2^62`.
///
/// Residues are held in the form of Montgomery, `x 2^64 mod p`, in `0..p` ([Montgomery1985](crate::bibliography#montgomery1985)); all
/// methods take and return that form unless they say otherwise. The two spare bits of the word let
/// up to four products be added up before they are reduced.
///
/// ```
/// use jurist_algebra::poly::modular::prime_field::PrimeField;
/// let f = PrimeField::new(101).unwrap();
/// let third = f.inverse(f.residue(3));
/// assert_eq!(f.integer(f.mul(third, f.residue(6))), 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PrimeField {
    prime: u64,
    /// `p^-1 mod 2^64`.
    inverse: u64,
    /// `2^64 mod p`, the form of 1.
    one: u64,
    /// `2^128 mod p`.
    square: u64,
}

impl PrimeField {
    /// The bound on primes.
    pub const LIMIT: u64 = 1 << 62;

    /// The field of a prime; `None` when `p` is not an odd prime below [`PrimeField::LIMIT`].
    pub fn new(p: u64) -> Option<PrimeField> {
        (p > 2 && p < Self::LIMIT && is_prime(p)).then(|| PrimeField::of_odd(p))
    }

    /// For an odd number, prime or not: all but inverses.
    fn of_odd(p: u64) -> PrimeField {
        // Newton's iteration doubles the number of correct bits: 3, 6, ..., 96.
        let mut inverse = p;
        for _ in 0..5 {
            inverse = inverse.wrapping_mul(2u64.wrapping_sub(p.wrapping_mul(inverse)));
        }
        let one = ((1u128 << 64) % u128::from(p)) as u64;
        let square = (u128::from(one) * u128::from(one) % u128::from(p)) as u64;
        PrimeField { prime: p, inverse, one, square }
    }

    /// The prime.
    pub fn prime(&self) -> u64 {
        self.prime
    }

    /// The form of 1.
    #[inline]
    pub fn one(&self) -> u64 {
        self.one
    }

    /// `x / 2^64 mod p` for `x < 2^64 p`.
    #[inline]
    pub fn reduce(&self, x: u128) -> u64 {
        let m = (x as u64).wrapping_mul(self.inverse);
        let high = (x >> 64) as u64;
        let below = ((u128::from(m) * u128::from(self.prime)) >> 64) as u64;
        let (difference, borrow) = high.overflowing_sub(below);
        if borrow { difference.wrapping_add(self.prime) } else { difference }
    }

    /// The form of an integer.
    #[inline]
    pub fn residue(&self, x: u64) -> u64 {
        self.reduce(u128::from(x) * u128::from(self.square))
    }

    /// The integer in `0..p` whose form this is.
    #[inline]
    pub fn integer(&self, x: u64) -> u64 {
        self.reduce(u128::from(x))
    }

    /// `x + y`.
    #[inline]
    pub fn add(&self, x: u64, y: u64) -> u64 {
        let sum = x + y;
        if sum >= self.prime { sum - self.prime } else { sum }
    }

    /// `x - y`.
    #[inline]
    pub fn sub(&self, x: u64, y: u64) -> u64 {
        let (difference, borrow) = x.overflowing_sub(y);
        if borrow { difference.wrapping_add(self.prime) } else { difference }
    }

    /// `-x`.
    #[inline]
    pub fn negated(&self, x: u64) -> u64 {
        if x == 0 { 0 } else { self.prime - x }
    }

    /// `x y`.
    #[inline]
    pub fn mul(&self, x: u64, y: u64) -> u64 {
        self.reduce(u128::from(x) * u128::from(y))
    }

    /// `x y + u v`, reduced once.
    #[inline]
    pub fn mul_add_mul(&self, x: u64, y: u64, u: u64, v: u64) -> u64 {
        self.reduce(u128::from(x) * u128::from(y) + u128::from(u) * u128::from(v))
    }

    /// `sum x_i y_i`, reduced once.
    #[inline]
    pub fn dot(&self, x: &[u64], y: &[u64]) -> u64 {
        self.sum_of_products(x.iter().zip(y))
    }

    /// `sum x_i y_(n - 1 - i)`, reduced once.
    #[inline]
    pub fn dot_backwards(&self, x: &[u64], y: &[u64]) -> u64 {
        self.sum_of_products(x.iter().rev().zip(y))
    }

    #[inline]
    fn sum_of_products<'a>(&self, pairs: impl Iterator<Item = (&'a u64, &'a u64)>) -> u64 {
        let limit = u128::from(self.prime) << 64;
        let mut sum = 0u128;
        for (&a, &b) in pairs {
            // Both terms are below 2^64 p / 4 and 2^64 p.
            sum += u128::from(a) * u128::from(b);
            if sum >= limit {
                sum -= limit;
            }
        }
        self.reduce(sum)
    }

    /// `x^e`.
    pub fn power(&self, x: u64, mut e: u64) -> u64 {
        let (mut result, mut base) = (self.one, x);
        while e > 0 {
            if e & 1 == 1 {
                result = self.mul(result, base);
            }
            base = self.mul(base, base);
            e >>= 1;
        }
        result
    }

    /// `1 / x`; 0 for 0. By Euclid's algorithm, about half the time of a power.
    pub fn inverse(&self, x: u64) -> u64 {
        // x times `factor` is `small` modulo p in every step, for magnitudes at most p.
        let (mut large, mut small) = (self.prime, x);
        let (mut before, mut factor) = (0i64, 1i64);
        while small > 1 {
            let quotient = large / small;
            (large, small) = (small, large - quotient * small);
            (before, factor) = (factor, before - quotient as i64 * factor);
        }
        if small == 0 {
            return 0;
        }
        // The plain inverse of the form is a^-1 2^-64; two products with 2^128 give a^-1 2^64.
        let plain = if factor < 0 { self.prime.wrapping_add_signed(factor) } else { factor as u64 };
        self.mul(self.mul(plain, self.square), self.square)
    }

    /// Replaces non-zero elements by their inverses, zero by zero, with one inversion and three
    /// products for each.
    pub fn invert_all(&self, elements: &mut [u64]) {
        let mut prefix = Vec::with_capacity(elements.len());
        let mut product = self.one;
        for &x in elements.iter() {
            prefix.push(product);
            if x != 0 {
                product = self.mul(product, x);
            }
        }
        let mut inverse = self.inverse(product);
        for (x, before) in elements.iter_mut().zip(prefix).rev() {
            if *x != 0 {
                let rest = self.mul(inverse, *x);
                *x = self.mul(inverse, before);
                inverse = rest;
            }
        }
    }
}

/// Whether `n` is prime, by the test of Miller and Rabin for the first twelve primes as bases: a
/// proof for every `n < 2^64` ([SorensonWebster2015](crate::bibliography#sorensonwebster2015)).
pub fn is_prime(n: u64) -> bool {
    const BASES: [u64; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    if n < 2 {
        return false;
    }
    for p in BASES {
        if n.is_multiple_of(p) {
            return n == p;
        }
    }
    if n < PrimeField::LIMIT {
        // The arithmetic of Montgomery asks only for an odd modulus.
        let f = PrimeField::of_odd(n);
        let bases = BASES.map(|p| f.residue(p));
        return passes_miller_rabin(n, &bases, f.one, |x, y| f.mul(x, y));
    }
    passes_miller_rabin(n, &BASES, 1, |x, y| (u128::from(x) * u128::from(y) % u128::from(n)) as u64)
}

/// Whether no base proves that an odd number is composite; `one` and the bases are in the form
/// that `product` multiplies.
fn passes_miller_rabin(n: u64, bases: &[u64], one: u64, product: impl Fn(u64, u64) -> u64) -> bool {
    let minus_one = n - one;
    let twos = (n - 1).trailing_zeros();
    let odd = (n - 1) >> twos;
    let witnesses_composite = |base: u64| {
        let (mut x, mut square, mut e) = (one, base, odd);
        while e > 0 {
            if e & 1 == 1 {
                x = product(x, square);
            }
            square = product(square, square);
            e >>= 1;
        }
        if x == one || x == minus_one {
            return false;
        }
        for _ in 1..twos {
            x = product(x, x);
            if x == minus_one {
                return false;
            }
        }
        true
    };
    !bases.iter().any(|&base| witnesses_composite(base))
}

/// The fields of the `count` greatest primes below 2^62, in descending order. They are found once
/// and kept.
pub fn largest_primes(count: usize) -> Vec<PrimeField> {
    static FOUND: Mutex<Vec<PrimeField>> = Mutex::new(Vec::new());
    let mut found = FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    while found.len() < count {
        // What is found stays found when the search is left.
        checkpoint(1000);
        let mut p = found.last().map_or(PrimeField::LIMIT - 1, |f| f.prime - 2);
        while !is_prime(p) {
            p -= 2;
        }
        found.push(PrimeField::of_odd(p));
    }
    found[..count].to_vec()
}

/// How many of the [`largest_primes`] have a product above `2^bits`: each exceeds `2^61.99` for
/// any number of them that memory could hold.
pub fn primes_for_bits(bits: u64) -> usize {
    usize::try_from(bits.saturating_mul(100) / 6199 + 1).expect("the primes fit into memory")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn by_trial_division(n: u64) -> bool {
        n >= 2 && (2..).take_while(|d| d * d <= n).all(|d| !n.is_multiple_of(d))
    }

    #[test]
    fn small_primes_and_strong_pseudoprimes() {
        for n in 0..20_000 {
            assert_eq!(is_prime(n), by_trial_division(n), "{n}");
        }
        // Pseudoprimes to the bases 2; 2, 3, 5, 7; the first nine; the twelve primes up to 37 hold below 2^64.
        for n in [2047, 3_215_031_751, 3_825_123_056_546_413_051, 561, 1_373_653, 341_550_071_728_321] {
            assert!(!is_prime(n), "{n}");
        }
        assert!(is_prime((1 << 61) - 1) && is_prime(18_446_744_073_709_551_557));
        assert_eq!(PrimeField::new(2), None);
        assert_eq!(PrimeField::new(91), None);
        assert_eq!(PrimeField::new(18_446_744_073_709_551_557), None);
    }

    #[test]
    fn the_greatest_primes_below_the_limit() {
        let primes = largest_primes(20);
        let expected: Vec<u64> = (0..).map(|k| PrimeField::LIMIT - 1 - k).filter(|&n| is_prime(n)).take(20).collect();
        assert_eq!(primes.iter().map(PrimeField::prime).collect::<Vec<_>>(), expected);
        assert_eq!(largest_primes(3), primes[..3]);
        // 2^61.99 < p.
        assert!(expected.iter().all(|&p| p > PrimeField::LIMIT - (PrimeField::LIMIT >> 8)));
        assert_eq!((primes_for_bits(0), primes_for_bits(61), primes_for_bits(62)), (1, 1, 2));
    }

    #[test]
    fn the_laws_of_a_field() {
        for f in [PrimeField::new(3).unwrap(), PrimeField::new(10_007).unwrap(), largest_primes(1)[0]] {
            let p = f.prime();
            let mut state = 5u64;
            for _ in 0..500 {
                let mut next = || {
                    state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    match state >> 61 {
                        0 => p - 1,
                        1 => 0,
                        _ => (state >> 1) % p,
                    }
                };
                let (a, b, c, d) = (next(), next(), next(), next());
                let (x, y, z, w) = (f.residue(a), f.residue(b), f.residue(c), f.residue(d));
                let wide = |v: u128| (v % u128::from(p)) as u64;
                let (ab, cd) = (u128::from(a) * u128::from(b), u128::from(c) * u128::from(d));
                assert_eq!(f.integer(f.mul(x, y)), wide(ab));
                assert_eq!(f.integer(f.mul_add_mul(x, y, z, w)), wide(ab + cd));
                assert_eq!(
                    f.integer(f.dot(&[x, z, x, z, x, z], &[y, w, y, w, y, w])),
                    wide(3 * ((ab + cd) % u128::from(p)))
                );
                assert_eq!(f.integer(f.add(x, y)), wide(u128::from(a) + u128::from(b)));
                assert_eq!(f.add(f.sub(x, y), y), x);
                assert_eq!(f.add(f.negated(x), x), 0);
                assert_eq!(f.mul(x, f.inverse(x)), if x == 0 { 0 } else { f.one() });
                assert_eq!(f.inverse(x), f.power(x, p - 2));
                let mut all = [x, y, 0, z];
                f.invert_all(&mut all);
                assert_eq!(all, [f.inverse(x), f.inverse(y), 0, f.inverse(z)]);
            }
        }
    }
}
