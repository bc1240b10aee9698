//! Loops with dead time and two parameters.

use super::delayed::{cleared, refused};
use super::resolved::Problem;
use crate::error::Error;
use crate::stability::dead_time::{DeadTime, PlaneLoop};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction};
use std::collections::BTreeMap;

impl Problem {
    /// The loop with dead time in the two free parameters; `None` for any other loop, and where it is undefined for all
    /// values.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`], and a common denominator.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for what cannot be treated.
    ///
    /// # Panics
    /// Unless two parameters are free.
    pub fn delayed_plane(&self, budget: &Budget) -> Result<Option<PlaneLoop>, Error> {
        assert_eq!(self.free().len(), 2, "two parameters are free");
        let algebra = self.algebra_over_symbols(budget)?;
        let delays = algebra.symbols().delays();
        let Some(polynomial) = algebra.polynomial().filter(|_| !delays.is_empty()) else { return Ok(None) };
        if self.region().bound() != super::Region::of(self.time()).bound() {
            let help = "ask for one parameter: 'intervals --param NAME --decay S'";
            return Err(refused("a decay rate cannot be asked of two parameters in a loop with dead time yet", help));
        }
        if algebra.symbols().iter().count() > delays.len() {
            let help = "write the values of exp, sqrt, sin, cos, tan and pi as numbers";
            return Err(refused("beside dead time the loop contains other functions that are not rational", help));
        }
        let line = |(variable, delay): &(usize, RationalFunction)| Some((*variable, dead_time(delay)?));
        let Some(times) = delays.iter().map(line).collect::<Option<BTreeMap<usize, DeadTime>>>() else {
            let help = "the parameters may enter a dead time as a*x + b*y + c with numbers a, b, c";
            return Err(refused("the dead time is not linear in the free parameters", help));
        };
        budget.enter(|| {
            let (scaled, common) = cleared(&polynomial.coefficients, |v| times.contains_key(&v))?;
            let mut terms: BTreeMap<DeadTime, Vec<MultiPoly>> = BTreeMap::new();
            for (j, f) in scaled.iter().enumerate() {
                for (monomial, c) in f.numerator().terms() {
                    let mut total = DeadTime::default();
                    let mut own = vec![0u32; 2];
                    for (variable, &e) in monomial.exponents().iter().enumerate().filter(|(_, e)| **e > 0) {
                        match times.get(&variable) {
                            Some(time) => total.add(time, e),
                            None => own[variable] += e,
                        }
                    }
                    let part = terms.entry(total).or_insert_with(|| vec![MultiPoly::zero(); scaled.len()]);
                    part[j] = part[j].plus(&MultiPoly::from_terms([(own, c.clone())]));
                }
            }
            // What contains a delay is an operator, and has no zeros among the parameters.
            let is_pole = |p: &&MultiPoly| !p.is_constant() && p.variables().iter().all(|v| *v < 2);
            let mut poles: Vec<MultiPoly> = polynomial.poles.iter().filter(is_pole).cloned().collect();
            poles.extend((!common.is_constant()).then_some(common));
            Ok(Some(PlaneLoop::new(terms, times.into_values().collect(), poles)))
        })?
    }
}

/// A dead time that is linear in both parameters.
fn dead_time(delay: &RationalFunction) -> Option<DeadTime> {
    let over = delay.denominator().as_constant()?;
    let mut time = DeadTime::default();
    for (monomial, c) in delay.numerator().terms() {
        let place = match (monomial.total_degree(), monomial.exponent(0), monomial.exponent(1)) {
            (0, ..) => &mut time.offset,
            (1, 1, 0) => &mut time.slopes[0],
            (1, 0, 1) => &mut time.slopes[1],
            _ => return None,
        };
        *place = Rational::new(c.clone(), over.clone());
    }
    Some(time)
}
