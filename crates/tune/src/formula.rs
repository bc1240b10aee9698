//! An expression of the gains that is to be best, as a rational function of them.

use crate::asked::Gain;
use crate::objective::{SOURCE, expression};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use jurist_engine::error::{Code, Diagnostic, Diagnostics, Error, Source, Span};
use jurist_engine::model::{Expression, Factor, Node, Sign};
use jurist_engine::problem::Question;
use jurist_stability::boxes::range_over;
use std::sync::Arc;

/// Formulas of a greater degree or with longer numbers are not multiplied out.
const MOST_DEGREE: u64 = 32;
const MOST_BITS: u64 = 1 << 13;

/// A box is cut into so many parts at most to see that a formula is defined in it.
const MOST_PARTS: usize = 512;

/// Constants and formulas of parameters are not deeper in each other.
const MOST_DEPTH: usize = 64;

/// A rational function of the gains, in their order.
#[derive(Clone, Debug)]
pub(crate) struct Formula {
    above: MultiPoly,
    below: MultiPoly,
}

impl Formula {
    /// Of an objective as it is written, `max k*ki`; names that are no gains have the values of the question.
    ///
    /// # Errors
    /// `E-tune-objective` where a name has no value or the expression is no rational function; as [`Expression::parse`].
    pub fn of(text: &str, gains: &[Gain], question: &Question) -> Result<Formula, Error> {
        let source = Source::new(SOURCE, text);
        let reader = Reader { gains, question, source: &source };
        let expression = expression(text)?;
        let function = reader.value(&expression, MOST_DEPTH)?;
        if function.is_constant() {
            let error = refused("the objective is the same for all gains").at(expression.span, "a constant");
            return Err(reader.wrong(error.help("write an expression of the free gains, as in 'max k*ki'")));
        }
        let (above, below) = (function.numerator().clone(), function.denominator().clone());
        Ok(Formula { above, below })
    }

    /// Its numerator and its denominator.
    pub fn parts(&self) -> [&MultiPoly; 2] {
        [&self.above, &self.below]
    }

    /// Its value; `None` where it is undefined.
    pub fn at(&self, point: &[Rational]) -> Option<Rational> {
        self.above.eval(point).checked_div(&self.below.eval(point))
    }

    /// Two numbers between which its values over a closed box lie; `None` where it may be undefined.
    pub fn range(&self, sides: &[[Rational; 2]]) -> Option<[Rational; 2]> {
        let [low, high] = range_over(&self.above, sides);
        let [least, most] = range_over(&self.below, sides);
        if !least.sign().is_gt() && !most.is_negative() {
            return None;
        }
        let ends = [(&low, &least), (&low, &most), (&high, &least), (&high, &most)];
        let all: Vec<Rational> = ends.into_iter().filter_map(|(a, b)| a.checked_div(b)).collect();
        Some([all.iter().min()?.clone(), all.iter().max()?.clone()])
    }

    /// The same of a box that is cut into parts where that is needed.
    ///
    /// # Errors
    /// `E-tune-objective` where it is not seen that it is defined at all points.
    pub fn range_in_parts(&self, sides: &[[Rational; 2]], gains: &[Gain]) -> Result<[Rational; 2], Error> {
        let mut parts = vec![sides.to_vec()];
        let mut all: Vec<Rational> = Vec::new();
        let mut looked = 0;
        while let Some(part) = parts.pop() {
            looked += 1;
            match self.range(&part) {
                Some(ends) => all.extend(ends),
                None if looked > MOST_PARTS => return Err(self.undefined(gains)),
                None => {
                    let share = |k: &usize| (&part[*k][1] - &part[*k][0]).checked_div(&(&sides[*k][1] - &sides[*k][0]));
                    let axis = (0..part.len()).rev().max_by_key(share).expect("a gain is free");
                    let middle = part[axis][0].midpoint(&part[axis][1]);
                    for end in [0, 1] {
                        let mut half = part.clone();
                        half[axis][end] = middle.clone();
                        parts.push(half);
                    }
                }
            }
        }
        let ends = [all.iter().min(), all.iter().max()];
        Ok(ends.map(|end| end.expect("there is a part").clone()))
    }

    fn undefined(&self, gains: &[Gain]) -> Error {
        let names: Vec<&str> = gains.iter().map(|gain| gain.name.as_str()).collect();
        let error = refused("the objective divides by zero at some gains within the bounds, or nearly so");
        error.help(format!("give bounds that leave out the zeros of {}", self.below.display(&names))).into()
    }

    /// Whether its values over a closed box are above a number, or below it; `None` where that is not seen.
    pub fn is_above(&self, sides: &[[Rational; 2]], number: &Rational) -> Option<bool> {
        let [least, most] = range_over(&self.below, sides);
        let is_positive = match (least.sign().is_gt(), most.is_negative()) {
            (true, _) => true,
            (_, true) => false,
            _ => return None,
        };
        let [p, q] = [number.numerator(), number.denominator()];
        let scaled = |f: &MultiPoly, n: &Integer| f.scaled_by(n);
        let [low, high] = range_over(&scaled(&self.above, &q).minus(&scaled(&self.below, &p)), sides);
        match (low.sign().is_gt(), high.is_negative()) {
            (true, _) => Some(is_positive),
            (_, true) => Some(!is_positive),
            _ => None,
        }
    }
}

/// What names mean.
struct Reader<'a> {
    gains: &'a [Gain],
    question: &'a Question,
    /// Where the expression stands.
    source: &'a Arc<Source>,
}

impl Reader<'_> {
    fn value(&self, e: &Expression, depth: usize) -> Result<RationalFunction, Error> {
        let inner = |e: &Expression| self.value(e, depth);
        let by_zero = |span: Span| self.wrong(refused("the objective divides by zero").at(span, "zero for all gains"));
        match &e.node {
            Node::Number(value) => Ok(value.into()),
            Node::Name(name) => self.name(name, e.span, depth),
            Node::Negative(of) => Ok(-inner(of)?),
            Node::Sum(terms) => terms.iter().try_fold(RationalFunction::zero(), |sum, (sign, term)| {
                let term = inner(term)?;
                self.check([&sum, &term], 1, e.span)?;
                Ok(if *sign == Sign::Plus { &sum + &term } else { &sum - &term })
            }),
            Node::Product(factors) => factors.iter().try_fold(RationalFunction::one(), |product, (kind, factor)| {
                let value = inner(factor)?;
                self.check([&product, &value], 1, e.span)?;
                match kind {
                    Factor::Times => Ok(&product * &value),
                    Factor::Over => product.checked_div(&value).ok_or_else(|| by_zero(factor.span)),
                }
            }),
            Node::Power(base, exponent) => {
                let value = inner(base)?;
                self.check([&value, &RationalFunction::one()], exponent.unsigned_abs(), e.span)?;
                value.pow(*exponent).ok_or_else(|| by_zero(base.span))
            }
            Node::Call(..) => {
                let error = refused("functions are not known in an objective").at(e.span, "a function");
                Err(self.wrong(error.help("write a rational expression of the gains, as in 'max k*ki'")))
            }
        }
    }

    fn name(&self, name: &str, span: Span, depth: usize) -> Result<RationalFunction, Error> {
        if let Some(gain) = self.gains.iter().position(|gain| gain.name == name) {
            return Ok(RationalFunction::variable(gain));
        }
        if let Some(value) = self.question.values_set().get(name) {
            return Ok(value.into());
        }
        let model = self.question.model();
        if let (Some(constant), Some(depth)) = (model.constant(name), depth.checked_sub(1)) {
            return Reader { source: model.source(), ..*self }.value(&constant.expression, depth);
        }
        match self.question.nominal(name)? {
            Some(value) => Ok(value.into()),
            None => {
                let error = refused(&format!("'{name}' has no value in the objective")).at(span, "no value");
                Err(self.wrong(error.help(format!("give it one: --set {name}=VALUE"))))
            }
        }
    }

    /// An error where a product of both, to a power, is too large to be multiplied out.
    fn check(&self, both: [&RationalFunction; 2], power: u64, span: Span) -> Result<(), Error> {
        let parts = || both.iter().flat_map(|f| [f.numerator(), f.denominator()]);
        let degree: u64 = parts().map(MultiPoly::total_degree).sum();
        let bits: u64 = parts().map(MultiPoly::height_bits).sum();
        if degree.saturating_mul(power) <= MOST_DEGREE && bits.saturating_mul(power) <= MOST_BITS {
            return Ok(());
        }
        let error = refused("the objective is too large to be multiplied out").at(span, "becomes too large here");
        Err(self.wrong(error.help("write an expression of a lower degree")))
    }

    fn wrong(&self, error: Diagnostic) -> Error {
        Diagnostics::new(Some(Arc::clone(self.source)), vec![error]).into()
    }
}

fn refused(message: &str) -> Diagnostic {
    Diagnostic::error(Code::TuneObjective, message)
}
