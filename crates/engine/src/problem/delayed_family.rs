//! Loops with dead time and any number of parameters.

use super::delayed::{cleared, refused};
use super::resolved::Problem;
use crate::error::Error;
use crate::stability::boxes::DelayedFunction;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};

impl Problem {
    /// The loop with dead time in all free parameters, around a usual point; `None` for any other loop, and where it is undefined or vanishes
    /// for all values.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and a common denominator.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for what cannot be treated.
    pub(crate) fn delayed_family(&self, usual: &[Rational], budget: &Budget) -> Result<Option<DelayedFunction>, Error> {
        let algebra = self.algebra_over_symbols(budget)?;
        let delays = algebra.symbols().delays();
        let Some(polynomial) = algebra.polynomial().filter(|_| !delays.is_empty()) else { return Ok(None) };
        if self.region().bound() != super::Region::of(self.time()).bound() {
            let help = "ask for one parameter: 'intervals --param NAME --decay S'";
            return Err(refused("a decay rate cannot be asked of tolerances in a loop with dead time yet", help));
        }
        if algebra.symbols().iter().count() > delays.len() {
            let help = "write the values of exp, sqrt, sin, cos, tan and pi as numbers";
            return Err(refused("beside dead time the loop contains other functions that are not rational", help));
        }
        let time_of = |variable: usize| delays.iter().find(|(own, _)| *own == variable).map(|(_, time)| time);
        budget.enter(|| {
            let (scaled, common) = cleared(&polynomial.coefficients, |v| time_of(v).is_some())?;
            let mut terms: Vec<(RationalFunction, Vec<MultiPoly>)> = Vec::new();
            for (j, f) in scaled.iter().enumerate() {
                for (monomial, c) in f.numerator().terms() {
                    let mut total = RationalFunction::zero();
                    let mut own = vec![0u32; usual.len()];
                    for (variable, &e) in monomial.exponents().iter().enumerate().filter(|(_, e)| **e > 0) {
                        match time_of(variable) {
                            Some(time) => {
                                total = &total + &(time * &RationalFunction::from(Rational::from(i64::from(e))))
                            }
                            None => own[variable] += e,
                        }
                    }
                    let at = terms.iter().position(|(time, _)| *time == total).unwrap_or_else(|| {
                        terms.push((total, vec![MultiPoly::zero(); scaled.len()]));
                        terms.len() - 1
                    });
                    terms[at].1[j] = terms[at].1[j].plus(&MultiPoly::from_terms([(own, c.clone())]));
                }
            }
            // What contains a delay is an operator, and has no zeros among the parameters.
            let is_pole = |p: &&MultiPoly| !p.is_constant() && p.variables().iter().all(|v| *v < usual.len());
            let mut poles: Vec<MultiPoly> = polynomial.poles.iter().filter(is_pole).cloned().collect();
            poles.extend((!common.is_constant()).then_some(common));
            let times = delays.iter().map(|(_, time)| time.clone()).collect();
            Ok(DelayedFunction::new(terms, times, poles, usual))
        })?
    }
}
