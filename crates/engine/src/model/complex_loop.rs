//! Computes the characteristic polynomial of a loop whose coefficients may be complex, and refuses the questions that the program cannot answer for
//! such loops.

use super::closed_loop::{Answer, ClosedLoop, Evaluated, add_pole, merged, poles_in, substituted};
use super::complex::ComplexPolynomial;
use super::definition::Model;
use super::evaluate::symbolic::Values;
use super::evaluate::zpoly::ZPoly;
use super::symbols::Symbols;
use super::text::UNIT;
use crate::coverage::Refusal;
use crate::coverage::refusals::COMPLEX;
use crate::error::{Diagnostics, Error};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::RationalFunction;

impl Answer<'_> {
    /// The characteristic polynomial that the model gives.
    pub(super) fn given_polynomial(self) -> Result<Evaluated, Error> {
        let Values::Characteristic(parts) = &self.values else { unreachable!("no other form has one") };
        let undefined = || Error::Undefined("a coefficient divides by zero".into());
        let formal_degree = parts.iter().map(ZPoly::degree).max().unwrap_or(0);
        let list = |p: &ZPoly| (0..=formal_degree).map(|k| self.substituted(&p.coefficient(k))).collect::<Option<_>>();
        let whole = ComplexPolynomial {
            re: list(&parts[0]).ok_or_else(undefined)?,
            im: list(&parts[1]).ok_or_else(undefined)?,
        };
        let sample_time = self.sample_time.as_ref().and_then(|t| self.substituted(t));
        let (symbols, images) = merged(&self.symbols.borrow())?;
        let whole = whole.try_map(|f| substituted(f, &images)).ok_or_else(undefined)?;
        let (coefficients, complex) = whole.real_or_complex();
        let polynomial = CharacteristicPolynomial {
            variables: symbols.variables(),
            coefficients,
            formal_degree: if complex.is_some() { 2 * formal_degree } else { formal_degree },
            poles: poles_in(&self.poles, &symbols, &images)?,
            monic: false,
        };
        let sample_time = sample_time.and_then(|t| substituted(&t, &images));
        let closed_loop = None;
        Ok(Evaluated { polynomial, complex, closed_loop, sample_time, symbols }.without_unused_symbols())
    }
}

impl ClosedLoop {
    /// The characteristic polynomial of a complex loop with conjugate roots, and the polynomial itself where it is complex.
    pub(super) fn complex_polynomial(
        &self,
        symbols: &Symbols,
        budget: &Budget,
    ) -> Result<(CharacteristicPolynomial, Option<ComplexPolynomial>), Error> {
        let unit = self.variables.len();
        let j = RationalFunction::variable(unit);
        let entry = |i: usize, k: usize| &self.a[(2 * i, 2 * k)] + &(&j * &self.a[(2 * i + 1, 2 * k)]);
        let n = self.a.rows() / 2;
        let matrix = RationalMatrix::from_fn(n, n, entry);
        let variables = self.variables.iter().cloned().chain([UNIT.to_owned()]).collect();
        let own = matrix.characteristic_polynomial(variables, budget)?;
        let whole = ComplexPolynomial::of(&own.coefficients, unit);
        let whole = whole.ok_or_else(|| Error::Undefined("division by zero".into()))?;
        let on_circle = |f: &RationalFunction| budget.enter(|| symbols.on_circle(f)).ok().flatten();
        let whole = whole.try_map(on_circle).unwrap_or(whole);
        let mut poles = self.poles.clone();
        own.poles.iter().for_each(|pole| add_pole(&mut poles, pole));
        let (coefficients, complex) = budget.enter(|| whole.real_or_complex())?;
        let short = coefficients.iter().map(on_circle).collect::<Option<Vec<_>>>();
        let coefficients = short.unwrap_or(coefficients);
        budget.check()?;
        let formal_degree = coefficients.len() - 1;
        let variables = self.variables.clone();
        Ok((CharacteristicPolynomial { variables, coefficients, formal_degree, poles, monic: true }, complex))
    }
}

impl Model {
    /// Refuses a loop that is complex with these values.
    pub(crate) fn refuse_complex_loop(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<(), Error> {
        self.refuse_complex(&self.answer(kept, given, budget)?, &COMPLEX)
    }

    /// Refuses a complex loop.
    pub(super) fn refuse_complex(&self, answer: &Answer<'_>, how: &Refusal) -> Result<(), Error> {
        match answer.wiring.is_complex {
            true => Err(Diagnostics::new(Some(self.source().clone()), vec![how.diagnostic(&[])]).into()),
            false => Ok(()),
        }
    }
}
