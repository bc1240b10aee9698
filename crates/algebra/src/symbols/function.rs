//! Functions of a parameter and symbols: polynomials in them, and resultants that are not expanded.

use super::horner::{Horner, Scheme};
use super::rational_series;
use super::specialise::resultant_on_line;
use super::{MovingSymbols, Symbols};
use crate::ball::{Ball, Elementary, Enclosed, enclosed_resultant};
use crate::limits::{Budget, Exhausted};
use crate::number::{Integer, Rational};
use crate::poly::multivariate::Line;
use crate::poly::{Domain, MultiPoly, Poly, UniPoly, resultant_formal};
use crate::precisions::RESULTANT_AT_NUMBER;

/// A function of a parameter (variable 0) and of symbols (symbol `i` is variable `i + 1`).
///
/// ```
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// use jurist_algebra::symbols::Function;
/// let [p, x] = [0, 1].map(MultiPoly::variable);
/// // Res(z - p, z - x) is x - p up to the sign.
/// let f = Function::resultant(vec![p.negated(), MultiPoly::one()], vec![x.negated(), MultiPoly::one()]);
/// assert_eq!(f.expanded_size(), 4);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Function {
    /// A polynomial.
    Polynomial(MultiPoly),
    /// The resultant, up to the sign, of two polynomials in a further unknown for their formal degrees.
    Resultant {
        /// All coefficients of the first from the constant term up.
        a: Vec<MultiPoly>,
        /// All coefficients of the second, which has no more.
        b: Vec<MultiPoly>,
    },
}

impl From<MultiPoly> for Function {
    fn from(p: MultiPoly) -> Function {
        Function::Polynomial(p)
    }
}

impl Function {
    /// The resultant, up to the sign, of two polynomials given by all coefficients for their formal degrees.
    ///
    /// # Panics
    /// When a list is empty, or both are constants.
    pub fn resultant(a: Vec<MultiPoly>, b: Vec<MultiPoly>) -> Function {
        assert!(!a.is_empty() && !b.is_empty() && a.len() + b.len() > 2, "polynomials of some formal degree");
        if a.len() >= b.len() { Function::Resultant { a, b } } else { Function::Resultant { a: b, b: a } }
    }

    /// The polynomial; `None` where it is not expanded.
    pub fn polynomial(&self) -> Option<&MultiPoly> {
        match self {
            Function::Polynomial(p) => Some(p),
            Function::Resultant { .. } => None,
        }
    }

    /// The polynomials it is made of.
    pub(super) fn polynomials(&self) -> impl Iterator<Item = &MultiPoly> {
        let (a, b) = match self {
            Function::Polynomial(p) => (std::slice::from_ref(p), &[][..]),
            Function::Resultant { a, b } => (a.as_slice(), b.as_slice()),
        };
        a.iter().chain(b)
    }

    /// A bound of the number of terms when it is expanded.
    pub fn expanded_size(&self) -> u64 {
        match self {
            Function::Polynomial(p) => p.terms().len() as u64,
            Function::Resultant { a, b } => {
                let degrees = |list: &[MultiPoly]| {
                    let mut highest: Vec<u64> = Vec::new();
                    for p in list {
                        for (i, d) in p.degrees().into_iter().enumerate() {
                            highest.resize(highest.len().max(i + 1), 0);
                            highest[i] = highest[i].max(u64::from(d));
                        }
                    }
                    highest
                };
                let (m, n) = (a.len() as u64 - 1, b.len() as u64 - 1);
                let (of_a, of_b) = (degrees(a), degrees(b));
                let at = |list: &[u64], i: usize| list.get(i).copied().unwrap_or(0);
                let terms = |i: usize| n * at(&of_a, i) + m * at(&of_b, i) + 1;
                (0..of_a.len().max(of_b.len())).map(terms).fold(1, u64::saturating_mul)
            }
        }
    }

    /// The same as a polynomial.
    ///
    /// Cost: a resultant in several variables.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn expanded(&self, budget: &Budget) -> Result<MultiPoly, Exhausted> {
        match self {
            Function::Polynomial(p) => Ok(p.clone()),
            Function::Resultant { a, b } => {
                let poly = |list: &[MultiPoly]| Poly::new(list.to_vec());
                resultant_formal(&poly(a), a.len() - 1, &poly(b), b.len() - 1, budget)
            }
        }
    }

    /// The function on a line through small integers, in variable `j` alone, up to the sign; `None` where a degree in `j`
    /// falls.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub(super) fn on_line(&self, j: usize, line: &Line, budget: &Budget) -> Result<Option<UniPoly>, Exhausted> {
        match self {
            Function::Polynomial(p) => Ok(line.polynomial(p, j)),
            Function::Resultant { a, b } => resultant_on_line(a, b, j, line, budget),
        }
    }

    /// The function of the reciprocal of the parameter, times a power of it.
    pub fn inverted(&self) -> Function {
        let reversed = |list: &[MultiPoly]| -> Vec<MultiPoly> {
            let degree = list.iter().map(|p| p.degree_in(0)).max().unwrap_or(0);
            let turned = |p: &MultiPoly| {
                let mut coefficients = p.as_poly_in(0).into_coeffs();
                coefficients.resize(degree as usize + 1, MultiPoly::zero());
                coefficients.reverse();
                MultiPoly::from_poly_in(&Poly::new(coefficients), 0)
            };
            list.iter().map(turned).collect()
        };
        match self {
            Function::Polynomial(p) => Function::Polynomial(reversed(std::slice::from_ref(p)).swap_remove(0)),
            Function::Resultant { a, b } => Function::Resultant { a: reversed(a), b: reversed(b) },
        }
    }

    /// About how many products an evaluation takes.
    pub(super) fn size(&self) -> u64 {
        let terms = |list: &[MultiPoly]| list.iter().map(|p| p.terms().len() as u64).sum::<u64>();
        match self {
            Function::Polynomial(p) => 1 + p.terms().len() as u64,
            Function::Resultant { a, b } => terms(a) + terms(b) + (a.len().max(b.len()) as u64).pow(3),
        }
    }

    /// The function at series of the parameter and the symbols.
    pub(super) fn at_series<S: Elementary>(&self, values: &[S]) -> S {
        Scheme::of(self).at(values)
    }

    /// The function at series with rational coefficients.
    pub(super) fn at_rational_series(&self, values: &[Vec<Rational>]) -> Vec<Rational> {
        let at = |p: &MultiPoly| rational_series::polynomial_at(p, values);
        match self {
            Function::Polynomial(p) => at(p),
            Function::Resultant { a, b } => {
                let at = |list: &[MultiPoly]| list.iter().map(|p| Exact(at(p))).collect::<Vec<Exact>>();
                enclosed_resultant(&at(a), &at(b)).0
            }
        }
    }

    /// Whether the function is zero where the parameter has a rational value, symbols there being as given.
    ///
    /// # Errors
    /// As [`Symbols::sign`].
    pub(super) fn vanishes_at(&self, value: &Rational, symbols: &Symbols, budget: &Budget) -> Result<bool, Exhausted> {
        let put = |f: &MultiPoly| f.substitute(0, value).0.map_variables(|i| i.saturating_sub(1));
        let Function::Resultant { a, b } = self else {
            return symbols.is_zero(&put(self.polynomial().expect("a polynomial")), budget);
        };
        let (a, b) = (common_scale(a, value), common_scale(b, value));
        let sign = RESULTANT_AT_NUMBER.find(|bits| {
            let at = |list: &[MultiPoly]| list.iter().map(|p| symbols.enclose(p, bits)).collect::<Vec<Ball>>();
            Ok(budget.enter(|| enclosed_resultant(&at(&a), &at(&b)))?.sign())
        })?;
        if let Some(sign) = sign {
            return Ok(sign.is_eq());
        }
        symbols.is_zero(&Function::resultant(a, b).expanded(budget)?, budget)
    }

    /// As text.
    pub(super) fn display(&self, names: &[String]) -> String {
        let list = |p: &[MultiPoly]| p.iter().map(|c| c.display(names).to_string()).collect::<Vec<_>>().join(", ");
        match self {
            Function::Polynomial(p) => p.display(names).to_string(),
            Function::Resultant { a, b } => format!("resultant([{}], [{}])", list(a), list(b)),
        }
    }
}

/// Polynomials at a rational value of the parameter, all times one positive integer, in symbols as their table numbers them.
pub fn common_scale(list: &[MultiPoly], value: &Rational) -> Vec<MultiPoly> {
    let degree = list.iter().map(|c| c.degree_in(0)).max().unwrap_or(0);
    let (n, d) = (value.numerator(), value.denominator());
    let at = |c: &MultiPoly| {
        let in_parameter = c.as_poly_in(0);
        let mut sum = MultiPoly::zero();
        for (k, part) in in_parameter.coeffs().iter().enumerate() {
            sum = sum.plus(&part.scaled_by(&(n.pow(k as u64) * d.pow(u64::from(degree) - k as u64))));
        }
        sum.map_variables(|i| i.saturating_sub(1))
    };
    list.iter().map(at).collect()
}

/// A power series with rational coefficients.
#[derive(Clone)]
struct Exact(Vec<Rational>);

impl Exact {
    fn with(&self, other: &Exact, f: impl Fn(&Rational, &Rational) -> Rational) -> Exact {
        Exact(self.0.iter().zip(&other.0).map(|(x, y)| f(x, y)).collect())
    }
}

impl Enclosed for Exact {
    fn nothing(&self) -> Exact {
        Exact(vec![Rational::ZERO; self.0.len()])
    }
    fn plus(&self, other: &Exact) -> Exact {
        self.with(other, |x, y| x + y)
    }
    fn minus(&self, other: &Exact) -> Exact {
        self.with(other, |x, y| x - y)
    }
    fn times(&self, other: &Exact) -> Exact {
        Exact(rational_series::product(&self.0, &other.0))
    }
    fn over(&self, other: &Exact) -> Option<Exact> {
        rational_series::quotient(&self.0, &other.0).map(Exact)
    }
    fn is_nothing(&self) -> bool {
        self.0.iter().all(Rational::is_zero)
    }
    fn least(&self) -> Integer {
        if self.0[0].is_zero() { Integer::ZERO } else { Integer::ONE }
    }
}

/// A polynomial at series.
pub(super) fn polynomial_at<S: Elementary>(p: &MultiPoly, values: &[S]) -> S {
    Horner::of(p).at(values)
}

impl MovingSymbols {
    /// Whether the function is zero at a rational value of the parameter.
    ///
    /// # Errors
    /// As [`Symbols::sign`].
    pub fn vanishes_at(&self, f: &Function, value: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        let Some(symbols) = self.at(value) else { return Ok(false) };
        f.vanishes_at(value, &symbols, budget)
    }
}
