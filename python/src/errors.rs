//! From the engine's one kind of "no" to Python's exceptions, which are classes written in Python.

use jurist::{Code, Diagnostic, Diagnostics, Error, Label, Severity, Source};
use jurist_show::diagnostics::render_error;
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;
use std::any::Any;
use std::sync::Arc;

/// Whether a model or a question is refused.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum About {
    Model,
    Question,
}

/// A place: line and column from 1, first byte and the byte behind the last one, a few words.
type Place = (usize, usize, usize, usize, String);

/// What a Python exception or warning is made of: severity, code, message, places, help.
type Parts = (&'static str, &'static str, String, Vec<Place>, Option<String>);

fn parts(d: &Diagnostic, source: Option<&Arc<Source>>) -> Parts {
    let place = |label: &Label| {
        let (line, column) = source.map_or((0, 0), |s| s.line_column(label.span.start));
        (line, column, label.span.start, label.span.end, label.text.clone())
    };
    let places = d.primary.iter().chain(&d.secondary).map(place).collect();
    let severity = if d.severity == Severity::Warning { "warning" } else { "error" };
    (severity, d.code.as_str(), d.message.clone(), places, d.help.clone())
}

/// An exception made by a function of `jurist._errors`.
fn made<'py>(py: Python<'py>, function: &str, arguments: impl PyCallArgs<'py>) -> PyErr {
    let make = || py.import("jurist._errors")?.getattr(function)?.call1(arguments);
    make().map_or_else(|failure: PyErr| failure, PyErr::from_value)
}

/// The exception that says the same as the engine's error. What is known of an answer that stopped is its document.
pub(crate) fn raised(py: Python<'_>, error: Error, about: About, document: Option<String>) -> PyErr {
    match error {
        Error::Refused(refused) => {
            let text = render_error(&refused, false);
            let all: Vec<Parts> = refused.diagnostics().iter().map(|d| parts(d, refused.source_text())).collect();
            made(py, "refused", (about == About::Model, text.trim_end(), all))
        }
        Error::Undefined(why) => {
            let message = format!("the model is undefined for these values: {why}");
            let diagnostic = Diagnostic::error(Code::Undefined, message).help("set the parameters to other values");
            raised(py, Diagnostics::from(diagnostic).into(), About::Question, None)
        }
        Error::Stopped(stopped) => {
            made(py, "undecided", (stopped.to_string(), stopped.stop.to_string(), stopped.reached(), document))
        }
        other => made(py, "defect", (other.to_string(),)),
    }
}

/// Warnings as codes and texts.
pub(crate) fn warnings(all: &[Diagnostic], source: Option<&Arc<Source>>) -> Vec<(&'static str, String)> {
    let one = |d: &Diagnostic| {
        let alone = Diagnostics::new(source.cloned(), vec![d.clone()]);
        (d.code.as_str(), render_error(&alone, false).trim_end().to_owned())
    };
    all.iter().map(one).collect()
}

/// A panic as an exception.
pub(crate) fn defect_of(py: Python<'_>, payload: &(dyn Any + Send)) -> PyErr {
    let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    made(py, "defect", (text.unwrap_or_else(|| "no message".to_owned()),))
}
