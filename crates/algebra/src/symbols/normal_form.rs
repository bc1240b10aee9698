//! The normal form of Lindemann and Weierstrass: a sum of algebraic numbers times powers of `e` with distinct algebraic
//! exponents, which is zero only where every coefficient is.
//!
//! Numbers are sums of rational multiples of square roots of integers, exact wherever the integers' square factors are found;
//! one that is not found can only keep a zero from being seen.

use super::{Definition, Symbols};
use crate::limits::checkpoint;
use crate::number::{Integer, Rational};
use crate::poly::{MultiPoly, RationalFunction};
use std::collections::BTreeMap;

/// The square root of a positive integer, times the imaginary unit where that is set.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Root {
    is_imaginary: bool,
    core: Integer,
}

/// A sum of rational multiples of square roots; no coefficient is zero.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
struct Number(BTreeMap<Root, Rational>);

/// A sum of numbers times powers of `e`, by exponent; no coefficient is zero.
#[derive(Clone, Debug, PartialEq, Default)]
struct Sum(BTreeMap<Number, Number>);

/// Primes below this are looked for in square factors.
const LARGEST_PRIME: u64 = 1000;

impl Number {
    fn rational(x: Rational) -> Number {
        Number::multiple(Root { is_imaginary: false, core: Integer::ONE }, x)
    }

    fn multiple(root: Root, x: Rational) -> Number {
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
        Number::multiple(root, Rational::new(square, d))
    }

    fn insert(&mut self, root: Root, x: Rational) {
        let sum = self.0.get(&root).map_or(x.clone(), |known| known + &x);
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
                let mut value = &(x * y) * &Rational::from(&common);
                if a.is_imaginary && b.is_imaginary {
                    value = -value;
                }
                out.insert(Root { is_imaginary: a.is_imaginary != b.is_imaginary, core }, value);
            }
        }
        out
    }

    fn as_rational(&self) -> Option<Rational> {
        match self.0.len() {
            0 => Some(Rational::ZERO),
            1 => self.0.iter().next().filter(|(r, _)| !r.is_imaginary && r.core.is_one()).map(|(_, x)| x.clone()),
            _ => None,
        }
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

impl Symbols {
    /// Whether the polynomial in symbols is seen to be zero in the normal form. Symbols that are no function of square roots
    /// are not treated.
    pub(super) fn is_zero_in_normal_form(&self, p: &MultiPoly) -> bool {
        self.numerator(p).is_some_and(|(sum, _)| sum.0.is_empty())
    }

    /// A polynomial in symbols times a number that is not zero, and that number.
    fn numerator(&self, p: &MultiPoly) -> Option<(Sum, Sum)> {
        let degrees = p.degrees();
        let mut tables = Vec::with_capacity(degrees.len());
        let mut denominator = Sum::one();
        for (i, degree) in degrees.iter().map(|d| *d as usize).enumerate() {
            if degree == 0 {
                tables.push(None);
                continue;
            }
            let value = self.normal_form(self.definition(i))?;
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

    /// A rational function of symbols that is an algebraic number.
    fn algebraic(&self, f: &RationalFunction) -> Option<Number> {
        let (above, a) = self.numerator(f.numerator())?;
        let (below, b) = self.numerator(f.denominator())?;
        let divisor = below.times(&a).as_number()?.as_rational()?;
        let scale = Number::rational(divisor.recip()?);
        Some(above.times(&b).as_number()?.times(&scale))
    }

    fn normal_form(&self, definition: &Definition) -> Option<Quotient> {
        let whole = |numerator| Some(Quotient { numerator, denominator: Sum::one() });
        let one = || Number::rational(Rational::ONE);
        let minus = |x: &Number| x.times(&Number::rational(-Rational::ONE));
        match definition {
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
                let exponent = s.times(&self.algebraic(time)?).times(&Number::rational(Rational::from(2)));
                let mut numerator = Sum::power(exponent.clone(), s.clone());
                numerator.insert(Number::default(), &minus(&s));
                let mut denominator = Sum::power(exponent, Number::rational(-&w));
                denominator.insert(Number::default(), &Number::rational(-w));
                Some(Quotient { numerator, denominator })
            }
            Definition::Fundamental { .. } | Definition::Pi | Definition::Algebraic(_) => None,
        }
    }
}
