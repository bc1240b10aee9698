//! Functions of the coordinates of a box as polynomials with a bound of what is left out.
//!
//! Taylor models \[MakinoBerz2003\], for use in this package only. Each coordinate goes from -1 to 1. Coefficients are integers in units of `2^-bits`; every rounding is in the bound.

mod monomials;

use super::clock::Clock;
use super::interval::Interval;
use super::number::{Q, Z};
use monomials::Monomials;
use num_traits::{Euclid, One, Signed, Zero};
use std::iter::repeat_n;

/// How functions are written: polynomials up to a total degree, in units of `2^-bits`.
#[derive(Clone, Debug)]
pub(super) struct Precision {
    pub order: usize,
    pub bits: usize,
    monomials: Monomials,
}

/// A sum of monomials in the coordinates, off by at most `rest` at every point of the box.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Taylor {
    /// In the order of [`Monomials`]; the terms of the highest degrees that are zero may be left out.
    c: Vec<Z>,
    pub rest: Z,
}

/// The quotient by `2^bits`, rounded up.
fn up(x: &Z, bits: usize) -> Z {
    -((-x) >> bits)
}

impl Precision {
    /// Over a box of so many parameters.
    pub fn new(parameters: usize, order: usize, bits: usize) -> Self {
        Precision { order, bits, monomials: Monomials::new(parameters, order) }
    }

    /// The number of parameters.
    pub fn parameters(&self) -> usize {
        self.monomials.variables()
    }

    /// The number of coefficients of a function.
    pub fn terms(&self) -> usize {
        self.monomials.len()
    }

    /// Refuses more functions at once than memory is for. Those of two parameters are short.
    pub fn hold(&self, functions: usize, clock: &Clock) -> Result<(), String> {
        match self.parameters() {
            0..=2 => Ok(()),
            _ => clock.hold(functions.saturating_mul(self.terms()), self.bits as u64),
        }
    }

    fn one_unit(&self) -> Z {
        Z::one() << self.bits
    }
}

impl Taylor {
    pub fn zero() -> Self {
        Taylor { c: Vec::new(), rest: Z::zero() }
    }

    /// So many units.
    pub fn units(c: Z, rest: Z) -> Self {
        Taylor { c: vec![c], rest }
    }

    /// A number in an interval.
    pub fn enclosing(of: &Interval) -> Self {
        let middle = (&of.lo + &of.hi) >> 1;
        let rest = &of.hi - &middle;
        Taylor::units(middle, rest)
    }

    /// All values.
    pub fn range(&self) -> Interval {
        let (c, around) = (self.constant(), self.variation());
        Interval { lo: &c - &around, hi: c + around }
    }

    pub fn number(q: &Q, p: &Precision) -> Self {
        let top = q.numer() << p.bits;
        let floor = top.div_euclid(q.denom());
        let rest = if &floor * q.denom() == top { Z::zero() } else { Z::one() };
        Taylor::units(floor, rest)
    }

    /// A parameter over its side of a box: the middle and half of the width times the coordinate of this number.
    pub fn coordinate([low, high]: &[Q; 2], axis: usize, p: &Precision) -> Self {
        let two = Q::from(Z::from(2));
        let (middle, half) = (Taylor::number(&((low + high) / &two), p), Taylor::number(&((high - low) / &two), p));
        let mut c = vec![Z::zero(); 2 + axis];
        c[0] = middle.constant();
        c[1 + axis] = half.constant();
        Taylor { c, rest: middle.rest + half.rest }
    }

    pub fn constant(&self) -> Z {
        self.c.first().cloned().unwrap_or_default()
    }

    /// A bound of what is beside the constant.
    pub fn variation(&self) -> Z {
        self.c.iter().skip(1).map(Z::abs).sum::<Z>() + &self.rest
    }

    /// A bound of the modulus.
    pub fn magnitude(&self) -> Z {
        self.constant().abs() + self.variation()
    }

    /// The coefficient of a coordinate.
    pub fn linear(&self, axis: usize) -> Z {
        self.c.get(1 + axis).cloned().unwrap_or_default()
    }

    /// Whether it is positive, or negative, at every point.
    pub fn sign(&self) -> Option<bool> {
        let c = self.constant();
        (c.abs() > self.variation()).then(|| c.is_positive())
    }

    pub fn plus(&self, other: &Self) -> Self {
        let (long, short) = if self.c.len() < other.c.len() { (other, self) } else { (self, other) };
        let mut c = long.c.clone();
        c.iter_mut().zip(&short.c).for_each(|(x, y)| *x += y);
        Taylor { c, rest: &self.rest + &other.rest }
    }

    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.scaled(&-Z::one()))
    }

    /// Times an integer, exactly.
    pub fn scaled(&self, n: &Z) -> Self {
        Taylor { c: self.c.iter().map(|c| c * n).collect(), rest: &self.rest * n.abs() }
    }

    /// Adds an integer times another one.
    pub fn add_scaled(&mut self, other: &Self, n: &Z) {
        if self.c.len() < other.c.len() {
            let missing = other.c.len() - self.c.len();
            self.c.extend(repeat_n(Z::zero(), missing));
        }
        self.c.iter_mut().zip(&other.c).for_each(|(x, y)| *x += y * n);
        self.rest += &other.rest * n.abs();
    }

    /// Divided by a positive integer.
    pub fn over(&self, n: &Z) -> Self {
        let rounded = Z::from(self.c.len());
        let rest = -((-&self.rest).div_euclid(n)) + rounded;
        Taylor { c: self.c.iter().map(|c| c.div_euclid(n)).collect(), rest }
    }

    /// Divided by a power of two.
    pub fn halved(&self, times: usize) -> Self {
        let rounded = Z::from(self.c.len());
        Taylor { c: self.c.iter().map(|c| c >> times).collect(), rest: up(&self.rest, times) + rounded }
    }

    /// Sums of the moduli of the coefficients of each degree.
    fn sizes(&self, p: &Precision) -> Vec<Z> {
        let mut out = vec![Z::zero(); p.order + 1];
        for (place, c) in self.c.iter().enumerate() {
            out[p.monomials.degree(place)] += c.abs();
        }
        out
    }

    /// The bits of the longest number, or of one: exponentials grow far beyond one.
    fn longest(&self, p: &Precision) -> u64 {
        self.c.iter().chain([&self.rest]).map(Z::bits).fold(p.bits as u64, u64::max)
    }

    /// The number of its coefficients that are not zero.
    pub fn size(&self) -> usize {
        self.c.iter().filter(|c| !c.is_zero()).count()
    }

    /// How many products of coefficients are counted for a product. In more than two coordinates few of them are of no higher degree than the model.
    fn products(&self, other: &Self, p: &Precision) -> usize {
        if p.parameters() <= 2 {
            return self.c.len() * other.c.len();
        }
        let of_degrees = |of: &Self| {
            let mut counts = vec![0; p.order + 1];
            of.c.iter().enumerate().filter(|(_, c)| !c.is_zero()).for_each(|(i, _)| counts[p.monomials.degree(i)] += 1);
            counts
        };
        let (own, others) = (of_degrees(self), of_degrees(other));
        let pairs = own.iter().enumerate().map(|(d, count)| count * others[..=p.order - d].iter().sum::<usize>());
        // Each coefficient is looked at, too.
        pairs.sum::<usize>() + (self.c.len() + other.c.len()) / 16 + 1
    }

    pub fn times(&self, other: &Self, p: &Precision, clock: &Clock) -> Result<Self, String> {
        clock.spend(self.products(other, p), self.longest(p), other.longest(p))?;
        let mut full: Vec<Z> = Vec::new();
        let others: Vec<(usize, &Z)> = other.c.iter().enumerate().filter(|(_, b)| !b.is_zero()).collect();
        for (i, a) in self.c.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            let most = p.order - p.monomials.degree(i);
            for &(k, b) in &others {
                if p.monomials.degree(k) > most {
                    break;
                }
                let place = p.monomials.product(i, k);
                if full.len() <= place {
                    full.resize(place + 1, Z::zero());
                }
                full[place] += a * b;
            }
        }
        // What is of too high a degree, and what the bounds make.
        let (own, others) = (self.sizes(p), other.sizes(p));
        let mut left: Z = Z::zero();
        for (d, a) in own.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            left += a * others[p.order + 1 - d..].iter().sum::<Z>();
        }
        let (own, others) = (own.iter().sum::<Z>(), others.iter().sum::<Z>());
        left += own * &other.rest + (others + &other.rest) * &self.rest;
        let rest = up(&left, p.bits) + Z::from(full.len());
        Ok(Taylor { c: full.into_iter().map(|c| c >> p.bits).collect(), rest })
    }

    /// Over the lower and the upper half of the box along an axis: `u` becomes `(u - 1)/2` and `(u + 1)/2`.
    pub fn halves(&self, axis: usize, p: &Precision) -> [Self; 2] {
        [-1, 1].map(|shift| {
            let mut c = vec![Z::zero(); self.c.len()];
            for (place, x) in self.c.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
                // x ((u + shift)/2)^n, in units of 2^-order.
                let n = p.monomials.exponent(place, axis);
                let mut way = Z::one() << (p.order - n);
                for k in (0..=n).rev() {
                    c[p.monomials.lowered(place, axis, n - k)] += x * &way;
                    way = way * Z::from(k) * Z::from(shift) / Z::from(n - k + 1);
                }
            }
            let rest = &self.rest + Z::from(c.len());
            Taylor { c: c.into_iter().map(|x| x >> p.order).collect(), rest }
        })
    }

    /// `1/f`; an error where the box is too wide for the series.
    pub fn inverse(&self, p: &Precision, clock: &Clock) -> Result<Self, String> {
        let (y, q) = self.relative(p, clock)?;
        // 1/(c (1 + y)) = (1 - y + y^2 - ...)/c.
        let one = Taylor::units(p.one_unit(), Z::zero());
        let mut sum = one.clone();
        for _ in 0..p.order {
            sum = one.minus(&sum.times(&y, p, clock)?);
        }
        sum.rest += q;
        sum.times(&self.reciprocal_of_constant(p)?, p, clock)
    }

    /// The square root that is not negative; an error where the box is too wide for the series.
    pub fn root(&self, p: &Precision, clock: &Clock) -> Result<Self, String> {
        let c = self.constant();
        if !c.is_positive() {
            return Err("a square root is not shown to be of a positive number".into());
        }
        let (y, q) = self.relative(p, clock)?;
        // The coefficient of y^(k + 1) is that of y^k times (1 - 2 k)/(2 k + 2); none is above one.
        let one = Taylor::units(p.one_unit(), Z::zero());
        let mut sum = one.clone();
        for k in (0..p.order as i64).rev() {
            sum = one.plus(&sum.times(&y, p, clock)?.scaled(&Z::from(1 - 2 * k)).over(&Z::from(2 * k + 2)));
        }
        sum.rest += q;
        sum.times(&Taylor::units((c << p.bits).sqrt(), Z::one()), p, clock)
    }

    /// `f = c (1 + y)` with the constant `c`: `y`, and a bound of `|y|^(order + 1) + |y|^(order + 2) + ...`.
    fn relative(&self, p: &Precision, clock: &Clock) -> Result<(Self, Z), String> {
        let (c, variation) = (self.constant().abs(), self.variation());
        if variation.clone() * 2 > c || c.is_zero() {
            return Err("a box is too wide for what is divided by in it, or for a root".into());
        }
        let mut y = self.clone();
        y.c[0] = Z::zero();
        let y = y.times(&self.reciprocal_of_constant(p)?, p, clock)?;
        // |y| is at most one half: the sum is at most twice its first term.
        let one = p.one_unit();
        let ratio = y.magnitude().min(&one >> 1);
        let mut q = &one << 1;
        for _ in 0..=p.order {
            q = up(&(q * &ratio), p.bits);
        }
        Ok((y, q))
    }

    fn reciprocal_of_constant(&self, p: &Precision) -> Result<Self, String> {
        let c = self.constant();
        if c.is_zero() {
            return Err("a divisor is not shown to be other than zero".into());
        }
        let quotient = (Z::one() << (2 * p.bits)).div_euclid(&c);
        Ok(Taylor::units(quotient, Z::one()))
    }
}

#[cfg(test)]
mod tests_exact;

#[cfg(test)]
mod tests {
    use super::*;
    use num_traits::ToPrimitive;
    use std::time::Duration;

    fn precision() -> Precision {
        Precision::new(2, 4, 96)
    }

    fn clock() -> Clock {
        Clock::new(Duration::MAX)
    }

    fn q(n: i64, d: i64) -> Q {
        Q::new(n.into(), d.into())
    }

    /// The value at a point, and the bound.
    fn value(t: &Taylor, [u, v]: [f64; 2]) -> (f64, f64) {
        let p = precision();
        let unit = 2f64.powi(-96);
        let term = |(place, c): (usize, &Z)| {
            let [i, j] = [0, 1].map(|axis| p.monomials.exponent(place, axis) as i32);
            c.to_f64().unwrap() * unit * u.powi(i) * v.powi(j)
        };
        (t.c.iter().enumerate().map(term).sum(), t.rest.to_f64().unwrap() * unit)
    }

    fn encloses(t: &Taylor, expected: impl Fn(f64, f64) -> f64) {
        for u in [-1.0, -0.3, 0.0, 0.7, 1.0] {
            for v in [-1.0, 0.2, 1.0] {
                let (found, rest) = value(t, [u, v]);
                assert!((found - expected(u, v)).abs() <= rest + 1e-12, "{u} {v}: {found} {rest}");
                assert!(rest < 0.01, "{rest}");
            }
        }
    }

    #[test]
    fn sums_products_quotients_and_roots_are_enclosed() {
        let (p, clock) = (precision(), clock());
        // x from 3 to 4, y from 1/2 to 1.
        let x = Taylor::coordinate(&[q(3, 1), q(4, 1)], 0, &p);
        let y = Taylor::coordinate(&[q(1, 2), q(1, 1)], 1, &p);
        let (x_at, y_at) = (|u: f64| 3.5 + u / 2.0, |v: f64| 0.75 + v / 4.0);
        let product = x.times(&y, &p, &clock).unwrap();
        encloses(&product, |u, v| x_at(u) * y_at(v));
        let fifth = product.times(&product, &p, &clock).unwrap().times(&x, &p, &clock).unwrap();
        let (found, rest) = value(&fifth, [1.0, 1.0]);
        assert!((found - 64.0).abs() <= rest && rest > 0.0, "a term of degree five is in the bound: {found} {rest}");
        encloses(&x.minus(&y).inverse(&p, &clock).unwrap(), |u, v| 1.0 / (x_at(u) - y_at(v)));
        encloses(&x.plus(&y).root(&p, &clock).unwrap(), |u, v| (x_at(u) + y_at(v)).sqrt());
        encloses(&x.over(&Z::from(3)).minus(&y.halved(2)), |u, v| x_at(u) / 3.0 - y_at(v) / 4.0);
        assert!(x.minus(&y.scaled(&Z::from(4))).inverse(&p, &clock).is_err(), "zero is within");
        assert!(y.minus(&x).root(&p, &clock).is_err(), "negative");
    }

    #[test]
    fn halves_are_the_function_over_half_of_the_box() {
        let (p, clock) = (precision(), clock());
        let x = Taylor::coordinate(&[q(3, 1), q(4, 1)], 0, &p);
        let y = Taylor::coordinate(&[q(1, 2), q(1, 1)], 1, &p);
        let f = x.times(&y, &p, &clock).unwrap().times(&y, &p, &clock).unwrap();
        for axis in [0, 1] {
            for (half, shift) in f.halves(axis, &p).iter().zip([-1.0, 1.0]) {
                encloses(half, |u, v| {
                    let at = |k: usize, w: f64| if k == axis { (w + shift) / 2.0 } else { w };
                    (3.5 + at(0, u) / 2.0) * (0.75 + at(1, v) / 4.0).powi(2)
                });
            }
        }
    }

    #[test]
    fn signs_are_those_at_every_point() {
        let p = precision();
        let x = Taylor::coordinate(&[q(0, 1), q(1, 1)], 0, &p);
        assert_eq!(x.sign(), None);
        assert_eq!(x.plus(&Taylor::number(&q(1, 1000), &p)).sign(), Some(true));
        assert_eq!(x.minus(&Taylor::number(&q(3, 2), &p)).sign(), Some(false));
        assert_eq!(Taylor::zero().sign(), None);
    }
}
