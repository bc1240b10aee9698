//! Values that depend on the parameters only.

use super::walk::{Failure, Meaning, division_by_zero, evaluate, too_large};
use super::work::count_work;
use crate::complex::{Parts, has_unit};
use crate::definition::{Constant, Parameter};
use crate::error::{Code, Diagnostic, Span};
use crate::text::{Expression, Function, PI, Sign, UNIT};
use jurist_algebra::ball::Ball;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

/// Polynomials whose coefficients could grow beyond this many bits are not computed.
const MAX_BITS: u64 = 1 << 23;

/// Exponentials of constants beyond this, either way, are refused.
const MAX_EXPONENT: u32 = 100_000;

/// What every name of a model stands for, and what has been divided by so far.
pub(crate) struct Scope<'a> {
    values: HashMap<&'a str, Option<RationalFunction>>,
    /// What the variables of all values stand for.
    pub variables: Vec<Variable>,
    /// The model is undefined where all polynomials of one of these are zero together.
    pub divisors: Vec<Vec<MultiPoly>>,
    seen: HashSet<Vec<MultiPoly>>,
    /// The variable that stands for the imaginary unit, once it is met.
    pub unit: Option<usize>,
    /// Whether `exp(-tau*s)` is dead time: in a continuous loop.
    pub is_continuous: bool,
    pub budget: &'a Budget,
}

/// What a variable of the values stands for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Variable {
    /// A parameter, or a constant that is kept.
    Named(String),
    /// The circle number.
    Pi,
    /// The imaginary unit. Values have it in the first power at most, and none below a fraction.
    Unit,
    /// A function of a value in the variables before this one.
    Call(Function, RationalFunction),
    /// The tangent of a value in the variables before this one that a prewarped rule brings: nobody wrote it.
    TangentOfRule(RationalFunction),
    /// `exp(-x s)` of a dead time `x` in the variables before this one.
    Delay(RationalFunction),
    /// The duty ratio of the loop at rest.
    Duty,
}

/// What a parameter stands for.
pub(crate) enum Symbol {
    /// Itself, under its own name.
    Variable,
    /// A number.
    Value(Rational),
}

impl<'a> Scope<'a> {
    /// A scope in which `symbol` says what each parameter, and each constant it knows, stands for.
    /// The constants come in an order in which each uses earlier ones only. Errors in constants
    /// are handed to `report`; what depends on them is [`Failure::Poisoned`].
    pub fn new(
        parameters: impl Iterator<Item = &'a Parameter>,
        constants: impl Iterator<Item = &'a Constant>,
        mut symbol: impl FnMut(&str, bool) -> Option<Symbol>,
        budget: &'a Budget,
        report: &mut dyn FnMut(Failure),
    ) -> Self {
        let mut scope = Scope {
            values: HashMap::new(),
            variables: Vec::new(),
            divisors: Vec::new(),
            seen: HashSet::new(),
            unit: None,
            is_continuous: false,
            budget,
        };
        for parameter in parameters {
            let symbol = symbol(&parameter.name, false).unwrap_or(Symbol::Variable);
            scope.bind(&parameter.name, symbol);
        }
        for constant in constants {
            if let Some(symbol) = symbol(&constant.name, true) {
                scope.bind(&constant.name, symbol);
                continue;
            }
            let value = match evaluate(&constant.expression, &mut scope) {
                Ok(value) => Some(value),
                Err(Failure::Poisoned) => None,
                Err(failure) => {
                    report(failure);
                    None
                }
            };
            scope.values.insert(&constant.name, value);
        }
        scope
    }

    fn bind(&mut self, name: &'a str, symbol: Symbol) {
        let value = match symbol {
            Symbol::Variable => {
                self.variables.push(Variable::Named(name.to_owned()));
                RationalFunction::variable(self.variables.len() - 1)
            }
            Symbol::Value(value) => value.into(),
        };
        self.values.insert(name, Some(value));
    }

    /// Gives a name its value; `None` where it has none.
    pub fn define(&mut self, name: &'a str, value: Option<RationalFunction>) {
        self.values.insert(name, value);
    }

    /// The value of an expression in constants and parameters.
    pub fn scalar(&mut self, e: &Expression) -> Result<RationalFunction, Failure> {
        evaluate(e, self)
    }

    /// A function of a value: a number where that is rational for a reason, else a variable that stands for it.
    pub fn call(
        &mut self,
        function: Function,
        value: RationalFunction,
        span: Span,
    ) -> Result<RationalFunction, Failure> {
        self.budget.check()?;
        if matches!(function, Function::Conj | Function::Re | Function::Im) || has_unit(&value, self.unit) {
            return self.call_of_complex(function, &value, span);
        }
        if let Some(x) = value.as_constant() {
            if function == Function::Sqrt && x.is_negative() {
                let error = Diagnostic::error(Code::Value, "the square root of a negative number");
                return Err(error.at(span, "not a real number").into());
            }
            if let Some(exact) = rational_value(function, &x) {
                return Ok(exact.into());
            }
        }
        self.refuse_without_value(function, &value, span)?;
        Ok(self.variable(Variable::Call(function, value)))
    }

    /// An error where a function of this argument has no value, or one that is too large to compute with, whatever the parameters are.
    fn refuse_without_value(&self, function: Function, x: &RationalFunction, span: Span) -> Result<(), Failure> {
        let wrong = match function {
            Function::Sqrt if self.enclosure(x).is_some_and(|x| x.sign() == Some(Ordering::Less)) => {
                Diagnostic::error(Code::Value, "the square root of a negative number").at(span, "not a real number")
            }
            Function::Tan if self.has_no_value(function, x) => {
                let error = Diagnostic::error(Code::Value, "the tangent of an odd multiple of pi/2");
                error.at(span, "has no value there")
            }
            Function::Exp if self.enclosure(x).is_some_and(|x| is_beyond(&x)) => {
                let error = Diagnostic::error(Code::TooLarge, "the exponential of a large number");
                let help = format!("an exponent may be as large as {MAX_EXPONENT}; are its units right?");
                error.at(span, "too large to compute with").help(help)
            }
            _ => return Ok(()),
        };
        Err(wrong.into())
    }

    /// The tangent that a prewarped rule brings.
    pub fn tangent_of_a_rule(&mut self, value: RationalFunction) -> RationalFunction {
        if value.is_zero() { value } else { self.variable(Variable::TangentOfRule(value)) }
    }

    /// The duty ratio of the loop at rest.
    pub fn duty(&mut self) -> RationalFunction {
        self.variable(Variable::Duty)
    }

    /// The variable that stands for this, the same each time.
    pub(super) fn variable(&mut self, wanted: Variable) -> RationalFunction {
        let at = self.variables.iter().position(|v| *v == wanted).unwrap_or_else(|| {
            self.variables.push(wanted);
            self.variables.len() - 1
        });
        RationalFunction::variable(at)
    }

    /// `exp(-x s)` of a dead time, which has no value of its own: a variable.
    pub fn delay(&mut self, time: RationalFunction, span: Span) -> Result<RationalFunction, Failure> {
        if time.is_zero() {
            return Ok(RationalFunction::one());
        }
        if time.as_constant().is_some_and(|x| x.is_negative()) {
            let error = Diagnostic::error(Code::DeadTime, "a negative dead time looks ahead").at(span, "a prediction");
            return Err(error.help("a dead time tau is written exp(-tau*s), with a minus sign").into());
        }
        Ok(self.variable(Variable::Delay(time)))
    }

    /// The dead time of the least delayed term of a polynomial, as a multiple of the first dead time there is; `None` where a
    /// ratio of dead times is no number.
    pub fn least_delay(&self, p: &MultiPoly) -> Option<Rational> {
        let times = self.variables.iter().map(|v| match v {
            Variable::Delay(time) => Some(time),
            _ => None,
        });
        let times: Vec<Option<&RationalFunction>> = times.collect();
        let Some(first) = times.iter().flatten().next() else { return Some(Rational::ZERO) };
        let mut least: Option<Rational> = None;
        for (monomial, _) in p.terms() {
            let mut sum = Rational::ZERO;
            for (i, &e) in monomial.exponents().iter().enumerate() {
                if let Some(time) = times[i].filter(|_| e > 0) {
                    let ratio = time.checked_div(first)?.as_constant()?;
                    sum = &sum + &(&ratio * &Rational::from(e as i64));
                }
            }
            least = Some(least.map_or(sum.clone(), |known| known.min(sum)));
        }
        Some(least.unwrap_or(Rational::ZERO))
    }

    /// Whether a value contains a dead time.
    pub fn is_delayed(&self, f: &RationalFunction) -> bool {
        f.variables().into_iter().any(|i| matches!(self.variables[i], Variable::Delay(_)))
    }

    /// Notes that the model is undefined where all of `polynomials` are zero, for all values of the delays in them.
    pub fn divides_by(&mut self, polynomials: Vec<MultiPoly>) {
        let delays = (0..self.variables.len()).filter(|&i| matches!(self.variables[i], Variable::Delay(_)));
        let parts = |p: &MultiPoly, i: usize| p.as_poly_in(i).into_coeffs();
        let polynomials = delays.fold(polynomials, |list, i| list.iter().flat_map(|p| parts(p, i)).collect());
        // A complex value is zero where both of its parts are.
        let polynomials: Vec<MultiPoly> = match self.unit {
            Some(unit) => polynomials.iter().flat_map(|p| Parts::of_polynomial(p, unit)).collect(),
            None => polynomials,
        };
        let divisor: Vec<MultiPoly> =
            polynomials.iter().filter(|p| !p.is_zero()).map(MultiPoly::primitive_over_integers).collect();
        if !divisor.iter().any(MultiPoly::is_constant) && self.seen.insert(divisor.clone()) {
            self.divisors.push(divisor);
        }
    }
}

/// True if a number is beyond the exponents that are computed with.
fn is_beyond(x: &Ball) -> bool {
    let most = Rational::from(i64::from(MAX_EXPONENT));
    x.lower() > most || x.upper() < -most
}

/// The value of a function where it is rational: at 0, and the roots of squares.
pub(crate) fn rational_value(function: Function, x: &Rational) -> Option<Rational> {
    match function {
        Function::Sqrt => x.checked_sqrt(),
        Function::Exp | Function::Cos => x.is_zero().then_some(Rational::ONE),
        Function::Sin | Function::Tan => x.is_zero().then_some(Rational::ZERO),
        Function::Conj | Function::Re => Some(x.clone()),
        Function::Im => Some(Rational::ZERO),
    }
}

fn fits(a: &MultiPoly, b: &MultiPoly) -> bool {
    let terms = (a.terms().len() as u64).saturating_mul(b.terms().len() as u64);
    a.total_degree() + b.total_degree() <= MultiPoly::MAX_DEGREE
        && terms <= 4 * MultiPoly::MAX_TERMS
        && a.height_bits() + b.height_bits() <= MAX_BITS
}

/// `a + b` or `a - b`, unless it would grow beyond every use. Counts its work.
pub(crate) fn checked_sum(a: &RationalFunction, sign: Sign, b: &RationalFunction) -> Option<RationalFunction> {
    let fits = fits(a.numerator(), b.denominator())
        && fits(b.numerator(), a.denominator())
        && fits(a.denominator(), b.denominator());
    count_work(a, b);
    fits.then(|| if sign == Sign::Plus { a + b } else { a - b })
}

/// `a b`, unless it would grow beyond every use. Counts its work.
pub(crate) fn checked_product(a: &RationalFunction, b: &RationalFunction) -> Option<RationalFunction> {
    let fits = fits(a.numerator(), b.numerator()) && fits(a.denominator(), b.denominator());
    count_work(a, b);
    fits.then(|| a * b)
}

impl Meaning for Scope<'_> {
    type Value = RationalFunction;

    fn number(&mut self, value: &Rational) -> Result<RationalFunction, Failure> {
        self.budget.check()?;
        Ok(value.into())
    }

    fn name(&mut self, name: &str, span: Span) -> Result<RationalFunction, Failure> {
        self.budget.check()?;
        match self.values.get(name) {
            Some(Some(value)) => Ok(value.clone()),
            Some(None) => Err(Failure::Poisoned),
            None if name == PI => Ok(self.variable(Variable::Pi)),
            None if name == UNIT => Ok(self.imaginary_unit()),
            None => {
                let message = format!("unknown name '{}'", crate::text::names::shorten(name));
                Err(Diagnostic::error(Code::UnknownName, message).at(span, "not defined").into())
            }
        }
    }

    fn negative(&mut self, value: RationalFunction) -> Result<RationalFunction, Failure> {
        Ok(-value)
    }

    fn sum(
        &mut self,
        a: RationalFunction,
        sign: Sign,
        b: RationalFunction,
        span: Span,
    ) -> Result<RationalFunction, Failure> {
        checked_sum(&a, sign, &b).ok_or_else(|| too_large(span))
    }

    fn product(&mut self, a: RationalFunction, b: RationalFunction, span: Span) -> Result<RationalFunction, Failure> {
        checked_product(&a, &b).and_then(|value| self.reduced(value)).ok_or_else(|| too_large(span))
    }

    fn quotient(&mut self, a: RationalFunction, b: RationalFunction, span: Span) -> Result<RationalFunction, Failure> {
        if self.is_hidden_zero(&b)? {
            return Err(division_by_zero(span));
        }
        let inverse = b.recip().ok_or_else(|| division_by_zero(span))?;
        self.divides_by(vec![b.numerator().clone()]);
        checked_product(&a, &inverse).and_then(|value| self.reduced(value)).ok_or_else(|| too_large(span))
    }

    fn power(&mut self, base: RationalFunction, exponent: i64, span: Span) -> Result<RationalFunction, Failure> {
        if exponent < 0 {
            if base.is_zero() || self.is_hidden_zero(&base)? {
                return Err(division_by_zero(span));
            }
            self.divides_by(vec![base.numerator().clone()]);
        }
        let power = base.pow(exponent).ok_or_else(|| too_large(span))?;
        count_work(&power, &base);
        self.reduced(power).ok_or_else(|| division_by_zero(span))
    }

    fn call(&mut self, function: Function, value: RationalFunction, span: Span) -> Result<RationalFunction, Failure> {
        Scope::call(self, function, value, span)
    }
}
