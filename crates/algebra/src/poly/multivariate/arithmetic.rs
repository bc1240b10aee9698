//! Sums, products, powers and the operators.

use super::lines::coefficients_are_coprime;
use super::{Monomial, MultiPoly};
use crate::limits::{checkpoint, claim};
use crate::number::Integer;
use crate::poly::{Domain, Poly};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// A product goes through one packed univariate product when the packed result has at most this
/// many coefficients for each product of terms; else the products are sorted.
const DENSE_FACTOR: usize = 2;

/// What a term with a small coefficient takes in a list.
const TERM_BYTES: u64 = size_of::<(Monomial, Integer)>() as u64;

/// Work of a product of two terms that is sorted among others, short coefficients included: 0.2 to 0.3 us.
const TERM_WORK: u64 = 24;

/// The product of numbers whose bits have this product is a unit of work.
const BITS_SQUARED: u64 = 1 << 14;

impl MultiPoly {
    /// The product; `None` when it would exceed [`MultiPoly::MAX_DEGREE`] or could exceed
    /// [`MultiPoly::MAX_TERMS`].
    pub fn checked_times(&self, other: &MultiPoly) -> Option<MultiPoly> {
        if !self.is_zero() && !other.is_zero() && self.total_degree() + other.total_degree() > Self::MAX_DEGREE {
            return None;
        }
        let degrees = (self.degrees(), other.degrees());
        let n = degrees.0.len().max(degrees.1.len());
        let degree = |d: &[u32], i: usize| d.get(i).map_or(0, |&e| u64::from(e));
        let in_box =
            (0..n).try_fold(1u64, |size, i| size.checked_mul(degree(&degrees.0, i) + degree(&degrees.1, i) + 1));
        let products = (self.terms.len() as u64).saturating_mul(other.terms.len() as u64);
        (products.min(in_box.unwrap_or(u64::MAX)) <= Self::MAX_TERMS).then(|| self.times(other))
    }

    /// The power; `None` when it would exceed [`MultiPoly::MAX_DEGREE`] or could exceed
    /// [`MultiPoly::MAX_TERMS`], or when a constant's power has more than
    /// [`MultiPoly::MAX_POWER_BITS`] bits. `0^0 = 1`.
    pub fn checked_power(&self, exponent: u64) -> Option<MultiPoly> {
        if exponent == 0 || self.is_one() {
            return Some(MultiPoly::one());
        }
        if self.is_zero() {
            return Some(MultiPoly::zero());
        }
        if self.total_degree().checked_mul(exponent)? > Self::MAX_DEGREE {
            return None;
        }
        if self.height_bits() > 1 && self.height_bits().checked_mul(exponent)? > Self::MAX_POWER_BITS {
            return None;
        }
        if self.is_constant() {
            return Some(self.power(exponent));
        }
        let mut result = MultiPoly::one();
        let mut base = self.clone();
        let mut e = exponent;
        loop {
            if e & 1 == 1 {
                result = result.checked_times(&base)?;
            }
            e >>= 1;
            if e == 0 {
                return Some(result);
            }
            base = base.checked_times(&base)?;
        }
    }

    /// The greatest size, in bits, of a coefficient that [`MultiPoly::checked_power`] may produce.
    pub const MAX_POWER_BITS: u64 = 1 << 22;

    /// `c p`.
    pub fn scaled_by(&self, c: &Integer) -> MultiPoly {
        if c.is_zero() {
            return MultiPoly::zero();
        }
        if c.is_one() {
            return self.clone();
        }
        checkpoint(4 * self.terms.len() as u64);
        MultiPoly { terms: self.terms.iter().map(|(m, a)| (m.clone(), a * c)).collect() }
    }

    /// `p` times a monomial.
    fn times_term(&self, monomial: &Monomial, c: &Integer) -> MultiPoly {
        if monomial.is_one() {
            return self.scaled_by(c);
        }
        checkpoint(4 * self.terms.len() as u64);
        let one = c.is_one();
        let product = |(m, a): &(Monomial, Integer)| {
            let m = m.checked_mul(monomial).expect("exponents stay below 2^32");
            (m, if one { a.clone() } else { a * c })
        };
        MultiPoly { terms: self.terms.iter().map(product).collect() }
    }

    /// `p + q` or `p - q` by merging.
    fn merged(&self, other: &MultiPoly, subtract: bool) -> MultiPoly {
        checkpoint(4 * (self.terms.len() + other.terms.len()) as u64);
        claim((self.terms.len() + other.terms.len()) as u64 * TERM_BYTES);
        let signed = |c: &Integer| if subtract { -c } else { c.clone() };
        let mut terms = Vec::with_capacity(self.terms.len() + other.terms.len());
        let (mut a, mut b) = (self.terms.iter().peekable(), other.terms.iter().peekable());
        while let (Some((m, c)), Some((n, d))) = (a.peek(), b.peek()) {
            match m.cmp(n) {
                Ordering::Greater => {
                    terms.push((m.clone(), c.clone()));
                    a.next();
                }
                Ordering::Less => {
                    terms.push((n.clone(), signed(d)));
                    b.next();
                }
                Ordering::Equal => {
                    let sum = if subtract { c - d } else { c + d };
                    if !sum.is_zero() {
                        terms.push((m.clone(), sum));
                    }
                    a.next();
                    b.next();
                }
            }
        }
        terms.extend(a.cloned());
        terms.extend(b.map(|(m, c)| (m.clone(), signed(c))));
        MultiPoly { terms }
    }

    /// The product by sorting all products of terms: the reference.
    fn times_sorted(&self, other: &MultiPoly) -> MultiPoly {
        let count = self.terms.len() * other.terms.len();
        claim(count as u64 * TERM_BYTES);
        let mut products = Vec::with_capacity(count);
        let each = TERM_WORK + self.height_bits() * other.height_bits() / BITS_SQUARED;
        for (m, c) in &self.terms {
            checkpoint(each * other.terms.len() as u64);
            for (n, d) in &other.terms {
                products.push((m.checked_mul(n).expect("exponents stay below 2^32"), c * d));
            }
        }
        MultiPoly::from_unsorted(products)
    }

    /// The product through one univariate product (Kronecker substitution); `None` where that
    /// would be wasteful.
    fn times_packed(&self, other: &MultiPoly) -> Option<MultiPoly> {
        let limit = self.terms.len().saturating_mul(other.terms.len()).saturating_mul(DENSE_FACTOR);
        let packing = Packing::for_product(self, other, limit)?;
        let product = Integer::convolve(&packing.pack(self), &packing.pack(other));
        Some(packing.unpack(product))
    }
}

/// A numbering of the monomials in a box that is additive and keeps the order: mixed radix,
/// variable 0 the most significant digit.
pub(super) struct Packing {
    /// For each variable the number of its exponents, one more than its degree.
    radix: Vec<usize>,
}

impl Packing {
    fn for_product(a: &MultiPoly, b: &MultiPoly, limit: usize) -> Option<Packing> {
        let (a, b) = (a.degrees(), b.degrees());
        let degree = |d: &[u32], i: usize| d.get(i).map_or(0, |&e| e as usize);
        Packing::new(
            (0..a.len().max(b.len())).map(|i| degree(&a, i).saturating_add(degree(&b, i)).saturating_add(1)).collect(),
            limit,
        )
    }

    /// `None` when the box holds more than `limit` monomials.
    pub(super) fn new(radix: Vec<usize>, limit: usize) -> Option<Packing> {
        let size = radix.iter().try_fold(1usize, |size, &r| size.checked_mul(r))?;
        (size <= limit).then_some(Packing { radix })
    }

    pub(super) fn number(&self, m: &Monomial) -> usize {
        let mut number = 0;
        for (i, &r) in self.radix.iter().enumerate() {
            number = number * r + m.exponent(i) as usize;
        }
        number
    }

    /// The coefficients by number, up to the leading term's.
    pub(super) fn pack(&self, p: &MultiPoly) -> Vec<Integer> {
        let length = p.terms.first().map_or(0, |(m, _)| self.number(m) + 1);
        claim((length * size_of::<Integer>()) as u64);
        let mut out = vec![Integer::ZERO; length];
        for (m, c) in &p.terms {
            out[self.number(m)] = c.clone();
        }
        out
    }

    pub(super) fn unpack(&self, coefficients: Vec<Integer>) -> MultiPoly {
        let mut exponents = vec![0u32; self.radix.len()];
        let mut terms = Vec::new();
        for (number, c) in coefficients.into_iter().enumerate().rev() {
            if c.is_zero() {
                continue;
            }
            let mut rest = number;
            for (e, &r) in exponents.iter_mut().zip(&self.radix).rev() {
                *e = u32::try_from(rest % r).expect("an exponent is below its radix");
                rest /= r;
            }
            debug_assert_eq!(rest, 0);
            terms.push((Monomial::new(&exponents), c));
        }
        MultiPoly::from_descending(terms)
    }
}

impl Domain for MultiPoly {
    fn zero() -> Self {
        MultiPoly { terms: Vec::new() }
    }
    fn one() -> Self {
        MultiPoly::constant(Integer::ONE)
    }
    fn from_integer(n: &Integer) -> Self {
        MultiPoly::constant(n.clone())
    }
    fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }
    fn is_one(&self) -> bool {
        matches!(self.terms.as_slice(), [(m, c)] if c.is_one() && m.is_one())
    }
    fn plus(&self, other: &Self) -> Self {
        self.merged(other, false)
    }
    fn minus(&self, other: &Self) -> Self {
        self.merged(other, true)
    }
    /// # Panics
    /// When an exponent would reach `2^32`; [`MultiPoly::MAX_DEGREE`] keeps inputs far below.
    fn times(&self, other: &Self) -> Self {
        match (self.terms.as_slice(), other.terms.as_slice()) {
            ([], _) | (_, []) => MultiPoly::zero(),
            ([(m, c)], _) => other.times_term(m, c),
            (_, [(m, c)]) => self.times_term(m, c),
            _ => self.times_packed(other).unwrap_or_else(|| self.times_sorted(other)),
        }
    }
    fn negated(&self) -> Self {
        MultiPoly { terms: self.terms.iter().map(|(m, c)| (m.clone(), -c)).collect() }
    }
    fn div_exact(&self, divisor: &Self) -> Option<Self> {
        self.div_exact_multi(divisor)
    }
    fn gcd(&self, other: &Self) -> Self {
        super::gcd::gcd(self, other)
    }
    fn primitive_gcd_fast(a: &Poly<Self>, b: &Poly<Self>) -> Option<Poly<Self>> {
        if coefficients_are_coprime(a, b) {
            return Some(Poly::one());
        }
        // With the unknown as variable 0.
        let over = |p: &Poly<Self>| {
            let shifted = p.map(|c| c.map_variables(|i| i + 1));
            MultiPoly::from_poly_in(&shifted, 0).primitive_over_integers()
        };
        let (a, b) = (over(a), over(b));
        let mut variables = a.variables();
        variables.extend(b.variables().into_iter().filter(|&j| a.degree_in(j) == 0));
        let g = super::gcd::gcd_in_fewer_variables(&a, &b, &variables)?;
        Some(g.as_poly_in(0).map(|c| c.map_variables(|i| i - 1)))
    }
    fn resultant_fast(a: &Poly<Self>, n: usize, b: &Poly<Self>, m: usize) -> Option<Self> {
        crate::poly::modular::multimodular_resultant::over_multivariate(a, n, b, m)
    }
    /// Whether the leading coefficient is negative.
    fn needs_negation(&self) -> bool {
        self.terms.first().is_some_and(|(_, c)| c.is_negative())
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $with:ident) => {
        impl $trait for &MultiPoly {
            type Output = MultiPoly;
            fn $method(self, other: &MultiPoly) -> MultiPoly {
                self.$with(other)
            }
        }
        impl $trait for MultiPoly {
            type Output = MultiPoly;
            fn $method(self, other: MultiPoly) -> MultiPoly {
                (&self).$with(&other)
            }
        }
    };
}
operator!(Add, add, plus);
operator!(Sub, sub, minus);
operator!(Mul, mul, times);

impl Neg for &MultiPoly {
    type Output = MultiPoly;
    fn neg(self) -> MultiPoly {
        self.negated()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_and_sorted_products_agree() {
        let p = MultiPoly::from_terms([
            (vec![2, 1], Integer::from(3)),
            (vec![0, 2], Integer::from(-5)),
            (vec![1], Integer::from(7)),
            (vec![], Integer::from(-1)),
        ]);
        let q = MultiPoly::from_terms([
            (vec![1, 1], Integer::from(2)),
            (vec![0, 0], Integer::from(9)),
            (vec![0, 2], Integer::from(4)),
        ]);
        let packing = Packing::for_product(&p, &q, usize::MAX).unwrap();
        let packed = packing.unpack(Integer::convolve(&packing.pack(&p), &packing.pack(&q)));
        assert_eq!(packed, p.times_sorted(&q));
        assert_eq!(p.times(&q), packed);
    }

    #[test]
    fn powers_are_limited_not_wrapped() {
        let k = MultiPoly::variable(0);
        assert_eq!(k.checked_power(MultiPoly::MAX_DEGREE + 1), None);
        assert_eq!(k.checked_power(u64::MAX), None);
        assert_eq!(k.checked_power(3).unwrap().degree_in(0), 3);
        assert_eq!(MultiPoly::from(2).checked_power(u64::MAX), None);
        assert_eq!(MultiPoly::from(-1).checked_power(u64::MAX), Some(MultiPoly::from(-1)));
        assert_eq!(MultiPoly::zero().checked_power(0), Some(MultiPoly::one()));
        let sum = (0..6).fold(MultiPoly::one(), |s, i| s.plus(&MultiPoly::variable(i)));
        assert_eq!(sum.checked_power(200), None);
    }
}
