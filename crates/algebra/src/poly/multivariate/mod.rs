//! Sparse polynomials in several numbered variables over the integers.

mod arithmetic;
mod convert;
mod display;
mod division;
mod gcd;
mod lines;
mod monomial;
#[cfg(feature = "strategies")]
pub mod strategies;
mod substitute;

use super::Domain;
use crate::limits::checkpoint;
use crate::number::Integer;
use std::fmt;

pub(crate) use lines::{Line, lines};
pub use lines::{are_coprime_in, is_square_free_in};
pub use monomial::Monomial;

/// A sparse polynomial over the integers in variables 0, 1, 2, ...
///
/// Terms are kept in descending lexicographic order, variable 0 the most significant, without
/// zero coefficients; so equality of values is equality of polynomials. Variables have numbers;
/// names are supplied when one is displayed. Rational coefficients are expressed by a
/// [`RationalFunction`](super::RationalFunction) with a constant denominator.
///
/// ```
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// let (k, t) = (MultiPoly::variable(0), MultiPoly::variable(1));
/// let p = &(&k + &t) * &(&k - &t);
/// assert_eq!(p.display(&["K", "T"]).to_string(), "K^2 - T^2");
/// assert_eq!(p.gcd(&(&k + &t)), &k + &t);
/// ```
#[derive(Clone, PartialEq, Eq, Hash, Default)]
pub struct MultiPoly {
    terms: Vec<(Monomial, Integer)>,
}

impl MultiPoly {
    /// The greatest total degree that [`MultiPoly::checked_power`] and
    /// [`MultiPoly::checked_times`] produce. Inputs held to it leave room for what is computed
    /// from them: the degree of a boundary polynomial of a loop of order `n` is below `n^2` times
    /// that of the entries, and exponents go up to `2^32 - 1`.
    pub const MAX_DEGREE: u64 = 10_000;

    /// The greatest number of terms that [`MultiPoly::checked_power`] and
    /// [`MultiPoly::checked_times`] produce: about a gigabyte, and far beyond what any later step
    /// could treat.
    pub const MAX_TERMS: u64 = 1_000_000;

    /// The variable with number `i`.
    pub fn variable(i: usize) -> Self {
        MultiPoly { terms: vec![(Monomial::power_of(i, 1), Integer::ONE)] }
    }

    /// A constant.
    pub fn constant(c: Integer) -> Self {
        MultiPoly::term(Monomial::ONE, c)
    }

    /// `c x^m`.
    pub fn term(monomial: Monomial, c: Integer) -> Self {
        MultiPoly { terms: if c.is_zero() { Vec::new() } else { vec![(monomial, c)] } }
    }

    /// From exponent vectors and coefficients, in any order; equal exponents are added up.
    pub fn from_terms(terms: impl IntoIterator<Item = (Vec<u32>, Integer)>) -> Self {
        MultiPoly::from_unsorted(terms.into_iter().map(|(e, c)| (Monomial::new(&e), c)).collect())
    }

    fn from_unsorted(mut terms: Vec<(Monomial, Integer)>) -> Self {
        terms.sort_by(|a, b| {
            checkpoint(1);
            b.0.cmp(&a.0)
        });
        let mut out: Vec<(Monomial, Integer)> = Vec::with_capacity(terms.len());
        for (m, c) in terms {
            match out.last_mut() {
                Some((last, sum)) if *last == m => *sum += c,
                _ => {
                    if out.last().is_some_and(|(_, sum)| sum.is_zero()) {
                        out.pop();
                    }
                    out.push((m, c));
                }
            }
        }
        if out.last().is_some_and(|(_, sum)| sum.is_zero()) {
            out.pop();
        }
        MultiPoly { terms: out }
    }

    /// From terms that are known to descend and to have no zero coefficient.
    pub(crate) fn from_descending(terms: Vec<(Monomial, Integer)>) -> Self {
        debug_assert!(terms.windows(2).all(|w| w[0].0 > w[1].0) && terms.iter().all(|(_, c)| !c.is_zero()));
        MultiPoly { terms }
    }

    /// The terms in descending order.
    pub fn terms(&self) -> &[(Monomial, Integer)] {
        &self.terms
    }

    /// The leading term; `None` for zero.
    pub fn leading_term(&self) -> Option<&(Monomial, Integer)> {
        self.terms.first()
    }

    /// The coefficient of the leading term; zero for zero.
    pub fn leading_coefficient(&self) -> Integer {
        self.terms.first().map_or(Integer::ZERO, |(_, c)| c.clone())
    }

    /// The degree in variable `i`; 0 for zero.
    pub fn degree_in(&self, i: usize) -> u32 {
        self.terms.iter().map(|(m, _)| m.exponent(i)).max().unwrap_or(0)
    }

    /// The greatest sum of exponents; 0 for zero.
    pub fn total_degree(&self) -> u64 {
        self.terms.iter().map(|(m, _)| m.total_degree()).max().unwrap_or(0)
    }

    /// The degrees in variables 0, 1, ... up to the last one that occurs.
    pub fn degrees(&self) -> Vec<u32> {
        let mut out = Vec::new();
        for (m, _) in &self.terms {
            let exponents = m.exponents();
            if exponents.len() > out.len() {
                out.resize(exponents.len(), 0);
            }
            for (d, e) in out.iter_mut().zip(exponents) {
                *d = (*d).max(*e);
            }
        }
        out
    }

    /// The variables that occur, ascending.
    pub fn variables(&self) -> Vec<usize> {
        self.degrees().iter().enumerate().filter(|(_, d)| **d > 0).map(|(i, _)| i).collect()
    }

    /// Whether no variable occurs.
    pub fn is_constant(&self) -> bool {
        // The leading monomial is the greatest, and 1 is the least of all.
        self.terms.first().is_none_or(|(m, _)| m.is_one())
    }

    /// The value of a constant; `None` when a variable occurs.
    pub fn as_constant(&self) -> Option<Integer> {
        self.is_constant().then(|| self.leading_coefficient())
    }

    /// The non-negative greatest common divisor of the coefficients; zero for zero.
    pub fn integer_content(&self) -> Integer {
        checkpoint(4 * self.terms.len() as u64);
        let mut content = Integer::ZERO;
        for (_, c) in self.terms.iter().rev() {
            content = content.gcd(c);
            if content.is_one() {
                break;
            }
        }
        content
    }

    /// The greatest monomial that divides every term; 1 for zero.
    pub fn monomial_content(&self) -> Monomial {
        let mut terms = self.terms.iter().map(|(m, _)| m);
        let Some(first) = terms.next() else { return Monomial::ONE };
        terms.fold(first.clone(), |g, m| g.gcd(m))
    }

    /// The polynomial divided by its integer content, with a positive leading coefficient.
    pub fn primitive_over_integers(&self) -> MultiPoly {
        let content = self.integer_content();
        let content = if self.needs_negation() { -content } else { content };
        self.div_exact_integer(&content).unwrap_or_default()
    }

    /// The largest bit length of a coefficient.
    pub fn height_bits(&self) -> u64 {
        self.terms.iter().map(|(_, c)| c.bit_length()).max().unwrap_or(0)
    }
}

impl From<Integer> for MultiPoly {
    fn from(c: Integer) -> Self {
        MultiPoly::constant(c)
    }
}

impl From<i64> for MultiPoly {
    fn from(c: i64) -> Self {
        MultiPoly::constant(Integer::from(c))
    }
}

impl fmt::Debug for MultiPoly {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.display::<&str>(&[]), f)
    }
}
