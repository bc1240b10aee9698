//! Transfer functions as lists of coefficients that stay formulas. Numerators and denominators are kept as products, so that nothing
//! is multiplied out that needs not be.

use super::formula::{as_number, is_zero, negative, power, product, quotient, sum, whole};
use jurist_algebra::number::Rational;
use jurist_engine::model::{Expression, Factor, Node, Sign};

/// Coefficients from the constant term up.
pub(super) type Polynomial = Vec<Expression>;

/// Powers of the variable, or of a factor, beyond this are not written out.
const MOST: u64 = 200;

/// A product: a factor without the variable, a power of the variable, and other polynomials.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub scale: Expression,
    pub power: usize,
    pub factors: Vec<Polynomial>,
}

/// A numerator and a denominator; that has no factor without the variable.
#[derive(Clone, Debug)]
pub(super) struct Fraction {
    pub numerator: Side,
    pub denominator: Side,
}

impl Side {
    fn scalar(scale: Expression) -> Side {
        Side { scale, power: 0, factors: Vec::new() }
    }

    fn is_scalar(&self) -> bool {
        self.power == 0 && self.factors.is_empty()
    }

    fn times(mut self, other: Side) -> Side {
        self.factors.extend(other.factors);
        Side { scale: product(self.scale, other.scale), power: self.power + other.power, ..self }
    }

    pub fn degree(&self) -> usize {
        self.power + self.factors.iter().map(|f| f.len() - 1).sum::<usize>()
    }

    /// Multiplied out; `None` where the formulas of the coefficients would be long.
    pub fn expanded(&self) -> Option<Polynomial> {
        let all = self.factors.iter().try_fold(vec![self.scale.clone()], |all, factor| multiplied(&all, factor))?;
        let mut shifted = vec![whole(0); self.power];
        shifted.extend(all);
        Some(shifted)
    }
}

fn multiplied(a: &Polynomial, b: &Polynomial) -> Option<Polynomial> {
    /// Names, numbers and operations in the coefficients of a product.
    const LONGEST: usize = 2000;
    let mut out = vec![whole(0); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            let term = product(x.clone(), y.clone());
            out[i + j] = sum(std::mem::replace(&mut out[i + j], whole(0)), Sign::Plus, term);
        }
    }
    (out.iter().map(size).sum::<usize>() <= LONGEST).then_some(out)
}

/// How many names, numbers and operations there are.
fn size(e: &Expression) -> usize {
    1 + match &e.node {
        Node::Number(_) | Node::Name(_) => 0,
        Node::Negative(inner) | Node::Power(inner, _) | Node::Call(_, inner) => size(inner),
        Node::Sum(terms) => terms.iter().map(|(_, e)| size(e)).sum(),
        Node::Product(factors) => factors.iter().map(|(_, e)| size(e)).sum(),
    }
}

/// A polynomial as a product: numbers in front, and the power of the variable, are split off.
fn side_of(mut p: Polynomial) -> Side {
    while p.last().is_some_and(is_zero) {
        p.pop();
    }
    if p.is_empty() {
        return Side::scalar(whole(0));
    }
    let power = p.iter().take_while(|c| is_zero(c)).count();
    let mut p = p.split_off(power);
    if p.len() == 1 {
        return Side { scale: p.remove(0), power, factors: Vec::new() };
    }
    // Of two factors that are one but for a number, each has the same form.
    let numbers: Option<Vec<Rational>> = p.iter().map(as_number).collect();
    let mut scale = whole(1);
    if let Some(numbers) = numbers
        && let Some(leading) = numbers.last().cloned()
    {
        let monic = numbers.iter().map(|c| c.checked_div(&leading));
        if let Some(monic) = monic.collect::<Option<Vec<Rational>>>() {
            p = monic.into_iter().map(Expression::number).collect();
            scale = Expression::number(leading);
        }
    }
    Side { scale, power, factors: vec![p] }
}

impl Fraction {
    fn scalar(value: Expression) -> Fraction {
        Fraction { numerator: Side::scalar(value), denominator: Side::scalar(whole(1)) }
    }

    fn is_scalar(&self) -> bool {
        self.numerator.is_scalar() && self.denominator.is_scalar()
    }

    fn plus(self, sign: Sign, other: Fraction) -> Option<Fraction> {
        if is_zero(&self.numerator.scale) && self.is_scalar() {
            let scale = other.numerator.scale;
            let scale = if sign == Sign::Plus { scale } else { negative(scale) };
            return Some(Fraction { numerator: Side { scale, ..other.numerator }, ..other });
        }
        if self.is_scalar() && other.is_scalar() {
            return Some(Fraction::scalar(sum(self.numerator.scale, sign, other.numerator.scale)));
        }
        // What each denominator lacks of the least common one.
        let (d, e) = (&self.denominator, &other.denominator);
        let power = d.power.max(e.power);
        let mut lacking = (Vec::new(), e.factors.clone());
        for factor in &d.factors {
            match lacking.1.iter().position(|f| f == factor) {
                Some(i) => {
                    lacking.1.remove(i);
                }
                None => lacking.0.push(factor.clone()),
            }
        }
        let brought = |side: &Side, power: usize, factors: Vec<Polynomial>| {
            side.clone().times(Side { scale: whole(1), power, factors }).expanded()
        };
        let left = brought(&self.numerator, power - d.power, lacking.1.clone())?;
        let right = brought(&other.numerator, power - e.power, lacking.0)?;
        let length = left.len().max(right.len());
        let at = |p: &Polynomial, k: usize| p.get(k).cloned().unwrap_or_else(|| whole(0));
        let numerator = (0..length).map(|k| sum(at(&left, k), sign, at(&right, k))).collect();
        let mut denominator = self.denominator;
        denominator.power = power;
        denominator.factors.extend(lacking.1);
        Some(Fraction { numerator: side_of(numerator), denominator })
    }

    fn times(self, other: Fraction) -> Fraction {
        Fraction {
            numerator: self.numerator.times(other.numerator),
            denominator: self.denominator.times(other.denominator),
        }
    }

    fn inverse(self) -> Fraction {
        let Side { scale, power, factors } = self.numerator;
        Fraction {
            numerator: Side { scale: quotient(whole(1), scale), ..self.denominator },
            denominator: Side { scale: whole(1), power, factors },
        }
    }

    fn over(self, other: Fraction) -> Fraction {
        if self.is_scalar() && other.is_scalar() {
            return Fraction::scalar(quotient(self.numerator.scale, other.numerator.scale));
        }
        if other.is_scalar() {
            let scale = quotient(self.numerator.scale, other.numerator.scale);
            return Fraction { numerator: Side { scale, ..self.numerator }, ..self };
        }
        self.times(other.inverse())
    }

    fn raised(self, exponent: i64) -> Option<Fraction> {
        if self.is_scalar() {
            return Some(Fraction::scalar(power(self.numerator.scale, exponent)));
        }
        let times = exponent.unsigned_abs();
        if times > MOST {
            return None;
        }
        let raised = |side: Side| Side {
            scale: power(side.scale, times as i64),
            power: side.power * times as usize,
            factors: (0..times).flat_map(|_| side.factors.clone()).collect(),
        };
        let whole = Fraction { numerator: raised(self.numerator), denominator: raised(self.denominator) };
        Some(if exponent < 0 { whole.inverse() } else { whole })
    }
}

/// A transfer expression; `None` where it has a function of the variable, or a power that is too high.
pub(super) fn fraction(e: &Expression, variable: &str) -> Option<Fraction> {
    let of = |e: &Expression| fraction(e, variable);
    if !e.names().contains(variable) {
        return Some(Fraction::scalar(e.clone()));
    }
    match &e.node {
        Node::Number(_) => None,
        Node::Name(_) => {
            let numerator = Side { scale: whole(1), power: 1, factors: Vec::new() };
            Some(Fraction { numerator, denominator: Side::scalar(whole(1)) })
        }
        Node::Negative(inner) => {
            let Fraction { numerator, denominator } = of(inner)?;
            Some(Fraction { numerator: Side { scale: negative(numerator.scale), ..numerator }, denominator })
        }
        Node::Sum(terms) => terms.iter().try_fold(Fraction::scalar(whole(0)), |all, (sign, term)| {
            let term = of(term)?;
            all.plus(*sign, term)
        }),
        Node::Product(factors) => factors.iter().try_fold(Fraction::scalar(whole(1)), |all, (factor, e)| {
            let factor_value = of(e)?;
            Some(if *factor == Factor::Times { all.times(factor_value) } else { all.over(factor_value) })
        }),
        Node::Power(base, exponent) => of(base)?.raised(*exponent),
        Node::Call(..) => None,
    }
}

/// Coefficients of a polynomial expression from the constant term up; `None` where it divides by the variable.
pub(super) fn polynomial(e: &Expression, variable: &str) -> Option<Polynomial> {
    let Fraction { numerator, denominator } = fraction(e, variable)?;
    let mut out = numerator.expanded().filter(|_| denominator.is_scalar())?;
    while out.len() > 1 && out.last().is_some_and(is_zero) {
        out.pop();
    }
    Some(out)
}
