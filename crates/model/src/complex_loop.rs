//! Computes the characteristic polynomial of a loop whose coefficients may be complex.

use super::closed_loop::ClosedLoop;
use super::complex::{ComplexPolynomial, parts_of};
use super::definition::Model;
use super::evaluate::values::Values;
use super::evaluate::zpoly::ZPoly;
use super::evaluated::{Answer, Evaluated, add_pole, merged, poles_in, substituted};
use super::symbols::Symbols;
use super::text::UNIT;
use crate::error::Error;
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{MultiPoly, RationalFunction};

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
    /// The entries of a matrix of real and imaginary parts as complex numbers, with the imaginary unit as the variable beyond all others.
    fn complex_matrix(&self, parts: &RationalMatrix) -> RationalMatrix {
        let j = RationalFunction::variable(self.variables.len());
        let entry = |i: usize, k: usize| &parts[(2 * i, 2 * k)] + &(&j * &parts[(2 * i + 1, 2 * k)]);
        RationalMatrix::from_fn(parts.rows() / 2, parts.columns() / 2, entry)
    }

    /// The coefficients of the characteristic polynomial of a complex matrix.
    fn complex_coefficients(
        &self,
        matrix: &RationalMatrix,
        budget: &Budget,
    ) -> Result<(ComplexPolynomial, Vec<MultiPoly>), Error> {
        let variables = self.variables.iter().cloned().chain([UNIT.to_owned()]).collect();
        let own = matrix.characteristic_polynomial(variables, budget)?;
        let whole = budget.enter(|| ComplexPolynomial::of(&own.coefficients, self.variables.len()))?;
        Ok((whole.ok_or_else(|| Error::Undefined("division by zero".into()))?, own.poles))
    }

    /// The denominator and the numerator of a complex loop's transfer function from an input to an output, both complex signals, nothing cancelled: as
    /// [`ClosedLoop::transfer_function_at`].
    ///
    /// Cost: two characteristic polynomials.
    ///
    /// # Errors
    /// [`Error::Stopped`].
    pub fn complex_transfer(
        &self,
        output: usize,
        input: usize,
        budget: &Budget,
    ) -> Result<[ComplexPolynomial; 2], Error> {
        let unit = self.variables.len();
        let [a, e, c, d] = [&self.a, &self.e, &self.c, &self.d].map(|m| self.complex_matrix(m));
        let n = a.rows();
        let (below, _) = self.complex_coefficients(&a, budget)?;
        // Powers of the imaginary unit are put in, so that entries stay small.
        let undefined = || Error::Undefined("division by zero".into());
        let parts = |f: &RationalFunction| parts_of(f, Some(unit)).ok_or_else(undefined);
        let changed = RationalMatrix::from_fn(n, n, |r, k| &a[(r, k)] - &(&e[(r, input)] * &c[(output, k)]));
        let changed = changed.try_map(|f| Ok::<_, Error>(parts(f)?.joined(unit)))?;
        let (other, _) = self.complex_coefficients(&changed, budget)?;
        let direct = parts(&d[(output, input)])?;
        Ok([below.clone(), other.minus(&below).plus_multiple(&direct, &below)])
    }

    /// The characteristic polynomial, of a complex loop with conjugate roots; and then the polynomial itself where it is complex.
    ///
    /// Cost: that of [`ClosedLoop::characteristic_polynomial`].
    ///
    /// # Errors
    /// [`Error::Stopped`]; [`Error::Undefined`] where a coefficient divides by zero.
    pub fn real_polynomial(
        &self,
        symbols: &Symbols,
        budget: &Budget,
    ) -> Result<(CharacteristicPolynomial, Option<ComplexPolynomial>), Error> {
        match self.is_complex {
            false => Ok((self.characteristic_polynomial(budget)?, None)),
            true => self.complex_polynomial(symbols, budget),
        }
    }

    /// The same of a complex loop.
    fn complex_polynomial(
        &self,
        symbols: &Symbols,
        budget: &Budget,
    ) -> Result<(CharacteristicPolynomial, Option<ComplexPolynomial>), Error> {
        let (whole, found) = self.complex_coefficients(&self.complex_matrix(&self.a), budget)?;
        let on_circle = |f: &RationalFunction| budget.enter(|| symbols.on_circle(f)).ok().flatten();
        let whole = whole.try_map(on_circle).unwrap_or(whole);
        let mut poles = self.poles.clone();
        found.iter().for_each(|pole| add_pole(&mut poles, pole));
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
    /// True if the loop is complex with these values.
    ///
    /// Cost: that of evaluating the expressions.
    ///
    /// # Errors
    /// As [`Model::evaluate`].
    pub fn is_complex_loop(
        &self,
        kept: &[String],
        given: &[(String, Rational)],
        budget: &Budget,
    ) -> Result<bool, Error> {
        Ok(self.answer(kept, given, budget)?.wiring.is_complex)
    }
}
