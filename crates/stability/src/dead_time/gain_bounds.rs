//! How far the imaginary axis has to be looked at for a gain.

use super::gain::GainLoop;
use super::gain_axis::{absolute, on_axis};
use super::quasi_polynomial::even_odd;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, UniPoly};

/// How far the modulus of a gain reaches in a neutral loop.
pub(super) struct Neutral {
    /// Whether the values on the axis come up to the largest one from below, infinitely many of them.
    pub approached: bool,
    /// A frequency from which on they do, or from which on they are not below it.
    pub limit: Rational,
    /// The modulus at which the difference operator stops being stable.
    pub largest: Rational,
}

impl GainLoop {
    /// For a parameter in the term `z^turns` only, whose power of `s` is the highest and not below that of the rest.
    pub(super) fn neutral_bound(&self, turns: usize) -> Option<Neutral> {
        let n = self.order();
        let (a, b) = (self.a[0].coeff(n), self.b[turns].coeff(n));
        if b.is_zero() {
            return None;
        }
        // |A|^2 b^2 - a^2 |N|^2 in omega^2, where A is taken without what is delayed (growing_beyond allows no more).
        let square = |p: &UniPoly| {
            let (even, odd) = even_odd(p);
            let (even, odd) = (on_axis(&even), on_axis(&odd).shifted_up(1));
            even.times(&even).plus(&odd.times(&odd))
        };
        let difference = square(&self.a[0]).scaled(&(&b * &b)).minus(&square(&self.b[turns]).scaled(&(&a * &a)));
        let largest = Rational::new(a.abs(), b.abs());
        let Some(top) = difference.leading() else {
            return Some(Neutral { approached: false, limit: Rational::ONE, largest });
        };
        // A bound of Cauchy: beyond it the highest power outweighs the others.
        let mut r = Integer::ONE;
        let degree = difference.degree().unwrap_or(0) as u64;
        while absolute(&difference).eval(&r) >= (top.abs() << 1) * r.pow(degree) {
            r = r << 1;
        }
        Some(Neutral { approached: top.is_negative(), limit: Rational::from(r), largest })
    }

    /// A frequency beyond which the highest power of `s` without delay outweighs all other terms for all values of the
    /// parameter up to a modulus; `None` where it does not.
    pub(super) fn frequency_bound(&self, largest: &Rational) -> Option<Rational> {
        let n = self.order();
        let (num, den) = (largest.numerator(), largest.denominator());
        // All terms over the modulus of the parameter; its part of the highest undelayed power counts against it.
        let mut total = UniPoly::zero();
        for (a, b) in self.a.iter().zip(&self.b) {
            total = total.plus(&absolute(a).scaled(&den)).plus(&absolute(b).scaled(&num));
        }
        let top = self.a[0].coeff(n).abs() * &den;
        let twice = &top + &top;
        if total.coeff(n) >= twice {
            return None;
        }
        let mut r = Integer::ONE;
        while total.eval(&r) >= &twice * &r.pow(n as u64) {
            r = r << 1;
        }
        Some(Rational::from(r))
    }

    /// A frequency beyond which `Re(ds/d log K)` is positive on the axis, for a parameter in the term `z^turns` only: it has
    /// the sign of `turns tau + Re(A'/A - N'/N)`. The errors are bounds of those of `A` and of `N`, where there are any.
    ///
    /// Where the highest power `a(z) s^n` of `A` is delayed, too, with all zeros of `a` outside of the closed unit disc,
    /// `Re(z a'(z)/a(z)) <= deg a/2` on the circle.
    pub(super) fn growing_beyond(&self, turns: usize, errors: Option<&[Vec<UniPoly>; 2]>) -> Option<Rational> {
        let (t, d) = (self.tau.numerator(), self.tau.denominator());
        let n = self.a.iter().filter_map(UniPoly::degree).max()?;
        let m = self.b[turns].degree()?;
        let error = |i: usize, k: usize| errors.map_or_else(UniPoly::zero, |errors| errors[i][k].clone());
        let bounds: Vec<UniPoly> = self.a.iter().enumerate().map(|(k, p)| absolute(p).plus(&error(0, k))).collect();
        // A without delay is to outweigh the rest of its highest power; where the loop is neutral in the parameter, A is to
        // be without delay altogether.
        let highest: Vec<Integer> = bounds.iter().map(|p| p.coeff(n)).collect();
        let own = self.a[0].coeff(n).abs() - error(0, 0).coeff(n);
        let least_top = highest.iter().skip(1).fold(own, |rest, c| rest - c);
        let is_delayed = bounds.iter().skip(1).any(|p| !p.is_zero());
        if !least_top.sign().is_gt() || m > n || (m == n && is_delayed) {
            return None;
        }
        let times = |k: usize| &t * &Integer::from(k as i64);
        let delays = highest.iter().rposition(|c| !c.is_zero()).unwrap_or(0);
        let least = Rational::from(&times(2 * turns)) - Rational::from(&times(delays));
        let least = least * Rational::dyadic(&Integer::ONE, 1);
        if !least.sign().is_gt() {
            return None;
        }
        // d A' = s^n (-t sum k a_k z^k) + rest, A = s^n a + lower.
        let lower = |p: &UniPoly| UniPoly::new(p.coeffs().iter().take(n).cloned().collect());
        let sum = |list: &mut dyn Iterator<Item = UniPoly>| list.fold(UniPoly::zero(), |sum, p| sum.plus(&p));
        let below = sum(&mut bounds.iter().map(lower));
        let rest = sum(&mut bounds
            .iter()
            .enumerate()
            .map(|(k, p)| p.derivative().scaled(&d).plus(&lower(p).scaled(&times(k)))));
        let slope = highest.iter().enumerate().fold(Integer::ZERO, |sum, (k, c)| sum + &times(k) * c);
        let slope = Rational::new(slope, least_top.clone());
        let other = absolute(&self.b[turns]).plus(&error(1, turns));
        let other_derivative = other.derivative().scaled(&d);
        // Twice the highest coefficient of what outweighs the others.
        let twice = self.b[turns].coeff(m).abs() << 1;
        let is_of_degree = other.degree() == Some(m) && bounds.iter().all(|p| p.degree().is_none_or(|own| own <= n));
        if !is_of_degree || twice <= other.coeff(m) {
            return None;
        }
        let mut r = Integer::ONE;
        loop {
            let bottom = &least_top * &r.pow(n as u64) - below.eval(&r);
            let other_bottom = &twice * &r.pow(m as u64) - other.eval(&r);
            if bottom.sign().is_gt() && other_bottom.sign().is_gt() {
                let own = Rational::from(&rest.eval(&r)) + Rational::from(&below.eval(&r)) * &slope;
                let moved = own / Rational::from(&bottom) + Rational::new(other_derivative.eval(&r), other_bottom);
                if moved < least {
                    return Some(Rational::from(r));
                }
            }
            r = r << 1;
        }
    }
}
