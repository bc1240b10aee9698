//! The curves in the plane of two parameters at which the number of stable roots may change.

use super::ground::Ground;
use super::integers::Integers;
use super::over_symbols::OverSymbols;
use crate::{AtPoint, Cause, Causes, HalfSizePair, ParametricPolynomial, Shape, count_roots};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Enclosure, Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, UniPoly};
use jurist_algebra::symbols::{Function, Symbols};
use std::sync::Arc;

/// The numbers of the two parameters as variables of a [`MultiPoly`].
pub const X: usize = 0;
/// See [`X`].
pub const Y: usize = 1;

/// A boundary curve: a square-free polynomial in both parameters, and what may happen on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What happens on the curve; for `complex pair` parts of it may be mirror pairs off the boundary.
    pub causes: Causes,
    /// The polynomial, primitive over the integers and coprime to those of the other curves. Symbol `i` of a loop with transcendental
    /// constants is variable `i + 2`.
    pub polynomial: MultiPoly,
}

/// A characteristic polynomial with two parameters, ready to be decomposed.
#[derive(Clone, Debug)]
pub struct PlanePolynomial {
    /// In `z` over `Z[x, y]`, or over that with symbols, denominators cleared.
    polynomial: Poly<MultiPoly>,
    denominator: MultiPoly,
    degree_loss: MultiPoly,
    formal_degree: usize,
    poles: Vec<MultiPoly>,
    /// What the coefficients are.
    ground: Arc<dyn Ground>,
}

impl PlanePolynomial {
    /// From a characteristic polynomial in which the variables 0 and 1 are kept.
    pub fn new(d: &CharacteristicPolynomial) -> Self {
        PlanePolynomial::over(d, Arc::new(Integers))
    }

    /// From a characteristic polynomial in which the variables 0 and 1 are kept and symbol `i` is variable `i + 2`.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::matrix::CharacteristicPolynomial;
    /// use jurist_algebra::poly::RationalFunction;
    /// use jurist_algebra::symbols::{Definition, Symbols};
    /// use jurist_stability::plane::{PlanePolynomial, stability_map};
    /// use jurist_stability::{Range, Shape};
    /// use std::sync::Arc;
    /// // z^2 + a z + b + X with X = exp(-1): the triangle of stable z^2 + a z + c, moved down
    /// let mut symbols = Symbols::new();
    /// symbols.insert("X1", Definition::exponential(-1));
    /// let [a, b, x] = [0, 1, 2].map(RationalFunction::variable);
    /// let d = CharacteristicPolynomial {
    ///     variables: vec!["a".into(), "b".into(), "X1".into()],
    ///     coefficients: vec![&b + &x, a, RationalFunction::one()],
    ///     formal_degree: 2,
    ///     poles: Vec::new(),
    ///     monic: true,
    /// };
    /// let p = PlanePolynomial::over_symbols(&d, &Arc::new(symbols));
    /// let plane = [Range::all(), Range::all()];
    /// let map = stability_map(&p, &plane, Shape::UnitDisc, &Budget::unlimited()).unwrap();
    /// let end = |end: &Option<jurist_algebra::real::Real>| end.as_ref().unwrap().decimal(6);
    /// assert_eq!((end(&map.regions[0].y.lower), end(&map.regions[0].y.upper)), ("-1.36788".into(), "0.632121".into()));
    /// ```
    ///
    /// Cost: `O(n)` least common multiples.
    pub fn over_symbols(d: &CharacteristicPolynomial, symbols: &Arc<Symbols>) -> Self {
        PlanePolynomial::over(d, Arc::new(OverSymbols::new(symbols)))
    }

    fn over(d: &CharacteristicPolynomial, ground: Arc<dyn Ground>) -> Self {
        let (polynomial, denominator) = d.cleared();
        let degree_loss = d.coefficients.get(d.formal_degree).map_or_else(MultiPoly::zero, |c| c.numerator().clone());
        let poles = d.poles.iter().filter(|p| !p.is_constant()).cloned().collect();
        PlanePolynomial { polynomial, denominator, degree_loss, formal_degree: d.formal_degree, poles, ground }
    }

    /// What the coefficients are.
    pub(super) fn ground(&self) -> &Arc<dyn Ground> {
        &self.ground
    }

    /// The loop is undefined at the zeros of these, the common denominator first.
    pub(super) fn all_poles(&self) -> impl Iterator<Item = &MultiPoly> {
        std::iter::once(&self.denominator).chain(&self.poles)
    }

    /// The numerator of the leading coefficient.
    pub(super) fn degree_loss(&self) -> &MultiPoly {
        &self.degree_loss
    }

    /// All values on a box of a polynomial whose variables are numbered as those of this one.
    pub fn enclose(&self, f: &MultiPoly, x: &Enclosure, y: &Enclosure, bits: u64) -> Enclosure {
        self.ground.enclose(f, x, y, bits)
    }

    /// The same with the two parameters exchanged.
    pub fn swapped(&self) -> Self {
        PlanePolynomial {
            polynomial: self.polynomial.map(exchanged),
            denominator: exchanged(&self.denominator),
            degree_loss: exchanged(&self.degree_loss),
            formal_degree: self.formal_degree,
            poles: self.poles.iter().map(exchanged).collect(),
            ground: Arc::clone(&self.ground),
        }
    }

    /// The polynomial in `z` or `s`, denominators cleared.
    pub fn polynomial(&self) -> &Poly<MultiPoly> {
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
    pub fn certain(&self, region: Shape) -> Vec<MultiPoly> {
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

    /// A bound of the number of terms of the curve of complex pairs, from the degrees of what it is made of.
    ///
    /// Cost: that of the half-size pair.
    pub fn size(&self, region: Shape) -> u64 {
        if self.formal_degree < 2 {
            return 1;
        }
        let pair = HalfSizePair::new(&self.polynomial, self.formal_degree, region);
        let all = |p: &Poly<MultiPoly>, degree: usize| (0..=degree).map(|k| p.coeff(k)).collect();
        Function::resultant(all(&pair.a, pair.degree_a), all(&pair.b, pair.degree_b)).expanded_size()
    }

    /// The exact root count at a point of a loop without symbols.
    ///
    /// # Panics
    /// When there are symbols: their loops are asked by [`SymbolicPolynomial::at`](crate::SymbolicPolynomial::at).
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
        for (_, f) in &found {
            if p.ground.vanishes(f, budget)? {
                return Ok(None);
            }
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
        if p.ground.vanishes(&polynomial, budget)? {
            return Ok(None);
        }
        let factors = p.ground.separated(&polynomial, budget)?;
        budget.enter(|| {
            for factor in factors {
                insert_coprime(&mut curves, &cause.into(), factor.square_free_part());
            }
        })?;
        budget.check()?;
    }
    Ok(Some(curves))
}

/// Adds curves on which something other than stability may change; they have no causes.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub(super) fn add_curves(
    curves: &mut Vec<Curve>,
    further: &[MultiPoly],
    ground: &dyn Ground,
    budget: &Budget,
) -> Result<(), Exhausted> {
    for polynomial in further {
        for factor in ground.separated(polynomial, budget)? {
            budget.check()?;
            insert_coprime(curves, &Causes::default(), factor.square_free_part());
        }
    }
    Ok(())
}

/// Square-free polynomials in two variables without common factors, whose zeros together are those of the given ones.
///
/// Cost: a greatest common divisor for each pair.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn coprime_polynomials(all: &[MultiPoly], budget: &Budget) -> Result<Vec<MultiPoly>, Exhausted> {
    let mut curves = Vec::new();
    add_curves(&mut curves, all, &Integers, budget)?;
    Ok(curves.into_iter().map(|curve| curve.polynomial).collect())
}

/// Why a loop with a characteristic polynomial is stable at no point: the boundary polynomial that vanishes
/// identically; `None` when there is none.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn vanishing_boundary(p: &PlanePolynomial, region: Shape, budget: &Budget) -> Result<Option<Cause>, Exhausted> {
    let n = p.formal_degree;
    if p.polynomial.degree() != Some(n) || p.ground.vanishes(&p.degree_loss, budget)? {
        return Ok(Some(Cause::DegreeLost));
    }
    if n == 0 {
        return Ok(None);
    }
    let real: &[(i64, Cause)] = match region {
        Shape::UnitDisc => &[(1, Cause::RootAtOne), (-1, Cause::RootAtMinusOne)],
        Shape::LeftHalfPlane => &[(0, Cause::RootAtZero)],
    };
    for (z, cause) in real {
        let value = p.polynomial.eval(&MultiPoly::constant(Integer::from(*z)));
        if p.ground.vanishes(&value, budget)? {
            return Ok(Some(*cause));
        }
    }
    let critical = HalfSizePair::new(&p.polynomial, n, region).critical_constraint(budget)?;
    Ok(p.ground.vanishes(&critical, budget)?.then_some(Cause::ComplexPair))
}

/// The parameters exchanged; symbols stay.
pub(super) fn exchanged(p: &MultiPoly) -> MultiPoly {
    p.map_variables(|i| [Y, X].get(i).copied().unwrap_or(i))
}

/// Whether no parameter occurs.
pub(super) fn is_number(p: &MultiPoly) -> bool {
    p.degree_in(X) == 0 && p.degree_in(Y) == 0
}

/// Without a factor in which no parameter occurs: of a polynomial that does not vanish it does not either.
pub(super) fn without_number(p: &MultiPoly) -> MultiPoly {
    if p.variables().iter().all(|&i| i <= Y) {
        return p.clone();
    }
    let in_x = p.as_poly_in(X);
    let parts = in_x.coeffs().iter().flat_map(|c| c.as_poly_in(Y).into_coeffs());
    let mut content = MultiPoly::zero();
    for part in parts {
        content = content.gcd(&part);
        if content.is_constant() {
            return p.primitive_over_integers();
        }
    }
    p.div_exact(&content).expect("the content divides").primitive_over_integers()
}

/// Adds a square-free polynomial to a list of coprime ones: what is shared with a member is split off and
/// carries the causes of both.
fn insert_coprime(curves: &mut Vec<Curve>, own: &Causes, polynomial: MultiPoly) {
    let mut rest = polynomial;
    let mut parts = Vec::new();
    for curve in curves.iter_mut() {
        if is_number(&rest) {
            break;
        }
        let common = curve.polynomial.gcd(&rest);
        if is_number(&common) {
            continue;
        }
        rest = rest.div_exact(&common).expect("a gcd divides");
        let left = curve.polynomial.div_exact(&common).expect("a gcd divides");
        let mut causes = curve.causes.clone();
        own.iter().for_each(|cause| causes.insert(cause));
        if is_number(&left) {
            curve.causes = causes;
        } else {
            curve.polynomial = left;
            parts.push(Curve { causes, polynomial: common });
        }
    }
    if !is_number(&rest) {
        let rest = rest.primitive_over_integers();
        parts.push(Curve { causes: own.clone(), polynomial: rest });
    }
    curves.extend(parts);
}
