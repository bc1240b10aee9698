//! A part of a loop behind holds: the matrix `A + K B` and its characteristic polynomial, with a symbol for each coefficient.

use super::exact_zeros::{exact_zeros, missing_degrees};
use super::nodes::{Matrices, enclosed, exceeds_from, in_parameter};
use super::steady_state::steady_state;
use crate::model::{Samples, SamplesPart, Symbols, quotient_at, rank_bound};
use crate::stability::SymbolicPolynomial;
use jurist_algebra::ball::{Ball, BallMatrix};
use jurist_algebra::limits::{Budget, checkpoint, until_shown};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use jurist_algebra::real::{Enclosing, Origin, Transcendental};
use jurist_algebra::symbols::{Definition, EnclosedNumber, Symbols as Values};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The degree in the parameter up to which polynomials are looked at.
const MOST_POWERS: usize = 4;

/// A part of the loop: a matrix that is a polynomial in `K`.
#[derive(Debug)]
pub(super) struct Part {
    symbols: Arc<Symbols>,
    /// The matrix at `K = 0`.
    constant: RationalMatrix,
    matrices: Matrices,
    /// A bound of the degree in `K`.
    pub degree: usize,
    /// The exact factor of `D(z; 0)`: polynomials of rational parts, and the roots at 1 that integrators bring.
    exact: UniPoly,
    /// The other parts of `A`, each with the number of its roots at 1, which are in the exact factor.
    others: Vec<(Vec<usize>, usize)>,
    /// A lower bound of the number of roots that are 0 for every `K`, from rational rows that are linearly dependent.
    at_origin: usize,
    /// The exact factor of `N_p(z)`, the coefficient of each power `K^p` in `D(z; K)`.
    zeros: UniPoly,
    /// `n - 1` less the degree of `N_p`.
    missing: usize,
    /// `d(K)` with `D(1; K) = c d(K)` for a number `c` other than 0, where that is known.
    at_rest: Option<UniPoly>,
    known: Mutex<BTreeMap<u64, Arc<Vec<Ball>>>>,
}

impl Part {
    /// The matrix `A + K B`. `None` where the degree is too large.
    pub fn linear(symbols: &Arc<Symbols>, constant: RationalMatrix, linear: RationalMatrix) -> Option<Part> {
        let degree = rank_bound(&linear);
        if degree > MOST_POWERS {
            return None;
        }
        let rest = steady_state(&constant, &linear, symbols).filter(|d| !d.is_zero());
        let at_origin = dependent_rows(&constant, &linear);
        let (zeros, missing) = match degree {
            1 => (exact_zeros(&constant, &linear), missing_degrees(&constant, &linear)),
            _ => (UniPoly::monomial(Integer::ONE, at_origin), 0),
        };
        let of = Part::of_constant(symbols, constant, Matrices::Linear(linear), degree);
        let mut part = Part { at_origin, zeros, missing, at_rest: rest, ..of };
        if part.degree > 0 && part.at_rest.is_some() && part.factor_at_rest(super::BITS)?.contains_zero() {
            part.at_rest = None;
        }
        Some(part)
    }

    /// A part of a loop over a hyperperiod, by its matrix at `K = 0` and the matrices of its samples.
    pub fn lifted(symbols: &Arc<Symbols>, constant: RationalMatrix, samples: &Arc<Samples>, of: &SamplesPart) -> Part {
        let matrices = Matrices::Samples(Arc::clone(samples), of.clone());
        let mut part = Part::of_constant(symbols, constant, matrices, of.degree);
        let root_at_one = UniPoly::from_i64(&[-1, 1]);
        let mut rest = part.exact.clone();
        let known = std::iter::from_fn(|| rest.div_exact(&root_at_one).map(|next| rest = next)).count();
        // Roots that the factors of rational parts do not have are those of the other part.
        if let [(_, at_one)] = part.others.as_mut_slice() {
            for _ in known..of.at_one {
                *at_one += 1;
                part.exact = part.exact.times(&root_at_one);
            }
        }
        part
    }

    /// What is known of a part by its matrix at `K = 0`.
    fn of_constant(symbols: &Arc<Symbols>, constant: RationalMatrix, matrices: Matrices, degree: usize) -> Part {
        let (mut exact, mut others) = (UniPoly::one(), Vec::new());
        for block in constant.decoupled_parts() {
            let own = constant.principal(&block);
            match rational_polynomial(&own) {
                Some(p) => exact = exact.times(&p),
                None => {
                    let at_one = integrators(&own, symbols);
                    for _ in 0..at_one {
                        exact = exact.times(&UniPoly::from_i64(&[-1, 1]));
                    }
                    others.push((block, at_one));
                }
            }
        }
        Part {
            symbols: Arc::clone(symbols),
            constant,
            matrices,
            degree,
            exact,
            others,
            at_origin: 0,
            zeros: UniPoly::one(),
            missing: 0,
            at_rest: None,
            known: Mutex::default(),
        }
    }

    /// The least power of `K` in `d(K)`, with its coefficient.
    fn lowest_at_rest(&self) -> (usize, Integer) {
        let d = self.at_rest.as_ref().map(UniPoly::coeffs).unwrap_or_default();
        d.iter().cloned().enumerate().find(|(_, c)| !c.is_zero()).unwrap_or((0, Integer::ONE))
    }

    /// `c` in `D(1; K) = c d(K)`, times a whole number.
    fn factor_at_rest(&self, bits: u64) -> Option<Ball> {
        let found = self.coefficients(bits)?;
        let (others, m) = (self.others_degree(), self.beside());
        let list = match self.lowest_at_rest().0 {
            // The leading 1 belongs to the sum.
            0 => &found[..others],
            power => found.get(others + (power - 1) * m..others + power * m)?,
        };
        let lead = if self.lowest_at_rest().0 == 0 { Integer::ONE } else { Integer::ZERO };
        Some(list.iter().fold(Ball::from_integer(&lead, bits), |sum, c| sum.add(c)))
    }

    /// The characteristic polynomial at `K = 0`.
    pub fn at_zero(&self, values: &[Ball], bits: u64) -> Option<Vec<Ball>> {
        Some(enclosed(&self.constant, values, bits)?.characteristic_polynomial(bits))
    }

    /// A power of two beyond which, and beyond whose negative, the loop is unstable; `None` where enclosures show none.
    ///
    /// A polynomial of degree `n` with its roots inside of the unit circle has coefficients of at most the binomials `(n over i)`.
    pub fn unstable_beyond(&self, bits: u64) -> Option<Rational> {
        let values = self.symbols.enclosed(bits)?;
        let nodes = self.matrices.polynomials(&self.constant, &values, self.degree, bits)?;
        let n = self.constant.rows();
        let binomial = |i: usize| (0..i).fold(Integer::ONE, |b, k| (&b * &whole(n - k)).div_exact(&whole(k + 1)));
        let all = in_parameter(&nodes, n, bits);
        let least = all.iter().enumerate().filter_map(|(i, c)| exceeds_from(c, &binomial(i), bits)).min()?;
        Some(Rational::from(Integer::ONE << least))
    }

    /// The degree of the enclosed factor of `D(z; 0)`.
    fn others_degree(&self) -> usize {
        self.constant.rows() - self.exact.degree().unwrap_or(0)
    }

    /// The number of coefficients of the enclosed factor of `N_p`.
    fn beside(&self) -> usize {
        self.constant.rows() - self.zeros.degree().unwrap_or(0) - self.missing
    }

    /// The coefficients of the enclosed factor of `D(z; 0)` without the leading 1, then those of the enclosed factor of each `N_p`.
    fn coefficients(&self, bits: u64) -> Option<Arc<Vec<Ball>>> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&bits) {
            return Some(Arc::clone(found));
        }
        let values = self.symbols.enclosed(bits)?;
        let mut out = self.other_factor(&values, bits)?;
        out.pop();
        let nodes = self.matrices.polynomials(&self.constant, &values, self.degree, bits)?;
        let n = self.constant.rows();
        let powers = in_parameter(&nodes, n - self.missing, bits);
        for power in 1..=self.degree {
            out.extend(quotient(powers.iter().map(|c| c[power].clone()).collect(), &self.zeros));
        }
        let out = Arc::new(out);
        known().insert(bits, Arc::clone(&out));
        Some(out)
    }

    /// The product of the polynomials of the parts that are not rational, without their roots at 1.
    fn other_factor(&self, values: &[Ball], bits: u64) -> Option<Vec<Ball>> {
        let root_at_one = UniPoly::from_i64(&[-1, 1]);
        let mut product = vec![Ball::from_integer(&Integer::ONE, bits)];
        for (block, at_one) in &self.others {
            let own = self.constant.principal(block);
            let entries = own.entries().iter().map(|f| quotient_at(f, values, bits)).collect::<Option<Vec<_>>>()?;
            let matrix = BallMatrix::from_fn(block.len(), |i, j| entries[i * block.len() + j].clone());
            let mut p = matrix.characteristic_polynomial(bits);
            (0..*at_one).for_each(|_| p = quotient(std::mem::take(&mut p), &root_at_one));
            let mut next = vec![Ball::zero(bits); product.len() + p.len() - 1];
            for (i, a) in product.iter().enumerate() {
                for (j, b) in p.iter().enumerate() {
                    next[i + j] = next[i + j].add(&a.mul(b));
                }
            }
            product = next;
        }
        Some(product)
    }

    /// `D(r z; K)` with a symbol for each coefficient, without denominators.
    pub fn polynomial(self: Arc<Self>, radius: &Rational) -> SymbolicPolynomial {
        let n = self.constant.rows();
        let others = self.others_degree();
        let mut table = Values::new();
        let m = self.beside();
        for index in 0..others + self.degree * m {
            let (power, k) = match index.checked_sub(others) {
                None => (0, index),
                Some(beyond) => (beyond / m + 1, beyond % m),
            };
            let words = match power {
                0 => format!("coefficient {k} of the part of D(z; 0) that is no exact factor"),
                _ => format!("coefficient {k} of the factor of D(z; K) beside K^{power} that is not exact"),
            };
            let value = Transcendental::new(Coefficient { of: Arc::clone(&self), index });
            table.insert(format!("c{index}"), Definition::Enclosed(EnclosedNumber { words, value }));
        }
        // K is variable 0, a symbol's number one more than its place in the table.
        let variable = |index: usize| MultiPoly::variable(index + 1);
        let whole = |c: &Integer| MultiPoly::constant(c.clone());
        let in_exact = self.exact.coeffs().iter().take_while(|c| c.is_zero()).count();
        let at_origin = self.at_origin.saturating_sub(in_exact).min(others);
        let other: Vec<MultiPoly> = std::iter::repeat_n(MultiPoly::zero(), at_origin)
            .chain((at_origin..others).map(variable))
            .chain([MultiPoly::one()])
            .collect();
        let exact = |p: &UniPoly| Poly::new(p.coeffs().iter().map(whole).collect::<Vec<_>>());
        let at_zero = exact(&self.exact).times(&Poly::new(other));
        let lead = self.exact.leading().cloned().unwrap_or(Integer::ONE);
        let beside = |power: usize, k: usize| variable(others + (power - 1) * m + k).scaled_by(&lead);
        // Where this is 0 nothing depends on K at z = 1.
        let zeros_at_one = self.zeros.eval(&Integer::ONE);
        let at_rest = self.at_rest.as_ref().filter(|_| radius.is_one() && !zeros_at_one.is_zero());
        let (lowest, lowest_coefficient) = self.lowest_at_rest();
        let scale = at_rest.map_or(Integer::ONE, |_| &lowest_coefficient * &zeros_at_one);
        let power_of = |base: Integer, exponent: usize| (0..exponent).fold(Integer::ONE, |p, _| &p * &base);
        let sum = |list: &mut dyn Iterator<Item = MultiPoly>| list.fold(MultiPoly::zero(), |sum, c| sum.plus(&c));
        let factor = |power: usize, k: usize| match at_rest {
            // Chosen so that the value at z = 1 is c d(K).
            Some(d) if k == 0 => {
                let whole = match lowest {
                    0 => sum(&mut at_zero.coeffs().iter().cloned()),
                    _ => sum(&mut (0..m).map(|k| beside(lowest, k))).scaled_by(&zeros_at_one),
                };
                let others = sum(&mut (1..m).map(|k| beside(power, k).scaled_by(&scale)));
                whole.scaled_by(&d.coeff(power)).minus(&others)
            }
            _ => beside(power, k).scaled_by(&scale),
        };
        let powers: Vec<Poly<MultiPoly>> = (0..=self.degree)
            .map(|power| match power {
                0 => at_zero.map(|c| c.scaled_by(&scale)),
                _ => exact(&self.zeros).times(&Poly::new((0..m).map(|k| factor(power, k)).collect())),
            })
            .collect();
        let in_powers = |(power, p): (usize, &Poly<MultiPoly>), k: usize| {
            (0..power).fold(p.coeff(k), |c, _| c.times(&MultiPoly::variable(0)))
        };
        let coefficient = |k: usize| {
            sum(&mut powers.iter().enumerate().map(|p| in_powers(p, k)))
                .scaled_by(&(power_of(radius.numerator(), k) * power_of(radius.denominator(), n - k)))
        };
        let polynomial = Poly::new((0..=n).map(coefficient).collect::<Vec<_>>());
        SymbolicPolynomial::from_parts(&Arc::new(table), polynomial, MultiPoly::one(), n, vec![MultiPoly::one()])
    }
}

fn whole(n: usize) -> Integer {
    Integer::from(n as u64)
}

/// A coefficient of a part's polynomial.
#[derive(Debug)]
struct Coefficient {
    of: Arc<Part>,
    index: usize,
}

impl Enclosing for Coefficient {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        until_shown((bits + 64).next_power_of_two(), |working| {
            checkpoint(working);
            let found = self.of.coefficients(working)?[self.index].to_enclosure();
            (found.upper() - found.lower() <= width).then_some(found)
        })
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "coefficient of the characteristic polynomial".to_owned(), details: Vec::new() }
    }
}

/// The number of rational rows of `A + K B` less their rank over the rational functions of `K`.
///
/// A minor of `m` rows has at most the degree `m` in `K`, so a minor that is zero at `m + 1` values is zero for every `K`. The greatest rank
/// at `m + 1` values is the rank over the functions.
fn dependent_rows(constant: &RationalMatrix, linear: &RationalMatrix) -> usize {
    let n = constant.rows();
    let numbers = |m: &RationalMatrix, i: usize| (0..n).map(|j| m[(i, j)].as_constant()).collect::<Option<Vec<_>>>();
    let rows: Vec<_> = (0..n).filter_map(|i| numbers(constant, i).zip(numbers(linear, i))).collect();
    let at = |k: usize| {
        let k = Rational::from(k as i64);
        rows.iter().map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + &(b * &k)).collect()).collect()
    };
    let rank_there = (0..=rows.len()).map(|k| rank(at(k))).max().unwrap_or(0);
    rows.len() - rank_there
}

/// The rank of a matrix by Gaussian elimination.
fn rank(mut rows: Vec<Vec<Rational>>) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    let mut found = 0;
    for column in 0..columns {
        let Some(pivot) = (found..rows.len()).find(|&i| !rows[i][column].is_zero()) else { continue };
        rows.swap(found, pivot);
        let (above, below) = rows.split_at_mut(found + 1);
        let pivot = &above[found];
        for row in below {
            let factor = row[column].checked_div(&pivot[column]).expect("a pivot is not zero");
            for (entry, p) in row.iter_mut().zip(pivot) {
                *entry = &*entry - &(&factor * p);
            }
        }
        found += 1;
    }
    found
}

/// The characteristic polynomial of a matrix of rational numbers, up to a factor; `None` for another matrix.
fn rational_polynomial(m: &RationalMatrix) -> Option<UniPoly> {
    m.entries().iter().all(|f| f.as_constant().is_some()).then_some(())?;
    let d = m.characteristic_polynomial(Vec::new(), &Budget::unlimited()).ok()?;
    let coefficients = d.coefficients.iter().map(RationalFunction::as_constant).collect::<Option<Vec<_>>>()?;
    let clear = Rational::from(coefficients.iter().fold(Integer::ONE, |l, c| l.lcm(&c.denominator())));
    Some(UniPoly::new(coefficients.iter().map(|c| (c * &clear).numerator()).collect()))
}

/// The number of roots at 1 of a part that is the exponential of a part of a matrix: as many as that has at 0. 0 for another part.
fn integrators(m: &RationalMatrix, symbols: &Symbols) -> usize {
    let n = m.rows();
    let entry = |i: usize, j: usize| {
        let f = &m[(i, j)];
        let only = f.variables();
        let [symbol] = only[..] else { return None };
        (*f == RationalFunction::variable(symbol)).then(|| symbols.flow_entry(symbol)).flatten()
    };
    let Some((of, ..)) = entry(0, 0) else { return 0 };
    let Some(places) = (0..n).map(|i| entry(i, i).filter(|at| at.0 == of && at.1 == at.2)).collect::<Option<Vec<_>>>()
    else {
        return 0;
    };
    let is_part = |i: usize, j: usize| entry(i, j) == Some((of, places[i].1, places[j].1)) || m[(i, j)].is_zero();
    if !(0..n).all(|i| (0..n).all(|j| is_part(i, j))) {
        return 0;
    }
    let whole = symbols.flow_matrix(of);
    let part = RationalMatrix::from_fn(n, n, |i, j| whole[(places[i].1, places[j].1)].clone());
    let Some(p) = rational_polynomial(&part) else { return 0 };
    p.coeffs().iter().take_while(|c| c.is_zero()).count()
}

/// The quotient of a polynomial by an exact factor: the remainder, which is zero, is left out.
fn quotient(mut p: Vec<Ball>, factor: &UniPoly) -> Vec<Ball> {
    let (degree, lead) = (factor.degree().unwrap_or(0), factor.leading().cloned().unwrap_or(Integer::ONE));
    for at in (degree..p.len()).rev() {
        let over = Ball::from_rational(&Rational::new(Integer::ONE, lead.clone()), p[at].bits());
        let q = p[at].mul(&over);
        for (k, c) in factor.coeffs().iter().enumerate().take(degree) {
            p[at - degree + k] = p[at - degree + k].sub(&q.scaled(c));
        }
        p[at] = q;
    }
    p.split_off(degree)
}
