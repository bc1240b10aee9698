//! Exponent vectors.

use std::cmp::Ordering;
use std::fmt;

/// How many exponents are kept without an allocation.
const INLINE: usize = 4;

/// A power product: the exponents of variables 0, 1, ... in lexicographic order, variable 0 the
/// most significant.
///
/// Exponent vectors of different lengths are the same when they differ by zeros at the end, so a
/// monomial does not know how many variables there are.
///
/// ```
/// use jurist_algebra::poly::Monomial;
/// let m = Monomial::new(&[2, 1]); // x_0^2 x_1
/// assert_eq!(m, Monomial::new(&[2, 1, 0]));
/// assert!(m > Monomial::power_of(1, 7));
/// assert_eq!(m.total_degree(), 3);
/// ```
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Monomial(Exponents);

/// Short vectors are padded with zeros, long ones have no zero at the end and more than `INLINE`
/// entries: one form for each monomial, and slices compare as monomials do.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Exponents {
    Short([u32; INLINE]),
    Long(Box<[u32]>),
}

impl Monomial {
    /// The monomial 1.
    pub const ONE: Monomial = Monomial(Exponents::Short([0; INLINE]));

    /// From exponents, variable 0 first.
    pub fn new(exponents: &[u32]) -> Self {
        let used = exponents.iter().rposition(|&e| e > 0).map_or(0, |last| last + 1);
        if used <= INLINE {
            let mut short = [0; INLINE];
            short[..used].copy_from_slice(&exponents[..used]);
            Monomial(Exponents::Short(short))
        } else {
            Monomial(Exponents::Long(exponents[..used].into()))
        }
    }

    /// `x_i^e`.
    pub fn power_of(variable: usize, exponent: u32) -> Self {
        let mut exponents = vec![0; variable + 1];
        exponents[variable] = exponent;
        Monomial::new(&exponents)
    }

    /// The exponents with zeros at the end trimmed.
    pub fn exponents(&self) -> &[u32] {
        let all = self.padded();
        &all[..all.iter().rposition(|&e| e > 0).map_or(0, |last| last + 1)]
    }

    fn padded(&self) -> &[u32] {
        match &self.0 {
            Exponents::Short(short) => short,
            Exponents::Long(long) => long,
        }
    }

    /// The exponent of variable `i`.
    pub fn exponent(&self, i: usize) -> u32 {
        self.padded().get(i).copied().unwrap_or(0)
    }

    /// Whether this is 1.
    pub fn is_one(&self) -> bool {
        *self == Monomial::ONE
    }

    /// The sum of the exponents.
    pub fn total_degree(&self) -> u64 {
        self.padded().iter().map(|&e| u64::from(e)).sum()
    }

    /// The same with exponent `e` for variable `i`.
    pub fn with_exponent(&self, i: usize, e: u32) -> Monomial {
        match &self.0 {
            Exponents::Short(short) if i < INLINE => {
                let mut short = *short;
                short[i] = e;
                Monomial(Exponents::Short(short))
            }
            _ => {
                let mut exponents = self.padded().to_vec();
                exponents.resize(exponents.len().max(i + 1), 0);
                exponents[i] = e;
                Monomial::new(&exponents)
            }
        }
    }

    /// The product; `None` when an exponent would leave the range of `u32`.
    pub fn checked_mul(&self, other: &Monomial) -> Option<Monomial> {
        self.zipped(other, u32::checked_add)
    }

    /// The quotient; `None` when `other` does not divide.
    pub fn checked_div(&self, other: &Monomial) -> Option<Monomial> {
        self.zipped(other, u32::checked_sub)
    }

    /// The exponents of both taken together; `None` where two of them have no result.
    #[inline]
    fn zipped(&self, other: &Monomial, f: impl Fn(u32, u32) -> Option<u32>) -> Option<Monomial> {
        if let (Exponents::Short(a), Exponents::Short(b)) = (&self.0, &other.0) {
            let mut out = [0; INLINE];
            for (out, (x, y)) in out.iter_mut().zip(a.iter().zip(b)) {
                *out = f(*x, *y)?;
            }
            return Some(Monomial(Exponents::Short(out)));
        }
        let n = self.padded().len().max(other.padded().len());
        let out: Option<Vec<u32>> = (0..n).map(|i| f(self.exponent(i), other.exponent(i))).collect();
        Some(Monomial::new(&out?))
    }

    /// The greatest monomial that divides both.
    pub fn gcd(&self, other: &Monomial) -> Monomial {
        let n = self.padded().len().min(other.padded().len());
        let least: Vec<u32> = (0..n).map(|i| self.exponent(i).min(other.exponent(i))).collect();
        Monomial::new(&least)
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        self.padded().cmp(other.padded())
    }
}

impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl fmt::Debug for Monomial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.exponents()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trailing_zeros_do_not_matter() {
        assert_eq!(Monomial::new(&[1, 0, 0, 0, 0, 0]), Monomial::new(&[1]));
        assert_eq!(Monomial::new(&[]), Monomial::ONE);
        assert_eq!(Monomial::new(&[0, 0, 0, 0, 0, 2]).exponents(), [0, 0, 0, 0, 0, 2]);
        let long = Monomial::power_of(7, 1);
        assert_eq!(long.checked_div(&long), Some(Monomial::ONE));
        assert_eq!(long.with_exponent(7, 0), Monomial::ONE);
    }

    #[test]
    fn order_is_lexicographic_across_lengths() {
        let m = |e: &[u32]| Monomial::new(e);
        let sorted = [
            m(&[]),
            m(&[0, 0, 0, 0, 0, 1]),
            m(&[0, 0, 0, 0, 1]),
            m(&[0, 1]),
            m(&[1]),
            m(&[1, 0, 0, 0, 9]),
            m(&[1, 0, 0, 1]),
        ];
        assert!(sorted.is_sorted() && sorted.windows(2).all(|w| w[0] != w[1]));
    }

    #[test]
    fn exponents_never_wrap() {
        let big = Monomial::power_of(0, u32::MAX);
        assert_eq!(big.checked_mul(&Monomial::power_of(0, 1)), None);
        assert!(big.checked_mul(&Monomial::power_of(5, 1)).is_some());
        assert_eq!(Monomial::ONE.checked_div(&Monomial::power_of(5, 1)), None);
    }
}
