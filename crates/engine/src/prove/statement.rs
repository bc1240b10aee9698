//! What every certificate says in the same words: its model, its statement, the identity of its pair.

use super::cofactors::Identity;
use super::digest::{loop_alone, sha256};
use super::no_certificate;
use crate::answer::PointVerdict;
use crate::error::Error;
use crate::problem::{Bound, Problem, Region};
use jurist_algebra::number::Rational;
use serde_json::Value;

pub(super) fn object<const N: usize>(pairs: [(&str, Value); N]) -> Value {
    Value::Object(pairs.into_iter().map(|(k, v)| (k.to_owned(), v)).collect())
}

pub(super) fn number(value: &Rational) -> Value {
    value.to_string().into()
}

pub(super) fn set(values: &[(String, Rational)]) -> Value {
    Value::Object(values.iter().map(|(n, v)| (n.clone(), number(v))).collect())
}

pub(super) fn region(region: &Region) -> Value {
    let value = match region.bound() {
        Bound::Number(value) => number(value),
        Bound::Free => "parameter".into(),
    };
    object([(region.bound_name(), value)])
}

/// Refuses models that the checkers do not read, before anything is computed for a certificate.
///
/// # Errors
/// `E-no-certificate`.
pub(super) fn readable(problem: &Problem) -> Result<(), Error> {
    if problem.model().hyperperiod() > 1 {
        return Err(no_certificate("no certificate: the checkers read no loops of several rates"));
    }
    if problem.model().has_steady_duty() {
        return Err(no_certificate("no certificate: the checkers do not solve for the duty ratio of an orbit"));
    }
    Ok(())
}

/// Title and digest of the model, for people: the check reads the model itself.
///
/// # Errors
/// As [`readable`].
pub(super) fn about(problem: &Problem) -> Result<Value, Error> {
    readable(problem)?;
    let digest = sha256(&loop_alone(&problem.model().source().text));
    let title = problem.title().map_or(Value::Null, Value::from);
    Ok(object([("title", title), ("digest", format!("sha256:{digest}").into())]))
}

/// That these are the stable intervals of the problem's parameter.
pub(super) fn intervals(problem: &Problem, stable: Vec<Value>) -> Value {
    let bound = |b: &Option<Rational>| b.as_ref().map_or(Value::Null, number);
    let parameter = problem.parameter();
    let domain = &parameter.domain;
    object([
        ("kind", "intervals".into()),
        ("time", problem.time().name().into()),
        ("parameter", parameter.name.as_str().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("domain", object([("lower", bound(&domain.lower)), ("upper", bound(&domain.upper))])),
        ("stable", Value::Array(stable)),
    ])
}

/// That the loop has this verdict.
pub(super) fn verdict(problem: &Problem, verdict: &PointVerdict) -> Value {
    let counts = verdict.count.unwrap_or_default();
    object([
        ("kind", "verdict".into()),
        ("time", problem.time().name().into()),
        ("set", set(problem.set())),
        ("region", region(problem.region())),
        ("verdict", verdict.verdict.name().into()),
        ("degree", verdict.degree.into()),
        ("inside", counts.inside.into()),
        ("on", counts.on.into()),
        ("outside", counts.outside.into()),
        ("infinite", verdict.infinite.into()),
    ])
}

/// The cofactors of the half-size pair and what they add up to; `null` where the order is too low for a pair.
pub(super) fn boundary<P>(identity: Option<&Identity<P>>, write: impl Fn(&P) -> Value) -> Value {
    let list = |polynomials: &[P]| Value::Array(polynomials.iter().map(&write).collect());
    identity.map_or(Value::Null, |i| object([("u", list(&i.u)), ("v", list(&i.v)), ("value", write(&i.value))]))
}
