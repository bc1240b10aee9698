//! The values of symbols whose arguments are functions of parameters.

use super::function::polynomial_at;
use super::scales::exponent;
use super::{Definition, FamilyValue};
use crate::ball::{Ball, Elementary};
use crate::number::{Enclosure, Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Exponents beyond this are not enclosed over an interval.
const LARGEST: i64 = 1 << 13;

/// A table of symbols whose arguments are rational functions of several parameters, which are the first variables, and of earlier
/// symbols, which are the variables after them.
///
/// ```
/// use jurist_algebra::ball::{Ball, MultiTaylorModel};
/// use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
/// use jurist_algebra::symbols::{Definition, ParametricSymbols};
/// // X = exp(x y) with x, y about 1
/// let product = &RationalFunction::variable(0) * &RationalFunction::variable(1);
/// let symbols = ParametricSymbols::new(vec![("X".into(), Definition::Exponential(product))]);
/// let about_one = (Ball::from_integer(&1.into(), 64), Ball::from_integer(&1.into(), 64).shifted(-8));
/// let parameters = MultiTaylorModel::linear(&[about_one.clone(), about_one], 3);
/// let values = symbols.values(&parameters).unwrap();
/// let difference = symbols.value(&MultiPoly::variable(2).minus(&MultiPoly::variable(2)), &values);
/// assert!(difference.terms().all(|(_, c)| c.is_zero()));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ParametricSymbols {
    table: Vec<(String, Definition)>,
}

impl ParametricSymbols {
    /// The table of these names and definitions.
    pub fn new(table: Vec<(String, Definition)>) -> Self {
        ParametricSymbols { table }
    }

    /// The table with another symbol at its end.
    pub fn with(mut self, name: &str, definition: Definition) -> ParametricSymbols {
        self.table.push((name.into(), definition));
        self
    }

    /// The number of symbols.
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// Whether some symbols are values of a family of matrices.
    pub fn has_families(&self) -> bool {
        self.table.iter().any(|(_, definition)| matches!(definition, Definition::Family(_)))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// What the symbols are functions of.
    pub fn arguments(&self) -> impl Iterator<Item = &RationalFunction> {
        self.table.iter().flat_map(|(_, definition)| definition.arguments())
    }

    /// The parameters that functions depend on, ascending.
    pub fn parameters_inside(&self, parameters: usize) -> Vec<usize> {
        first_of(self.arguments().flat_map(RationalFunction::variables), parameters)
    }

    /// The parameters in what arguments are divided by, ascending: where these vary much, little is known of the symbols.
    pub fn parameters_below(&self, parameters: usize) -> Vec<usize> {
        first_of(self.arguments().flat_map(|f| f.denominator().variables()), parameters)
    }

    /// The parameters and all symbols as enclosures, from those of the parameters; `None` where a divisor may vanish, a root's argument
    /// may be negative, or an exponential is too large.
    ///
    /// Cost: an exponential of a small matrix for each symbol.
    pub fn values<S: Elementary>(&self, parameters: &[S]) -> Option<Vec<S>> {
        values_of(&self.table, parameters.to_vec())
    }

    /// The value of a polynomial in parameters and symbols at [values](ParametricSymbols::values).
    ///
    /// Cost: a product for each step of Horner's scheme.
    pub fn value<S: Elementary>(&self, p: &MultiPoly, values: &[S]) -> S {
        polynomial_at(p, values)
    }
}

/// The first variables of a list, ascending, each once.
fn first_of(variables: impl Iterator<Item = usize>, count: usize) -> Vec<usize> {
    variables.filter(|v| *v < count).collect::<BTreeSet<usize>>().into_iter().collect()
}

/// The parameters and the symbols of a table, where the parameters have these values; `None` where one may not be defined.
pub(super) fn values_of<S: Elementary>(table: &[(String, Definition)], parameters: Vec<S>) -> Option<Vec<S>> {
    let like = parameters.first()?.clone();
    let mut known = Evaluation::new(parameters, &like);
    for (_, definition) in table {
        let value = known.value(definition)?;
        known.push(value);
    }
    Some(known.values)
}

/// Constants of up to so many bits are divided by as their inverses.
const LARGEST_DIVISOR: u64 = 20;

/// The value of a rational function where its variables have these; `None` where the denominator may vanish.
pub(super) fn quotient<S: Elementary>(f: &RationalFunction, values: &[S], like: &S) -> Option<S> {
    let at = |p: &MultiPoly| match p.as_constant() {
        Some(c) => like.integer(&c),
        None => polynomial_at(p, values),
    };
    match f.denominator().as_constant() {
        Some(c) if c.is_one() => Some(at(f.numerator())),
        // Numbers have bits after the point: the inverse of a large one has few that count.
        Some(c) if c.bit_length() <= LARGEST_DIVISOR => {
            let over = Rational::new(Integer::ONE, c);
            Some(at(f.numerator()).times(&like.constant(&Ball::from_rational(&over, like.bits()))))
        }
        _ => at(f.numerator()).over(&at(f.denominator())),
    }
}

/// Values of variables, one after the other.
pub(super) struct Evaluation<'d, S> {
    values: Vec<S>,
    like: S,
    /// All solutions of an equation at once.
    rows: Vec<(&'d [RationalFunction], &'d RationalFunction, Vec<S>)>,
    /// All values of a family at once.
    families: Vec<(&'d FamilyValue, Vec<S>)>,
}

impl<'d, S: Elementary> Evaluation<'d, S> {
    /// Begins with the values of the first variables. All other values are numbers of the same kind as `like`.
    pub fn new(values: Vec<S>, like: &S) -> Self {
        Evaluation { values, like: like.clone(), rows: Vec::new(), families: Vec::new() }
    }

    /// The values that are known.
    pub fn values(&self) -> &[S] {
        &self.values
    }

    /// The value of one more variable.
    pub fn push(&mut self, value: S) {
        self.values.push(value);
    }

    fn at(&self, f: &RationalFunction) -> Option<S> {
        quotient(f, &self.values, &self.like)
    }

    /// The value of a function of the variables that are known; `None` where it may not be defined.
    pub fn value(&mut self, definition: &'d Definition) -> Option<S> {
        let (like, bits) = (&self.like, self.like.bits());
        Some(match definition {
            Definition::Pi => like.constant(&Ball::from_enclosure(&Enclosure::pi(bits + 8), bits)),
            Definition::Algebraic(x) => like.constant(&Definition::enclosed(x, bits)),
            Definition::Enclosed(x) => like.constant(&x.at(bits)),
            Definition::Root(x) => self.at(x)?.square_root()?,
            Definition::Duty(duty) => duty.value(|f| self.at(f))?,
            Definition::Exponential(x) => {
                let x = self.at(x)?;
                if x.range().upper() > Rational::from(LARGEST) {
                    return None;
                }
                x.exponential()
            }
            Definition::Tangent { square, time } => {
                let (w, t) = (self.at(square)?, self.at(time)?);
                let row = t.solutions(&[w, like.nothing()]);
                row[1].over(&row[0])?
            }
            Definition::Fundamental { polynomial, index, time } => {
                let row = self.rows.iter().position(|(of, at, _)| *of == polynomial.as_slice() && *at == time);
                let row = match row {
                    Some(row) => row,
                    None => {
                        let n = polynomial.len() - 1;
                        let coefficients = polynomial[..n].iter().map(|f| self.at(f)).collect::<Option<Vec<S>>>()?;
                        let time_there = self.at(time)?;
                        if is_too_large(&coefficients, &time_there) {
                            return None;
                        }
                        self.rows.push((polynomial, time, time_there.solutions(&coefficients)));
                        self.rows.len() - 1
                    }
                };
                self.rows[row].2[*index].clone()
            }
            Definition::Family(value) => {
                let is_same =
                    |(known, _): &(&FamilyValue, _)| Arc::ptr_eq(&known.of, &value.of) && known.at == value.at;
                let family = match self.families.iter().position(is_same) {
                    Some(family) => family,
                    None => {
                        let at = value.at.iter().map(|f| self.at(f)).collect::<Option<Vec<S>>>()?;
                        self.families.push((value, value.of.values_near(&at, &self.like)?));
                        self.families.len() - 1
                    }
                };
                self.families[family].1[value.index].clone()
            }
        })
    }
}

/// Whether exponentials of a companion matrix anywhere in these balls may have too many bits to be of use.
fn is_too_large<S: Elementary>(coefficients: &[S], time: &S) -> bool {
    let size = |s: &S| Rational::dyadic(&s.range().magnitude_units(), s.bits());
    let n = coefficients.len() as i64;
    // No root is larger than twice the greatest of the roots |c_k|^(1/(n - k)).
    let octaves = coefficients.iter().enumerate().map(|(k, c)| {
        let size = size(c);
        if size.is_zero() { 0 } else { exponent(&size).div_euclid(n - k as i64) + 1 }
    });
    let rate = Rational::from(2).pow(octaves.max().unwrap_or(0).max(0)).expect("two is not zero");
    size(time) * rate > Rational::from(LARGEST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball::Series;

    /// The inverse of a number with 240 bits has no digit 112 bits after the point.
    #[test]
    fn a_quotient_of_long_numbers_keeps_its_digits() {
        let long = Integer::from(3).pow(150);
        let f = RationalFunction::new(
            MultiPoly::variable(0).scaled_by(&long.clone()),
            MultiPoly::constant(&long + &Integer::ONE),
        );
        let third = Ball::from_rational(&Rational::new(1.into(), 3.into()), 112);
        let x = Series::constant(&third, 1);
        let value = quotient(&f.unwrap(), std::slice::from_ref(&x), &x).unwrap();
        let value = &value.coefficients()[0];
        assert!(value.width_units().bit_length() < 8, "{value:?}");
        // 3^149/(3^150 + 1)
        let exact = Rational::new(Integer::from(3).pow(149), &long + &Integer::ONE);
        assert!(value.lower() <= exact && exact <= value.upper());
    }
}
