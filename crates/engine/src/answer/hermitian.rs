//! The conditions of a loop with complex coefficients: that the leading principal minors of its Hermitian matrix are positive.

use super::table::{ENCLOSED_DIGITS, ParametricTable, PointTable, agreed, agreed_over_symbols};
use crate::error::Error;
use crate::model::ComplexPolynomial;
use crate::problem::Problem;
use crate::stability::{Range, Shape, hermitian_minors, hermitian_test, stable_set, symbolic_stable_set};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, Poly, RationalFunction, UniPoly};
use std::sync::Arc;

/// The minors of a polynomial whose coefficients have been multiplied by their common denominator.
struct Minors {
    list: Vec<MultiPoly>,
    below: MultiPoly,
}

impl Minors {
    /// The variables of the coefficients are renamed.
    fn of(
        whole: &ComplexPolynomial,
        renamed: impl Fn(usize) -> usize,
        region: Shape,
        budget: &Budget,
    ) -> Result<Minors, Exhausted> {
        budget.step("minors");
        let all = || whole.re.iter().chain(&whole.im);
        let below = budget.enter(|| {
            let least = |l: MultiPoly, f: &RationalFunction| {
                let d = f.denominator();
                l.times(&d.div_exact(&l.gcd(d)).expect("a gcd divides"))
            };
            all().fold(MultiPoly::one(), least)
        })?;
        let cleared = |f: &RationalFunction| {
            let factor = below.div_exact(f.denominator()).expect("a common multiple");
            f.numerator().times(&factor).map_variables(&renamed)
        };
        let [re, im] = [&whole.re, &whole.im].map(|list| Poly::new(list.iter().map(cleared).collect::<Vec<_>>()));
        let list = hermitian_minors(&re, &im, whole.re.len() - 1, region, budget)?;
        Ok(Minors { list, below: below.map_variables(&renamed) })
    }

    /// As polynomials in the one parameter.
    fn in_parameter(&self) -> (Vec<UniPoly>, UniPoly) {
        let plain = |p: &MultiPoly| p.to_univariate(0).expect("nothing but the parameter is left");
        (self.list.iter().map(plain).collect(), plain(&self.below))
    }
}

impl Problem {
    /// The conditions at a point; `None` where the loop is not complex.
    pub(super) fn complex_point(&self, budget: &Budget) -> Result<Option<PointTable>, Error> {
        let Some(whole) = self.complex_in_region(budget)? else { return Ok(None) };
        let mut table = PointTable { test: None, enclosed: None, verdict: None };
        if self.algebra_over_symbols(budget)?.symbols().is_empty() {
            let defined = self.parametric(budget)?.filter(|p| !p.is_undefined_at(&Rational::ZERO));
            if let Some(p) = defined {
                let (minors, below) = Minors::of(&whole, |i| i, self.shape(), budget)?.in_parameter();
                table.test = Some(hermitian_test(minors, &below, p, &Range::all(), budget)?);
            }
        } else if let Some(p) = self.symbolic(budget)? {
            // There the parameter is variable 0, also where there is none.
            let Minors { list, below } = Minors::of(&whole, |i| i + 1, self.shape(), budget)?;
            table.enclosed = p.hermitian_conditions(&list, &below, ENCLOSED_DIGITS, budget)?;
        }
        Ok(Some(table))
    }

    /// The conditions in one parameter; `None` where the loop is not complex.
    pub(super) fn complex_table(self: &Arc<Self>, budget: &Budget) -> Result<Option<ParametricTable>, Error> {
        let Some(whole) = self.complex_in_region(budget)? else { return Ok(None) };
        let domain = &self.parameter().domain;
        let symbols = self.algebra_over_symbols(budget)?.symbols();
        if symbols.is_empty() || symbols.is_moving() {
            let Some(p) = self.parametric(budget)? else { return Ok(Some(ParametricTable::undefined())) };
            let stable = self.with_sides(stable_set(p, domain, self.shape(), budget)?, budget)?;
            let (minors, below) = Minors::of(&whole, |i| i, self.shape(), budget)?.in_parameter();
            let test = hermitian_test(minors, &below, p, domain, budget)?;
            return agreed(test, stable).map(Some);
        }
        let Some(p) = self.symbolic(budget)? else { return Ok(Some(ParametricTable::undefined())) };
        let stable = self.with_sides(symbolic_stable_set(&p, domain, self.shape(), budget)?, budget)?;
        let Minors { list, below } = Minors::of(&whole, |i| i, self.shape(), budget)?;
        let test = p.hermitian_test(&list, &below, domain, ENCLOSED_DIGITS, budget)?;
        agreed_over_symbols(test, stable, budget).map(Some)
    }
}
