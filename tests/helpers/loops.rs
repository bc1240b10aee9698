//! Stable sets of whole loops.

use super::number::number;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use jurist_engine::answer::Verdict;
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

/// Compares a stable set of `K`, and verdicts, with the largest modulus of a root in floating point: at these gains, and a share `beside` of
/// each end to both of its sides. Returns how many ends and how many gains were looked at.
pub fn agrees_with_radius(
    model: &Model,
    set: &StableSet,
    mut gains: Vec<f64>,
    beside: f64,
    radius: impl Fn(f64) -> f64,
) -> [usize; 2] {
    /// Nearer to 1 floating point tells nothing.
    const UNCLEAR: f64 = 1e-6;
    let mut ends = 0;
    for end in set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
        let end: f64 = end.value.decimal(17).parse().expect("a decimal");
        let step = beside * (end.abs() + 0.1);
        gains.extend([end - step, end + step]);
        ends += 1;
    }
    gains.retain(|gain| (radius(*gain) - 1.0).abs() >= UNCLEAR);
    for gain in &gains {
        let (is_stable, exact) = (radius(*gain) < 1.0, Rational::from_f64(*gain).expect("a number"));
        let verdict =
            model.ask().set("K", exact.clone()).verdict(&Budget::unlimited()).expect("a verdict").into_value();
        let found = [set.contains(&exact), verdict.verdict == Verdict::Stable];
        assert_eq!(found, [is_stable; 2], "K = {gain}: {}\n{}", radius(*gain), model.source().text);
    }
    [ends, gains.len()]
}
