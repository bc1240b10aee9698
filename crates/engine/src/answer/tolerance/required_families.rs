//! The polynomials whose stability over a box is what a requirement asks for.

use crate::coverage::refusals::MARGINS_IN_ONE;
use crate::error::Error;
use crate::problem::Problem;
use crate::response::{Family, Requirement, Rule, half_tangent, radius_below};
use crate::stability::boxes::{BoxPolynomial, Side};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// Required numbers that are not rational are replaced by ones that ask for more, by a part in ten to this.
const DIGITS: usize = 30;

/// The same of exponentials, in binary digits.
const BITS: u64 = 100;

/// A family and the side of its own parameter, the last one, if it has any.
type FamilyOfLoops = (BoxPolynomial, Option<Side>);

/// How a family is made of a characteristic polynomial, of its degree and of what it is divided by.
type Made<'m> = &'m dyn Fn(&Poly<MultiPoly>, usize, &[&MultiPoly]) -> BoxPolynomial;

impl Problem {
    /// The families whose stability over the box is what is required; the parameters are followed by constants that are not rational.
    pub(super) fn families(
        self: &Arc<Self>,
        requirement: &Requirement,
        at: Option<&str>,
        parameters: usize,
        budget: &Budget,
    ) -> Result<Vec<FamilyOfLoops>, Error> {
        let shape = self.shape();
        match requirement.rule() {
            Rule::Sector(least) => {
                let in_sector = |p: &Poly<MultiPoly>, n: usize, undefined: &[&MultiPoly]| {
                    BoxPolynomial::in_sector(p, n, undefined, parameters, least)
                };
                self.family_of_roots(&in_sector, budget)
            }
            Rule::Modulus { exponent } => {
                let radius = radius_below(exponent, BITS);
                let (top, bottom) = (radius.numerator(), radius.denominator());
                let in_disc = |p: &Poly<MultiPoly>, n: usize, undefined: &[&MultiPoly]| {
                    let scale = |k: usize| &top.pow(k as u64) * &bottom.pow((n - k) as u64);
                    let scaled = Poly::new((0..=n).map(|k| p.coeff(k).scaled_by(&scale(k))).collect());
                    BoxPolynomial::of_parts(scaled, n, undefined.iter().copied(), parameters, shape)
                };
                self.family_of_roots(&in_disc, budget)
            }
            rule => self.families_at_cut(rule, at, parameters, budget),
        }
    }

    /// Of requirements on the roots.
    fn family_of_roots(self: &Arc<Self>, made: Made<'_>, budget: &Budget) -> Result<Vec<FamilyOfLoops>, Error> {
        let whole = self.without_region();
        let Some(d) = whole.algebra_over_symbols(budget)?.polynomial() else { return Ok(Vec::new()) };
        let (p, denominator) = budget.enter(|| d.cleared())?;
        let undefined: Vec<&MultiPoly> = d.poles.iter().chain([&denominator]).collect();
        Ok(vec![(budget.enter(|| made(&p, d.formal_degree, &undefined))?, None)])
    }

    /// Of requirements on the open loop at a cut.
    fn families_at_cut(
        self: &Arc<Self>,
        rule: &Rule,
        at: Option<&str>,
        parameters: usize,
        budget: &Budget,
    ) -> Result<Vec<FamilyOfLoops>, Error> {
        let (whole, shape) = (self.without_region(), self.shape());
        let family: Family<MultiPoly> = Family::of(&whole, at, budget)?;
        if *family.symbols != whole.fixed_symbols(budget)? {
            return Err(MARGINS_IN_ONE.diagnostic(&[]).into());
        }
        let [open, back] = family.parts();
        let undefined = [&family.undefined];
        let closed = open.plus(back);
        let above = |x: &Real| x.exact().unwrap_or_else(|| x.refined_to_digits(DIGITS).enclosure().1);
        let up_to = |t: Rational| Side::fixed(t.clone(), [t, Rational::ZERO]);
        let (list, side) = match rule {
            Rule::Factors(factor) => {
                let g = above(&Real::from(factor.clone()));
                let below = &Rational::ONE - &g.recip().expect("a factor above 1");
                let with_factor = open.plus(&back.scaled(&MultiPoly::variable(parameters)));
                let n = open.degree().max(back.degree()).unwrap_or(0);
                let p = budget.enter(|| BoxPolynomial::of_parts(with_factor, n, undefined, parameters + 1, shape))?;
                (vec![p], Side::fixed(Rational::ONE, [below, &g - &Rational::ONE]))
            }
            Rule::Turned { twice_cosine } => {
                let t = above(&half_tangent(twice_cosine, budget)?);
                let turned = [&closed, &back.minus(open)];
                (vec![budget.enter(|| BoxPolynomial::turned(turned, &undefined, parameters, shape))?], up_to(t))
            }
            Rule::Circle(circle) => {
                let scaled = |p: &Poly<MultiPoly>, by: &Integer| p.scaled(&MultiPoly::constant(by.clone()));
                let (least, combined) = (circle.least(), circle.combination(open, back));
                let (m, whole) = (scaled(&combined, &least.numerator()), scaled(&closed, &least.denominator()));
                let both = [[whole.plus(&m), m.minus(&whole)], [whole.minus(&m), m.plus(&whole).negated()]];
                let turned =
                    |[a, b]: &[Poly<MultiPoly>; 2]| BoxPolynomial::turned([a, b], &undefined, parameters, shape);
                (budget.enter(|| both.iter().map(turned).collect())?, up_to(Rational::ONE))
            }
            Rule::DeadTime(_) | Rule::Sector(_) | Rule::Modulus { .. } => unreachable!("not about the open loop alone"),
        };
        Ok(list.into_iter().map(|p| (p, Some(side.clone()))).collect())
    }
}
