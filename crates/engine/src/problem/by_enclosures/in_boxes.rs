//! Algebra for boxes of a loop behind holds whose exact polynomials would be long: each coefficient is a symbol of which values are known, at
//! points and as Taylor models.

use super::{WORK_BEFORE, is_too_long};
use crate::error::Error;
use crate::model::{InNumbers, Symbols};
use crate::problem::{Algebra, Bound, Problem, Region};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction, UniPoly};
use jurist_algebra::symbols::{Definition, FamilyValue, MatrixFamily};
use std::collections::BTreeSet;
use std::sync::Arc;

impl Problem {
    /// The same problem for a question that is decided in boxes: with coefficients of which only values are known where a loop behind holds has
    /// long exact ones.
    ///
    /// Cost: less than a second of exact algebra on the first call, and the closed loop without a characteristic polynomial.
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`].
    pub(crate) fn in_boxes(self: &Arc<Self>, budget: &Budget) -> Result<Arc<Problem>, Error> {
        if let Some(known) = self.in_boxes.get() {
            return Ok(known.clone().unwrap_or_else(|| Arc::clone(self)));
        }
        let found = self.by_values(budget)?.map(|algebra| Arc::new(self.with_algebra(algebra)));
        Ok(self.in_boxes.get_or_init(|| found).clone().unwrap_or_else(|| Arc::clone(self)))
    }

    /// Algebra by values; `None` where exact algebra is short, or the loop is not of this form.
    fn by_values(&self, budget: &Budget) -> Result<Option<Algebra>, Error> {
        let radius = match self.region() {
            Region::Disc(Bound::Number(radius)) => radius.clone(),
            _ => return Ok(None),
        };
        if self.free().is_empty() || self.evaluated().is_some() || !self.model().has_holds() {
            return Ok(None);
        }
        match self.algebra_over_symbols(&budget.clone().within_work(WORK_BEFORE)) {
            Err(Error::Stopped(stopped)) if is_too_long(&stopped) && budget.check().is_ok() => {}
            // Who needs it meets the error again.
            _ => return Ok(None),
        }
        if self.model().hyperperiod() > 1 {
            return Ok(None);
        }
        let kept: Vec<String> = self.free().iter().map(|free| free.name.clone()).collect();
        let found = budget.enter(|| self.model().closed_loop_in_numbers(&kept, self.set(), budget))?;
        let found = match found {
            Ok(found) => found,
            Err(stopped @ Error::Stopped(_)) => return Err(stopped),
            Err(_) => None,
        };
        let is_held = |found: &InNumbers| found.symbols.has_flows() && !found.closed_loop.is_complex;
        let Some(found) = found.filter(is_held) else { return Ok(None) };
        budget.step("coefficients by enclosures");
        Ok(budget.enter(|| OfNames::of(&found, kept).and_then(|names| names.algebra(&found, &radius)))?)
    }
}

/// What the free names do in the closed loop.
struct OfNames {
    kept: Vec<String>,
    /// Those that the matrix is linear in, and no function depends on.
    gains: Vec<usize>,
    /// The others.
    inside: Vec<usize>,
}

impl OfNames {
    fn of(found: &InNumbers, kept: Vec<String>) -> Option<OfNames> {
        let closed_loop = &found.closed_loop;
        let count = kept.len();
        let mut inside: BTreeSet<usize> = found.symbols.arguments().flat_map(RationalFunction::variables).collect();
        let entries = closed_loop.a.entries();
        inside.extend(entries.iter().flat_map(|f| f.denominator().variables()));
        inside.extend(closed_loop.poles.iter().flat_map(MultiPoly::variables));
        for (monomial, _) in entries.iter().flat_map(|f| f.numerator().terms()) {
            let own: Vec<usize> = (0..count).filter(|&i| monomial.exponent(i) > 0 && !inside.contains(&i)).collect();
            if own.iter().map(|&i| monomial.exponent(i)).sum::<u32>() > 1 {
                inside.extend(own);
            }
        }
        let (inside, gains) = (0..count).partition(|i| inside.contains(i));
        Some(OfNames { kept, gains, inside })
    }

    /// A function of the family's variables: names that are inside of functions, then symbols. `None` where a gain is left.
    fn placed(&self, f: &RationalFunction) -> Option<RationalFunction> {
        if f.variables().iter().any(|i| self.gains.contains(i)) {
            return None;
        }
        f.map_variables(|i| match i.checked_sub(self.kept.len()) {
            Some(symbol) => self.inside.len() + symbol,
            None => self.inside.iter().position(|own| *own == i).unwrap_or(0),
        })
    }

    /// The matrix without gains, and what each gain adds.
    fn split(&self, a: &RationalMatrix) -> Option<(RationalMatrix, Vec<RationalMatrix>)> {
        let n = a.rows();
        let part = |gain: Option<usize>| {
            let entry = |f: &RationalFunction| {
                let terms = f.numerator().terms().iter().filter(|(monomial, _)| {
                    self.gains.iter().all(|i| monomial.exponent(*i) == u32::from(Some(*i) == gain))
                });
                let without = |exponents: &[u32]| {
                    exponents
                        .iter()
                        .enumerate()
                        .map(|(i, e)| if Some(i) == gain { 0 } else { *e })
                        .collect::<Vec<u32>>()
                };
                let above = MultiPoly::from_terms(terms.map(|(m, c)| (without(m.exponents()), c.clone())));
                self.placed(&RationalFunction::new(above, f.denominator().clone())?)
            };
            let entries = a.entries().iter().map(entry).collect::<Option<Vec<_>>>()?;
            Some(RationalMatrix::from_fn(n, n, |i, j| entries[i * n + j].clone()))
        };
        let slopes = self.gains.iter().map(|gain| part(Some(*gain))).collect::<Option<Vec<_>>>()?;
        Some((part(None)?, slopes))
    }

    fn algebra(&self, found: &InNumbers, radius: &Rational) -> Option<Algebra> {
        let closed_loop = &found.closed_loop;
        let (constant, slopes) = self.split(&closed_loop.a)?;
        let over = RationalFunction::from(radius.recip()?);
        let [constant, slopes] =
            [vec![constant], slopes].map(|list| list.iter().map(|m| m.scaled(&over)).collect::<Vec<_>>());
        let constant = constant.into_iter().next()?;
        let n = constant.rows();
        // The degree in all gains together.
        let first_symbol = self.inside.len() + found.symbols.iter().count();
        let all = slopes.iter().enumerate().fold(RationalMatrix::zeros(n, n), |sum, (i, slope)| {
            &sum + &slope.scaled(&RationalFunction::variable(first_symbol + i))
        });
        let degree = crate::model::rank_bound(&all);
        // What is divided by: polynomials in names stay, of others the values are asked for.
        let below = closed_loop.a.entries().iter().chain(found.symbols.arguments()).map(RationalFunction::denominator);
        let mut poles: Vec<&MultiPoly> = Vec::new();
        for pole in closed_loop.poles.iter().chain(below).filter(|p| !p.is_constant()) {
            if !poles.contains(&pole) {
                poles.push(pole);
            }
        }
        let is_of_names = |p: &&MultiPoly| p.variables().iter().all(|i| *i < self.kept.len());
        let (of_names, of_symbols): (Vec<&MultiPoly>, Vec<&MultiPoly>) = poles.into_iter().partition(is_of_names);
        let beside = of_symbols.iter().map(|p| self.placed(&(*p).clone().into())).collect::<Option<Vec<_>>>()?;
        let count = beside.len();
        let place = |f: &RationalFunction| self.placed(f);
        let variables = found.symbols.family_variables(self.inside.len(), place)?;
        let family = Arc::new(MatrixFamily::new(variables, constant, slopes, degree, beside)?);
        let sample_time = found.sample_time.clone();
        if sample_time.iter().flat_map(RationalFunction::variables).any(|i| i >= self.kept.len()) {
            return None;
        }
        let symbol = |index: usize| MultiPoly::variable(self.kept.len() + index);
        let values = family.monomials().len() * n;
        let poles = of_names.into_iter().cloned().chain((0..count).map(|k| symbol(values + k))).collect();
        let symbols = self.symbols(&family, values + count);
        let polynomial = CharacteristicPolynomial {
            variables: symbols.variables(),
            coefficients: self.coefficients(&family, symbol),
            formal_degree: n,
            poles,
            monic: true,
        };
        Some(Algebra::of_values(polynomial, sample_time, symbols))
    }

    fn symbols(&self, family: &Arc<MatrixFamily>, count: usize) -> Symbols {
        let at: Vec<RationalFunction> = self.inside.iter().map(|i| RationalFunction::variable(*i)).collect();
        let definition = |index: usize| {
            let own = FamilyValue { of: Arc::clone(family), index, at: at.clone() };
            // No name of a model begins with a digit.
            (format!("{index}c"), Definition::Family(own))
        };
        Symbols::of_definitions(self.kept.clone(), (0..count).map(definition).collect())
    }

    /// The coefficients of the powers of `z`, from those of the powers of `z - 1`.
    fn coefficients(&self, family: &MatrixFamily, symbol: impl Fn(usize) -> MultiPoly) -> Vec<RationalFunction> {
        let n = family.order();
        let mut of_w: Vec<MultiPoly> = vec![MultiPoly::zero(); n];
        for (m, exponents) in family.monomials().iter().enumerate() {
            let powers = self.gains.iter().zip(exponents).flat_map(|(i, e)| std::iter::repeat_n(*i, *e as usize));
            let gains = powers.fold(MultiPoly::one(), |product, i| product.times(&MultiPoly::variable(i)));
            for (k, c) in of_w.iter_mut().enumerate() {
                *c = c.plus(&gains.times(&symbol(m * n + k)));
            }
        }
        of_w.push(MultiPoly::one());
        let mut power = UniPoly::one();
        let mut out = vec![MultiPoly::zero(); n + 1];
        for c in &of_w {
            for (k, binomial) in power.coeffs().iter().enumerate() {
                out[k] = out[k].plus(&c.scaled_by(binomial));
            }
            power = &power * &UniPoly::new(vec![Integer::from(-1), Integer::ONE]);
        }
        out.into_iter().map(RationalFunction::from).collect()
    }
}
