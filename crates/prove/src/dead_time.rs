//! Certificates of stable dead times: where roots can cross the axis, and how often they have by each end.

use super::emit::polynomials;
use super::gain;
use super::no_certificate;
use super::statement::{self, about, number, object};
use super::text::to_text;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, RealAlgebraic, SquareFree, UniPoly, isolate_real_roots_in};
use jurist_algebra::real::{Origin, Real};
use jurist_engine::answer::Answer;
use jurist_engine::problem::{BaseDelay, DelayedLoop};
use jurist_model::error::Error;
use jurist_stability::{End, StableInterval, StableSet};
use serde_json::Value;

/// The schema of certificates of stable dead times.
const SCHEMA: &str = "jurist/certificate/3";

/// Bits of the squared frequencies; the checkers have more.
const ROOT_BITS: u64 = 256;

/// Bits of the checkers' enclosures.
const BITS: u64 = 384;

/// Ends are enclosed to this many digits.
const DIGITS: usize = 15;

/// `E`, `O` with `p(i omega) = E + i omega O`, in `omega^2`.
fn even_odd(p: &UniPoly) -> (UniPoly, UniPoly) {
    let part = |from: usize| {
        let signed = |(k, c): (usize, &Integer)| if k % 2 == 1 { -c } else { c.clone() };
        UniPoly::new(p.coeffs().iter().skip(from).step_by(2).enumerate().map(signed).collect())
    };
    (part(0), part(1))
}

/// The certificate of the stable dead times.
pub(super) fn of_set(answer: &Answer<StableSet>, delayed: &DelayedLoop, budget: &Budget) -> Result<String, Error> {
    let problem = answer.problem();
    let domain = &problem.parameter().domain;
    let BaseDelay::Line { slope, offset } = delayed.delay() else {
        return gain::of_set(answer, delayed, budget);
    };
    if !offset.is_zero() || slope.is_negative() || delayed.degree_in_parameter() > 0 || !delayed.poles().is_empty() {
        return Err(no_certificate("no certificate: the dead time is not a multiple of the parameter"));
    }
    if !answer.value().undecided().is_empty() {
        return Err(no_certificate("no certificate: a part of the answer is undecided"));
    }
    let function = delayed.quasi_polynomial();
    let Some([p, q]) = function.as_ref().map(|f| f.parts()) else {
        return Err(no_certificate("no certificate: several multiples of a dead time have none"));
    };
    if domain.lower.as_ref().is_none_or(Rational::is_negative) {
        return Err(no_certificate("no certificate: the domain has negative dead times"));
    }
    let n = p.degree().unwrap_or(0);
    if q.degree() > Some(n) || q.coeff(n).abs() >= p.coeff(n).abs() {
        return Err(no_certificate("no certificate: the loop is advanced, or of neutral type and never stable"));
    }
    let is_at_zero = p.plus(q).coeff(0).is_zero();
    let found = if is_at_zero { Vec::new() } else { crossings(p, q, budget)? };
    let mut stable = Vec::new();
    // A single value belongs to a closed end of the domain, and the statement is about the inside.
    let is_single =
        |i: &&StableInterval| matches!((&i.lower, &i.upper), (Some(a), Some(b)) if a.value.is_same(&b.value));
    for interval in answer.value().intervals().iter().filter(|i| !is_single(i)) {
        let ends = [&interval.lower, &interval.upper].map(|e| end(e.as_ref(), &found));
        let [lower, upper] = ends;
        stable.push(object([("lower", lower?), ("upper", upper?)]));
    }
    let enclosure = |root: &RealAlgebraic| {
        let width = Rational::dyadic(&Integer::ONE, ROOT_BITS);
        let (a, b) = root.refined(&width).enclosure();
        let (a, b) = if a == b { (&a - &width, &b + &width) } else { (a, b) };
        Value::Array(vec![number(&a), number(&b)])
    };
    Ok(to_text(&object([
        ("schema", SCHEMA.into()),
        ("model", about(problem)?),
        ("statement", statement::intervals(problem, stable)),
        ("bits", BITS.into()),
        ("delay", number(slope)),
        ("parts", polynomials(&[p.clone(), q.clone()])),
        ("crossings", found.iter().map(enclosure).collect()),
    ])))
}

/// The positive roots of `|P_0|^2 - |P_1|^2` in `omega^2`, ascending, all of them simple.
fn crossings(p: &UniPoly, q: &UniPoly, budget: &Budget) -> Result<Vec<RealAlgebraic>, Error> {
    let ((e0, o0), (e1, o1)) = (even_odd(p), even_odd(q));
    let modulus = |e: &UniPoly, o: &UniPoly| e.times(e).plus(&o.times(o).shifted_up(1));
    let f = modulus(&e0, &o0).minus(&modulus(&e1, &o1));
    let zeros = f.coeffs().iter().take_while(|c| c.is_zero()).count();
    let f = UniPoly::new(f.coeffs()[zeros..].to_vec());
    let simple = SquareFree::new(f).ok_or_else(|| no_certificate("no certificate: roots touch the axis"))?;
    let found = isolate_real_roots_in(&simple, Some(&Rational::ZERO), None, budget)?;
    let angle = o0.times(&e1).minus(&e0.times(&o1));
    if !angle.is_zero() && found.iter().any(|root| root.sign_of(&angle).is_eq()) {
        return Err(no_certificate("no certificate: a crossing has z = 1 or z = -1, and that is no identity"));
    }
    Ok(found)
}

/// An end of a stable interval.
fn end(end: Option<&End>, found: &[RealAlgebraic]) -> Result<Value, Error> {
    let Some(end) = end else { return Ok(Value::Null) };
    if let Some(q) = end.value.exact() {
        return Ok(number(&q));
    }
    let unknown = || no_certificate("no certificate: an end is no crossing");
    let Real::Transcendental(value) = &end.value else { return Err(unknown()) };
    let Origin::Crossing { omega_squared, turns, .. } = value.origin() else { return Err(unknown()) };
    let crossing = found.iter().position(|root| root.compare(&omega_squared).is_eq()).ok_or_else(unknown)?;
    let (a, b) = end.value.refined_to_digits(DIGITS).enclosure();
    let width = &b - &a;
    Ok(object([
        ("crossing", crossing.into()),
        ("turns", turns.into()),
        ("between", Value::Array(vec![number(&(a - &width)), number(&(b + &width))])),
    ]))
}
