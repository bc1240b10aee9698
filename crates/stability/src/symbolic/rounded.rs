//! Polynomials over symbols with rounded coefficients, for pictures.

use super::{SymbolicPolynomial, Table};
use jurist_algebra::ball::Ball;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, Poly, UniPoly};
use jurist_algebra::symbols::{Symbols, common_scale};
use std::sync::Arc;

/// Bits after the point.
const BITS: u64 = 320;

/// A polynomial over symbols that is asked for at many values of its parameter.
#[derive(Debug)]
pub struct Rounding {
    polynomial: SymbolicPolynomial,
    /// The coefficients and the poles by powers of the parameter, where no symbol depends on it.
    enclosed: Option<[Vec<Vec<Ball>>; 2]>,
}

impl Rounding {
    /// The polynomial at a value of the parameter, times a power of two and rounded to integers: for its roots in floating point,
    /// not for verdicts. `None` where the loop is undefined, or so near to that that it cannot be told.
    ///
    /// Cost: a product for each coefficient; an enclosure of each where symbols depend on the parameter.
    pub fn at(&self, value: &Rational) -> Option<UniPoly> {
        let [coefficients, poles] = match &self.enclosed {
            Some(enclosed) => {
                let x = Ball::from_rational(value, BITS);
                let horner = |c: &Vec<Ball>| c.iter().rev().fold(Ball::zero(BITS), |sum, c| sum.mul(&x).add(c));
                enclosed.each_ref().map(|list| list.iter().map(horner).collect::<Vec<Ball>>())
            }
            None => {
                let symbols = self.polynomial.table_at(value)?;
                let list = |list: &[MultiPoly]| {
                    common_scale(list, value).iter().map(|c| symbols.enclose(c, BITS)).collect::<Vec<Ball>>()
                };
                [self.polynomial.polynomial.coeffs(), &self.polynomial.poles].map(list)
            }
        };
        if poles.iter().any(Ball::contains_zero) {
            return None;
        }
        Some(UniPoly::new(coefficients.iter().map(Ball::middle_units).collect()))
    }

    /// The polynomial with its coefficients as polynomials in the parameter, times a power of two and rounded to integers: for
    /// pictures. `None` where symbols depend on the parameter.
    pub fn whole(&self) -> Option<Poly<UniPoly>> {
        let [coefficients, _] = self.enclosed.as_ref()?;
        let in_parameter = |c: &Vec<Ball>| UniPoly::new(c.iter().map(Ball::middle_units).collect());
        Some(Poly::new(coefficients.iter().map(in_parameter).collect()))
    }
}

impl SymbolicPolynomial {
    /// The polynomial, to be rounded at many values of its parameter.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Model, ParameterBuilder, Time};
    /// use jurist_engine::problem::Ask;
    /// // z - exp(-1) + K at K = 1
    /// let (model, _) = Model::builder(Time::Discrete)
    ///     .parameter(ParameterBuilder::new("K").nominal("1"))
    ///     .characteristic("z - exp(-1) + K")
    ///     .build()?;
    /// let problem = model.ask().free("K").problem()?;
    /// let p = problem.symbolic(&Budget::unlimited())?.unwrap().rounding().at(&1.into()).unwrap();
    /// let root = -p.coeff(0).to_f64_approximate() / p.coeff(1).to_f64_approximate();
    /// assert!((root - ((-1f64).exp() - 1.0)).abs() < 1e-15);
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// Cost: an enclosure of each coefficient, where no symbol depends on the parameter.
    pub fn rounding(self) -> Rounding {
        let enclosed = match &self.symbols {
            Table::Fixed(symbols) => {
                let number = |c: &MultiPoly| symbols.enclose(&c.map_variables(|i| i.saturating_sub(1)), BITS);
                let powers = |c: &MultiPoly| c.as_poly_in(0).coeffs().iter().map(number).collect();
                let list = |list: &[MultiPoly]| list.iter().map(powers).collect();
                Some([self.polynomial.coeffs(), &self.poles].map(list))
            }
            Table::Moving(_) => None,
        };
        Rounding { polynomial: self, enclosed }
    }

    fn table_at(&self, value: &Rational) -> Option<Arc<Symbols>> {
        match &self.symbols {
            Table::Fixed(symbols) => Some(Arc::clone(symbols)),
            Table::Moving(symbols) => Some(Arc::new(symbols.at(value)?)),
        }
    }
}
