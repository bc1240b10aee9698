//! Resultants over the integers and over their polynomials by evaluation, interpolation and Chinese
//! remainders, or as small determinants, and where which pays.

use super::resultant::DensePair;
use crate::number::Integer;
use crate::poly::{Monomial, MultiPoly, Poly, UniPoly};

/// The subresultant sequence is used when the sum of the degrees is below this.
pub const MULTIMODULAR_MIN_DEGREES: usize = 3;

/// The greatest number of points of a grid in several variables for each term of the coefficients:
/// beyond, the polynomials are so sparse that the subresultant sequence has a chance.
const POINTS_PER_TERM: usize = 1 << 12;

/// The greatest number of points of a grid.
const MAX_POINTS: usize = 1 << 24;

static ZERO: Integer = Integer::ZERO;

/// The least exponents and the numbers of exponents of the variables, and the coefficients.
type Coefficients = (Vec<(usize, usize)>, Vec<Integer>);

/// By minors or modulo primes.
fn fastest(pair: &DensePair<'_>) -> Coefficients {
    match pair.resultant_by_minors_if_fast() {
        Some(coefficients) => (from_zero(pair), coefficients),
        None => pair.resultant(),
    }
}

fn from_zero(pair: &DensePair<'_>) -> Vec<(usize, usize)> {
    pair.lengths().into_iter().map(|length| (0, length)).collect()
}

/// For integer coefficients; `None` where the subresultant sequence is expected to be faster.
pub(in crate::poly) fn over_integers(a: &UniPoly, n: usize, b: &UniPoly, m: usize) -> Option<Integer> {
    (n + m >= MULTIMODULAR_MIN_DEGREES).then(|| resultant_multimodular_integers(a, n, b, m))
}

/// For coefficients in one variable.
pub(in crate::poly) fn over_univariate(a: &Poly<UniPoly>, n: usize, b: &Poly<UniPoly>, m: usize) -> Option<UniPoly> {
    (n + m >= MULTIMODULAR_MIN_DEGREES).then(|| {
        let pair = dense(a, n, b, m);
        let (ranges, coefficients) = fastest(&pair);
        Poly::new(coefficients).shifted_up(ranges[0].0)
    })
}

/// For coefficients in several variables.
pub(in crate::poly) fn over_multivariate(
    a: &Poly<MultiPoly>,
    n: usize,
    b: &Poly<MultiPoly>,
    m: usize,
) -> Option<MultiPoly> {
    if n + m < MULTIMODULAR_MIN_DEGREES {
        return None;
    }
    let terms: usize = a.coeffs().iter().chain(b.coeffs()).map(|c| c.terms().len()).sum();
    let limit = terms.saturating_mul(POINTS_PER_TERM).min(MAX_POINTS);
    let layout = Layout::new(a, n, b, m, limit)?;
    layout.with_pair(a, n, b, m, |pair| Some(fastest(pair)))
}

/// The resultant of integer polynomials for formal degrees modulo primes.
///
/// # Panics
/// When a formal degree is below the degree.
pub fn resultant_multimodular_integers(a: &UniPoly, n: usize, b: &UniPoly, m: usize) -> Integer {
    let (mut coefficients, at_b) = room(a.coeffs().len(), n, b.coeffs().len(), m, 1);
    for (k, c) in a.coeffs().iter().enumerate() {
        coefficients[k] = c;
    }
    for (k, c) in b.coeffs().iter().enumerate() {
        coefficients[at_b + k] = c;
    }
    let pair = DensePair { degrees: (n, m), terms: Vec::new(), coefficients };
    pair.resultant().1.pop().unwrap_or_default()
}

/// The resultant over `Z[K]` for formal degrees: evaluated at `0, 1, 2, ...` modulo primes,
/// interpolated and lifted, with proved bounds on degree and coefficients.
///
/// # Panics
/// When a formal degree is below the degree.
pub fn resultant_multimodular(a: &Poly<UniPoly>, n: usize, b: &Poly<UniPoly>, m: usize) -> UniPoly {
    let (ranges, coefficients) = dense(a, n, b, m).resultant();
    Poly::new(coefficients).shifted_up(ranges[0].0)
}

/// Two polynomials whose coefficients are polynomials in one variable.
pub(super) fn dense<'a>(a: &'a Poly<UniPoly>, n: usize, b: &'a Poly<UniPoly>, m: usize) -> DensePair<'a> {
    let terms = a.coeffs().iter().chain(b.coeffs()).map(|c| c.coeffs().len()).max().unwrap_or(0).max(1);
    let (mut coefficients, at_b) = room(a.coeffs().len(), n, b.coeffs().len(), m, terms);
    let rows = n + m + 2;
    for (p, start) in [(a, 0), (b, at_b)] {
        for (k, c) in p.coeffs().iter().enumerate() {
            for (e, x) in c.coeffs().iter().enumerate() {
                coefficients[e * rows + start + k] = x;
            }
        }
    }
    DensePair { degrees: (n, m), terms: vec![terms], coefficients }
}

/// The resultant over `Z[x_0, x_1, ...]` for formal degrees on a grid of as many dimensions as
/// there are variables; `None` when the grid would be too large.
///
/// # Panics
/// When a formal degree is below the degree.
pub fn resultant_multimodular_multivariate(
    a: &Poly<MultiPoly>,
    n: usize,
    b: &Poly<MultiPoly>,
    m: usize,
) -> Option<MultiPoly> {
    Layout::new(a, n, b, m, MAX_POINTS)?.with_pair(a, n, b, m, |pair| Some(pair.resultant()))
}

/// The same as the determinant of a small matrix, in machine words; `None` when a degree is 0 or above 6, or the resultant
/// may have more than 8 words.
///
/// Cost: with `n` the higher degree `n 2^(n - 1)` products of polynomials in words
/// ([DiazTocaGonzalezVega2004](crate::bibliography#diaztocagonzalezvega2004)).
///
/// ```
/// use jurist_algebra::poly::modular::multimodular_resultant::resultant_by_minors;
/// use jurist_algebra::poly::{Domain, MultiPoly, Poly};
/// let (k, t) = (MultiPoly::variable(0), MultiPoly::variable(1));
/// let a = Poly::new(vec![t.clone(), MultiPoly::zero(), MultiPoly::one()]); // x^2 + T
/// let b = Poly::new(vec![k.clone(), MultiPoly::one()]); // x + K
/// assert_eq!(resultant_by_minors(&a, 2, &b, 1), Some(&(&k * &k) + &t));
/// ```
///
/// # Panics
/// When a formal degree is below the degree.
pub fn resultant_by_minors(a: &Poly<MultiPoly>, n: usize, b: &Poly<MultiPoly>, m: usize) -> Option<MultiPoly> {
    let layout = Layout::new(a, n, b, m, MAX_POINTS)?;
    layout.with_pair(a, n, b, m, |pair| Some((from_zero(pair), pair.resultant_by_minors()?)))
}

/// All zeros, and where the second polynomial begins.
fn room(length_a: usize, n: usize, length_b: usize, m: usize, terms: usize) -> (Vec<&'static Integer>, usize) {
    assert!(length_a <= n + 1 && length_b <= m + 1, "the formal degree is below the degree");
    (vec![&ZERO; (n + m + 2) * terms], n + 1)
}

/// The variables that occur and their degrees in the coefficients.
struct Layout {
    variables: Vec<usize>,
    terms: Vec<usize>,
}

impl Layout {
    /// `None` when the coefficients or the grid of the resultant exceed `limit`.
    fn new(a: &Poly<MultiPoly>, n: usize, b: &Poly<MultiPoly>, m: usize, limit: usize) -> Option<Layout> {
        let degrees = |p: &Poly<MultiPoly>| {
            let mut all: Vec<u32> = Vec::new();
            for c in p.coeffs() {
                let degrees = c.degrees();
                all.resize(all.len().max(degrees.len()), 0);
                for (d, e) in all.iter_mut().zip(degrees) {
                    *d = e.max(*d);
                }
            }
            all
        };
        let (in_a, in_b) = (degrees(a), degrees(b));
        let at = |d: &[u32], i: usize| d.get(i).copied().unwrap_or(0) as usize;
        let mut layout = Layout { variables: Vec::new(), terms: Vec::new() };
        let (mut coefficients, mut points) = (n + m + 2, 1usize);
        for i in 0..in_a.len().max(in_b.len()) {
            let (da, db) = (at(&in_a, i), at(&in_b, i));
            if da.max(db) == 0 {
                continue;
            }
            layout.variables.push(i);
            layout.terms.push(da.max(db) + 1);
            coefficients = coefficients.checked_mul(da.max(db) + 1)?;
            points = points.checked_mul(da.checked_mul(m)?.checked_add(db.checked_mul(n)?)?.checked_add(1)?)?;
        }
        (coefficients <= limit.max(n + m + 2) && points <= limit).then_some(layout)
    }

    /// The resultant by a method that may not serve.
    fn with_pair(
        &self,
        a: &Poly<MultiPoly>,
        n: usize,
        b: &Poly<MultiPoly>,
        m: usize,
        by: impl Fn(&DensePair<'_>) -> Option<Coefficients>,
    ) -> Option<MultiPoly> {
        let (mut coefficients, at_b) =
            room(a.coeffs().len(), n, b.coeffs().len(), m, self.terms.iter().product::<usize>());
        let rows = n + m + 2;
        for (p, start) in [(a, 0), (b, at_b)] {
            for (k, c) in p.coeffs().iter().enumerate() {
                for (monomial, x) in c.terms() {
                    let place = self
                        .variables
                        .iter()
                        .zip(&self.terms)
                        .fold(0, |place, (&i, &terms)| place * terms + monomial.exponent(i) as usize);
                    coefficients[place * rows + start + k] = x;
                }
            }
        }
        let pair = DensePair { degrees: (n, m), terms: self.terms.clone(), coefficients };
        let (ranges, values) = by(&pair)?;
        let mut exponents = vec![0u32; self.variables.last().map_or(0, |last| last + 1)];
        let mut terms = Vec::new();
        for (place, c) in values.into_iter().enumerate().filter(|(_, c)| !c.is_zero()) {
            let mut rest = place;
            for (&i, &(least, length)) in self.variables.iter().zip(&ranges).rev() {
                exponents[i] = u32::try_from(least + rest % length).expect("degrees stay below 2^32");
                rest /= length;
            }
            terms.push((Monomial::new(&exponents), c));
        }
        terms.reverse();
        Some(MultiPoly::from_descending(terms))
    }
}
