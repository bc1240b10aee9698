//! The curves in the plane of two parameters at which the number of stable roots may change.

use crate::stability::{AtPoint, Cause, Causes, HalfSizePair, ParametricPolynomial, Shape, count_roots};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};

/// The numbers of the two parameters as variables of a [`MultiPoly`].
pub const X: usize = 0;
/// See [`X`].
pub const Y: usize = 1;

/// A boundary curve: a square-free polynomial in both parameters, and what may happen on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What happens on the curve; for `complex pair` parts of it may be mirror pairs off the boundary.
    pub causes: Causes,
    /// The polynomial, primitive over the integers and coprime to those of the other curves.
    pub polynomial: MultiPoly,
}

/// A characteristic polynomial with two parameters, ready to be decomposed.
#[derive(Clone, Debug)]
pub struct PlanePolynomial {
    /// In `z` over `Z[x, y]`, denominators cleared.
    polynomial: Poly<MultiPoly>,
    denominator: MultiPoly,
    degree_loss: MultiPoly,
    formal_degree: usize,
    poles: Vec<MultiPoly>,
}

impl PlanePolynomial {
    /// From a characteristic polynomial in which the variables 0 and 1 are kept.
    pub fn new(d: &CharacteristicPolynomial) -> Self {
        let (polynomial, denominator) = d.cleared();
        let degree_loss = d.coefficients.get(d.formal_degree).map_or_else(MultiPoly::zero, |c| c.numerator().clone());
        let poles = d.poles.iter().filter(|p| !p.is_constant()).cloned().collect();
        PlanePolynomial { polynomial, denominator, degree_loss, formal_degree: d.formal_degree, poles }
    }

    /// The same with the two parameters exchanged.
    pub fn swapped(&self) -> Self {
        let swap = |p: &MultiPoly| p.map_variables(|i| 1 - i);
        PlanePolynomial {
            polynomial: self.polynomial.map(swap),
            denominator: swap(&self.denominator),
            degree_loss: swap(&self.degree_loss),
            formal_degree: self.formal_degree,
            poles: self.poles.iter().map(swap).collect(),
        }
    }

    /// The polynomial in `z` or `s`, denominators cleared.
    pub(crate) fn polynomial(&self) -> &Poly<MultiPoly> {
        &self.polynomial
    }

    /// The degree the polynomial is meant to have.
    pub fn formal_degree(&self) -> usize {
        self.formal_degree
    }

    /// In `z` over `Z[x, y]`, denominators cleared.
    pub(super) fn cleared(&self) -> &Poly<MultiPoly> {
        &self.polynomial
    }

    /// Where one of these vanishes the loop is not stable: the poles, the leading coefficient, and the values that are roots on the
    /// boundary at fixed places.
    pub(crate) fn certain(&self, region: Shape) -> Vec<MultiPoly> {
        let mut out = self.poles.clone();
        out.extend([self.denominator.clone(), self.polynomial.coeff(self.formal_degree)]);
        if self.formal_degree > 0 {
            let value = |z: i64| self.polynomial.eval(&MultiPoly::constant(Integer::from(z)));
            match region {
                Shape::UnitDisc => out.extend([value(1), value(-1)]),
                Shape::LeftHalfPlane => out.push(value(0)),
            }
        }
        out
    }

    /// The exact root count at a point.
    pub fn at(&self, x: &Rational, y: &Rational, region: Shape) -> AtPoint {
        let point = [x.clone(), y.clone()];
        let value = |p: &MultiPoly| p.eval(&point);
        if value(&self.denominator).is_zero() || self.poles.iter().any(|p| value(p).is_zero()) {
            return AtPoint::Undefined;
        }
        let special = UniPoly::from_rational_poly(&self.polynomial.map(value)).1;
        if special.is_zero() {
            return AtPoint::Zero;
        }
        let count = count_roots(&special, region);
        AtPoint::Defined { count, infinite: self.formal_degree - count.total() }
    }

    /// The polynomial at a point, up to a factor.
    pub(crate) fn specialised(&self, point: &[Rational; 2]) -> UniPoly {
        UniPoly::from_rational_poly(&self.polynomial.map(|p| p.eval(point))).1
    }

    /// The polynomial in `y` alone at a rational `x`; `None` when the loop is undefined for every `y`.
    pub fn at_x(&self, x: &Rational) -> Option<ParametricPolynomial> {
        let side = |p: &MultiPoly| p.substitute(X, x).0.to_univariate(Y).expect("x is set");
        let denominator = self.denominator.substitute(X, x);
        let (den, den_scale) = (side(&self.denominator), denominator.1);
        let poles: Vec<UniPoly> = self.poles.iter().map(side).collect();
        if den.is_zero() || poles.iter().any(UniPoly::is_zero) {
            return None;
        }
        // Each coefficient has its own integer denominator after the substitution.
        let coefficient = |c: &MultiPoly| {
            let (_, scale) = c.substitute(X, x);
            (side(c).scaled(&den_scale), den.scaled(&scale))
        };
        let coefficients: Vec<_> = (0..=self.formal_degree).map(|k| coefficient(&self.polynomial.coeff(k))).collect();
        Some(ParametricPolynomial::new(&coefficients, self.formal_degree, poles))
    }
}

/// The boundary curves, square-free and pairwise coprime, or `None` when the loop is stable at no
/// point because a boundary polynomial vanishes identically.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn boundary_curves(p: &PlanePolynomial, region: Shape, budget: &Budget) -> Result<Option<Vec<Curve>>, Exhausted> {
    let n = p.formal_degree;
    if p.polynomial.degree() != Some(n) {
        return Ok(None);
    }
    let mut found = Vec::new();
    if n > 0 {
        let value = |z: i64| p.polynomial.eval(&MultiPoly::constant(Integer::from(z)));
        match region {
            Shape::UnitDisc => {
                found.push((Cause::RootAtOne, value(1)));
                found.push((Cause::RootAtMinusOne, value(-1)));
            }
            Shape::LeftHalfPlane => found.push((Cause::RootAtZero, value(0))),
        }
        if found.iter().any(|(_, f)| f.is_zero()) {
            return Ok(None);
        }
        budget.step("the curve of complex pairs");
        let pair = HalfSizePair::new(&p.polynomial, n, region);
        found.push((Cause::ComplexPair, pair.critical_constraint(budget)?));
    }
    found.push((Cause::DegreeLost, p.degree_loss.clone()));
    found.push((Cause::Pole, p.denominator.clone()));
    found.extend(p.poles.iter().map(|q| (Cause::Pole, q.clone())));
    budget.step("coprime curves");
    let mut curves: Vec<Curve> = Vec::new();
    for (cause, polynomial) in found {
        if polynomial.is_zero() {
            return Ok(None);
        }
        for factor in separated(&polynomial) {
            budget.check()?;
            let mut causes = Causes::default();
            causes.insert(cause);
            insert_coprime(&mut curves, &causes, factor.square_free_part());
        }
    }
    Ok(Some(curves))
}

/// Adds curves on which something other than stability may change; they have no causes.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn add_curves(curves: &mut Vec<Curve>, further: &[MultiPoly], budget: &Budget) -> Result<(), Exhausted> {
    for factor in further.iter().flat_map(separated) {
        budget.check()?;
        insert_coprime(curves, &Causes::default(), factor.square_free_part());
    }
    Ok(())
}

/// Why a loop with a characteristic polynomial is stable at no point: the boundary polynomial that vanishes
/// identically; `None` when there is none.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn vanishing_boundary(p: &PlanePolynomial, region: Shape, budget: &Budget) -> Result<Option<Cause>, Exhausted> {
    let n = p.formal_degree;
    if p.polynomial.degree() != Some(n) || p.degree_loss.is_zero() {
        return Ok(Some(Cause::DegreeLost));
    }
    if n == 0 {
        return Ok(None);
    }
    let vanishes = |z: i64| p.polynomial.eval(&MultiPoly::constant(Integer::from(z))).is_zero();
    let real = match region {
        Shape::UnitDisc if vanishes(1) => Some(Cause::RootAtOne),
        Shape::UnitDisc if vanishes(-1) => Some(Cause::RootAtMinusOne),
        Shape::LeftHalfPlane if vanishes(0) => Some(Cause::RootAtZero),
        _ => None,
    };
    if real.is_some() {
        return Ok(real);
    }
    let critical = HalfSizePair::new(&p.polynomial, n, region).critical_constraint(budget)?;
    Ok(critical.is_zero().then_some(Cause::ComplexPair))
}

/// The factor in `x` alone, the factor in `y` alone, and what is left.
fn separated(p: &MultiPoly) -> Vec<MultiPoly> {
    let content = |p: &MultiPoly, main: usize| p.as_poly_in(main).content();
    let exact = |a: &MultiPoly, b: &MultiPoly| a.div_exact(b).expect("the content divides");
    let in_x = content(p, Y);
    let rest = exact(p, &in_x);
    let in_y = content(&rest, X);
    let rest = exact(&rest, &in_y);
    [in_x, in_y, rest].into_iter().filter(|f| !f.is_constant()).collect()
}

/// Adds a square-free polynomial to a list of coprime ones: what is shared with a member is split off and
/// carries the causes of both.
fn insert_coprime(curves: &mut Vec<Curve>, own: &Causes, polynomial: MultiPoly) {
    let mut rest = polynomial;
    let mut parts = Vec::new();
    for curve in curves.iter_mut() {
        if rest.is_constant() {
            break;
        }
        let common = curve.polynomial.gcd(&rest);
        if common.is_constant() {
            continue;
        }
        rest = rest.div_exact(&common).expect("a gcd divides");
        let left = curve.polynomial.div_exact(&common).expect("a gcd divides");
        let mut causes = curve.causes.clone();
        own.iter().for_each(|cause| causes.insert(cause));
        if left.is_constant() {
            curve.causes = causes;
        } else {
            curve.polynomial = left;
            parts.push(Curve { causes, polynomial: common });
        }
    }
    if !rest.is_constant() {
        let rest = rest.primitive_over_integers();
        parts.push(Curve { causes: own.clone(), polynomial: rest });
    }
    curves.extend(parts);
}
