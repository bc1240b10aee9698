//! What the coefficients of an open loop are: integers, or polynomials in the constants of a plant behind a hold.

use super::combined::{Combination, Combined};
use super::enclosed::enclosed;
use super::{Frequencies, Place, Value};
use crate::answer::stable_factors;
use crate::coverage::refusals::BESIDE_DEAD_TIME;
use crate::error::Error;
use crate::model;
use crate::precisions::SIGN_AT_NUMBER;
use crate::problem::symbols_without;
use crate::stability::dead_time::{ConstantParts, FamilyLoop, GainLoop, Line, family_cells, gain_cells};
use crate::stability::{
    AtPoint, ParametricPolynomial, Range, Shape, StableSet, SymbolicPolynomial, is_stable, stable_set,
    symbolic_stable_set, zeros_in,
};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Enclosure, Integer, Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use jurist_algebra::real::Real;
use jurist_algebra::symbols::{Definition, MovingSymbols, SymbolicPoly, Symbols};
use std::fmt;
use std::sync::Arc;

/// Numbers with an order, and the polynomials over them in the variable of the frequency.
pub(crate) trait Ground: Clone + fmt::Debug + Send + Sync {
    /// A number.
    type Number: Domain;

    /// The distinct zeros in an open range, ascending; none of a polynomial that vanishes everywhere.
    fn zeros(&self, p: &Poly<Self::Number>, range: &Range, budget: &Budget) -> Result<Vec<Real>, Exhausted>;

    /// The zeros of the derivative of `a/b` in an open range, ascending, without an expansion of the products in it; `None` where they are to be expanded.
    fn extremes(
        &self,
        _quotient: [&Poly<Self::Number>; 2],
        _range: &Range,
        _budget: &Budget,
    ) -> Result<Option<Vec<Real>>, Exhausted> {
        Ok(None)
    }

    /// The sign of a number.
    fn sign(&self, c: &Self::Number, budget: &Budget) -> Result<Sign, Exhausted>;

    /// The sign of a polynomial at a real number.
    fn sign_at(&self, p: &Poly<Self::Number>, x: &Real, budget: &Budget) -> Result<Sign, Exhausted>;

    /// The quotient of two numbers of which the second is not zero.
    fn quotient(&self, a: &Self::Number, b: &Self::Number, budget: &Budget) -> Result<Value, Exhausted>;

    /// The quotient of two polynomials at a number that is not rational; neither is zero there.
    fn quotient_at(&self, a: &Poly<Self::Number>, b: &Poly<Self::Number>, x: &Real) -> Value;

    /// The values of a polynomial at rational numbers, with some bits; its coefficients are enclosed once.
    fn values(&self, p: &Poly<Self::Number>, bits: u64) -> impl Fn(&Rational) -> Enclosure;

    /// Whether all roots are inside of the boundary.
    fn is_stable(&self, p: &Poly<Self::Number>, shape: Shape, budget: &Budget) -> Result<bool, Exhausted>;

    /// The factors `k` for which the sum of these polynomials times powers of `k`, from the zeroth up, is stable; where one of `poles`, in `k`, is zero,
    /// the loop is undefined.
    fn stable_factors(
        &self,
        powers: &[Poly<Self::Number>],
        poles: &[Poly<Self::Number>],
        shape: Shape,
        budget: &Budget,
    ) -> Result<StableSet, Exhausted>;

    /// The factors `k` for which `D0 + k N exp(-tau s)` is stable.
    fn stable_factors_with_delay(
        &self,
        parts: [&Poly<Self::Number>; 2],
        tau: &Rational,
        budget: &Budget,
    ) -> Result<StableSet, Error>;

    /// The loop of the factor `k`: the sum of these polynomials times powers of `k exp(-tau s)`, from the zeroth up.
    fn family_of_factors(&self, powers: &[Poly<Self::Number>], tau: &Rational) -> FamilyLoop;

    /// A number as a polynomial in symbols, whose variables come after so many others.
    fn in_symbols(&self, c: &Self::Number, before: usize) -> MultiPoly;

    /// The symbols, whose variables come after so many others.
    fn symbols_after(&self, before: usize) -> Vec<(String, Definition)>;

    /// A polynomial as one in variable 0 and the symbols, whose variables come after so many.
    fn in_variable(&self, p: &Poly<Self::Number>, before: usize) -> MultiPoly {
        let coefficients = p.coeffs().iter().map(|c| self.in_symbols(c, before)).collect();
        MultiPoly::from_poly_in(&Poly::new(coefficients), 0)
    }

    /// A polynomial in the factor, which is variable 0; variables of symbols follow.
    fn in_factor(&self, p: &Poly<Self::Number>) -> RationalFunction {
        self.in_variable(p, 1).into()
    }

    /// The symbols beside the factor.
    fn beside_factor(&self) -> MovingSymbols {
        MovingSymbols::new(self.symbols_after(1))
    }

    /// The value of a quotient of polynomials without a common factor at a frequency; `None` where it is infinite.
    fn value(
        &self,
        a: &Poly<Self::Number>,
        b: &Poly<Self::Number>,
        place: &Place,
        frequencies: Frequencies,
        budget: &Budget,
    ) -> Result<Option<Value>, Exhausted> {
        let (above, below) = match place {
            Place::Inside(x) => match x.exact() {
                Some(x) => {
                    let degree = a.coeffs().len().max(b.coeffs().len());
                    (at_rational(a, &x, degree), at_rational(b, &x, degree))
                }
                None => {
                    if self.sign_at(b, x, budget)?.is_eq() {
                        return Ok(None);
                    }
                    if self.sign_at(a, x, budget)?.is_eq() {
                        return Ok(Some(Value::from(Rational::ZERO)));
                    }
                    return Ok(Some(self.quotient_at(a, b, x)));
                }
            },
            end => at_end(a, b, end, frequencies),
        };
        if self.sign(&below, budget)?.is_eq() {
            return Ok(None);
        }
        if self.sign(&above, budget)?.is_eq() {
            return Ok(Some(Value::from(Rational::ZERO)));
        }
        self.quotient(&above, &below, budget).map(Some)
    }
}

/// Two polynomials at an end of the range of frequencies, multiplied by the same positive number.
pub(crate) fn at_end<R: Domain>(a: &Poly<R>, b: &Poly<R>, end: &Place, frequencies: Frequencies) -> (R, R) {
    let x = match (end, frequencies) {
        (Place::Lowest, Frequencies::Positive(Shape::UnitDisc)) => 2,
        (Place::Highest, Frequencies::Positive(Shape::UnitDisc)) => -2,
        (Place::Highest, _) => {
            let degree = a.coeffs().len().max(b.coeffs().len()).saturating_sub(1);
            return (a.coeff(degree), b.coeff(degree));
        }
        _ => 0,
    };
    let x = R::from_integer(&Integer::from(x));
    (a.eval(&x), b.eval(&x))
}

/// The value at `x = p/q` times `q^degree`.
fn at_rational<R: Domain>(p: &Poly<R>, x: &Rational, degree: usize) -> R {
    let (up, down) = (x.numerator(), x.denominator());
    let term = |(i, c): (usize, &R)| c.times(&R::from_integer(&(up.pow(i as u64) * down.pow((degree - i) as u64))));
    p.coeffs().iter().enumerate().map(term).fold(R::zero(), |sum, t| sum.plus(&t))
}

/// The greatest degree of polynomials.
fn degree_of<R: Domain>(powers: &[Poly<R>]) -> usize {
    powers.iter().map(|p| p.coeffs().len()).max().unwrap_or(0).saturating_sub(1)
}

/// A coefficient of the sum of polynomials times powers of the factor, as a polynomial in the factor.
fn coefficient_in_factor<R: Domain>(powers: &[Poly<R>], i: usize) -> Poly<R> {
    Poly::new(powers.iter().map(|p| p.coeff(i)).collect())
}

/// The integers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Integers;

impl Ground for Integers {
    type Number = Integer;

    fn zeros(&self, p: &UniPoly, range: &Range, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        Ok(zeros_in(p, range, budget)?.into_iter().map(Real::from).collect())
    }

    fn sign(&self, c: &Integer, _: &Budget) -> Result<Sign, Exhausted> {
        Ok(c.sign())
    }

    fn sign_at(&self, p: &UniPoly, x: &Real, budget: &Budget) -> Result<Sign, Exhausted> {
        let x = x.algebraic().expect("zeros of polynomials with integer coefficients are algebraic");
        budget.enter(|| x.sign_of(p))
    }

    fn quotient(&self, a: &Integer, b: &Integer, _: &Budget) -> Result<Value, Exhausted> {
        Ok(Value::from(Rational::new(a.clone(), b.clone())))
    }

    fn quotient_at(&self, a: &UniPoly, b: &UniPoly, x: &Real) -> Value {
        Value::quotient(a, b, x.algebraic().expect("zeros of polynomials with integer coefficients are algebraic"))
    }

    fn values(&self, p: &UniPoly, _: u64) -> impl Fn(&Rational) -> Enclosure {
        |x| Enclosure::from_rational(p.eval_rational(x))
    }

    fn is_stable(&self, p: &UniPoly, shape: Shape, budget: &Budget) -> Result<bool, Exhausted> {
        budget.enter(|| is_stable(p, shape))
    }

    fn stable_factors(
        &self,
        powers: &[UniPoly],
        poles: &[UniPoly],
        shape: Shape,
        budget: &Budget,
    ) -> Result<StableSet, Exhausted> {
        let degree = degree_of(powers);
        let coefficient = |i| (coefficient_in_factor(powers, i), UniPoly::one());
        let coefficients: Vec<_> = (0..=degree).map(coefficient).collect();
        let p = ParametricPolynomial::new(&coefficients, degree, poles.to_vec());
        stable_set(&p, &Range::all(), shape, budget)
    }

    fn stable_factors_with_delay(
        &self,
        [d, n]: [&UniPoly; 2],
        tau: &Rational,
        budget: &Budget,
    ) -> Result<StableSet, Error> {
        let zero = UniPoly::zero();
        let gain = GainLoop::new(vec![d.clone(), zero.clone()], vec![zero, n.clone()], tau.clone());
        stable_factors(gain_cells(&gain, &Range::all(), budget), &gain.family(), budget)
    }

    fn family_of_factors(&self, powers: &[UniPoly], tau: &Rational) -> FamilyLoop {
        let part =
            |(i, p): (usize, &UniPoly)| p.coeffs().iter().map(|c| UniPoly::monomial(c.clone(), i)).collect::<Vec<_>>();
        let parts = powers.iter().enumerate().map(part).collect();
        FamilyLoop::new(parts, Line::constant(tau.clone()), Line::constant(Rational::ZERO))
    }

    fn in_symbols(&self, c: &Integer, _: usize) -> MultiPoly {
        MultiPoly::constant(c.clone())
    }

    fn symbols_after(&self, _: usize) -> Vec<(String, Definition)> {
        Vec::new()
    }
}

/// Polynomials in symbols; symbol `i` is variable `i`.
#[derive(Clone, Debug)]
pub(crate) struct Constants(pub Arc<Symbols>);

impl Constants {
    /// The symbols of a loop without a free name; no polynomial is in those that stand for dead times.
    ///
    /// # Errors
    /// `E-dead-time` where another one is not a constant.
    pub fn beside_delays(symbols: &model::Symbols) -> Result<Constants, Error> {
        let delays: Vec<usize> = symbols.delays().iter().map(|(variable, _)| *variable).collect();
        let table = symbols_without(symbols, &delays).ok_or_else(|| BESIDE_DEAD_TIME.diagnostic(&[]))?;
        Ok(Constants(Arc::new(table)))
    }

    /// The value at a ball.
    fn at_ball(&self, p: &Poly<MultiPoly>, x: &Ball) -> Ball {
        let coefficients: Vec<Ball> = p.coeffs().iter().map(|c| self.0.enclose(c, x.bits())).collect();
        horner(&coefficients, x)
    }

    pub(super) fn at_real(&self, p: &Poly<MultiPoly>, x: &Real, bits: u64) -> Ball {
        let (lo, hi) = x.refined(&Rational::dyadic(&Integer::ONE, bits)).enclosure();
        self.at_ball(p, &Ball::between(&lo, &hi, bits))
    }

    /// The polynomial with the unknown as variable 0.
    pub(super) fn over_unknown(p: &Poly<MultiPoly>) -> MultiPoly {
        let shifted = p.coeffs().iter().map(|c| c.map_variables(|i| i + 1)).collect();
        MultiPoly::from_poly_in(&Poly::new(shifted), 0)
    }

    /// The polynomial of a loop in the factor (variable 0), or in nothing.
    fn symbolic(&self, coefficients: Vec<MultiPoly>, free: usize, poles: Vec<MultiPoly>) -> SymbolicPolynomial {
        let factor = (free == 1).then(|| "factor".to_owned());
        let d = CharacteristicPolynomial {
            variables: factor.into_iter().chain(self.0.names()).collect(),
            formal_degree: coefficients.len() - 1,
            coefficients: coefficients.into_iter().map(RationalFunction::from).collect(),
            poles,
            monic: false,
        };
        SymbolicPolynomial::new(&d, free, &self.0)
    }
}

/// The value of the polynomial with these coefficients, from the constant term up.
fn horner(coefficients: &[Ball], x: &Ball) -> Ball {
    coefficients.iter().rev().fold(Ball::zero(x.bits()), |sum, c| sum.mul(x).add(c))
}

impl Ground for Constants {
    type Number = MultiPoly;

    fn zeros(&self, p: &Poly<MultiPoly>, range: &Range, budget: &Budget) -> Result<Vec<Real>, Exhausted> {
        match SymbolicPoly::new(&Constants::over_unknown(p), &self.0, budget)? {
            Some(p) => p.real_roots_in(range.lower.as_ref(), range.upper.as_ref(), budget),
            None => Ok(Vec::new()),
        }
    }

    /// Where coefficients are known by enclosures alone no identity is lost.
    fn extremes(
        &self,
        [a, b]: [&Poly<MultiPoly>; 2],
        range: &Range,
        budget: &Budget,
    ) -> Result<Option<Vec<Real>>, Exhausted> {
        if !self.0.has_enclosed_numbers() || range.lower.is_none() || range.upper.is_none() || a.is_zero() {
            return Ok(None);
        }
        let slope = Combined::new(self, &[a, b], Combination::Slope);
        slope.map(|slope| slope.zeros(range, budget)).transpose()
    }

    fn sign(&self, c: &MultiPoly, budget: &Budget) -> Result<Sign, Exhausted> {
        self.0.sign(c, budget)
    }

    /// Read off enclosures. What is zero at a number by a common factor is to be divided out before.
    fn sign_at(&self, p: &Poly<MultiPoly>, x: &Real, budget: &Budget) -> Result<Sign, Exhausted> {
        if p.is_zero() {
            return Ok(Sign::Equal);
        }
        if let Some(x) = x.exact() {
            return self.sign(&at_rational(p, &x, p.coeffs().len()), budget);
        }
        SIGN_AT_NUMBER.decide("the open loop at a frequency", |bits| {
            budget.check()?;
            Ok(budget.enter(|| self.at_real(p, x, bits))?.sign())
        })
    }

    fn quotient(&self, a: &MultiPoly, b: &MultiPoly, budget: &Budget) -> Result<Value, Exhausted> {
        // The root of b y - a, so that a rational number is seen.
        let line = Poly::new(vec![a.negated(), b.clone()]);
        let line =
            SymbolicPoly::new(&Constants::over_unknown(&line), &self.0, budget)?.expect("the divisor is not zero");
        let root = line.real_roots_in(None, None, budget)?.pop().expect("a line has a root");
        Ok(Value::Number(root))
    }

    fn quotient_at(&self, a: &Poly<MultiPoly>, b: &Poly<MultiPoly>, x: &Real) -> Value {
        let (a, b, x, over) = (a.clone(), b.clone(), x.clone(), self.clone());
        Value::Number(enclosed("quotient at a frequency", move |bits| {
            Some(over.at_real(&a, &x, bits).div(&over.at_real(&b, &x, bits))?.to_enclosure())
        }))
    }

    fn values(&self, p: &Poly<MultiPoly>, bits: u64) -> impl Fn(&Rational) -> Enclosure {
        let coefficients: Vec<Ball> = p.coeffs().iter().map(|c| self.0.enclose(c, bits)).collect();
        move |x| horner(&coefficients, &Ball::from_rational(x, bits)).to_enclosure()
    }

    fn is_stable(&self, p: &Poly<MultiPoly>, shape: Shape, budget: &Budget) -> Result<bool, Exhausted> {
        if p.is_zero() {
            return Ok(false);
        }
        let degree = p.coeffs().len() - 1;
        let found = self.symbolic(p.coeffs().to_vec(), 0, Vec::new()).at(&Rational::ZERO, shape, budget)?;
        Ok(matches!(found, AtPoint::Defined { count, infinite: 0 } if count.inside == degree))
    }

    fn stable_factors(
        &self,
        powers: &[Poly<MultiPoly>],
        poles: &[Poly<MultiPoly>],
        shape: Shape,
        budget: &Budget,
    ) -> Result<StableSet, Exhausted> {
        let degree = degree_of(powers);
        let coefficient = |i| Constants::over_unknown(&coefficient_in_factor(powers, i));
        let poles = poles.iter().map(Constants::over_unknown).collect();
        let p = self.symbolic((0..=degree).map(coefficient).collect(), 1, poles);
        symbolic_stable_set(&p, &Range::all(), shape, budget)
    }

    fn stable_factors_with_delay(
        &self,
        [d, n]: [&Poly<MultiPoly>; 2],
        tau: &Rational,
        budget: &Budget,
    ) -> Result<StableSet, Error> {
        let family = self.family_of_factors(&[d.clone(), n.clone()], tau);
        stable_factors(family_cells(&family, &Range::all(), budget), &family, budget)
    }

    fn family_of_factors(&self, powers: &[Poly<MultiPoly>], tau: &Rational) -> FamilyLoop {
        let part = |(i, p): (usize, &Poly<MultiPoly>)| -> Vec<MultiPoly> {
            let factor = MultiPoly::variable(0).power(i as u64);
            p.coeffs().iter().map(|c| self.in_symbols(c, 1).times(&factor)).collect()
        };
        let parts = ConstantParts::new(powers.iter().enumerate().map(part).collect(), Symbols::clone(&self.0));
        FamilyLoop::enclosed(parts, Line::constant(tau.clone()), Line::constant(Rational::ZERO))
    }

    fn in_symbols(&self, c: &MultiPoly, before: usize) -> MultiPoly {
        c.map_variables(|i| i + before)
    }

    fn symbols_after(&self, before: usize) -> Vec<(String, Definition)> {
        let place = |f: &RationalFunction| f.map_variables(|i| i + before);
        let definition = |i: usize| self.0.definition(i).try_map(place).expect("variables are only renamed");
        self.0.names().into_iter().zip((0..self.0.len()).map(definition)).collect()
    }
}
