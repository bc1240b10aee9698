//! What every certificate says in the same words: its model, its statement, the identity of its pair.

use super::cofactors::Identity;
use super::no_certificate;
use jurist_algebra::number::Rational;
use jurist_check::{loop_alone, sha256};
use jurist_engine::answer::PointVerdict;
use jurist_engine::problem::{Bound, Problem, Region};
use jurist_model::error::Error;
use jurist_model::{Block, Diagram, Dynamics, Form, Node};
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

/// The most unknowns of a hyperperiod that the checkers take: signals and states at each sample.
const MOST_UNKNOWNS: u64 = 400;

/// Refuses loops of several rates that the checkers do not read, before anything is computed for a certificate: they lift loops whose
/// rates are numbers of samples.
///
/// # Errors
/// `E-no-certificate`.
pub(super) fn of_rates(problem: &Problem) -> Result<(), Error> {
    let model = problem.model();
    if model.has_steady_duty() {
        return Err(no_certificate("no certificate: the checkers do not solve for the duty ratio of an orbit"));
    }
    let (steps, Form::Blocks(diagram)) = (model.hyperperiod(), model.form()) else { return Ok(()) };
    if steps == 1 {
        return Ok(());
    }
    let why = if diagram.blocks.iter().any(|block| block.sample_time.is_some()) {
        "a block says its rate by a sample time, and the checkers read 'every'"
    } else if steps.saturating_mul(unknowns(diagram)) > MOST_UNKNOWNS {
        "a hyperperiod has more equations than the checkers take"
    } else {
        return Ok(());
    };
    Err(no_certificate(format!("no certificate: {why}")))
}

/// Whether a block is behind a hold that brings constants, as far as that shows in what is written.
pub(super) fn has_held_plant(problem: &Problem) -> bool {
    let Form::Blocks(diagram) = problem.model().form() else { return false };
    let is_held = |block: &Block| {
        block.discretization.as_ref().is_some_and(|d| d.method.is_hold()) && !are_integrators(&block.dynamics)
    };
    diagram.blocks.iter().any(is_held)
}

/// Whether a block in state space has no modes but integrators, for certain: its state matrix is written as numbers, all of one side being 0.
fn are_integrators(dynamics: &Dynamics) -> bool {
    let Dynamics::StateSpace { a, .. } = dynamics else { return false };
    let is_zero = |i: usize, j: usize| matches!(&a.rows[i][j].node, Node::Number(x) if x.is_zero());
    let n = a.rows.len();
    let below = (0..n).all(|i| (0..=i).all(|j| is_zero(i, j)));
    below || (0..n).all(|i| (i..n).all(|j| is_zero(i, j)))
}

/// A bound of the signals and the states of a diagram, without those of transfer functions.
fn unknowns(diagram: &Diagram) -> u64 {
    let of = |block: &Block| {
        let states = match &block.dynamics {
            Dynamics::StateSpace { a, .. } => a.size().0,
            _ => 0,
        };
        (block.outputs.len() + states) as u64
    };
    diagram.blocks.iter().map(of).sum()
}

/// Refuses loops of several rates, for statements beside those of stability.
///
/// # Errors
/// `E-no-certificate`.
pub(super) fn of_one_rate(problem: &Problem) -> Result<(), Error> {
    match problem.model().hyperperiod() {
        1 => of_rates(problem),
        _ => Err(no_certificate("no certificate: of a loop of several rates stability alone is certified")),
    }
}

/// Title and digest of the model, for people: the check reads the model itself.
///
/// # Errors
/// As [`of_one_rate`].
pub(super) fn about(problem: &Problem) -> Result<Value, Error> {
    of_one_rate(problem)?;
    about_at_rates(problem)
}

/// The same for statements that are made of loops of several rates, too.
///
/// # Errors
/// As [`of_rates`].
pub(super) fn about_at_rates(problem: &Problem) -> Result<Value, Error> {
    of_rates(problem)?;
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
