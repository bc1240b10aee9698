//! A polynomial's values at all residues modulo a small prime at once.

use super::small_residues::power;
use crate::limits::checkpoint;

/// Below the end sums of as many products of residues as there are residues fit a word; below the start Horner's rule at
/// each residue is as fast: all roots of Chebyshev's polynomial of degree 50 took 205 us with the transform, 200 us without.
const PRIMES: std::ops::Range<u64> = 100..1 << 20;

/// The greatest quotient of the factors of `p - 1`: beyond, Horner's rule at each residue is hardly slower.
const MOST_UNEVEN: usize = 16;

/// The residues of a prime but 0 as powers of one of them, in whose order a Fourier transform takes two steps.
///
/// With `g` a primitive root, `p - 1 = s t` and `j = t j1 + j2`, the value at `g^k` is the sum over `j2 < t` of `g^(k j2)` times the
/// sum over `j1 < s` of `c_j g^(t j1 k)`, which depends on `k` modulo `s` only: `(p - 1) (s + t)` products in all
/// ([CooleyTukey1965](crate::bibliography#cooleytukey1965)).
pub(super) struct AllResidues {
    prime: u64,
    /// `g^0, g^1, ...`
    powers: Vec<u32>,
    /// The divisor `s` of `p - 1`.
    outer: usize,
}

impl AllResidues {
    /// `None` when the prime is too small or too large, or `p - 1` has no two factors of about the same size.
    pub fn new(prime: u64) -> Option<AllResidues> {
        if !PRIMES.contains(&prime) {
            return None;
        }
        let order = prime as usize - 1;
        let divisor = |d: &usize| order.is_multiple_of(*d);
        let outer = (1..=order.isqrt().max(1)).rev().find(divisor).expect("1 divides");
        if order / outer > MOST_UNEVEN * outer {
            return None;
        }
        let mut powers = Vec::with_capacity(order);
        let g = primitive_root(prime);
        let mut x = 1;
        for _ in 0..order {
            powers.push(x as u32);
            x = x * g % prime;
        }
        Some(AllResidues { prime, powers, outer })
    }

    /// The residues in the order of the values: 0 last.
    pub fn residues(&self) -> impl Iterator<Item = u64> {
        self.powers.iter().map(|&x| u64::from(x)).chain([0])
    }

    /// The powers of `g^exponent`, for an exponent below the order.
    fn powers_by(&self, exponent: usize) -> impl Iterator<Item = u32> {
        let next = move |k: &usize| {
            Some(if k + exponent < self.powers.len() { k + exponent } else { k + exponent - self.powers.len() })
        };
        std::iter::successors(Some(0), next).map(|k| self.powers[k])
    }

    /// The values of the polynomial with such coefficients, all below the prime, at all residues.
    pub fn values(&self, coefficients: &[u64]) -> Vec<u32> {
        let (s, order) = (self.outer, self.powers.len());
        let t = order / s;
        checkpoint((order * (s + t) / 16) as u64 + 4);
        // x^(p - 1) = 1.
        let mut folded = vec![0u32; order];
        for chunk in coefficients.chunks(order) {
            for (sum, &c) in folded.iter_mut().zip(chunk) {
                *sum = ((u64::from(*sum) + c) % self.prime) as u32;
            }
        }
        let reduce = |sum: &u64| (sum % self.prime) as u32;
        let mut values = vec![0u32; order + 1];
        // Row m of the second step: g^(s m j2), m and j2 below t.
        let step: Vec<u32> = (0..t).flat_map(|m| self.powers_by(s * m).take(t)).collect();
        let mut sums = vec![0u64; t];
        let mut twisted = vec![0u32; t];
        for k in 0..s {
            sums.fill(0);
            for (row, factor) in folded.chunks_exact(t).zip(self.powers_by(t * k)) {
                let factor = u64::from(factor);
                for (sum, &c) in sums.iter_mut().zip(row) {
                    *sum += u64::from(c) * factor;
                }
            }
            for ((place, sum), factor) in twisted.iter_mut().zip(&sums).zip(self.powers_by(k)) {
                *place = reduce(&(u64::from(reduce(sum)) * u64::from(factor)));
            }
            for (m, row) in step.chunks_exact(t).enumerate() {
                let sum: u64 = row.iter().zip(&twisted).map(|(&a, &b)| u64::from(a) * u64::from(b)).sum();
                values[k + s * m] = reduce(&sum);
            }
        }
        values[order] = coefficients.first().map_or(0, |&c| c as u32);
        values
    }
}

/// A number whose powers are all residues but 0.
fn primitive_root(prime: u64) -> u64 {
    let order = prime - 1;
    let (mut rest, mut divisors) = (order, Vec::new());
    for d in (2..).take_while(|d| d * d <= order) {
        if rest.is_multiple_of(d) {
            divisors.push(d);
            while rest.is_multiple_of(d) {
                rest /= d;
            }
        }
    }
    divisors.extend((rest > 1).then_some(rest));
    let is_primitive = |g: &u64| divisors.iter().all(|d| power(*g, order / d, prime) != 1);
    (1..prime).find(is_primitive).expect("the group of units is cyclic")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_horner() {
        let mut state = 9u64;
        // 106 is twice a prime.
        assert!([97, 107, 1_048_583].into_iter().all(|prime| AllResidues::new(prime).is_none()));
        for prime in [101, 103, 109, 127, 211, 257, 1009] {
            let all = AllResidues::new(prime).unwrap();
            let mut residues: Vec<u64> = all.residues().collect();
            residues.sort_unstable();
            assert!(residues.into_iter().eq(0..prime));
            for count in [0, 1, 2, 5, prime as usize - 1, prime as usize, 2 * prime as usize + 3] {
                let mut next = || {
                    state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    (state >> 33) % prime
                };
                let c: Vec<u64> = (0..count).map(|_| next()).collect();
                for (x, value) in all.residues().zip(all.values(&c)) {
                    let expected = c.iter().rev().fold(0, |sum, c| (sum * x + c) % prime);
                    assert_eq!(u64::from(value), expected, "{count} coefficients at {x} modulo {prime}");
                }
            }
        }
    }

    /// Sums of the largest products.
    #[test]
    fn nothing_overflows_below_the_limit() {
        let prime = 65_537;
        let all = AllResidues::new(prime).unwrap();
        let c = vec![prime - 1; prime as usize - 1];
        for (x, value) in all.residues().zip(all.values(&c)) {
            // -(1 + x + ... + x^(p - 2)): 1 at 1, 0 at the other units, -1 at 0.
            let expected = match x {
                0 => prime - 1,
                1 => 1,
                _ => 0,
            };
            assert_eq!(u64::from(value), expected, "{x}");
        }
    }
}
