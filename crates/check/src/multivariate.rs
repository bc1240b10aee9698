//! Polynomials in the loop's variable and all parameters, and their quotients.

use super::clock::Clock;
use super::number::{Q, Z, power};
use super::products;
use super::univariate::{gcd_counted, gcd_of};
use num_traits::{One, Signed, Zero};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// More terms than this are refused.
const MAX_TERMS: usize = 50_000;

/// Exponents beyond this are refused.
const MAX_EXPONENT: u32 = 4000;

/// Numbers of more bits are refused before they are computed.
const MAX_BITS: u64 = 1 << 22;

/// Counts operations on numbers of so many bits, whose results have at most as many as both together.
fn count(clock: &Clock, operations: usize, bits: u64, others: u64) -> Result<(), String> {
    if bits.saturating_add(others) > MAX_BITS {
        return Err(clock.refuse("a number in the model grows too long"));
    }
    clock.spend(operations, bits, others)
}

fn longest<'z>(numbers: impl Iterator<Item = &'z Z>) -> u64 {
    numbers.map(Z::bits).max().unwrap_or(0)
}

/// Integer coefficients by exponents; variable 0 is `z` or `s`, the parameters follow.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct Multi(pub BTreeMap<Vec<u32>, Z>);

impl Multi {
    pub fn constant(value: Z) -> Self {
        Multi::default().with(Vec::new(), value)
    }

    pub fn one() -> Self {
        Multi::constant(Z::one())
    }

    pub fn variable(index: usize) -> Self {
        let mut exponents = vec![0; index + 1];
        exponents[index] = 1;
        Multi::default().with(exponents, Z::one())
    }

    fn with(mut self, exponents: Vec<u32>, value: Z) -> Self {
        self.add(exponents, value);
        self
    }

    /// Adds a term. Exponent lists have no zeros at the end, so that each monomial has one key.
    pub fn add(&mut self, mut exponents: Vec<u32>, value: Z) {
        while exponents.last() == Some(&0) {
            exponents.pop();
        }
        match self.0.entry(exponents) {
            Entry::Vacant(_) if value.is_zero() => {}
            Entry::Vacant(place) => {
                place.insert(value);
            }
            Entry::Occupied(mut place) => {
                *place.get_mut() += value;
                if place.get().is_zero() {
                    place.remove();
                }
            }
        }
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    pub fn is_constant(&self) -> bool {
        self.0.keys().all(Vec::is_empty)
    }

    /// The degree in a variable, 0 for zero.
    pub fn degree(&self, variable: usize) -> usize {
        self.0.keys().map(|e| e.get(variable).copied().unwrap_or(0) as usize).max().unwrap_or(0)
    }

    pub fn plus(&self, other: &Multi) -> Multi {
        let mut sum = self.clone();
        sum.add_all(other);
        sum
    }

    pub fn add_all(&mut self, other: &Multi) {
        for (e, c) in &other.0 {
            match self.0.get_mut(e) {
                Some(sum) => {
                    *sum += c;
                    if sum.is_zero() {
                        self.0.remove(e);
                    }
                }
                None => {
                    self.0.insert(e.clone(), c.clone());
                }
            }
        }
    }

    pub fn minus(&self, other: &Multi) -> Multi {
        self.plus(&other.scaled(&-Z::one()))
    }

    pub fn scaled(&self, factor: &Z) -> Multi {
        if factor.is_zero() {
            return Multi::default();
        }
        Multi(self.0.iter().map(|(e, c)| (e.clone(), c * factor)).collect())
    }

    pub fn times(&self, other: &Multi, clock: &Clock) -> Result<Multi, String> {
        let bits = [self, other].map(|m| longest(m.0.values()));
        count(clock, 0, bits[0], bits[1])?;
        // The product of the terms of the highest degrees in a variable has the sum of these.
        if !self.is_zero()
            && !other.is_zero()
            && products::added(&self.degrees(), &other.degrees()).iter().any(|&e| e > MAX_EXPONENT)
        {
            return Err(clock.refuse("an expression of the model has too high a degree"));
        }
        clock.hold(self.0.len().saturating_mul(other.0.len()).min(MAX_TERMS), bits[0] + bits[1])?;
        products::times(self, other, bits, MAX_TERMS, clock)?
            .ok_or_else(|| clock.refuse("an expression of the model has too many terms"))
    }

    /// The degrees in all variables.
    fn degrees(&self) -> Vec<u32> {
        let mut out = Vec::new();
        for e in self.0.keys() {
            out.resize(out.len().max(e.len()), 0);
            out.iter_mut().zip(e).for_each(|(most, e)| *most = (*most).max(*e));
        }
        out
    }

    pub fn power(&self, exponent: u32, clock: &Clock) -> Result<Multi, String> {
        let mut result = Multi::one();
        if let (1, Some((e, c))) = (self.0.len(), self.0.first_key_value()) {
            let bits = c.bits().saturating_mul(exponent.into());
            count(clock, 1, bits / 2, bits / 2)?;
            let e: Vec<u32> = e.iter().map(|e| e.saturating_mul(exponent)).collect();
            if e.iter().any(|&e| e > MAX_EXPONENT) {
                return Err(clock.refuse("an expression of the model has too high a degree"));
            }
            return Ok(Multi::default().with(e, c.pow(exponent)));
        }
        for _ in 0..exponent {
            result = result.times(self, clock)?;
        }
        Ok(result)
    }

    /// Coefficients of the powers of a variable, from the constant term up.
    pub fn coefficients(&self, variable: usize) -> Vec<Multi> {
        let mut out = vec![Multi::default(); if self.is_zero() { 0 } else { self.degree(variable) + 1 }];
        for (e, c) in &self.0 {
            let mut rest = e.clone();
            let k = rest.get_mut(variable).map_or(0, |e| std::mem::take(e) as usize);
            out[k].add(rest, c.clone());
        }
        out
    }

    /// `variable^k` times the polynomial.
    fn raised(&self, variable: usize, k: usize) -> Multi {
        let mut out = Multi::default();
        for (e, c) in &self.0 {
            let mut e = e.clone();
            if e.len() <= variable {
                e.resize(variable + 1, 0);
            }
            e[variable] += k as u32;
            out.add(e, c.clone());
        }
        out
    }

    /// The quotient, if the division is exact over the integers.
    pub fn divided(&self, divisor: &Multi, clock: &Clock) -> Result<Option<Multi>, String> {
        // The largest key is the leading term of a lexicographic order: shorter lists count as padded with 0.
        let Some((lead_e, lead_c)) = divisor.0.last_key_value() else { return Ok(None) };
        let (mut rest, mut quotient) = (self.clone(), Multi::default());
        let bits = longest(divisor.0.values());
        while let Some((e, c)) = rest.0.last_key_value() {
            let fits = e.len() >= lead_e.len() && e.iter().zip(lead_e).all(|(a, b)| a >= b);
            let factor = c / lead_c;
            if !fits || &factor * lead_c != *c {
                return Ok(None);
            }
            let difference: Vec<u32> =
                e.iter().enumerate().map(|(i, a)| a - lead_e.get(i).copied().unwrap_or(0)).collect();
            count(clock, divisor.0.len(), factor.bits(), bits)?;
            for (f, d) in &divisor.0 {
                let n = f.len().max(difference.len());
                let at = |list: &[u32], i: usize| list.get(i).copied().unwrap_or(0);
                rest.add((0..n).map(|i| at(f, i) + at(&difference, i)).collect(), -(d * &factor));
            }
            quotient.add(difference, factor);
        }
        Ok(Some(quotient))
    }

    /// The quotient of a polynomial by a divisor of it.
    pub fn quotient(&self, divisor: &Multi, clock: &Clock) -> Result<Multi, String> {
        self.divided(divisor, clock)?.ok_or_else(|| "internal: a divisor does not divide".into())
    }

    /// The least common multiple.
    pub fn common_multiple<'m>(all: impl Iterator<Item = &'m Multi>, clock: &Clock) -> Result<Multi, String> {
        let mut common = Multi::one();
        for own in all {
            let rest = own.quotient(&common.gcd(own, clock)?, clock)?;
            common = common.times(&rest, clock)?;
        }
        Ok(common)
    }

    /// A greatest common divisor over the integers, by primitive remainders in the first variable.
    pub fn gcd(&self, other: &Multi, clock: &Clock) -> Result<Multi, String> {
        clock.tick()?;
        if self.is_zero() || other.is_zero() {
            return Ok(self.plus(other));
        }
        let first = |m: &Multi| m.0.keys().filter_map(|e| e.iter().position(|&e| e > 0)).min();
        let variable = match (first(self), first(other)) {
            (None, None) => {
                let all = self.0.values().chain(other.0.values());
                return Ok(Multi::constant(gcd_of(all, clock)?));
            }
            (a, b) => a.unwrap_or(usize::MAX).min(b.unwrap_or(usize::MAX)),
        };
        let (content_a, mut a) = self.split_content(variable, clock)?;
        let (content_b, mut b) = other.split_content(variable, clock)?;
        if a.degree(variable) < b.degree(variable) {
            std::mem::swap(&mut a, &mut b);
        }
        while !b.is_zero() {
            if b.degree(variable) == 0 {
                a = Multi::one();
                break;
            }
            let rest = a.pseudo_remainder(&b, variable, clock)?;
            a = std::mem::replace(&mut b, rest.split_content(variable, clock)?.1);
        }
        content_a.gcd(&content_b, clock)?.times(&a, clock)
    }

    /// The greatest common divisor of the coefficients of a variable, and the rest.
    pub fn split_content(&self, variable: usize, clock: &Clock) -> Result<(Multi, Multi), String> {
        let mut content = Multi::default();
        for c in self.coefficients(variable) {
            content = content.gcd(&c, clock)?;
        }
        if self.is_zero() {
            return Ok((Multi::one(), Multi::default()));
        }
        let rest = self.quotient(&content, clock)?;
        Ok((content, rest))
    }

    fn pseudo_remainder(&self, divisor: &Multi, variable: usize, clock: &Clock) -> Result<Multi, String> {
        let n = divisor.degree(variable);
        let lead = divisor.coefficients(variable).pop().unwrap_or_default();
        let mut rest = self.clone();
        while !rest.is_zero() && rest.degree(variable) >= n {
            let shift = rest.degree(variable) - n;
            let top = rest.coefficients(variable).pop().unwrap_or_default();
            let subtract = divisor.times(&top, clock)?.raised(variable, shift);
            rest = rest.times(&lead, clock)?.minus(&subtract);
        }
        Ok(rest)
    }

    /// The polynomial with every parameter but `kept` replaced by its value: rational coefficients by powers
    /// of variable 0, and in each by powers of the kept parameter.
    pub fn specialised(&self, kept: usize, values: &[Q], clock: &Clock) -> Result<Vec<Vec<Q>>, String> {
        let mut out: Vec<Vec<Q>> = vec![vec![Q::zero(); self.degree(kept) + 1]; self.degree(0) + 1];
        for (e, c) in &self.0 {
            let mut term = Q::from(c.clone());
            for (i, &k) in e.iter().enumerate().filter(|(i, k)| *i != 0 && *i != kept && **k > 0) {
                let value = values.get(i).ok_or("a number is needed of what depends on the parameters in question")?;
                let bits = |q: &Q| q.numer().bits() + q.denom().bits();
                count(clock, 1, bits(&term), bits(value).saturating_mul(k.into()))?;
                term *= power(value, k);
            }
            let at = |i: usize| e.get(i).copied().unwrap_or(0) as usize;
            out[at(0)][at(kept)] += term;
        }
        Ok(out)
    }
}

/// `numerator / (denominator scalar)`: the denominator contains variable 0 or is 1, the scalar does not
/// contain it. Nothing but integers is ever cancelled.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fraction {
    pub numerator: Multi,
    pub denominator: Multi,
    pub scalar: Multi,
}

impl From<Multi> for Fraction {
    fn from(numerator: Multi) -> Self {
        Fraction::over(numerator, Multi::one())
    }
}

impl Fraction {
    pub fn number(value: &Q) -> Self {
        Fraction::over(Multi::constant(value.numer().clone()), Multi::constant(value.denom().clone()))
    }

    pub fn variable(index: usize) -> Self {
        Multi::variable(index).into()
    }

    /// Over a polynomial without variable 0.
    pub fn over(numerator: Multi, scalar: Multi) -> Self {
        Fraction { numerator, denominator: Multi::one(), scalar }
    }

    /// Without common integer factors.
    fn reduced(mut self, clock: &Clock) -> Result<Self, String> {
        let mut g = Z::zero();
        for c in self.numerator.0.values().chain(self.scalar.0.values()) {
            g = gcd_counted(&g, c, clock)?;
            if g.is_one() {
                break;
            }
        }
        if self.scalar.0.last_key_value().is_some_and(|(_, c)| c.is_negative()) {
            g = -g;
        }
        if !g.is_zero() && !g.is_one() {
            for c in self.numerator.0.values_mut().chain(self.scalar.0.values_mut()) {
                *c = &*c / &g;
            }
        }
        Ok(self)
    }

    pub fn negated(self) -> Self {
        Fraction { numerator: self.numerator.scaled(&-Z::one()), ..self }
    }

    /// The sum over the least common denominator.
    pub fn plus(&self, other: &Fraction, clock: &Clock) -> Result<Fraction, String> {
        let (d, e) = (&self.denominator, &other.denominator);
        let (d_rest, e_rest) = if d == e {
            (Multi::one(), Multi::one())
        } else if d.degree(0) == 0 || e.degree(0) == 0 {
            (d.clone(), e.clone())
        } else {
            let g = d.gcd(e, clock)?.split_content(0, clock)?.1;
            (d.quotient(&g, clock)?, e.quotient(&g, clock)?)
        };
        let (left_scalar, right_scalar) = if self.scalar == other.scalar {
            (Multi::one(), Multi::one())
        } else if self.scalar.is_constant() && other.scalar.is_constant() {
            let g = self.scalar.gcd(&other.scalar, clock)?;
            (other.scalar.quotient(&g, clock)?, self.scalar.quotient(&g, clock)?)
        } else {
            (other.scalar.clone(), self.scalar.clone())
        };
        let left = self.numerator.times(&e_rest, clock)?.times(&left_scalar, clock)?;
        let right = other.numerator.times(&d_rest, clock)?.times(&right_scalar, clock)?;
        let sum = left.plus(&right);
        let (denominator, scalar) = (d.times(&e_rest, clock)?, self.scalar.times(&left_scalar, clock)?);
        Fraction { numerator: sum, denominator, scalar }.reduced(clock)
    }

    pub fn times(&self, other: &Fraction, clock: &Clock) -> Result<Fraction, String> {
        Fraction {
            numerator: self.numerator.times(&other.numerator, clock)?,
            denominator: self.denominator.times(&other.denominator, clock)?,
            scalar: self.scalar.times(&other.scalar, clock)?,
        }
        .reduced(clock)
    }

    /// `1/self`; the numerator must not be zero.
    pub fn inverse(&self, clock: &Clock) -> Result<Fraction, String> {
        let top = self.denominator.times(&self.scalar, clock)?;
        let bottom = self.numerator.clone();
        if bottom.degree(0) == 0 {
            Fraction::over(top, bottom)
        } else {
            Fraction { numerator: top, denominator: bottom, scalar: Multi::one() }
        }
        .reduced(clock)
    }

    pub fn power(&self, exponent: u32, clock: &Clock) -> Result<Fraction, String> {
        Ok(Fraction {
            numerator: self.numerator.power(exponent, clock)?,
            denominator: self.denominator.power(exponent, clock)?,
            scalar: self.scalar.power(exponent, clock)?,
        })
    }

    /// The value, if no variable occurs.
    pub fn as_number(&self) -> Option<Q> {
        let number = |m: &Multi| m.is_constant().then(|| m.0.values().next().cloned().unwrap_or_default());
        let below = number(&self.scalar)? * number(&self.denominator)?;
        if below.is_zero() { None } else { Some(Q::new(number(&self.numerator)?, below)) }
    }

    /// Denominator and scalar together.
    pub fn whole_denominator(&self, clock: &Clock) -> Result<Multi, String> {
        self.denominator.times(&self.scalar, clock)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn gcd_of_products() {
        let clock = &Clock::new(Duration::MAX);
        let (x, y, z) = (Multi::variable(0), Multi::variable(1), Multi::variable(3));
        let f = x.times(&y, clock).unwrap().plus(&z);
        let g = x.minus(&y).plus(&Multi::constant(Z::from(3)));
        let h = y.times(&z, clock).unwrap().scaled(&Z::from(6)).plus(&x);
        let (a, b) = (f.times(&g, clock).unwrap(), f.times(&h, clock).unwrap());
        let common = a.gcd(&b, clock).unwrap();
        assert!(common == f || common == f.scaled(&Z::from(-1)), "{common:?}");
        assert_eq!(a.divided(&g, clock).unwrap(), Some(f));
        assert_eq!(a.divided(&h, clock).unwrap(), None);
    }
}
