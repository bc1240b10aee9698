//! Quotients of multivariate polynomials.

use super::{Domain, MultiPoly};
use crate::number::{Integer, Rational};
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

/// A rational function over the rationals in numbered variables: numerator and denominator are
/// coprime polynomials over the integers (contents included), the denominator's leading
/// coefficient is positive. So equality of values is equality of functions.
///
/// A polynomial with rational coefficients is a rational function whose denominator is an integer;
/// such functions cost integer gcds only.
///
/// A function in lowest terms no longer knows the poles of the expression it came from: `K/K` is 1.
///
/// ```
/// use jurist_algebra::poly::RationalFunction;
/// let k = RationalFunction::variable(0);
/// let one = RationalFunction::one();
/// let f = (&(&k * &k) - &one).checked_div(&(&k - &one)).unwrap();
/// assert_eq!(f, &k + &one);
/// assert_eq!(f.checked_div(&k).unwrap().display(&["K"]).to_string(), "(K + 1)/K");
/// ```
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct RationalFunction {
    numerator: MultiPoly,
    denominator: MultiPoly,
}

impl RationalFunction {
    /// Zero.
    pub fn zero() -> Self {
        RationalFunction { numerator: MultiPoly::zero(), denominator: MultiPoly::one() }
    }

    /// One.
    pub fn one() -> Self {
        RationalFunction { numerator: MultiPoly::one(), denominator: MultiPoly::one() }
    }

    /// The variable with number `i`.
    pub fn variable(i: usize) -> Self {
        RationalFunction::from(MultiPoly::variable(i))
    }

    /// The quotient in lowest terms; `None` when the denominator is zero.
    pub fn new(numerator: MultiPoly, denominator: MultiPoly) -> Option<Self> {
        if denominator.is_zero() {
            return None;
        }
        let g = numerator.gcd(&denominator);
        Some(RationalFunction::normalised(divided(&numerator, &g), divided(&denominator, &g)))
    }

    /// From coprime parts; the sign is put in order.
    fn normalised(numerator: MultiPoly, denominator: MultiPoly) -> Self {
        if denominator.needs_negation() {
            RationalFunction { numerator: numerator.negated(), denominator: denominator.negated() }
        } else {
            RationalFunction { numerator, denominator }
        }
    }

    /// The numerator.
    pub fn numerator(&self) -> &MultiPoly {
        &self.numerator
    }

    /// The denominator; never zero.
    pub fn denominator(&self) -> &MultiPoly {
        &self.denominator
    }

    /// Whether this is 0.
    pub fn is_zero(&self) -> bool {
        self.numerator.is_zero()
    }

    /// Whether this is 1.
    pub fn is_one(&self) -> bool {
        self.numerator.is_one() && self.denominator.is_one()
    }

    /// Whether no variable occurs.
    pub fn is_constant(&self) -> bool {
        self.numerator.is_constant() && self.denominator.is_constant()
    }

    /// Whether the denominator is an integer.
    pub fn is_polynomial(&self) -> bool {
        self.denominator.is_constant()
    }

    /// The value of a constant; `None` when a variable occurs.
    pub fn as_constant(&self) -> Option<Rational> {
        Some(Rational::new(self.numerator.as_constant()?, self.denominator.as_constant()?))
    }

    /// The variables that occur, ascending.
    pub fn variables(&self) -> Vec<usize> {
        let mut out = self.numerator.variables();
        out.extend(self.denominator.variables());
        out.sort_unstable();
        out.dedup();
        out
    }

    fn sum(&self, other: &Self, subtract: bool) -> Self {
        let combine = |a: &MultiPoly, b: &MultiPoly| if subtract { a.minus(b) } else { a.plus(b) };
        let (a, b, c, d) = (&self.numerator, &self.denominator, &other.numerator, &other.denominator);
        if b.is_one() && d.is_one() {
            return RationalFunction { numerator: combine(a, c), denominator: MultiPoly::one() };
        }
        // [Henrici1956]: with g = gcd(b, d), only factors of g can cancel from the sum.
        let g = b.gcd(d);
        let (b_rest, d_rest) = (divided(b, &g), divided(d, &g));
        let numerator = combine(&a.times(&d_rest), &c.times(&b_rest));
        let common = numerator.gcd(&g);
        let denominator = divided(&b_rest.times(d), &common);
        RationalFunction::normalised(divided(&numerator, &common), denominator)
    }

    fn product(&self, other: &Self) -> Self {
        let (a, b, c, d) = (&self.numerator, &self.denominator, &other.numerator, &other.denominator);
        let (g, h) = (a.gcd(d), c.gcd(b));
        let numerator = divided(a, &g).times(&divided(c, &h));
        let denominator = divided(b, &h).times(&divided(d, &g));
        if numerator.is_zero() {
            return RationalFunction::zero();
        }
        RationalFunction::normalised(numerator, denominator)
    }

    /// `1 / f`; `None` for 0.
    pub fn recip(&self) -> Option<Self> {
        (!self.is_zero()).then(|| RationalFunction::normalised(self.denominator.clone(), self.numerator.clone()))
    }

    /// The quotient; `None` when `other` is 0.
    pub fn checked_div(&self, other: &Self) -> Option<Self> {
        other.recip().map(|r| self.product(&r))
    }

    /// The power; `0^0 = 1`. `None` for 0 to a negative power, and when the result exceeds the
    /// limits of [`MultiPoly::checked_power`].
    pub fn pow(&self, exponent: i64) -> Option<Self> {
        let base = if exponent < 0 { self.recip()? } else { self.clone() };
        let raise = |p: &MultiPoly| p.checked_power(exponent.unsigned_abs());
        Some(RationalFunction { numerator: raise(&base.numerator)?, denominator: raise(&base.denominator)? })
    }

    /// Sets variable `i` to `x`; `None` when the denominator vanishes identically there.
    pub fn substitute(&self, i: usize, x: &Rational) -> Option<Self> {
        let (numerator, p) = self.numerator.substitute(i, x);
        if let Some(denominator) = self.denominator.as_constant() {
            if numerator.is_zero() {
                return Some(RationalFunction::zero());
            }
            let denominator = denominator * p;
            let g = numerator.integer_content().gcd(&denominator);
            let numerator = numerator.div_exact_integer(&g).expect("the content divides");
            return Some(RationalFunction { numerator, denominator: denominator.div_exact(&g).into() });
        }
        let (denominator, q) = self.denominator.substitute(i, x);
        RationalFunction::new(numerator.scaled_by(&q), denominator.scaled_by(&p))
    }

    /// The value where variable `i` is `point[i]`; `None` when the denominator vanishes.
    ///
    /// # Panics
    /// When a variable occurs that the point does not give.
    pub fn eval(&self, point: &[Rational]) -> Option<Rational> {
        self.numerator.eval(point).checked_div(&self.denominator.eval(point))
    }

    /// The same function with variable `i` called `new_index(i)`; `None` when the denominator
    /// vanishes because two variables became one.
    pub fn map_variables(&self, new_index: impl Fn(usize) -> usize) -> Option<Self> {
        let (numerator, denominator) =
            (self.numerator.map_variables(&new_index), self.denominator.map_variables(&new_index));
        // Lowest terms stay lowest terms when different variables remain different.
        let mut images: Vec<usize> = self.variables().into_iter().map(&new_index).collect();
        let count = images.len();
        images.sort_unstable();
        images.dedup();
        if images.len() == count {
            return Some(RationalFunction::normalised(numerator, denominator));
        }
        RationalFunction::new(numerator, denominator)
    }

    /// The function with `images[i]` in the place of variable `i`; variables beyond the list stay. `None` when the
    /// denominator vanishes identically then.
    ///
    /// Cost: a product of powers for each term of numerator and denominator; powers are computed once.
    ///
    /// ```
    /// use jurist_algebra::poly::RationalFunction;
    /// let (x, t) = (RationalFunction::variable(0), RationalFunction::variable(1));
    /// // x^2 + 1 where x = 1/t
    /// let f = &(&x * &x) + &RationalFunction::one();
    /// let g = f.compose(&[t.recip().unwrap()]).unwrap();
    /// assert_eq!(g.display(&["x", "t"]).to_string(), "(t^2 + 1)/t^2");
    /// ```
    pub fn compose(&self, images: &[RationalFunction]) -> Option<Self> {
        composed(&self.numerator, images).checked_div(&composed(&self.denominator, images))
    }

    /// Text such as `(3*K^2 - 1)/(2*T)`. Variables beyond the names are written `x_i`.
    pub fn display<'a, S: AsRef<str>>(&'a self, names: &'a [S]) -> DisplayRationalFunction<'a, S> {
        DisplayRationalFunction { function: self, names }
    }
}

/// The polynomial with functions in the place of its first variables.
fn composed(p: &MultiPoly, images: &[RationalFunction]) -> RationalFunction {
    let degrees = p.degrees();
    let powers: Vec<Vec<RationalFunction>> = degrees
        .iter()
        .enumerate()
        .map(|(i, &degree)| {
            let x = images.get(i).cloned().unwrap_or_else(|| RationalFunction::variable(i));
            let mut list = vec![RationalFunction::one()];
            for k in 0..degree as usize {
                list.push(&list[k] * &x);
            }
            list
        })
        .collect();
    let mut sum = RationalFunction::zero();
    for (monomial, c) in p.terms() {
        let mut term = RationalFunction::from(c.clone());
        for (i, &e) in monomial.exponents().iter().enumerate().filter(|(_, e)| **e > 0) {
            term = &term * &powers[i][e as usize];
        }
        sum = &sum + &term;
    }
    sum
}

/// `p / d`, where `d` is a divisor of `p`.
fn divided(p: &MultiPoly, d: &MultiPoly) -> MultiPoly {
    if d.is_one() { p.clone() } else { p.div_exact(d).expect("a common divisor divides") }
}

impl Default for RationalFunction {
    fn default() -> Self {
        RationalFunction::zero()
    }
}

impl From<MultiPoly> for RationalFunction {
    fn from(numerator: MultiPoly) -> Self {
        RationalFunction { numerator, denominator: MultiPoly::one() }
    }
}

impl From<Integer> for RationalFunction {
    fn from(n: Integer) -> Self {
        RationalFunction::from(MultiPoly::constant(n))
    }
}

impl From<i64> for RationalFunction {
    fn from(n: i64) -> Self {
        RationalFunction::from(Integer::from(n))
    }
}

impl From<&Rational> for RationalFunction {
    fn from(x: &Rational) -> Self {
        let (numerator, denominator) = (x.numerator(), x.denominator());
        RationalFunction { numerator: numerator.into(), denominator: denominator.into() }
    }
}

impl From<Rational> for RationalFunction {
    fn from(x: Rational) -> Self {
        RationalFunction::from(&x)
    }
}

/// The field of rational functions: a greatest common divisor is 1, or 0 when both are 0.
impl Domain for RationalFunction {
    fn zero() -> Self {
        RationalFunction::zero()
    }
    fn one() -> Self {
        RationalFunction::one()
    }
    fn from_integer(n: &Integer) -> Self {
        RationalFunction::from(n.clone())
    }
    fn is_zero(&self) -> bool {
        self.is_zero()
    }
    fn is_one(&self) -> bool {
        self.is_one()
    }
    fn plus(&self, other: &Self) -> Self {
        self.sum(other, false)
    }
    fn minus(&self, other: &Self) -> Self {
        self.sum(other, true)
    }
    fn times(&self, other: &Self) -> Self {
        self.product(other)
    }
    fn negated(&self) -> Self {
        -self
    }
    fn div_exact(&self, divisor: &Self) -> Option<Self> {
        self.checked_div(divisor)
    }
    fn gcd(&self, other: &Self) -> Self {
        if self.is_zero() && other.is_zero() { RationalFunction::zero() } else { RationalFunction::one() }
    }
    fn needs_negation(&self) -> bool {
        self.numerator.needs_negation()
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident| $value:expr) => {
        impl $trait for &RationalFunction {
            type Output = RationalFunction;
            fn $method(self, other: &RationalFunction) -> RationalFunction {
                let ($a, $b) = (self, other);
                $value
            }
        }
        impl $trait for RationalFunction {
            type Output = RationalFunction;
            fn $method(self, other: RationalFunction) -> RationalFunction {
                let ($a, $b) = (&self, &other);
                $value
            }
        }
    };
}
operator!(Add, add, |a, b| a.sum(b, false));
operator!(Sub, sub, |a, b| a.sum(b, true));
operator!(Mul, mul, |a, b| a.product(b));

impl Neg for &RationalFunction {
    type Output = RationalFunction;
    fn neg(self) -> RationalFunction {
        RationalFunction { numerator: self.numerator.negated(), denominator: self.denominator.clone() }
    }
}

impl Neg for RationalFunction {
    type Output = RationalFunction;
    fn neg(self) -> RationalFunction {
        -&self
    }
}

/// A rational function together with the names of its variables, ready to be formatted.
#[derive(Clone, Copy, Debug)]
pub struct DisplayRationalFunction<'a, S> {
    function: &'a RationalFunction,
    names: &'a [S],
}

impl<S: AsRef<str>> fmt::Display for DisplayRationalFunction<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (numerator, denominator) = (&self.function.numerator, &self.function.denominator);
        if denominator.is_one() {
            return write!(f, "{}", numerator.display(self.names));
        }
        if numerator.terms().len() > 1 {
            write!(f, "({})/", numerator.display(self.names))?;
        } else {
            write!(f, "{}/", numerator.display(self.names))?;
        }
        // A product after a slash needs parentheses; a number or a power of one variable does not.
        let atom = match denominator.terms() {
            [(m, c)] => m.is_one() || (c.is_one() && m.exponents().iter().filter(|&&e| e > 0).count() == 1),
            _ => false,
        };
        if atom {
            write!(f, "{}", denominator.display(self.names))
        } else {
            write!(f, "({})", denominator.display(self.names))
        }
    }
}

impl fmt::Debug for RationalFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.display::<&str>(&[]), f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lowest_terms_and_sign() {
        let (k, t) = (MultiPoly::variable(0), MultiPoly::variable(1));
        let f = RationalFunction::new((&k * &t).scaled_by(&Integer::from(-4)), (&t * &t).scaled_by(&Integer::from(-6)));
        assert_eq!(f.unwrap().display(&["K", "T"]).to_string(), "2*K/(3*T)");
        assert_eq!(RationalFunction::new(k, MultiPoly::zero()), None);
    }

    #[test]
    fn substitution_at_a_pole() {
        let k = RationalFunction::variable(0);
        let f = k.recip().unwrap();
        assert_eq!(f.substitute(0, &Rational::ZERO), None);
        assert_eq!(f.eval(&[Rational::ZERO]), None);
        assert_eq!(
            f.substitute(0, &Rational::new(2.into(), 3.into())).unwrap().as_constant(),
            Some(Rational::new(3.into(), 2.into()))
        );
    }

    #[test]
    fn powers() {
        let half_k = RationalFunction::new(MultiPoly::variable(0), MultiPoly::from(-2)).unwrap();
        assert_eq!(half_k.pow(-3).unwrap().display(&["K"]).to_string(), "-8/K^3");
        assert_eq!(RationalFunction::zero().pow(-1), None);
        assert_eq!(RationalFunction::zero().pow(0), Some(RationalFunction::one()));
        assert_eq!(half_k.pow(i64::MIN), None);
    }
}
