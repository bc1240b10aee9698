//! Formulas and numbers in the notation of a program.

use super::Target;
use jurist_algebra::number::{Integer, Rational, parse_number};
use jurist_engine::model::{Expression, Factor, Level, Node, Sign};

/// A formula in the notation of a program.
pub(super) fn formula(target: &dyn Target, e: &Expression) -> String {
    let mut out = String::new();
    write(target, e, Level::Sum, &mut out);
    out
}

/// Writes a formula, in parentheses where it binds less tightly than `least`.
fn write(target: &dyn Target, e: &Expression, least: Level, out: &mut String) {
    let number = if let Node::Number(value) = &e.node { Some(in_formula(value)) } else { None };
    if level(e, number.as_deref()) < least {
        out.push('(');
        write(target, e, Level::Sum, out);
        out.push(')');
        return;
    }
    match &e.node {
        Node::Number(_) => out.push_str(&number.unwrap_or_default()),
        Node::Name(name) => out.push_str(name),
        Node::Negative(inner) => {
            out.push('-');
            write(target, inner, Level::Power, out);
        }
        Node::Sum(terms) => {
            for (i, (sign, term)) in terms.iter().enumerate() {
                out.push_str(sign.before(i == 0));
                let is_first = i == 0 && *sign == Sign::Plus;
                write(target, term, if is_first { Level::Negative } else { Level::Product }, out);
            }
        }
        Node::Product(factors) => {
            for (i, (factor, e)) in factors.iter().enumerate() {
                out.push_str(factor.before(i == 0));
                // A sign in front of all factors needs no parentheses.
                let is_first = i == 0 && *factor == Factor::Times;
                write(target, e, if is_first { Level::Negative } else { Level::Power }, out);
            }
        }
        Node::Power(base, exponent) => {
            write(target, base, Level::Atom, out);
            out.push_str(target.power());
            out.push_str(&if *exponent < 0 { format!("({exponent})") } else { exponent.to_string() });
        }
        Node::Call(function, inner) => {
            out.push_str(function.name());
            out.push('(');
            write(target, inner, Level::Sum, out);
            out.push(')');
        }
    }
}

/// The level of an expression, of a number that of its text.
fn level(e: &Expression, number: Option<&str>) -> Level {
    match (&e.node, number) {
        (Node::Number(value), Some(text)) if !value.is_negative() && !text.contains('/') => Level::Atom,
        _ => e.level(),
    }
}

/// Whole numbers up to this are exact in floating point.
const EXACT: i64 = 1 << 53;

/// A number in a formula: whole, a decimal where that is exact, a quotient, or the nearest decimal.
fn in_formula(value: &Rational) -> String {
    let is_short = |n: Integer| n.to_i64().is_some_and(|n| n.abs() <= EXACT);
    if value.is_integer() && is_short(value.numerator()) {
        return value.to_string();
    }
    let decimal = decimal(value);
    let is_exact = parse_number(&decimal).is_ok_and(|written| written == *value);
    if !is_exact && is_short(value.numerator()) && is_short(value.denominator()) {
        return value.to_string();
    }
    decimal
}

/// The shortest decimal that is read as the floating-point number nearest to this.
pub(super) fn decimal(value: &Rational) -> String {
    format!("{:?}", value.to_f64_approximate())
}
