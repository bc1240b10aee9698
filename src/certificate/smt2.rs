//! The statement about one parameter in the language of SMT solvers.

use crate::analysis::OneParameter;
use crate::limits::{Budget, Exhausted};
use crate::number::{Integer, Rational};
use crate::poly::{Domain, RealAlgebraic, UniPoly};
use crate::stability::{Inequality, ScaledPoly, StableSet, classical_test};
use std::fmt::Write;

/// An SMT-LIB 2 script (the SMT-LIB Standard, version 2.6) that asks for a parameter value in the domain at which the classical
/// conditions (Jury's, or Routh's) and the claimed set differ. `unsat` means that they are the same set.
///
/// The only variable is the parameter. An irrational end is no variable either: with `f` its polynomial and `(a, b)`
/// its enclosure, `x < end` is `x <= a or (x < b and f(x) has the sign of f(a))`.
///
/// # Errors
/// [`Exhausted`] when the budget runs out.
pub fn intervals_smt2(question: &OneParameter, set: &StableSet, budget: &Budget) -> Result<String, Exhausted> {
    let mut domain = Vec::new();
    if let Some(lower) = &question.domain.lower {
        domain.push(format!("(< {} p)", real(lower)));
    }
    if let Some(upper) = &question.domain.upper {
        domain.push(format!("(< p {})", real(upper)));
    }
    let mut conditions = Vec::new();
    match &question.polynomial {
        None => conditions.push("false".to_owned()),
        Some(p) => {
            for pole in p.poles().iter().chain([p.denominator()]) {
                conditions.push(format!("(distinct {} 0.0)", horner(pole)));
            }
            let test = classical_test(p, &question.domain, question.region, budget)?;
            if p.formal_degree() == 0 {
                let c = p.polynomial().coeffs().first().cloned().unwrap_or_else(UniPoly::zero);
                conditions.push(format!("(distinct (* {} {}) 0.0)", horner(&c), horner(p.content())));
            }
            for condition in &test.conditions {
                conditions.push(match &condition.inequality {
                    Inequality::Positive(f) => format!("(> {} 0.0)", horner(&f.polynomial)),
                    Inequality::Dominates { left, right } => {
                        let (l, r) = (scaled(left), scaled(right));
                        format!("(let ((l {l}) (r {r})) (> (* (- l r) (+ l r)) 0.0))")
                    }
                });
            }
        }
    }
    let mut claimed = Vec::new();
    for interval in set.intervals() {
        let lower = interval.lower.as_ref().map(|e| above(&e.value));
        let upper = interval.upper.as_ref().map(|e| below(&e.value));
        claimed.push(joined("and", lower.into_iter().chain(upper).collect(), "true"));
    }
    let mut out = String::new();
    let _ = writeln!(out, "; p is the parameter '{}'", question.parameter.replace(['\n', '\r'], " "));
    for (name, value) in &question.set {
        let _ = writeln!(out, "; {} = {value}", name.replace(['\n', '\r'], " "));
    }
    let _ = writeln!(out, "; unsat: the loop is stable exactly on the claimed set");
    let _ = writeln!(out, "(set-logic QF_NRA)\n(declare-const p Real)");
    for bound in domain {
        let _ = writeln!(out, "(assert {bound})");
    }
    let _ = writeln!(out, "(define-fun stable () Bool {})", joined("and", conditions, "true"));
    let _ = writeln!(out, "(define-fun claimed () Bool {})", joined("or", claimed, "false"));
    let _ = writeln!(out, "(assert (distinct stable claimed))\n(check-sat)");
    Ok(out)
}

fn joined(operator: &str, parts: Vec<String>, empty: &str) -> String {
    match parts.as_slice() {
        [] => empty.to_owned(),
        [one] => one.clone(),
        many => format!("({operator} {})", many.join(" ")),
    }
}

fn integer(value: &Integer) -> String {
    if value.is_negative() { format!("(- {}.0)", value.abs()) } else { format!("{value}.0") }
}

fn real(value: &Rational) -> String {
    if value.is_integer() {
        return integer(&value.numerator());
    }
    format!("(/ {} {}.0)", integer(&value.numerator()), value.denominator())
}

/// The value at `p`.
fn horner(f: &UniPoly) -> String {
    let Some((last, rest)) = f.coeffs().split_last() else { return "0.0".into() };
    let open: String = rest.iter().map(|c| format!("(+ {} (* p ", integer(c))).collect();
    format!("{open}{}{}", integer(last), "))".repeat(rest.len()))
}

fn scaled(f: &ScaledPoly) -> String {
    format!("(* {} {})", real(&f.scale), horner(&f.polynomial))
}

fn below(end: &RealAlgebraic) -> String {
    let (a, b) = end.enclosure();
    if a == b {
        return format!("(< p {})", real(&a));
    }
    let f = end.polynomial();
    let compare = if f.sign_at(&a).is_gt() { ">" } else { "<" };
    format!("(or (<= p {}) (and (< p {}) ({compare} {} 0.0)))", real(&a), real(&b), horner(f))
}

fn above(end: &RealAlgebraic) -> String {
    let (a, b) = end.enclosure();
    if a == b {
        return format!("(< {} p)", real(&a));
    }
    let f = end.polynomial();
    let compare = if f.sign_at(&b).is_gt() { ">" } else { "<" };
    format!("(or (<= {} p) (and (< {} p) ({compare} {} 0.0)))", real(&b), real(&a), horner(f))
}
