//! Questions about loops with transcendental constants, such as plants behind a hold.

use super::Problem;
use crate::error::{Diagnostic, Error};
use crate::model::Symbol;
use crate::stability::SymbolicPolynomial;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::RationalFunction;
use jurist_algebra::symbols::{Definition, MovingSymbols, Symbols};
use std::sync::Arc;

impl Problem {
    /// The polynomial in the one free parameter (or none) over the constants of the model; `None` where the loop is undefined
    /// for every value.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and `O(n)` least common multiples.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; refused (`E-function`) where the question is inside of a function and its domain
    /// is not bounded.
    ///
    /// # Panics
    /// When more than one parameter is free.
    pub fn symbolic(&self, budget: &Budget) -> Result<Option<SymbolicPolynomial>, Error> {
        assert!(self.free().len() <= 1, "one parameter is free");
        let algebra = self.algebra_over_symbols(budget)?;
        if !algebra.symbols().delays().is_empty() {
            let help = "known of it: verdict, intervals of one parameter, analyze, charpoly";
            return Err(super::delayed::refused("this cannot be asked of a loop with dead time yet", help));
        }
        let Some(polynomial) = algebra.polynomial() else { return Ok(None) };
        let (symbols, free) = (algebra.symbols(), self.free().len());
        if !symbols.is_moving() {
            return Ok(Some(SymbolicPolynomial::new(polynomial, free, &Arc::new(self.fixed_symbols(budget)?))));
        }
        let mut table = Vec::new();
        for symbol in symbols.iter() {
            table.push((symbol.name.clone(), definition(symbol, |f| Some(f.clone()))?));
        }
        let found = SymbolicPolynomial::with_moving(polynomial, &Arc::new(MovingSymbols::new(table)));
        let asked = self.parameter();
        let (lower, upper) = (asked.domain.lower.as_ref(), asked.domain.upper.as_ref());
        let is_bounded = match (lower, upper) {
            (Some(_), Some(_)) => true,
            (Some(lower), None) => found.tail_start(lower, self.shape(), budget)?.is_some(),
            _ => false,
        };
        if !is_bounded {
            let message = format!("'{}' is inside of a function, and its domain is not bounded", asked.name);
            let help = format!("give both bounds: --domain {}=LO..HI", asked.name);
            return Err(Diagnostic::error("E-function", message).help(help).into());
        }
        Ok(Some(found))
    }
}

impl Problem {
    /// What the symbols of a loop stand for, none of which depends on what is free.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time`.
    pub(crate) fn fixed_symbols(&self, budget: &Budget) -> Result<Symbols, Error> {
        let symbols = self.algebra_over_symbols(budget)?.symbols();
        if !symbols.delays().is_empty() {
            let help = "known of it: verdict, intervals of one parameter, analyze, charpoly";
            return Err(super::delayed::refused("this cannot be asked of a loop with dead time yet", help));
        }
        let mut table = Symbols::new();
        for symbol in symbols.iter() {
            let place = |f: &RationalFunction| f.map_variables(|i| i.saturating_sub(symbols.first()));
            table.push(&symbol.name, definition(symbol, place)?);
        }
        Ok(table)
    }
}

/// The definition with its arguments' variables as the table numbers them.
fn definition(of: &Symbol, place: impl Fn(&RationalFunction) -> Option<RationalFunction>) -> Result<Definition, Error> {
    // Dead time is a function of s; a loop with it is asked otherwise.
    let placed = of.definition().and_then(|definition| definition.try_map(place));
    placed.ok_or_else(|| Error::Undefined("a function has no value there".into()))
}
