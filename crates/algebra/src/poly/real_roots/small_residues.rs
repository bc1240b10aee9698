//! Residues modulo numbers below 2^32, prime or not, for the search of rational roots.

use crate::poly::UniPoly;

/// The coefficients modulo `prime`, zeros at the top dropped.
pub(super) fn residues(p: &UniPoly, prime: u64) -> Vec<u64> {
    let mut out: Vec<u64> = p.coeffs().iter().map(|c| c.mod_u64(prime)).collect();
    trim(&mut out);
    out
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
            let residues: Vec<u64> = p.coeffs().iter().map(|c| c.mod_u64(product)).collect();
            let Some(&lead) = residues.last() else { return false };
            false $(|| rootless::<$prime>(&residues, lead))*
        }};
    }
    any_rootless!(13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59)
}
