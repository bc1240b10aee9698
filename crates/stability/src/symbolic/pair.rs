//! Where on the boundary a complex pair sits at a limit that is a root over symbols.

use crate::line::Common;
use crate::precisions::COMMON_ROOT;
use crate::{ComplexPair, HalfSizePair, Shape};
use jurist_algebra::ball::{Ball, common_root};
use jurist_algebra::limits::{Budget, Exhausted, checkpoint, until_shown};
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{MultiPoly, Poly};
use jurist_algebra::real::{Enclosing, Origin, Real, Transcendental};
use jurist_algebra::symbols::Symbols;
use std::fmt;
use std::sync::Arc;

/// What polynomials in the parameter (variable 0) and symbols are for a value of the parameter.
pub(super) trait Values: fmt::Debug + Send + Sync {
    /// The values of polynomials, the parameter anywhere in a ball; `None` where a symbol has none.
    fn at(&self, list: &[MultiPoly], parameter: &Ball) -> Option<Vec<Ball>>;
}

impl Values for Symbols {
    fn at(&self, list: &[MultiPoly], parameter: &Ball) -> Option<Vec<Ball>> {
        let bits = parameter.bits();
        let value = |p: &MultiPoly| {
            let in_parameter = p.as_poly_in(0);
            in_parameter.coeffs().iter().rev().fold(Ball::zero(bits), |sum, c| {
                sum.mul(parameter).add(&self.enclose(&c.map_variables(|i| i.saturating_sub(1)), bits))
            })
        };
        Some(list.iter().map(value).collect())
    }
}

/// The half-size pair as polynomials in the parameter and symbols, by all coefficients for the formal degrees.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub a: Vec<MultiPoly>,
    pub b: Vec<MultiPoly>,
    pub region: Shape,
}

impl Pair {
    pub fn of(pair: &HalfSizePair<MultiPoly>) -> Pair {
        let all = |p: &Poly<MultiPoly>, degree: usize| (0..=degree).map(|k| p.coeff(k)).collect();
        Pair { a: all(&pair.a, pair.degree_a), b: all(&pair.b, pair.degree_b), region: pair.region }
    }
}

/// Looks for the common root of the half-size pair where its resultant is zero.
pub(super) struct CommonRoots {
    pair: Arc<Pair>,
    values: Arc<dyn Values>,
}

impl CommonRoots {
    /// Of a pair that is not constant.
    pub fn new(pair: Arc<Pair>, values: Arc<dyn Values>) -> CommonRoots {
        CommonRoots { pair, values }
    }

    /// The common root at a zero of the resultant.
    pub fn at(&self, value: &Real, budget: &Budget) -> Result<Common, Exhausted> {
        let root =
            CommonRoot { pair: Arc::clone(&self.pair), values: Arc::clone(&self.values), parameter: value.clone() };
        let (lower, upper) = match self.pair.region {
            Shape::UnitDisc => (Some(Rational::from(-2)), Rational::from(2)),
            Shape::LeftHalfPlane => (None, Rational::ZERO),
        };
        let found = COMMON_ROOT.find(|bits| {
            budget.check()?;
            let Some(x) = budget.enter(|| root.attempt(bits))? else { return Ok(None) };
            let is_inside = *x.upper() < upper && lower.as_ref().is_none_or(|l| l < x.lower());
            let is_beyond = *x.lower() > upper || lower.as_ref().is_some_and(|l| x.upper() < l);
            Ok::<_, Exhausted>((is_inside || is_beyond).then_some(is_inside.then_some(x)))
        })?;
        Ok(match found {
            None => Common::Unknown,
            Some(None) => Common::Beyond,
            Some(Some(x)) => {
                let x = Transcendental::within(root, x);
                Common::Pair(ComplexPair::at_half_size_root(self.pair.region, x))
            }
        })
    }
}

/// The common root of the pair at a value of the parameter.
#[derive(Debug)]
struct CommonRoot {
    pair: Arc<Pair>,
    values: Arc<dyn Values>,
    parameter: Real,
}

impl CommonRoot {
    /// An enclosure computed with so many bits; `None` where the root is not seen to be the only one.
    fn attempt(&self, bits: u64) -> Option<Enclosure> {
        let (lo, hi) = self.parameter.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
        let at = Ball::between(&lo, &hi, bits);
        let values = |list: &[MultiPoly]| self.values.at(list, &at);
        Some(common_root(&values(&self.pair.a)?, &values(&self.pair.b)?)?.to_enclosure())
    }
}

impl Enclosing for CommonRoot {
    fn enclose(&self, bits: u64, _known: Option<&Enclosure>) -> Enclosure {
        let width = Rational::dyadic(&Integer::ONE, bits);
        until_shown(bits + 64, |working| {
            checkpoint(working);
            // With enough bits the root is seen to be the only one, as when it was found.
            self.attempt(working).filter(|x| x.upper() - x.lower() <= width)
        })
    }

    fn origin(&self) -> Origin {
        Origin::Function { function: "common root of the half-size pair".to_owned(), details: Vec::new() }
    }
}
