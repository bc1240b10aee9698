//! Values that are zero whatever the parameters are, such as `sqrt(2)^2 - 2`: as coefficients they do not count for a degree, and nothing
//! is divided by them. Arguments at which a function has no value, and constants as numbers.

use super::scalar::{Scope, Variable};
use super::zpoly::ZPoly;
use crate::complex::{Parts, has_unit, parts_of};
use crate::definition::Model;
use crate::error::Error;
use crate::evaluated::substituted;
use crate::steady::no_duty;
use crate::symbols::Symbols;
use crate::text::Function;
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::poly::RationalFunction;
use std::collections::BTreeSet;

/// Divisors and arguments of more functions and parameters than this are not looked at: every constant of a model is, and enclosing
/// functions of functions takes twice as long with each.
const MOST: usize = 6;

/// The bits after the point with which constants are enclosed to see their signs and sizes.
const ENOUGH_BITS: u64 = 128;

impl Scope<'_> {
    /// The polynomial without leading coefficients that are zero whatever the parameters are, as far as identities between functions
    /// tell.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn without_identities(&self, p: ZPoly) -> Result<ZPoly, Exhausted> {
        let mut coefficients = p.coefficients().to_vec();
        while let Some(last) = coefficients.last()
            && self.is_zero_by_identities(last)?
        {
            coefficients.pop();
        }
        Ok(ZPoly::new(coefficients))
    }

    /// True if a value has functions in it that identities show to be zero whatever the parameters are.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn is_hidden_zero(&self, f: &RationalFunction) -> Result<bool, Exhausted> {
        for part in self.parts(f) {
            let is_zero = part.is_zero() || self.needed(&part).len() <= MOST && self.is_zero_by_identities(&part)?;
            if !is_zero {
                return Ok(false);
            }
        }
        Ok(!f.is_zero())
    }

    /// True if a value other than zero has functions in it, and identities show that it is zero.
    fn is_zero_by_identities(&self, f: &RationalFunction) -> Result<bool, Exhausted> {
        for part in self.parts(f) {
            let is_zero = part.is_zero() || self.has_functions(&part) && self.is_identity(&part)?;
            if !is_zero {
                return Ok(false);
            }
        }
        Ok(!f.is_zero())
    }

    /// The value itself where it is real, else its real and its imaginary part.
    fn parts(&self, f: &RationalFunction) -> Vec<RationalFunction> {
        match parts_of(f, self.unit).filter(|_| has_unit(f, self.unit)) {
            Some(Parts { re, im }) => vec![re, im],
            None => vec![f.clone()],
        }
    }

    /// True if a polynomial is seen to be zero whatever the parameters are.
    ///
    /// # Errors
    /// [`Exhausted`] when the budget runs out.
    pub fn vanishes(&self, p: &ZPoly) -> Result<bool, Exhausted> {
        for c in p.coefficients() {
            if !c.is_zero() && !self.is_hidden_zero(c)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn has_functions(&self, f: &RationalFunction) -> bool {
        let is_function =
            |i: usize| !matches!(self.variables[i], Variable::Named(_) | Variable::Delay(_) | Variable::Duty);
        f.variables().into_iter().any(is_function)
    }

    /// True if a function of this argument has no value whatever the parameters are: a tangent of half a turn.
    pub fn has_no_value(&self, function: Function, argument: &RationalFunction) -> bool {
        let call = Variable::Call(function, argument.clone());
        let mut needed = self.needed(argument);
        needed.push(self.variables.len());
        needed.len() <= MOST
            && self.images(&needed, Some(&call)).is_err()
            && self.images(&self.needed(argument), None).is_ok()
    }

    /// An enclosure of a value without parameters; `None` where one is in it, or more functions than are looked at.
    pub fn enclosure(&self, f: &RationalFunction) -> Option<Ball> {
        let needed = self.needed(f);
        let is_named =
            |&i: &usize| matches!(self.variables[i], Variable::Named(_) | Variable::Delay(_) | Variable::Duty);
        if needed.len() > MOST || needed.iter().any(is_named) {
            return None;
        }
        let (images, symbols) = self.images(&needed, None).ok()?;
        let (symbols, merged) = symbols.merged()?;
        let f = substituted(&renumbered(f, &needed)?, &images).and_then(|f| substituted(&f, &merged))?;
        symbols.fixed_values()?.quotient_at(&f, ENOUGH_BITS)
    }

    /// Whether a value is seen to be zero whatever all names are.
    fn is_identity(&self, f: &RationalFunction) -> Result<bool, Exhausted> {
        let needed = self.needed(f);
        // Values that do not exist are reported elsewhere.
        let Ok((images, symbols)) = self.images(&needed, None) else { return Ok(false) };
        let Some((symbols, merged)) = symbols.merged() else { return Ok(false) };
        let image =
            renumbered(f, &needed).and_then(|f| substituted(&f, &images)).and_then(|f| substituted(&f, &merged));
        image.map_or(Ok(false), |f| symbols.is_identically_zero(&f, self.budget))
    }

    /// The variables that a value depends on, directly or through the arguments of functions, ascending.
    fn needed(&self, f: &RationalFunction) -> Vec<usize> {
        let mut found = BTreeSet::new();
        let mut open: Vec<usize> = f.variables().into_iter().collect();
        while let Some(i) = open.pop() {
            if found.insert(i)
                && let Variable::Call(_, x) | Variable::TangentOfRule(x) | Variable::Delay(x) = &self.variables[i]
            {
                open.extend(x.variables());
            }
        }
        found.into_iter().collect()
    }

    /// What these variables, and one more, are in their names and in symbols; all arguments are of variables among them.
    fn images(&self, needed: &[usize], more: Option<&Variable>) -> Result<(Vec<RationalFunction>, Symbols), Error> {
        let own = |i: &usize| self.variables.get(*i).or(more);
        let undefined = || Error::Undefined("two variables became one".into());
        let mut variables = Vec::with_capacity(needed.len());
        for variable in needed.iter().filter_map(own) {
            let of = |x: &RationalFunction| renumbered(x, needed).ok_or_else(undefined);
            variables.push(match variable {
                Variable::Named(_) | Variable::Pi | Variable::Unit | Variable::Duty => variable.clone(),
                Variable::Call(function, x) => Variable::Call(*function, of(x)?),
                Variable::TangentOfRule(x) => Variable::TangentOfRule(of(x)?),
                Variable::Delay(x) => Variable::Delay(of(x)?),
            });
        }
        let names = variables.iter().filter_map(|v| match v {
            Variable::Named(name) => Some(name.clone()),
            _ => None,
        });
        Model::images(&variables, &names.collect::<Vec<String>>(), &[], &no_duty)
    }
}

/// A value in the variables of a list, by their places in it.
fn renumbered(f: &RationalFunction, needed: &[usize]) -> Option<RationalFunction> {
    f.map_variables(|i| needed.binary_search(&i).unwrap_or(i))
}
