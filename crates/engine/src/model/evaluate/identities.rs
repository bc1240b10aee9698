//! Values that are zero whatever the parameters are, such as `sqrt(2)^2 - 2`: as coefficients they do not count for a degree, and nothing
//! is divided by them. Arguments at which a function has no value, and constants as numbers.

use super::scalar::{Scope, Variable};
use super::zpoly::ZPoly;
use crate::error::Error;
use crate::model::complex::{Parts, has_unit, parts_of};
use crate::model::definition::Model;
use crate::model::evaluated::substituted;
use crate::model::steady::no_duty;
use crate::model::symbols::Symbols;
use crate::model::text::Function;
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

#[cfg(test)]
mod tests {
    use crate::answer::Verdict;
    use crate::error::Source;
    use crate::model::Model;
    use jurist_algebra::limits::Budget;

    fn model(loop_text: &str) -> Model {
        let text = format!(
            "time = 'discrete'\n[parameters]\nK = {{ nominal = 0.1 }}\na = {{ nominal = 0.3 }}\n[constants]\nb = 1.7\n{loop_text}"
        );
        Model::from_toml(&Source::new("model.toml", text)).unwrap().0
    }

    /// Zero whatever `a` is, as in the help of `sin` and `cos`, of numbers, and of roots of roots.
    const ZEROS: [&str; 12] = [
        "cos(pi/3) - 1/2",
        "sin(a)^2 + cos(a)^2 - 1",
        "sin(b)^2 + cos(b)^2 - 1",
        "sqrt(2)^2 - 2",
        "tan(pi/4) - 1",
        "sqrt(3 + 2*sqrt(2)) - 1 - sqrt(2)",
        "sin(2*a) - 2*sin(a)*cos(a)",
        "cos(a + b) - cos(a)*cos(b) + sin(a)*sin(b)",
        "exp(a)*exp(-a) - 1",
        "exp(2*b) - exp(b)^2",
        "a*(sqrt(8) - 2*sqrt(2))",
        "tan(pi*a)*cos(pi*a) - sin(pi*a)",
    ];

    #[test]
    fn what_is_zero_for_all_values_does_not_count_for_the_degree() {
        let budget = Budget::unlimited();
        for zero in ZEROS {
            let form = format!("[loop]\ncharacteristic = '({zero})*z^3 + K*({zero})*z^2 + z - K'\n");
            let model = model(&form);
            let verdict = model.ask().verdict(&budget).unwrap().into_value();
            assert_eq!((verdict.verdict, verdict.degree, verdict.infinite), (Verdict::Stable, 1, 0), "{zero}");
            let set = model.ask().free("K").stable_set(&budget).unwrap().into_value();
            let ends = |i: &crate::stability::StableInterval| {
                [&i.lower, &i.upper].map(|end| end.as_ref().unwrap().value.exact().unwrap())
            };
            assert_eq!(set.intervals().iter().map(ends).collect::<Vec<_>>(), [[(-1).into(), 1.into()]], "{zero}");
        }
    }

    #[test]
    fn neither_does_it_in_a_block() {
        for zero in ZEROS {
            let form = format!(
                "[loop]\ninputs = ['r']\noutputs = ['y']\n[[block]]\ninput = 'r - y'\noutput = 'y'\n\
                 transfer = '(({zero})*z^2 + K)/(({zero})*z^2 + z)'\n"
            );
            let verdict = model(&form).ask().verdict(&Budget::unlimited()).unwrap().into_value();
            assert_eq!((verdict.verdict, verdict.degree, verdict.infinite), (Verdict::Stable, 1, 0), "{zero}");
        }
    }

    /// A coefficient that is zero at these values only is a root that has left through infinity.
    #[test]
    fn what_is_zero_at_the_values_only_counts() {
        for almost in ["a - 3/10", "sin(a - 3/10)", "sin(a)^2 + cos(a)^2 - 1 + 10*a - 3", "sqrt(2)^2 - 2 + K - 1/10"] {
            let form = format!("[loop]\ncharacteristic = '({almost})*z^2 + z - K'\n");
            let verdict = model(&form).ask().verdict(&Budget::unlimited()).unwrap().into_value();
            assert_eq!((verdict.verdict, verdict.degree, verdict.infinite), (Verdict::Unstable, 2, 1), "{almost}");
        }
    }
}
