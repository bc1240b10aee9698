//! Walking an expression with a meaning for each of its operations.

use crate::error::{Code, Diagnostic, Span};
use crate::text::{Expression, Factor, Function, Node, Sign};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;

/// Why an expression has no value.
#[derive(Clone, Debug)]
pub(crate) enum Failure {
    /// The text is wrong.
    Wrong(Box<Diagnostic>),
    /// The budget ran out.
    Exhausted(Exhausted),
    /// A name in it has no value because of an error that has been reported already.
    Poisoned,
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Failure::Wrong(Box::new(diagnostic))
    }
}

impl From<Exhausted> for Failure {
    fn from(exhausted: Exhausted) -> Self {
        Failure::Exhausted(exhausted)
    }
}

/// What the operations of an expression mean.
pub(crate) trait Meaning {
    /// What an expression evaluates to.
    type Value;
    fn number(&mut self, value: &Rational) -> Result<Self::Value, Failure>;
    fn name(&mut self, name: &str, span: Span) -> Result<Self::Value, Failure>;
    fn negative(&mut self, value: Self::Value) -> Result<Self::Value, Failure>;
    fn sum(&mut self, a: Self::Value, sign: Sign, b: Self::Value, span: Span) -> Result<Self::Value, Failure>;
    fn product(&mut self, a: Self::Value, b: Self::Value, span: Span) -> Result<Self::Value, Failure>;
    /// `span` is the divisor's.
    fn quotient(&mut self, a: Self::Value, b: Self::Value, span: Span) -> Result<Self::Value, Failure>;
    /// `span` is the base's.
    fn power(&mut self, base: Self::Value, exponent: i64, span: Span) -> Result<Self::Value, Failure>;
    /// `span` is that of the whole call.
    fn call(&mut self, function: Function, value: Self::Value, span: Span) -> Result<Self::Value, Failure>;
}

/// The value of `e`. Recursion is as deep as the nesting of the text, which the parser limits.
pub(crate) fn evaluate<M: Meaning>(e: &Expression, meaning: &mut M) -> Result<M::Value, Failure> {
    match &e.node {
        Node::Number(value) => meaning.number(value),
        Node::Name(name) => meaning.name(name, e.span),
        Node::Negative(inner) => {
            let value = evaluate(inner, meaning)?;
            meaning.negative(value)
        }
        Node::Sum(terms) => {
            let mut sum = None;
            for (sign, term) in terms {
                let value = evaluate(term, meaning)?;
                sum = Some(match (sum, sign) {
                    (None, Sign::Plus) => value,
                    (None, Sign::Minus) => meaning.negative(value)?,
                    (Some(sum), _) => meaning.sum(sum, *sign, value, term.span)?,
                });
            }
            sum.map_or_else(|| meaning.number(&Rational::ZERO), Ok)
        }
        Node::Product(factors) => {
            let mut product = None;
            for (factor, operand) in factors {
                let value = evaluate(operand, meaning)?;
                product = Some(match (product, factor) {
                    (None, Factor::Times) => value,
                    (None, Factor::Over) => {
                        let one = meaning.number(&Rational::ONE)?;
                        meaning.quotient(one, value, operand.span)?
                    }
                    (Some(product), Factor::Times) => meaning.product(product, value, operand.span)?,
                    (Some(product), Factor::Over) => meaning.quotient(product, value, operand.span)?,
                });
            }
            product.map_or_else(|| meaning.number(&Rational::ONE), Ok)
        }
        Node::Power(base, exponent) => {
            let value = evaluate(base, meaning)?;
            meaning.power(value, *exponent, base.span)
        }
        Node::Call(function, inner) => {
            let value = evaluate(inner, meaning)?;
            meaning.call(*function, value, e.span)
        }
    }
}

/// The error of a division by something that is zero whatever the parameters are.
pub(crate) fn division_by_zero(span: Span) -> Failure {
    Diagnostic::error(Code::DivisionByZero, "division by an expression that is identically zero")
        .at(span, "zero for all values of the parameters")
        .into()
}

/// The error of a value that grows beyond every use.
pub(crate) fn too_large(span: Span) -> Failure {
    Diagnostic::error(Code::TooLarge, "the expression is too large to be multiplied out")
        .at(span, "becomes too large here")
        .help("lower the exponents or the number of parameters")
        .into()
}
