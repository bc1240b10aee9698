//! Polynomials in z (or s) whose coefficients are rational functions of the parameters.

use super::scalar::{checked_product, checked_sum};
use crate::text::Sign;
use jurist_algebra::limits::Budget;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};

/// The one form of a value; `None` where it has none.
pub(crate) type Reduced<'r> = dyn Fn(RationalFunction) -> Option<RationalFunction> + 'r;

/// Coefficients from the constant term up, no zero at the top.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ZPoly(Vec<RationalFunction>);

impl ZPoly {
    pub fn new(mut coefficients: Vec<RationalFunction>) -> Self {
        while coefficients.last().is_some_and(RationalFunction::is_zero) {
            coefficients.pop();
        }
        ZPoly(coefficients)
    }

    pub fn constant(value: RationalFunction) -> Self {
        ZPoly::new(vec![value])
    }

    pub fn one() -> Self {
        ZPoly::constant(RationalFunction::one())
    }

    /// `z^k`.
    pub fn power_of_variable(k: usize) -> Self {
        let mut coefficients = vec![RationalFunction::zero(); k];
        coefficients.push(RationalFunction::one());
        ZPoly(coefficients)
    }

    pub fn coefficients(&self) -> &[RationalFunction] {
        &self.0
    }

    pub fn coefficient(&self, k: usize) -> RationalFunction {
        self.0.get(k).cloned().unwrap_or_default()
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    pub fn is_one(&self) -> bool {
        matches!(self.0.as_slice(), [one] if one.is_one())
    }

    /// The degree, 0 for zero.
    pub fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    pub fn leading(&self) -> RationalFunction {
        self.0.last().cloned().unwrap_or_default()
    }

    pub fn negated(&self) -> Self {
        ZPoly(self.0.iter().map(|c| -c).collect())
    }

    pub fn scaled(&self, factor: &RationalFunction) -> Option<Self> {
        self.0.iter().map(|c| checked_product(c, factor)).collect::<Option<Vec<_>>>().map(ZPoly::new)
    }

    pub fn sum(&self, sign: Sign, other: &Self) -> Option<Self> {
        let n = self.0.len().max(other.0.len());
        // Long sums mostly add to one coefficient; the others stay as they are.
        let at = |k: usize| match (self.0.get(k), other.0.get(k)) {
            (Some(a), Some(b)) if !b.is_zero() => checked_sum(a, sign, b),
            (Some(a), _) => Some(a.clone()),
            (None, Some(b)) => Some(if sign == Sign::Plus { b.clone() } else { -b }),
            (None, None) => Some(RationalFunction::zero()),
        };
        (0..n).map(at).collect::<Option<Vec<_>>>().map(ZPoly::new)
    }

    pub fn product(&self, other: &Self) -> Option<Self> {
        self.product_within(other, &Budget::unlimited())
    }

    /// The product; `None` also when the budget runs out.
    pub fn product_within(&self, other: &Self, budget: &Budget) -> Option<Self> {
        if self.is_one() || other.is_zero() {
            return Some(other.clone());
        }
        if other.is_one() || self.is_zero() {
            return Some(self.clone());
        }
        let mut out = vec![RationalFunction::zero(); self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, b) in other.0.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                budget.check().ok()?;
                out[i + j] = checked_sum(&out[i + j], Sign::Plus, &checked_product(a, b)?)?;
            }
        }
        Some(ZPoly::new(out))
    }

    /// The power; `None` also when the budget runs out.
    pub fn power(&self, exponent: u64, budget: &Budget) -> Option<Self> {
        let mut result = ZPoly::one();
        let mut base = self.clone();
        let mut e = exponent;
        while e > 0 {
            if e & 1 == 1 {
                result = result.product_within(&base, budget)?;
            }
            e >>= 1;
            if e > 0 {
                base = base.product_within(&base, budget)?;
            }
        }
        Some(result)
    }

    /// Quotient and remainder over the field of rational functions, whose elements `reduced` brings into the one form that equal
    /// ones have; `None` for a zero divisor.
    pub fn divide(&self, divisor: &Self, reduced: &Reduced<'_>) -> Option<(Self, Self)> {
        let inverse = reduced(divisor.leading().recip()?)?;
        let shift = divisor.degree();
        let mut rest = self.0.clone();
        let mut quotient = vec![RationalFunction::zero(); (rest.len()).saturating_sub(shift)];
        for k in (0..quotient.len()).rev() {
            let factor = reduced(checked_product(&rest[k + shift], &inverse)?)?;
            for (j, c) in divisor.0.iter().enumerate() {
                rest[k + j] = checked_sum(&rest[k + j], Sign::Minus, &reduced(checked_product(&factor, c)?)?)?;
            }
            quotient[k] = factor;
        }
        Some((ZPoly::new(quotient), ZPoly::new(rest)))
    }

    /// Divided by the leading coefficient; `None` for zero.
    pub fn monic(&self, reduced: &Reduced<'_>) -> Option<Self> {
        self.scaled(&reduced(self.leading().recip()?)?)?.try_map(reduced)
    }

    /// The polynomial of the images of the coefficients.
    pub fn try_map(&self, image: &Reduced<'_>) -> Option<Self> {
        self.0.iter().cloned().map(image).collect::<Option<Vec<_>>>().map(ZPoly::new)
    }

    /// A monic polynomial times the least common denominator of its coefficients.
    pub fn primitive(&self) -> Option<Self> {
        let common = self.0.iter().fold(MultiPoly::one(), |common, c| {
            let shared = common.gcd(c.denominator());
            common.times(&c.denominator().div_exact(&shared).expect("a common divisor divides"))
        });
        if common.is_one() { Some(self.clone()) } else { self.scaled(&common.into()) }
    }

    /// The monic greatest common divisor of two polynomials that are not both zero.
    pub fn gcd(&self, other: &Self, reduced: &Reduced<'_>) -> Option<Self> {
        let (mut a, mut b) = (self.clone(), other.clone());
        while !b.is_zero() {
            // Monic remainders keep the coefficients as small as the field allows.
            let rest = a.divide(&b, reduced)?.1;
            a = b;
            b = if rest.is_zero() { rest } else { rest.monic(reduced)? };
        }
        a.monic(reduced)
    }
}
