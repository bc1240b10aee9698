//! Linear expressions in signals or states.

use super::scalar::{Scope, checked_product, checked_sum};
use super::walk::{Failure, Meaning, evaluate};
use crate::error::{Code, Diagnostic, Span};
use crate::text::{Expression, Function, Sign};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;
use std::collections::{BTreeMap, HashMap};

/// A constant part and the coefficient of each signal, by its number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Linear {
    constant: RationalFunction,
    /// The coefficients; a signal that is written is listed even when its coefficient is zero.
    pub coefficients: BTreeMap<usize, RationalFunction>,
}

struct InSignals<'s, 'a> {
    scope: &'s mut Scope<'a>,
    signals: &'s HashMap<&'s str, usize>,
}

/// The coefficients of a linear expression without a constant term.
pub(crate) fn linear(
    e: &Expression,
    signals: &HashMap<&str, usize>,
    scope: &mut Scope<'_>,
) -> Result<BTreeMap<usize, RationalFunction>, Failure> {
    let value = evaluate(e, &mut InSignals { scope, signals })?;
    if !value.constant.is_zero() {
        return Err(Diagnostic::error(Code::NotLinear, "a linear expression in signals has no constant term")
            .at(e.span, "contains a term without a signal")
            .help("feed constant values in through an external input")
            .into());
    }
    let reduced = |(i, c)| Some((i, scope.reduced(c)?));
    value.coefficients.into_iter().map(reduced).collect::<Option<_>>().ok_or_else(|| too_large(e.span))
}

fn not_linear(message: &str, span: Span) -> Failure {
    Diagnostic::error(Code::NotLinear, message)
        .at(span, "not linear in the signals")
        .help("only sums of signals times constants and parameters are linear")
        .into()
}

fn too_large(span: Span) -> Failure {
    super::walk::too_large(span)
}

impl Linear {
    fn scaled(&self, factor: &RationalFunction) -> Option<Linear> {
        let scale = |(&i, c): (&usize, &RationalFunction)| Some((i, checked_product(c, factor)?));
        Some(Linear {
            constant: checked_product(&self.constant, factor)?,
            coefficients: self.coefficients.iter().map(scale).collect::<Option<_>>()?,
        })
    }
}

impl Meaning for InSignals<'_, '_> {
    type Value = Linear;

    fn number(&mut self, value: &Rational) -> Result<Linear, Failure> {
        Ok(Linear { constant: self.scope.number(value)?, ..Linear::default() })
    }

    fn name(&mut self, name: &str, span: Span) -> Result<Linear, Failure> {
        if let Some(&i) = self.signals.get(name) {
            return Ok(Linear { coefficients: BTreeMap::from([(i, RationalFunction::one())]), ..Linear::default() });
        }
        Ok(Linear { constant: self.scope.name(name, span)?, ..Linear::default() })
    }

    fn negative(&mut self, value: Linear) -> Result<Linear, Failure> {
        let coefficients = value.coefficients.into_iter().map(|(i, c)| (i, -c)).collect();
        Ok(Linear { constant: -value.constant, coefficients })
    }

    fn sum(&mut self, mut a: Linear, sign: Sign, b: Linear, span: Span) -> Result<Linear, Failure> {
        a.constant = self.scope.sum(a.constant, sign, b.constant, span)?;
        for (i, c) in b.coefficients {
            let entry = a.coefficients.entry(i).or_default();
            *entry = checked_sum(entry, sign, &c).ok_or_else(|| too_large(span))?;
        }
        Ok(a)
    }

    fn product(&mut self, a: Linear, b: Linear, span: Span) -> Result<Linear, Failure> {
        let (signals, factor) = match (a.coefficients.is_empty(), b.coefficients.is_empty()) {
            (false, false) => return Err(not_linear("a product of signals", span)),
            (true, _) => (b, a.constant),
            (false, true) => (a, b.constant),
        };
        signals.scaled(&factor).ok_or_else(|| too_large(span))
    }

    fn quotient(&mut self, a: Linear, b: Linear, span: Span) -> Result<Linear, Failure> {
        if !b.coefficients.is_empty() {
            return Err(not_linear("a division by a signal", span));
        }
        let inverse = self.scope.quotient(RationalFunction::one(), b.constant, span)?;
        a.scaled(&inverse).ok_or_else(|| too_large(span))
    }

    fn power(&mut self, base: Linear, exponent: i64, span: Span) -> Result<Linear, Failure> {
        if base.coefficients.is_empty() {
            return Ok(Linear { constant: self.scope.power(base.constant, exponent, span)?, ..Linear::default() });
        }
        if exponent == 1 { Ok(base) } else { Err(not_linear("a power of a signal", span)) }
    }

    fn call(&mut self, function: Function, value: Linear, span: Span) -> Result<Linear, Failure> {
        if !value.coefficients.is_empty() {
            return Err(not_linear("a function of a signal", span));
        }
        Ok(Linear { constant: self.scope.call(function, value.constant, span)?, ..Linear::default() })
    }
}
