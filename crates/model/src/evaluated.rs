//! From a loop and a question to polynomials and matrices.

use super::closed_loop::ClosedLoop;
use super::complex::{ComplexPolynomial, names_of_parts, names_of_wholes, unlifted};
use super::connect::state_space::{Connecting, NotConnected, assemble};
use super::definition::Model;
use super::evaluate::scalar::{Scope, Symbol, Variable};
use super::evaluate::symbolic::symbolic;
use super::evaluate::values::{Values, Wiring};
use super::evaluate::walk::Failure as Wrong;
use super::steady::SteadyDuty;
use super::symbols::{Definition, Symbols};
use super::text::Expression;
use crate::error::{Code, Diagnostic, Diagnostics, Error};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use std::cell::RefCell;

/// A model evaluated with values for everything that is not kept.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Evaluated {
    /// The characteristic polynomial, symbolic in the kept names. Of a complex loop it is `D conj(D)`, of twice the order.
    pub polynomial: CharacteristicPolynomial,
    /// The characteristic polynomial `D` itself where it is complex.
    pub complex: Option<ComplexPolynomial>,
    /// The closed loop in state space; `None` for the form `characteristic`.
    pub closed_loop: Option<ClosedLoop>,
    /// The sample time as a function of the kept names; `None` when the model has none or it divides by zero.
    pub sample_time: Option<RationalFunction>,
    /// What the variables beyond the kept names stand for; none where everything is rational.
    pub symbols: Symbols,
}

impl Evaluated {
    /// The closed loop with its characteristic polynomial.
    pub(super) fn of(
        closed_loop: ClosedLoop,
        sample_time: Option<RationalFunction>,
        symbols: Symbols,
        budget: &Budget,
    ) -> Result<Evaluated, Error> {
        let (mut polynomial, complex) = closed_loop.real_polynomial(&symbols, budget)?;
        polynomial.poles = polynomial.poles.iter().filter_map(|pole| pole_beside(pole, &symbols)).collect();
        let closed_loop = Some(closed_loop);
        Ok(Evaluated { polynomial, complex, closed_loop, sample_time, symbols }.without_unused_symbols())
    }

    /// The same without symbols where none occurs: then everything is rational.
    pub(super) fn without_unused_symbols(mut self) -> Evaluated {
        let first = self.symbols.first();
        let is_free = |f: &RationalFunction| f.variables().last().is_none_or(|last| *last < first);
        let p = &self.polynomial;
        let closed_loop = self.closed_loop.iter();
        let mut entries = closed_loop.flat_map(|l| [&l.a, &l.e, &l.c, &l.d]).flat_map(|m| m.entries());
        let complex = self.complex.iter().flat_map(|d| d.re.iter().chain(&d.im));
        let is_rational = p.coefficients.iter().all(is_free)
            && complex.into_iter().all(is_free)
            && p.poles.iter().all(|pole| pole.variables().last().is_none_or(|last| *last < first))
            && entries.all(is_free)
            && self.sample_time.iter().all(is_free);
        drop(entries);
        if is_rational && !self.symbols.is_empty() && !self.symbols.has_moving_root() {
            self.polynomial.variables.truncate(first);
            if let Some(closed_loop) = &mut self.closed_loop {
                closed_loop.variables.truncate(first);
            }
            self.symbols = self.symbols.cleared();
        }
        self
    }
}

/// The expressions of the model with values set for what is not kept.
pub(super) struct Answer<'m> {
    pub wiring: Wiring<'m>,
    pub values: Values,
    /// For each variable of `values`, what it is in kept names and symbols: a number, a variable, or a function of both.
    pub images: Vec<RationalFunction>,
    pub symbols: RefCell<Symbols>,
    pub poles: Vec<MultiPoly>,
    /// The time from one state to the next: of a loop with several rates its hyperperiod.
    pub sample_time: Option<RationalFunction>,
    /// At which sample a hyperperiod begins, where that matters.
    pub start: Option<u64>,
}

impl Answer<'_> {
    pub fn substituted(&self, f: &RationalFunction) -> Option<RationalFunction> {
        substituted(f, &self.images)
    }

    /// A polynomial that is zero where the image of `p` is.
    fn substituted_polynomial(&self, p: &MultiPoly) -> Option<MultiPoly> {
        Some(self.substituted(&p.clone().into())?.numerator().clone())
    }
}

/// A function with these images in the place of its variables. Numbers are put in first: they make it smaller.
pub(super) fn substituted(f: &RationalFunction, images: &[RationalFunction]) -> Option<RationalFunction> {
    let mut f = f.clone();
    for i in f.variables() {
        if let Some(value) = images[i].as_constant() {
            f = f.substitute(i, &value)?;
        }
    }
    let variables = f.variables();
    let number = |i: usize| match images[i].variables().as_slice() {
        [j] if images[i] == RationalFunction::variable(*j) => Some(*j),
        _ => None,
    };
    if variables.iter().all(|&i| number(i).is_some()) {
        return f.map_variables(|i| number(i).unwrap_or(i));
    }
    f.compose(images)
}

impl Model {
    /// The characteristic polynomial, closed loop and sample time, symbolic in the kept names, which become the variables
    /// 0, 1, ...; `values` has the value of every other parameter and may replace the number of constants.
    ///
    /// Matrices and blocks give `det(zI - A)` of the closed loop, monic, with every mode; a `characteristic` stays as it is
    /// written. The formal degree is that with all parameters symbolic, before any was set.
    ///
    /// Cost: each expression is evaluated once, all parameters symbolic, which is the part that grows with their
    /// number; then every coefficient is a rational function into which the values are put. For matrices and blocks
    /// there follows [`ClosedLoop::characteristic_polynomial`].
    ///
    /// # Errors
    /// [`Error::Undefined`] at values for which the model is undefined whatever is kept, [`Error::Stopped`] when the
    /// budget runs out, [`Error::Refused`] where the model is not complete.
    pub fn evaluate(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Evaluated, Error> {
        self.evaluate_near(kept, values, &[], budget)
    }

    /// The same where dead times that vary against the sample time of their hold have as many whole samples as near these
    /// values of the kept names: what is found holds from one whole number of samples to the next.
    ///
    /// Cost: that of [`Model::evaluate`].
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn evaluate_near(
        &self,
        kept: &[String],
        values: &[(String, Rational)],
        near: &[Rational],
        budget: &Budget,
    ) -> Result<Evaluated, Error> {
        let mut answer = self.answer(kept, values, budget)?;
        answer.symbols = RefCell::new(answer.symbols.into_inner().near(near));
        if let Values::Characteristic(_) = &answer.values {
            return answer.given_polynomial();
        }
        let (closed_loop, sample_time, symbols) = self.connected(answer, budget)?;
        Evaluated::of(closed_loop, sample_time, symbols, budget)
    }

    /// The value of an expression. All its constants and parameters have values.
    ///
    /// Cost: an operation on rational functions for each operator of the expression and of the model's constants.
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::problem::Ask;
    /// use jurist_model::{Expression, Model};
    /// let drive = Model::drive();
    /// let problem = drive.ask().problem().unwrap();
    /// let inductance = Expression::parse("1/L_a").unwrap();
    /// let value = drive.value(&inductance, problem.set(), &Budget::unlimited()).unwrap();
    /// assert_eq!(value.to_string(), "500/23");
    /// ```
    pub fn value(
        &self,
        expression: &Expression,
        values: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Rational, Error> {
        let mut failures = Vec::new();
        let mut report = |failure| failures.push(failure);
        let given = |name: &str| values.iter().find(|(n, _)| n == name).map(|(_, value)| value.clone());
        let symbol = |name: &str, _: bool| given(name).map(Symbol::Value);
        let mut scope = Scope::new(self.parameters().iter(), self.ordered_constants(), symbol, budget, &mut report);
        let value = scope.scalar(expression).map_err(&mut report).ok();
        let Some(value) = value.filter(|_| failures.is_empty()) else { return Err(self.failed(failures)) };
        if let Some(number) = value.as_constant() {
            return Ok(number);
        }
        let named = |i: usize| matches!(scope.variables[i], Variable::Named(_));
        if value.variables().into_iter().all(named) {
            return Err(Error::Undefined("a parameter has no value".into()));
        }
        let error = Diagnostic::error(Code::Function, "a rational number is needed here");
        let error = error.at(expression.span, "not rational").help("write as many digits of it as you mean");
        Err(Diagnostics::new(Some(self.source().clone()), vec![error]).into())
    }

    /// Evaluates each expression with all parameters symbolic, as every question does.
    ///
    /// Cost: that part of [`Model::evaluate`].
    ///
    /// # Errors
    /// [`Error::Refused`] for all expressions that have no value, such as one that becomes too large; else as [`Model::evaluate`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_model::Model;
    /// use jurist_model::error::{Code, Error, Source};
    /// let text = "time = 'discrete'\nparameters = { K = {}, b = {} }\nloop.characteristic = '((z + K + b)^100)^100'\n";
    /// // To be read takes little work: what is large is looked at in the end.
    /// let (model, _) = Model::from_toml(&Source::new("model.toml", text))?;
    /// let Err(Error::Refused(refused)) = model.check_expressions(&Budget::unlimited()) else { panic!() };
    /// assert_eq!(refused.code(), Code::TooLarge);
    /// # Ok::<(), jurist_model::error::Diagnostics>(())
    /// ```
    pub fn check_expressions(&self, budget: &Budget) -> Result<(), Error> {
        let kept: Vec<String> = self.parameters().iter().map(|p| p.name.clone()).collect();
        let duty = || Err(Error::Undefined("no duty ratio is asked for".into()));
        budget.enter(|| self.answer_with(&kept, &[], &duty, budget).map(drop))?
    }

    /// That a model given by its characteristic polynomial has no states.
    pub fn has_no_states(&self) -> Error {
        let error = Diagnostic::error(Code::NoStates, "a model given by its characteristic polynomial has no states");
        let error = error.help("give the loop by matrices or blocks");
        Diagnostics::new(Some(self.source().clone()), vec![error]).into()
    }

    pub(super) fn answer(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<Answer<'_>, Error> {
        self.answer_with(kept, given, &|| self.steady_duty(kept, given, budget), budget)
    }

    /// The same with this duty ratio of the loop at rest, where one is asked for.
    pub(super) fn answer_with(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        duty: &dyn Fn() -> Result<SteadyDuty, Error>,
        budget: &Budget,
    ) -> Result<Answer<'_>, Error> {
        let mut failures = Vec::new();
        let mut report = |failure| failures.push(failure);
        let mut scope = self.scope(kept, given, budget, &mut report);
        let mut wiring = Wiring::of(self);
        let values = symbolic(self, &mut wiring, &mut scope, &mut report);
        let sample_time = match self.sample_time_expression() {
            Some(e) => scope.scalar(e).map_err(&mut report).ok(),
            None => None,
        };
        let (Some(values), true) = (values, failures.is_empty()) else { return Err(self.failed(failures)) };
        let (images, symbols) = Model::images(&scope.variables, kept, given, duty)?;
        let symbols = RefCell::new(symbols);
        let steps = RationalFunction::from(Rational::from(self.hyperperiod() as i64));
        let sample_time = sample_time.map(|time| &time * &steps);
        let mut answer = Answer { wiring, values, images, symbols, poles: Vec::new(), sample_time, start: None };
        let divisors = std::mem::take(&mut scope.divisors);
        for divisor in divisors {
            budget.check()?;
            let parts: Option<Vec<MultiPoly>> = divisor.iter().map(|p| answer.substituted_polynomial(p)).collect();
            let pole = parts.unwrap_or_default().iter().fold(MultiPoly::zero(), |g, p| g.gcd(p));
            if pole.is_zero() {
                return Err(Error::Undefined("division by zero at these values of the parameters".into()));
            }
            add_pole(&mut answer.poles, &pole);
        }
        Ok(answer)
    }

    /// Parameters stay symbolic until everything is evaluated: only so the degree and the points of division by zero do not depend
    /// on the values set. A constant that is set has another number.
    pub(super) fn scope<'a>(
        &'a self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &'a Budget,
        report: &mut dyn FnMut(Wrong),
    ) -> Scope<'a> {
        let symbol = |name: &str, constant: bool| match given.iter().find(|(n, _)| n == name) {
            _ if !constant => Some(Symbol::Variable),
            Some((_, value)) => Some(Symbol::Value(value.clone())),
            None => kept.iter().any(|k| k == name).then_some(Symbol::Variable),
        };
        Scope::new(self.parameters().iter(), self.ordered_constants(), symbol, budget, report)
    }

    /// What each variable of the values is in kept names and symbols.
    pub(super) fn images(
        variables: &[Variable],
        kept: &[String],
        given: &[(String, Rational)],
        duty: &dyn Fn() -> Result<SteadyDuty, Error>,
    ) -> Result<(Vec<RationalFunction>, Symbols), Error> {
        let mut symbols = Symbols::new(kept);
        let mut images: Vec<RationalFunction> = Vec::with_capacity(variables.len());
        for variable in variables {
            images.push(match variable {
                Variable::Named(name) => match kept.iter().position(|k| k == name) {
                    Some(i) => RationalFunction::variable(i),
                    None => {
                        let value = given.iter().find(|(n, _)| n == name).map(|(_, value)| value.clone());
                        value.map(RationalFunction::from).unwrap_or_else(|| RationalFunction::variable(0))
                    }
                },
                Variable::Pi => symbols.pi(),
                // No value has it any more.
                Variable::Unit => RationalFunction::zero(),
                Variable::Call(function, argument) => {
                    let undefined = || Error::Undefined(format!("'{}' has no value there", function.name()));
                    let argument = substituted(argument, &images).ok_or_else(undefined)?;
                    symbols.call(*function, argument).ok_or_else(undefined)?
                }
                Variable::TangentOfRule(angle) => {
                    let undefined = || Error::Undefined("the factor of a prewarped rule has no value there".into());
                    let angle = substituted(angle, &images).ok_or_else(undefined)?;
                    symbols.tangent_of_a_rule(angle).ok_or_else(undefined)?
                }
                Variable::Duty => match duty()? {
                    SteadyDuty::Any => RationalFunction::zero(),
                    SteadyDuty::Number(number) => symbols.enclosed_number(number),
                    SteadyDuty::Moving(found) => {
                        let undefined = || Error::Undefined("the duty ratio of the orbit has no value there".into());
                        let own = symbols.import(&found.1).ok_or_else(undefined)?;
                        symbols.duty(found.0.with(|f| f.compose(&own)).ok_or_else(undefined)?)
                    }
                },
                Variable::Delay(time) => {
                    let undefined = || Error::Undefined("a dead time has no value there".into());
                    let time = substituted(time, &images).ok_or_else(undefined)?;
                    match time.as_constant() {
                        Some(x) if x.is_negative() => {
                            return Err(Error::Undefined(format!("a dead time is negative there: {x}")));
                        }
                        Some(x) if x.is_zero() => RationalFunction::one(),
                        _ => symbols.delay(time),
                    }
                }
            });
        }
        Ok((images, symbols))
    }

    fn failed(&self, failures: Vec<Wrong>) -> Error {
        let mut diagnostics = Vec::new();
        for failure in failures {
            match failure {
                Wrong::Exhausted(exhausted) => return Error::Stopped(exhausted),
                Wrong::Wrong(diagnostic) => diagnostics.push(*diagnostic),
                Wrong::Poisoned => {}
            }
        }
        if diagnostics.is_empty() {
            diagnostics.push(Diagnostic::error(Code::Missing, "the model is not complete"));
        }
        diagnostics.dedup();
        Error::Refused(Diagnostics::new(Some(self.source().clone()), diagnostics))
    }

    /// Why there is no closed loop, with the model's text.
    pub(super) fn not_connected(&self, why: NotConnected) -> Error {
        match why {
            NotConnected::Exhausted(exhausted) => exhausted.into(),
            NotConnected::Undefined(diagnostic) => Error::Undefined(diagnostic.message),
            NotConnected::Refused(diagnostic) => {
                Diagnostics::new(Some(self.source().clone()), vec![*diagnostic]).into()
            }
        }
    }

    pub(super) fn connected(
        &self,
        answer: Answer<'_>,
        budget: &Budget,
    ) -> Result<(ClosedLoop, Option<RationalFunction>, Symbols), Error> {
        let outputs = self.outputs().iter().map(|o| o.name.name.clone()).collect();
        self.connected_with(answer, outputs, budget)
    }

    /// The connected system, its outputs called so, with its sample time and what its variables stand for.
    pub(super) fn connected_with(
        &self,
        answer: Answer<'_>,
        outputs: Vec<String>,
        budget: &Budget,
    ) -> Result<(ClosedLoop, Option<RationalFunction>, Symbols), Error> {
        let substitution = |f: &RationalFunction| answer.substituted(f);
        let symbols = Some(&answer.symbols);
        let how = Connecting { set: &substitution, symbols, start: answer.start, budget };
        let mut assembled =
            assemble(self, &answer.wiring, &answer.values, &how).map_err(|why| self.not_connected(why))?;
        let (mut inputs, mut outputs, mut is_complex) = (answer.wiring.inputs.clone(), outputs, false);
        if answer.wiring.is_complex {
            outputs = names_of_parts(outputs);
            match unlifted(&assembled.system) {
                Some(system) => {
                    assembled.system = system;
                    for names in [&mut assembled.states, &mut inputs, &mut outputs] {
                        *names = names_of_wholes(names);
                    }
                }
                None => is_complex = true,
            }
        }
        let mut poles = answer.poles.clone();
        for pole in &assembled.poles {
            add_pole(&mut poles, pole);
        }
        let sample_time = answer.sample_time.as_ref().and_then(|t| answer.substituted(t));
        let (symbols, images) = merged(&answer.symbols.into_inner())?;
        let undefined = || Error::Undefined("division by zero".into());
        let matrix = |m: &RationalMatrix| -> Result<RationalMatrix, Error> {
            if symbols.is_empty() {
                return Ok(m.clone());
            }
            m.try_map(|f| substituted(f, &images).ok_or_else(undefined))
        };
        let system = &assembled.system;
        let closed_loop = ClosedLoop {
            variables: symbols.variables(),
            time: self.time(),
            a: matrix(&system.a)?,
            e: matrix(&system.b)?,
            c: matrix(&system.c)?,
            d: matrix(&system.d)?,
            states: assembled.states,
            inputs,
            outputs,
            poles: poles_in(&poles, &symbols, &images)?,
            leading: substituted(&assembled.leading, &images).unwrap_or_else(RationalFunction::one),
            is_complex,
        };
        Ok((closed_loop, sample_time.and_then(|t| substituted(&t, &images)), symbols))
    }
}

/// The symbols without relations between powers and multiple angles.
pub(super) fn merged(symbols: &Symbols) -> Result<(Symbols, Vec<RationalFunction>), Error> {
    symbols.merged().ok_or_else(|| Error::Undefined("a function has no value there".into()))
}

/// The poles in merged symbols, without factors that have no zero.
pub(super) fn poles_in(
    poles: &[MultiPoly],
    symbols: &Symbols,
    images: &[RationalFunction],
) -> Result<Vec<MultiPoly>, Error> {
    let mut out = Vec::new();
    for pole in poles {
        let image = substituted(&pole.clone().into(), images).filter(|f| !f.is_zero());
        let image = image.ok_or_else(|| Error::Undefined("division by zero".into()))?;
        if let Some(pole) = pole_beside(image.numerator(), symbols) {
            add_pole(&mut out, &pole);
        }
    }
    Ok(out)
}

/// A pole without the factors in symbols that have no zero; `None` when nothing else is left.
fn pole_beside(pole: &MultiPoly, symbols: &Symbols) -> Option<MultiPoly> {
    if symbols.is_empty() {
        return Some(pole.clone());
    }
    // For a function of s to divide by zero, all coefficients of the delays have to vanish.
    let content = |p: &MultiPoly, i: usize| p.as_poly_in(i).coeffs().iter().fold(MultiPoly::zero(), |g, c| g.gcd(c));
    let mut rest = symbols.delays().iter().fold(pole.clone(), |rest, (i, _)| content(&rest, *i));
    let exponentials =
        symbols.iter().enumerate().filter(|(_, s)| matches!(s.definition(), Some(Definition::Exponential(_))));
    let exponentials = exponentials.map(|(i, _)| MultiPoly::variable(symbols.first() + i));
    for factor in symbols.nonzero().iter().cloned().chain(exponentials) {
        while let Some(quotient) = rest.div_exact(&factor) {
            rest = quotient;
        }
    }
    (!rest.is_constant()).then(|| rest.primitive_over_integers())
}

pub(super) fn add_pole(poles: &mut Vec<MultiPoly>, pole: &MultiPoly) {
    let pole = pole.primitive_over_integers();
    if !pole.is_constant() && !poles.contains(&pole) {
        poles.push(pole);
    }
}
