//! For which values of a parameter a loop is stable and meets its requirements.

use super::cells::Cells;
use super::damped::changes;
use super::family::{Boundaries, Family};
use super::margins::Margins;
use super::met::AtPoint;
use super::open_loop::OpenLoop;
use super::over_symbols::SymbolicFamily;
use super::requirement::{Requirement, Rule, scaled_by_exponential};
use super::spiral::OnSpiral;
use super::{DelayMargin, HeldDelay};
use crate::answer::{Answer, Verdict};
use crate::coverage::refusals::DELAY_AT_POINTS;
use crate::error::{Code, Diagnostic, Error};
use crate::precisions::REQUIRED_DELAY;
use crate::problem::Problem;
use crate::stability::{
    End, Range, Shape, StableSet, SymbolicPolynomial, UndecidedBracket, boundary_polynomials, symbolic_stable_set,
};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::{Enclosure, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, RationalFunction, UniPoly};
use jurist_algebra::real::Real;
use std::cmp::Ordering;
use std::sync::Arc;

/// The values of one parameter for which a loop is stable and meets all its requirements.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct RequiredSet {
    /// The intervals, ascending.
    pub intervals: Vec<RequiredInterval>,
    /// Where it is not told, ascending.
    pub undecided: Vec<UndecidedBracket>,
}

/// An interval; `None` is an infinite end.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequiredInterval {
    /// The lower end.
    pub lower: Option<RequiredEnd>,
    /// The upper end.
    pub upper: Option<RequiredEnd>,
}

impl RequiredInterval {
    /// Whether a value lies between the ends, or is one that is met.
    pub fn contains(&self, value: &Rational) -> bool {
        let is_beyond = |end: &Option<RequiredEnd>, side: Ordering| {
            end.as_ref().is_some_and(|end| match end.value().compare_rational(value) {
                Ordering::Equal => !matches!(end, RequiredEnd::Requirement { closed: true, .. }),
                order => order == side,
            })
        };
        !is_beyond(&self.lower, Ordering::Greater) && !is_beyond(&self.upper, Ordering::Less)
    }
}

/// An end: of stability, or where a requirement binds.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "there are few of them, and most are the large one")]
pub enum RequiredEnd {
    /// Stability ends, or the domain does.
    Stability(End),
    /// A requirement is not met beyond.
    Requirement {
        /// The value.
        value: Real,
        /// The names of all that are not met beyond.
        names: Vec<&'static str>,
        /// Whether they are met at the value itself.
        closed: bool,
    },
}

impl RequiredEnd {
    /// The value.
    pub fn value(&self) -> Real {
        match self {
            RequiredEnd::Stability(end) => end.value.clone(),
            RequiredEnd::Requirement { value, .. } => value.clone(),
        }
    }
}

/// A requirement at a point.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RequirementMet {
    /// What is required.
    pub requirement: Requirement,
    /// The margins, where a requirement is about them.
    pub margins: Option<Arc<Margins>>,
    /// Whether it is met; never by a loop that is not stable.
    pub met: bool,
}

impl Problem {
    /// For which values of the one free parameter the loop is stable and meets the requirements, margins being taken at a cut.
    ///
    /// A margin changes from met to not met only where a crossing of the open loop passes the required value, where crossings
    /// appear or vanish (the discriminant), or where one enters the range of frequencies at its ends: zeros of resultants in
    /// the parameter. One rational value between two neighbours is decided exactly.
    ///
    /// Where the loop contains functions that are not rational, as a plant behind a hold brings them, the same is asked of resultants
    /// that are enclosed and not expanded, and what these leave open is [`RequiredSet::undecided`].
    ///
    /// Cost: that of [`Problem::stable_set`], a few resultants for each requirement in polynomials of the order's degree, and one
    /// computation of each margin in each cell.
    ///
    /// # Errors
    /// [`Error::Refused`] as [`OpenLoop::of`](crate::response::OpenLoop::of), and `E-require` for a requirement that is not decided for such a loop; [`Error::Stopped`].
    ///
    /// # Panics
    /// Unless one parameter is free.
    pub fn required_set(
        self: &Arc<Self>,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Answer<RequiredSet>, Error> {
        budget.enter(|| {
            let stable = self.stable_set(budget)?.into_value();
            let whole = self.without_region();
            if requirements.iter().any(Requirement::needs_cut)
                && let Some(family) = SymbolicFamily::of(&whole, at, budget)?
            {
                budget.step("boundaries of the requirements");
                return Ok(Answer::new(Arc::clone(self), family.required_set(requirements, &stable, budget)?));
            }
            let family = match requirements.iter().any(Requirement::needs_cut) {
                true => Some(Family::of(self, at, budget)?),
                false => None,
            };
            budget.step("boundaries of the requirements");
            let mut boundaries = Vec::new();
            for requirement in requirements {
                boundaries.push(whole.boundaries(requirement, family.as_ref(), &stable, budget)?);
            }
            let mut intervals = Vec::new();
            if !stable.undecided().is_empty() {
                let message = "the stable set is undecided in places, and so are requirements";
                return Err(Diagnostic::error(Code::Require, message).into());
            }
            for interval in stable.intervals() {
                budget.step("testing a sample of each cell");
                let cells =
                    Cells { problem: &whole, requirements, boundaries: &boundaries, family: family.as_ref(), budget };
                intervals.extend(cells.within(interval)?);
            }
            Ok(Answer::new(Arc::clone(self), RequiredSet { intervals, undecided: Vec::new() }))
        })?
    }

    /// Whether the loop is stable and meets each requirement, with every parameter at its set or nominal value.
    ///
    /// Cost: that of each margin.
    ///
    /// # Errors
    /// As [`Problem::margins`].
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn requirements_met(
        self: &Arc<Self>,
        requirements: &[Requirement],
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Vec<RequirementMet>, Error> {
        if requirements.is_empty() {
            return Ok(Vec::new());
        }
        budget.enter(|| {
            let stable = self.verdict(budget)?.value().verdict == Verdict::Stable;
            let (margins, zero_loop) = match requirements.iter().any(Requirement::needs_cut) {
                true => {
                    let is_delay = requirements.iter().any(|r| matches!(r.rule(), Rule::DeadTime(_)));
                    match self.margins_with(at, &Rational::ZERO, is_delay, budget) {
                        Ok(margins) => (Some(Arc::new(margins.into_value())), None),
                        // A gain of zero opens the loop at this point: it has no margins, and no change at the cut matters.
                        Err(refused) => match OpenLoop::of_any(self, at, budget) {
                            Ok(open_loop) if open_loop.is_zero() => (None, Some(open_loop)),
                            _ => return Err(refused),
                        },
                    }
                }
                false => (None, None),
            };
            let about_roots = |r: &Requirement| !r.needs_cut();
            let closed = match requirements.iter().any(about_roots) {
                true => self.without_region().parametric(budget)?.map(|p| p.specialised(&Rational::ZERO)),
                false => None,
            };
            let closed = closed.unwrap_or_else(UniPoly::zero);
            let mut out = Vec::with_capacity(requirements.len());
            for requirement in requirements {
                let open_loop = margins.as_ref().map(|m| &m.open_loop).or(zero_loop.as_ref());
                let known = match margins.as_ref().and_then(|m| Some((m, m.stable.as_ref()?))) {
                    Some((all, stable)) => requirement.is_met_by(all, stable, budget)?,
                    None => None,
                };
                let met = match (requirement.rule(), &margins, known) {
                    _ if !stable => false,
                    (_, _, Some(met)) => met,
                    (Rule::DeadTime(least), Some(margins), _) => bears(margins, least, budget)?,
                    // A loop that is open at this point bears any dead time.
                    (Rule::DeadTime(_), None, _) => true,
                    _ => AtPoint::new(open_loop, &closed, self.shape()).meets(requirement, budget)?,
                };
                out.push(RequirementMet { requirement: requirement.clone(), margins: margins.clone(), met });
            }
            Ok(out)
        })?
    }

    fn boundaries(
        &self,
        requirement: &Requirement,
        family: Option<&Family<UniPoly>>,
        stable: &StableSet,
        budget: &Budget,
    ) -> Result<Boundaries<UniPoly>, Error> {
        let undecided = || {
            let message = format!("the requirement {} is not decided for this loop", requirement.name());
            Error::from(
                Diagnostic::error(Code::Require, message).help("a polynomial of its boundary vanishes for every value"),
            )
        };
        let found = match (requirement.rule(), family) {
            (Rule::Sector(least), _) => {
                let Some(p) = self.parametric(budget)? else { return Err(undecided()) };
                if self.shape() == Shape::UnitDisc {
                    budget.step("roots on the spiral of the damping");
                    let p = OnSpiral::new(p.polynomial(), least);
                    let mut values = Vec::new();
                    for interval in stable.intervals() {
                        values.extend(changes(&p, interval, budget)?);
                    }
                    return Ok(Boundaries { values, ..Boundaries::none() });
                }
                let sector = crate::stability::sector::sector_in_parameter(p, least);
                let Some(found) = boundary_polynomials(&sector, self.shape(), budget)? else { return Err(undecided()) };
                let zeros = found.into_iter().map(|b| b.polynomial.poly().clone()).collect();
                Boundaries { zeros, ..Boundaries::none() }
            }
            (Rule::Modulus { exponent }, _) => {
                Boundaries { values: self.settled(exponent, budget)?, ..Boundaries::none() }
            }
            (Rule::DeadTime(_), _) => {
                return Err(DELAY_AT_POINTS.diagnostic(&[]).into());
            }
            (_, None) => return Err(undecided()),
            (_, Some(family)) => {
                let mut found = family.boundaries(requirement, budget)?;
                found.zeros.push(family.undefined.clone());
                found
            }
        };
        if found.zeros.iter().any(UniPoly::is_zero) || found.touches.is_zero() { Err(undecided()) } else { Ok(found) }
    }

    /// The values of the parameter at which a root may have the modulus `exp(exponent)`.
    fn settled(&self, exponent: &Rational, budget: &Budget) -> Result<Vec<Real>, Error> {
        if self.shape() != Shape::UnitDisc || !self.has_fixed_sample_time(budget)? {
            let message = "a settling time is required of discrete loops with a sample time that is a number";
            return Err(Diagnostic::error(Code::Require, message).into());
        }
        let Some(p) = self.parametric(budget)? else { return Ok(Vec::new()) };
        let lift = |c: &UniPoly| MultiPoly::from_univariate(c, 1);
        let (symbols, scaled) = scaled_by_exponential(p.polynomial().coeffs().iter().map(lift), exponent);
        // The parameter is variable 0, the exponential variable 1.
        let swapped = |c: &MultiPoly| RationalFunction::from(c.map_variables(|i| 1 - i));
        let d = CharacteristicPolynomial {
            variables: vec![self.parameter().name.clone(), "X".to_owned()],
            coefficients: scaled.coeffs().iter().map(swapped).collect(),
            formal_degree: p.formal_degree(),
            poles: Vec::new(),
            monic: false,
        };
        let p = SymbolicPolynomial::new(&d, 1, &symbols);
        let set = symbolic_stable_set(&p, &Range::all(), Shape::UnitDisc, budget)?;
        let mut out: Vec<Real> = Vec::new();
        for end in set.intervals().iter().flat_map(|i| [&i.lower, &i.upper]).flatten() {
            if out.last().is_none_or(|last| !last.is_same(&end.value)) {
                out.push(end.value.clone());
            }
        }
        Ok(out)
    }

    fn has_fixed_sample_time(&self, budget: &Budget) -> Result<bool, Error> {
        let step = self.algebra(budget)?.sample_time();
        Ok(step.is_some_and(|t| t.as_constant().is_some()))
    }
}

/// Whether a stable loop bears all dead times less than one.
fn bears(margins: &Margins, least: &Rational, budget: &Budget) -> Result<bool, Error> {
    let Some(stable) = &margins.stable else { return Ok(false) };
    match (&stable.delay, &margins.held_delay) {
        (DelayMargin::Unbounded, _) => Ok(true),
        (DelayMargin::Zero, _) => Ok(false),
        (DelayMargin::DeadTime(i), _) => {
            let crossing = &margins.crossings.gain[*i];
            let enclose = |bits| crossing.delay(margins.open_loop.shape(), bits);
            Ok(is_at_least(enclose, least, budget)?)
        }
        (_, Some(HeldDelay { samples, period, .. })) => {
            let needed = least.checked_div(period).expect("a sample time is positive");
            Ok(match samples {
                Some(samples) => budget.enter(|| samples.compare_rational(&needed).is_ge())?,
                None => needed <= Rational::from(HeldDelay::LOOKED_AT),
            })
        }
        (DelayMargin::Samples(m) | DelayMargin::SamplesAtLeast(m), None) => {
            let Some(step) = margins.open_loop.sample_time() else {
                let message = "a delay margin of a discrete loop needs its sample time";
                return Err(Diagnostic::error(Code::Require, message).into());
            };
            Ok(&Rational::from(*m) * step >= *least)
        }
    }
}

fn is_at_least(
    enclose: impl Fn(u64) -> Option<Enclosure>,
    least: &Rational,
    budget: &Budget,
) -> Result<bool, Exhausted> {
    REQUIRED_DELAY.decide("comparing a delay with the required one", |bits| {
        Ok(match budget.enter(|| enclose(bits))? {
            Some(e) if e.lower() >= least => Some(true),
            Some(e) if e.upper() < least => Some(false),
            _ => None,
        })
    })
}
