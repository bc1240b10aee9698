//! Resultants modulo primes, and from them resultants over the integers and their polynomials.

use super::chinese::{Chinese, Limbs};
use super::grid::Grid;
use super::prime_field::PrimeField;
use super::sylvester_bounds::Frame;
use crate::limits::checkpoint;
use crate::number::Integer;

/// Primes are distributed over the threads when there are at least this many products of residues
/// to compute in all: about 4 ms of work, against some 0.1 ms to wake the other threads.
const PARALLEL_MIN_PRODUCTS: usize = 1 << 20;

/// Two polynomials in `x` of formal degrees `degrees`, whose coefficients are polynomials with
/// integer coefficients in several variables, densely stored.
///
/// `coefficients` has the shape `terms[0] x terms[1] x ... x c` with `c = degrees.0 + degrees.1 + 2`: for
/// each monomial the coefficients of `x^0, x^1, ...` in the first and then in the second polynomial.
pub struct DensePair<'a> {
    /// The formal degrees in `x`.
    pub degrees: (usize, usize),
    /// The number of exponents of each variable: its degree plus one.
    pub terms: Vec<usize>,
    /// All coefficients; zeros may share one integer.
    pub coefficients: Vec<&'a Integer>,
}

impl DensePair<'_> {
    /// The numbers of exponents of the variables in the resultant: the degree of a determinant is
    /// at most the sum of the degrees of its rows.
    pub fn lengths(&self) -> Vec<usize> {
        let rows = self.degrees.0 + self.degrees.1 + 2;
        let mut inner = rows;
        let mut lengths = vec![0; self.terms.len()];
        for (axis, &terms) in self.terms.iter().enumerate().rev() {
            let (mut a, mut b) = (0, 0);
            for (k, _) in self.coefficients.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                let exponent = k / inner % terms;
                let side = if k % rows <= self.degrees.0 { &mut a } else { &mut b };
                *side = exponent.max(*side);
            }
            lengths[axis] = a * self.degrees.1 + b * self.degrees.0 + 1;
            inner *= terms;
        }
        lengths
    }

    /// `e` such that every coefficient of the resultant is below `2^e` in magnitude.
    ///
    /// Where all variables have modulus 1 the determinant of Sylvester is at most the product of the
    /// Euclidean lengths of its rows ([Hadamard1893](crate::bibliography#hadamard1893)), with the sum of the magnitudes of its coefficients
    /// in place of each entry; and by Cauchy's formula no coefficient exceeds the greatest value there.
    pub fn height_bits(&self) -> u64 {
        let norms = self.norms();
        let square = |norms: &[Integer]| {
            norms.iter().fold(Integer::ZERO, |mut sum, c| {
                sum.add_mul_assign(c, c);
                sum
            })
        };
        let (a, b) = norms.split_at(self.degrees.0 + 1);
        let square = square(a).pow(self.degrees.1 as u64) * square(b).pow(self.degrees.0 as u64);
        square.bit_length().div_ceil(2)
    }

    /// For each coefficient of the two polynomials the sum of the magnitudes in it.
    pub(super) fn norms(&self) -> Vec<Integer> {
        let rows = self.degrees.0 + self.degrees.1 + 2;
        let mut norms = vec![Integer::ZERO; rows];
        for (k, c) in self.coefficients.iter().enumerate() {
            if c.is_negative() { norms[k % rows] -= *c } else { norms[k % rows] += *c }
        }
        norms
    }

    /// For each variable the least exponent that is stored and how many from there on, and the coefficients of the resultant
    /// for the formal degrees in an array of that shape: evaluated on a grid modulo as many primes as bounds of the
    /// exponents and the coefficients ask for, interpolated, and lifted by Chinese remainders.
    ///
    /// The formal resultant is a determinant, so no prime and no point is unlucky.
    pub fn resultant(&self) -> (Vec<(usize, usize)>, Vec<Integer>) {
        let Some(frame) = Frame::new(self) else { return (vec![(0, 0); self.terms.len()], Vec::new()) };
        let chinese = Chinese::for_bits(frame.bits);
        let limbs = self.limbs(&frame);
        let size = frame.points();
        let image = |f: &PrimeField| self.image(f, &limbs, &frame);
        let images: Vec<Vec<u64>> = chinese.images(self.is_worth_threads(size, chinese.fields().len()), image);
        let coefficient = |k: usize| {
            let value = chinese.integer(images.iter().map(|image| image[k]));
            if frame.divisor.is_one() { value } else { value * &frame.divisor }
        };
        let coefficients = (0..size).map(coefficient).collect();
        (frame.ranges, coefficients)
    }

    /// All coefficients, and then the known divisor, to be reduced modulo primes.
    pub(super) fn limbs(&self, frame: &Frame) -> Limbs {
        Limbs::new(self.coefficients.iter().copied().chain([&frame.divisor]))
    }

    /// The resultant without what is known to divide it modulo one prime: the values on the grid, interpolated.
    fn image(&self, f: &PrimeField, limbs: &Limbs, frame: &Frame) -> Vec<u64> {
        let mut grid = self.grid(f, frame);
        let mut values = self.values(limbs, frame, &grid);
        grid.prepare_interpolation(f.inverse(grid.factorial()));
        let mut inner = 1;
        for &(_, length) in frame.ranges.iter().rev() {
            grid.interpolate(&mut values, length, inner);
            inner *= length;
        }
        values
    }

    /// The grid from 0 on, or from 1 on where powers of variables are divided by.
    pub(super) fn grid<'f>(&self, f: &'f PrimeField, frame: &Frame) -> Grid<'f> {
        let longest = frame.ranges.iter().map(|range| range.1).max().unwrap_or(1);
        Grid::starting_at(f, u64::from(frame.ranges.iter().any(|range| range.0 > 0)), longest)
    }

    /// The values of the resultant on a grid modulo its prime, without what is known to divide it.
    pub(super) fn values(&self, limbs: &Limbs, frame: &Frame, grid: &Grid<'_>) -> Vec<u64> {
        let f = grid.field();
        let rows = self.degrees.0 + self.degrees.1 + 2;
        let mut data = limbs.residues(f);
        let known = data.pop().expect("the divisor is the last");
        let mut inner = rows;
        for (&terms, &(_, length)) in self.terms.iter().zip(&frame.ranges).rev() {
            data = grid.evaluate(&data, terms, inner, length);
            inner *= length;
        }
        let powers = self.powers(frame, grid, known);
        let mut values = Vec::with_capacity(data.len() / rows);
        let mut divisors = Vec::with_capacity(data.len() / rows);
        let mut scratch = Scratch::default();
        for (k, pair) in data.chunks_exact(rows).enumerate() {
            let (a, b) = pair.split_at(self.degrees.0 + 1);
            let (value, divisor) = resultant_fraction(f, a, b, &mut scratch);
            values.push(value);
            divisors.push(powers.get(k).map_or(divisor, |&power| f.mul(divisor, power)));
        }
        f.invert_all(&mut divisors);
        for (v, &d) in values.iter_mut().zip(&divisors) {
            *v = f.mul(*v, d);
        }
        values
    }

    /// What is known to divide the resultant, at all points of the grid; nothing where that is 1.
    fn powers(&self, frame: &Frame, grid: &Grid<'_>, known: u64) -> Vec<u64> {
        let f = grid.field();
        if frame.divisor.is_one() && frame.ranges.iter().all(|range| range.0 == 0) {
            return Vec::new();
        }
        frame.ranges.iter().fold(vec![known], |powers, &(order, length)| {
            let axis: Vec<u64> = grid.points()[..length].iter().map(|&x| f.power(x, order as u64)).collect();
            powers.iter().flat_map(|&p| axis.iter().map(move |&x| f.mul(p, x))).collect()
        })
    }

    /// Whether the values on so many points modulo so many primes are worth the other threads.
    pub(super) fn is_worth_threads(&self, points: usize, primes: usize) -> bool {
        points * primes * (self.degrees.0 * self.degrees.1).max(1) >= PARALLEL_MIN_PRODUCTS
    }
}

/// Room for remainder sequences.
#[derive(Default)]
struct Scratch {
    a: Vec<u64>,
    b: Vec<u64>,
}

/// The resultant of two polynomials modulo a prime for the formal degrees `a.len() - 1` and
/// `b.len() - 1`; zeros at the top are allowed.
///
/// # Panics
/// When a list is empty.
pub fn resultant_modulo(f: &PrimeField, a: &[u64], b: &[u64]) -> u64 {
    let (value, divisor) = resultant_fraction(f, a, b, &mut Scratch::default());
    f.mul(value, f.inverse(divisor))
}

/// Sequences of polynomials of at least this degree count their steps one by one.
const COUNTED_DEGREE: usize = 256;

/// The formal resultant as a quotient, so that many divisors can be inverted at once.
fn resultant_fraction(f: &PrimeField, a: &[u64], b: &[u64], scratch: &mut Scratch) -> (u64, u64) {
    let (n, m) = (a.len() - 1, b.len() - 1);
    if m < COUNTED_DEGREE {
        checkpoint((n * m / 2) as u64 + 4);
    }
    if (n == m || n == m + 1)
        && m > 0
        && a[n] != 0
        && b[m] != 0
        && let Some(fraction) = resultant_regular(f, a, b, scratch)
    {
        return fraction;
    }
    (resultant_euclid(f, a, b), f.one())
}

/// Euclid's algorithm without divisions for degrees `(m, m)` or `(m + 1, m)` while each remainder has
/// the degree one below; `None` when one has not.
fn resultant_regular(f: &PrimeField, a: &[u64], b: &[u64], scratch: &mut Scratch) -> Option<(u64, u64)> {
    let (n, m) = (a.len() - 1, b.len() - 1);
    let (a_buffer, b_buffer) = (&mut scratch.a, &mut scratch.b);
    a_buffer.clear();
    a_buffer.extend_from_slice(a);
    b_buffer.clear();
    b_buffer.extend_from_slice(b);
    let (mut a, mut b) = (a_buffer.as_mut_slice(), b_buffer.as_mut_slice());
    let mut negative = false;
    // The factor of the first step alone: lc(b)^(m - 1).
    let mut divisor = f.one();
    if n == m {
        let (top_a, top_b) = (a[m], b[m]);
        let negated = f.negated(top_a);
        for (x, &y) in a[..m].iter_mut().zip(b.iter()) {
            *x = f.mul_add_mul(*x, top_b, negated, y);
        }
        divisor = f.power(top_b, m as u64 - 1);
        negative = m % 2 == 1;
        a = &mut a[..m];
        std::mem::swap(&mut a, &mut b);
        if b[m - 1] == 0 {
            return None;
        }
    }
    // Now deg a = deg b + 1. With r = l^2 a - q b, l = lc(b), m = deg b and deg r = m - 1:
    // Res(a, b) = (-1)^(m(m+1)) l^-2m l^2 Res(b, r). So the divisor is the product of l^(2(m-1)), which is the square
    // of the product of all products of the first leading coefficients.
    let mut leading = f.one();
    let mut product = f.one();
    loop {
        let m = b.len() - 1;
        let l = b[m];
        if m == 0 {
            let value = if negative { f.negated(l) } else { l };
            return Some((value, f.mul(divisor, f.mul(product, product))));
        }
        if m >= COUNTED_DEGREE {
            checkpoint(m as u64);
        }
        let square = f.mul(l, l);
        let top = a[m + 1];
        let first = f.negated(f.mul(top, l));
        let second = f.mul_add_mul(top, b[m - 1], f.negated(l), a[m]);
        a[0] = f.mul_add_mul(square, a[0], second, b[0]);
        for ((x, &y), &z) in a[1..m].iter_mut().zip(&b[1..m]).zip(&b[..m - 1]) {
            let sum = u128::from(square) * u128::from(*x)
                + u128::from(second) * u128::from(y)
                + u128::from(first) * u128::from(z);
            *x = f.reduce(sum);
        }
        if m > 1 {
            leading = f.mul(leading, l);
            product = f.mul(product, leading);
        }
        let r = &mut a[..m];
        if r[m - 1] == 0 {
            return None;
        }
        (a, b) = (b, r);
    }
}

/// Euclid's algorithm for any degrees and formal degrees: the reference.
fn resultant_euclid(f: &PrimeField, a: &[u64], b: &[u64]) -> u64 {
    let (n, m) = (a.len() - 1, b.len() - 1);
    let trimmed = |p: &[u64]| p[..p.iter().rposition(|&c| c != 0).map_or(0, |last| last + 1)].to_vec();
    let (mut a, mut b) = (trimmed(a), trimmed(b));
    let sign = |value: u64, odd: bool| if odd { f.negated(value) } else { value };
    // Formal degrees of zero polynomials: zero rows, unless there are no rows.
    if a.is_empty() || b.is_empty() {
        return match (n, m) {
            (0, 0) => f.one(),
            (_, 0) if a.is_empty() => f.power(b.first().copied().unwrap_or(0), n as u64),
            (0, _) if b.is_empty() => f.power(a.first().copied().unwrap_or(0), m as u64),
            _ => 0,
        };
    }
    let (lost_a, lost_b) = (n + 1 - a.len(), m + 1 - b.len());
    if lost_a > 0 && lost_b > 0 {
        return 0;
    }
    let mut value = f.mul(f.power(a[a.len() - 1], lost_b as u64), f.power(b[b.len() - 1], lost_a as u64));
    value = sign(value, m % 2 == 1 && lost_a % 2 == 1);
    if a.len() < b.len() {
        value = sign(value, (a.len() - 1) % 2 == 1 && (b.len() - 1) % 2 == 1);
        std::mem::swap(&mut a, &mut b);
    }
    while b.len() > 1 {
        let (n, m) = (a.len() - 1, b.len() - 1);
        let lead = b[m];
        let inverse = f.inverse(lead);
        for k in (0..=n - m).rev() {
            checkpoint(m as u64 / 4);
            let q = f.negated(f.mul(a[k + m], inverse));
            for (x, &y) in a[k..k + m].iter_mut().zip(&b) {
                *x = f.add(*x, f.mul(q, y));
            }
        }
        a.truncate(m);
        let r = trimmed(&a);
        if r.is_empty() {
            return 0;
        }
        // Res(a, b) = (-1)^(nm) Res(b, a) = (-1)^(nm) lc(b)^(n - deg r) Res(b, r).
        value = sign(f.mul(value, f.power(lead, (n + 1 - r.len()) as u64)), n % 2 == 1 && m % 2 == 1);
        (a, b) = (b, r);
    }
    f.mul(value, f.power(b[0], (a.len() - 1) as u64))
}

#[cfg(test)]
mod tests {
    use super::super::prime_field::largest_primes;
    use super::*;
    use crate::limits::Budget;
    use crate::poly::{UniPoly, resultant_formal_subresultant};

    fn numbers(count: usize, size: u64, state: &mut u64) -> Vec<i64> {
        let mut next = || {
            *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            *state >> 20
        };
        (0..count).map(|_| (next() % (2 * size + 1)) as i64 - size as i64).collect()
    }

    /// All degrees to 6, with zeros sprinkled at the top and inside, against the determinant over the
    /// integers; modulo a small prime every kind of degree drop happens in the sequence.
    #[test]
    fn modular_resultants_are_images() {
        let mut state = 3;
        for f in [PrimeField::new(3).unwrap(), PrimeField::new(11).unwrap(), largest_primes(1)[0]] {
            for round in 0..2000usize {
                let (n, m) = (round % 7, round / 7 % 7);
                let a = numbers(n + 1, [1, 2, 50][round % 3], &mut state);
                let b = numbers(m + 1, [1, 2, 50][round / 3 % 3], &mut state);
                let image = |p: &[i64]| {
                    let integers: Vec<Integer> = p.iter().map(|&c| Integer::from(c)).collect();
                    Limbs::new(&integers).residues(&f)
                };
                let expected = resultant_formal_subresultant(
                    &UniPoly::from_i64(&a),
                    n,
                    &UniPoly::from_i64(&b),
                    m,
                    &Budget::unlimited(),
                )
                .unwrap();
                let expected = expected.mod_u64(f.prime());
                let (a_image, b_image) = (image(&a), image(&b));
                assert_eq!(
                    f.integer(resultant_modulo(&f, &a_image, &b_image)),
                    expected,
                    "{a:?} {b:?} mod {}",
                    f.prime()
                );
                assert_eq!(f.integer(resultant_euclid(&f, &a_image, &b_image)), expected, "{a:?} {b:?}");
            }
        }
    }
}
