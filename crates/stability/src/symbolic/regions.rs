//! The same loop with another region brought back to the disc and the half plane, where the region's bound is not rational.

use super::{SymbolicPolynomial, Table, symbolic_stable_set};
use crate::sector::in_sector;
use crate::{ParametricPolynomial, Range, Shape, StableSet, stable_set};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use jurist_algebra::symbols::{Definition, MovingSymbols};
use std::sync::Arc;

impl SymbolicPolynomial {
    /// `D(r z)` with `r = exp(exponent)`, a symbol more: its roots are in the unit disc just when those of `D` are in the disc of radius `r`.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_algebra::poly::{MultiPoly, Poly};
    /// use jurist_algebra::symbols::Symbols;
    /// use jurist_stability::{Range, Shape, SymbolicPolynomial, symbolic_stable_set};
    /// // z - K in the disc of radius exp(-1)
    /// let [k, one] = [MultiPoly::variable(0), MultiPoly::constant(1.into())];
    /// let polynomial = Poly::new(vec![-&k, one.clone()]);
    /// let p = SymbolicPolynomial::from_parts(&Symbols::new().into(), polynomial, one, 1, Vec::new());
    /// let p = p.scaled_by_exponential(&(-1).into());
    /// let set = symbolic_stable_set(&p, &Range::all(), Shape::UnitDisc, &Budget::unlimited()).unwrap();
    /// assert_eq!(set.intervals()[0].upper.as_ref().unwrap().value.decimal(8), "0.36787944");
    /// ```
    ///
    /// Cost: `O(n)` products of coefficients.
    #[must_use]
    pub fn scaled_by_exponential(&self, exponent: &Rational) -> SymbolicPolynomial {
        let definition = Definition::exponential(exponent.clone());
        let (symbols, radius) = match &self.symbols {
            Table::Fixed(symbols) => {
                let mut symbols = symbols.as_ref().clone();
                let radius = symbols.insert("X", definition);
                (Table::Fixed(Arc::new(symbols)), radius)
            }
            Table::Moving(symbols) => (Table::Moving(Arc::new(symbols.with("X", definition))), symbols.len()),
        };
        let radius = MultiPoly::variable(radius + 1);
        let mut power = MultiPoly::one();
        let mut scaled = Vec::with_capacity(self.polynomial.coeffs().len());
        for c in self.polynomial.coeffs() {
            scaled.push(c.times(&power));
            power = power.times(&radius);
        }
        SymbolicPolynomial { symbols, polynomial: Poly::new(scaled), ..self.clone() }
    }

    /// The polynomial, of twice the degree, whose roots are in the left half plane just when the roots of this one are in the sector of at
    /// least this damping; see [`in_sector`].
    ///
    /// Cost: `O(n^2)` products of coefficients.
    #[must_use]
    pub fn in_sector(&self, damping: &Rational) -> SymbolicPolynomial {
        let polynomial = in_sector(&self.polynomial, damping);
        SymbolicPolynomial { polynomial, formal_degree: 2 * self.formal_degree, ..self.clone() }
    }

    /// The stable set: [`stable_set`] decides a loop without symbols, [`symbolic_stable_set`] any other.
    ///
    /// Cost: that of these.
    ///
    /// # Errors
    /// As these.
    pub fn stable_set(&self, range: &Range, region: Shape, budget: &Budget) -> Result<StableSet, Exhausted> {
        match self.without_symbols() {
            Some(p) => stable_set(&p, range, region, budget),
            None => symbolic_stable_set(self, range, region, budget),
        }
    }

    fn without_symbols(&self) -> Option<ParametricPolynomial> {
        self.fixed_symbols().filter(|symbols| symbols.is_empty())?;
        let one = |p: &MultiPoly| p.to_univariate(0);
        let coefficient = |i| Some((one(&self.polynomial.coeff(i))?, UniPoly::one()));
        let coefficients = (0..=self.formal_degree).map(coefficient).collect::<Option<Vec<_>>>()?;
        let poles = self.poles.iter().map(one).collect::<Option<Vec<_>>>()?;
        let poles = poles.into_iter().filter(|p| !p.is_constant() || p.is_zero()).collect();
        Some(ParametricPolynomial::new(&coefficients, self.formal_degree, poles))
    }

    /// The table of symbols as functions of the parameter; a constant becomes a constant function. Returns `None` if a definition has no
    /// arguments beside the parameter.
    ///
    /// Cost: a copy of the table.
    pub fn moving_symbols(&self) -> Option<Arc<MovingSymbols>> {
        let symbols = match &self.symbols {
            Table::Fixed(symbols) => symbols,
            Table::Moving(symbols) => return Some(Arc::clone(symbols)),
        };
        let beside = |f: &RationalFunction| f.map_variables(|i| i + 1);
        let define = |(i, name): (usize, String)| Some((name, symbols.definition(i).try_map(beside)?));
        let table: Option<Vec<_>> = symbols.names().into_iter().enumerate().map(define).collect();
        Some(Arc::new(MovingSymbols::new(table?)))
    }
}
