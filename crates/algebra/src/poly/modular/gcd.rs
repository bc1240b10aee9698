//! Greatest common divisors of integer polynomials through their images modulo primes.

use super::chinese::{Chinese, Limbs};
use super::prime_field::{PrimeField, largest_primes};
use crate::limits::checkpoint;
use crate::poly::{Domain, Poly, UniPoly};

/// The subresultant sequence is used up to this degree of the smaller polynomial.
pub const MODULAR_MIN_DEGREE: usize = 3;

/// A greatest common divisor of two non-zero primitive polynomials, up to sign ([Brown1971](crate::bibliography#brown1971)).
///
/// The degree of the divisor modulo a prime that does not divide both leading coefficients is never too small,
/// so a common divisor over the integers of that degree is a greatest one: the result is
/// proved by two divisions.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// use jurist_algebra::poly::modular::gcd::primitive_gcd_modular;
/// let (a, b) = (UniPoly::from_i64(&[-1, 0, 0, 0, 1]), UniPoly::from_i64(&[-1, 0, 0, 0, 0, 0, 1]));
/// assert_eq!(primitive_gcd_modular(&a, &b), UniPoly::from_i64(&[-1, 0, 1]));
/// ```
///
/// # Panics
/// When one of them is zero.
pub fn primitive_gcd_modular(a: &UniPoly, b: &UniPoly) -> UniPoly {
    primitive_gcd_with(a, b, |k| largest_primes(k + 1)[k])
}

/// The same with the given sequence of distinct primes, which must not end.
fn primitive_gcd_with(a: &UniPoly, b: &UniPoly, prime: impl Fn(usize) -> PrimeField) -> UniPoly {
    let lead = |p: &UniPoly| p.leading().expect("not zero").clone();
    let leading = lead(a).gcd(&lead(b));
    let (limbs_a, limbs_b) = (Limbs::new(a.coeffs()), Limbs::new(b.coeffs()));
    let limbs_leading = Limbs::new([&leading]);
    let mut fields: Vec<PrimeField> = Vec::new();
    let mut images: Vec<Vec<u64>> = Vec::new();
    let mut attempt_at = 1;
    for k in 0.. {
        let f = prime(k);
        let scale = limbs_leading.residues(&f)[0];
        if scale == 0 {
            continue;
        }
        let mut image = monic_gcd(&f, limbs_a.residues(&f), limbs_b.residues(&f));
        if image.len() == 1 {
            return UniPoly::one();
        }
        if let Some(known) = images.first() {
            if image.len() > known.len() {
                continue;
            }
            if image.len() < known.len() {
                // All primes so far were unlucky.
                fields.clear();
                images.clear();
                attempt_at = 1;
            }
        }
        for c in &mut image {
            *c = f.mul(*c, scale);
        }
        fields.push(f);
        images.push(image);
        if fields.len() < attempt_at {
            continue;
        }
        attempt_at = fields.len() + fields.len().div_ceil(2);
        let chinese = Chinese::new(fields.clone());
        let length = images[0].len();
        let lifted = (0..length).map(|j| chinese.integer(images.iter().map(|image| image[j])));
        let candidate = Poly::new(lifted.collect()).primitive_part();
        if candidate.coeffs().len() == length && divides(&candidate, a) && divides(&candidate, b) {
            return candidate;
        }
    }
    unreachable!("the sequence of primes does not end")
}

fn divides(candidate: &UniPoly, p: &UniPoly) -> bool {
    // Cheap refusals first: the ends must divide.
    let ends = |p: &UniPoly| (p.coeffs()[0].clone(), p.leading().expect("not zero").clone());
    let ((low, high), (p_low, p_high)) = (ends(candidate), ends(p));
    p_low.divisible_by(&low) && p_high.divisible_by(&high) && Domain::div_exact(p, candidate).is_some()
}

/// The monic greatest common divisor of two polynomials modulo a prime, not both zero.
pub(super) fn monic_gcd(f: &PrimeField, a: Vec<u64>, b: Vec<u64>) -> Vec<u64> {
    let trim = |p: &mut Vec<u64>| p.truncate(p.iter().rposition(|&c| c != 0).map_or(0, |last| last + 1));
    let (mut a, mut b) = (a, b);
    trim(&mut a);
    trim(&mut b);
    if a.len() < b.len() {
        std::mem::swap(&mut a, &mut b);
    }
    while !b.is_empty() {
        let m = b.len() - 1;
        checkpoint((a.len() - m) as u64 * m as u64 / 8 + 8);
        if m == 0 {
            return vec![f.one()];
        }
        if a.len() == m + 2 {
            // Two quotient terms without a division: l^2 a - q b, l the leading coefficient of b.
            let (l, top) = (b[m], a[m + 1]);
            let (square, first) = (f.mul(l, l), f.negated(f.mul(top, l)));
            let second = f.mul_add_mul(top, b[m - 1], f.negated(l), a[m]);
            a.truncate(m);
            a[0] = f.mul_add_mul(square, a[0], second, b[0]);
            for ((x, &y), &z) in a[1..].iter_mut().zip(&b[1..m]).zip(&b[..m - 1]) {
                let sum = u128::from(square) * u128::from(*x)
                    + u128::from(second) * u128::from(y)
                    + u128::from(first) * u128::from(z);
                *x = f.reduce(sum);
            }
        } else {
            let inverse = f.inverse(b[m]);
            while a.len() > m {
                let top = f.negated(f.mul(a[a.len() - 1], inverse));
                let at = a.len() - 1 - m;
                for (x, &y) in a[at..at + m].iter_mut().zip(&b) {
                    *x = f.add(*x, f.mul(top, y));
                }
                a.pop();
            }
        }
        trim(&mut a);
        std::mem::swap(&mut a, &mut b);
    }
    let inverse = f.inverse(a[a.len() - 1]);
    a.iter().map(|&c| f.mul(c, inverse)).collect()
}

/// The quotient of a polynomial by a monic one that divides it, modulo a prime.
pub(super) fn divided_by_monic(f: &PrimeField, a: &[u64], divisor: &[u64]) -> Vec<u64> {
    let m = divisor.len() - 1;
    checkpoint((a.len().saturating_sub(m) * m / 8) as u64);
    let backwards: Vec<u64> = divisor[..m].iter().rev().copied().collect();
    // The coefficients from the top: each is one of the dividend less a sum over those before.
    let mut quotient: Vec<u64> = Vec::with_capacity(a.len().saturating_sub(m));
    for &c in a.iter().skip(m).rev() {
        let known = quotient.len().min(m);
        let sum: u64 = f.dot_backwards(&quotient[quotient.len() - known..], &backwards[..known]);
        quotient.push(f.sub(c, sum));
    }
    quotient.reverse();
    quotient
}

/// [`primitive_gcd_modular`]; `None` where the subresultant sequence is expected to be faster.
pub(in crate::poly) fn primitive_gcd(a: &UniPoly, b: &UniPoly) -> Option<UniPoly> {
    (a.coeffs().len().min(b.coeffs().len()) > MODULAR_MIN_DEGREE).then(|| primitive_gcd_modular(a, b))
}

/// Whether a prime proves that two polynomials have no common factor of positive degree.
///
/// `true` is a proof: when a prime does not divide both leading coefficients, the degree of the greatest common divisor
/// can only grow modulo it. `false` says nothing. `O(n m)` operations on machine words for each of two primes.
pub(crate) fn coprime_modulo_some_prime(a: &UniPoly, b: &UniPoly) -> bool {
    if a.coeffs().is_empty() || b.coeffs().is_empty() {
        return false;
    }
    if a.is_constant() || b.is_constant() {
        return true;
    }
    let (limbs_a, limbs_b) = (Limbs::new(a.coeffs()), Limbs::new(b.coeffs()));
    largest_primes(2).iter().any(|f| {
        let (a, b) = (limbs_a.residues(f), limbs_b.residues(f));
        // One leading coefficient must survive; then the divisor's leading coefficient does too.
        (a.last() != Some(&0) || b.last() != Some(&0)) && monic_gcd(f, a, b).len() == 1
    })
}

/// The primes of a sequence are tried until one divides neither leading coefficient; used in tests to
/// meet unlucky ones.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::gcd::primitive_gcd_subresultant;
    use std::cell::Cell;

    /// Small primes first: nearly all of them are unlucky in some way.
    fn from_small_primes(a: &UniPoly, b: &UniPoly) -> UniPoly {
        let small: Vec<PrimeField> = (3..2000).filter_map(PrimeField::new).collect();
        let used = Cell::new(0);
        let g = primitive_gcd_with(a, b, |k| {
            used.set(k);
            small[k]
        });
        assert!(used.get() < small.len());
        g
    }

    #[test]
    fn unlucky_primes_do_not_harm() {
        // x - 1 and x - 1 - 3 5 7 11 agree modulo 3, 5, 7 and 11; the leading coefficients vanish modulo 13 and 17.
        let common = UniPoly::from_i64(&[5, -3, 0, 13 * 17]);
        let a = common.times(&UniPoly::from_i64(&[-1, 1])).times(&UniPoly::from_i64(&[1, 0, 2]));
        let b = common.times(&UniPoly::from_i64(&[-1 - 1155, 1])).times(&UniPoly::from_i64(&[2, 0, 1]));
        assert_eq!(primitive_gcd_subresultant(&a, &b), common);
        assert_eq!(primitive_gcd_modular(&a, &b), common);
        assert_eq!(from_small_primes(&a, &b), common);
        let (a, b) = (UniPoly::from_i64(&[-1, 1]), UniPoly::from_i64(&[-1156, 1]));
        assert_eq!(from_small_primes(&a, &b), UniPoly::one());
    }

    #[test]
    fn small_primes_need_many_images() {
        let common = UniPoly::from_i64(&[-1_000_003, 0, 999_983, -7, 1 << 40]);
        let a = common.times(&UniPoly::from_i64(&[3, 1, 4, 1, 5]));
        let b = common.times(&UniPoly::from_i64(&[2, 7, 1, 8, 2, 8]));
        assert_eq!(from_small_primes(&a, &b).primitive_part(), primitive_gcd_subresultant(&a, &b));
    }
}
