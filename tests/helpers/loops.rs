//! Stable sets of whole loops.

use super::certificates::checkers::accept_intervals_of;
use super::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RealAlgebraic;
use jurist_engine::analysis::{Settings, intervals};
use jurist_engine::model::Loop;
use jurist_engine::stability::StableSet;

/// Values in place of nominal ones.
pub fn set(values: &[(&str, &str)]) -> Settings {
    let set = values.iter().map(|(name, value)| ((*name).to_string(), number(value))).collect();
    Settings { set, ..Settings::default() }
}

/// The exact stable set.
pub fn stable_set_of(lp: &Loop, parameter: &str, settings: &Settings) -> StableSet {
    let answer = intervals(lp, settings, parameter, &Budget::unlimited()).unwrap_or_else(|e| panic!("{e}"));
    answer.stable.decided().expect("there is no budget").clone()
}

/// The exact stable set, whose certificate both checkers accept.
pub fn certified_set_of(lp: &Loop, parameter: &str, settings: &Settings) -> StableSet {
    accept_intervals_of(lp, settings, parameter);
    stable_set_of(lp, parameter, settings)
}

/// Asserts that an irrational number is a simple zero of a function given in exact arithmetic: it
/// changes sign within 1e-40.
pub fn assert_changes_sign(value: &RealAlgebraic, f: impl Fn(&Rational) -> Rational) {
    let (lo, hi) = value.refined(&number("1e-40")).enclosure();
    assert!(lo < hi, "{lo} is rational");
    assert_ne!(f(&lo).sign(), f(&hi).sign(), "no change of sign at {}", value.decimal(15));
}
