//! Both checkers on one certificate, and the certificates of whole loops.

use super::python::Python;
use jurist_algebra::limits::Budget;
use jurist_check::{Limits, Step, check};
use jurist_engine::analysis::{Settings, one_parameter, verdict};
use jurist_engine::model::Loop;
use jurist_engine::prove::emit::{intervals_certificate, verdict_certificate};
use std::sync::{Mutex, OnceLock};
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits { timeout: Duration::MAX };

/// What the Python checker says; `None` where Python is not there. One process serves a whole test program.
pub fn python(model: &str, certificate: &str) -> Option<Result<String, String>> {
    static PYTHON: OnceLock<Option<Mutex<Python>>> = OnceLock::new();
    let python = PYTHON.get_or_init(|| Python::start().map(Mutex::new)).as_ref()?;
    Some(python.lock().unwrap_or_else(|e| e.into_inner()).check(model, certificate))
}

/// Asserts that both checkers accept.
pub fn accept(model: &str, certificate: &str) {
    check(model, certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{model}\n{certificate}"));
    if let Some(Err(e)) = python(model, certificate) {
        panic!("Python: {e}\n{model}\n{certificate}");
    }
}

/// Asserts that both checkers reject, the first one at this step.
pub fn reject(model: &str, certificate: &str, step: Step) {
    match check(model, certificate, &LIMITS) {
        Ok(proved) => panic!("accepted: {}\n{certificate}", proved.statement),
        Err(e) => assert_eq!(e.step, step, "{e}\n{certificate}"),
    }
    if let Some(Ok(proved)) = python(model, certificate) {
        panic!("Python accepted: {proved}\n{certificate}");
    }
}

/// Asserts that the stable set of a loop has a certificate that both checkers accept.
pub fn accept_intervals_of(lp: &Loop, settings: &Settings, parameter: &str) {
    let budget = Budget::unlimited();
    let question = one_parameter(lp, settings, parameter, &budget).unwrap_or_else(|e| panic!("{e}"));
    let model = &lp.source().text;
    accept(model, &intervals_certificate(model, &question, &budget).expect("no limit"));
}

/// Asserts that the verdict at a point has a certificate that both checkers accept.
pub fn accept_verdict_of(lp: &Loop, settings: &Settings) {
    let budget = Budget::unlimited();
    let answer = verdict(lp, settings, &budget).unwrap_or_else(|e| panic!("{e}"));
    accept(&lp.source().text, &verdict_certificate(lp, settings, &answer, &budget).expect("no limit"));
}
