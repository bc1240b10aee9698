//! The square-free factors of a resultant, without the resultant itself.
//!
//! A discriminant of a resultant is nearly a square: the crossings of two branches are double zeros. Its factors have a
//! fraction of its degree and of its digits, so they are found modulo a few primes, and the values of their product are
//! compared with those of the determinant modulo as many primes as determine that.

use super::chinese::{Chinese, Limbs};
use super::gcd::{divided_by_monic, monic_gcd};
use super::multimodular_resultant::dense;
use super::prime_field::PrimeField;
use super::resultant::DensePair;
use super::sylvester_bounds::Frame;
use crate::limits::{checkpoint, parallel_map};
use crate::number::Integer;
use crate::poly::{Poly, UniPoly};

/// So many bits of a product of primes beyond what a fraction needs make it believable; it is proved later.
const SPARE_BITS: u64 = 40;

/// A resultant that fewer primes determine is computed whole.
const MIN_PRIMES: usize = 16;

/// An attempt to lift the factors is made whenever there are one more prime for so many.
const PRIMES_PER_ATTEMPT: usize = 8;

/// Polynomials and their multiplicities.
type Factors = Vec<(UniPoly, usize)>;

/// A monic factor modulo a prime and its multiplicity.
type Factor = (Vec<u64>, usize);

/// What is known modulo one prime: the multiplicity of the zero 0, and all other factors.
struct Image {
    field: PrimeField,
    leading: u64,
    at_zero: usize,
    factors: Vec<Factor>,
}

impl Image {
    /// The number of distinct zeros, and how they are distributed.
    fn shape(&self) -> (usize, Vec<(usize, usize)>) {
        let degrees = self.factors.iter().map(|(f, e)| (f.len() - 1, *e));
        let distinct = degrees.clone().map(|d| d.0).sum();
        (distinct, std::iter::once((1, self.at_zero)).chain(degrees).collect())
    }

    /// Whether each factor has so small a part of the zeros that a fraction of the primes finds it: its coefficients are
    /// lifted as quotients, which takes twice their digits.
    fn is_promising(&self) -> bool {
        let all: usize = self.factors.iter().map(|(f, e)| (f.len() - 1) * e).sum();
        self.factors.iter().all(|(f, _)| 2 * (f.len() - 1) <= all)
    }
}

impl Image {
    /// This polynomial divided by the product of the powers of some others, which may have the factor `x` first; `None` where
    /// they are not multiples of its own factors.
    fn quotient(&self, factors: &[(Vec<u64>, u64)]) -> Option<u64> {
        let f = &self.field;
        let others = &factors[usize::from(self.at_zero > 0)..];
        if others.len() != self.factors.len() {
            return None;
        }
        let mut product = f.one();
        for ((own, multiplicity), (other, power)) in self.factors.iter().zip(others) {
            let leading = *other.last()?;
            let is_multiple = own.len() == other.len() && own.iter().zip(other).all(|(&c, &d)| f.mul(leading, c) == d);
            if leading == 0 || !is_multiple || *multiplicity as u64 != *power {
                return None;
            }
            product = f.mul(product, f.power(leading, *power));
        }
        Some(f.mul(self.leading, f.inverse(product)))
    }
}

/// A resultant over `Z[x]`, to be evaluated modulo primes.
struct Determinant<'a> {
    pair: DensePair<'a>,
    limbs: Limbs,
    /// The power of `x` and the number that divide it for certain are left out of its values.
    frame: Frame,
}

impl Determinant<'_> {
    fn points(&self) -> usize {
        self.frame.points()
    }

    fn bits(&self) -> u64 {
        self.frame.bits + SPARE_BITS
    }
}

/// The square-free decomposition of the resultant of two polynomials over `Z[x]`, up to a constant: primitive polynomials with
/// positive leading coefficients, pairwise coprime, with their multiplicities. `None` where the resultant is zero, or where
/// this way does not find it.
///
/// Only squares, cubes and so on are told apart: the factors need not be irreducible.
///
/// Cost: that of [`resultant_square_free_decomposition`](crate::poly::resultant_square_free_decomposition) without what it falls back on.
pub fn square_free_decomposition(a: &Poly<UniPoly>, b: &Poly<UniPoly>) -> Option<Vec<(UniPoly, usize)>> {
    let (n, m) = (a.degree()?, b.degree()?);
    let pair = dense(a, n, b, m);
    let frame = Frame::new(&pair)?;
    let order = frame.ranges[0].0;
    let determinant = Determinant { limbs: pair.limbs(&frame), pair, frame };
    let mut factors = determinant.factors()?;
    if order > 0 {
        match factors.iter_mut().find(|(f, _)| *f == Poly::x()) {
            Some((_, multiplicity)) => *multiplicity += order,
            None => factors.insert(0, (Poly::x(), order)),
        }
    }
    Some(factors)
}

impl Determinant<'_> {
    /// The factors without the known power of `x`: a candidate that is proved.
    ///
    /// The determinant is a multiple of the product modulo each prime, hence by a number modulo all of them; and then equal to
    /// that, since both are below half the product of the primes.
    fn factors(&self) -> Option<Factors> {
        let chinese = Chinese::for_bits(self.bits());
        if chinese.fields().len() < MIN_PRIMES {
            return None;
        }
        let (candidate, images) = self.candidate(chinese.fields())?;
        let degree: usize = candidate.iter().map(|(f, e)| (f.coeffs().len() - 1) * e).sum();
        if degree >= self.points() {
            return None;
        }
        let limbs: Vec<(Limbs, u64)> = candidate.iter().map(|(f, e)| (Limbs::new(f.coeffs()), *e as u64)).collect();
        let quotient = |f: &PrimeField| {
            let factors: Vec<(Vec<u64>, u64)> = limbs.iter().map(|(limbs, e)| (limbs.residues(f), *e)).collect();
            match images.iter().find(|image| image.field == *f) {
                Some(image) => image.quotient(&factors),
                None => self.quotient(f, &factors),
            }
        };
        let quotients: Option<Vec<u64>> = self.images(chinese.fields(), quotient).into_iter().collect();
        let quotient = chinese.integer(quotients?);
        let norm = |f: &UniPoly| f.coeffs().iter().fold(Integer::ZERO, |sum, c| sum + c.abs());
        let bits: u64 = candidate.iter().map(|(f, e)| norm(f).bit_length() * *e as u64).sum();
        (bits + quotient.bit_length() <= self.bits()).then_some(candidate)
    }

    /// What the determinant is modulo a prime, divided by the product of the powers of some polynomials; `None` where it is no
    /// multiple of that.
    fn quotient(&self, f: &PrimeField, factors: &[(Vec<u64>, u64)]) -> Option<u64> {
        let grid = self.pair.grid(f, &self.frame);
        let values = self.pair.values(&self.limbs, &self.frame, &grid);
        let mut product = vec![f.one(); self.points()];
        for (factor, multiplicity) in factors {
            let at = grid.evaluate(factor, factor.len(), 1, self.points());
            for (p, v) in product.iter_mut().zip(at) {
                *p = f.mul(*p, f.power(v, *multiplicity));
            }
        }
        let known = product.iter().position(|&p| p != 0)?;
        let quotient = f.mul(values[known], f.inverse(product[known]));
        values.iter().zip(&product).all(|(&v, &p)| v == f.mul(quotient, p)).then_some(quotient)
    }

    /// Integer polynomials with the images that the decomposition has modulo the first primes, and these images.
    fn candidate(&self, primes: &[PrimeField]) -> Option<(Factors, Vec<Image>)> {
        let mut images: Vec<Image> = Vec::new();
        let mut tried = 0;
        while tried < primes.len() {
            // The first prime tells whether there is a chance; later some are taken before each attempt.
            let more = if tried == 0 { 1 } else { (tried / PRIMES_PER_ATTEMPT).max(2) };
            let batch = &primes[tried..(tried + more).min(primes.len())];
            tried += batch.len();
            for image in self.images(batch, |f| self.decomposed(f)) {
                let image = image?;
                match images.first().map(|first| (first.shape(), image.shape())) {
                    None if !image.is_promising() => return None,
                    // Modulo an unlucky prime different zeros fall together.
                    Some((known, shape)) if shape.0 < known.0 => continue,
                    Some((known, shape)) if shape.0 > known.0 => images.clear(),
                    Some((known, shape)) if shape != known => return None,
                    _ => {}
                }
                images.push(image);
            }
            if let Some(candidate) = lifted(&images) {
                return Some((candidate, images));
            }
        }
        None
    }

    fn images<T: Send>(&self, primes: &[PrimeField], image: impl Fn(&PrimeField) -> T + Send + Sync) -> Vec<T> {
        if self.pair.is_worth_threads(self.points(), primes.len()) {
            parallel_map(primes, image)
        } else {
            primes.iter().map(image).collect()
        }
    }

    /// The square-free decomposition modulo a prime; `None` for zero.
    fn decomposed(&self, f: &PrimeField) -> Option<Image> {
        let mut grid = self.pair.grid(f, &self.frame);
        let mut coefficients = self.pair.values(&self.limbs, &self.frame, &grid);
        grid.prepare_interpolation(f.inverse(grid.factorial()));
        grid.interpolate(&mut coefficients, self.points(), 1);
        Image::of(f, coefficients)
    }
}

impl Image {
    /// The square-free decomposition of a polynomial modulo a prime above its degree by Yun's algorithm
    /// ([Yun1976](crate::bibliography#yun1976)). `None` for zero.
    fn of(f: &PrimeField, mut p: Vec<u64>) -> Option<Image> {
        p.truncate(p.iter().rposition(|&c| c != 0)? + 1);
        let at_zero = p.iter().position(|&c| c != 0)?;
        p.drain(..at_zero);
        let leading = *p.last()?;
        let mut factors = Vec::new();
        if p.len() > 1 {
            let derivative = derivative(f, &p);
            let common = monic_gcd(f, p.clone(), derivative.clone());
            let mut rest = divided_by_monic(f, &p, &common);
            let mut d = minus_derivative(f, divided_by_monic(f, &derivative, &common), &rest);
            let mut multiplicity = 1;
            while rest.len() > 1 {
                let factor = monic_gcd(f, rest.clone(), d.clone());
                rest = divided_by_monic(f, &rest, &factor);
                d = minus_derivative(f, divided_by_monic(f, &d, &factor), &rest);
                if factor.len() > 1 {
                    factors.push((factor, multiplicity));
                }
                multiplicity += 1;
            }
        }
        Some(Image { field: *f, leading, at_zero, factors })
    }
}

fn derivative(f: &PrimeField, p: &[u64]) -> Vec<u64> {
    p.iter().enumerate().skip(1).map(|(k, &c)| f.mul(f.residue(k as u64), c)).collect()
}

/// `p - q'`, without zeros at the top.
fn minus_derivative(f: &PrimeField, mut p: Vec<u64>, q: &[u64]) -> Vec<u64> {
    let derivative = derivative(f, q);
    p.resize(p.len().max(derivative.len()), 0);
    for (a, b) in p.iter_mut().zip(derivative) {
        *a = f.sub(*a, b);
    }
    p.truncate(p.iter().rposition(|&c| c != 0).map_or(0, |last| last + 1));
    p
}

/// Primitive integer polynomials with these monic images; `None` where more primes are needed.
fn lifted(images: &[Image]) -> Option<Factors> {
    let first = images.first()?;
    let chinese = Chinese::new(images.iter().map(|image| image.field).collect());
    let product = images.iter().fold(Integer::ONE, |product, image| product * Integer::from(image.field.prime()));
    // The denominators first, the longest ones before the others: most attempts fail there.
    let mut order: Vec<usize> = (0..first.factors.len()).collect();
    order.sort_by_key(|&k| std::cmp::Reverse(first.factors[k].0.len()));
    let mut denominators = vec![Integer::ONE; order.len()];
    for k in order {
        let sums = images.iter().map(|image| combined(&image.field, &image.factors[k].0));
        denominators[k] = denominator(&chinese.integer(sums), &product)?;
    }
    let mut out = Vec::with_capacity(denominators.len() + 1);
    if first.at_zero > 0 {
        out.push((Poly::x(), first.at_zero));
    }
    for ((k, (factor, multiplicity)), mut common) in first.factors.iter().enumerate().zip(denominators) {
        let mut numerators = Vec::with_capacity(factor.len());
        for j in 0..factor.len() {
            let coefficient = chinese.integer(images.iter().map(|image| image.factors[k].0[j]));
            let mut numerator = symmetric(&(coefficient * &common), &product);
            let is_short =
                |n: &Integer, d: &Integer| n.bit_length() + d.bit_length() + SPARE_BITS / 2 <= product.bit_length();
            if !is_short(&numerator, &common) {
                // The sum had a part of the denominator as a factor, a power of two as a rule.
                let further = denominator(&numerator, &product)?;
                numerator = symmetric(&(numerator * &further), &product);
                numerators.iter_mut().for_each(|n| *n *= &further);
                common *= further;
                if !is_short(&numerator, &common) {
                    return None;
                }
            }
            numerators.push(numerator);
        }
        out.push((UniPoly::new(numerators).primitive_part(), *multiplicity));
    }
    Some(out)
}

/// A sum of multiples of the coefficients, which keeps all of the common denominator but what it divides by chance.
fn combined(f: &PrimeField, coefficients: &[u64]) -> u64 {
    let mut multiplier = 1u64;
    coefficients.iter().fold(0, |sum, &c| {
        multiplier = multiplier * 16807 % 32749;
        f.add(sum, f.mul(f.residue(multiplier), c))
    })
}

/// The representative of least magnitude.
fn symmetric(x: &Integer, modulus: &Integer) -> Integer {
    let rest = x.div_mod_floor(modulus).1;
    if &(&rest << 1) > modulus { rest - modulus } else { rest }
}

/// The denominator of the fraction whose value modulo a number is given, where one is much shorter than chance would have it: the
/// step of Euclid's algorithm with the greatest quotient ([Monagan2004](crate::bibliography#monagan2004)).
fn denominator(value: &Integer, modulus: &Integer) -> Option<Integer> {
    let (mut large, mut small) = (modulus.clone(), value.div_mod_floor(modulus).1);
    let (mut before, mut factor) = (Integer::ZERO, Integer::ONE);
    let mut best = (0, Integer::ONE);
    while !small.is_zero() {
        checkpoint(4);
        let (quotient, rest) = large.div_mod_floor(&small);
        let bits = quotient.bit_length();
        if best.0 < bits {
            best = (bits, factor.clone());
        }
        let mut next = before;
        next.sub_mul_assign(&quotient, &factor);
        (large, small) = (small, rest);
        (before, factor) = (factor, next);
    }
    (best.0 > SPARE_BITS).then(|| best.1.abs())
}
