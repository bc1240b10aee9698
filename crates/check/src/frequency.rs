//! A quasi-polynomial along the imaginary axis: the axis cut into parts, on each of which the function is enclosed.

use super::clock::Clock;
use super::interval::{Interval, solutions};
use super::number::{Q, Z};
use super::univariate::Uni;
use num_traits::{One, Signed, Zero};
use std::collections::BTreeMap;

/// The axis is halved this often at most.
const MAX_HALVINGS: usize = 200;

/// More parts of the axis are refused.
const MAX_PARTS: usize = 100_000;

/// Powers of two between which the highest power of `s` is to dominate from.
const EXPONENTS: std::ops::RangeInclusive<i32> = -128..=256;

/// More dead times, or a higher order, are refused.
const MAX_ORDER: usize = 64;

/// `sum (A_k(s) + p B_k(s)) z^k`, `z = exp(-tau s)`.
pub(super) struct Family {
    pub order: usize,
    /// Coefficients of `A_k` and `B_k` from the constant term up, `order + 1` of each.
    parts: Vec<[Vec<Z>; 2]>,
    tau: Q,
}

impl Family {
    /// From the coefficients of powers of `s`, `a + b p`, for each power of `z`.
    pub fn new(parts: &[Vec<Uni>], tau: Q) -> Result<Self, String> {
        let order = parts.iter().flat_map(|part| part.iter().rposition(|c| !c.is_zero())).max();
        let order = order.filter(|n| (1..=MAX_ORDER).contains(n)).ok_or("the loop has no fitting order")?;
        let row =
            |part: &Vec<Uni>, k: usize| (0..=order).map(|j| part.get(j).map_or_else(Z::zero, |c| c.at(k))).collect();
        Ok(Family { order, parts: parts.iter().map(|part| [row(part, 0), row(part, 1)]).collect(), tau })
    }

    fn coefficient(&self, k: usize, j: usize, p: &Q) -> Q {
        let [a, b] = &self.parts[k];
        Q::from(a[j].clone()) + p * Q::from(b[j].clone())
    }

    /// The value at `s = 0`.
    pub fn at_zero(&self, p: &Q) -> Q {
        (0..self.parts.len()).fold(Q::zero(), |sum, k| sum + self.coefficient(k, 0, p))
    }

    /// The coefficient of the highest power of `s` without delay.
    pub fn leading(&self, p: &Q) -> Q {
        self.coefficient(0, self.order, p)
    }

    /// The exponent of a power of two from which on, for `p` from `a` to `b` and `Re s >= 0`, the highest power of `s` without delay
    /// outweighs all other terms: a coefficient is largest at one of the ends, and what is left divided by that power falls.
    pub fn beyond(&self, a: &Q, b: &Q, clock: &Clock) -> Result<i32, String> {
        let n = self.order;
        let (first, last) = (self.leading(a), self.leading(b));
        let dominates = || "the highest power of s is not shown to outweigh the others".to_owned();
        if first.is_zero() || last.is_zero() || first.is_negative() != last.is_negative() {
            return Err(dominates());
        }
        let largest = |k: usize, j: usize| self.coefficient(k, j, a).abs().max(self.coefficient(k, j, b).abs());
        let sum = |j: usize| (0..self.parts.len()).fold(Q::zero(), |sum, k| sum + largest(k, j));
        let others: Vec<Q> = (0..n).map(sum).collect();
        let delayed = (1..self.parts.len()).fold(Q::zero(), |sum, k| sum + largest(k, n));
        let left = first.abs().min(last.abs()) - delayed;
        if !left.is_positive() {
            return Err(dominates());
        }
        let power = |e: i32| if e < 0 { Q::new(Z::one(), Z::one() << -e) } else { Q::from(Z::one() << e) };
        let bits = left.numer().bits() + left.denom().bits();
        for e in EXPONENTS {
            clock.spend(n * n, bits + 256, bits + 256)?;
            let s = power(e);
            let rest = others.iter().rev().fold(Q::zero(), |sum, c| sum * &s + c);
            if rest < &left * num_traits::pow(s, n) {
                return Ok(e);
            }
        }
        Err(dominates())
    }
}

/// A complex number, enclosed.
#[derive(Clone)]
pub(super) struct Complex(pub [Interval; 2]);

impl Complex {
    fn zero() -> Self {
        Complex([Interval::zero(), Interval::zero()])
    }

    pub fn plus(&self, other: &Self) -> Self {
        let ([a, b], [c, d]) = (&self.0, &other.0);
        Complex([a.plus(c), b.plus(d)])
    }

    pub fn times(&self, other: &Self, bits: usize) -> Self {
        let ([a, b], [c, d]) = (&self.0, &other.0);
        Complex([a.times(c, bits).minus(&b.times(d, bits)), a.times(d, bits).plus(&b.times(c, bits))])
    }

    pub fn conjugate(&self) -> Self {
        let [a, b] = &self.0;
        Complex([a.clone(), b.negated()])
    }

    pub fn scaled(&self, n: &Z) -> Self {
        Complex([self.0[0].scaled(n), self.0[1].scaled(n)])
    }

    /// The square of the modulus.
    pub fn square(&self, bits: usize) -> Interval {
        let squared = |x: &Interval| {
            let product = x.times(x, bits);
            if x.contains_zero() { Interval { lo: Z::zero(), hi: product.hi } } else { product }
        };
        squared(&self.0[0]).plus(&squared(&self.0[1]))
    }
}

/// A half plane in which a value is: around the positive real axis, the positive imaginary one, the negative ones.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Label(i64);

impl Label {
    /// Around a number with this sign times `i^power`.
    pub fn of_sign(is_negative: bool, power: usize) -> Self {
        Label((power as i64 + if is_negative { 2 } else { 0 }) % 4)
    }

    /// The quarter turn to another half plane that shares a point with this one; `None` for the opposite one.
    pub fn step_to(self, other: Label) -> Option<i64> {
        match (other.0 - self.0).rem_euclid(4) {
            0 => Some(0),
            1 => Some(1),
            3 => Some(-1),
            _ => None,
        }
    }

    /// The half plane of an enclosed value, this one if possible, and the quarter turn to it.
    pub fn next(self, value: &Complex) -> Option<(Label, i64)> {
        let [re, im] = &value.0;
        let holds = |label: i64| match label {
            0 => re.lo.is_positive(),
            1 => im.lo.is_positive(),
            2 => re.hi.is_negative(),
            _ => im.hi.is_negative(),
        };
        [0, 1, 3].into_iter().find_map(|step| {
            let label = (self.0 + step) % 4;
            holds(label).then_some((Label(label), if step == 3 { -1 } else { step }))
        })
    }
}

/// A part of the axis: its lower end and the power of two that is its width, in units, and `exp(i omega tau)` in its middle.
struct Part {
    lower: Z,
    width: usize,
    turn: Complex,
}

/// The axis from 0 on, in units of `2^-bits`.
pub(super) struct Frequencies<'a> {
    family: &'a Family,
    bits: usize,
    /// `exp(i omega tau)` for `omega` of `2^k` units.
    turns: BTreeMap<usize, Complex>,
    /// How many parts have been looked at.
    parts: usize,
    clock: &'a Clock,
}

impl<'a> Frequencies<'a> {
    pub fn new(family: &'a Family, bits: usize, clock: &'a Clock) -> Self {
        Frequencies { family, bits, turns: BTreeMap::new(), parts: 0, clock }
    }

    /// `exp(i omega tau)` for `omega` of `2^k` units.
    fn turn(&mut self, k: usize) -> Result<Complex, String> {
        if let Some(known) = self.turns.get(&k) {
            return Ok(known.clone());
        }
        let omega = Q::new(Z::one() << k, Z::one() << self.bits);
        let mut row =
            solutions(&[Q::one(), Q::zero()], &(omega * &self.family.tau), self.bits, self.clock)?.into_iter();
        let (Some(cos), Some(sin)) = (row.next(), row.next()) else { return Err("internal: no circle".into()) };
        let found = Complex([cos, sin]);
        self.turns.insert(k, found.clone());
        Ok(found)
    }

    /// Calls `settles` with `A` and `B` on parts of the axis from 0 to `2^exponent`, in order; one that it does not settle is halved.
    pub fn walk(&mut self, exponent: i32, mut settles: impl FnMut([Complex; 2], usize) -> bool) -> Result<(), String> {
        let end = usize::try_from(self.bits as i64 + i64::from(exponent)).unwrap_or(0);
        let least = end.saturating_sub(MAX_HALVINGS).max(2);
        if end <= least {
            return Err("the frequencies are too low for the bits".into());
        }
        let turn = self.turn(end - 1)?;
        let mut parts = vec![Part { lower: Z::zero(), width: end, turn }];
        while let Some(part) = parts.pop() {
            self.parts += 1;
            if self.parts > MAX_PARTS {
                return Err("the axis would have to be cut into too many parts".into());
            }
            if settles(self.enclosed(&part)?, self.bits) {
                continue;
            }
            if part.width <= least {
                return Err("a root may be on the axis".into());
            }
            // The middles of the halves are a quarter away from the middle.
            let quarter = self.turn(part.width - 2)?;
            let middle = &part.lower + (Z::one() << (part.width - 1));
            let above = part.turn.times(&quarter, self.bits);
            let below = part.turn.times(&quarter.conjugate(), self.bits);
            parts.push(Part { lower: middle, width: part.width - 1, turn: above });
            parts.push(Part { lower: part.lower, width: part.width - 1, turn: below });
        }
        Ok(())
    }

    /// `A` and `B` on a part of the axis.
    fn enclosed(&self, part: &Part) -> Result<[Complex; 2], String> {
        let (bits, n) = (self.bits, self.family.order);
        let operations = (n + 1) * (2 * self.family.parts.len() + 1) + 12 * self.family.parts.len();
        self.clock.spend(operations, bits as u64, bits as u64)?;
        // Powers of a number that is not negative rise with it.
        let ends = [part.lower.clone(), &part.lower + (Z::one() << part.width)];
        let omega = Interval { lo: ends[0].clone(), hi: ends[1].clone() };
        let mut powers = vec![Interval::integer(&Z::one(), bits)];
        for j in 0..n {
            let next = powers[j].times(&omega, bits);
            powers.push(next);
        }
        // Half of the width times tau, in units, rounded up.
        let half = Q::from(Z::one() << (part.width - 1)) * &self.family.tau;
        let radius = half.ceil().to_integer();
        let one = Z::one() << bits;
        let mut power = Complex([Interval::integer(&Z::one(), bits), Interval::zero()]);
        let mut out = [Complex::zero(), Complex::zero()];
        for (k, both) in self.family.parts.iter().enumerate() {
            if k > 0 {
                power = power.times(&part.turn, bits);
            }
            // exp(-i k omega tau) differs from that in the middle by no more than the angle.
            let off = &radius * Z::from(k);
            let near = |x: &Interval| Interval { lo: (&x.lo - &off).max(-&one), hi: (&x.hi + &off).min(one.clone()) };
            let z = Complex([near(&power.0[0]), near(&power.0[1]).negated()]);
            for (sum, coefficients) in out.iter_mut().zip(both) {
                if coefficients.iter().all(Zero::is_zero) {
                    continue;
                }
                // i^j: 1, i, -1, -i.
                let mut value = [Interval::zero(), Interval::zero()];
                for (j, c) in coefficients.iter().enumerate().filter(|(_, c)| !c.is_zero()) {
                    let term = powers[j].scaled(c);
                    let term = if j % 4 >= 2 { term.negated() } else { term };
                    value[j % 2] = value[j % 2].plus(&term);
                }
                let value = Complex(value);
                *sum = sum.plus(&if k == 0 { value } else { value.times(&z, bits) });
            }
        }
        Ok(out)
    }
}
