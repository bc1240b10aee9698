//! Questions about loops with transcendental constants, such as plants behind a hold.

use super::{Algebra, Problem};
use crate::coverage::CoefficientRing;
use crate::coverage::refusals::INSIDE;
use crate::error::{Code, Diagnostic, Error};
use crate::model::{self, Symbol};
use crate::stability::boxes::MovingPolynomial;
use crate::stability::{SymbolicPlane, SymbolicPolynomial};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_algebra::symbols::{Definition, MovingSymbols, ParametricSymbols, Symbols};
use std::sync::Arc;

impl Problem {
    /// The polynomial in the one free parameter (or none) over the constants of the model; `None` where the loop is undefined
    /// for every value.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and `O(n)` least common multiples.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`].
    ///
    /// # Panics
    /// When more than one parameter is free.
    pub fn symbolic(&self, budget: &Budget) -> Result<Option<SymbolicPolynomial>, Error> {
        assert!(self.free().len() <= 1, "one parameter is free");
        let algebra = self.algebra_over_symbols(budget)?;
        if !algebra.symbols().delays().is_empty() {
            return Err(not_rational(algebra.symbols()));
        }
        self.symbolic_of(algebra)
    }

    /// The same from algebra that is known.
    pub(super) fn symbolic_of(&self, algebra: &Algebra) -> Result<Option<SymbolicPolynomial>, Error> {
        let Some(polynomial) = algebra.polynomial() else { return Ok(None) };
        self.symbolic_polynomial(polynomial, algebra.symbols()).map(Some)
    }

    /// The same from a polynomial in the free parameter, if there is one, and symbols.
    pub(crate) fn symbolic_polynomial(
        &self,
        polynomial: &CharacteristicPolynomial,
        symbols: &model::Symbols,
    ) -> Result<SymbolicPolynomial, Error> {
        let found = match symbols.is_moving() {
            false => SymbolicPolynomial::new(polynomial, self.free().len(), &Arc::new(fixed_symbols(symbols)?)),
            true => SymbolicPolynomial::with_moving(polynomial, &Arc::new(moving_symbols(symbols)?)),
        };
        Ok(match self.free().first().and_then(|free| free.nominal.clone()) {
            Some(usual) => found.with_usual_value(usual),
            None => found,
        })
    }
}

impl Problem {
    /// What the symbols of a loop stand for, none of which depends on what is free.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`].
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time`.
    pub fn fixed_symbols(&self, budget: &Budget) -> Result<Symbols, Error> {
        let symbols = self.algebra_over_symbols(budget)?.symbols();
        if !symbols.delays().is_empty() {
            return Err(not_rational(symbols));
        }
        fixed_symbols(symbols)
    }
}

impl Problem {
    /// What the symbols of a loop with two free parameters stand for, neither of which is inside of a function.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time`; `E-function` where functions depend on a parameter.
    pub(super) fn symbols_outside(&self, budget: &Budget) -> Result<Symbols, Error> {
        let symbols = self.algebra_over_symbols(budget)?.symbols();
        if !symbols.delays().is_empty() {
            return Err(not_rational(symbols));
        }
        let inside = parameters_inside(symbols);
        if let Some(axis) = [0, 1].into_iter().find(|axis| inside.contains(axis)) {
            let name = &self.free()[axis].name;
            return Err(INSIDE.diagnostic(&[("name", name)]).into());
        }
        fixed_symbols(symbols)
    }

    /// The polynomial in the two free parameters over the constants of the model, of which some may be functions of one of the two;
    /// `None` where the loop is rational, and where it is undefined for all values.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and of [`SymbolicPlane::new`].
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time`; `E-function` where functions depend on both parameters.
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn symbolic_plane(&self, budget: &Budget) -> Result<Option<SymbolicPlane>, Error> {
        assert_eq!(self.free().len(), 2, "two parameters are free");
        let algebra = self.algebra_over_symbols(budget)?;
        let symbols = algebra.symbols();
        let Some(polynomial) = algebra.polynomial().filter(|_| !symbols.is_empty()) else { return Ok(None) };
        if !symbols.delays().is_empty() {
            return Err(not_rational(symbols));
        }
        let inside = parameters_inside(symbols);
        let plane = match [0, 1].map(|axis| inside.contains(&axis)) {
            [true, true] => {
                let [x, y] = [0, 1].map(|i| &self.free()[i].name);
                let message = format!("'{x}' and '{y}' are both inside of functions, as behind a hold");
                let help =
                    "this plane has functions of one parameter: 'Problem::map_by' makes boxes where both are inside";
                return Err(Diagnostic::error(Code::Function, message).help(help).into());
            }
            [false, false] => SymbolicPlane::new(polynomial, self.shape(), &Arc::new(fixed_symbols(symbols)?)),
            [first, _] => {
                let axis = usize::from(!first);
                let place = |i: usize| if i == axis { 0 } else { i.saturating_sub(1) };
                let mut table = Vec::new();
                for symbol in symbols.iter() {
                    table.push((symbol.name.clone(), definition(symbol, |f| f.map_variables(place))?));
                }
                SymbolicPlane::with_moving(polynomial, self.shape(), &Arc::new(MovingSymbols::new(table)), axis)
            }
        };
        Ok(Some(plane))
    }
}

impl Problem {
    /// The loop in all its free names where one of them is inside of functions, or only values of its coefficients are known, and there is no dead
    /// time.
    pub(crate) fn moving_family(&self, budget: &Budget) -> Result<Option<MovingPolynomial>, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let symbols = algebra.symbols();
        let is_moving = (symbols.is_moving() || symbols.has_families()) && symbols.delays().is_empty();
        let Some(d) = algebra.polynomial().filter(|_| is_moving) else { return Ok(None) };
        let symbols = parametric_symbols(symbols)?;
        let d = CharacteristicPolynomial { poles: self.divisors(budget)?, ..d.clone() };
        let positive = self.positive();
        let free = self.free().len();
        let family = budget.enter(|| MovingPolynomial::new(&d, free, symbols, self.shape()))?;
        Ok(Some(family.defined_where_positive(positive)))
    }
}

impl Problem {
    /// What does not vanish where the loop is defined, in the free names and symbols: the model's divisors, the sample time, what the symbols'
    /// arguments are divided by, and what is presupposed to be positive.
    pub(crate) fn divisors(&self, budget: &Budget) -> Result<Vec<MultiPoly>, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let symbols = parametric_symbols(algebra.symbols())?;
        let poles = algebra.polynomial().into_iter().flat_map(|d| &d.poles);
        let time = algebra.sample_time().into_iter().flat_map(|t| [t.numerator(), t.denominator()]);
        let below = symbols.arguments().map(RationalFunction::denominator);
        Ok(poles.chain(time).chain(below).cloned().chain(self.positive()).collect())
    }
}

/// The refusal of a loop with dead time.
fn not_rational(symbols: &model::Symbols) -> Error {
    CoefficientRing::of(symbols).not_rational(symbols).into()
}

/// The variables in the arguments of the symbols.
fn parameters_inside(symbols: &model::Symbols) -> Vec<usize> {
    let arguments = symbols.iter().filter_map(|symbol| symbol.definition());
    arguments.flat_map(|d| d.arguments()).flat_map(RationalFunction::variables).collect()
}

/// The table of symbols that do not depend on a kept name; their arguments are in symbols alone.
pub(crate) fn fixed_symbols(symbols: &model::Symbols) -> Result<Symbols, Error> {
    let mut table = Symbols::new();
    for symbol in symbols.iter() {
        let place = |f: &RationalFunction| f.map_variables(|i| i.saturating_sub(symbols.first()));
        table.push(&symbol.name, definition(symbol, place)?);
    }
    Ok(table)
}

/// The definition of a symbol that no polynomial contains: the table keeps its row, and the other symbols their numbers.
const PLACEHOLDER: Definition = Definition::Pi;

/// The table of symbols that do not depend on a kept name, beside others that are not asked for; `None` where one has no value.
pub(crate) fn symbols_without(symbols: &model::Symbols, moving: &[usize]) -> Option<Symbols> {
    let mut table = Symbols::new();
    for (i, symbol) in (symbols.first()..).zip(symbols.iter()) {
        let is_fixed = |f: &&RationalFunction| f.variables().iter().all(|variable| *variable >= symbols.first());
        let place = |f: &RationalFunction| Some(f).filter(is_fixed)?.map_variables(|i| i - symbols.first());
        let own = if moving.contains(&i) { PLACEHOLDER } else { definition(symbol, place).ok()? };
        table.push(&symbol.name, own);
    }
    Some(table)
}

/// The table of symbols where one name is kept, on which they may depend.
pub(crate) fn moving_symbols(symbols: &model::Symbols) -> Result<MovingSymbols, Error> {
    Ok(MovingSymbols::new(definitions(symbols)?))
}

/// The table of symbols where several names are kept, on which they may depend.
///
/// Symbols that stand for dead times have a placeholder: the polynomials that are asked may not contain them.
pub(crate) fn parametric_symbols(symbols: &model::Symbols) -> Result<ParametricSymbols, Error> {
    let delays: Vec<usize> = symbols.delays().into_iter().map(|(variable, _)| variable).collect();
    let own = |(variable, symbol): (usize, &Symbol)| {
        let definition = match delays.contains(&variable) {
            true => PLACEHOLDER,
            false => definition(symbol, |f| Some(f.clone()))?,
        };
        Ok((symbol.name.clone(), definition))
    };
    let table = (symbols.first()..).zip(symbols.iter()).map(own).collect::<Result<_, Error>>()?;
    Ok(ParametricSymbols::new(table))
}

fn definitions(symbols: &model::Symbols) -> Result<Vec<(String, Definition)>, Error> {
    symbols.iter().map(|symbol| Ok((symbol.name.clone(), definition(symbol, |f| Some(f.clone()))?))).collect()
}

/// The definition with its arguments' variables as the table numbers them.
pub(super) fn definition(
    of: &Symbol,
    place: impl Fn(&RationalFunction) -> Option<RationalFunction>,
) -> Result<Definition, Error> {
    // Dead time is a function of s; a loop with it is asked otherwise.
    let placed = of.definition().and_then(|definition| definition.try_map(place));
    placed.ok_or_else(|| Error::Undefined("a function has no value there".into()))
}
