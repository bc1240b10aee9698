//! A part of a loop behind holds: the matrix `A + K B` and its characteristic polynomial, with a symbol for each coefficient.

use super::at_one::zeros_at_one;
use super::exact_zeros::{exact_zeros, missing_degrees};
use super::nodes::{Matrices, enclosed, exceeds_from, in_parameter};
use super::origin::{dependent_rows, roots_at_origin};
use super::steady_state::steady_state;
use crate::model::{Samples, SamplesPart, Symbols, quotient_at, rank_bound};
use jurist_algebra::ball::{Ball, BallMatrix};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, RationalFunction, UniPoly};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The degree in the parameter up to which polynomials are looked at.
const MOST_POWERS: usize = 4;

/// A part of the loop: a matrix that is a polynomial in `K`.
#[derive(Debug)]
pub(super) struct Part {
    symbols: Arc<Symbols>,
    /// The matrix at `K = 0`.
    pub(super) constant: RationalMatrix,
    matrices: Matrices,
    /// A bound of the degree in `K`.
    pub degree: usize,
    /// The exact factor of `D(z; 0)`: polynomials of rational parts, and the roots at 1 that integrators bring.
    pub(super) exact: UniPoly,
    /// The other parts of `A`, each with the number of its roots at 1, which are in the exact factor.
    others: Vec<(Vec<usize>, usize)>,
    /// A lower bound of the number of roots that are 0 for every `K`, from rational rows that are linearly dependent.
    pub(super) at_origin: usize,
    /// The exact factor of `N_p(z)`, the coefficient of each power `K^p` in `D(z; K)`.
    pub(super) zeros: UniPoly,
    /// `n - 1` less the degree of `N_p`.
    missing: usize,
    /// A factor `d(K)` of `D(1; K)` that is known, and a bound of the degree of the other one, which is not zero.
    pub(super) at_rest: Option<(UniPoly, usize)>,
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
        let mut part = Part { at_origin, zeros, missing, at_rest: rest.map(|d| (d, 0)), ..of };
        if part.degree > 0 && part.at_rest.is_some() && part.factor_at_rest(super::BITS)?.contains_zero() {
            part.at_rest = None;
        }
        Some(part)
    }

    /// A part of a loop over a hyperperiod, by its matrix at `K = 0` and the matrices of its samples.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn lifted(
        symbols: &Arc<Symbols>,
        constant: RationalMatrix,
        samples: &Arc<Samples>,
        of: &SamplesPart,
        budget: &Budget,
    ) -> Result<Part, Exhausted> {
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
        if part.degree > 0 {
            part.at_origin = roots_at_origin(samples, of);
            part.zeros = UniPoly::monomial(Integer::ONE, part.at_origin);
            part.at_rest = part.known_at_one(samples, of, budget)?;
        }
        Ok(part)
    }

    /// The known factor of `D(1; K)` of a loop over its hyperperiod, and the degree of the other one.
    fn known_at_one(
        &self,
        samples: &Samples,
        of: &SamplesPart,
        budget: &Budget,
    ) -> Result<Option<(UniPoly, usize)>, Exhausted> {
        let Some(sums) = self.at_one(super::BITS) else { return Ok(None) };
        let known = zeros_at_one(&sums, samples, of, budget)?;
        let at_zero = of.at_one.max(usize::from(self.has_root_at_one()));
        let known = known.times(&UniPoly::monomial(Integer::ONE, at_zero));
        let others = self.degree.checked_sub(known.degree().unwrap_or(0));
        Ok(others.filter(|_| !known.is_constant()).map(|others| (known, others)))
    }

    /// The coefficients of `D(1; K)`.
    fn at_one(&self, bits: u64) -> Option<Vec<Ball>> {
        let values = self.symbols.enclosed(bits)?;
        let nodes = self.matrices.polynomials(&self.constant, &values, self.degree, bits)?;
        let rows = in_parameter(&nodes, self.constant.rows() + 1, bits);
        let sum = |power: usize| rows.iter().fold(Ball::zero(bits), |sum, row| sum.add(&row[power]));
        Some((0..=self.degree).map(sum).collect())
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
    pub(super) fn lowest_at_rest(&self) -> (usize, Integer) {
        let d = self.at_rest.as_ref().map(|(d, _)| d.coeffs()).unwrap_or_default();
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

    /// Whether 1 is known to be a root at `K = 0`.
    pub fn has_root_at_one(&self) -> bool {
        self.exact.eval(&Integer::ONE).is_zero()
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
    pub(super) fn others_degree(&self) -> usize {
        self.constant.rows() - self.exact.degree().unwrap_or(0)
    }

    /// The number of coefficients of the enclosed factor of `N_p`.
    pub(super) fn beside(&self) -> usize {
        self.constant.rows() - self.zeros.degree().unwrap_or(0) - self.missing
    }

    /// The coefficients of the enclosed factor of `D(z; 0)` without the leading 1, then those of the enclosed factor of each `N_p`.
    pub(super) fn coefficients(&self, bits: u64) -> Option<Arc<Vec<Ball>>> {
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
}

fn whole(n: usize) -> Integer {
    Integer::from(n as u64)
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
pub(in crate::problem) fn quotient(mut p: Vec<Ball>, factor: &UniPoly) -> Vec<Ball> {
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
