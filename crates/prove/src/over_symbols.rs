//! Polynomials over symbols as the checkers see them: enclosed with a number of bits, and signs only where they are certain.

use jurist_algebra::ball::Ball;
use jurist_algebra::number::{Integer, Rational, Sign};
use jurist_algebra::poly::multivariate::{are_coprime_in, is_square_free_in};
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_algebra::symbols::{Symbols, common_factor};

/// Pairwise coprime polynomials in the parameter (variable 0) and symbols, square-free in the parameter, of which all given ones are
/// products up to factors without the parameter. What does not depend on symbols is apart.
pub(super) fn coprime_basis(polynomials: &[MultiPoly]) -> Vec<MultiPoly> {
    let mut basis: Vec<MultiPoly> = Vec::new();
    let mut todo: Vec<MultiPoly> = polynomials.to_vec();
    while let Some(p) = todo.pop() {
        let Some(mut part) = primitive_in_parameter(&p) else { continue };
        if !is_square_free_in(&part, 0) {
            let repeated = part.gcd(&part.derivative(0));
            if repeated.degree_in(0) > 0 {
                part = part.div_exact(&repeated).expect("a gcd divides");
                todo.extend([repeated, part]);
                continue;
            }
        }
        let algebraic = MultiPoly::from_univariate(&common_factor(&part), 0);
        if algebraic.degree_in(0) > 0 && algebraic.degree_in(0) < part.degree_in(0) {
            todo.push(part.div_exact(&algebraic).expect("a factor divides"));
            todo.push(algebraic);
            continue;
        }
        let shares = |b: &MultiPoly| !are_coprime_in(b, &part, 0) && b.gcd(&part).degree_in(0) > 0;
        let common = basis.iter().position(shares);
        match common {
            None => basis.push(part),
            Some(k) => {
                let b = basis.swap_remove(k);
                let g = b.gcd(&part);
                let rest = |p: &MultiPoly| p.div_exact(&g).expect("a gcd divides");
                if b.degree_in(0) == g.degree_in(0) {
                    basis.push(b.clone());
                    todo.push(rest(&part));
                } else {
                    todo.extend([rest(&b), rest(&part), g]);
                }
            }
        }
    }
    basis
}

/// Without factors in which the parameter does not occur; `None` if nothing is left.
fn primitive_in_parameter(p: &MultiPoly) -> Option<MultiPoly> {
    if p.degree_in(0) == 0 {
        return None;
    }
    let in_parameter = p.as_poly_in(0);
    let mut content = MultiPoly::zero();
    for c in in_parameter.coeffs().iter().rev() {
        content = content.gcd(c);
        if content.is_constant() && !content.is_zero() {
            break;
        }
    }
    let p = if content.is_constant() { p.clone() } else { p.div_exact(&content).expect("a content divides") };
    Some(p.primitive_over_integers())
}

/// A table with the bits that enclosures have.
#[derive(Clone, Copy)]
pub(super) struct Enclosed<'s> {
    pub symbols: &'s Symbols,
    pub bits: u64,
}

impl Enclosed<'_> {
    fn number(&self, p: &MultiPoly) -> Ball {
        self.symbols.enclose(&p.map_variables(|i| i.saturating_sub(1)), self.bits)
    }

    /// The coefficients of the powers of the parameter.
    pub fn coefficients(&self, p: &MultiPoly) -> Vec<Ball> {
        p.as_poly_in(0).coeffs().iter().map(|c| self.number(c)).collect()
    }

    /// The sign at a rational number, `Equal` only for an identity; `None` where it is not certain.
    pub fn sign_at(&self, p: &MultiPoly, value: &Rational) -> Option<Sign> {
        let (left, _) = p.substitute(0, value);
        if left.is_zero() { Some(Sign::Equal) } else { self.number(&left).sign().filter(|s| !s.is_eq()) }
    }

    /// Descartes' bound for an open interval; `None` where a sign is not certain.
    pub fn variations(&self, p: &MultiPoly, l: Option<&Rational>, r: Option<&Rational>) -> Option<usize> {
        if p.degree_in(0) == 0 {
            return Some(0);
        }
        let c = self.coefficients(p);
        let signs = match (l, r) {
            (None, None) => return None,
            (Some(l), None) => along(c, l, &Rational::ONE),
            (None, Some(r)) => along(c, r, &-Rational::ONE),
            (Some(l), Some(r)) => {
                let mut c = along(c, l, &(r - l));
                c.reverse();
                shift(&mut c, &Integer::ONE);
                c
            }
        };
        let (mut last, mut count) = (None, 0);
        for c in &signs {
            let sign = c.sign()?;
            if !sign.is_eq() {
                count += usize::from(last.is_some_and(|l| l != sign));
                last = Some(sign);
            }
        }
        Some(count)
    }

    /// How many roots are inside the unit circle, none on it, as the checkers count them: the Schur-Cohn reduction. With `stop`, any
    /// smaller number where one is outside. `None` where a step is not certain.
    pub fn inside(&self, coefficients: &[MultiPoly], value: Option<&Rational>, stop: bool) -> Option<usize> {
        let at = |p: &MultiPoly| match value {
            None => p.clone(),
            Some(value) => {
                // All over the same denominator.
                homogeneous(p, value, coefficients.iter().map(|c| c.degree_in(0)).max().unwrap_or(0))
            }
        };
        let mut d: Vec<Ball> = coefficients.iter().map(|c| self.number(&at(c))).collect();
        let mut found = 0;
        if d.last()?.contains_zero() {
            return None;
        }
        while d.len() > 1 {
            let n = d.len() - 1;
            let longest = d.iter().map(|x| x.magnitude_units().bit_length()).max().unwrap_or(0);
            d = d.iter().map(|x| x.shifted(self.bits as i64 - longest as i64)).collect();
            let (first, last) = (d[0].clone(), d[n].clone());
            let sign = last.mul(&last).sub(&first.mul(&first)).sign()?;
            d = if sign.is_gt() {
                found += 1;
                (1..=n).map(|k| last.mul(&d[k]).sub(&first.mul(&d[n - k]))).collect()
            } else if sign.is_eq() {
                return None;
            } else if stop {
                return Some(found);
            } else {
                (0..n).map(|k| first.mul(&d[k]).sub(&last.mul(&d[n - k]))).collect()
            };
        }
        (!d[0].contains_zero()).then_some(found)
    }
}

/// The value at a rational number times its denominator to the power of `degree`.
fn homogeneous(p: &MultiPoly, value: &Rational, degree: u32) -> MultiPoly {
    let (n, d) = (value.numerator(), value.denominator());
    let mut sum = MultiPoly::zero();
    for (k, part) in p.as_poly_in(0).coeffs().iter().enumerate() {
        sum = sum.plus(&part.scaled_by(&(n.pow(k as u64) * d.pow(u64::from(degree) - k as u64))));
    }
    sum
}

/// Coefficients of a positive multiple of `f(a + w t)` in `t`.
fn along(mut c: Vec<Ball>, a: &Rational, w: &Rational) -> Vec<Ball> {
    let d = a.denominator() * w.denominator();
    let mut scale = Integer::ONE;
    for x in c.iter_mut().rev() {
        *x = x.scaled(&scale);
        scale = &scale * &d;
    }
    shift(&mut c, &(a.numerator() * w.denominator()));
    let (step, mut scale) = (w.numerator() * a.denominator(), Integer::ONE);
    for x in &mut c {
        *x = x.scaled(&scale);
        scale = &scale * &step;
    }
    c
}

/// `f(t + a)`.
fn shift(c: &mut [Ball], a: &Integer) {
    let n = c.len();
    for i in 0..n {
        for j in (i..n - 1).rev() {
            c[j] = c[j].add(&c[j + 1].scaled(a));
        }
    }
}
