//! The program itself, the checker, and the list of error codes.

use crate::errors::{About, raised};
use crate::wait::{Patience, waited};
use jurist::{Error, Limits};
use pyo3::prelude::*;
use std::ffi::OsString;
use std::time::Duration;

/// Runs the program on a list of arguments, its name first; gives the exit status.
#[pyfunction]
pub(crate) fn program(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| jurist::cli::program(arguments, false))
}

/// Checks a certificate: true, the kind of the statement and the statement; or false, the step that failed and why.
#[pyfunction]
pub(crate) fn check(
    py: Python<'_>,
    model: String,
    certificate: String,
    timeout: f64,
) -> PyResult<(bool, String, String)> {
    let limits = Limits::within(Duration::try_from_secs_f64(timeout.max(0.0)).unwrap_or(Duration::MAX));
    let work = move |_: &jurist::Budget| {
        Ok(match jurist::check(&model, &certificate, &limits) {
            Ok(proved) => (true, proved.kind.to_owned(), proved.statement),
            Err(rejection) => (false, rejection.step.name().to_owned(), rejection.to_string()),
        })
    };
    waited(py, &Patience::unlimited(), work)?.map_err(|e: Error| raised(py, e, About::Question, None))
}

/// Every error code with its explanation.
#[pyfunction]
pub(crate) fn codes() -> Vec<(String, String)> {
    jurist_engine::error::codes().map(|(code, text)| (code.to_string(), text)).collect()
}

/// Every word of the answers and of the field with its explanation.
#[pyfunction]
pub(crate) fn words() -> Vec<(&'static str, &'static str)> {
    jurist_show::words().collect()
}

/// Breaks off as a defect would: shows that no panic leaves the package.
#[pyfunction]
pub(crate) fn defect(py: Python<'_>) -> PyResult<()> {
    let work = |_: &jurist::Budget| -> Result<(), Error> { panic!("a defect on purpose") };
    waited(py, &Patience::unlimited(), work)?.map_err(|e| raised(py, e, About::Question, None))
}
