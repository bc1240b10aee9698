//! Which names of a model may vary.

use super::definition::{Constant, Model, Parameter};
use super::text::names::{did_you_mean, known_names, list, shorten};
use crate::error::{Code, Diagnostic, Diagnostics};

impl Model {
    /// What a name that is to be varied is: the parameter, or the constant as a parameter.
    ///
    /// # Errors
    /// `E-unknown-parameter`, `E-not-a-number`.
    pub fn free(&self, name: &str) -> Result<Parameter, Diagnostics> {
        if let Some(diagnostic) = self.not_free(name) {
            return Err(Diagnostics::new(Some(self.source().clone()), vec![diagnostic]));
        }
        let constant = |c: &Constant| Parameter {
            nominal: c.number.clone(),
            tolerance: c.tolerance.clone(),
            ..Parameter::named(c.name.clone(), c.span)
        };
        let found = self.parameter(name).cloned().or_else(|| self.constant(name).map(constant));
        found.ok_or_else(|| unknown_parameter(self, name).into())
    }

    /// Why a name cannot be left free; `None` if it can.
    pub fn not_free(&self, name: &str) -> Option<Diagnostic> {
        if self.parameter(name).is_some() {
            return None;
        }
        match self.constant(name) {
            Some(Constant { number: Some(_), .. }) => None,
            Some(c) => {
                let message = format!("the constant '{}' is given by a formula, so it cannot vary", shorten(name));
                let error = Diagnostic::error(Code::NotANumber, message).at(c.span, "given by a formula");
                let used: Vec<&str> = c.expression.names().into_iter().collect();
                Some(error.help(format!("vary what it depends on: {}", list(used.into_iter().take(8)))))
            }
            None => Some(unknown_parameter(self, name)),
        }
    }
}

fn unknown_parameter(model: &Model, name: &str) -> Diagnostic {
    let numbers = model.constants().iter().filter(|c| c.number.is_some()).map(|c| c.name.as_str());
    let names = || model.parameters().iter().map(|p| p.name.as_str()).chain(numbers.clone());
    let mut error =
        Diagnostic::error(Code::UnknownParameter, format!("the model has no parameter '{}'", shorten(name)));
    let sample_time = (name == "sample_time" && model.sample_time_expression().is_some()).then(|| {
        "give the sample time a name: sample_time = \"T\", and a constant T; then '--param T' asks about it".to_owned()
    });
    let none = || "it has no names at all: write one where a number stands, as K in 'K/(s + 1)'".to_owned();
    error.help =
        sample_time.or_else(|| did_you_mean(name, names())).or_else(|| known_names(names())).or_else(|| Some(none()));
    error
}
