//! Stable sets of whole loops, and what they are expected to be, in words.

use super::certificates::checkers::certified_set_of;
use super::number::number;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{RealAlgebraic, UniPoly};
use jurist_engine::model::Loop;
use jurist_engine::problem::Question;
use jurist_engine::stability::{End, StableSet};

/// A question with values in place of nominal ones.
pub fn with(lp: &Loop, values: &[(&str, &str)]) -> Question {
    lp.ask().set_all(values.iter().map(|(name, value)| (*name, number(value))))
}

/// The exact stable set.
pub fn stable_set_of(question: Question) -> StableSet {
    question.stable_set(&Budget::unlimited()).unwrap_or_else(|e| panic!("{e}")).into_value()
}

/// Asserts that the stable set is the list of intervals, each end in words:
///
/// * `-inf`, `inf`;
/// * `19/50: z=-1`: the exact value and its causes;
/// * `root 1 -10 10 near 0.1127: complex pair`: an irrational root of 1 - 10 k + 10 k^2 with these digits;
///
/// and that both checkers accept the set's certificate.
pub fn assert_stable(question: Question, expected: &[(&str, &str)]) {
    let found = certified_set_of(question);
    let shown: Vec<_> = found.intervals().iter().map(|i| (words(&i.lower, "-inf"), words(&i.upper, "inf"))).collect();
    assert_eq!(found.intervals().len(), expected.len(), "found {shown:?}");
    for ((interval, expected), shown) in found.intervals().iter().zip(expected).zip(&shown) {
        assert_end(&interval.lower, expected.0, "-inf", &shown.0);
        assert_end(&interval.upper, expected.1, "inf", &shown.1);
    }
}

fn words(end: &Option<End>, infinite: &str) -> String {
    let Some(end) = end else { return infinite.into() };
    match end.value.exact() {
        Some(exact) => format!("{exact}: {}", end.causes),
        None => format!("near {}: {}", end.value.decimal(15), end.causes),
    }
}

fn assert_end(end: &Option<End>, expected: &str, infinite: &str, shown: &str) {
    let (Some(end), Some(root)) = (end, expected.strip_prefix("root ")) else {
        assert_eq!(shown, expected, "an infinite end is {infinite}");
        return;
    };
    let (coefficients, rest) = root.split_once(" near ").expect("digits");
    let (digits, causes) = rest.split_once(": ").expect("causes");
    let integers: Vec<_> = coefficients.split(' ').map(|c| number(c).numerator()).collect();
    assert!(end.value.sign_of(&UniPoly::new(integers)).is_eq(), "{shown} is no root of {coefficients}");
    assert!(end.value.exact().is_none(), "{shown} is rational");
    assert!(end.value.decimal(60).starts_with(digits), "{shown}, expected {digits}");
    assert_eq!(end.causes.to_string(), causes, "{shown}");
}

/// Asserts that an irrational number is a simple zero of a function given in exact arithmetic: it
/// changes sign within 1e-40.
pub fn assert_changes_sign(value: &RealAlgebraic, f: impl Fn(&Rational) -> Rational) {
    let (lo, hi) = value.refined(&number("1e-40")).enclosure();
    assert!(lo < hi, "{lo} is rational");
    assert_ne!(f(&lo).sign(), f(&hi).sign(), "no change of sign at {}", value.decimal(15));
}
