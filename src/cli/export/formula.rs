//! Formulas that stay as they are written, put together with as little of 0 and 1 as possible.

use jurist_algebra::number::Rational;
use jurist_engine::model::{Expression, Factor, Node, Sign};

/// An expression of this form, which stands nowhere.
pub(super) fn of_node(node: Node) -> Expression {
    let mut made = Expression::number(Rational::ZERO);
    made.node = node;
    made
}

/// A whole number.
pub(super) fn whole(value: i64) -> Expression {
    Expression::number(value)
}

/// The number that an expression is without any name; powers and functions are left alone.
pub(super) fn as_number(e: &Expression) -> Option<Rational> {
    match &e.node {
        Node::Number(value) => Some(value.clone()),
        Node::Negative(inner) => as_number(inner).map(|value| -value),
        Node::Sum(terms) => terms.iter().try_fold(Rational::ZERO, |sum, (sign, term)| {
            let value = as_number(term)?;
            Some(if *sign == Sign::Plus { sum + value } else { sum - value })
        }),
        Node::Product(factors) => factors.iter().try_fold(Rational::ONE, |product, (factor, e)| {
            let value = as_number(e)?;
            if *factor == Factor::Times { Some(product * value) } else { product.checked_div(&value) }
        }),
        Node::Name(_) | Node::Power(..) | Node::Call(..) => None,
    }
}

pub(super) fn is_zero(e: &Expression) -> bool {
    as_number(e).is_some_and(|value| value.is_zero())
}

pub(super) fn is_one(e: &Expression) -> bool {
    as_number(e).is_some_and(|value| value == Rational::ONE)
}

/// `-e`.
pub(super) fn negative(e: Expression) -> Expression {
    match e.node {
        Node::Negative(inner) => *inner,
        Node::Number(value) => Expression::number(-value),
        Node::Sum(terms) => {
            let other = |sign| if sign == Sign::Plus { Sign::Minus } else { Sign::Plus };
            of_node(Node::Sum(terms.into_iter().map(|(sign, term)| (other(sign), term)).collect()))
        }
        node => of_node(Node::Negative(Box::new(of_node(node)))),
    }
}

/// `a + b` or `a - b`.
pub(super) fn sum(a: Expression, sign: Sign, b: Expression) -> Expression {
    if let (Some(x), Some(y)) = (as_number(&a), as_number(&b)) {
        return Expression::number(if sign == Sign::Plus { x + y } else { x - y });
    }
    if is_zero(&b) {
        return a;
    }
    let b = if sign == Sign::Plus { b } else { negative(b) };
    if is_zero(&a) {
        return b;
    }
    let mut terms = terms_of(a);
    terms.extend(terms_of(b));
    of_node(Node::Sum(terms))
}

fn terms_of(e: Expression) -> Vec<(Sign, Expression)> {
    match e.node {
        Node::Sum(terms) => terms,
        Node::Negative(inner) => vec![(Sign::Minus, *inner)],
        Node::Number(value) if value.is_negative() => vec![(Sign::Minus, Expression::number(-value))],
        node => vec![(Sign::Plus, of_node(node))],
    }
}

/// `a b`.
pub(super) fn product(a: Expression, b: Expression) -> Expression {
    if let (Some(x), Some(y)) = (as_number(&a), as_number(&b)) {
        return Expression::number(x * y);
    }
    if is_zero(&a) || is_zero(&b) {
        return whole(0);
    }
    if is_one(&a) {
        return b;
    }
    if is_one(&b) {
        return a;
    }
    let is_minus_one = |e: &Expression| as_number(e).is_some_and(|value| value == -Rational::ONE);
    if is_minus_one(&a) {
        return negative(b);
    }
    if is_minus_one(&b) {
        return negative(a);
    }
    match (a.node, b.node) {
        (Node::Negative(a), b) => negative(product(*a, of_node(b))),
        (a, Node::Negative(b)) => negative(product(of_node(a), *b)),
        (Node::Number(a), b) if a.is_negative() => negative(product(Expression::number(-a), of_node(b))),
        (a, b) => {
            let mut factors = factors_of(of_node(a));
            factors.extend(factors_of(of_node(b)));
            of_node(Node::Product(factors))
        }
    }
}

fn factors_of(e: Expression) -> Vec<(Factor, Expression)> {
    match e.node {
        Node::Product(factors) => factors,
        node => vec![(Factor::Times, of_node(node))],
    }
}

/// `a/b`.
pub(super) fn quotient(a: Expression, b: Expression) -> Expression {
    if is_one(&b) || is_zero(&a) {
        return a;
    }
    if let (Some(x), Some(y)) = (as_number(&a), as_number(&b))
        && let Some(value) = x.checked_div(&y)
    {
        return Expression::number(value);
    }
    if let Node::Negative(inner) = a.node {
        return negative(quotient(*inner, b));
    }
    // A one in front is left out, so that it is not in the middle of a product.
    let mut factors = if is_one(&a) { Vec::new() } else { factors_of(a) };
    factors.push((Factor::Over, b));
    of_node(Node::Product(factors))
}

/// `e^n`.
pub(super) fn power(e: Expression, exponent: i64) -> Expression {
    match exponent {
        0 => whole(1),
        1 => e,
        _ if is_one(&e) => e,
        _ => of_node(Node::Power(Box::new(e), exponent)),
    }
}
