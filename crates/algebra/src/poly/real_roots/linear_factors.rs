//! Linear factors taken out of a polynomial one after the other, in machine words.

use super::fixed::write_shifted;
use crate::limits::checkpoint;
use crate::number::{Integer, Rational};
use crate::poly::UniPoly;
use std::cmp::Ordering;

/// The widths are fitted to what is left after so many factors.
const FACTORS_PER_FIT: usize = 4;

/// The most bits of numerators and denominators: above those of a product a word leaves two.
const MOST_BITS: u32 = 60;

/// A linear factor `denominator x - numerator`.
struct Factor {
    numerator: i64,
    denominator: u64,
    /// The odd part of the denominator.
    odd: u64,
    /// The inverse of that modulo `2^64`.
    inverse: u64,
    /// The power of two in the denominator.
    twos: u32,
    /// The bits of the larger of numerator and denominator.
    bits: u32,
}

impl Factor {
    /// `None` when a number has more than [`MOST_BITS`].
    fn new(root: &Rational) -> Option<Factor> {
        let (numerator, denominator) = (root.numerator().to_i64()?, root.denominator().to_i64()?.unsigned_abs());
        let bits = 64 - (numerator.unsigned_abs() | denominator).leading_zeros();
        let twos = denominator.trailing_zeros();
        let odd = denominator >> twos;
        // Newton's iteration doubles the number of correct bits: 3, 6, ..., 96.
        let inverse = (0..5).fold(odd, |x, _| x.wrapping_mul(2u64.wrapping_sub(odd.wrapping_mul(x))));
        (bits <= MOST_BITS).then_some(Factor { numerator, denominator, odd, inverse, twos, bits })
    }

    /// The order of the magnitudes of the roots.
    fn compare_size(&self, other: &Factor) -> Ordering {
        let cross = |x: &Factor, y: &Factor| u128::from(x.numerator.unsigned_abs()) * u128::from(y.denominator);
        cross(self, other).cmp(&cross(other, self))
    }

    /// `(c + numerator q) / denominator` modulo a power of two, all of one length; `false` when the power of two in the
    /// denominator does not divide.
    fn step(&self, c: &[u64], q: &[u64], out: &mut [u64]) -> bool {
        let factor = u128::from(self.numerator.unsigned_abs());
        let mut carry = 0;
        if self.numerator < 0 {
            for ((place, &c), &q) in out.iter_mut().zip(c).zip(q) {
                let product = factor * u128::from(q) + u128::from(carry);
                let (difference, borrow) = c.overflowing_sub(product as u64);
                *place = difference;
                carry = (product >> 64) as u64 + u64::from(borrow);
            }
        } else {
            for ((place, &c), &q) in out.iter_mut().zip(c).zip(q) {
                let sum = factor * u128::from(q) + u128::from(c) + u128::from(carry);
                (*place, carry) = (sum as u64, (sum >> 64) as u64);
            }
        }
        if self.twos > 0 {
            if out[0].trailing_zeros() < self.twos {
                return false;
            }
            for k in 0..out.len() {
                let above = out.get(k + 1).copied().unwrap_or((out[k] as i64 >> 63) as u64);
                out[k] = out[k] >> self.twos | above << (64 - self.twos);
            }
        }
        if self.odd > 1 {
            let mut borrow = 0;
            for x in out {
                let (difference, below) = x.overflowing_sub(borrow);
                *x = difference.wrapping_mul(self.inverse);
                borrow = ((u128::from(*x) * u128::from(self.odd)) >> 64) as u64 + u64::from(below);
            }
        }
        true
    }
}

/// A polynomial with two's complement coefficients, from the leading one down, each as long as it needs to be.
struct Flat {
    /// The coefficients, `stride` limbs apart.
    limbs: Vec<u64>,
    stride: usize,
    /// How many limbs of each coefficient count; they never fall.
    widths: Vec<usize>,
}

/// The bounds of the limbs at the top: no number of `w` limbs reaches `2^(64 w - 2 - bits)`, so that its product by one of
/// `bits` bits fits, and the sum of that and another number.
#[derive(Clone, Copy)]
struct Room {
    bits: u32,
}

impl Room {
    /// The limbs for a number of so many bits.
    fn width(self, bits: u64) -> usize {
        (bits + 2 + u64::from(self.bits)).div_ceil(64) as usize
    }

    fn fits(self, top: u64) -> bool {
        let half = 1u64 << (62 - self.bits);
        top.wrapping_add(half) < 2 * half
    }
}

/// Sign limbs up to a greater width.
fn extend(number: &mut [u64], from: usize, to: usize) {
    let sign = from.checked_sub(1).map_or(0, |top| (number[top] as i64 >> 63) as u64);
    number[from..to].fill(sign);
}

impl Flat {
    fn new(p: &UniPoly, room: Room) -> Flat {
        let mut widest = 1;
        let width = |c: &Integer| {
            widest = room.width(c.bit_length()).max(widest);
            widest
        };
        let widths: Vec<usize> = p.coeffs().iter().rev().map(width).collect();
        // A limb more for quotients with greater coefficients.
        let stride = widest + 1;
        let mut limbs = vec![0; widths.len() * stride];
        for ((c, place), &width) in p.coeffs().iter().rev().zip(limbs.chunks_exact_mut(stride)).zip(&widths) {
            write_shifted(c, 0, &mut place[..width]);
        }
        Flat { limbs, stride, widths }
    }

    /// Writes the quotient by a linear factor; `false` when that does not divide, or coefficients become too large.
    fn divide(&mut self, factor: &Factor, room: Room, quotient: &mut Flat) -> bool {
        let (stride, last) = (self.stride, self.widths.len() - 1);
        checkpoint((self.widths.iter().sum::<usize>() / 4) as u64 + 8);
        quotient.widths.clear();
        let zero = &mut vec![0; stride][..];
        let mut width = 0;
        for k in 0..=last {
            let c = &mut self.limbs[k * stride..(k + 1) * stride];
            let (before, out) = quotient.limbs.split_at_mut(k * stride);
            let (q, out) = (if k > 0 { &mut before[(k - 1) * stride..] } else { &mut *zero }, &mut out[..stride]);
            let to = self.widths[k].max(width);
            extend(c, self.widths[k], to);
            extend(q, width, to);
            width = to;
            if k == last {
                // The remainder.
                return factor.step(&c[..width], &q[..width], &mut out[..width])
                    && out[..width].iter().all(|&x| x == 0);
            }
            while !factor.step(&c[..width], &q[..width], &mut out[..width]) || !room.fits(out[width - 1]) {
                if width == stride {
                    return false;
                }
                extend(c, width, width + 1);
                extend(q, width, width + 1);
                width += 1;
            }
            quotient.widths.push(width);
        }
        unreachable!("the remainder is the last")
    }

    /// Takes away limbs that are not needed.
    fn fit(&mut self, room: Room) {
        let mut widest = 1;
        for (width, c) in self.widths.iter_mut().zip(self.limbs.chunks_exact(self.stride)) {
            while *width > widest && c[*width - 1] == (c[*width - 2] as i64 >> 63) as u64 && room.fits(c[*width - 2]) {
                *width -= 1;
            }
            widest = widest.max(*width);
        }
    }

    fn polynomial(&self) -> UniPoly {
        let rows = self.limbs.chunks_exact(self.stride).zip(&self.widths).rev();
        UniPoly::new(rows.map(|(c, &width)| Integer::from_twos_complement(&c[..width])).collect())
    }
}

/// The quotient of a polynomial by the linear factors of some numbers, and for each of these whether it was a root; what is a root
/// may be left, but not what is none taken.
///
/// By the rule of Ruffini and Horner the coefficients of a quotient are `q_k = (c_(k+1) + n q_(k+1)) / d` from the leading
/// one down, and `c_0 + n q_0`, the remainder, is 0 exactly for a root `n / d`. Large roots first: that makes what is left small.
/// Cost: one pass over the words of the coefficients for each number.
pub(super) fn without_linear_factors(p: &UniPoly, numbers: &[Rational]) -> (UniPoly, Vec<bool>) {
    let mut factors: Vec<(usize, Factor)> =
        numbers.iter().enumerate().filter_map(|(k, x)| Some((k, Factor::new(x)?))).collect();
    factors.sort_by(|(_, f), (_, g)| g.compare_size(f));
    let mut is_root = vec![false; numbers.len()];
    let room = Room { bits: factors.iter().map(|(_, f)| f.bits).max().unwrap_or(0) };
    let mut rest = Flat::new(p, room);
    let mut quotient = Flat { limbs: rest.limbs.clone(), stride: rest.stride, widths: Vec::new() };
    for (count, (k, factor)) in factors.iter().enumerate() {
        if rest.widths.len() > 1 && rest.divide(factor, room, &mut quotient) {
            std::mem::swap(&mut rest, &mut quotient);
            is_root[*k] = true;
            if count % FACTORS_PER_FIT == FACTORS_PER_FIT - 1 {
                rest.fit(room);
            }
        }
    }
    (rest.polynomial(), is_root)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::real_roots::linear;

    fn rational(n: i64, d: i64) -> Rational {
        Rational::new(n.into(), d.into())
    }

    /// Every set of roots of a list of awkward ones, times a polynomial without any: all are found, others are not, and what is
    /// left is that polynomial.
    #[test]
    fn quotients_are_those_of_long_division() {
        let edge = (1i64 << 60) - 1;
        let list = [
            rational(0, 1),
            rational(1, 1),
            rational(-1, 1),
            rational(7, 12),
            rational(-5, 3),
            rational(3, 64),
            rational(edge, 1),
            rational(-edge, 2),
            rational(1, edge),
        ];
        let others = [rational(2, 1), rational(1, 2), rational(-7, 12), rational(1, 3), rational(-edge, 1)];
        let cofactors = [
            UniPoly::from_i64(&[1]),
            UniPoly::from_i64(&[1, 0, 1]),
            UniPoly::from_i64(&[-3, 0, 0, 1 << 62]),
            UniPoly::new(vec![Integer::from(10).pow(300), Integer::ZERO, -Integer::from(7).pow(200)]),
        ];
        for cofactor in &cofactors {
            for subset in 0..1usize << list.len() {
                let roots: Vec<Rational> =
                    (0..list.len()).filter(|k| subset >> k & 1 == 1).map(|k| list[k].clone()).collect();
                let p = roots.iter().fold(cofactor.clone(), |p, x| &p * &linear(x));
                let numbers: Vec<Rational> = roots.iter().chain(&others).cloned().collect();
                let (rest, is_root) = without_linear_factors(&p, &numbers);
                assert_eq!(&rest, cofactor, "{roots:?}");
                assert!(is_root.iter().enumerate().all(|(k, &is_root)| is_root == (k < roots.len())), "{roots:?}");
            }
        }
    }

    /// Coefficients of all lengths, and factors that do not divide.
    #[test]
    fn widths_grow_and_shrink() {
        let binomial = &UniPoly::monomial(Integer::ONE, 64) - &UniPoly::from_i64(&[1]);
        let (rest, is_root) = without_linear_factors(&binomial, &[rational(1, 1), rational(-1, 1), rational(3, 1)]);
        assert_eq!((&rest * &UniPoly::from_i64(&[-1, 0, 1]), is_root), (binomial, vec![true, true, false]));
        let roots: Vec<Rational> = (1..=60).map(|k| rational(k, 1)).collect();
        let product = roots.iter().fold(UniPoly::from_i64(&[1]), |p, x| &p * &linear(x));
        assert_eq!(without_linear_factors(&product, &roots), (UniPoly::from_i64(&[1]), vec![true; 60]));
        // A number that is given twice is a root once.
        assert_eq!(without_linear_factors(&product, &[rational(5, 1), rational(5, 1)]).1, [true, false]);
        // Coefficients that are long all over.
        let large = Integer::from(10).pow(40);
        let p = &UniPoly::new(vec![large.clone(), -&large, large.clone()]) * &UniPoly::from_i64(&[1, 1]);
        assert_eq!(without_linear_factors(&p, &[rational(-1, 1)]).1, [true]);
    }

    #[test]
    fn constants_and_numbers_that_are_too_long_stay() {
        let one = UniPoly::from_i64(&[5]);
        assert_eq!(without_linear_factors(&one, &[rational(5, 1)]), (one, vec![false]));
        let long = Rational::from(Integer::from(10).pow(30));
        let p = linear(&long);
        assert_eq!(without_linear_factors(&p, &[long]), (p, vec![false]));
        let p = UniPoly::from_i64(&[-6, 2]);
        assert_eq!(without_linear_factors(&p, &[rational(3, 1)]), (UniPoly::from_i64(&[2]), vec![true]));
    }
}
