//! The open loop as functions of parameters, in the form in which it is asked along the circle.

use super::along_circle::{Asked, Coefficient};
use super::family::Quotient;
use super::requirement::Rule;
use crate::stability::Shape;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RealAlgebraic};

/// What a requirement asks of an open loop in parameters, as polynomials in these and in symbols.
pub(super) struct LoopFunctions {
    /// The coefficients of the denominator and of the numerator without its content, that content, the number that is asked for, and what must
    /// not vanish. In discrete time the coefficients are those in `w = z - 1`: what cancels at `z = 1` is seen in symbols.
    pub all: Vec<MultiPoly>,
    /// How many are the denominator's, and the numerator's.
    sizes: [usize; 2],
    rule: Rule,
}

impl LoopFunctions {
    /// Of an open loop; `alpha` is the number that is asked for.
    pub fn new(quotient: &Quotient<MultiPoly>, undefined: &MultiPoly, rule: &Rule, alpha: MultiPoly) -> LoopFunctions {
        let content = quotient.numerator.content();
        let numerator = quotient.numerator.map(|c| c.div_exact(&content).expect("the content divides"));
        let one_more = Poly::new(vec![MultiPoly::one(), MultiPoly::one()]);
        let parts = [&quotient.denominator, &numerator].map(|p| match quotient.shape {
            Shape::UnitDisc => p.compose(&one_more).into_coeffs(),
            Shape::LeftHalfPlane => p.coeffs().to_vec(),
        });
        let sizes = [parts[0].len(), parts[1].len()];
        let all = parts.into_iter().flatten().chain([content, alpha, undefined.clone()]).collect();
        LoopFunctions { all, sizes, rule: rule.clone() }
    }

    /// The coefficients of the denominator.
    pub fn denominator(&self) -> &[MultiPoly] {
        &self.all[..self.sizes[0]]
    }

    /// What is asked along the circle, of all functions' values in a box; `on_circle` brings both polynomials there. `None` where the loop may be
    /// undefined.
    pub fn asked<C: Coefficient>(&self, values: &[C], on_circle: impl Fn([&[C]; 2]) -> [Vec<C>; 2]) -> Option<Asked> {
        let (d, rest) = values.split_at(self.sizes[0]);
        let (n, rest) = rest.split_at(self.sizes[1]);
        let [content, alpha, undefined] = rest else { return None };
        undefined.affine().sign()?;
        let [d, n] = on_circle([d, n]);
        Some(Asked::of(&self.rule, &d, (&n, content), alpha))
    }
}

/// The number that a rule asks for; zero where that is part of the rule.
pub(super) fn number_asked(rule: &Rule) -> RealAlgebraic {
    match rule {
        Rule::Turned { twice_cosine } => twice_cosine.clone(),
        Rule::Factors(factor) => factor.clone(),
        _ => RealAlgebraic::from_rational(Rational::ZERO),
    }
}
