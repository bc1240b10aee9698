//! Both checkers on one certificate, and the certificates of whole loops.

use super::mutations;
use super::python::{self, Python};
use crate::helpers::thorough::{count, is_tried};
use jurist::Certificate;
use jurist_algebra::limits::Budget;
use jurist_check::format::Json;
use jurist_check::{Limits, Step, check};
use jurist_engine::answer::PointVerdict;
use jurist_engine::problem::Question;
use jurist_engine::stability::StableSet;
use std::sync::Mutex;
use std::time::Duration;

/// No test may fail because the machine is busy.
const LIMITS: Limits = Limits::within(Duration::MAX);

/// What the Python checker says; `None` where Python is not there. As many processes serve a whole test program as tests ask at once.
pub fn python(model: &str, certificate: &str) -> Option<Result<String, String>> {
    static IDLE: Mutex<Vec<Python>> = Mutex::new(Vec::new());
    let idle = || IDLE.lock().unwrap_or_else(|e| e.into_inner());
    if !python::is_there() {
        return None;
    }
    let waiting = idle().pop();
    let mut checker = waiting.unwrap_or_else(Python::start);
    let found = checker.check(model, certificate);
    idle().push(checker);
    Some(found)
}

/// Asserts that both checkers accept; where not all is tried the Python checker, the slower one, is given one certificate in three, by its length.
pub fn accept(model: &str, certificate: &str) {
    check(model, certificate, &LIMITS).unwrap_or_else(|e| panic!("{e}\n{model}\n{certificate}"));
    if is_tried(certificate.len(), 3)
        && let Some(Err(e)) = python(model, certificate)
    {
        panic!("Python: {e}\n{model}\n{certificate}");
    }
}

/// The Python checker is given one in so many changes of a certificate: it is the slower one.
pub const PYTHON_EVERY: usize = 8;

/// Asserts that the Rust checker rejects at this step.
pub fn reject_in_rust(model: &str, certificate: &str, step: Step) {
    match check(model, certificate, &LIMITS) {
        Ok(proved) => panic!("accepted: {}\n{certificate}", proved.statement),
        Err(e) => assert_eq!(e.step, step, "{e}\n{certificate}"),
    }
}

/// Asserts that both checkers reject, the first one at this step; the second one is asked as in [`accept`].
pub fn reject(model: &str, certificate: &str, step: Step) {
    reject_in_rust(model, certificate, step);
    if is_tried(certificate.len(), 3)
        && let Some(Ok(proved)) = python(model, certificate)
    {
        panic!("Python accepted: {proved}\n{certificate}");
    }
}

/// Asserts of one in `every` changes (one in three times as many where not all is tried) of one value in a certificate, at least so many of them wrong, that what is accepted is true, and of a part of
/// them that both checkers say the same.
pub fn reject_or_find_true(
    model: &str,
    certificate: &str,
    every: usize,
    least: usize,
    is_true: impl Fn(&Json) -> bool,
) {
    let original = Json::parse(certificate).unwrap();
    assert!(is_true(&original), "{certificate}");
    let (mut rejected, mut accepted) = (0, 0);
    let mutations = mutations(&original);
    let changes = mutations.one_in(every * count(6, 1)).filter(|changed| changed.get("model") == original.get("model"));
    for (k, changed) in changes.enumerate() {
        let certificate = changed.to_text();
        let verdict = check(model, &certificate, &LIMITS);
        if k % PYTHON_EVERY == 0
            && let Some(other) = python(model, &certificate)
        {
            assert_eq!(verdict.is_ok(), other.is_ok(), "{verdict:?} {other:?}\n{model}\n{certificate}");
        }
        match verdict {
            Err(_) => rejected += 1,
            Ok(proved) => {
                accepted += 1;
                assert!(is_true(&changed), "{}\n{model}\n{certificate}", proved.statement);
            }
        }
    }
    assert!(rejected >= least / count(6, 1) && accepted < rejected / 3, "{rejected} rejected, {accepted} accepted");
}

/// The stable set, whose certificate both checkers accept.
pub fn certified_set_of(question: Question) -> StableSet {
    let budget = Budget::unlimited();
    let answer = question.stable_set(&budget).unwrap_or_else(|e| panic!("{e}"));
    accept(&answer.problem().model().source().text, &answer.certificate(&budget).expect("no limit"));
    answer.into_value()
}

/// The verdict at a point, whose certificate both checkers accept.
pub fn certified_verdict_of(question: Question) -> PointVerdict {
    let budget = Budget::unlimited();
    let answer = question.verdict(&budget).unwrap_or_else(|e| panic!("{e}"));
    accept(&answer.problem().model().source().text, &answer.certificate(&budget).expect("no limit"));
    answer.into_value()
}
