//! Rational expressions in z (or s): sums use the least common denominator, products and
//! quotients never cancel.

use super::scalar::Scope;
use super::walk::{Failure, Meaning, division_by_zero, evaluate, too_large};
use super::zpoly::{Reduced, ZPoly};
use crate::complex::has_unit;
use crate::error::{Code, Diagnostic, Span};
use crate::text::{Expression, Factor, Function, Node, Sign};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

/// Orders beyond this are refused.
pub(crate) const MAX_ORDER: usize = 2000;

/// A numerator and a denominator as they stand, common factors included.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fraction {
    pub numerator: ZPoly,
    pub denominator: ZPoly,
}

/// Evaluates expressions in the polynomial variable.
pub(crate) struct InVariable<'s, 'a> {
    pub scope: &'s mut Scope<'a>,
    /// `z` or `s`.
    pub variable: &'s str,
    /// Whether a denominator may contain the variable.
    pub rational: bool,
}

/// A transfer expression.
pub(crate) fn fraction(e: &Expression, variable: &str, scope: &mut Scope<'_>) -> Result<Fraction, Failure> {
    let fraction = evaluate(e, &mut InVariable { scope, variable, rational: true })?;
    if fraction.looks_ahead(scope) {
        let error = Diagnostic::error(Code::DeadTime, "the transfer function looks ahead: it divides by a dead time");
        return Err(error
            .at(e.span, "a prediction")
            .help("a dead time tau is written exp(-tau*s), a factor of the numerator")
            .into());
    }
    Ok(fraction)
}

/// The transfer expression of a block behind a hold: what is rational in `s`, and the dead time of factors `exp(-tau*s)` of the whole.
pub(crate) fn held_fraction(e: &Expression, scope: &mut Scope<'_>) -> Result<(Fraction, RationalFunction), Failure> {
    let mut exponents = Vec::new();
    let rest = without_exponentials(e, &mut exponents);
    let mut meaning = InVariable { scope: &mut *scope, variable: "s", rational: true };
    let mut delay = RationalFunction::zero();
    for exponent in exponents {
        let value = evaluate(exponent, &mut meaning)?;
        delay = &delay + &meaning.time(&value, exponent.span)?;
    }
    Ok((fraction(&rest, "s", scope)?, delay))
}

/// An expression without those factors of the whole that are exponentials of `s`, and their exponents.
fn without_exponentials<'e>(e: &'e Expression, exponents: &mut Vec<&'e Expression>) -> Expression {
    let node = match &e.node {
        Node::Call(Function::Exp, exponent) if exponent.names().contains("s") => {
            exponents.push(exponent);
            Node::Number(1.into())
        }
        Node::Negative(inner) => Node::Negative(Box::new(without_exponentials(inner, exponents))),
        Node::Product(factors) => {
            let of = |(factor, e): &'e (Factor, Expression)| match factor {
                Factor::Times => (Factor::Times, without_exponentials(e, exponents)),
                Factor::Over => (Factor::Over, e.clone()),
            };
            Node::Product(factors.iter().map(of).collect())
        }
        node => node.clone(),
    };
    Expression { span: e.span, node }
}

/// An expression that is a polynomial in the variable.
pub(crate) fn polynomial(e: &Expression, variable: &str, scope: &mut Scope<'_>) -> Result<ZPoly, Failure> {
    let Fraction { numerator, denominator } = evaluate(e, &mut InVariable { scope, variable, rational: false })?;
    assert!(denominator.is_one());
    Ok(numerator)
}

impl Fraction {
    /// Whether the numerator is less delayed than the denominator is as a whole; not known where two dead times have no
    /// ratio that is a number.
    fn looks_ahead(&self, scope: &Scope<'_>) -> bool {
        let least = |p: &ZPoly| -> Option<Rational> {
            let mut least: Option<Rational> = None;
            for f in p.coefficients().iter().filter(|f| !f.is_zero()) {
                let delay = scope.least_delay(f.numerator())? - scope.least_delay(f.denominator())?;
                least = Some(least.map_or(delay.clone(), |known| known.min(delay)));
            }
            least
        };
        match (least(&self.numerator), least(&self.denominator)) {
            (Some(numerator), Some(denominator)) => numerator < denominator,
            _ => false,
        }
    }

    fn constant(value: RationalFunction) -> Self {
        Fraction { numerator: ZPoly::constant(value), denominator: ZPoly::one() }
    }

    fn sum(&self, sign: Sign, other: &Self, reduced: &Reduced<'_>) -> Option<Self> {
        let (d, e) = (&self.denominator, &other.denominator);
        if d == e {
            return Some(Fraction { numerator: self.numerator.sum(sign, &other.numerator)?, denominator: d.clone() });
        }
        // With g = gcd(d, e) the least common denominator is d (e/g) = e (d/g).
        let (e_rest, d_rest) = if d.degree() == 0 || e.degree() == 0 {
            (e.clone(), d.clone())
        } else {
            // Without denominators: what is left of `d` and `e` then has none either. A monic divisor would leave its
            // leading coefficient behind as a factor, which has zeros of its own where it contains a dead time.
            let g = d.gcd(e, reduced)?.primitive()?;
            (e.divide(&g, reduced)?.0, d.divide(&g, reduced)?.0)
        };
        let left = self.numerator.product(&e_rest)?;
        let right = other.numerator.product(&d_rest)?;
        Some(Fraction { numerator: left.sum(sign, &right)?, denominator: d.product(&e_rest)? })
    }
}

impl InVariable<'_, '_> {
    fn divided(&mut self, a: Fraction, b: &Fraction, span: Span) -> Result<Fraction, Failure> {
        if self.scope.vanishes(&b.numerator)? {
            return Err(division_by_zero(span));
        }
        if (b.numerator.degree() > 0 || self.scope.is_delayed(&b.numerator.leading())) && !self.rational {
            let v = self.variable;
            return Err(Diagnostic::error(
                Code::NotPolynomial,
                format!("the characteristic polynomial divides by {v}"),
            )
            .at(span, format!("contains {v}"))
            .help("multiply the equation by its denominators, or use [[block]] with transfer functions")
            .into());
        }
        let polynomials = b.numerator.coefficients().iter().map(|c| c.numerator().clone()).collect();
        self.scope.divides_by(polynomials);
        let too_large = || too_large(span);
        let mut numerator = a.numerator.product(&b.denominator).ok_or_else(too_large)?;
        let mut denominator = a.denominator;
        if b.numerator.degree() == 0 && !self.scope.is_delayed(&b.numerator.leading()) {
            // A divisor without z goes into the coefficients.
            let inverse = b.numerator.leading().recip().ok_or_else(|| division_by_zero(span))?;
            numerator = numerator.scaled(&inverse).ok_or_else(too_large)?;
        } else {
            denominator = denominator.product(&b.numerator).ok_or_else(too_large)?;
        }
        self.limited(Fraction { numerator, denominator }, span)
    }

    fn limited(&self, f: Fraction, span: Span) -> Result<Fraction, Failure> {
        if f.numerator.degree().max(f.denominator.degree()) > MAX_ORDER {
            return Err(too_large(span));
        }
        if self.scope.unit.is_none() {
            return Ok(f);
        }
        let reduced = |p: &ZPoly| p.try_map(&|c| self.scope.reduced(c)).ok_or_else(|| division_by_zero(span));
        Ok(Fraction { numerator: reduced(&f.numerator)?, denominator: reduced(&f.denominator)? })
    }
}

impl Meaning for InVariable<'_, '_> {
    type Value = Fraction;

    fn number(&mut self, value: &Rational) -> Result<Fraction, Failure> {
        Ok(Fraction::constant(value.into()))
    }

    fn name(&mut self, name: &str, span: Span) -> Result<Fraction, Failure> {
        if name == self.variable {
            return Ok(Fraction { numerator: ZPoly::power_of_variable(1), denominator: ZPoly::one() });
        }
        self.scope.name(name, span).map(Fraction::constant)
    }

    fn negative(&mut self, f: Fraction) -> Result<Fraction, Failure> {
        Ok(Fraction { numerator: f.numerator.negated(), denominator: f.denominator })
    }

    fn sum(&mut self, a: Fraction, sign: Sign, b: Fraction, span: Span) -> Result<Fraction, Failure> {
        self.scope.budget.check()?;
        let sum = a.sum(sign, &b, &|f| self.scope.reduced(f)).ok_or_else(|| too_large(span))?;
        self.limited(sum, span)
    }

    fn product(&mut self, a: Fraction, b: Fraction, span: Span) -> Result<Fraction, Failure> {
        self.scope.budget.check()?;
        let too_large = || too_large(span);
        let budget = self.scope.budget;
        let product = |a: &ZPoly, b: &ZPoly| match a.product_within(b, budget) {
            Some(product) => Ok(product),
            None => budget.check().map_err(Failure::from).and(Err(too_large())),
        };
        let numerator = product(&a.numerator, &b.numerator)?;
        let denominator = product(&a.denominator, &b.denominator)?;
        self.limited(Fraction { numerator, denominator }, span)
    }

    fn quotient(&mut self, a: Fraction, b: Fraction, span: Span) -> Result<Fraction, Failure> {
        self.scope.budget.check()?;
        self.divided(a, &b, span)
    }

    fn power(&mut self, base: Fraction, exponent: i64, span: Span) -> Result<Fraction, Failure> {
        let degree = base.numerator.degree().max(base.denominator.degree()) as u64;
        if degree.saturating_mul(exponent.unsigned_abs()) > MAX_ORDER as u64 {
            return Err(too_large(span));
        }
        self.scope.budget.check()?;
        let looks_ahead = exponent < 0 && self.scope.is_delayed(&base.numerator.leading());
        if degree == 0 && !base.numerator.is_zero() && base.denominator.is_one() && !looks_ahead {
            // A power of numbers and parameters has its own limits.
            return self.scope.power(base.numerator.leading(), exponent, span).map(Fraction::constant);
        }
        let base = if exponent < 0 { self.divided(Fraction::constant(1.into()), &base, span)? } else { base };
        let budget = self.scope.budget;
        let raise = |p: &ZPoly| match p.power(exponent.unsigned_abs(), budget) {
            Some(power) => Ok(power),
            None => budget.check().map_err(Failure::from).and(Err(too_large(span))),
        };
        let raised = Fraction { numerator: raise(&base.numerator)?, denominator: raise(&base.denominator)? };
        self.limited(raised, span)
    }

    fn call(&mut self, function: Function, value: Fraction, span: Span) -> Result<Fraction, Failure> {
        if value.numerator.degree() == 0 && value.denominator.degree() == 0 {
            let inner = value.numerator.leading().checked_div(&value.denominator.leading());
            let inner = inner.and_then(|x| self.scope.reduced(x)).ok_or_else(|| division_by_zero(span))?;
            return self.scope.call(function, inner, span).map(Fraction::constant);
        }
        if function == Function::Exp && self.variable == "s" && self.scope.is_continuous {
            return self.dead_time(&value, span).map(Fraction::constant);
        }
        Err(of_the_variable(function, self.variable, span).into())
    }
}

impl InVariable<'_, '_> {
    /// `exp(-x s)`.
    fn dead_time(&mut self, exponent: &Fraction, span: Span) -> Result<RationalFunction, Failure> {
        let time = self.time(exponent, span)?;
        self.scope.delay(time, span)
    }

    /// The `x` of `-x s`.
    fn time(&mut self, exponent: &Fraction, span: Span) -> Result<RationalFunction, Failure> {
        let (n, d) = (&exponent.numerator, &exponent.denominator);
        if n.degree() != 1 || !n.coefficient(0).is_zero() || d.degree() > 0 {
            let error = Diagnostic::error(Code::DeadTime, "the exponent is not a dead time times s");
            return Err(error
                .at(span, "not of the form exp(-tau*s)")
                .help("a dead time tau is written exp(-tau*s)")
                .into());
        }
        let time = n.leading().checked_div(&d.leading()).and_then(|x| self.scope.reduced(x));
        let time = -time.ok_or_else(|| division_by_zero(span))?;
        if has_unit(&time, self.scope.unit) {
            let error = Diagnostic::error(Code::Complex, "a dead time is real").at(span, "a complex value");
            return Err(error.help("exp(j*phi) of a constant is a factor of its own").into());
        }
        Ok(time)
    }
}

/// The error of a function of z or s.
fn of_the_variable(function: Function, variable: &str, span: Span) -> Diagnostic {
    let message = format!("'{}' of {variable} is not rational in {variable}", function.name());
    let error = Diagnostic::error(Code::Function, message).at(span, format!("contains {variable}"));
    error.help(match (function, variable) {
        (Function::Exp, "s") => {
            "dead time of a plant behind a hold is a factor of the whole, exp(-tau*s)*G(s) with discretize = \"zoh\""
        }
        (Function::Exp, _) => "a delay of whole samples is 1/z^n; z itself is exp(s*T)",
        _ => "functions have arguments of constants and parameters",
    })
}
