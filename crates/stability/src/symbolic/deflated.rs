//! Zeros of resultants that are not expanded. Some of these zeros are known to be double.

use super::basis::{Condition, Unexpanded};
use super::resultant::PairResultant;
use crate::Range;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::MultiPoly;
use jurist_algebra::real::{Origin, Real};
use jurist_algebra::symbols::{EnclosedPoly, Symbols, merged};
use std::sync::Arc;

/// The zeros in a range of the resultant of two polynomials in an unknown, by all coefficients for their formal degrees, which are
/// polynomials in the parameter (variable 0) and symbols. Some numbers are known to be double zeros at least, and are among what is
/// returned; the others must be simple: else the search ends by itself, with an error.
///
/// Cost: values of the resultant at as many numbers as its degree, with more and more bits.
///
/// # Errors
/// [`Exhausted`] when the budget runs out, and where zeros are not told apart with some thousand bits.
pub fn zeros_of_resultant(
    [a, b]: [Vec<MultiPoly>; 2],
    double: Vec<Real>,
    symbols: &Arc<Symbols>,
    range: &Range,
    budget: &Budget,
) -> Result<Vec<Real>, Exhausted> {
    let of = PairResultant::of_curves(a, b, symbols, budget)?;
    if double.is_empty() {
        return Condition::Enclosed(Arc::new(of)).roots(range, budget);
    }
    let deflated = Deflated { of, double: double.clone() };
    let others = Condition::Enclosed(Arc::new(deflated)).roots(range, budget)?;
    merged(others, double, budget)
}

/// A polynomial without double zeros that are known.
#[derive(Debug)]
struct Deflated {
    of: PairResultant,
    /// Other numbers than 0.
    double: Vec<Real>,
}

impl Unexpanded for Deflated {
    fn vanishes_at_zero(&self) -> bool {
        self.of.vanishes_at_zero()
    }
}

impl EnclosedPoly for Deflated {
    fn enclose(&self, bits: u64) -> Vec<Ball> {
        let working = bits + 64;
        let mut coefficients = self.of.enclose(working);
        let width = Rational::dyadic(&Integer::ONE, working);
        for zero in &self.double {
            let (lo, hi) = zero.refined(&width).enclosure();
            let zero = Ball::between(&lo, &hi, working);
            // The rest is zero.
            for _ in 0..2 {
                for k in (1..coefficients.len() - 1).rev() {
                    coefficients[k] = coefficients[k].add(&coefficients[k + 1].mul(&zero));
                }
                coefficients.remove(0);
            }
        }
        coefficients.into_iter().map(|c| c.with_bits(bits)).collect()
    }

    fn vanishes_at(&self, x: &Rational, budget: &Budget) -> Result<bool, Exhausted> {
        self.of.vanishes_at(x, budget)
    }

    fn origin(&self) -> Origin {
        self.of.origin()
    }
}
