//! Residues modulo word-size numbers, prime or not, for the search of rational roots.

use crate::number::Integer;
use crate::poly::UniPoly;

/// The coefficients modulo `prime`, zeros at the top dropped.
pub(super) fn residues(p: &UniPoly, prime: u64) -> Vec<u64> {
    let mut out = all_residues(p, prime);
    trim(&mut out);
    out
}

/// The coefficients modulo `m`: half limbs times powers of `2^32` that are reduced once for all coefficients, and one division each.
fn all_residues(p: &UniPoly, m: u64) -> Vec<u64> {
    let limbs = p.coeffs().iter().map(|c| c.as_limbs().len()).max().unwrap_or(0);
    let next = |power: &u64| Some(((u128::from(*power) << 32) % u128::from(m)) as u64);
    let powers: Vec<u64> = std::iter::successors(Some(1 % m), next).take(2 * limbs).collect();
    let residue = |c: &Integer| {
        // Sums of up to 2^32 products of 32 and 64 bits.
        let sum = c.as_limbs().iter().zip(powers.as_chunks::<2>().0).fold(0u128, |sum, (limb, [low, high])| {
            sum + u128::from(*limb & u64::from(u32::MAX)) * u128::from(*low)
                + u128::from(limb >> 32) * u128::from(*high)
        });
        let residue = (sum % u128::from(m)) as u64;
        if c.is_negative() && residue > 0 { m - residue } else { residue }
    };
    p.coeffs().iter().map(residue).collect()
}

fn trim(a: &mut Vec<u64>) {
    while a.last() == Some(&0) {
        a.pop();
    }
}

/// `base^exponent` modulo a prime below 2^32.
pub(super) fn power(base: u64, mut exponent: u64, prime: u64) -> u64 {
    let (mut result, mut base) = (1, base % prime);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * base % prime;
        }
        base = base * base % prime;
        exponent >>= 1;
    }
    result
}

/// Whether some small prime proves that a polynomial has no rational root: it does not divide the
/// leading coefficient, and the polynomial has no root modulo it. `false` says nothing.
pub(super) fn has_no_rational_root(p: &UniPoly) -> bool {
    /// Divisions by a constant are multiplications.
    fn rootless<const PRIME: u32>(residues: &[u64], lead: u64) -> bool {
        let q = u64::from(PRIME);
        if lead.is_multiple_of(q) || residues[0].is_multiple_of(q) {
            return false;
        }
        // x^(q - 1) = 1 for x other than 0.
        let mut folded = [0u32; 58];
        let period = (PRIME as usize - 1).min(residues.len());
        let folded = &mut folded[..period];
        for chunk in residues.chunks(period) {
            for (sum, r) in folded.iter_mut().zip(chunk) {
                *sum = (*sum + (r % q) as u32) % PRIME;
            }
        }
        (1..PRIME).all(|x| folded.iter().rev().fold(0, |acc, &c| (acc * x + c) % PRIME) != 0)
    }
    macro_rules! any_rootless {
        ($($prime:literal),*) => {{
            let product: u64 = 1 $(* $prime)*;
            let residues = all_residues(p, product);
            let Some(&lead) = residues.last() else { return false };
            false $(|| rootless::<$prime>(&residues, lead))*
        }};
    }
    any_rootless!(13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residues_are_those_of_division() {
        let mut c = Integer::from(-7i64);
        let mut list = vec![Integer::ZERO, Integer::ONE, -Integer::ONE];
        for k in 0..40u64 {
            c = &c * &Integer::from(0xffff_ffff_ffff_ffc5u64) + Integer::from(k);
            list.extend([c.clone(), -&c]);
        }
        let p = UniPoly::new(list);
        for m in [1, 2, 41, 1681, 1_073_741_789, u64::MAX, 0x8000_0000_0000_001d] {
            let expected: Vec<u64> = p.coeffs().iter().map(|c| c.mod_u64(m)).collect();
            assert_eq!(all_residues(&p, m), expected, "{m}");
        }
    }
}
