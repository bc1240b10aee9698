//! Polynomials in the parameter whose coefficients are polynomials in symbols.
//!
//! Zero is only ever an identity; a sign is only ever read off an enclosure.

use super::clock::Clock;
use super::coefficient::{Coefficient, Ring};
use super::interval::{Interval, balanced};
use super::multivariate::Multi;
use super::number::{Q, Z, integer};
use super::over_symbols::primitive;
use super::statement::{count, list, text};
use super::symbols::Table;
use crate::format::Json;
use num_bigint::Sign;
use num_traits::{One, Zero};
use std::collections::BTreeMap;
use std::rc::Rc;

/// A polynomial with its table of symbols.
#[derive(Clone)]
pub(super) struct Over {
    pub polynomial: Multi,
    pub table: Rc<Table>,
}

impl PartialEq for Over {
    fn eq(&self, other: &Self) -> bool {
        self.polynomial == other.polynomial
    }
}

impl std::fmt::Debug for Over {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.polynomial.fmt(f)
    }
}

impl Over {
    pub fn new(polynomial: Multi, table: &Rc<Table>) -> Self {
        Over { polynomial, table: Rc::clone(table) }
    }

    /// Reads a list of terms: each its coefficient and the exponents of the parameter and the symbols, ascending by exponents.
    pub fn read(json: &Json, what: &str, table: &Rc<Table>) -> Result<Self, String> {
        let mut terms = BTreeMap::new();
        for term in list(json, what)? {
            let [c, exponents @ ..] = list(term, what)? else { return Err(format!("{what} has an empty term")) };
            let c = integer(text(c, what)?)?;
            let exponents = exponents.iter().map(|e| count(e, what)).collect::<Result<Vec<_>, _>>()?;
            if c.is_zero() || exponents.last() == Some(&0) || exponents.len() > table.len() + 1 {
                return Err(format!("{what} has a term that is not in its shortest form"));
            }
            if exponents.iter().any(|e| *e > 4000) {
                return Err(format!("{what} has too high a degree"));
            }
            let key: Vec<u32> = match exponents.is_empty() {
                true => Vec::new(),
                false => std::iter::once(0).chain(exponents.into_iter().map(|e| e as u32)).collect(),
            };
            if terms.insert(key, c).is_some() {
                return Err(format!("{what} has a term twice"));
            }
        }
        Ok(Over::new(Multi(terms), table))
    }

    fn enclosed(&self, clock: &Clock) -> Result<Vec<Interval>, String> {
        self.table.enclosed(&self.polynomial, clock)
    }

    fn with(&self, polynomial: Multi) -> Self {
        Over::new(polynomial, &self.table)
    }
}

/// A positive multiple of the polynomial in symbols that is left at a value of the parameter; `degree` is at least its degree.
fn at(p: &Multi, value: &Q, degree: usize, clock: &Clock) -> Result<Multi, String> {
    let mut sum = Multi::default();
    for (k, part) in p.coefficients(1).iter().enumerate() {
        let (n, d) = (value.numer(), value.denom());
        clock.spend(part.0.len(), n.bits() * k as u64, d.bits() * (degree - k) as u64)?;
        sum = sum.plus(&part.scaled(&(n.pow(k as u32) * d.pow((degree - k) as u32))));
    }
    Ok(sum)
}

fn uncertain(what: &str, bits: usize) -> String {
    format!("{what} is not certain with {bits} bits")
}

impl Ring for Over {
    fn zero(&self) -> Self {
        self.with(Multi::default())
    }

    fn is_zero(&self) -> bool {
        self.polynomial.is_zero()
    }

    fn plus(&self, other: &Self) -> Self {
        self.with(self.polynomial.plus(&other.polynomial))
    }

    fn minus(&self, other: &Self) -> Self {
        self.with(self.polynomial.minus(&other.polynomial))
    }

    fn times(&self, other: &Self, clock: &Clock) -> Result<Self, String> {
        Ok(self.with(self.polynomial.times(&other.polynomial, clock)?))
    }

    fn scaled(&self, factor: &Z) -> Self {
        self.with(self.polynomial.scaled(factor))
    }

    fn is_nonzero(&self, clock: &Clock) -> Result<bool, String> {
        Ok(self.enclosed(clock)?.iter().any(|c| !c.contains_zero()))
    }
}

impl Coefficient for Over {
    fn degree(&self) -> usize {
        self.polynomial.degree(1)
    }

    fn is_unit(&self, clock: &Clock) -> Result<bool, String> {
        Ok(self.degree() == 0 && self.is_nonzero(clock)?)
    }

    fn vanishes_at(&self, value: &Q, clock: &Clock) -> Result<bool, String> {
        let left = at(&self.polynomial, value, self.degree(), clock)?;
        if left.is_zero() {
            return Ok(true);
        }
        match self.table.enclosed(&left, clock)?.first() {
            Some(c) if !c.contains_zero() => Ok(false),
            _ => Err(uncertain(&format!("a sign at {value}"), self.table.bits)),
        }
    }

    fn divided(&self, divisor: &Self, clock: &Clock) -> Result<Option<Self>, String> {
        // Gauss: a quotient by a polynomial without common integers is integral; the integers move no zero.
        let primitive = |p: &Self| Ok::<_, String>(primitive(vec![p.polynomial.clone()], clock)?.swap_remove(0));
        Ok(primitive(self)?.divided(&primitive(divisor)?, clock)?.map(|q| self.with(q)))
    }

    fn descartes(&self, a: Option<&Q>, b: Option<&Q>, clock: &Clock) -> Result<Option<usize>, String> {
        if self.degree() == 0 {
            return Ok(Some(0));
        }
        let c = self.enclosed(clock)?;
        let signs = match (a, b) {
            (None, None) => return Ok(None),
            (Some(a), None) => along(c, a, &Q::one(), clock)?,
            (None, Some(b)) => along(c, b, &-Q::one(), clock)?,
            (Some(a), Some(b)) => {
                let mut c = along(c, a, &(b - a), clock)?;
                c.reverse();
                shift(&mut c, &Z::one(), clock)?;
                c
            }
        };
        let mut last = Sign::NoSign;
        let mut count = 0;
        for c in &signs {
            let sign = c.sign().ok_or_else(|| uncertain("a coefficient's sign", self.table.bits))?;
            if sign != Sign::NoSign {
                count += usize::from(last != Sign::NoSign && last != sign);
                last = sign;
            }
        }
        Ok(Some(count))
    }

    fn is_stable_at(coefficients: &[Self], value: &Q, discrete: bool, clock: &Clock) -> Result<bool, String> {
        let Some(first) = coefficients.first() else { return Ok(false) };
        if !discrete {
            return Err("a continuous loop has no symbols".into());
        }
        let degree = coefficients.iter().map(Coefficient::degree).max().unwrap_or(0);
        let table = &first.table;
        let mut d = Vec::with_capacity(coefficients.len());
        for c in coefficients {
            let left = at(&c.polynomial, value, degree, clock)?;
            d.push(table.enclosed(&left, clock)?.into_iter().next().unwrap_or_else(Interval::zero));
        }
        let n = d.len() - 1;
        inside(d, true, table.bits, clock).map(|found| found == n)
    }
}

/// How many roots of a polynomial are inside the unit circle; none is on it then. With `stop`, any smaller number where one is
/// outside.
///
/// With `|d_0| < |d_n|` the reduction `(d_n D - d_0 D#)/z` has one root less inside and as many outside \[Jury1964\]. With `|d_0| > |d_n|`
/// the polynomial `d_0 D - d_n D#`, one degree lower, has as many inside as `D` by Rouche's theorem, if none is on the circle; a root
/// there is one of every reduction, but the last is a constant.
pub(super) fn inside(mut d: Vec<Interval>, stop: bool, bits: usize, clock: &Clock) -> Result<usize, String> {
    let mut found = 0;
    if d.last().is_none_or(Interval::contains_zero) {
        return Err(uncertain("the degree", bits));
    }
    while d.len() > 1 {
        let n = d.len() - 1;
        clock.spend(2 * n, bits as u64, bits as u64)?;
        balanced(&mut d, bits);
        let (first, last) = (d[0].clone(), d[n].clone());
        let squares = last.times(&last, bits).minus(&first.times(&first, bits));
        d = match squares.sign() {
            Some(Sign::Plus) => {
                found += 1;
                (1..=n).map(|k| last.times(&d[k], bits).minus(&first.times(&d[n - k], bits))).collect()
            }
            Some(Sign::Minus) if stop => return Ok(found),
            Some(Sign::Minus) => (0..n).map(|k| first.times(&d[k], bits).minus(&last.times(&d[n - k], bits))).collect(),
            _ => return Err(uncertain("a root count", bits)),
        };
    }
    if d[0].contains_zero() { Err(uncertain("a root count", bits)) } else { Ok(found) }
}

/// Coefficients of a positive multiple of `f(a + w t)` in `t`: multiples and sums by integers, which round nothing.
fn along(mut c: Vec<Interval>, a: &Q, w: &Q, clock: &Clock) -> Result<Vec<Interval>, String> {
    let d = a.denom() * w.denom();
    let mut scale = Z::one();
    for x in c.iter_mut().rev() {
        *x = x.scaled(&scale);
        scale *= &d;
    }
    shift(&mut c, &(a.numer() * w.denom()), clock)?;
    let (step, mut scale) = (w.numer() * a.denom(), Z::one());
    for x in &mut c {
        *x = x.scaled(&scale);
        scale *= &step;
    }
    Ok(c)
}

/// `f(t + a)` by repeated synthetic division.
fn shift(c: &mut [Interval], a: &Z, clock: &Clock) -> Result<(), String> {
    let n = c.len();
    for i in 0..n {
        clock.spend(n - i, a.bits(), 64)?;
        for j in (i..n - 1).rev() {
            c[j] = c[j].plus(&c[j + 1].scaled(a));
        }
    }
    Ok(())
}
