//! Taylor polynomials of functions of a moving parameter on one side of a point.

use super::function::polynomial_at;
use super::moving::MovingSymbols;
use crate::ball::{Ball, Series};
use crate::number::Rational;
use crate::poly::MultiPoly;

impl MovingSymbols {
    /// Polynomials in the parameter and symbols as functions of the share `u` of an interval, `p = lo + (hi - lo) u`: for each
    /// the coefficients of `1` to `u^(terms - 1)`, and then a ball that holds the factor of `u^terms` in what is left out,
    /// wherever `u` is in `[0, 1]`. `None` where a divisor may vanish in the interval, or a root's argument be negative.
    ///
    /// ```
    /// use jurist_algebra::poly::{MultiPoly, RationalFunction};
    /// use jurist_algebra::symbols::{Definition, MovingSymbols};
    /// // exp(p) on [0, 1/2]: 1, 1/2, 1/8, and a rest of at most exp(1/2)/48
    /// let symbols = MovingSymbols::new(vec![("X".into(), Definition::Exponential(RationalFunction::variable(0)))]);
    /// let found = symbols.taylor_from_end(&[MultiPoly::variable(1)], &0.into(), &"1/2".parse().unwrap(), 3, 64).unwrap();
    /// assert!(found[0][2].contains(&"1/8".parse().unwrap()));
    /// assert!(found[0][3].upper() < "35/1000".parse().unwrap() && found[0][3].contains(&"1/48".parse().unwrap()));
    /// ```
    ///
    /// Cost: that of [`MovingSymbols::series`] at the end and over the interval, and a product for each factor of each term.
    pub fn taylor_from_end(
        &self,
        list: &[MultiPoly],
        lo: &Rational,
        hi: &Rational,
        terms: usize,
        bits: u64,
    ) -> Option<Vec<Vec<Ball>>> {
        let length = Ball::from_rational(&(hi - lo), bits);
        let series = |at: &Ball, terms| self.series(&Series::linear(at, &length, terms));
        let near = series(&Ball::from_rational(lo, bits), terms)?;
        let whole = series(&Ball::between(lo, hi, bits), terms + 1)?;
        let one = |p: &MultiPoly| {
            let mut out = polynomial_at(p, &near).coefficients().to_vec();
            out.extend(polynomial_at(p, &whole).coefficients().last().cloned());
            out
        };
        Some(list.iter().map(one).collect())
    }
}
