//! An open loop whose coefficients are known by enclosures.

use super::part::Part;
use super::{BITS, are_nonzero};
use crate::model::Opened;
use jurist_algebra::matrix::RationalMatrix;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, Poly, RationalFunction};
use jurist_algebra::symbols::Symbols;
use std::sync::Arc;

/// An open loop `N/D0`. Symbol `i` of the table is variable `i` of the coefficients.
pub(crate) struct EnclosedQuotient {
    pub symbols: Arc<Symbols>,
    pub denominator: Poly<MultiPoly>,
    pub numerator: Poly<MultiPoly>,
}

impl EnclosedQuotient {
    /// `None` where the cut has a direct feedthrough, the closed loop decouples, or a divisor may be zero.
    ///
    /// Cost: enclosures of the matrix and of two characteristic polynomials.
    pub fn of(opened: &Opened) -> Option<EnclosedQuotient> {
        let system = &opened.system;
        let column = system.inputs.len().max(system.e.columns()).checked_sub(1)?;
        if !system.d[(0, column)].is_zero() {
            return None;
        }
        let n = system.a.rows();
        let symbols = Arc::new(opened.symbols.without_kept()?);
        let values = symbols.enclosed(BITS)?;
        let entries = [&system.a, &system.e, &system.c].into_iter().flat_map(|m| m.entries());
        are_nonzero(system.poles.iter().chain(entries.map(RationalFunction::denominator)), 0, &values)?;
        // What comes back has the sign of the feedback.
        let returned = RationalMatrix::from_fn(n, n, |i, j| &system.e[(i, column)] * &system.c[(0, j)]);
        let is_whole = (&system.a + &returned).decoupled_parts().len() == 1;
        let part = Part::linear(&symbols, system.a.clone(), returned).filter(|part| is_whole && part.degree == 1)?;
        let p = Arc::new(part).polynomial(&Rational::ONE);
        let symbols = Arc::clone(p.fixed_symbols()?);
        let in_factor = |c: &MultiPoly| c.as_poly_in(0).map(|c| c.map_variables(|i| i.saturating_sub(1)));
        let coefficients: Vec<Poly<MultiPoly>> = p.polynomial().coeffs().iter().map(in_factor).collect();
        let [denominator, numerator] = [0, 1].map(|k| Poly::new(coefficients.iter().map(|c| c.coeff(k)).collect()));
        Some(EnclosedQuotient { symbols, denominator, numerator })
    }
}
