//! Loops with two parameters, and short ways to ask for their maps.

use super::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_algebra::real::Real;
use jurist_engine::stability::plane::{
    Limit, PlanePolynomial, RegionLimits, StabilityMap, region_limits, stability_map,
};
use jurist_engine::stability::{AlgebraicInterval, AtPoint, IntervalSet, Range, RealInterval, Shape};
use proptest::collection::vec;
use proptest::prelude::*;

pub fn x() -> RationalFunction {
    RationalFunction::variable(0)
}

pub fn y() -> RationalFunction {
    RationalFunction::variable(1)
}

pub fn c(text: &str) -> RationalFunction {
    number(text).into()
}

/// Coefficients from the constant term up; each is a pole where its denominator vanishes.
pub fn polynomial(coefficients: Vec<RationalFunction>) -> PlanePolynomial {
    let formal_degree = coefficients.len() - 1;
    let poles = coefficients.iter().map(|f| f.denominator().clone()).collect();
    let variables = vec!["x".to_string(), "y".to_string()];
    PlanePolynomial::new(&CharacteristicPolynomial { variables, coefficients, formal_degree, poles, monic: false })
}

/// `z + f`: stable where `|f| < 1`.
pub fn first_order(f: RationalFunction) -> PlanePolynomial {
    polynomial(vec![f, c("1")])
}

pub fn square(f: &RationalFunction) -> RationalFunction {
    f * f
}

/// A small polynomial in `x` and `y` with few terms.
pub fn coefficient() -> impl Strategy<Value = MultiPoly> {
    let term = ((0u32..=2, 0u32..=2), -6i64..=6).prop_map(|((i, j), c)| (vec![i, j], c.into()));
    vec(term, 1..=3).prop_map(MultiPoly::from_terms)
}

/// A loop of order 1 to 3; `z^n` plus small coefficients is stable somewhere more often than not.
pub fn small_loop() -> impl Strategy<Value = PlanePolynomial> {
    vec(coefficient(), 1..=3).prop_map(|low| {
        let scaled = |p: &MultiPoly| RationalFunction::new(p.clone(), MultiPoly::from(8)).unwrap();
        polynomial(low.iter().map(scaled).chain([c("1")]).collect())
    })
}

/// The plane without bounds.
pub fn plane() -> [Range; 2] {
    [Range::all(), Range::all()]
}

pub fn map(p: &PlanePolynomial, domain: &[Range; 2], region: Shape) -> StabilityMap {
    stability_map(p, domain, region, &Budget::unlimited()).unwrap()
}

pub fn disc(p: &PlanePolynomial) -> StabilityMap {
    map(p, &plane(), Shape::UnitDisc)
}

pub fn limits(m: &StabilityMap, p: &PlanePolynomial, domain: &[Range; 2], region: Shape) -> Vec<RegionLimits> {
    region_limits(m, p, domain, region, 12, &Budget::unlimited()).unwrap()
}

/// Both ends to eight digits.
pub fn ends(r: &RealInterval) -> (Option<String>, Option<String>) {
    let text = |e: &Option<Real>| e.as_ref().map(|e| e.decimal(8));
    (text(&r.lower), text(&r.upper))
}

/// A slice of a map of a loop without transcendental constants, as a set.
pub fn algebraic(slice: &[RealInterval]) -> IntervalSet {
    let end = |end: &Option<Real>| end.as_ref().map(|end| end.algebraic().expect("an algebraic number").clone());
    slice.iter().map(|i| AlgebraicInterval { lower: end(&i.lower), upper: end(&i.upper) }).collect()
}

pub fn some(a: &str, b: &str) -> (Option<String>, Option<String>) {
    (Some(a.into()), Some(b.into()))
}

/// The value and the causes of a limit.
pub fn said(limit: &Option<Limit>) -> Option<(String, String)> {
    limit.as_ref().map(|l| (l.value.decimal(8), l.causes.to_string()))
}

pub fn says(value: &str, causes: &str) -> Option<(String, String)> {
    Some((value.into(), causes.into()))
}

/// Whether all roots are strictly inside at a point, by the exact count.
pub fn is_stable(p: &PlanePolynomial, x: &Rational, y: &Rational, region: Shape) -> bool {
    matches!(p.at(x, y, region), AtPoint::Defined { count, infinite: 0 } if count.inside == p.formal_degree())
}

/// The cell of a point agrees with the exact root count there; `None` on a curve or a wall.
pub fn cell_agrees(
    m: &StabilityMap,
    p: &PlanePolynomial,
    x: &Rational,
    y: &Rational,
    domain: &[Range; 2],
    region: Shape,
) -> Option<bool> {
    let (s, k) = m.locate(x, y, &domain[1], &Budget::unlimited()).unwrap()?;
    let cell = &m.strips[s].cells[k];
    let AtPoint::Defined { count, infinite } = p.at(x, y, region) else { return Some(false) };
    let stable = infinite == 0 && count.inside == p.formal_degree();
    Some((count.outside + infinite, count.on, stable) == (cell.outside, cell.on, cell.stable))
}
