//! The normal form of Lindemann and Weierstrass: a sum of numbers times powers of `e` with distinct exponents, which is zero only
//! where every coefficient is.
//!
//! Numbers are sums of multiples of square roots of integers, exact wherever the integers' square factors are found; one that is not
//! found can only keep a zero from being seen. Multiples are rational functions of what nothing is known of: of parameters, so that an
//! identity between functions of them is seen, and of the circle number. With rational multiples the form is zero exactly where the
//! number is.

use super::{Definition, Symbols};
use crate::limits::checkpoint;
use crate::number::{Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};
use std::collections::{BTreeMap, HashMap};

/// The square root of a positive integer, times the imaginary unit where that is set.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Root {
    is_imaginary: bool,
    core: Integer,
}

/// A sum of multiples of square roots; no coefficient is zero.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Default)]
struct Number(BTreeMap<Root, RationalFunction>);

/// A sum of numbers times powers of `e`, by exponent; no coefficient is zero.
#[derive(Clone, Debug, PartialEq, Default)]
struct Sum(HashMap<Number, Number>);

/// Primes below this are looked for in square factors.
const LARGEST_PRIME: u64 = 1000;

impl Number {
    fn rational(x: Rational) -> Number {
        Number::function(x.into())
    }

    fn function(x: RationalFunction) -> Number {
        Number::multiple(Root { is_imaginary: false, core: Integer::ONE }, x)
    }

    fn multiple(root: Root, x: RationalFunction) -> Number {
        let mut out = Number::default();
        out.insert(root, x);
        out
    }

    /// The square root of a rational number.
    fn square_root(x: &Rational) -> Number {
        if x.is_zero() {
            return Number::default();
        }
        let (n, d) = (x.numerator(), x.denominator());
        // sqrt(n/d) = sqrt(n d)/d
        let (square, core) = square_free(&(n.abs() * &d));
        let root = Root { is_imaginary: n.is_negative(), core };
        Number::multiple(root, Rational::new(square, d).into())
    }

    fn insert(&mut self, root: Root, x: RationalFunction) {
        let sum = self.0.get(&root).map_or_else(|| x.clone(), |known| known + &x);
        if sum.is_zero() {
            self.0.remove(&root);
        } else {
            self.0.insert(root, sum);
        }
    }

    fn plus(&self, other: &Number) -> Number {
        let mut out = self.clone();
        other.0.iter().for_each(|(root, x)| out.insert(root.clone(), x.clone()));
        out
    }

    fn times(&self, other: &Number) -> Number {
        let mut out = Number::default();
        for (a, x) in &self.0 {
            for (b, y) in &other.0 {
                let common = a.core.gcd(&b.core);
                let core = a.core.div_exact(&common) * b.core.div_exact(&common);
                let mut value = &(x * y) * &RationalFunction::from(common);
                if a.is_imaginary && b.is_imaginary {
                    value = -value;
                }
                out.insert(Root { is_imaginary: a.is_imaginary != b.is_imaginary, core }, value);
            }
        }
        out
    }

    fn scaled(&self, factor: i64) -> Number {
        self.times(&Number::rational(Rational::from(factor)))
    }

    fn as_function(&self) -> Option<RationalFunction> {
        match self.0.len() {
            0 => Some(RationalFunction::zero()),
            1 => self.0.iter().next().filter(|(r, _)| !r.is_imaginary && r.core.is_one()).map(|(_, x)| x.clone()),
            _ => None,
        }
    }

    fn as_rational(&self) -> Option<Rational> {
        self.as_function()?.as_constant()
    }
}

/// `n = square^2 core`, up to square factors of large primes that are not seen.
fn square_free(n: &Integer) -> (Integer, Integer) {
    let root = n.sqrt_floor();
    if &root * &root == *n {
        return (root, Integer::ONE);
    }
    let (mut square, mut core) = (Integer::ONE, n.clone());
    for p in 2..LARGEST_PRIME {
        let p = Integer::from(p);
        let p2 = &p * &p;
        while core.divisible_by(&p2) {
            core = core.div_exact(&p2);
            square *= &p;
        }
    }
    // What is left may be a small number times a large square.
    for small in 1..LARGEST_PRIME {
        let small = Integer::from(small);
        if core.divisible_by(&small) {
            let rest = core.div_exact(&small);
            let root = rest.sqrt_floor();
            if &root * &root == rest {
                return (square * root, small);
            }
        }
    }
    (square, core)
}

impl Sum {
    fn number(x: Number) -> Sum {
        Sum::power(Number::default(), x)
    }

    /// `x e^exponent`.
    fn power(exponent: Number, x: Number) -> Sum {
        let mut out = Sum::default();
        out.insert(exponent, &x);
        out
    }

    fn one() -> Sum {
        Sum::number(Number::rational(Rational::ONE))
    }

    fn insert(&mut self, exponent: Number, x: &Number) {
        let sum = self.0.get(&exponent).map_or_else(|| x.clone(), |known| known.plus(x));
        if sum.0.is_empty() {
            self.0.remove(&exponent);
        } else {
            self.0.insert(exponent, sum);
        }
    }

    fn add(&mut self, other: &Sum) {
        other.0.iter().for_each(|(e, x)| self.insert(e.clone(), x));
    }

    fn times(&self, other: &Sum) -> Sum {
        let mut out = Sum::default();
        for (e, x) in &self.0 {
            for (f, y) in &other.0 {
                checkpoint(100);
                out.insert(e.plus(f), &x.times(y));
            }
        }
        out
    }

    fn as_number(&self) -> Option<Number> {
        match self.0.len() {
            0 => Some(Number::default()),
            1 => self.0.get(&Number::default()).cloned(),
            _ => None,
        }
    }
}

/// A quotient of two sums.
struct Quotient {
    numerator: Sum,
    denominator: Sum,
}

/// Definitions of the variables from `first` on; nothing is known of those before.
struct Table<'t> {
    first: usize,
    definitions: &'t dyn Fn(usize) -> Option<&'t Definition>,
}

impl Symbols {
    /// Whether the polynomial in symbols is seen to be zero in the normal form. Symbols that are no function of square roots
    /// are not treated, but for the circle number, of which nothing is known.
    pub(super) fn is_zero_in_normal_form(&self, p: &MultiPoly) -> bool {
        let definitions = |i: usize| self.table.get(i).map(|(_, definition)| definition);
        let table = Table { first: 0, definitions: &definitions };
        table.numerator(p).is_some_and(|(sum, _)| sum.0.is_empty())
    }

    /// The rational number that a rational function of symbols is, where that is seen in the normal form.
    ///
    /// ```
    /// use jurist_algebra::poly::RationalFunction;
    /// use jurist_algebra::symbols::{Definition, Symbols};
    /// let mut symbols = Symbols::new();
    /// let (a, b) = (symbols.insert("a", Definition::root(2)), symbols.insert("b", Definition::root(8)));
    /// let product = &RationalFunction::variable(a) * &RationalFunction::variable(b);
    /// assert_eq!(symbols.as_rational(&product), Some(4.into()));
    /// ```
    ///
    /// Cost: that of the normal form.
    pub fn as_rational(&self, f: &RationalFunction) -> Option<Rational> {
        let definitions = |i: usize| self.table.get(i).map(|(_, definition)| definition);
        Table { first: 0, definitions: &definitions }.algebraic(f)?.as_rational()
    }
}

/// Whether a polynomial is seen to be zero for all values of its first variables, where the others stand for these functions of them
/// and of one another.
///
/// ```
/// use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
/// use jurist_algebra::symbols::{Definition, is_identity};
/// // sin(a)^2 + cos(a)^2 - 1 with the free number a
/// let a = RationalFunction::variable(0);
/// let solution = |index| Definition::Fundamental { polynomial: vec![1.into(), 0.into(), 1.into()], index, time: a.clone() };
/// let [cos, sin] = [1, 2].map(MultiPoly::variable);
/// let p = cos.times(&cos).plus(&sin.times(&sin)).minus(&MultiPoly::one());
/// assert!(is_identity(&p, 1, &[Some(solution(0)), Some(solution(1))]));
/// ```
///
/// Nothing is known of a variable without a definition.
///
/// Cost: as many products of sums of exponentials as the polynomial has terms.
pub fn is_identity(p: &MultiPoly, first: usize, definitions: &[Option<Definition>]) -> bool {
    let definitions = |i: usize| definitions.get(i).and_then(Option::as_ref);
    Table { first, definitions: &definitions }.numerator(p).is_some_and(|(sum, _)| sum.0.is_empty())
}

impl Table<'_> {
    /// A polynomial times a number that is not zero, and that number.
    fn numerator(&self, p: &MultiPoly) -> Option<(Sum, Sum)> {
        let degrees = p.degrees();
        let mut tables = Vec::with_capacity(degrees.len());
        let mut denominator = Sum::one();
        for (i, degree) in degrees.iter().map(|d| *d as usize).enumerate() {
            if degree == 0 {
                tables.push(None);
                continue;
            }
            let value = self.value(i)?;
            let powers = |of: &Sum| {
                let mut out = vec![Sum::one()];
                (0..degree).for_each(|k| out.push(out[k].times(of)));
                out
            };
            let (above, below) = (powers(&value.numerator), powers(&value.denominator));
            denominator = denominator.times(&below[degree]);
            tables.push(Some((above, below, degree)));
        }
        let mut sum = Sum::default();
        for (monomial, c) in p.terms() {
            let mut term = Sum::number(Number::rational(Rational::from(c)));
            for (i, table) in tables.iter().enumerate() {
                let Some((above, below, degree)) = table else { continue };
                let k = monomial.exponent(i) as usize;
                term = term.times(&above[k]).times(&below[degree - k]);
            }
            sum.add(&term);
        }
        Some((sum, denominator))
    }

    /// A rational function of symbols that is free of exponentials.
    fn algebraic(&self, f: &RationalFunction) -> Option<Number> {
        let (above, a) = self.numerator(f.numerator())?;
        let (below, b) = self.numerator(f.denominator())?;
        let divisor = below.times(&a).as_number()?.as_function()?;
        let scale = Number::function(divisor.recip()?);
        Some(above.times(&b).as_number()?.times(&scale))
    }

    /// What a variable stands for.
    fn value(&self, i: usize) -> Option<Quotient> {
        let itself = |i| {
            let numerator = Sum::number(Number::function(RationalFunction::variable(i)));
            Some(Quotient { numerator, denominator: Sum::one() })
        };
        let Some(i) = i.checked_sub(self.first) else { return itself(i) };
        match (self.definitions)(i) {
            None | Some(Definition::Pi) => itself(i + self.first),
            Some(definition) => self.function(definition),
        }
    }

    /// What a function stands for.
    fn function(&self, definition: &Definition) -> Option<Quotient> {
        let whole = |numerator| Some(Quotient { numerator, denominator: Sum::one() });
        let one = || Number::rational(Rational::ONE);
        match definition {
            Definition::Pi
            | Definition::Algebraic(_)
            | Definition::Enclosed(_)
            | Definition::Duty(_)
            | Definition::Family(_) => None,
            Definition::Exponential(x) => whole(Sum::power(self.algebraic(x)?, one())),
            Definition::Root(x) => whole(Sum::number(Number::square_root(&self.algebraic(x)?.as_rational()?))),
            Definition::Tangent { square, time } => {
                // With s = sqrt(-w) and E = exp(2 s t): (E - 1)/(s (E + 1)), and 1/s = s/(-w).
                let w = self.algebraic(square)?.as_rational()?;
                if w.is_zero() {
                    // The limit of tan(sqrt(w) t)/sqrt(w).
                    return whole(Sum::number(self.algebraic(time)?));
                }
                let s = Number::square_root(&-&w);
                let exponent = s.times(&self.algebraic(time)?).scaled(2);
                let mut numerator = Sum::power(exponent.clone(), s.clone());
                numerator.insert(Number::default(), &s.scaled(-1));
                let mut denominator = Sum::power(exponent, Number::rational(-&w));
                denominator.insert(Number::default(), &Number::rational(-w));
                Some(Quotient { numerator, denominator })
            }
            Definition::Fundamental { polynomial, index, time } => self.solution(polynomial, *index, time),
        }
    }

    /// A fundamental solution of an equation of the first or second order with rational coefficients.
    fn solution(&self, polynomial: &[RationalFunction], index: usize, time: &RationalFunction) -> Option<Quotient> {
        let rational = |f: &RationalFunction| self.algebraic(f)?.as_rational();
        let time = self.algebraic(time)?;
        let half = Rational::new(Integer::ONE, 2.into());
        let times = |x: &Number, y: &Rational| x.times(&Number::rational(y.clone()));
        let (b, c) = match polynomial {
            [c, _] => {
                let numerator = Sum::power(times(&time, &-rational(c)?), Number::rational(Rational::ONE));
                return Some(Quotient { numerator, denominator: Sum::one() });
            }
            [c, b, _] => (&rational(b)? * &half, rational(c)?),
            _ => return None,
        };
        // With s = sqrt(b^2 - c), half the coefficient b: exp(-b t) (E - 1/E)/(2 s) with E = exp(s t), and exp(-b t) (E + 1/E)/2.
        let square = &(&b * &b) - &c;
        let decay = times(&time, &-&b);
        let (mut sine, mut cosine) = (Sum::default(), Sum::default());
        if square.is_zero() {
            sine.insert(decay.clone(), &time);
            cosine.insert(decay, &Number::rational(Rational::ONE));
        } else {
            let s = Number::square_root(&square);
            let over = times(&s, &(&half / &square));
            for sign in [1, -1] {
                let exponent = decay.plus(&s.times(&time).scaled(sign));
                sine.insert(exponent.clone(), &over.scaled(sign));
                cosine.insert(exponent, &Number::rational(half.clone()));
            }
        }
        if index == 0 {
            cosine.add(&sine.times(&Sum::number(Number::rational(b))));
            return Some(Quotient { numerator: cosine, denominator: Sum::one() });
        }
        Some(Quotient { numerator: sine, denominator: Sum::one() })
    }
}
