//! Polynomials, and functions made of them, in the order in which they are evaluated.

use super::Function;
use crate::ball::{
    Ball, Elementary, Enclosed, Known, ShortModel, TaylorModel, enclosed_resultant, enclosed_resultant_by_minors,
    short_resultant,
};
use crate::limits::checkpoint;
use crate::number::Integer;
use crate::poly::{Domain, MultiPoly};

/// Horner's scheme in the variables, the last one outermost: as few products as the shape of a polynomial allows.
#[derive(Clone, Debug)]
pub(super) enum Horner {
    Constant(Integer),
    /// In one variable, coefficients from the constant term up, none where there is no such power.
    In(usize, Vec<Option<Horner>>),
}

impl Horner {
    pub fn of(p: &MultiPoly) -> Horner {
        if let Some(c) = p.as_constant() {
            return Horner::Constant(c);
        }
        let last = *p.variables().last().expect("not constant");
        let part = |p: &MultiPoly| (!p.is_zero()).then(|| Horner::of(p));
        Horner::In(last, p.as_poly_in(last).coeffs().iter().map(part).collect())
    }

    /// The value where the variables are as given.
    pub fn at<S: Elementary>(&self, values: &[S]) -> S {
        self.evaluated(values, &[], 0, &|c, _| values[0].integer(c))
    }

    /// The value at balls with so many bits.
    pub fn at_balls(&self, values: &[Ball], bits: u64) -> Ball {
        self.evaluated(values, &[], 0, &|c, _| Ball::from_integer(c, bits))
    }

    /// The value over a power of two, and its exponent, where the variables are `2^exponent` times what is given: such that no term is
    /// larger than one where no value is.
    pub fn at_short(&self, values: &[ShortModel], exponents: &[i64], exponent: i64) -> ShortModel {
        self.evaluated(values, exponents, -exponent, &|c, exponent| values[0].constant(c, exponent))
    }

    /// `constant(c, e)` is `c 2^e`.
    fn evaluated<S: Enclosed>(
        &self,
        values: &[S],
        exponents: &[i64],
        exponent: i64,
        constant: &dyn Fn(&Integer, i64) -> S,
    ) -> S {
        checkpoint(16);
        let (variable, parts) = match self {
            Horner::Constant(c) => return constant(c, exponent),
            Horner::In(variable, parts) => (*variable, parts),
        };
        let of_variable = exponents.get(variable).copied().unwrap_or(0);
        let mut sum: Option<S> = None;
        for (k, part) in parts.iter().enumerate().rev() {
            let shifted = sum.map(|s| s.times(&values[variable]));
            let part = part.as_ref();
            let part = part.map(|p| p.evaluated(values, exponents, exponent + of_variable * k as i64, constant));
            sum = match (shifted, part) {
                (Some(s), Some(part)) => Some(s.plus(&part)),
                (one, other) => one.or(other),
            };
        }
        sum.expect("a polynomial that is not constant")
    }

    /// A power of two that no term is larger than where the variables are at most powers of two with these exponents; `None` for zero.
    pub fn largest_term(&self, exponents: &[i64]) -> Option<i64> {
        match self {
            Horner::Constant(c) => (!c.is_zero()).then(|| c.bit_length() as i64),
            Horner::In(variable, parts) => {
                let parts = parts.iter().enumerate();
                parts
                    .filter_map(|(k, p)| Some(p.as_ref()?.largest_term(exponents)? + exponents[*variable] * k as i64))
                    .max()
            }
        }
    }
}

/// The value of a polynomial at balls with so many bits, its variables in this order.
///
/// Cost: products of balls, as many as Horner's scheme in several variables takes.
///
/// ```
/// use jurist_algebra::ball::Ball;
/// use jurist_algebra::poly::{Domain, MultiPoly};
/// use jurist_algebra::symbols::value_at_balls;
/// let third = Ball::from_rational(&"1/3".parse().unwrap(), 64);
/// let square = MultiPoly::variable(0).times(&MultiPoly::variable(0));
/// assert!(value_at_balls(&square, &[third], 64).contains(&"1/9".parse().unwrap()));
/// ```
///
/// # Panics
/// When a variable has no value.
pub fn value_at_balls(p: &MultiPoly, values: &[Ball], bits: u64) -> Ball {
    Horner::of(p).at_balls(values, bits)
}

/// A function as the schemes of its polynomials.
#[derive(Clone, Debug)]
pub(super) enum Scheme {
    Polynomial(Horner),
    Resultant(Vec<Horner>, Vec<Horner>),
}

/// Polynomials of so many coefficients have few minors.
const MOST_BY_MINORS: usize = 9;

impl Scheme {
    pub fn of(f: &Function) -> Scheme {
        let list = |list: &[MultiPoly]| list.iter().map(Horner::of).collect();
        match f {
            Function::Polynomial(p) => Scheme::Polynomial(Horner::of(p)),
            Function::Resultant { a, b } => Scheme::Resultant(list(a), list(b)),
        }
    }

    /// The function at series or models of the parameter and the symbols.
    pub fn at<S: Elementary>(&self, values: &[S]) -> S {
        let list = |list: &[Horner]| list.iter().map(|p| p.at(values)).collect::<Vec<S>>();
        match self {
            Scheme::Polynomial(p) => p.at(values),
            Scheme::Resultant(a, b) if a.len() <= MOST_BY_MINORS => enclosed_resultant_by_minors(&list(a), &list(b)),
            Scheme::Resultant(a, b) => enclosed_resultant(&list(a), &list(b)),
        }
    }

    /// The same up to a power of two, in short numbers; `None` where they are too short.
    pub fn at_short(&self, values: &[TaylorModel]) -> Option<Known> {
        let exponents: Vec<i64> = values.iter().map(TaylorModel::exponent).collect();
        let short: Vec<ShortModel> = values.iter().zip(&exponents).map(|(v, e)| ShortModel::of(v, *e)).collect();
        let list = |list: &[Horner]| -> Vec<ShortModel> {
            let largest = list.iter().filter_map(|p| p.largest_term(&exponents)).max().unwrap_or(0);
            list.iter().map(|p| p.at_short(&short, &exponents, largest)).collect()
        };
        match self {
            Scheme::Polynomial(p) => list(std::slice::from_ref(p))[0].known(),
            Scheme::Resultant(a, b) if a.len() <= MOST_BY_MINORS => short_resultant(&list(a), &list(b)).known(),
            Scheme::Resultant(..) => None,
        }
    }
}
