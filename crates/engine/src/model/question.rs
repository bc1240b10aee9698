//! What is asked of a loop: which names stay symbolic and which values the others take.

use super::definition::{Constant, Loop, Parameter};
use super::text::names::{did_you_mean, known_names, list, shorten};
use crate::error::{Diagnostic, Error};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use std::collections::BTreeMap;
use std::fmt;

/// The names that stay symbolic, and values for others.
///
/// A parameter that is neither kept nor set takes its nominal value; one that is set keeps its part in
/// the degree that counts and in the points of division by zero, which are those of the model with all
/// parameters symbolic.
///
/// A constant that is given as a number can be kept or set too. Set, it has another number and nothing
/// else changes: the answer is that of a model file with this number in it. Kept, it is freed: a parameter with
/// its number as nominal value and an unbounded domain, symbolic like every other parameter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Question {
    /// The names that stay symbolic: variables 0, 1, ... of the answer.
    pub keep: Vec<String>,
    /// Values that replace the nominal ones.
    pub set: BTreeMap<String, Rational>,
}

impl Question {
    /// Keeps these names, everything else nominal.
    pub fn keeping<S: Into<String>>(names: impl IntoIterator<Item = S>) -> Self {
        Question { keep: names.into_iter().map(Into::into).collect(), set: BTreeMap::new() }
    }

    /// The same with a value for one more name.
    pub fn with(mut self, name: impl Into<String>, value: impl Into<Rational>) -> Self {
        self.set.insert(name.into(), value.into());
        self
    }
}

/// A question whose every name is known and has its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resolved {
    /// The names that stay symbolic.
    pub kept: Vec<String>,
    /// The value of every other parameter, and of every constant that was set, in the order of the
    /// model.
    pub values: Vec<(String, Rational)>,
    /// Values outside their domains.
    pub warnings: Vec<Diagnostic>,
}

/// Why a question has no polynomial for an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelError {
    /// The question or the model is wrong.
    Input(Error),
    /// The model is undefined for the values set, whatever the kept parameters are.
    Undefined(String),
    /// The budget ran out.
    Exhausted(Exhausted),
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModelError::Input(error) => error.fmt(f),
            ModelError::Undefined(what) => write!(f, "the model is undefined here: {what}"),
            ModelError::Exhausted(exhausted) => exhausted.fmt(f),
        }
    }
}

impl std::error::Error for ModelError {}

impl From<Error> for ModelError {
    fn from(error: Error) -> Self {
        ModelError::Input(error)
    }
}

impl From<Exhausted> for ModelError {
    fn from(exhausted: Exhausted) -> Self {
        ModelError::Exhausted(exhausted)
    }
}

impl Loop {
    /// Names and numbers a question, with warnings for values outside their domains.
    ///
    /// # Errors
    /// `E-unknown-parameter`, `E-not-a-number` (a constant given by a formula), `E-kept-and-set`,
    /// `E-kept-twice`, `E-no-value`; all that apply.
    pub fn resolve(&self, question: &Question) -> Result<Resolved, Error> {
        let mut errors = Vec::new();
        let mut warnings = Vec::new();
        for name in question.keep.iter().chain(question.set.keys()) {
            errors.extend(self.not_free(name));
        }
        for (i, name) in question.keep.iter().enumerate() {
            let shown = shorten(name);
            if question.keep[..i].contains(name) {
                errors.push(Diagnostic::error("E-kept-twice", format!("'{shown}' is asked for twice")));
            } else if question.set.contains_key(name) {
                let error = Diagnostic::error("E-kept-and-set", format!("'{shown}' is both kept symbolic and set"));
                errors.push(error.help("leave out one of the two"));
            }
        }
        let mut values = Vec::new();
        for parameter in self.parameters().iter().filter(|p| !question.keep.contains(&p.name)) {
            match question.set.get(&parameter.name) {
                Some(value) => {
                    if !parameter.contains(value) {
                        let message = format!("{} = {value} is outside its domain", parameter.name);
                        warnings.push(Diagnostic::warning("W-outside-domain", message));
                    }
                    values.push((parameter.name.clone(), value.clone()));
                }
                None => match &parameter.nominal {
                    Some(nominal) => values.push((parameter.name.clone(), nominal.clone())),
                    None => errors.push(no_value(parameter)),
                },
            }
        }
        for constant in self.constants() {
            if let Some(value) = question.set.get(&constant.name) {
                values.push((constant.name.clone(), value.clone()));
            }
        }
        if errors.is_empty() {
            Ok(Resolved { kept: question.keep.clone(), values, warnings })
        } else {
            Err(Error::new(Some(self.source().clone()), errors))
        }
    }

    /// What a name that is to be varied is: the parameter, or the constant as a parameter.
    ///
    /// # Errors
    /// `E-unknown-parameter`, `E-not-a-number`.
    pub fn free(&self, name: &str) -> Result<Parameter, Error> {
        if let Some(diagnostic) = self.not_free(name) {
            return Err(Error::new(Some(self.source().clone()), vec![diagnostic]));
        }
        let constant = |c: &Constant| Parameter {
            name: c.name.clone(),
            span: c.span,
            nominal: c.number.clone(),
            min: None,
            max: None,
            unit: None,
            description: None,
        };
        let found = self.parameter(name).cloned().or_else(|| self.constant(name).map(constant));
        found.ok_or_else(|| unknown_parameter(self, name).into())
    }

    fn not_free(&self, name: &str) -> Option<Diagnostic> {
        if self.parameter(name).is_some() {
            return None;
        }
        match self.constant(name) {
            Some(Constant { number: Some(_), .. }) => None,
            Some(c) => {
                let message = format!("the constant '{}' is given by a formula, so it cannot vary", shorten(name));
                let error = Diagnostic::error("E-not-a-number", message).at(c.span, "given by a formula");
                let used: Vec<&str> = c.expression.names().into_iter().collect();
                Some(error.help(format!("vary what it depends on: {}", list(used.into_iter().take(8)))))
            }
            None => Some(unknown_parameter(self, name)),
        }
    }
}

fn unknown_parameter(model: &Loop, name: &str) -> Diagnostic {
    let numbers = model.constants().iter().filter(|c| c.number.is_some()).map(|c| c.name.as_str());
    let names = || model.parameters().iter().map(|p| p.name.as_str()).chain(numbers.clone());
    let mut error = Diagnostic::error("E-unknown-parameter", format!("the model has no parameter '{}'", shorten(name)));
    error.help = did_you_mean(name, names()).or_else(|| known_names(names()));
    error
}

fn no_value(parameter: &Parameter) -> Diagnostic {
    let name = shorten(&parameter.name);
    Diagnostic::error("E-no-value", format!("the parameter '{name}' has no value"))
        .at(parameter.span, "no 'nominal' here")
        .help(format!("give it a nominal value, or set it: --set {name}=..."))
}
