//! The characteristic polynomial of a part of a loop at whole values of the parameter.

use crate::model::{Samples, SamplesPart, quotient_at};
use jurist_algebra::ball::{Ball, BallMatrix};
use jurist_algebra::limits::checkpoint;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::{Integer, Rational};
use std::sync::Arc;

/// The matrix of a part where `K` is not 0.
#[derive(Debug)]
pub(super) enum Matrices {
    /// `A + K B`; this is `B`.
    Linear(RationalMatrix),
    /// The product of the matrices of the samples of a hyperperiod.
    Samples(Arc<Samples>, SamplesPart),
}

impl Matrices {
    /// The characteristic polynomials at `K = 0, 1, ..`, one more than the degree.
    ///
    /// `constant` is the matrix at `K = 0`, and `values` are those of its symbols. `None` where a divisor may vanish.
    pub fn polynomials(
        &self,
        constant: &RationalMatrix,
        values: &[Ball],
        degree: usize,
        bits: u64,
    ) -> Option<Vec<Vec<Ball>>> {
        let (samples, of) = match self {
            Matrices::Linear(linear) => {
                let (a, b) = (enclosed(constant, values, bits)?, enclosed(linear, values, bits)?);
                let at = |k: usize| at_node(&a, &b, k).characteristic_polynomial(bits);
                return Some((0..=degree).map(at).collect());
            }
            Matrices::Samples(samples, of) => (samples, of),
        };
        let values = samples.symbols.enclosed(bits)?;
        let of_part = |m: &RationalMatrix| enclosed(&m.principal(&of.at_sample), &values, bits);
        let patterns = samples.patterns.iter().map(|[a, b]| Some((of_part(a)?, of_part(b)?)));
        let patterns = patterns.collect::<Option<Vec<_>>>()?;
        let at = |k: usize| {
            checkpoint(bits);
            let patterns: Vec<BallMatrix> = patterns.iter().map(|(a, b)| at_node(a, b, k)).collect();
            let whole = samples.runs.iter().fold(None, |before: Option<BallMatrix>, (pattern, length)| {
                let run = power(&patterns[*pattern], *length);
                Some(before.map_or_else(|| run.clone(), |before| run.mul(&before)))
            });
            let whole = whole.expect("a hyperperiod has a sample");
            let kept = BallMatrix::from_fn(of.kept.len(), |i, j| whole.at(of.kept[i], of.kept[j]).clone());
            kept.characteristic_polynomial(bits)
        };
        Some((0..=degree).map(at).collect())
    }
}

/// The values of the entries; `None` where a divisor may vanish.
pub(super) fn enclosed(m: &RationalMatrix, values: &[Ball], bits: u64) -> Option<BallMatrix> {
    let entries = m.entries().iter().map(|f| quotient_at(f, values, bits)).collect::<Option<Vec<_>>>()?;
    Some(BallMatrix::from_fn(m.rows(), |i, j| entries[i * m.rows() + j].clone()))
}

/// `A + k B`.
fn at_node(a: &BallMatrix, b: &BallMatrix, k: usize) -> BallMatrix {
    BallMatrix::from_fn(a.size(), |i, j| a.at(i, j).add(&b.at(i, j).scaled(&Integer::from(k as u64))))
}

/// A power, from 1, by squaring.
fn power(m: &BallMatrix, exponent: u64) -> BallMatrix {
    match exponent {
        1 => m.clone(),
        _ if exponent.is_multiple_of(2) => power(&m.mul(m), exponent / 2),
        _ => power(m, exponent - 1).mul(m),
    }
}

/// The coefficients of `z^i` below a power, each by powers of `K`, from the polynomials at `K = 0, 1, ..`.
pub(super) fn in_parameter(nodes: &[Vec<Ball>], below: usize, bits: u64) -> Vec<Vec<Ball>> {
    let weights = interpolation(nodes.len() - 1);
    let weights: Vec<Vec<Ball>> =
        weights.iter().map(|list| list.iter().map(|w| Ball::from_rational(w, bits)).collect()).collect();
    let coefficient = |i: usize, weights: &Vec<Ball>| {
        let terms = nodes.iter().zip(weights).map(|(node, w)| node[i].mul(w));
        terms.fold(Ball::zero(bits), |sum, term| sum.add(&term))
    };
    (0..below).map(|i| weights.iter().map(|weights| coefficient(i, weights)).collect()).collect()
}

/// The least `e` for which a polynomial in `K` is larger than a number wherever `|K|` is `2^e` or more; `None` where its last coefficient may be
/// zero.
pub(super) fn exceeds_from(polynomial: &[Ball], number: &Integer, bits: u64) -> Option<u64> {
    let (last, others) = polynomial.split_last()?;
    let (last, degree) = (last.least_magnitude_units(), others.len() as u64);
    let exceeds = |e: &u64| {
        let others = others.iter().zip(0..).map(|(c, power)| c.magnitude_units() << (e * power));
        &last << (e * degree) > others.fold(number << bits, |sum, c| sum + c)
    };
    // What is larger at one `|K|` is so at all greater ones: the last power grows fastest.
    (!last.is_zero()).then(|| (0..=bits).find(exceeds)).flatten()
}

/// Weights of an interpolation at `K = 0, 1, ..`, one list for each power of `K`: the values times its weights add up to its coefficient.
pub(super) fn interpolation(degree: usize) -> Vec<Vec<Rational>> {
    let bases: Vec<Vec<Rational>> = (0..=degree).map(|node| lagrange(node, degree)).collect();
    (0..=degree).map(|power| bases.iter().map(|basis| basis[power].clone()).collect()).collect()
}

/// The product of `(K - m)/(node - m)` over the other whole numbers `m` up to the degree.
fn lagrange(node: usize, degree: usize) -> Vec<Rational> {
    let number = |m: usize| Rational::from(m as i64);
    (0..=degree).filter(|&m| m != node).fold(vec![Rational::ONE], |basis, m| {
        let scale = (number(node) - number(m)).recip().expect("another node");
        let mut product = vec![Rational::ZERO; basis.len() + 1];
        for (i, c) in basis.iter().enumerate() {
            let c = c * &scale;
            product[i] = &product[i] - &(&c * &number(m));
            product[i + 1] = &product[i + 1] + &c;
        }
        product
    })
}
