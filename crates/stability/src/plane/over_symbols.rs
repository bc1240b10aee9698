//! Curves whose coefficients are polynomials in transcendental constants.

use super::content::separated_over_numbers;
use super::curves::{Curve, PlanePolynomial, X, Y};
use super::glue::{Links, Wall};
use super::ground::{Beside, Corner, Ground, Projected, put};
use super::nodes::Nodes;
use super::touching::{links_over_symbols, passes_over_symbols};
use crate::symbolic::{zeros_of_all, zeros_of_resultant};
use crate::{AtPoint, End, Range, Shape, SymbolicPolynomial, symbolic_stable_set};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted, parallel_map};
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, resultant_formal};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Function, SymbolicPoly, Symbols, common_scale, merged};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Resultants that may have more terms are not expanded.
const MOST_TERMS: u64 = 30_000;

/// The polynomials in symbols that are numbers, as variables from 2 on.
#[derive(Debug)]
pub(super) struct OverSymbols {
    pub symbols: Arc<Symbols>,
}

/// A polynomial in one parameter and symbols as the table of these expects it: the parameter is variable 0.
pub(super) fn in_one(f: &MultiPoly, parameter: usize) -> MultiPoly {
    f.map_variables(|i| if i == parameter { 0 } else { i.saturating_sub(1) })
}

/// A number as the table of symbols expects it.
fn number(f: &MultiPoly) -> MultiPoly {
    f.map_variables(|i| i.saturating_sub(2))
}

impl OverSymbols {
    pub fn new(symbols: &Arc<Symbols>) -> OverSymbols {
        OverSymbols { symbols: Arc::clone(symbols) }
    }

    /// The polynomial on a vertical line.
    fn line(&self, p: &PlanePolynomial, x: &Rational) -> SymbolicPolynomial {
        let one = |f: &MultiPoly| common_scale(std::slice::from_ref(f), x).swap_remove(0);
        SymbolicPolynomial::from_parts(
            &self.symbols,
            Poly::new(common_scale(p.cleared().coeffs(), x)),
            one(p.degree_loss()),
            p.formal_degree(),
            p.all_poles().map(one).collect(),
        )
    }

    /// One of the polynomials in `x`, expanded, without factors that are known to be repeated, and these factors; `None` where it is
    /// too long.
    fn projected(
        &self,
        wanted: Projected<'_>,
        curves: &[Curve],
        node: Option<&MultiPoly>,
        budget: &Budget,
    ) -> Result<Option<Vec<MultiPoly>>, Exhausted> {
        budget.check()?;
        let curve = |i: usize| curves[i].polynomial.as_poly_in(Y);
        let expanded = match wanted {
            Projected::Leading(i) => curve(i).leading().cloned().unwrap_or_default(),
            Projected::AtEdge(i, y) => put(&curves[i].polynomial, Y, y),
            Projected::Discriminant(_) | Projected::Resultant(..) => {
                let [f, g] = operands(wanted, curves);
                match resultant(&f, &g, budget)? {
                    Some(found) => found,
                    None => return Ok(None),
                }
            }
        };
        if expanded.is_zero() {
            // The curve is the edge itself.
            return if let Projected::AtEdge(..) = wanted { Ok(Some(Vec::new())) } else { Err(coincide()) };
        }
        let mut rest = expanded.primitive_over_integers();
        let mut parts = Vec::new();
        if let Some(node) = node {
            while let Some(quotient) = budget.enter(|| rest.div_exact(node))? {
                rest = quotient;
                if parts.is_empty() {
                    parts.push(node.clone());
                }
            }
        }
        parts.push(rest);
        Ok(Some(parts))
    }

    /// A polynomial in `x` as one over symbols.
    fn over_symbols(&self, f: &MultiPoly, budget: &Budget) -> Result<SymbolicPoly, Exhausted> {
        SymbolicPoly::new(&in_one(f, X), &self.symbols, budget)?.ok_or_else(coincide)
    }

    /// The zeros of one of the polynomials in `x` that is not expanded.
    fn zeros_unexpanded(
        &self,
        wanted: Projected<'_>,
        curves: &[Curve],
        nodes: &Nodes,
        range: &Range,
        budget: &Budget,
    ) -> Result<Vec<Real>, Exhausted> {
        let pair = operands(wanted, curves).map(|f| f.coeffs().iter().map(|c| in_one(c, X)).collect::<Vec<_>>());
        let double = match wanted {
            Projected::Discriminant(i) => nodes.on(&curves[i], self, range, budget)?,
            _ => Vec::new(),
        };
        zeros_of_resultant(pair, double, &self.symbols, range, budget)
    }

    /// Whether one of the polynomials in `x` has a zero between two numbers at which it has none.
    pub(super) fn changes_sign(
        &self,
        wanted: Projected<'_>,
        curves: &[Curve],
        [left, right]: [&Rational; 2],
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let Some(parts) = self.projected(wanted, curves, None, budget)? else { return Ok(false) };
        for part in parts {
            let part = self.over_symbols(&part, budget)?;
            let sign = |x: &Rational| -> Result<Sign, Exhausted> {
                let other =
                    self.symbols.sign(&put(part.rest(), 0, x).map_variables(|i| i.saturating_sub(1)), budget)?;
                Ok(if part.algebraic().poly().sign_at(x).is_lt() { other.reverse() } else { other })
            };
            if sign(left)? != sign(right)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The value of a polynomial in which no parameter occurs.
    pub(super) fn constant(&self, f: &MultiPoly, bits: u64) -> Ball {
        self.symbols.enclose(&number(f), bits)
    }

    /// The coefficients of the powers of `y` where `x` is anywhere in an interval.
    pub(super) fn over(&self, f: &Poly<MultiPoly>, x: &Ball) -> Vec<Ball> {
        f.coeffs().iter().map(|c| self.horner(c, X, x)).collect()
    }

    /// The value at a point that is enclosed.
    pub(super) fn value(&self, f: &MultiPoly, x: &Ball, y: &Ball) -> Ball {
        let zero = Ball::zero(y.bits());
        self.over(&f.as_poly_in(Y), x).iter().rev().fold(zero, |sum, c| sum.mul(y).add(c))
    }

    /// The values of a polynomial in one parameter on an interval.
    fn horner(&self, f: &MultiPoly, parameter: usize, at: &Ball) -> Ball {
        let zero = Ball::zero(at.bits());
        let value = |c: &MultiPoly| self.constant(c, at.bits());
        f.as_poly_in(parameter).coeffs().iter().rev().fold(zero, |sum, c| sum.mul(at).add(&value(c)))
    }
}

/// The polynomials in `y` whose resultant a discriminant or a resultant is. The discriminant is that of `f'` and `n f - y f'`, both of
/// degree `n - 1`: the leading coefficient is then no factor of it.
fn operands(wanted: Projected<'_>, curves: &[Curve]) -> [Poly<MultiPoly>; 2] {
    let curve = |i: usize| curves[i].polynomial.as_poly_in(Y);
    match wanted {
        Projected::Resultant(i, j) => [curve(i), curve(j)],
        Projected::Leading(i) | Projected::AtEdge(i, _) | Projected::Discriminant(i) => {
            let f = curve(i);
            let n = f.degree().unwrap_or(0);
            let other = (0..n).map(|k| f.coeff(k).scaled_by(&Integer::from((n - k) as u64))).collect();
            [f.derivative(), Poly::new(other)]
        }
    }
}

/// The resultant in `y`, for the higher one of both degrees of the polynomials of a discriminant; `None` where it may have too many
/// terms.
pub(super) fn resultant(
    f: &Poly<MultiPoly>,
    g: &Poly<MultiPoly>,
    budget: &Budget,
) -> Result<Option<MultiPoly>, Exhausted> {
    let (m, n) = (f.degree().unwrap_or(0), g.degree().unwrap_or(0));
    if m == 0 && n == 0 {
        return Ok(Some(MultiPoly::one()));
    }
    let terms = Function::resultant(f.coeffs().to_vec(), g.coeffs().to_vec()).expanded_size();
    if terms > MOST_TERMS {
        return Ok(None);
    }
    resultant_formal(f, m, g, n, budget).map(Some)
}

/// Curves that are different polynomials in symbols and the same ones with the numbers these stand for.
fn coincide() -> Exhausted {
    Exhausted::by_method("identities of constants", "boundary curves have a part in common that only their values show")
}

/// The numbers before the powers of the parameters, as the table of symbols expects them.
fn coefficients(f: &MultiPoly) -> impl Iterator<Item = ([u32; 2], MultiPoly)> {
    let mut found: BTreeMap<[u32; 2], Vec<_>> = BTreeMap::new();
    for (monomial, c) in f.terms() {
        let symbols = monomial.exponents().get(2..).unwrap_or_default().to_vec();
        found.entry([monomial.exponent(X), monomial.exponent(Y)]).or_default().push((symbols, c.clone()));
    }
    found.into_iter().map(|(powers, terms)| (powers, MultiPoly::from_terms(terms)))
}

impl Ground for OverSymbols {
    fn vanishes(&self, f: &MultiPoly, budget: &Budget) -> Result<bool, Exhausted> {
        for (_, number) in coefficients(f) {
            if !self.symbols.is_zero(&number, budget)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn separated(&self, f: &MultiPoly, budget: &Budget) -> Result<Vec<MultiPoly>, Exhausted> {
        separated_over_numbers(self, f, budget)
    }

    fn sign(&self, f: &MultiPoly, budget: &Budget) -> Result<Sign, Exhausted> {
        self.symbols.sign(&number(f), budget)
    }

    fn zeros(
        &self,
        f: &MultiPoly,
        parameter: usize,
        [lower, upper]: [Option<&Rational>; 2],
        budget: &Budget,
    ) -> Result<Option<Vec<Real>>, Exhausted> {
        match SymbolicPoly::new(&in_one(f, parameter), &self.symbols, budget)? {
            None => Ok(None),
            Some(f) => f.real_roots_in(lower, upper, budget).map(Some),
        }
    }

    fn critical_values(
        &self,
        p: &PlanePolynomial,
        curves: &[Curve],
        wanted: &[Projected<'_>],
        (range, region): (&Range, Shape),
        budget: &Budget,
    ) -> Result<Vec<Real>, Exhausted> {
        let nodes = Nodes::of(p, region, budget)?;
        let found: Result<Vec<Option<Vec<SymbolicPoly>>>, Exhausted> = parallel_map(wanted, |wanted| {
            let Some(parts) = self.projected(*wanted, curves, nodes.expanded(), budget)? else { return Ok(None) };
            let part = |f: &MultiPoly| self.over_symbols(&self.symbols.norm(f, 2, budget)?, budget);
            parts.iter().map(part).collect::<Result<Vec<_>, Exhausted>>().map(Some)
        });
        let found = found?;
        budget.step("isolating critical values");
        let long: Vec<Projected<'_>> =
            wanted.iter().zip(&found).filter(|(_, found)| found.is_none()).map(|(wanted, _)| *wanted).collect();
        let lists: Result<Vec<Vec<Real>>, Exhausted> =
            parallel_map(long, |wanted| self.zeros_unexpanded(wanted, curves, &nodes, range, budget));
        let mut all = zeros_of_all(found.into_iter().flatten().flatten().collect(), &self.symbols, range, budget)?;
        for list in lists? {
            all = merged(all, list, budget)?;
        }
        Ok(all)
    }

    fn counts(
        &self,
        p: &PlanePolynomial,
        x: &Rational,
        heights: &[Rational],
        region: Shape,
        budget: &Budget,
    ) -> Result<Vec<AtPoint>, Exhausted> {
        let line = budget.enter(|| self.line(p, x))?;
        heights.iter().map(|y| line.at(y, region, budget)).collect()
    }

    fn is_clear(
        &self,
        f: &MultiPoly,
        [left, right]: [&Rational; 2],
        y: &Rational,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let along = put(f, Y, y);
        // Nearly always the values on the whole segment show it.
        let width = right - left;
        let bits = 128 + 2 * width.denominator().bit_length();
        let all = budget.enter(|| self.horner(&along, X, &Ball::between(left, right, bits)))?;
        if all.sign().is_some() {
            return Ok(true);
        }
        for end in [left, right] {
            if self.sign(&put(&along, X, end), budget)?.is_eq() {
                return Ok(false);
            }
        }
        let zeros = self.zeros(&along, X, [Some(left), Some(right)], budget)?;
        Ok(left == right || zeros.is_some_and(|zeros| zeros.is_empty()))
    }

    fn links(&self, wall: &Wall<'_>, pairs: &[(usize, usize)], budget: &Budget) -> Result<Links, Exhausted> {
        links_over_symbols(self, wall, pairs, budget)
    }

    fn ends(
        &self,
        p: &PlanePolynomial,
        x: &Rational,
        beside: &Beside<'_>,
        (range, region): (&Range, Shape),
        budget: &Budget,
    ) -> Result<Vec<End>, Exhausted> {
        let line = budget.enter(|| self.line(p, x))?;
        let set = symbolic_stable_set(&line, range, region, budget)?;
        let Some(around) = set.intervals().iter().find(|i| i.contains(&beside.inside)) else { return Ok(Vec::new()) };
        let sides = [&around.lower, &around.upper].into_iter().zip(&beside.beyond).zip(beside.walls);
        let is_end = |beyond: &Option<Rational>| beyond.as_ref().is_none_or(|point| !around.contains(point));
        let ends = sides.filter_map(|((end, beyond), wall)| wall.and(end.clone()).filter(|_| is_end(beyond)));
        Ok(ends.collect())
    }

    fn passes(
        &self,
        curves: &[Curve],
        pair: [usize; 2],
        corner: &Corner<'_>,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        passes_over_symbols(self, curves, pair, corner, budget)
    }

    fn enclose(&self, f: &MultiPoly, x: &Enclosure, y: &Enclosure, bits: u64) -> Enclosure {
        let zero = || Enclosure::from_rational(Rational::ZERO);
        let value = |c: &MultiPoly| self.symbols.enclose(&number(c), bits).to_enclosure();
        let over = |c: &MultiPoly| {
            let in_x = c.as_poly_in(X);
            in_x.coeffs().iter().rev().fold(zero(), |sum, c| sum.mul(x, bits).add(&value(c), bits))
        };
        let in_y = f.as_poly_in(Y);
        in_y.coeffs().iter().rev().fold(zero(), |sum, c| sum.mul(y, bits).add(&over(c), bits))
    }

    fn rounded(&self, f: &MultiPoly, bits: u64) -> MultiPoly {
        let round =
            |(powers, c): ([u32; 2], MultiPoly)| (powers.to_vec(), self.symbols.enclose(&c, bits).middle_units());
        MultiPoly::from_terms(coefficients(f).map(round))
    }
}
