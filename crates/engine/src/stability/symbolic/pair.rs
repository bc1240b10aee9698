//! Where on the boundary a complex pair sits at a limit that is a root over symbols.

use crate::stability::{ComplexPair, HalfSizePair, Shape};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, subresultant_chain};
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};
use jurist_algebra::symbols::Symbols;
use std::fmt;
use std::sync::Arc;

/// Bits after which a common root is not looked for.
const MOST_BITS: u64 = 1 << 12;

/// What is known of the common roots of the half-size pair at a value of the parameter.
pub(super) enum Common {
    /// One, strictly inside of the boundary's interval: a pair of roots is there.
    Pair(ComplexPair),
    /// One, beyond the interval: two real roots that are mirror images of each other.
    Beyond,
    /// Several, or one at an end of the interval.
    Unknown,
}

/// What polynomials in the parameter (variable 0) and symbols are for a value of the parameter.
pub(super) trait Values: fmt::Debug + Send + Sync {
    /// The value of a polynomial, the parameter anywhere in a ball; `None` where a symbol has none.
    fn at(&self, p: &MultiPoly, parameter: &Ball) -> Option<Ball>;
}

impl Values for Symbols {
    fn at(&self, p: &MultiPoly, parameter: &Ball) -> Option<Ball> {
        let bits = parameter.bits();
        let in_parameter = p.as_poly_in(0);
        let coefficients = in_parameter.coeffs().iter().rev();
        Some(coefficients.fold(Ball::zero(bits), |sum, c| {
            sum.mul(parameter).add(&self.enclose(&c.map_variables(|i| i.saturating_sub(1)), bits))
        }))
    }
}

/// The first subresultant of the half-size pair, as polynomials in the parameter and symbols: at a zero of the resultant its
/// root is the common root.
pub(super) struct FirstSubresultant {
    constant: MultiPoly,
    leading: MultiPoly,
    values: Arc<dyn Values>,
    region: Shape,
}

impl FirstSubresultant {
    /// `None` where the chain has none.
    pub fn new(
        pair: &HalfSizePair<MultiPoly>,
        values: Arc<dyn Values>,
        budget: &Budget,
    ) -> Result<Option<FirstSubresultant>, Exhausted> {
        let (a, b) = (&pair.a, &pair.b);
        let (first, second) = if a.degree() >= b.degree() { (a, b) } else { (b, a) };
        if second.is_zero() {
            return Ok(None);
        }
        let chain = subresultant_chain(first, second, budget)?;
        let linear = |p: &&Poly<MultiPoly>| p.degree() == Some(1);
        Ok(chain.iter().rev().find(linear).map(|p| FirstSubresultant {
            constant: p.coeff(0),
            leading: p.coeff(1),
            values,
            region: pair.region,
        }))
    }

    /// The common root at a zero of the resultant.
    pub fn at(&self, value: &Real, budget: &Budget) -> Result<Common, Exhausted> {
        let root = CommonRoot {
            constant: self.constant.clone(),
            leading: self.leading.clone(),
            values: Arc::clone(&self.values),
            parameter: value.clone(),
        };
        let (lower, upper) = match self.region {
            Shape::UnitDisc => (Some(Rational::from(-2)), Rational::from(2)),
            Shape::LeftHalfPlane => (None, Rational::ZERO),
        };
        let mut bits = 64;
        while bits <= MOST_BITS {
            budget.check()?;
            if let Some(x) = budget.enter(|| root.attempt(bits))? {
                if *x.upper() < upper && lower.as_ref().is_none_or(|l| l < x.lower()) {
                    let x = Transcendental::within(root, x);
                    return Ok(Common::Pair(ComplexPair::at_half_size_root(self.region, x)));
                }
                if *x.lower() > upper || lower.as_ref().is_some_and(|l| x.upper() < l) {
                    return Ok(Common::Beyond);
                }
            }
            bits *= 2;
        }
        Ok(Common::Unknown)
    }
}

/// The root of the first subresultant at a value of the parameter.
#[derive(Debug)]
struct CommonRoot {
    constant: MultiPoly,
    leading: MultiPoly,
    values: Arc<dyn Values>,
    parameter: Real,
}

impl CommonRoot {
    /// An enclosure computed with so many bits; `None` where the leading coefficient may vanish.
    fn attempt(&self, bits: u64) -> Option<Enclosure> {
        let (lo, hi) = self.parameter.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
        let at = Ball::between(&lo, &hi, bits);
        let value = |p: &MultiPoly| self.values.at(p, &at);
        Some(value(&self.constant)?.neg().div(&value(&self.leading)?)?.to_enclosure())
    }
}

impl Enclosing for CommonRoot {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        let mut working = bits + 64;
        loop {
            checkpoint(working);
            // The leading coefficient is not zero, as was seen when the root was made.
            if let Some(x) = self.attempt(working)
                && x.upper() - x.lower() <= width
            {
                return x;
            }
            working *= 2;
        }
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "first subresultant".to_owned(), details: Vec::new() }
    }
}
