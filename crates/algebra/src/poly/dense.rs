//! The dense univariate polynomial.

use super::Domain;
use super::rounded_sign::sign_by_rounding;
use crate::limits::checkpoint;
use crate::number::{Enclosure, Integer, Rational, Sign};
use std::fmt;

/// A univariate polynomial over `R`: coefficients from the constant term up, no zero at the top.
///
/// ```
/// use jurist_algebra::poly::UniPoly;
/// let p = UniPoly::from_i64(&[-1, 0, 1]); // x^2 - 1
/// assert_eq!(p.degree(), Some(2));
/// assert_eq!(p.eval(&3.into()), 8.into());
/// ```
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Poly<R> {
    coeffs: Vec<R>,
}

/// A univariate polynomial over the integers.
///
/// ```
/// use jurist_algebra::number::Rational;
/// use jurist_algebra::poly::UniPoly;
/// let p = UniPoly::from_i64(&[-1, 0, 4]); // 4 x^2 - 1
/// assert!(p.sign_at(&Rational::new(1.into(), 2.into())).is_eq());
/// assert_eq!(p.eval_rational(&3.into()), 35.into());
/// ```
pub type UniPoly = Poly<Integer>;

impl<R: Domain> Poly<R> {
    /// From coefficients, the constant term first; zeros at the top are dropped.
    pub fn new(mut coeffs: Vec<R>) -> Self {
        while coeffs.last().is_some_and(R::is_zero) {
            coeffs.pop();
        }
        Poly { coeffs }
    }

    /// A constant.
    pub fn constant(c: R) -> Self {
        Poly::new(vec![c])
    }

    /// `c x^k`.
    pub fn monomial(c: R, k: usize) -> Self {
        let mut coeffs = vec![R::zero(); k];
        coeffs.push(c);
        Poly::new(coeffs)
    }

    /// The indeterminate.
    pub fn x() -> Self {
        Poly::monomial(R::one(), 1)
    }

    /// The coefficients from the constant term up; empty for the zero polynomial.
    pub fn coeffs(&self) -> &[R] {
        &self.coeffs
    }

    /// The coefficients, taken out.
    pub fn into_coeffs(self) -> Vec<R> {
        self.coeffs
    }

    /// The coefficient of `x^k`, zero above the degree.
    pub fn coeff(&self, k: usize) -> R {
        self.coeffs.get(k).cloned().unwrap_or_else(R::zero)
    }

    /// The degree; `None` for the zero polynomial.
    pub fn degree(&self) -> Option<usize> {
        self.coeffs.len().checked_sub(1)
    }

    /// The leading coefficient; `None` for the zero polynomial.
    pub fn leading(&self) -> Option<&R> {
        self.coeffs.last()
    }

    /// Whether the degree is 0 or the polynomial is zero.
    pub fn is_constant(&self) -> bool {
        self.coeffs.len() <= 1
    }

    /// The value at `x`, by Horner's rule: `O(n)` operations.
    pub fn eval(&self, x: &R) -> R {
        checkpoint(4 * self.coeffs.len() as u64);
        let mut acc = R::zero();
        for c in self.coeffs.iter().rev() {
            acc = acc.times(x).plus(c);
        }
        acc
    }

    /// The derivative.
    pub fn derivative(&self) -> Self {
        let coeffs = self.coeffs.iter().enumerate().skip(1);
        Poly::new(coeffs.map(|(k, c)| c.times(&R::from_integer(&Integer::from(k)))).collect())
    }

    /// `x^n p(1/x)` for a formal degree `n` at least the degree: the coefficients reversed.
    ///
    /// # Panics
    /// When `n` is below the degree.
    pub fn reversed(&self, n: usize) -> Self {
        assert!(self.coeffs.len() <= n + 1, "the formal degree is below the degree");
        Poly::new((0..=n).map(|k| self.coeff(n - k)).collect())
    }

    /// `p(-x)`.
    pub fn negated_argument(&self) -> Self {
        let flip = |(k, c): (usize, &R)| if k % 2 == 1 { c.negated() } else { c.clone() };
        Poly { coeffs: self.coeffs.iter().enumerate().map(flip).collect() }
    }

    /// `p(x + a)`: `O(n^2)` operations.
    pub fn taylor_shift(&self, a: &R) -> Self {
        let mut c = self.coeffs.clone();
        let n = c.len();
        for i in 0..n {
            checkpoint(4 * (n - i) as u64 % 4096);
            for j in (i..n.saturating_sub(1)).rev() {
                if j % 1024 == 0 {
                    checkpoint(4096);
                }
                let (low, high) = c.split_at_mut(j + 1);
                if a.is_one() {
                    low[j] = low[j].plus(&high[0]);
                } else {
                    low[j].add_times(a, &high[0]);
                }
            }
        }
        Poly::new(c)
    }

    /// `p(a x)`.
    pub fn scaled_argument(&self, a: &R) -> Self {
        checkpoint(8 * self.coeffs.len() as u64);
        let mut power = R::one();
        let mut coeffs = Vec::with_capacity(self.coeffs.len());
        for c in &self.coeffs {
            coeffs.push(c.times(&power));
            power = power.times(a);
        }
        Poly::new(coeffs)
    }

    /// `c p`.
    pub fn scaled(&self, c: &R) -> Self {
        checkpoint(4 * self.coeffs.len() as u64);
        Poly::new(self.coeffs.iter().map(|a| a.times(c)).collect())
    }

    /// `x^k p`.
    pub fn shifted_up(&self, k: usize) -> Self {
        if self.is_zero() {
            return self.clone();
        }
        let mut coeffs = vec![R::zero(); k];
        coeffs.extend_from_slice(&self.coeffs);
        Poly { coeffs }
    }

    /// `p(q(x))`, by Horner's rule.
    pub fn compose(&self, q: &Poly<R>) -> Self {
        let mut acc = Poly::zero();
        for c in self.coeffs.iter().rev() {
            acc = acc.times(q).plus(&Poly::constant(c.clone()));
        }
        acc
    }

    /// The polynomial whose coefficients are the images under `f`.
    pub fn map<S: Domain>(&self, f: impl FnMut(&R) -> S) -> Poly<S> {
        Poly::new(self.coeffs.iter().map(f).collect())
    }
}

impl UniPoly {
    /// From machine integers, the constant term first.
    pub fn from_i64(coeffs: &[i64]) -> Self {
        Poly::new(coeffs.iter().map(|&c| Integer::from(c)).collect())
    }

    /// The value at a rational number.
    pub fn eval_rational(&self, x: &Rational) -> Rational {
        let Some(n) = self.degree() else { return Rational::ZERO };
        Rational::new(self.eval_homogeneous(&x.numerator(), &x.denominator()), x.denominator().pow(n as u64))
    }

    /// An enclosure of the values on an enclosure, by Horner's rule with `bits` significant bits.
    pub fn eval_enclosure(&self, x: &Enclosure, bits: u64) -> Enclosure {
        checkpoint(64 * self.coeffs.len() as u64);
        let mut acc = Enclosure::from_rational(Rational::ZERO);
        for c in self.coeffs.iter().rev() {
            acc = acc.mul(x, bits).add(&Enclosure::from_rational(Rational::from(c)), bits);
        }
        acc
    }

    /// The sign of the value at a rational number.
    pub fn sign_at(&self, x: &Rational) -> Sign {
        let (a, q) = (x.numerator(), x.denominator());
        sign_by_rounding(self, &a, &q).unwrap_or_else(|| self.eval_homogeneous(&a, &q).sign())
    }

    /// `q^n p(a/q)` with `n` the degree: an integer, of the sign of `p(a/q)` when `q > 0`.
    fn eval_homogeneous(&self, a: &Integer, q: &Integer) -> Integer {
        if q.is_one() {
            return self.eval(a);
        }
        checkpoint(8 * self.coeffs.len() as u64);
        let mut acc = Integer::ZERO;
        let mut power = Integer::ONE;
        for c in self.coeffs.iter().rev() {
            acc = &acc * a;
            acc.add_mul_assign(c, &power);
            power = &power * q;
        }
        acc
    }

    /// The primitive integer polynomial with the roots of a rational one: `(q, p)` with
    /// `self = p q`, `q` a positive rational.
    pub fn from_rational_poly(p: &Poly<Rational>) -> (Rational, UniPoly) {
        checkpoint(16 * p.coeffs().len() as u64);
        let mut denominator = Integer::ONE;
        for c in p.coeffs() {
            denominator = denominator.lcm(&c.denominator());
        }
        let scale = |c: &Rational| c.numerator() * denominator.div_exact(&c.denominator());
        let integral = p.map(scale);
        if integral.is_zero() {
            return (Rational::ONE, integral);
        }
        let content = integral.content();
        let primitive = integral.map(|c| c.div_exact(&content));
        (Rational::new(content, denominator), primitive)
    }

    /// The largest bit length of a coefficient.
    pub fn height_bits(&self) -> u64 {
        self.coeffs.iter().map(Integer::bit_length).max().unwrap_or(0)
    }
}

impl<R: Domain> fmt::Debug for Poly<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.coeffs).finish()
    }
}

/// `l/C(n, k)` for `k` from 0 to `n`, where `l` is the least common multiple of the binomial coefficients: the coefficients of powers are multiplied
/// by these numbers on the way to Bernstein's basis.
///
/// Cost: `O(n)` operations on numbers of `O(n)` bits.
///
/// ```
/// use jurist_algebra::poly::bernstein_weights;
/// assert_eq!(bernstein_weights(3), [3, 1, 1, 3].map(|k: i64| k.into()));
/// ```
pub fn bernstein_weights(n: usize) -> Vec<Integer> {
    let mut choices = vec![Integer::ONE];
    for k in 0..n {
        let next = &choices[k] * &Integer::from((n - k) as u64);
        choices.push(next.div_exact(&Integer::from(k as u64 + 1)));
    }
    let common = choices.iter().fold(Integer::ONE, |l, c| l.lcm(c));
    choices.iter().map(|c| common.div_exact(c)).collect()
}
