//! Loops whose characteristic polynomial has transcendental constants, such as those of a plant behind a hold.
//!
//! The constants are variables of the coefficients ([`Symbols`]). Everything that is decided by signs of rational numbers in
//! a loop without them is decided by signs of polynomials in symbols: the boundary polynomials are the same, and so is the
//! half-size pair.

mod basis;
mod boundary_zeros;
mod brackets;
mod conditions;
mod count;
mod deflated;
mod factors;
mod hermitian;
mod interpolation;
mod jury;
mod minors;
mod moving;
mod outward;
mod pair;
mod plane;
mod regions;
mod resultant;
mod rounded;
mod rows;
mod set;
mod statements;

pub use basis::zeros_of_all;
pub use boundary_zeros::{told_apart, zeros_of_functions};
pub use conditions::{RealIntervals, SymbolicCondition, SymbolicTest};
pub use count::{EnclosedLoop, certain_count, open_equation};
pub use deflated::zeros_of_resultant;
pub use jury::{Comparison, EnclosedCondition, EnclosedRow, EnclosedTable};
pub use plane::SymbolicPlane;
pub use rounded::Rounding;
pub use rows::SymbolicRow;
pub use set::stable_set_of_parts;
pub use set::symbolic_stable_set;

use super::{AtPoint, Cause, HalfSizePair, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};
use jurist_algebra::symbols::{Function, MovingSymbols, Symbols, common_scale, resultants_seem_simple_in};
use std::sync::Arc;

/// A characteristic polynomial in one parameter, or none, whose coefficients contain symbols.
///
/// In its polynomials the parameter is variable 0 and symbol `i` is variable `i + 1`, also where there is no parameter.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::matrix::CharacteristicPolynomial;
/// use jurist_algebra::poly::RationalFunction;
/// use jurist_algebra::symbols::{Definition, Symbols};
/// use jurist_stability::{Range, Shape, SymbolicPolynomial, symbolic_stable_set};
/// use std::sync::Arc;
/// // z - X + K with X = exp(-1): a pole at s = -1 behind a hold of one second
/// let mut symbols = Symbols::new();
/// symbols.insert("X1", Definition::exponential(-1));
/// let (k, x) = (RationalFunction::variable(0), RationalFunction::variable(1));
/// let d = CharacteristicPolynomial {
///     variables: vec!["K".into(), "X1".into()],
///     coefficients: vec![&k - &x, RationalFunction::one()],
///     formal_degree: 1,
///     poles: Vec::new(),
///     monic: true,
/// };
/// let p = SymbolicPolynomial::new(&d, 1, &Arc::new(symbols));
/// let set = symbolic_stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
/// let interval = &set.intervals()[0];
/// let end = |end: &Option<jurist_stability::End>| end.as_ref().unwrap().value.decimal(6);
/// assert_eq!((end(&interval.lower), end(&interval.upper)), ("-0.632121".into(), "1.36788".into()));
/// ```
#[derive(Clone, Debug)]
pub struct SymbolicPolynomial {
    symbols: Table,
    polynomial: Poly<MultiPoly>,
    degree_loss: MultiPoly,
    formal_degree: usize,
    /// The common denominator first.
    poles: Vec<MultiPoly>,
    /// A usual value of the parameter.
    usual: Rational,
    /// The loop is unstable where the parameter is beyond this number or its negative.
    unstable_beyond: Option<Rational>,
    /// Roots come to the boundary, and the loop ceases to be defined, in these closed parts alone.
    open_parts: Option<Arc<[(Rational, Rational)]>>,
}

/// What the symbols stand for.
#[derive(Clone, Debug)]
enum Table {
    /// Numbers.
    Fixed(Arc<Symbols>),
    /// Functions of the parameter.
    Moving(Arc<MovingSymbols>),
}

impl SymbolicPolynomial {
    /// From a characteristic polynomial whose first `free` (0 or 1) variables are parameters and whose others are symbols.
    ///
    /// Cost: `O(n)` least common multiples.
    ///
    /// # Panics
    /// When more than one variable is free.
    pub fn new(d: &CharacteristicPolynomial, free: usize, symbols: &Arc<Symbols>) -> Self {
        SymbolicPolynomial::over(d, free, Table::Fixed(Arc::clone(symbols)))
    }

    /// The same where symbols depend on the parameter.
    ///
    /// Cost: `O(n)` least common multiples.
    pub fn with_moving(d: &CharacteristicPolynomial, symbols: &Arc<MovingSymbols>) -> Self {
        SymbolicPolynomial::over(d, 1, Table::Moving(Arc::clone(symbols)))
    }

    fn over(d: &CharacteristicPolynomial, free: usize, symbols: Table) -> Self {
        assert!(free <= 1, "one parameter is free");
        let place = |p: &MultiPoly| p.map_variables(|i| i + 1 - free);
        let (polynomial, denominator) = d.cleared();
        let loss = d.coefficients.get(d.formal_degree).map_or_else(MultiPoly::zero, |c| place(c.numerator()));
        let poles = std::iter::once(place(&denominator)).chain(d.poles.iter().map(place)).collect();
        SymbolicPolynomial {
            symbols,
            polynomial: Poly::new(polynomial.coeffs().iter().map(place).collect()),
            degree_loss: loss,
            formal_degree: d.formal_degree,
            poles,
            usual: Rational::ONE,
            unstable_beyond: None,
            open_parts: None,
        }
    }

    /// From a polynomial without denominators whose coefficients are numbered as in this type, what the leading coefficient vanishes
    /// with, and the polynomials at whose zeros the loop is undefined.
    pub fn from_parts(
        symbols: &Arc<Symbols>,
        polynomial: Poly<MultiPoly>,
        degree_loss: MultiPoly,
        formal_degree: usize,
        poles: Vec<MultiPoly>,
    ) -> Self {
        let symbols = Table::Fixed(Arc::clone(symbols));
        let (usual, unstable_beyond, open_parts) = (Rational::ONE, None, None);
        SymbolicPolynomial {
            symbols,
            polynomial,
            degree_loss,
            formal_degree,
            poles,
            usual,
            unstable_beyond,
            open_parts,
        }
    }

    /// With a number beyond which, and beyond whose negative, the loop is known to be unstable: zeros are looked for between the two. Then the
    /// coefficients of the highest powers of the parameter may be zero without a reason that shows.
    #[must_use]
    pub fn unstable_beyond(self, number: Rational) -> Self {
        SymbolicPolynomial { unstable_beyond: Some(number), ..self }
    }

    /// With the closed parts of a bounded range in which alone roots come to the boundary, ascending and apart, where symbols depend on the parameter:
    /// the stable set in that range is asked for.
    #[must_use]
    pub fn with_open_parts(self, parts: Vec<(Rational, Rational)>) -> Self {
        SymbolicPolynomial { open_parts: Some(parts.into()), ..self }
    }

    /// With a usual value of the parameter: where nothing else bounds it, it is looked at up to a multiple of that.
    #[must_use]
    pub fn with_usual_value(mut self, usual: Rational) -> Self {
        self.usual = usual;
        self
    }

    /// A number beyond which, and beyond whose negative, the loop is unstable, where one is known.
    pub fn known_unstable_beyond(&self) -> Option<&Rational> {
        self.unstable_beyond.as_ref()
    }

    /// A usual value of the parameter.
    pub fn usual(&self) -> &Rational {
        &self.usual
    }

    /// The polynomial without denominators.
    pub fn polynomial(&self) -> &Poly<MultiPoly> {
        &self.polynomial
    }

    /// The degree the polynomial is meant to have.
    pub fn formal_degree(&self) -> usize {
        self.formal_degree
    }

    /// The loop is undefined at the zeros of these.
    pub fn poles(&self) -> &[MultiPoly] {
        &self.poles
    }

    /// What the symbols stand for, unless they depend on the parameter.
    pub fn fixed_symbols(&self) -> Option<&Arc<Symbols>> {
        match &self.symbols {
            Table::Fixed(symbols) => Some(symbols),
            Table::Moving(_) => None,
        }
    }

    /// The half-size pair.
    fn pair(&self, region: Shape) -> HalfSizePair<MultiPoly> {
        HalfSizePair::new(&self.polynomial, self.formal_degree, region)
    }

    /// What the symbols stand for at a value of the parameter; `None` where one has no value.
    fn symbols_at(&self, value: &Rational) -> Option<Arc<Symbols>> {
        match &self.symbols {
            Table::Fixed(symbols) => Some(Arc::clone(symbols)),
            Table::Moving(symbols) => symbols.at(value).map(Arc::new),
        }
    }

    /// The exact root count at a value of the parameter.
    ///
    /// Cost: enclosures of the coefficients with more and more bits until the boundary is left aside for certain, and
    /// a root count of integers; signs of constants where it is not.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where the sign of a constant is not found.
    pub fn at(&self, value: &Rational, region: Shape, budget: &Budget) -> Result<AtPoint, Exhausted> {
        let Some(symbols) = self.symbols_at(value) else { return Ok(AtPoint::Undefined) };
        let number = |p: &MultiPoly| p.substitute(0, value).0.map_variables(|i| i.saturating_sub(1));
        for pole in &self.poles {
            if count::is_zero(&number(pole), "what the loop divides by", &symbols, budget)? {
                return Ok(AtPoint::Undefined);
            }
        }
        let coefficients = budget.enter(|| common_scale(self.polynomial.coeffs(), value))?;
        count::at_point(coefficients, self.formal_degree, &symbols, region, budget)
    }

    /// Whether an odd number of real roots lies beyond the point where the real axis leaves the region to the right, at a value
    /// of the parameter where the loop is defined: the signs there and beyond all roots tell.
    ///
    /// Cost: the signs of two numbers.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out, and where a sign is not found.
    pub fn has_odd_real_roots_beyond(
        &self,
        value: &Rational,
        region: Shape,
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        let Some(symbols) = self.symbols_at(value) else { return Ok(false) };
        let coefficients = budget.enter(|| common_scale(self.polynomial.coeffs(), value))?;
        let at_end = match region {
            Shape::UnitDisc => coefficients.iter().fold(MultiPoly::zero(), |sum, c| sum.plus(c)),
            Shape::LeftHalfPlane => coefficients.first().cloned().unwrap_or_default(),
        };
        let at_end = symbols.sign(&at_end, budget)?;
        for lead in coefficients.iter().rev() {
            let lead = symbols.sign(lead, budget)?;
            if lead.is_ne() {
                return Ok(at_end.is_ne() && at_end != lead);
            }
        }
        Ok(false)
    }

    /// The boundary conditions; `None` where one of them holds for every value of the parameter because it is zero, or the
    /// degree is not reached. The resultant is expanded where it has no more than `most` terms.
    fn conditions(&self, region: Shape, most: u64, budget: &Budget) -> Result<Option<Vec<Condition>>, Exhausted> {
        let n = self.formal_degree;
        if self.polynomial.degree() != Some(n) {
            return Ok(None);
        }
        budget.step("boundary polynomials");
        let value = |x: i64| budget.enter(|| self.polynomial.eval(&MultiPoly::constant(Integer::from(x))));
        let mut found: Vec<Condition> = Vec::new();
        if n > 0 {
            match region {
                Shape::UnitDisc => {
                    found.push((Cause::RootAtOne, value(1)?.into()));
                    found.push((Cause::RootAtMinusOne, value(-1)?.into()));
                }
                Shape::LeftHalfPlane => found.push((Cause::RootAtZero, value(0)?.into())),
            }
        }
        found.push((Cause::DegreeLost, self.degree_loss.clone().into()));
        found.extend(self.poles.iter().map(|q| (Cause::Pole, q.clone().into())));
        if let Table::Moving(symbols) = &self.symbols {
            let signs = symbols.signs_under_roots();
            // Such a zero ends no interval, but a cell must not be decided by the loop at it.
            let touched = symbols.touched_under_roots();
            found.extend(touched.iter().map(|p| (Cause::Undecided, MultiPoly::from_univariate(p, 0).into())));
            let cause = |divides| if divides { Cause::Pole } else { Cause::SquareRoot };
            found.extend(signs.iter().map(|s| (cause(s.divides), MultiPoly::from_univariate(&s.function, 0).into())));
        }
        if n > 1 {
            let pair = pair::Pair::of(&self.pair(region));
            found.push((Cause::ComplexPair, Function::resultant(pair.a, pair.b)));
            let functions: Vec<Function> = found.iter().map(|(_, f)| f.clone()).collect();
            let resultant = &functions[functions.len() - 1];
            if resultant.expanded_size() <= most || !resultants_seem_simple_in(&functions, 0, budget)? {
                let expanded = self.pair(region).critical_constraint(budget)?;
                found.pop();
                found.push((Cause::ComplexPair, expanded.into()));
            }
        }
        let is_zero = |(_, f): &Condition| f.polynomial().is_some_and(MultiPoly::is_zero);
        Ok((!found.iter().any(is_zero)).then_some(found))
    }
}

/// What happens at the zeros of a function.
type Condition = (Cause, Function);

/// Resultants with no more terms than this are expanded: then repeated and common factors are known.
const MOST_EXPANDED: u64 = 400;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_conditions;
