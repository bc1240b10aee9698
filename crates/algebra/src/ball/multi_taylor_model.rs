//! Analytic functions of several variables as polynomials with a bound of all that is left out.

use super::flow::exponential_of;
use super::implicit::{Approximate, implicit};
use super::solutions::{Scaled, Summed, solutions_by_taylor};
use super::{Along, Ball, Elementary, Enclosed, exp};
use crate::number::Integer;
use raw_sum::RawSum;
use std::sync::Arc;

/// The monomials in some variables up to a total degree, by degree, and the places of their products.
#[derive(Debug, PartialEq, Eq)]
struct Monomials {
    degree: usize,
    exponents: Vec<Vec<u32>>,
    /// The first monomial of each degree, and the number of all.
    starts: Vec<usize>,
    /// For each monomial the places of its products with those whose product is not beyond the degree.
    products: Vec<Vec<u32>>,
}

impl Monomials {
    fn new(variables: usize, degree: usize) -> Monomials {
        let mut exponents = vec![vec![0; variables]];
        let mut starts = vec![0, 1];
        for total in 1..=degree {
            let before = exponents[starts[total - 1]..].to_vec();
            for monomial in before {
                // Each is made once: by raising its last variable.
                let last = monomial.iter().rposition(|e| *e > 0).unwrap_or(0);
                exponents.extend((last..variables).map(|i| {
                    let mut next = monomial.clone();
                    next[i] += 1;
                    next
                }));
            }
            starts.push(exponents.len());
        }
        let place: std::collections::HashMap<&[u32], u32> =
            exponents.iter().enumerate().map(|(i, e)| (e.as_slice(), i as u32)).collect();
        let products = exponents
            .iter()
            .map(|a| {
                let own: u32 = a.iter().sum();
                let most = starts[degree - own as usize + 1];
                let product = |b: &Vec<u32>| a.iter().zip(b).map(|(x, y)| x + y).collect::<Vec<u32>>();
                exponents[..most].iter().map(|b| place[product(b).as_slice()]).collect()
            })
            .collect();
        Monomials { degree, exponents, starts, products }
    }
}

/// A power series in several variables of which the coefficients up to a total degree are known, and the sum of the absolute values of all
/// others, with all that the known ones are off, is bounded: a function that is known on the polydisc `|x_i| <= 1`.
///
/// As [`TaylorModel`](super::TaylorModel), in the algebra of series in several variables in which the norm of a product is at most the product of
/// the norms. Coefficients are numbers in fixed point: what rounding them leaves out is left out with the rest.
///
/// ```
/// use jurist_algebra::ball::{Ball, MultiTaylorModel};
/// // exp(x y/4) with |x|, |y| <= 1
/// let [zero, half] = [0, 1].map(|n| Ball::from_integer(&n.into(), 64).shifted(-1));
/// let [x, y] = MultiTaylorModel::linear(&[(zero.clone(), half.clone()), (zero, half)], 4).try_into().unwrap();
/// let model = x.mul(&y).exp();
/// let (exponents, square) = model.terms().find(|(e, _)| *e == [2, 2]).unwrap();
/// assert_eq!((exponents.len(), square.bit_length()), (2, 64 - 5 + 1)); // 1/32
/// // What is left out is 1/384 and less.
/// assert_eq!(model.rest_units().bit_length(), 64 - 8);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MultiTaylorModel {
    monomials: Arc<Monomials>,
    bits: u64,
    /// In units of the last place, as is the rest.
    coefficients: Vec<Integer>,
    rest: Integer,
}

impl MultiTaylorModel {
    /// `c_i + r_i x_i` for each of the variables, up to a total degree of at least one.
    ///
    /// # Panics
    /// For degree zero, or when the numbers of bits differ.
    pub fn linear(lines: &[(Ball, Ball)], degree: usize) -> Vec<MultiTaylorModel> {
        assert!(degree > 0, "a line has degree one");
        let monomials = Arc::new(Monomials::new(lines.len(), degree));
        let bits = lines.first().map_or(0, |(c, _)| c.bits());
        let coefficients = vec![Integer::ZERO; monomials.exponents.len()];
        MultiTaylorModel { bits, coefficients, rest: Integer::ZERO, monomials }.lines(lines)
    }

    /// The same in the variables and up to the degree of a known model: what does not depend on the lines is not computed again.
    ///
    /// # Panics
    /// When the numbers of bits, or of variables, differ.
    pub fn lines(&self, lines: &[(Ball, Ball)]) -> Vec<MultiTaylorModel> {
        let bits = lines.first().map_or(0, |(c, _)| c.bits());
        let zero = MultiTaylorModel { bits, ..self.nothing() };
        assert!(zero.coefficients.len() > lines.len(), "each line has its variable");
        let line = |(i, (c, r)): (usize, &(Ball, Ball))| {
            assert!(c.bits() == bits && r.bits() == bits, "all balls have the same bits");
            let mut out = zero.constant(c);
            let (middle, radius) = middle_and_radius(r);
            out.coefficients[1 + i] = middle;
            out.rest += &radius;
            out
        };
        lines.iter().enumerate().map(line).collect()
    }

    /// The exponents of each monomial with its coefficient in units of the last place, by total degree.
    pub fn terms(&self) -> impl Iterator<Item = (&[u32], &Integer)> {
        self.monomials.exponents.iter().map(Vec::as_slice).zip(&self.coefficients)
    }

    /// A bound of the sum of the absolute values of all that is left out, in units of the last place.
    pub fn rest_units(&self) -> &Integer {
        &self.rest
    }

    fn with(&self, coefficients: Vec<Integer>, rest: Integer) -> MultiTaylorModel {
        MultiTaylorModel { monomials: Arc::clone(&self.monomials), bits: self.bits, coefficients, rest }
    }

    /// What so many roundings are off at most.
    fn roundings(&self) -> Integer {
        Integer::from(self.coefficients.len() as u64)
    }

    fn norm(&self) -> Integer {
        self.coefficients.iter().fold(self.rest.clone(), |sum, c| sum + c.abs())
    }

    /// How far from the first coefficient values are at most.
    fn around(&self) -> Integer {
        self.norm() - self.coefficients[0].abs()
    }

    /// The polynomial alone.
    fn known(&self) -> MultiTaylorModel {
        MultiTaylorModel { rest: Integer::ZERO, ..self.clone() }
    }

    /// The sum.
    pub fn add(&self, other: &MultiTaylorModel) -> MultiTaylorModel {
        let sums = self.coefficients.iter().zip(&other.coefficients).map(|(a, b)| a + b);
        self.with(sums.collect(), &self.rest + &other.rest)
    }

    /// The difference.
    pub fn sub(&self, other: &MultiTaylorModel) -> MultiTaylorModel {
        let differences = self.coefficients.iter().zip(&other.coefficients).map(|(a, b)| a - b);
        self.with(differences.collect(), &self.rest + &other.rest)
    }

    /// The product with an integer.
    pub fn scaled(&self, n: &Integer) -> MultiTaylorModel {
        self.with(self.coefficients.iter().map(|c| c * n).collect(), &self.rest * &n.abs())
    }

    /// The sums of the absolute values of the coefficients of each degree.
    fn sizes(&self) -> Vec<Integer> {
        let sum =
            |ends: &[usize]| self.coefficients[ends[0]..ends[1]].iter().fold(Integer::ZERO, |sum, c| sum + c.abs());
        self.monomials.starts.windows(2).map(sum).collect()
    }

    /// The product: as many products of numbers as there are pairs of monomials whose product is not beyond the degree.
    pub fn mul(&self, other: &MultiTaylorModel) -> MultiTaylorModel {
        let mut sum = RawSum::of(self);
        sum.add_product(self, other);
        sum.model(self)
    }

    /// The quotient; `None` where the divisor may have a zero in the polydisc.
    ///
    /// With `q` any polynomial, `a/b - q = (a - q b)/b`; Newton's iteration makes it one that has the first terms. The norm of `1/b` is at
    /// most that of such a polynomial `p` for `a = 1`, over one less the norm of `1 - p b`.
    pub fn div(&self, other: &MultiTaylorModel) -> Option<MultiTaylorModel> {
        let one = self.integer(&Integer::ONE);
        let first = Ball::from_units(other.coefficients[0].clone(), other.coefficients[0].clone(), self.bits);
        let mut inverse = self.constant(&Ball::from_integer(&Integer::ONE, self.bits).div(&first)?).known();
        let divisor = other.known();
        for _ in 0..self.doublings() {
            let missing = one.sub(&divisor.mul(&inverse)).known();
            inverse = inverse.add(&inverse.mul(&missing)).known();
        }
        let unit = &Integer::ONE << self.bits;
        let left = &unit - &one.sub(&inverse.mul(other)).norm();
        if !left.sign().is_gt() {
            return None;
        }
        let quotient = self.known().mul(&inverse).known();
        let missed = self.sub(&quotient.mul(other)).norm();
        let rest = up(missed * ratio_up(&inverse.norm(), &left, self.bits), self.bits);
        Some(MultiTaylorModel { rest, ..quotient })
    }

    /// How often a number of known terms is doubled, from one to all.
    fn doublings(&self) -> u32 {
        (self.monomials.degree + 1).next_power_of_two().ilog2()
    }

    /// The square root; `None` where the function may have a zero in the polydisc or is negative.
    ///
    /// The rest is bounded as that of a [`TaylorModel`](super::TaylorModel).
    pub fn sqrt(&self) -> Option<MultiTaylorModel> {
        let first = Ball::from_units(self.coefficients[0].clone(), self.coefficients[0].clone(), self.bits);
        let mut root = self.constant(&first.sqrt()?).known();
        for _ in 0..self.doublings() {
            let quotient = self.known().div(&root)?.known();
            let twice = root.add(&quotient);
            root = self.with(twice.coefficients.into_iter().map(|c| c >> 1).collect(), Integer::ZERO);
        }
        let least = root.least();
        if least.is_zero() {
            return None;
        }
        let missed = self.sub(&root.mul(&root)).norm();
        let relative = ratio_up(&ratio_up(&missed, &least, self.bits), &least, self.bits);
        if relative > &Integer::ONE << self.bits {
            return None;
        }
        let rest = up(relative * root.norm(), self.bits);
        Some(MultiTaylorModel { rest, ..root })
    }

    /// The exponential: `exp(c) exp(g)`, `c` the constant term, and the sum of the first powers of `g`; those left out are at most
    /// those of its norm.
    pub fn exp(&self) -> MultiTaylorModel {
        let first = Ball::from_units(self.coefficients[0].clone(), self.coefficients[0].clone(), self.bits);
        let mut moving = self.clone();
        moving.coefficients[0] = Integer::ZERO;
        let one = self.integer(&Integer::ONE);
        let mut sum = one.clone();
        for k in (1..=self.monomials.degree as u64).rev() {
            sum = one.add(&Summed::divided_by(&moving.mul(&sum), k));
        }
        let norm = moving.norm();
        let norm = Ball::from_units(norm.clone(), norm, self.bits);
        let mut beyond = exp(&norm).sub(&Ball::from_integer(&Integer::ONE, self.bits));
        let mut power = Ball::from_integer(&Integer::ONE, self.bits);
        for k in 1..=self.monomials.degree as u64 {
            power = power.mul(&norm).divided_by(k);
            beyond = beyond.sub(&power);
        }
        sum.rest += &beyond.magnitude_units();
        self.constant(&exp(&first)).mul(&sum)
    }
}

/// The middle of a ball and how far from it the ends are.
fn middle_and_radius(c: &Ball) -> (Integer, Integer) {
    let middle = c.middle_units();
    let radius = c.width_units() - (c.width_units() >> 1);
    (middle, radius)
}

/// `n 2^-bits`, rounded up.
fn up(n: Integer, bits: u64) -> Integer {
    -(-n >> bits)
}

/// `a/b` in units, rounded up, for positive `b`.
fn ratio_up(a: &Integer, b: &Integer, bits: u64) -> Integer {
    -(-(a << bits)).div_mod_floor(b).0
}

impl Enclosed for MultiTaylorModel {
    fn nothing(&self) -> MultiTaylorModel {
        self.with(vec![Integer::ZERO; self.coefficients.len()], Integer::ZERO)
    }
    fn plus(&self, other: &MultiTaylorModel) -> MultiTaylorModel {
        self.add(other)
    }
    fn minus(&self, other: &MultiTaylorModel) -> MultiTaylorModel {
        self.sub(other)
    }
    fn times(&self, other: &MultiTaylorModel) -> MultiTaylorModel {
        self.mul(other)
    }
    fn over(&self, other: &MultiTaylorModel) -> Option<MultiTaylorModel> {
        self.div(other)
    }
    fn is_nothing(&self) -> bool {
        self.rest.is_zero() && self.coefficients.iter().all(Integer::is_zero)
    }
    fn sum_of_products<'a>(&self, pairs: impl Iterator<Item = (&'a Self, &'a Self)>) -> MultiTaylorModel {
        let mut sum: Option<RawSum> = None;
        for (a, b) in pairs.filter(|(a, b)| !a.is_nothing() && !b.is_nothing()) {
            sum.get_or_insert_with(|| RawSum::of(self)).add_product(a, b);
        }
        sum.map_or_else(|| self.nothing(), |sum| sum.model(self))
    }
    fn least(&self) -> Integer {
        let least = self.coefficients[0].abs() - self.around();
        if least.is_negative() { Integer::ZERO } else { least }
    }
}

impl Scaled for MultiTaylorModel {
    fn norm_units(&self) -> Integer {
        self.norm()
    }
    fn rescaled(&self, bits: u64, exponent: i64) -> MultiTaylorModel {
        // One shift: units of the new last place.
        let by = exponent + bits as i64 - self.bits as i64;
        let shift = by.unsigned_abs();
        let all = self.coefficients.iter();
        let (coefficients, rest) = if by >= 0 {
            (all.map(|c| c << shift).collect(), &self.rest << shift)
        } else {
            (all.map(|c| c >> shift).collect(), up(self.rest.clone(), shift) + self.roundings())
        };
        MultiTaylorModel { bits, ..self.with(coefficients, rest) }
    }
}

impl Summed for MultiTaylorModel {
    fn one(&self) -> MultiTaylorModel {
        self.integer(&Integer::ONE)
    }
    fn divided_by(&self, n: u64) -> MultiTaylorModel {
        let n = Integer::from(n);
        let coefficients = self.coefficients.iter().map(|c| c.div_mod_floor(&n).0).collect();
        let rest = -(-&self.rest).div_mod_floor(&n).0 + self.roundings();
        self.with(coefficients, rest)
    }
    fn widened(&self) -> MultiTaylorModel {
        self.with(self.coefficients.clone(), &self.rest + &Integer::ONE)
    }
}

impl Approximate for MultiTaylorModel {
    fn near(&self) -> MultiTaylorModel {
        self.known()
    }
    fn around(&self, radius: &Integer) -> MultiTaylorModel {
        self.with(self.coefficients.clone(), &self.rest + radius)
    }
    fn size(&self) -> Integer {
        self.norm()
    }
}

impl Elementary for MultiTaylorModel {
    fn bits(&self) -> u64 {
        self.bits
    }
    fn constant(&self, c: &Ball) -> MultiTaylorModel {
        let (middle, radius) = middle_and_radius(c);
        let mut out = self.nothing();
        out.coefficients[0] = middle;
        out.rest = radius;
        out
    }
    fn range(&self) -> Ball {
        let (middle, around) = (&self.coefficients[0], self.around());
        Ball::from_units(middle - &around, middle + &around, self.bits)
    }
    fn square_root(&self) -> Option<MultiTaylorModel> {
        self.sqrt()
    }
    fn exponential(&self) -> MultiTaylorModel {
        self.exp()
    }
    fn solutions(&self, coefficients: &[MultiTaylorModel]) -> Vec<MultiTaylorModel> {
        solutions_by_taylor(coefficients, self)
    }
    fn as_models(list: &[MultiTaylorModel]) -> Option<&[MultiTaylorModel]> {
        Some(list)
    }
    fn of_models(models: Vec<MultiTaylorModel>) -> Option<Vec<MultiTaylorModel>> {
        Some(models)
    }
    fn exponential_of(n: usize, matrix: &[MultiTaylorModel]) -> Option<Vec<MultiTaylorModel>> {
        exponential_of(n, matrix)
    }
    fn line(&self) -> Option<Along> {
        self.in_one_variable()
    }
    fn of_powers(&self, variable: Option<usize>, coefficients: &[Ball]) -> MultiTaylorModel {
        self.with_powers(variable, coefficients)
    }
    fn implicit(
        &self,
        start: &Ball,
        f: &dyn Fn(&MultiTaylorModel) -> Option<[MultiTaylorModel; 2]>,
    ) -> Option<MultiTaylorModel> {
        implicit(self, start, self.monomials.degree + 1, f)
    }
}

mod along;
mod raw_sum;

#[cfg(test)]
mod tests;
