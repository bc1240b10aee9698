//! Loops with blocks behind a hold: everything is over the symbols of a certificate.

use super::clock::Clock;
use super::coefficient::{Coefficient, Ring};
use super::complex::square_of_root;
use super::interval::Interval;
use super::multivariate::Multi;
use super::number::Q;
use super::over::{Over, inside};
use super::over_symbols::{OverSymbols, in_disc, over_symbols, same};
use super::roots::Places;
use super::statement::{Extent, polynomials};
use super::symbols::Table;
use super::{Rejection, Step, model};
use crate::format::Json;
use num_bigint::BigInt;
use std::rc::Rc;

/// The characteristic polynomial as the certificate gives it, which is that of the model, the model's poles, and whether it is a complex loop, doubled.
pub(super) fn characteristic(
    text: &str,
    kept: Option<&str>,
    set: &[(String, Q)],
    extent: &Extent,
    given: &Json,
    table: &Rc<Table>,
    clock: &Clock,
) -> Result<(Vec<Over>, Vec<Over>, bool), Rejection> {
    let read = |json: &Json, what: &str| Over::read(json, what, table);
    let own = Step::Model.of((|| {
        let asked = model::asked(text, kept, set, table, None, clock)?;
        if !asked.discrete {
            return Err("the model's time is not that of the statement".to_owned());
        }
        let found = clock.reading(|| over_symbols(&asked.form, &asked.divisors, &asked.values, clock))?;
        Ok((found, asked.is_doubled))
    })())?;
    let (own, is_doubled) = own;
    let OverSymbols { coefficients, poles } = own;
    let given = Step::Characteristic.of(polynomials(given, "'characteristic'", read))?;
    let polynomials: Vec<Multi> = given.iter().map(|c| c.polynomial.clone()).collect();
    let is_root = Step::Characteristic.of((|| {
        let own = in_disc(&coefficients, extent);
        let square = square_of_root(&polynomials, &own, is_doubled, clock)?;
        same(square.as_deref().unwrap_or(&polynomials), &own, clock)?;
        Ok(square.is_some())
    })())?;
    Ok((given, poles.into_iter().map(|p| Over::new(p, table)).collect(), is_doubled && !is_root))
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
