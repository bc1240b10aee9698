//! Polynomials over symbols with rounded coefficients, for pictures.

use super::{SymbolicPolynomial, Table};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, Poly, UniPoly};
use jurist_algebra::symbols::common_scale;
use std::sync::Arc;

/// Bits after the point.
const BITS: u64 = 320;

impl SymbolicPolynomial {
    /// The polynomial at a value of the parameter, times a power of two and rounded to integers: for its roots in floating point,
    /// not for verdicts. `None` where the loop is undefined, or so near to that that it cannot be told.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::{Model, ParameterBuilder, Time};
    /// // z - exp(-1) + K at K = 1
    /// let (model, _) = Model::builder(Time::Discrete)
    ///     .parameter(ParameterBuilder::new("K").nominal("1"))
    ///     .characteristic("z - exp(-1) + K")
    ///     .build()?;
    /// let problem = model.ask().free("K").problem()?;
    /// let p = problem.symbolic(&Budget::unlimited())?.unwrap().rounded_at(&1.into()).unwrap();
    /// let root = -p.coeff(0).to_f64_approximate() / p.coeff(1).to_f64_approximate();
    /// assert!((root - ((-1f64).exp() - 1.0)).abs() < 1e-15);
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// Cost: an enclosure of each coefficient.
    pub fn rounded_at(&self, value: &Rational) -> Option<UniPoly> {
        let symbols = match &self.symbols {
            Table::Fixed(symbols) => Arc::clone(symbols),
            Table::Moving(symbols) => Arc::new(symbols.at(value)?),
        };
        let number = |p: &MultiPoly| p.substitute(0, value).0.map_variables(|i| i.saturating_sub(1));
        if self.poles.iter().any(|pole| symbols.enclose(&number(pole), BITS).contains_zero()) {
            return None;
        }
        let coefficients = common_scale(self.polynomial.coeffs(), value);
        Some(UniPoly::new(coefficients.iter().map(|c| symbols.enclose(c, BITS).middle_units()).collect()))
    }

    /// The polynomial with its coefficients as polynomials in the parameter, times a power of two and rounded to integers: for
    /// pictures. `None` where symbols depend on the parameter.
    ///
    /// Cost: an enclosure of each coefficient.
    pub fn rounded(&self) -> Option<Poly<UniPoly>> {
        let Table::Fixed(symbols) = &self.symbols else { return None };
        let number = |c: &MultiPoly| symbols.enclose(&c.map_variables(|i| i.saturating_sub(1)), BITS).middle_units();
        let in_parameter = |c: &MultiPoly| UniPoly::new(c.as_poly_in(0).coeffs().iter().map(number).collect());
        Some(Poly::new(self.polynomial.coeffs().iter().map(in_parameter).collect()))
    }
}
