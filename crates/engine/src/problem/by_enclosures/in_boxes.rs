//! Algebra for boxes of a loop behind holds whose exact polynomials would be long. Each coefficient is a symbol. Its values are known, at points and as
//! Taylor models.

use super::{WORK_BEFORE, is_too_long};
use crate::error::Error;
use crate::model::{ClosedLoop, Cut, InNumbers, Opened, Symbols, Time, rank_bound};
use crate::problem::{Algebra, Bound, Problem, Region};
use jurist_algebra::limits::Budget;
use jurist_algebra::matrix::{CharacteristicPolynomial, RationalMatrix};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, Monomial, MultiPoly, Poly, RationalFunction};
use jurist_algebra::symbols::{Definition, FamilyValue, MatrixFamily};
use std::collections::BTreeSet;
use std::sync::Arc;

impl Problem {
    /// The same problem for a question that is decided in boxes. Where a loop behind holds has long exact coefficients, they are replaced by
    /// symbols whose values are known.
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

    /// Whether a loop behind holds has long exact coefficients, and these have values instead.
    ///
    /// # Errors
    /// As [`Problem::in_boxes`].
    pub(crate) fn is_long(self: &Arc<Self>, budget: &Budget) -> Result<bool, Error> {
        Ok(self.model().hyperperiod() == 1 && !Arc::ptr_eq(self, &self.in_boxes(budget)?))
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
        self.coefficients_by_values(&radius, budget)
    }

    /// Algebra whose coefficients are known by their values, in a disc of this radius; `None` where the loop is not of this form.
    pub(super) fn coefficients_by_values(&self, radius: &Rational, budget: &Budget) -> Result<Option<Algebra>, Error> {
        let has_rates = self.model().hyperperiod() > 1;
        let kept: Vec<String> = self.free().iter().map(|free| free.name.clone()).collect();
        let found = budget.enter(|| match has_rates {
            true => self.model().closed_loop_by_values(&kept, self.set(), budget),
            false => self.model().closed_loop_in_numbers(&kept, self.set(), budget),
        })?;
        let found = match found {
            Ok(found) => found,
            Err(stopped @ Error::Stopped(_)) => return Err(stopped),
            Err(_) => None,
        };
        let is_held = |found: &InNumbers| found.symbols.has_flows() && !found.closed_loop.is_complex;
        let Some(InNumbers { closed_loop, sample_time, symbols }) = found.filter(is_held) else { return Ok(None) };
        budget.step("coefficients by enclosures");
        let of = Held { system: &closed_loop, sample_time: sample_time.as_ref(), symbols: &symbols };
        // Over a hyperperiod a gain has high powers: it counts as what is inside of functions.
        let names = |kept| if has_rates { OfNames::without_gains(kept) } else { OfNames::of(&of, kept) };
        Ok(budget.enter(|| of.algebra(&names(kept), radius))?)
    }

    /// The loop cut open, by values. `None` where the cut is at a gain, where the open loop has a direct feedthrough or the closed loop decouples, or is not
    /// of this form.
    ///
    /// Cost: the closed loop without a characteristic polynomial.
    ///
    /// # Errors
    /// As [`Problem::closed_loop_over_symbols`].
    pub(crate) fn opened_by_values(&self, cut: &Cut, budget: &Budget) -> Result<Option<OpenedByValues>, Error> {
        if matches!(cut, Cut::Gain(_)) || self.model().hyperperiod() > 1 || self.time() == Time::Continuous {
            return Ok(None);
        }
        let kept: Vec<String> = self.free().iter().map(|free| free.name.clone()).collect();
        let opened = budget.enter(|| self.model().opened_in_numbers(cut, &kept, self.set(), budget))??;
        let Opened { system, sample_time, symbols, is_closed } = &opened;
        if *is_closed || !symbols.has_flows() || system.is_complex {
            return Ok(None);
        }
        let of = Held { system, sample_time: sample_time.as_ref(), symbols };
        Ok(budget.enter(|| {
            let names = OfNames::of(&of, kept.clone());
            of.opened(&names).or_else(|| of.opened(&OfNames::without_gains(kept)))
        })?)
    }
}

/// The open loop `N/D0` of a loop by values.
pub(crate) struct OpenedByValues {
    pub denominator: Poly<MultiPoly>,
    pub numerator: Poly<MultiPoly>,
    /// It vanishes where something is divided by zero.
    pub undefined: MultiPoly,
    pub sample_time: Option<RationalFunction>,
    pub symbols: Symbols,
}

/// A loop behind holds with its exponentials whole.
struct Held<'a> {
    system: &'a ClosedLoop,
    sample_time: Option<&'a RationalFunction>,
    symbols: &'a Symbols,
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
    /// All names count as what is inside of functions.
    fn without_gains(kept: Vec<String>) -> OfNames {
        OfNames { gains: Vec::new(), inside: (0..kept.len()).collect(), kept }
    }

    fn of(of: &Held, kept: Vec<String>) -> OfNames {
        let count = kept.len();
        let ClosedLoop { a, e, c, poles, .. } = of.system;
        let mut inside: BTreeSet<usize> = of.symbols.arguments().flat_map(RationalFunction::variables).collect();
        inside.extend([a, e, c].into_iter().flat_map(|m| m.entries()).flat_map(|f| f.denominator().variables()));
        inside.extend(poles.iter().flat_map(MultiPoly::variables));
        for (monomial, _) in [a, e, c].into_iter().flat_map(|m| m.entries()).flat_map(|f| f.numerator().terms()) {
            let own: Vec<usize> = (0..count).filter(|&i| monomial.exponent(i) > 0 && !inside.contains(&i)).collect();
            if own.iter().map(|&i| monomial.exponent(i)).sum::<u32>() > 1 {
                inside.extend(own);
            }
        }
        let (inside, gains) = (0..count).partition(|i| inside.contains(i));
        OfNames { kept, gains, inside }
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

    /// The matrix without gains, and what each gain adds; `None` where it is not linear in them.
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
        let degree = |m: &Monomial| self.gains.iter().map(|i| m.exponent(*i)).sum::<u32>();
        if a.entries().iter().flat_map(|f| f.numerator().terms()).any(|(m, _)| degree(m) > 1) {
            return None;
        }
        let slopes = self.gains.iter().map(|gain| part(Some(*gain))).collect::<Option<Vec<_>>>()?;
        Some((part(None)?, slopes))
    }

    /// Symbols for the values of a family.
    fn symbols(&self, family: &Arc<MatrixFamily>, count: usize) -> Symbols {
        let at: Vec<RationalFunction> = self.inside.iter().map(|i| RationalFunction::variable(*i)).collect();
        let definition = |index: usize| {
            let own = FamilyValue { of: Arc::clone(family), index, at: at.clone() };
            // No name of a model begins with a digit.
            (format!("{index}c"), Definition::Family(own))
        };
        Symbols::of_definitions(self.kept.clone(), (0..count).map(definition).collect())
    }

    /// The symbol of a value.
    fn symbol(&self, index: usize) -> MultiPoly {
        MultiPoly::variable(self.kept.len() + index)
    }
}

/// The values of a loop as symbols.
struct Values {
    family: Arc<MatrixFamily>,
    symbols: Symbols,
    /// What is divided by, in names and symbols.
    poles: Vec<MultiPoly>,
}

impl Held<'_> {
    /// The family of the matrix and its slopes. `None` where its degree is large, or the sample time contains functions.
    fn values(
        &self,
        names: &OfNames,
        constant: RationalMatrix,
        slopes: Vec<RationalMatrix>,
        degree: usize,
    ) -> Option<Values> {
        // What is divided by: polynomials in names stay, of others the values are asked for.
        let ClosedLoop { a, e, c, poles: known, .. } = self.system;
        let entries = [a, e, c].into_iter().flat_map(|m| m.entries());
        let below = entries.chain(self.symbols.arguments()).map(RationalFunction::denominator);
        let mut all: Vec<&MultiPoly> = Vec::new();
        for pole in known.iter().chain(below).filter(|p| !p.is_constant()) {
            if !all.contains(&pole) {
                all.push(pole);
            }
        }
        let count = names.kept.len();
        let is_of_names = |p: &&MultiPoly| p.variables().iter().all(|i| *i < count);
        let (of_names, of_symbols): (Vec<&MultiPoly>, Vec<&MultiPoly>) = all.into_iter().partition(is_of_names);
        let beside = of_symbols.iter().map(|p| names.placed(&(*p).clone().into())).collect::<Option<Vec<_>>>()?;
        if self.sample_time.into_iter().flat_map(RationalFunction::variables).any(|i| i >= count) {
            return None;
        }
        let others = beside.len();
        let variables = self.symbols.family_variables(names.inside.len(), |f| names.placed(f))?;
        let family = Arc::new(MatrixFamily::new(variables, constant, slopes, degree, beside)?);
        let first = family.monomials().len() * family.order();
        let poles = of_names.into_iter().cloned().chain((0..others).map(|k| names.symbol(first + k))).collect();
        let symbols = names.symbols(&family, first + others);
        Some(Values { family, symbols, poles })
    }

    /// A bound of the degree of the polynomial in all slopes together.
    fn degree(&self, names: &OfNames, slopes: &[RationalMatrix]) -> usize {
        let n = self.system.a.rows();
        let first = names.inside.len() + self.symbols.iter().count();
        let all = slopes.iter().enumerate().fold(RationalMatrix::zeros(n, n), |sum, (i, slope)| {
            &sum + &slope.scaled(&RationalFunction::variable(first + i))
        });
        rank_bound(&all)
    }

    fn algebra(&self, names: &OfNames, radius: &Rational) -> Option<Algebra> {
        let over = RationalFunction::from(radius.recip()?);
        let (constant, slopes) = names.split(&self.system.a)?;
        let slopes: Vec<RationalMatrix> = slopes.iter().map(|m| m.scaled(&over)).collect();
        let degree = self.degree(names, &slopes);
        let Values { family, symbols, poles } = self.values(names, constant.scaled(&over), slopes, degree)?;
        let n = family.order();
        let mut of_w: Vec<MultiPoly> = vec![MultiPoly::zero(); n];
        for (m, exponents) in family.monomials().iter().enumerate() {
            let powers = names.gains.iter().zip(exponents).flat_map(|(i, e)| std::iter::repeat_n(*i, *e as usize));
            let gains = powers.fold(MultiPoly::one(), |product, i| product.times(&MultiPoly::variable(i)));
            for (k, c) in of_w.iter_mut().enumerate() {
                *c = c.plus(&gains.times(&names.symbol(m * n + k)));
            }
        }
        of_w.push(MultiPoly::one());
        let polynomial = CharacteristicPolynomial {
            variables: symbols.variables(),
            coefficients: in_z(of_w).into_coeffs().into_iter().map(RationalFunction::from).collect(),
            formal_degree: n,
            poles,
            monic: true,
        };
        Some(Algebra::of_values(polynomial, self.sample_time.cloned(), symbols))
    }

    /// The closed loop is `A + l E C` with `l = 1`, and its polynomial `D0 + l N`, for `E C` has the rank 1.
    fn opened(&self, names: &OfNames) -> Option<OpenedByValues> {
        let system = self.system;
        let (n, column) = (system.a.rows(), system.inputs.len().max(system.e.columns()).checked_sub(1)?);
        let returned = RationalMatrix::from_fn(n, n, |i, j| &system.e[(i, column)] * &system.c[(0, j)]);
        let is_whole = (&system.a + &returned).decoupled_parts().len() == 1;
        if !is_whole || !system.d[(0, column)].is_zero() {
            return None;
        }
        let ((constant, of_open), (back, of_back)) = (names.split(&system.a)?, names.split(&returned)?);
        let nothing = RationalMatrix::zeros(n, n);
        // For each slope: whether it has the factor l, and its gain.
        let gains = || names.gains.iter().copied().map(Some);
        let parts = gains().zip(of_open).map(|(gain, m)| (false, gain, m));
        let parts = parts.chain([(true, None, back)]).chain(gains().zip(of_back).map(|(gain, m)| (true, gain, m)));
        let parts: Vec<(bool, Option<usize>, RationalMatrix)> = parts.filter(|(_, _, m)| *m != nothing).collect();
        let slopes: Vec<RationalMatrix> = parts.iter().map(|(_, _, m)| m.clone()).collect();
        let degree = self.degree(names, &slopes);
        let Values { family, symbols, poles } = self.values(names, constant, slopes, degree)?;
        let mut both = [(); 2].map(|()| vec![MultiPoly::zero(); n]);
        for (m, exponents) in family.monomials().iter().enumerate() {
            let of = || parts.iter().zip(exponents).filter(|(_, e)| **e > 0);
            let back: u32 = of().filter(|((is_back, ..), _)| *is_back).map(|(_, e)| e).sum();
            // Higher powers of l have the coefficient 0.
            let Some(own) = both.get_mut(back as usize) else { continue };
            let powers = of().flat_map(|((_, gain, _), e)| std::iter::repeat_n(*gain, *e as usize)).flatten();
            let gains = powers.fold(MultiPoly::one(), |product, i| product.times(&MultiPoly::variable(i)));
            for (k, c) in own.iter_mut().enumerate() {
                *c = c.plus(&gains.times(&names.symbol(m * n + k)));
            }
        }
        both[0].push(MultiPoly::one());
        let [denominator, numerator] = both.map(in_z);
        let undefined = poles.iter().fold(MultiPoly::one(), |product, pole| product.times(pole));
        Some(OpenedByValues { denominator, numerator, undefined, sample_time: self.sample_time.cloned(), symbols })
    }
}

/// The polynomial in `z`, from the coefficients of the powers of `w = z - 1`.
fn in_z(of_w: Vec<MultiPoly>) -> Poly<MultiPoly> {
    Poly::new(of_w).compose(&Poly::new(vec![MultiPoly::one().negated(), MultiPoly::one()]))
}
