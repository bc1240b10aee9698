//! The characteristic polynomial of a statement, over numbers or over the symbols of a certificate.

use super::characteristic::Characteristic as OverNumbers;
use super::clock::Clock;
use super::coefficient::{Coefficient, Ring};
use super::complex::{Meant, meant, square_of_root};
use super::interval::Interval;
use super::multivariate::Multi;
use super::number::Q;
use super::over::{Over, inside};
use super::over_symbols::{OverSymbols, in_disc, over_symbols, same};
use super::region::transformed;
use super::roots::Places;
use super::statement::{Extent, polynomial, polynomials};
use super::symbols::Table;
use super::{Rejection, Step, is_same_time, model};
use crate::format::Json;
use num_bigint::BigInt;
use std::rc::Rc;

/// A loop of a statement: that of a model, with values for all parameters but a kept one.
pub(super) struct Question<'q> {
    pub model: &'q str,
    pub kept: Option<&'q str>,
    pub set: &'q [(String, Q)],
    pub extent: &'q Extent,
    pub discrete: bool,
}

/// The characteristic polynomial as the certificate gives it.
pub(super) struct Characteristic {
    pub coefficients: Vec<Over>,
    pub poles: Vec<Over>,
    /// Whether it is that of a complex loop, doubled.
    pub is_doubled: bool,
}

impl Question<'_> {
    /// The model's characteristic polynomial without symbols, in the region, and what the given one is of it: its root takes its place.
    pub fn rational(&self, given: &Json, clock: &Clock) -> Result<(OverNumbers, Meant), Rejection> {
        let mut d = Step::Model.of(model::read(self.model, self.kept, self.set, clock))?;
        Step::Model.of(is_same_time(d.discrete, self.discrete))?;
        d.coefficients = Step::Model.of(transformed(&d.coefficients, d.discrete, self.extent, clock))?;
        let given = Step::Characteristic.of(polynomials(given, "'characteristic'", polynomial))?;
        let meant = Step::Characteristic.of(meant(&given, &d.coefficients, d.is_doubled, clock))?;
        if let Meant::Root = meant {
            (d.coefficients, d.degree) = (given, d.degree / 2);
        }
        Ok((d, meant))
    }

    /// The characteristic polynomial over symbols: the given one, which is that of the model.
    pub fn over_symbols(&self, given: &Json, table: &Rc<Table>, clock: &Clock) -> Result<Characteristic, Rejection> {
        let asked = Step::Model.of(model::asked(self.model, self.kept, self.set, table, None, clock))?;
        Step::Model.of(is_same_time(asked.discrete, true))?;
        let own = clock.reading(|| over_symbols(&asked.form, &asked.divisors, &asked.values, clock));
        let OverSymbols { coefficients, poles } = Step::Model.of(own)?;
        let read = |json: &Json, what: &str| Over::read(json, what, table);
        let given = Step::Characteristic.of(polynomials(given, "'characteristic'", read))?;
        let polynomials: Vec<Multi> = given.iter().map(|c| c.polynomial.clone()).collect();
        let is_root = Step::Characteristic.of((|| {
            let own = in_disc(&coefficients, self.extent);
            let square = square_of_root(&polynomials, &own, asked.is_doubled, clock)?;
            same(square.as_deref().unwrap_or(&polynomials), &own, clock)?;
            Ok(square.is_some())
        })())?;
        let poles = poles.into_iter().map(|p| Over::new(p, table)).collect();
        Ok(Characteristic { coefficients: given, poles, is_doubled: asked.is_doubled && !is_root })
    }
}

/// Where the roots are, none of them at infinity, and the loop defined.
pub(super) fn places(d: &[Over], poles: &[Over], table: &Table, clock: &Clock) -> Result<Places, String> {
    for p in poles.iter().chain(d.last()) {
        if !p.is_unit(clock)? {
            return Err("a divisor is not shown to be other than zero".into());
        }
    }
    let mut d = d.to_vec();
    let mut places = Places::default();
    // Roots at 1 and -1 that are there by an identity are divided out.
    for root in [1, -1] {
        let sign = BigInt::from(root);
        loop {
            // Horner's scheme: the quotient's coefficients, then the value.
            let mut quotient: Vec<Over> = Vec::with_capacity(d.len());
            for c in d.iter().rev() {
                let next = quotient.last().map_or_else(|| c.clone(), |q: &Over| q.scaled(&sign).plus(c));
                quotient.push(next);
            }
            if d.len() < 2 || !quotient.pop().is_some_and(|value| value.is_zero()) {
                break;
            }
            quotient.reverse();
            d = quotient;
            places.on += 1;
        }
    }
    let enclosed =
        |c: &Over| Ok(table.enclosed(&c.polynomial, clock)?.into_iter().next().unwrap_or_else(Interval::zero));
    let n = d.len() - 1;
    places.inside = inside(d.iter().map(enclosed).collect::<Result<_, String>>()?, false, table.bits, clock)?;
    places.outside = n - places.inside;
    Ok(places)
}
