//! Questions as texts: values, domains, the region.

use crate::wait::Patience;
use jurist::{Ask, Code, Diagnostic, Error, Model, Question, Range, Rational, Region, parse_number};
use pyo3::prelude::*;

/// What is asked besides what is free. Numbers are texts, so that they stay exact.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    values: Vec<(String, String)>,
    domains: Vec<(String, Option<String>, Option<String>)>,
    radius: Option<String>,
    decay: Option<String>,
    timeout: Option<f64>,
    progress: Option<Py<PyAny>>,
    pub digits: usize,
}

impl Asked {
    /// How long the answer may take.
    pub fn patience(&mut self) -> Patience {
        Patience { timeout: self.timeout, progress: self.progress.take() }
    }

    /// The question to a model.
    pub fn of(&self, model: &Model) -> Result<Question, Error> {
        let mut question = model.ask();
        for (name, value) in &self.values {
            model.free(name)?;
            question = question.set(name, number(value)?);
        }
        for (name, lower, upper) in &self.domains {
            let (lower, upper) = (bound(lower)?, bound(upper)?);
            if name != "radius" && name != "decay" {
                model.free(name)?;
            }
            question = question.domain(name, Range::between(lower, upper));
        }
        if let Some(radius) = bound(&self.radius)? {
            question = question.within(Region::disc(radius)?);
        }
        if let Some(decay) = bound(&self.decay)? {
            question = question.within(Region::half_plane(decay));
        }
        Ok(question)
    }
}

/// An exact number from its text.
pub(crate) fn number(text: &str) -> Result<Rational, Error> {
    parse_number(text).map_err(|e| Diagnostic::error(Code::Number, format!("'{text}' is not a number: {e}")).into())
}

fn bound(text: &Option<String>) -> Result<Option<Rational>, Error> {
    text.as_deref().map(number).transpose()
}
