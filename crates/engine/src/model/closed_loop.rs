//! From a loop and a question to polynomials and matrices.

use super::connect::state_space::{Stop, assemble};
use super::definition::{Loop, Time};
use super::evaluate::scalar::{Scope, Symbol};
use super::evaluate::symbolic::{Values, Wiring, symbolic};
use super::evaluate::walk::Failure;
use super::question::{ModelError, Question, Resolved};
use super::text::names::{did_you_mean, known_names, shorten};
use crate::error::{Diagnostic, Error};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};

/// A closed loop in state space: `x' = A x + E r`, `y = C x + D r`, where `x'` is the next sample
/// or the derivative.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClosedLoop {
    /// The kept parameters: variables 0, 1, ... of all entries.
    pub variables: Vec<String>,
    /// Discrete or continuous.
    pub time: Time,
    /// The closed-loop matrix A, n x n.
    pub a: RationalMatrix,
    /// How the inputs enter: E, n x inputs.
    pub e: RationalMatrix,
    /// The outputs: C, outputs x n.
    pub c: RationalMatrix,
    /// From inputs to outputs at once: D, outputs x inputs.
    pub d: RationalMatrix,
    /// Names of the states.
    pub states: Vec<String>,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// The loop is undefined where one of these is zero.
    pub poles: Vec<MultiPoly>,
}

/// A transfer function of the closed loop as it stands: nothing is cancelled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TransferFunction {
    /// Coefficients of the numerator from the constant term up, as many as the denominator has.
    pub numerator: Vec<RationalFunction>,
    /// The characteristic polynomial.
    pub denominator: CharacteristicPolynomial,
}

/// The evaluated model with values set for what is not kept.
struct Answer<'m> {
    wiring: Wiring<'m>,
    values: Values,
    /// For each variable of `values`, its value; `None` for the kept ones.
    set: Vec<Option<Rational>>,
    /// For each variable of `values`, its number among the kept ones.
    numbers: Vec<usize>,
    kept: Vec<String>,
    poles: Vec<MultiPoly>,
    sample_time: Option<RationalFunction>,
}

impl Answer<'_> {
    fn substituted(&self, f: &RationalFunction) -> Option<RationalFunction> {
        let mut f = f.clone();
        for i in f.variables() {
            if let Some(Some(value)) = self.set.get(i) {
                f = f.substitute(i, value)?;
            }
        }
        f.map_variables(|i| self.numbers[i])
    }

    fn substituted_polynomial(&self, p: &MultiPoly) -> MultiPoly {
        let mut p = p.clone();
        for i in p.variables() {
            if let Some(Some(value)) = self.set.get(i) {
                p = p.substitute(i, value).0;
            }
        }
        p.map_variables(|i| self.numbers[i])
    }
}

impl Loop {
    /// The characteristic polynomial, symbolic in the kept names.
    ///
    /// Matrices and blocks give `det(zI - A)` of the closed loop, monic, with every mode; a
    /// `characteristic` stays as it is written. The formal degree is that with all parameters
    /// symbolic, before any was set.
    ///
    /// # Errors
    /// [`ModelError`]: a wrong question, values for which the model is undefined, or a budget that ran out.
    pub fn characteristic_polynomial(
        &self,
        question: &Question,
        budget: &Budget,
    ) -> Result<CharacteristicPolynomial, ModelError> {
        let answer = self.answer(question, budget)?;
        if let Values::Characteristic(p) = &answer.values {
            let undefined = || ModelError::Undefined("a coefficient divides by zero".into());
            let mut coefficients = Vec::with_capacity(p.coefficients().len());
            for c in p.coefficients() {
                coefficients.push(answer.substituted(c).ok_or_else(undefined)?);
            }
            let formal_degree = p.degree();
            if coefficients.is_empty() {
                coefficients.push(RationalFunction::zero());
            }
            return Ok(CharacteristicPolynomial {
                variables: answer.kept,
                coefficients,
                formal_degree,
                poles: answer.poles,
                monic: false,
            });
        }
        self.connected(answer, budget)?.characteristic_polynomial(budget)
    }

    /// The closed loop in state space, with entries in the kept names.
    ///
    /// # Errors
    /// As [`Loop::characteristic_polynomial`]; `E-no-states` for the form `characteristic`.
    pub fn closed_loop(&self, question: &Question, budget: &Budget) -> Result<ClosedLoop, ModelError> {
        let answer = self.answer(question, budget)?;
        if matches!(answer.values, Values::Characteristic(_)) {
            let error =
                Diagnostic::error("E-no-states", "a model given by its characteristic polynomial has no states");
            let error = error.help("give the loop by matrices or blocks");
            return Err(Error::new(Some(self.source().clone()), vec![error]).into());
        }
        self.connected(answer, budget)
    }

    /// The transfer function from an input to an output of the closed loop.
    ///
    /// # Errors
    /// As [`Loop::closed_loop`]; `E-unknown-signal`.
    pub fn transfer_function(
        &self,
        input: &str,
        output: &str,
        question: &Question,
        budget: &Budget,
    ) -> Result<TransferFunction, ModelError> {
        let closed_loop = self.closed_loop(question, budget)?;
        let find = |names: &[String], name: &str, what: &str| {
            names.iter().position(|n| n == name).ok_or_else(|| {
                let message = format!("the loop has no {what} '{}'", shorten(name));
                let mut error = Diagnostic::error("E-unknown-signal", message);
                let names = || names.iter().map(String::as_str);
                error.help = did_you_mean(name, names()).or_else(|| known_names(names()));
                ModelError::Input(Error::new(Some(self.source().clone()), vec![error]))
            })
        };
        let j = find(&closed_loop.inputs, input, "input")?;
        let i = find(&closed_loop.outputs, output, "output")?;
        closed_loop.transfer_function(i, j, budget)
    }

    /// The sample time as a function of the kept names; `None` when the model has none.
    ///
    /// # Errors
    /// As [`Loop::characteristic_polynomial`].
    pub fn sample_time(&self, question: &Question, budget: &Budget) -> Result<Option<RationalFunction>, ModelError> {
        let answer = self.answer(question, budget)?;
        match &answer.sample_time {
            None => Ok(None),
            Some(value) => match answer.substituted(value) {
                Some(value) => Ok(Some(value)),
                None => Err(ModelError::Undefined("the sample time divides by zero".into())),
            },
        }
    }

    fn answer(&self, question: &Question, budget: &Budget) -> Result<Answer<'_>, ModelError> {
        let Resolved { kept, values: given, .. } = self.resolve(question)?;
        let mut failures = Vec::new();
        let mut report = |failure| failures.push(failure);
        let kept_constant = |name: &str| question.keep.iter().any(|k| k == name).then_some(Symbol::Variable);
        // Parameters stay symbolic until everything is evaluated: only so the degree and the points of
        // division by zero do not depend on the values set. A constant that is set has another number.
        let symbol = |name: &str, constant: bool| match question.set.get(name) {
            _ if !constant => Some(Symbol::Variable),
            Some(value) => Some(Symbol::Value(value.clone())),
            None => kept_constant(name),
        };
        let mut scope = Scope::new(self.parameters().iter(), self.ordered_constants(), symbol, budget, &mut report);
        let wiring = Wiring::of(self);
        let values = symbolic(self, &wiring, &mut scope, &mut report);
        let sample_time = match self.sample_time_expression() {
            Some(e) => scope.scalar(e).map_err(&mut report).ok(),
            None => None,
        };
        let (Some(values), true) = (values, failures.is_empty()) else { return Err(self.failed(failures)) };
        let value = |name: &String| given.iter().find(|(n, _)| n == name).map(|(_, v)| v.clone());
        let set: Vec<Option<Rational>> = scope.variables.iter().map(value).collect();
        let number = |name: &String| kept.iter().position(|k| k == name).unwrap_or(0);
        let numbers = scope.variables.iter().map(number).collect();
        let mut answer = Answer { wiring, values, set, numbers, kept, poles: Vec::new(), sample_time };
        let divisors = std::mem::take(&mut scope.divisors);
        for divisor in divisors {
            budget.check()?;
            let parts: Vec<MultiPoly> = divisor.iter().map(|p| answer.substituted_polynomial(p)).collect();
            let pole = parts.iter().fold(MultiPoly::zero(), |g, p| g.gcd(p));
            if pole.is_zero() {
                return Err(ModelError::Undefined("division by zero at these values of the parameters".into()));
            }
            add_pole(&mut answer.poles, &pole);
        }
        Ok(answer)
    }

    fn failed(&self, failures: Vec<Failure>) -> ModelError {
        let mut diagnostics = Vec::new();
        for failure in failures {
            match failure {
                Failure::Exhausted(exhausted) => return ModelError::Exhausted(exhausted),
                Failure::Wrong(diagnostic) => diagnostics.push(*diagnostic),
                Failure::Poisoned => {}
            }
        }
        if diagnostics.is_empty() {
            diagnostics.push(Diagnostic::error("E-missing", "the model is not complete"));
        }
        diagnostics.dedup();
        ModelError::Input(Error::new(Some(self.source().clone()), diagnostics))
    }

    fn connected(&self, answer: Answer<'_>, budget: &Budget) -> Result<ClosedLoop, ModelError> {
        let substitution = |f: &RationalFunction| answer.substituted(f);
        let assembled = match assemble(self, &answer.wiring, &answer.values, &substitution, budget) {
            Ok(assembled) => assembled,
            Err(Stop::Exhausted(exhausted)) => return Err(exhausted.into()),
            Err(Stop::Undefined(diagnostic)) => return Err(ModelError::Undefined(diagnostic.message)),
        };
        let mut poles = answer.poles;
        for pole in &assembled.poles {
            add_pole(&mut poles, pole);
        }
        Ok(ClosedLoop {
            variables: answer.kept,
            time: self.time(),
            a: assembled.system.a,
            e: assembled.system.b,
            c: assembled.system.c,
            d: assembled.system.d,
            states: assembled.states,
            inputs: answer.wiring.inputs.iter().map(|s| (*s).to_owned()).collect(),
            outputs: self.outputs().iter().map(|o| o.name.name.clone()).collect(),
            poles,
        })
    }
}

fn add_pole(poles: &mut Vec<MultiPoly>, pole: &MultiPoly) {
    let pole = pole.primitive_over_integers();
    if !pole.is_constant() && !poles.contains(&pole) {
        poles.push(pole);
    }
}

impl ClosedLoop {
    /// `det(zI - A)`.
    ///
    /// # Errors
    /// [`ModelError::Exhausted`].
    pub fn characteristic_polynomial(&self, budget: &Budget) -> Result<CharacteristicPolynomial, ModelError> {
        let mut p = self.a.characteristic_polynomial(self.variables.clone(), budget)?;
        let mut poles = self.poles.clone();
        p.poles.iter().for_each(|pole| add_pole(&mut poles, pole));
        p.poles = poles;
        Ok(p)
    }

    /// The transfer function from input `j` to output `i`, nothing cancelled.
    ///
    /// By the matrix determinant lemma the numerator is `det(zI - A + e c) - det(zI - A) + d det(zI - A)`
    /// with `e` the column of the input and `c`, `d` the row of the output: it equals
    /// `c adj(zI - A) e + d det(zI - A)`.
    ///
    /// # Errors
    /// [`ModelError::Exhausted`].
    ///
    /// # Panics
    /// When there is no such input or output.
    pub fn transfer_function(&self, i: usize, j: usize, budget: &Budget) -> Result<TransferFunction, ModelError> {
        let denominator = self.characteristic_polynomial(budget)?;
        let n = self.a.rows();
        let changed = RationalMatrix::from_fn(n, n, |r, k| &self.a[(r, k)] - &(&self.e[(r, j)] * &self.c[(i, k)]));
        let other = changed.characteristic_polynomial(self.variables.clone(), budget)?;
        let direct = &self.d[(i, j)];
        let pairs = other.coefficients.iter().zip(&denominator.coefficients);
        let numerator = pairs.map(|(b, a)| &(b - a) + &(direct * a)).collect();
        Ok(TransferFunction { numerator, denominator })
    }
}
