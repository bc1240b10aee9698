//! A circle that the open loop keeps to one side of.

use crate::model::Between;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, Poly};

/// At all frequencies `|1 + L| >= least |u + v L|`: in the plane of `L` the outside of a disk, its inside, or a half plane.
///
/// With `least = p/q` the condition is `a |L|^2 + 2 b Re L + c >= 0`, where `a = q^2 - p^2 v^2`, `b = q^2 - p^2 u v`, `c = q^2 - p^2 u^2`.
#[derive(Clone, Debug)]
pub struct Circle {
    /// `u` and `v`.
    combined: [i64; 2],
    least: Rational,
    /// The number that the user wrote; `least` is computed from it.
    asked: Rational,
    /// The signals between which it is, where it is not about the loop at a cut.
    between: Option<Between>,
}

impl Circle {
    /// Of the whole loop; `asked` is the number that the user wrote.
    pub fn new(combined: [i64; 2], least: Rational, asked: Rational) -> Circle {
        Circle { combined, least, asked, between: None }
    }

    /// The same of the transfer function between two signals in the place of `L/(1 + L)`.
    pub fn between(self, between: Between) -> Circle {
        Circle { between: Some(between), ..self }
    }

    /// The number that the user wrote.
    pub fn asked(&self) -> &Rational {
        &self.asked
    }

    /// `u` and `v`.
    pub fn combined(&self) -> [i64; 2] {
        self.combined
    }

    /// The least `|1 + L|/|u + v L|`.
    pub fn least(&self) -> &Rational {
        &self.least
    }

    /// The signals between which it is.
    pub fn signals(&self) -> Option<&Between> {
        self.between.as_ref()
    }

    /// `u D0 + v N`.
    pub fn combination<R: Domain>(&self, d: &Poly<R>, n: &Poly<R>) -> Poly<R> {
        let times = |p: &Poly<R>, by: i64| p.scaled(&R::from_integer(&Integer::from(by)));
        times(d, self.combined[0]).plus(&times(n, self.combined[1]))
    }

    /// `a`, `b` and `c`.
    pub fn coefficients(&self) -> [Integer; 3] {
        let (p, q) = (self.least.numerator(), self.least.denominator());
        let [u, v] = self.combined.map(Integer::from);
        let less = |product: Integer| &(&q * &q) - &(&(&p * &p) * &product);
        [less(&v * &v), less(&u * &v), less(&u * &u)]
    }

    /// `q^2 |D0 + N|^2 - p^2 |u D0 + v N|^2` of the two squares: not negative where the condition holds.
    pub fn excess<R: Domain>(&self, sum_squared: &Poly<R>, combined_squared: &Poly<R>) -> Poly<R> {
        let (p, q) = (self.least.numerator(), self.least.denominator());
        let whole = sum_squared.scaled(&R::from_integer(&(&q * &q)));
        whole.minus(&combined_squared.scaled(&R::from_integer(&(&p * &p))))
    }
}
