//! Arithmetic modulo numbers of 60 bits, in Montgomery's form: a sum of sixteen products is reduced at once.
//!
//! The moduli are most likely prime, and nothing rests on it: an inverse is tested when it is taken, and where there is
//! none another modulus is used.

use crate::number::Z;
use num_traits::{Signed, ToPrimitive};

/// Coefficients that are summed at a time: with what is above them, products of residues as many as are reduced at once.
const BLOCK: usize = 15;

/// A fraction of residues; nothing is said of whether the lower one has an inverse.
pub(super) struct Quotient {
    pub above: u64,
    pub below: u64,
}

/// A modulus. Residues `x` stand for `x/2^64`.
pub(super) struct Modulus {
    pub value: u64,
    /// `-1/value` modulo `2^64`.
    inverse: u64,
    /// `2^128`, which stands for `2^64`.
    square: u64,
}

impl Modulus {
    /// Of an odd number below `2^60`.
    pub fn new(value: u64) -> Self {
        // Newton's iteration doubles the digits that are right.
        let inverse = (0..6).fold(1u64, |x, _| x.wrapping_mul(2u64.wrapping_sub(value.wrapping_mul(x))));
        let square = (u128::MAX % u128::from(value) + 1) % u128::from(value);
        Modulus { value, inverse: inverse.wrapping_neg(), square: square as u64 }
    }

    /// The greatest odd number below a bound, and above `2^59`, that passes Fermat's test.
    pub fn below(bound: u64) -> Option<Self> {
        let odd = (1 << 59..bound).rev().filter(|p| p % 2 == 1).map(Modulus::new);
        odd.into_iter().find(|m| m.power(m.of_u64(2), m.value - 1) == m.of_u64(1))
    }

    pub fn of_u64(&self, x: u64) -> u64 {
        self.times(x % self.value, self.square)
    }

    pub fn of(&self, x: &Z) -> u64 {
        let rest = (x % self.value).to_i64().unwrap_or(0);
        let residue = self.of_u64(rest.unsigned_abs());
        if x.is_negative() { self.minus(0, residue) } else { residue }
    }

    /// The residue between 0 and the modulus itself.
    pub fn number(&self, x: u64) -> u64 {
        self.times(x, 1)
    }

    pub fn times(&self, x: u64, y: u64) -> u64 {
        self.reduced(u128::from(x) * u128::from(y))
    }

    /// A number below `2^64` times the modulus, over `2^64`.
    fn reduced(&self, product: u128) -> u64 {
        let multiple = (product as u64).wrapping_mul(self.inverse);
        let sum = ((product + u128::from(multiple) * u128::from(self.value)) >> 64) as u64;
        if sum >= self.value { sum - self.value } else { sum }
    }

    pub fn plus(&self, x: u64, y: u64) -> u64 {
        let sum = x + y;
        if sum >= self.value { sum - self.value } else { sum }
    }

    pub fn minus(&self, x: u64, y: u64) -> u64 {
        if x >= y { x - y } else { x + self.value - y }
    }

    pub fn power(&self, x: u64, mut exponent: u64) -> u64 {
        let (mut result, mut square) = (self.of_u64(1), x);
        while exponent > 0 {
            if exponent % 2 == 1 {
                result = self.times(result, square);
            }
            square = self.times(square, square);
            exponent /= 2;
        }
        result
    }

    pub fn inverse(&self, x: u64) -> Option<u64> {
        let inverse = self.power(x, self.value - 2);
        (self.times(x, inverse) == self.of_u64(1)).then_some(inverse)
    }

    /// The powers of a number that [`Self::value_at`] needs.
    pub fn powers(&self, x: u64) -> [u64; BLOCK + 1] {
        let mut powers = [self.of_u64(1); BLOCK + 1];
        for k in 1..=BLOCK {
            powers[k] = self.times(powers[k - 1], x);
        }
        powers
    }

    /// The value of a polynomial at the number with these powers. Horner's rule, many coefficients at a time.
    pub fn value_at(&self, p: &[u64], powers: &[u64; BLOCK + 1]) -> u64 {
        p.chunks(BLOCK).rev().fold(0, |higher, block| {
            let sum = block.iter().zip(powers).map(|(c, x)| u128::from(*c) * u128::from(*x)).sum::<u128>();
            self.reduced(sum + u128::from(higher) * u128::from(powers[BLOCK]))
        })
    }

    /// The resultant of two polynomials whose leading coefficients are not zero: by Euclid's algorithm without divisions,
    /// what the multiples make too much below the line.
    pub fn resultant(&self, a: &mut Vec<u64>, b: &mut Vec<u64>) -> Option<Quotient> {
        let both_odd = |a: &[u64], b: &[u64]| a.len().is_multiple_of(2) && b.len().is_multiple_of(2);
        let (mut top, mut bottom, mut negative) = (self.of_u64(1), self.of_u64(1), false);
        if a.len() < b.len() {
            negative = both_odd(a, b);
            std::mem::swap(a, b);
        }
        while b.len() > 1 {
            let (m, n, lead) = (a.len() - 1, b.len() - 1, b[b.len() - 1]);
            negative ^= both_odd(a, b);
            if m == n + 1 {
                self.reduce_by_two(a, b);
            } else {
                for shift in (0..=m - n).rev() {
                    let first = a.pop()?;
                    for (k, c) in a.iter_mut().enumerate() {
                        *c = self.times(*c, lead);
                        if k >= shift {
                            *c = self.minus(*c, self.times(first, b[k - shift]));
                        }
                    }
                }
            }
            while a.last() == Some(&0) {
                a.pop();
            }
            if a.is_empty() {
                // A remainder of zero tells something only where all that was multiplied with has an inverse.
                return Some(Quotient { above: 0, below: self.times(bottom, lead) });
            }
            // With r the remainder of lead^s a: Res(a, b) lead^(s n) = (-1)^(m n) lead^(m - deg r) Res(b, r).
            top = self.times(top, self.power(lead, (m + 1 - a.len()) as u64));
            bottom = self.times(bottom, self.power(lead, ((m - n + 1) * n) as u64));
            std::mem::swap(a, b);
        }
        top = self.times(top, self.power(b[0], a.len() as u64 - 1));
        Some(Quotient { above: if negative { self.minus(0, top) } else { top }, below: bottom })
    }

    /// The quotient of two polynomials; `None` if there is none, or the divisor's leading coefficient has no inverse.
    pub fn divided(&self, a: &[u64], b: &[u64]) -> Option<Vec<u64>> {
        let n = b.len() - 1;
        let inverse = self.inverse(b[n])?;
        let mut rest = a.to_vec();
        let mut quotient = vec![0; a.len().checked_sub(n)?];
        for (k, c) in quotient.iter_mut().enumerate().rev() {
            *c = self.times(rest[k + n], inverse);
            for (r, b) in rest[k..].iter_mut().zip(b) {
                *r = self.minus(*r, self.times(*c, *b));
            }
        }
        rest[..n].iter().all(|r| *r == 0).then_some(quotient)
    }

    /// The remainder of `lead^2 a` by `b`, one degree less and with this leading coefficient: the usual case. A sum of three products
    /// is below `2^126`, so that it is reduced once.
    fn reduce_by_two(&self, a: &mut Vec<u64>, b: &[u64]) {
        let n = b.len() - 1;
        let (lead, below) = (b[n], &b[..n]);
        let (first, second) = (a[n + 1], a[n]);
        a.truncate(n);
        let square = self.times(lead, lead);
        let minus_linear = self.minus(0, self.times(lead, first));
        let minus_constant = self.minus(self.times(first, below[n - 1]), self.times(lead, second));
        let mut before = 0;
        for (c, b) in a.iter_mut().zip(below) {
            let sum = u128::from(square) * u128::from(*c)
                + u128::from(minus_linear) * u128::from(before)
                + u128::from(minus_constant) * u128::from(*b);
            *c = self.reduced(sum);
            before = *b;
        }
    }

    /// The coefficients of the polynomial that has these values at ascending numbers, by Newton's divided differences.
    pub fn interpolated(&self, nodes: &[u64], mut d: Vec<u64>) -> Option<Vec<u64>> {
        let (n, last) = (d.len(), nodes.last()? - nodes.first()?);
        let inverses = (1..=last).map(|k| self.inverse(self.of_u64(k))).collect::<Option<Vec<u64>>>()?;
        for k in 1..n {
            for i in (k..n).rev() {
                let difference = (nodes[i] - nodes[i - k]) as usize;
                d[i] = self.times(self.minus(d[i], d[i - 1]), inverses[difference - 1]);
            }
        }
        let mut out: Vec<u64> = Vec::with_capacity(n);
        for (c, node) in d.into_iter().zip(nodes).rev() {
            // out (x - node) + c
            let node = self.of_u64(*node);
            out.insert(0, 0);
            for k in 1..out.len() {
                out[k - 1] = self.minus(out[k - 1], self.times(out[k], node));
            }
            out[0] = self.plus(out[0], c);
        }
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remainder_of_zero_by_a_divisor_of_zero_tells_nothing() {
        let m = Modulus::new(15);
        let of = |c: &[u64]| c.iter().map(|&c| m.of_u64(c)).collect::<Vec<u64>>();
        let resultant = |a: &[u64], b: &[u64]| {
            let found = m.resultant(&mut of(a), &mut of(b))?;
            Some(m.number(m.times(found.above, m.inverse(found.below)?)))
        };
        // Modulo 15: 3 (5 x^2) is zero, and so is the remainder by 3 x, whatever they are.
        assert_eq!(resultant(&[0, 0, 5], &[0, 3]), None);
        assert_eq!(resultant(&[2, 1], &[1, 1]), Some(14));
        assert_eq!(resultant(&[0, 1, 1], &[0, 1]), Some(0));
    }

    #[test]
    fn values_and_quotients_are_those_of_polynomials() {
        let m = Modulus::below(1 << 60).unwrap();
        let x = m.of_u64(3);
        for length in 1..40u64 {
            let p: Vec<u64> = (0..length).map(|k| m.minus(0, m.of_u64(k * k + 1))).collect();
            let plainly = p.iter().rev().fold(0, |sum, c| m.plus(m.times(sum, x), *c));
            assert_eq!(m.value_at(&p, &m.powers(x)), plainly);
            // (y^2 - 3) p over p, and with one more.
            let b = [m.minus(0, x), 0, m.of_u64(1)];
            let mut product = vec![0; p.len() + 2];
            for (i, c) in p.iter().enumerate() {
                for (j, b) in b.iter().enumerate() {
                    product[i + j] = m.plus(product[i + j], m.times(*c, *b));
                }
            }
            assert_eq!(m.divided(&product, &b), Some(p));
            product[0] = m.plus(product[0], m.of_u64(1));
            assert_eq!(m.divided(&product, &b), None);
        }
        assert_eq!(m.divided(&[1], &[1, 1]), None);
    }

    #[test]
    fn residues_are_those_of_integers() {
        let m = Modulus::below(1 << 60).unwrap();
        assert_eq!(m.value, (1 << 60) - 93); // the greatest prime there
        let (x, y) = (123_456_789_012_345_678u64, 987_654_321_098_765_432u64);
        let (a, b) = (m.of_u64(x), m.of_u64(y));
        let by_128 = |z: u128| (z % u128::from(m.value)) as u64;
        assert_eq!(m.number(m.times(a, b)), by_128(u128::from(x) * u128::from(y)));
        assert_eq!(m.number(m.plus(a, b)), by_128(u128::from(x) + u128::from(y)));
        assert_eq!(m.plus(m.minus(a, b), b), a);
        assert_eq!(m.times(m.inverse(a).unwrap(), a), m.of_u64(1));
        assert_eq!(m.inverse(0), None);
        let long = Z::from(x) * Z::from(y) * Z::from(-7);
        assert_eq!(m.plus(m.of(&long), m.times(m.of_u64(7), m.times(a, b))), 0);
        // No inverse is taken for one that is none.
        let composite = Modulus::new(((1 << 31) - 1) * ((1 << 30) - 35));
        assert_eq!(composite.inverse(composite.of_u64((1 << 31) - 1)), None);
    }
}
