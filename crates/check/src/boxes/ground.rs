//! What polynomials in the parameters of a box have for coefficients: integers, or polynomials in the symbols of a table.
//!
//! Zero is only ever an identity; any other sign over symbols is read off an enclosure.

use super::{at, values_at};
use crate::bernstein::Known;
use crate::clock::Clock;
use crate::held;
use crate::interval::Interval;
use crate::multivariate::Multi;
use crate::number::{Q, Z};
use crate::over::{Over, inside};
use crate::over_box::{FIRST, beside_factors};
use crate::roots::{Places, is_hurwitz, is_schur, places_by_axis, places_by_circle};
use crate::symbols::Table;
use num_traits::Zero;
use std::rc::Rc;

/// The variables behind the parameters of a box are symbols, if there is a table.
pub(crate) struct Ground {
    parameters: usize,
    table: Option<Rc<Table>>,
}

impl Ground {
    pub fn new(parameters: usize, table: Option<Rc<Table>>) -> Self {
        Ground { parameters, table }
    }

    /// Of polynomials in so many parameters, without symbols.
    pub fn integers(parameters: usize) -> Self {
        Ground { parameters, table: None }
    }

    /// How many variables a polynomial may have.
    pub fn variables(&self) -> usize {
        self.parameters + self.table.as_ref().map_or(0, |table| table.len())
    }

    /// Whether a parameter occurs in a polynomial.
    pub fn is_in_parameters(&self, p: &Multi) -> bool {
        (FIRST..FIRST + self.parameters).any(|v| p.degree(v) > 0)
    }

    /// The coefficients of the monomials in the parameters, as far as they are known.
    pub fn known(&self, p: &Multi, clock: &Clock) -> Result<Known, String> {
        Ok(match &self.table {
            None => Known(p.0.iter().map(|(e, c)| (e.clone(), c.clone(), Z::zero())).collect()),
            Some(table) => {
                let enclosed = table.enclosed_beside(p, FIRST + self.parameters, clock)?;
                Known(enclosed.into_iter().map(|(e, x)| (e, &x.lo + &x.hi, x.hi - x.lo)).collect())
            }
        })
    }

    /// Whether a polynomial has zeros only where one of the factors has: without what it has in common with them it is other than zero,
    /// and no parameter is left in it.
    pub fn vanishes_only_with(&self, p: &Multi, factors: &[Multi], clock: &Clock) -> Result<bool, String> {
        let left = beside_factors(p, factors, self.parameters, clock)?;
        if left.is_zero() || self.is_in_parameters(&left) {
            return Ok(false);
        }
        Ok(self.known(&left, clock)?.0.iter().all(|(_, middle, radius)| middle.magnitude() > radius.magnitude()))
    }

    /// Whether all roots are inside at a point, and the degree is that of all coefficients.
    pub fn is_stable(&self, d: &[Multi], point: &[Q], discrete: bool, clock: &Clock) -> Result<bool, String> {
        if let Some(table) = &self.table {
            let enclosed =
                values_at(d, point, clock)?.iter().map(|c| number(table, c, clock)).collect::<Result<Vec<_>, _>>()?;
            return Ok(inside(enclosed, true, table.bits, clock)? == d.len() - 1);
        }
        let at = at(d, point, clock)?;
        let is_stable = if discrete { is_schur(&at, clock)? } else { is_hurwitz(&at, clock)? };
        Ok(at.0.len() == d.len() && is_stable)
    }

    /// Whether polynomials all vanish at a point. That one does not is to be certain.
    pub fn vanish_at(&self, list: &[Multi], point: &[Q], clock: &Clock) -> Result<bool, String> {
        let at = values_at(list, point, clock)?;
        if at.iter().all(Multi::is_zero) {
            return Ok(true);
        }
        let Some(table) = &self.table else { return Ok(false) };
        for c in &at {
            if !number(table, c, clock)?.contains_zero() {
                return Ok(false);
            }
        }
        Err(format!("a divisor is not shown to be other than zero with {} bits", table.bits))
    }

    /// Where the roots are at a point, and how many are at infinity.
    pub fn places(&self, d: &[Multi], point: &[Q], discrete: bool, clock: &Clock) -> Result<(Places, usize), String> {
        let n = d.len() - 1;
        if let Some(table) = &self.table {
            let mut at = values_at(d, point, clock)?;
            while at.last().is_some_and(Multi::is_zero) {
                at.pop();
            }
            let Some(degree) = at.len().checked_sub(1) else { return Ok((Places::default(), n)) };
            let d: Vec<Over> = at.into_iter().map(|c| Over::new(c, table)).collect();
            return Ok((held::places(&d, &[], table, clock)?, n - degree));
        }
        let polynomial = at(d, point, clock)?;
        if polynomial.is_zero() {
            return Ok((Places::default(), n));
        }
        let places = if discrete { places_by_circle } else { places_by_axis };
        Ok((places(&polynomial, clock)?, n - polynomial.degree()))
    }
}

/// The value of a polynomial in symbols alone.
fn number(table: &Table, c: &Multi, clock: &Clock) -> Result<Interval, String> {
    Ok(table.enclosed(c, clock)?.into_iter().next().unwrap_or_else(Interval::zero))
}
