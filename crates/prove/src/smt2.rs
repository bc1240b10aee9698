//! The statement about one parameter in the language of SMT solvers.

use super::refuse_transcendental;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly, RealAlgebraic, UniPoly};
use jurist_engine::answer::Answer;
use jurist_model::error::Error;
use jurist_stability::{Shape, StableSet, jury_table_with, routh_table};
use std::fmt::Write;

/// An SMT-LIB 2 script (the SMT-LIB Standard, version 2.6) that asks for a parameter value in the domain at which the classical
/// conditions (Jury's, or Routh's) and the claimed set differ. `unsat` means that they are the same set.
///
/// The only variable is the parameter. An irrational end is no variable either: with `f` its polynomial and `(a, b)`
/// its enclosure, `x < end` is `x <= a or (x < b and f(x) has the sign of f(a))`.
///
/// The conditions are those of the table whose rows are divided by the entry two rows above, so that their degrees grow by
/// addition: `|first| > |last|` of a row stands as "`first - last` and `first + last` have the same sign".
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::Model;
/// let (drive, budget) = (Model::drive(), Budget::unlimited());
/// let script = jurist_prove::smt2(&drive.ask().free("K_pwm").stable_set(&budget)?, &budget)?;
/// assert!(script.ends_with("(check-sat)\n"));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
///
/// Cost: one table, `O(n^2)` operations on polynomials in the parameter, and its text.
///
/// # Errors
/// [`Error::Stopped`] when the budget runs out; [`Error::Refused`] (`E-no-certificate`) where the limits are not
/// algebraic numbers.
pub fn smt2(answer: &Answer<StableSet>, budget: &Budget) -> Result<String, Error> {
    budget.enter(|| {
        let problem = answer.problem();
        problem.refuse_complex(budget)?;
        let (parameter, set) = (problem.parameter(), answer.value());
        refuse_transcendental(set, "no statement for solvers")?;
        let mut domain = Vec::new();
        if let Some(lower) = &parameter.domain.lower {
            domain.push(format!("(< {} p)", real(lower)));
        }
        if let Some(upper) = &parameter.domain.upper {
            domain.push(format!("(< p {})", real(upper)));
        }
        let mut conditions = Vec::new();
        match problem.parametric(budget)? {
            None => conditions.push("false".to_owned()),
            Some(p) => {
                let not_zero = p.poles().iter().chain([p.denominator(), p.content()]);
                let not_zero = not_zero.filter(|f| f.is_zero() || !f.is_constant());
                conditions.extend(not_zero.map(|f| format!("(distinct {} 0.0)", horner(f))));
                match problem.shape() {
                    Shape::UnitDisc => jury(p.polynomial(), p.formal_degree(), &mut conditions),
                    Shape::LeftHalfPlane => routh(p.polynomial(), p.formal_degree(), &mut conditions),
                }
            }
        }
        let mut claimed = Vec::new();
        for interval in set.intervals() {
            let lower = interval.lower.as_ref().and_then(|e| e.value.algebraic()).map(above);
            let upper = interval.upper.as_ref().and_then(|e| e.value.algebraic()).map(below);
            claimed.push(joined("and", lower.into_iter().chain(upper).collect(), "true"));
        }
        let mut out = String::new();
        let _ = writeln!(out, "; p is the parameter '{}'", parameter.name.replace(['\n', '\r'], " "));
        for (name, value) in problem.set() {
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
    })?
}

/// Jury's conditions: `a_n D(1) > 0`, `(-1)^n a_n D(-1) > 0`, `|a_n| > |a_0|`, and `|first| > |last|` of every further row. A divisor
/// of a row is the first entry of an earlier one, which is not zero where that row's condition holds.
fn jury(d: &Poly<UniPoly>, n: usize, out: &mut Vec<String>) {
    if n == 0 {
        return out.push(format!("(distinct {} 0.0)", horner(&d.coeff(0))));
    }
    let value = |x: i64| d.eval(&UniPoly::constant(Integer::from(x)));
    let at_minus_one = if n.is_multiple_of(2) { value(-1) } else { value(-1).negated() };
    out.push(same_sign(&d.coeff(n), &value(1)));
    out.push(same_sign(&d.coeff(n), &at_minus_one));
    for (i, (first, last)) in jury_table_with(d, n, true).end_entries().enumerate() {
        let (large, small) = if i == 0 { (last, first) } else { (first, last) };
        out.push(same_sign(&large.minus(small), &large.plus(small)));
    }
}

/// Routh's conditions: all Hurwitz determinants have the sign of `a_n` to the power of their order.
fn routh(d: &Poly<UniPoly>, n: usize, out: &mut Vec<String>) {
    let lead = d.coeff(n);
    if n == 0 {
        return out.push(format!("(distinct {} 0.0)", horner(&lead)));
    }
    for (k, minor) in routh_table(d, n).first_column().enumerate().skip(1) {
        let power = if k % 2 == 0 { UniPoly::one() } else { lead.clone() };
        out.push(same_sign(&power, minor));
    }
}

/// Both polynomials are positive, or both are negative.
fn same_sign(f: &UniPoly, g: &UniPoly) -> String {
    let (f, g) = (without_content(f), without_content(g));
    let both = |sign: &str| {
        let parts = [&f, &g].into_iter().filter(|p| !is_positive_constant(p));
        let parts: Vec<String> = parts.map(|p| format!("({sign} {} 0.0)", horner(p))).collect();
        joined("and", parts, "true")
    };
    if is_positive_constant(&f) || is_positive_constant(&g) {
        return both(">");
    }
    format!("(or {} {})", both(">"), both("<"))
}

/// Divided by a positive integer: `primitive_part` would change signs.
fn without_content(f: &UniPoly) -> UniPoly {
    if f.is_zero() { f.clone() } else { f.div_exact_scalar(&f.content()).expect("the content divides") }
}

fn is_positive_constant(f: &UniPoly) -> bool {
    f.is_constant() && f.coeff(0).sign().is_gt()
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
