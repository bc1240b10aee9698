//! Functions that are zero whatever the kept names are.

use super::{Definition, Symbols};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::poly::{MultiPoly, RationalFunction};
use jurist_algebra::symbols::{Symbols as Values, is_identity};
use std::collections::BTreeMap;

impl Symbols {
    /// Whether a function of kept names and symbols is seen to be zero whatever the kept names are: by the normal form of Lindemann and
    /// Weierstrass, or as all its coefficients in the kept names are numbers that are zero.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub(crate) fn is_identically_zero(&self, f: &RationalFunction, budget: &Budget) -> Result<bool, Exhausted> {
        let p = f.numerator();
        let is_symbol = |i: &usize| *i >= self.first();
        if p.is_constant() || !p.variables().iter().any(is_symbol) {
            return Ok(f.is_zero());
        }
        let definitions: Vec<Option<Definition>> = self.table.iter().map(|s| s.definition().cloned()).collect();
        if budget.enter(|| is_identity(p, self.first(), &definitions))? {
            return Ok(true);
        }
        let Some(values) = self.fixed_values().filter(|_| self.delays().is_empty()) else { return Ok(false) };
        for number in in_kept_names(p, self.first()).values() {
            match values.is_zero(number, budget) {
                Ok(true) => {}
                // A zero that no identity shows is not left out.
                Err(stopped) if !stopped.stop.is_precision() => return Err(stopped),
                _ => return Ok(false),
            }
        }
        Ok(true)
    }

    /// The rational number that a function of symbols is, where that is seen in the normal form.
    pub(super) fn as_rational(&self, f: &RationalFunction) -> Option<jurist_algebra::number::Rational> {
        if let Some(number) = f.as_constant() {
            return Some(number);
        }
        let first = self.first();
        if f.variables().into_iter().any(|i| i < first) {
            return None;
        }
        self.fixed_values()?.as_rational(&f.map_variables(|i| i - first)?)
    }

    /// The table of what the symbols stand for; `None` where one is no number.
    pub(crate) fn fixed_values(&self) -> Option<Values> {
        let mut values = Values::new();
        for symbol in &self.table {
            let definition = symbol.definition().filter(|_| !symbol.is_moving)?;
            let place = |f: &RationalFunction| f.map_variables(|i| i.saturating_sub(self.first()));
            values.push(&symbol.name, definition.try_map(place)?);
        }
        Some(values)
    }
}

/// The coefficients of the monomials in the first variables, polynomials in the others, which are numbered from 0 on.
fn in_kept_names(p: &MultiPoly, first: usize) -> BTreeMap<Vec<u32>, MultiPoly> {
    let mut parts: BTreeMap<Vec<u32>, Vec<_>> = BTreeMap::new();
    for (monomial, c) in p.terms() {
        let exponents = monomial.exponents();
        let (kept, own) = exponents.split_at(first.min(exponents.len()));
        let mut kept = kept.to_vec();
        kept.resize(first, 0);
        parts.entry(kept).or_default().push((own.to_vec(), c.clone()));
    }
    parts.into_iter().map(|(kept, terms)| (kept, MultiPoly::from_terms(terms))).collect()
}
