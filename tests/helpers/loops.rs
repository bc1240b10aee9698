//! Stable sets of whole loops.

use super::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::model::Model;
use jurist_engine::problem::Question;
use jurist_engine::stability::StableSet;

/// A question with values in place of nominal ones.
pub fn with(lp: &Model, values: &[(&str, &str)]) -> Question {
    lp.ask().set_all(values.iter().map(|(name, value)| (*name, number(value))))
}

/// The exact stable set.
pub fn stable_set_of(question: Question) -> StableSet {
    question.stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value()
}

/// Asserts that an irrational number is a simple zero of a function given in exact arithmetic: it
/// changes sign within 1e-40.
pub fn assert_changes_sign(value: &Real, f: impl Fn(&Rational) -> Rational) {
    let (lo, hi) = value.refined(&number("1e-40")).enclosure();
    assert!(lo < hi, "{lo} is rational");
    assert_ne!(f(&lo).sign(), f(&hi).sign(), "no change of sign at {}", value.decimal(15));
}
