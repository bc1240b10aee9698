//! Where the curve of complex pairs crosses itself: two pairs of roots are on the boundary at once.

use super::curves::{Curve, PlanePolynomial, X, Y, without_number};
use super::over_symbols::{OverSymbols, in_one, resultant};
use crate::precisions::SINGULAR_POINT;
use crate::symbolic::{zeros_of_all, zeros_of_resultant};
use crate::{Cause, HalfSizePair, Range, Shape};
use jurist_algebra::ball::{Ball, common_root};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, subresultant_chain};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::SymbolicPoly;

/// The half-size pair's subresultant of degree 1, in whose common zeros the pair has two common roots, if it has not lost degree.
///
/// There the matrix of Sylvester has two dependent rows at least, so that its determinant, the polynomial of the curve, and the derivatives
/// of this are zero: the point is a singular one of the curve, and the discriminant is zero twice at least.
#[derive(Debug, Default)]
pub(super) struct Nodes {
    known: Option<Known>,
}

#[derive(Debug)]
struct Known {
    /// Coefficients of the subresultant of degree 1.
    linear: [MultiPoly; 2],
    /// The leading coefficient of that of degree 2: where it is not zero, and the other subresultant is, the pair has two common roots.
    leading: MultiPoly,
    /// The resultant of the pair.
    resultant: MultiPoly,
    /// That of both coefficients in `y`, where it is not too long.
    expanded: Option<MultiPoly>,
}

impl Nodes {
    /// Of a loop; nothing where there can be no such points, or its pair is a special one.
    pub fn of(p: &PlanePolynomial, region: Shape, budget: &Budget) -> Result<Nodes, Exhausted> {
        if p.formal_degree() < 4 {
            return Ok(Nodes::default());
        }
        let pair = HalfSizePair::new(p.cleared(), p.formal_degree(), region);
        let (a, b) = if pair.a.degree() >= pair.b.degree() { (&pair.a, &pair.b) } else { (&pair.b, &pair.a) };
        if b.degree().unwrap_or(0) == 0 {
            return Ok(Nodes::default());
        }
        let chain = subresultant_chain(a, b, budget)?;
        let of_degree = |d: usize| chain.iter().rev().find(|s| s.degree() == Some(d));
        let (Some(linear), Some(square)) = (of_degree(1), of_degree(2)) else { return Ok(Nodes::default()) };
        let linear = [0, 1].map(|k| linear.coeff(k));
        let [first, second] = linear.each_ref().map(|c| c.as_poly_in(Y));
        if first.is_zero() || second.is_zero() || first.is_constant() && second.is_constant() {
            return Ok(Nodes::default());
        }
        let expanded = resultant(&first, &second, budget)?.filter(|f| f.degree_in(X) > 0);
        let known = Known {
            leading: square.coeff(2),
            resultant: pair.critical_constraint(budget)?,
            expanded: expanded.map(|f| without_number(&f)),
            linear,
        };
        Ok(Nodes { known: Some(known) })
    }

    /// The polynomial in `x` at whose zeros there may be such points; `None` where it is not expanded.
    pub fn expanded(&self) -> Option<&MultiPoly> {
        self.known.as_ref()?.expanded.as_ref()
    }

    /// Zeros of the discriminant of a curve that are known to be double at least.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where zeros are not told apart with some thousand bits.
    pub fn on(
        &self,
        curve: &Curve,
        ground: &OverSymbols,
        range: &Range,
        budget: &Budget,
    ) -> Result<Vec<Real>, Exhausted> {
        let Some(known) = self.known.as_ref().filter(|_| curve.causes.contains(Cause::ComplexPair)) else {
            return Ok(Vec::new());
        };
        // What is left of the resultant is to be without a zero there.
        let Some(rest) = budget.enter(|| known.resultant.div_exact(&curve.polynomial))? else { return Ok(Vec::new()) };
        let symbols = &ground.symbols;
        let zeros = match &known.expanded {
            Some(f) => {
                let Some(f) = SymbolicPoly::new(&in_one(f, X), symbols, budget)? else { return Ok(Vec::new()) };
                zeros_of_all(vec![f], symbols, range, budget)?
            }
            None => {
                let pair = known.linear.each_ref().map(|c| {
                    let in_y = c.as_poly_in(Y);
                    in_y.coeffs().iter().map(|c| in_one(c, X)).collect::<Vec<_>>()
                });
                zeros_of_resultant(pair, Vec::new(), symbols, range, budget)?
            }
        };
        let mut double = Vec::new();
        for zero in zeros {
            if zero.exact().is_none() && known.is_singular(&zero, &rest, ground, budget)? {
                double.push(zero);
            }
        }
        Ok(double)
    }
}

impl Known {
    /// Whether it is seen that a curve, of which the resultant is a product with `rest`, is singular over a zero.
    fn is_singular(
        &self,
        zero: &Real,
        rest: &MultiPoly,
        ground: &OverSymbols,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let linear: Vec<Poly<MultiPoly>> = self.linear.iter().map(|c| c.as_poly_in(Y)).collect();
        for bits in SINGULAR_POINT.bits() {
            let is_seen = budget.enter(|| {
                let (lo, hi) = zero.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
                let x = Ball::between(&lo, &hi, bits);
                let y = common_root(&ground.over(&linear[0], &x), &ground.over(&linear[1], &x))?;
                let differs = |f: &MultiPoly| ground.value(f, &x, &y).sign().is_some();
                (differs(&self.leading) && differs(rest)).then_some(())
            })?;
            if is_seen.is_some() {
                return Ok(true);
            }
        }
        Ok(false)
    }
}
