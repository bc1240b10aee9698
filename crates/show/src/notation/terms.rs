//! A coefficient as sums of monomials with rational coefficients.

use jurist_algebra::number::{Rational, to_decimal};
use jurist_algebra::poly::{MultiPoly, RationalFunction};

/// Monomials as exponents of the parameters, with their coefficients, in descending order.
pub type Terms = Vec<(Vec<u32>, Rational)>;

/// A rational function as sums of monomials: the denominator is `None` where it is a number, by which
/// the numerator's coefficients are then divided.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficient {
    /// Terms of the numerator.
    pub numerator: Terms,
    /// Terms of the denominator; `None` where it is a number, which then divides the numerator.
    pub denominator: Option<Terms>,
}

impl Coefficient {
    /// From a rational function in so many parameters.
    pub fn new(function: &RationalFunction, parameters: usize) -> Self {
        match function.denominator().as_constant() {
            Some(d) => Coefficient {
                numerator: terms(function.numerator(), parameters, &Rational::from(d)),
                denominator: None,
            },
            None => Coefficient {
                numerator: terms(function.numerator(), parameters, &Rational::ONE),
                denominator: Some(terms(function.denominator(), parameters, &Rational::ONE)),
            },
        }
    }
}

/// The terms of a polynomial, divided by a number.
pub(crate) fn terms(polynomial: &MultiPoly, parameters: usize, divisor: &Rational) -> Terms {
    let term = |(monomial, c): &(jurist_algebra::poly::Monomial, jurist_algebra::number::Integer)| {
        let exponents = (0..parameters).map(|i| monomial.exponent(i)).collect();
        (exponents, Rational::from(c) / divisor)
    };
    polynomial.terms().iter().map(term).collect()
}

/// How sums, products, powers and numbers are written in a notation.
pub struct Syntax<'a> {
    /// A number that is not negative.
    pub number: &'a dyn Fn(&Rational) -> String,
    /// A parameter to a power of at least 1.
    pub power: &'a dyn Fn(usize, u32) -> String,
    /// Between factors.
    pub times: &'a str,
    /// A quotient of two sums; each comes with whether it is a single term.
    pub quotient: &'a dyn Fn((String, bool), (String, bool)) -> String,
}

impl Syntax<'_> {
    /// The coefficient as an expression.
    pub fn coefficient(&self, coefficient: &Coefficient) -> String {
        let numerator = self.sum(&coefficient.numerator);
        match &coefficient.denominator {
            None => numerator,
            Some(terms) => {
                let single = coefficient.numerator.len() == 1;
                (self.quotient)((numerator, single), (self.sum(terms), false))
            }
        }
    }

    fn sum(&self, terms: &Terms) -> String {
        if terms.is_empty() {
            return (self.number)(&Rational::ZERO);
        }
        let mut out = String::new();
        for (i, (exponents, c)) in terms.iter().enumerate() {
            out.push_str(match (i, c.is_negative()) {
                (0, true) => "-",
                (0, false) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            });
            let magnitude = c.abs();
            let mut factors = Vec::new();
            let powers = exponents.iter().enumerate().filter(|(_, e)| **e > 0);
            factors.extend(powers.map(|(i, e)| (self.power)(i, *e)));
            if !magnitude.is_one() || factors.is_empty() {
                factors.insert(0, (self.number)(&magnitude));
            }
            out.push_str(&factors.join(self.times));
        }
        out
    }
}

/// An exact fraction or a decimal.
pub fn plain_number(value: &Rational, digits: Option<usize>) -> String {
    match digits {
        None => value.to_string(),
        Some(digits) => to_decimal(value, digits),
    }
}
