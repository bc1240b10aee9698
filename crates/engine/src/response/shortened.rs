//! Products along the boundary with a symbol for each long coefficient.
//!
//! Where each coefficient of an open loop is a constant of its own, a coefficient of `|D0|^2` is a sum of as many products as the order, and one of the
//! derivative of a quotient has the fourth power of them: at order 10 most of the time of margins went into sums of thousands of terms. A symbol for each
//! coefficient of a product is a number as well as the coefficients that it is made of are. Factors with rational coefficients
//! stay exact, as those that an integrator brings, and so do values at rest that are rational multiples of one another.

use super::parts::Reduced;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{checkpoint, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::real::{Enclosing, Origin, Transcendental};
use jurist_algebra::symbols::{Definition, EnclosedNumber, Symbols, common_factor};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Coefficients of at most so many terms stay as they are.
const MOST_TERMS: usize = 6;

impl Reduced<MultiPoly> {
    /// The same products with symbols for long coefficients, and the table with these symbols after the others.
    pub(super) fn shortened(&self, symbols: &Arc<Symbols>) -> (Reduced<MultiPoly>, Arc<Symbols>) {
        let mut long = Vec::new();
        let first = symbols.len();
        let all = [&self.numerator_squared, &self.denominator_squared, &self.twice_real, &self.imaginary];
        let [numerator_squared, denominator_squared, twice_real, imaginary] =
            all.map(|p| with_symbols(p, first, &mut long));
        if long.is_empty() {
            return (self.clone(), Arc::clone(symbols));
        }
        let count = long.len();
        let products = Arc::new(Products { symbols: Arc::clone(symbols), list: long, known: Mutex::default() });
        let mut table = Symbols::clone(symbols);
        for index in 0..count {
            let words = format!("coefficient {index} of the products of the open loop's numerator and denominator");
            let value = Transcendental::new(Product { of: Arc::clone(&products), index });
            table.push(&format!("p{index}"), Definition::Enclosed(EnclosedNumber { words, value }));
        }
        let products = [numerator_squared, denominator_squared];
        (Reduced::of_products(products, [twice_real, imaginary], self.frequencies), Arc::new(table))
    }
}

/// The polynomial with symbols in its factor that is not rational: for the value at `x = 2`, and for the coefficients of what is left beside it. At rest
/// numerator and denominator may be rational multiples of one another, and so are their products as long as they have one symbol.
fn with_symbols(p: &Poly<MultiPoly>, first: usize, long: &mut Vec<MultiPoly>) -> Poly<MultiPoly> {
    if p.coeffs().iter().all(|c| c.terms().len() <= MOST_TERMS) {
        return p.clone();
    }
    let beside = Poly::new(p.coeffs().iter().map(|c| c.map_variables(|i| i + 1)).collect());
    let exact = common_factor(&MultiPoly::from_poly_in(&beside, 0)).map(|c| MultiPoly::constant(c.clone()));
    let rest = p.div_exact(&exact).expect("a common factor divides");
    let two = MultiPoly::from(2);
    let at_rest = rest.eval(&two);
    let from_rest = Poly::new(vec![two.negated(), MultiPoly::one()]);
    let others = rest.minus(&Poly::constant(at_rest.clone())).div_exact(&from_rest).expect("zero at x = 2");
    let mut short = |c: &MultiPoly| {
        if c.terms().len() <= MOST_TERMS {
            return c.clone();
        }
        let content = c.integer_content();
        let content = if c.terms().first().is_some_and(|(_, c)| c.is_negative()) { -content } else { content };
        let primitive = c.div_exact_integer(&content).expect("the content divides");
        let known = long.iter().position(|p| *p == primitive).unwrap_or_else(|| {
            long.push(primitive);
            long.len() - 1
        });
        MultiPoly::variable(first + known).scaled_by(&content)
    };
    let at_rest = Poly::constant(short(&at_rest));
    from_rest.times(&others.map(&mut short)).plus(&at_rest).times(&exact)
}

/// Polynomials in symbols; each list of values is computed once.
#[derive(Debug)]
struct Products {
    symbols: Arc<Symbols>,
    list: Vec<MultiPoly>,
    known: Mutex<BTreeMap<u64, Arc<Vec<Ball>>>>,
}

impl Products {
    fn values(&self, bits: u64) -> Arc<Vec<Ball>> {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&bits) {
            return Arc::clone(found);
        }
        let values = Arc::new(self.list.iter().map(|p| self.symbols.enclose(p, bits)).collect());
        known().insert(bits, Arc::clone(&values));
        values
    }
}

/// One of them.
#[derive(Debug)]
struct Product {
    of: Arc<Products>,
    index: usize,
}

impl Enclosing for Product {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        until_shown((bits + 64).next_power_of_two(), |working| {
            checkpoint(working);
            let found = self.of.values(working)[self.index].to_enclosure();
            (found.upper() - found.lower() <= width).then_some(found)
        })
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "coefficient of a product along the boundary".to_owned(), details: Vec::new() }
    }
}

#[cfg(test)]
mod tests;
