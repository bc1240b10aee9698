//! Nominal values of parameters: numbers, and formulas in constants and in other parameters.

use super::complex::has_unit;
use super::definition::{Model, Parameter, Position};
use super::evaluate::scalar::Scope;
use super::evaluate::walk::Failure;
use super::evaluate::work::NUMBER_WORK;
use super::text::Expression;
use super::text::names::shorten;
use crate::error::{Code, Diagnostic};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, to_decimal};
use jurist_algebra::poly::RationalFunction;
use std::collections::{HashMap, HashSet};

/// The nominal value of a parameter, or why it has none.
#[derive(Clone, Debug)]
pub enum Nominal {
    /// A number.
    Value(Rational),
    /// There is none.
    Missing,
    /// There is none, since the formula needs this parameter, which has none.
    Needs(String),
    /// The formula has no rational value.
    Wrong(Box<Diagnostic>),
}

impl Nominal {
    /// The number, if there is one.
    pub fn value(&self) -> Option<&Rational> {
        match self {
            Nominal::Value(value) => Some(value),
            Nominal::Missing | Nominal::Needs(_) | Nominal::Wrong(_) => None,
        }
    }
}

/// Why a name has no value.
#[derive(Clone)]
enum Without<'m> {
    Parameter(&'m str),
    Wrong(Diagnostic),
}

impl Model {
    /// The nominal value of each parameter, in their order, where the names that `changed` knows have other values: formulas follow.
    ///
    /// Cost: nothing where no nominal value is a formula; else that of the formulas and of the constants that they need. It is counted,
    /// and what takes too much is wrong.
    pub fn nominal_values(&self, changed: &dyn Fn(&str) -> Option<Rational>) -> Vec<Nominal> {
        let plain = |p: &Parameter| match changed(&p.name).or_else(|| p.nominal.clone()) {
            Some(value) => Nominal::Value(value),
            None => Nominal::Missing,
        };
        let is_asked = |p: &&Parameter| p.nominal_formula.is_some() && changed(&p.name).is_none();
        let mut nominal: Vec<Nominal> = self.parameters.iter().map(plain).collect();
        let needed = self.needed_by(self.parameters.iter().filter(is_asked).filter_map(|p| p.nominal_formula.as_ref()));
        let is_formula = |i: &usize| is_asked(&&self.parameters[*i]);
        let budget = Budget::with_work(NUMBER_WORK);
        let found = budget.enter(|| {
            let mut found = Values::new(&budget);
            for (i, p) in self.parameters.iter().enumerate().filter(|(i, _)| !is_formula(i)) {
                found.define(&p.name, nominal[i].value().cloned().ok_or(Without::Parameter(&p.name)).map(Into::into));
            }
            for position in &self.order {
                match position {
                    Position::Constant(i) if needed.contains(self.constants[*i].name.as_str()) => {
                        let constant = &self.constants[*i];
                        let value = match changed(&constant.name) {
                            Some(value) => Ok(value.into()),
                            None => found.value(&constant.expression),
                        };
                        found.define(&constant.name, value);
                    }
                    Position::Parameter(i) if is_formula(i) => {
                        let parameter = &self.parameters[*i];
                        let formula = parameter.nominal_formula.as_ref().expect("it is one");
                        let value = found.rational(formula, parameter);
                        found.define(&parameter.name, value.clone().map(Into::into));
                        nominal[*i] = match value {
                            Ok(value) => Nominal::Value(value),
                            Err(Without::Parameter(name)) => Nominal::Needs(name.to_owned()),
                            Err(Without::Wrong(error)) => Nominal::Wrong(Box::new(error)),
                        };
                    }
                    Position::Constant(_) | Position::Parameter(_) => {}
                }
            }
        });
        if found.is_err() || budget.check().is_err() {
            for (i, parameter) in self.parameters.iter().enumerate().filter(|(i, _)| is_formula(i)) {
                let formula = parameter.nominal_formula.as_ref().expect("it is one");
                nominal[i] = Nominal::Wrong(Box::new(too_much(formula)));
            }
        }
        nominal
    }

    /// The names that the formula of a nominal value depends on, by way of others too.
    pub fn needed_by<'m>(&'m self, formulas: impl Iterator<Item = &'m Expression>) -> HashSet<&'m str> {
        let mut needed: HashSet<&str> = formulas.flat_map(Expression::names).collect();
        for position in self.order.iter().rev() {
            let (name, formula) = match position {
                Position::Constant(i) => (&self.constants[*i].name, Some(&self.constants[*i].expression)),
                Position::Parameter(i) => (&self.parameters[*i].name, self.parameters[*i].nominal_formula.as_ref()),
            };
            if needed.contains(name.as_str()) {
                needed.extend(formula.into_iter().flat_map(Expression::names));
            }
        }
        needed
    }
}

fn too_much(formula: &Expression) -> Diagnostic {
    Diagnostic::error(Code::TooLarge, "the nominal value takes too much work to compute").at(formula.span, "too large")
}

/// Values of names, one after the other.
struct Values<'m> {
    scope: Scope<'m>,
    without: HashMap<&'m str, Without<'m>>,
}

impl<'m> Values<'m> {
    fn new(budget: &'m Budget) -> Self {
        let scope = Scope::new(std::iter::empty(), std::iter::empty(), |_, _| None, budget, &mut |_| {});
        Values { scope, without: HashMap::new() }
    }

    fn define(&mut self, name: &'m str, value: Result<RationalFunction, Without<'m>>) {
        let value = value.map_err(|why| self.without.insert(name, why)).ok();
        self.scope.define(name, value);
    }

    fn value(&mut self, formula: &Expression) -> Result<RationalFunction, Without<'m>> {
        self.scope.scalar(formula).map_err(|failure| match failure {
            Failure::Wrong(mut error) => {
                // Of numbers, not of functions of the parameters.
                if error.code == Code::DivisionByZero {
                    error.message = "division by zero".into();
                    error.primary.iter_mut().for_each(|label| label.text = "zero here".into());
                }
                Without::Wrong(*error)
            }
            Failure::Exhausted(_) => Without::Wrong(too_much(formula)),
            Failure::Poisoned => {
                let why = formula.names().into_iter().find_map(|name| self.without.get(name));
                why.cloned().unwrap_or_else(|| Without::Wrong(too_much(formula)))
            }
        })
    }

    /// The value of a nominal value's formula, which has to be a rational number.
    fn rational(&mut self, formula: &Expression, of: &Parameter) -> Result<Rational, Without<'m>> {
        /// Digits of a number that is offered in the place of a formula.
        const DIGITS: usize = 17;
        let value = self.value(formula).map_err(|why| match why {
            Without::Wrong(error) if error.primary.as_ref().is_some_and(|l| !formula.span.covers(l.span)) => {
                let label = format!("the nominal value of '{}' needs it", shorten(&of.name));
                Without::Wrong(error.also(formula.span, label))
            }
            why => why,
        })?;
        if has_unit(&value, self.scope.unit) {
            let message = format!("the nominal value of '{}' is complex", shorten(&of.name));
            let error = Diagnostic::error(Code::Complex, message).at(formula.span, "a real value belongs here");
            let help = "parameters are real: write two of them, and a + j*b where they are used";
            return Err(Without::Wrong(error.help(help)));
        }
        value.as_constant().ok_or_else(|| {
            let message = format!("the nominal value of '{}' is not known to be a rational number", shorten(&of.name));
            let near = self.scope.enclosure(&value).map(|ball| to_decimal(&ball.lower(), DIGITS));
            let help = match near {
                Some(near) => format!("write a number, such as {near}"),
                None => "write a number".to_owned(),
            };
            let label = "pi and functions have no exact value";
            Without::Wrong(Diagnostic::error(Code::NotANumber, message).at(formula.span, label).help(help))
        })
    }
}
