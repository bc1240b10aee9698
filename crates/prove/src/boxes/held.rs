//! The symbols of a box whose loop has blocks behind a hold, or prewarped rules, at fixed times.

use super::super::held::{MOST_OF_CHECKERS, SPARE_BITS, definitions, longest, modes, without_certain_roots};
use super::super::over_symbols::Enclosed;
use crate::precisions::CERTIFICATE_OVER_SYMBOLS;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Integer;
use jurist_algebra::number::{Rational, Sign};
use jurist_algebra::poly::{Domain, MultiPoly};
use jurist_algebra::symbols::Symbols;
use jurist_engine::answer::SYMBOL_BITS;
use jurist_engine::problem::Problem;
use jurist_model::error::Error;
use jurist_stability::boxes::{BoxPolynomial, Witness};
use jurist_stability::{AtPoint, Cause, RootCount};
use serde_json::Value;

/// A table of symbols, which are the variables of polynomials behind those of the box.
pub(super) struct Held {
    symbols: Symbols,
    parameters: usize,
}

impl Held {
    pub fn of(problem: &Problem, budget: &Budget) -> Result<Held, Error> {
        Ok(Held { symbols: problem.fixed_symbols(budget)?, parameters: problem.free().len() })
    }

    /// Polynomials with values for the parameters, together times a positive number; the symbols become the variables from 1 on.
    fn at(&self, list: &[MultiPoly], point: &[Rational]) -> Vec<MultiPoly> {
        let mut out = list.to_vec();
        for (i, x) in point.iter().enumerate() {
            let most = out.iter().map(|p| p.degree_in(i)).max().unwrap_or(0);
            for p in &mut out {
                let spare = u64::from(most - p.degree_in(i));
                *p = p.substitute(i, x).0.scaled_by(&x.denominator().pow(spare));
            }
        }
        let place = |i: usize| (i + 1).saturating_sub(self.parameters);
        out.iter().map(|p| p.map_variables(place)).collect()
    }

    /// The bits with which the checkers count the roots at a point as the model's verdict does; `None` where these are not enough.
    fn bits_at(
        &self,
        p: &BoxPolynomial,
        point: &[Rational],
        wanted: (RootCount, usize),
        budget: &Budget,
    ) -> Result<Option<u64>, Error> {
        let mut d = self.at(&p.coefficients_in_region(), point);
        let formal = d.len();
        while d.last().is_some_and(MultiPoly::is_zero) {
            d.pop();
        }
        let (count, infinite) = wanted;
        if infinite != formal - d.len().max(1) {
            return Ok(None);
        }
        if d.is_empty() {
            return Ok(Some(CERTIFICATE_OVER_SYMBOLS.first));
        }
        let (rest, on) = without_certain_roots(&d);
        let found = CERTIFICATE_OVER_SYMBOLS.find(|bits| {
            budget.check()?;
            let enclosed = Enclosed { symbols: &self.symbols, bits };
            Ok::<_, Error>(budget.enter(|| enclosed.inside(rest.coeffs(), None, false))?.map(|inside| (inside, bits)))
        })?;
        let outside = |inside: usize| d.len() - 1 - on - inside;
        let is_right =
            |&(inside, _): &(usize, u64)| (inside, on, outside(inside)) == (count.inside, count.on, count.outside);
        Ok(found.filter(is_right).map(|(_, bits)| bits + longest(d.iter())))
    }

    /// The bits with which the checkers see that a point beyond is not stable; `None` where that needs more than an enclosure.
    pub fn bits_beyond(&self, p: &BoxPolynomial, witness: &Witness, budget: &Budget) -> Result<Option<u64>, Error> {
        match &witness.at {
            Some(AtPoint::Undefined) => {
                let divisors = p.certain().iter().filter(|(cause, _)| *cause == Cause::Pole).map(|(_, f)| f.clone());
                let is_zero = self.at(&divisors.collect::<Vec<_>>(), &witness.point).iter().any(MultiPoly::is_zero);
                Ok(is_zero.then_some(CERTIFICATE_OVER_SYMBOLS.first))
            }
            Some(AtPoint::Zero) => self.bits_at(p, &witness.point, (RootCount::default(), p.formal_degree()), budget),
            Some(AtPoint::Defined { count, infinite }) => self.bits_at(p, &witness.point, (*count, *infinite), budget),
            None | Some(AtPoint::Delayed { .. }) => Ok(None),
        }
    }

    /// The bits with which the checkers see that the nominal point is stable.
    pub fn bits_inside(&self, p: &BoxPolynomial, point: &[Rational], budget: &Budget) -> Result<Option<u64>, Error> {
        let count = RootCount { inside: p.formal_degree(), ..RootCount::default() };
        self.bits_at(p, point, (count, 0), budget)
    }

    /// A factor without factors that are numbers, polynomials in symbols, with the sign that it has; `None` where nothing else is in it.
    pub fn in_parameters(&self, f: &MultiPoly) -> Option<MultiPoly> {
        type Terms = Vec<(Vec<u32>, Integer)>;
        let mut parts: Vec<(Vec<u32>, Terms)> = Vec::new();
        for (monomial, c) in f.terms() {
            let mut of_parameters = monomial.exponents().to_vec();
            let mut of_symbols = of_parameters.clone();
            of_parameters.resize(self.parameters, 0);
            of_symbols.iter_mut().take(self.parameters).for_each(|e| *e = 0);
            match parts.iter_mut().find(|(known, _)| *known == of_parameters) {
                Some((_, terms)) => terms.push((of_symbols, c.clone())),
                None => parts.push((of_parameters, vec![(of_symbols, c.clone())])),
            }
        }
        if parts.iter().all(|(e, _)| e.iter().all(|k| *k == 0)) {
            return None;
        }
        let mut content = MultiPoly::zero();
        for (_, terms) in parts {
            content = content.gcd(&MultiPoly::from_terms(terms));
            if content.is_constant() {
                return Some(f.clone());
            }
        }
        let place = |i: usize| i.saturating_sub(self.parameters);
        let sign = self.symbols.enclose(&content.map_variables(place), SYMBOL_BITS).sign();
        let content = match sign {
            Some(Sign::Greater) => content,
            Some(Sign::Less) => content.negated(),
            // Nothing is gained where it is not told.
            _ => return Some(f.clone()),
        };
        Some(f.div_exact(&content).expect("a content divides"))
    }

    /// The parts of a certificate that say what the symbols are; enclosures with so many bits tell what is counted, and those of the polynomials
    /// are as narrow as those that proved the box.
    pub fn parts<'p>(
        &self,
        problem: &Problem,
        bits: u64,
        polynomials: impl Iterator<Item = &'p MultiPoly>,
        budget: &Budget,
    ) -> Result<[(&'static str, Value); 3], Error> {
        let bits = bits.max(SYMBOL_BITS + longest(polynomials)) + SPARE_BITS;
        Ok([
            ("bits", bits.min(MOST_OF_CHECKERS).into()),
            ("symbols", definitions(&self.symbols)?),
            ("modes", modes(problem, budget)?),
        ])
    }
}
