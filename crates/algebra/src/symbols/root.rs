//! Polynomials with enclosed coefficients, and one real root of such a polynomial, refined to any width.

use super::Symbols;
use crate::ball::Ball;
use crate::limits::{Budget, Exhausted, checkpoint, until_shown};
use crate::number::{Enclosure, Integer, Rational};
use crate::poly::{Domain, MultiPoly};
use crate::precisions::DIRECTION;
use crate::real::{Enclosing, Origin};
use std::cmp::Ordering;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// A polynomial in one unknown whose coefficients are real numbers that are known by enclosures.
///
/// Its first and last coefficients are not zero.
pub trait EnclosedPoly: fmt::Debug + Send + Sync {
    /// Enclosures of all coefficients from the constant term up, computed with so many bits.
    fn enclose(&self, bits: u64) -> Vec<Ball>;

    /// Whether a rational number other than 0 is a root.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where it is not found out.
    fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted>;

    /// Where its roots come from.
    fn origin(&self) -> Origin;
}

/// A polynomial by its coefficients from the constant term up, polynomials in symbols.
#[derive(Debug)]
pub(super) struct Coefficients {
    symbols: Arc<Symbols>,
    list: Vec<MultiPoly>,
    /// With the bits that they were enclosed with last: neighbouring roots are refined with the same.
    known: Mutex<Option<(u64, Vec<Ball>)>>,
}

impl Coefficients {
    pub fn new(symbols: Arc<Symbols>, list: Vec<MultiPoly>) -> Coefficients {
        Coefficients { symbols, list, known: Mutex::default() }
    }
}

impl EnclosedPoly for Coefficients {
    fn enclose(&self, bits: u64) -> Vec<Ball> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, found)) = known().as_ref().filter(|(with, _)| *with == bits) {
            return found.clone();
        }
        let found: Vec<Ball> = self.list.iter().map(|c| self.symbols.enclose(c, bits)).collect();
        *known() = Some((bits, found.clone()));
        found
    }

    fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        let mut sum = MultiPoly::zero();
        let (n, d) = (x.numerator(), x.denominator());
        let degree = self.list.len() - 1;
        for (k, c) in self.list.iter().enumerate() {
            sum = sum.plus(&c.scaled_by(&(n.pow(k as u64) * d.pow((degree - k) as u64))));
        }
        self.symbols.is_zero(&sum, budget)
    }

    fn origin(&self) -> Origin {
        let names = self.symbols.names();
        let used: std::collections::BTreeSet<usize> = self.list.iter().flat_map(MultiPoly::variables).collect();
        Origin::Symbols {
            symbols: used.into_iter().map(|i| (names[i].clone(), self.symbols.definition_text(i))).collect(),
            polynomial: self.list.iter().map(|c| c.display(&names).to_string()).collect(),
        }
    }
}

/// The value at a ball.
fn value(coefficients: &[Ball], x: &Ball) -> Ball {
    let zero = Ball::zero(x.bits());
    coefficients.iter().rev().fold(zero, |sum, c| sum.mul(x).add(c))
}

pub(super) fn derivative(coefficients: &[Ball]) -> Vec<Ball> {
    coefficients.iter().enumerate().skip(1).map(|(k, c)| c.scaled(&Integer::from(k as u64))).collect()
}

/// The only root of a polynomial between two numbers, a simple one.
#[derive(Debug)]
pub(super) struct SymbolicRoot {
    pub of: Arc<dyn EnclosedPoly>,
    pub place: Enclosure,
}

impl Enclosing for SymbolicRoot {
    fn enclose(&self, bits: u64, known: Option<&Enclosure>) -> Enclosure {
        let known = known.unwrap_or(&self.place);
        let (mut lo, mut hi) = (known.lower().clone(), known.upper().clone());
        let target = Rational::dyadic(&Integer::ONE, bits);
        let mut working = bits + 64;
        let rising = self.rises();
        'precision: loop {
            let coefficients = self.of.enclose(working);
            let slope = derivative(&coefficients);
            while &hi - &lo > target {
                checkpoint(bits);
                let whole = Ball::between(&lo, &hi, working);
                let middle = middle(&lo, &hi, working);
                let at_middle = value(&coefficients, &middle);
                let step = at_middle.div(&value(&slope, &whole));
                let newton = step.and_then(|step| middle.sub(&step).intersection(&whole));
                let width = &hi - &lo;
                if let Some(newton) = newton
                    && (newton.upper() - newton.lower()) * Rational::from(2) <= width
                {
                    (lo, hi) = (newton.lower().max(lo), newton.upper().min(hi));
                    continue;
                }
                // Bisection; one of two points is not the root.
                let quarter = Ball::from_rational(&(&lo + &(&width * &Rational::dyadic(&Integer::ONE, 2))), working);
                let known = [(at_middle, middle), (value(&coefficients, &quarter), quarter)];
                let Some((sign, at)) = known.iter().find_map(|(v, at)| Some((v.sign()?, at))) else {
                    working *= 2;
                    continue 'precision;
                };
                if (sign == Ordering::Greater) == rising {
                    hi = at.upper()
                } else {
                    lo = at.lower()
                }
                if &hi - &lo >= width {
                    working *= 2;
                    continue 'precision;
                }
            }
            return Enclosure::new(lo, hi);
        }
    }

    fn origin(&self) -> Origin {
        self.of.origin()
    }
}

/// A number between two others, exact in that many bits unless they are as near as that.
fn middle(lo: &Rational, hi: &Rational, bits: u64) -> Ball {
    let ball = Ball::from_rational(&lo.midpoint(hi), bits);
    let unit = ball.lower();
    Ball::from_rational(&unit, bits)
}

impl SymbolicRoot {
    /// Whether the polynomial is negative below the root.
    fn rises(&self) -> bool {
        until_shown(DIRECTION, |working| {
            let coefficients = self.of.enclose(working);
            let at = |x: &Rational| value(&coefficients, &Ball::from_rational(x, working)).sign();
            let (below, above) = (at(self.place.lower())?, at(self.place.upper())?);
            (below != above).then(|| above.is_gt())
        })
    }
}
