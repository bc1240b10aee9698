//! For which values of a parameter a loop is stable and meets its requirements.

use super::boundaries::Boundaries;
use super::cells::Cells;
use super::family::Family;
use super::for_all::AllOf;
use super::gain_family::GainFamily;
use super::margins::Margins;
use super::met::AtPoint;
use super::on_roots::OnRoots;
use super::open_loop::OpenLoop;
use super::over_symbols::SymbolicFamily;
use super::requirement::{Found, Requirement, Rule};
use crate::answer::{Answer, Verdict};
use crate::error::{Code, Diagnostic, Error};
use crate::model::Cut;
use crate::problem::Problem;
use crate::stability::{End, Shape, StableInterval, StableSet, UndecidedBracket};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Domain, UniPoly};
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
    /// Names for all of whose values in these ranges it holds what is said.
    pub for_all: Vec<AllOf>,
    /// What ended the work before all was looked at: then some of what is undecided was not.
    pub stopped: Option<Exhausted>,
}

impl RequiredSet {
    /// Sorts what is undecided.
    pub(super) fn sort(&mut self) {
        self.undecided.sort_by(|a, b| (&a.lower, &a.upper).cmp(&(&b.lower, &b.upper)));
    }

    /// The values in both sets; what binds at an end is what binds there in either.
    ///
    /// Cost: comparisons of each interval with each.
    ///
    /// # Errors
    /// As [`Real::compare`].
    fn intersection(&self, other: &RequiredSet, budget: &Budget) -> Result<RequiredSet, Exhausted> {
        let mut intervals = Vec::new();
        for a in &self.intervals {
            for b in &other.intervals {
                let lower = RequiredEnd::nearer([&a.lower, &b.lower], Ordering::Greater, budget)?;
                let upper = RequiredEnd::nearer([&a.upper, &b.upper], Ordering::Less, budget)?;
                let order = match (&lower, &upper) {
                    (Some(lower), Some(upper)) => lower.value().compare(&upper.value(), budget)?,
                    _ => Ordering::Less,
                };
                let is_closed = |end: &Option<RequiredEnd>| end.as_ref().is_some_and(RequiredEnd::is_closed);
                if order.is_lt() || (order.is_eq() && is_closed(&lower) && is_closed(&upper)) {
                    intervals.push(RequiredInterval { lower, upper });
                }
            }
        }
        let mut found = RequiredSet { intervals, undecided: self.undecided.clone(), ..RequiredSet::default() };
        found.undecided.extend(other.undecided.iter().filter(|b| !self.undecided.contains(b)).cloned());
        found.sort();
        Ok(found)
    }
}

impl From<&StableSet> for RequiredSet {
    fn from(set: &StableSet) -> Self {
        let end = |end: &Option<End>| end.clone().map(RequiredEnd::Stability);
        let interval = |i: &StableInterval| RequiredInterval { lower: end(&i.lower), upper: end(&i.upper) };
        let intervals = set.intervals().iter().map(interval).collect();
        RequiredSet { intervals, undecided: set.undecided().to_vec(), ..RequiredSet::default() }
    }
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

impl RequiredEnd {
    /// True if the value itself is in the set.
    pub fn is_closed(&self) -> bool {
        match self {
            RequiredEnd::Stability(end) => end.closed,
            RequiredEnd::Requirement { closed, .. } => *closed,
        }
    }

    /// The end that comes first from inside: the one whose value compares so with the other. At the same value stability goes before
    /// requirements, and requirements are named together.
    fn nearer(
        ends: [&Option<RequiredEnd>; 2],
        side: Ordering,
        budget: &Budget,
    ) -> Result<Option<RequiredEnd>, Exhausted> {
        let [Some(a), Some(b)] = ends else { return Ok(ends.into_iter().flatten().next().cloned()) };
        let order = a.value().compare(&b.value(), budget)?;
        if order.is_ne() {
            return Ok(Some(if order == side { a.clone() } else { b.clone() }));
        }
        Ok(Some(match (a, b) {
            (RequiredEnd::Stability(end), other) | (other, RequiredEnd::Stability(end)) => {
                RequiredEnd::Stability(end.clone().closed_if(end.closed && other.is_closed()))
            }
            (
                RequiredEnd::Requirement { value, names, closed },
                RequiredEnd::Requirement { names: others, closed: also, .. },
            ) => {
                let names = names.iter().chain(others.iter().filter(|name| !names.contains(name))).copied().collect();
                RequiredEnd::Requirement { value: value.clone(), names, closed: *closed && *also }
            }
        }))
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

impl RequirementMet {
    /// The margin that the loop has; `None` where there is no bound, and of a loop that is not stable.
    pub fn found(&self) -> Option<Found<'_>> {
        let all = self.margins.as_ref()?;
        self.requirement.found(all, all.stable.as_ref()?)
    }
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
        if !requirements.is_empty() {
            self.refuse_complex_set(requirements, budget)?;
            self.refuse_undamped(requirements, budget)?;
        }
        budget.enter(|| {
            let stable = self.stable_set(budget)?.into_value();
            let (on_margins, on_roots): (Vec<Requirement>, Vec<Requirement>) =
                requirements.iter().cloned().partition(Requirement::needs_cut);
            let (between, on_margins): (Vec<Requirement>, Vec<Requirement>) =
                on_margins.into_iter().partition(|requirement| requirement.signals().is_some());
            let (borne, on_margins): (Vec<Requirement>, Vec<Requirement>) =
                on_margins.into_iter().partition(Requirement::is_delay_margin);
            let mut found = match on_margins.is_empty() {
                true => RequiredSet::from(&stable),
                false => self.with_margins(&on_margins, &stable, at, budget)?,
            };
            for requirement in &between {
                let own = self.with_margins(std::slice::from_ref(requirement), &stable, at, budget)?;
                found = found.intersection(&own, budget)?;
            }
            for requirement in &borne {
                let own = self.bearing_set(requirement, &stable, at, budget)?;
                found = found.intersection(&own, budget)?;
            }
            for requirement in &on_roots {
                budget.step(requirement.name());
                let own = self.on_roots(requirement, budget)?.required_set(requirement, &stable, budget)?;
                found = found.intersection(&own, budget)?;
            }
            Ok(Answer::new(Arc::clone(self), found))
        })?
    }

    /// The parts of the stable set in which requirements on margins are met, all of them at one cut.
    pub(super) fn with_margins(
        self: &Arc<Self>,
        requirements: &[Requirement],
        stable: &StableSet,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        let whole = self.without_region();
        if let Some(found) = whole.required_of_gain(requirements, &requirements[0].cut(self, at)?, stable, budget)? {
            return Ok(found);
        }
        if !self.algebra_over_symbols(budget)?.symbols().delays().is_empty() {
            budget.step("boundaries of the requirements");
            if self.algebra_over_symbols(budget)?.is_complex() {
                return whole.required_of_delayed_complex(requirements, stable, at, budget);
            }
            return whole.required_in_boxes(requirements, stable, at, budget);
        }
        let cut = requirements[0].cut(self, at)?;
        let over_symbols = SymbolicFamily::of(&whole, cut.clone(), budget)?;
        budget.step("boundaries of the requirements");
        if let Some(family) = over_symbols {
            return family.required_set(requirements, stable, budget);
        }
        let family = Family::of_cut(self, cut, budget)?;
        let boundaries: Vec<_> =
            requirements.iter().map(|r| boundaries(r, &family, budget)).collect::<Result<_, Error>>()?;
        if !stable.undecided().is_empty() {
            let message = "the stable set is undecided in places, and so are requirements";
            return Err(Diagnostic::error(Code::Require, message).into());
        }
        let mut intervals = Vec::new();
        for interval in stable.intervals() {
            budget.step("testing a sample of each cell");
            let cells = Cells { requirements, boundaries: &boundaries, family: &family, budget };
            intervals.extend(cells.within(interval)?);
        }
        Ok(RequiredSet { intervals, ..RequiredSet::default() })
    }

    /// The same of a loop behind holds whose open loop is a multiple of the parameter; `None` of another one, and where that way does not tell.
    fn required_of_gain(
        &self,
        requirements: &[Requirement],
        cut: &Cut,
        stable: &StableSet,
        budget: &Budget,
    ) -> Result<Option<RequiredSet>, Error> {
        if !self.model().has_holds() || requirements.iter().any(|r| matches!(r.rule(), Rule::DeadTime(_))) {
            return Ok(None);
        }
        budget.step("boundaries of the requirements");
        let found = GainFamily::of(self, cut, budget).and_then(|family| {
            let set = |family: GainFamily| family.required_set(requirements, stable, budget);
            family.map(set).transpose()
        });
        match found {
            Err(Error::Stopped(stopped)) if stopped.stop.is_precision() => Ok(None),
            found => found,
        }
    }

    /// A requirement on the roots of the closed loop, all of them as they are.
    fn on_roots(self: &Arc<Self>, requirement: &Requirement, budget: &Budget) -> Result<OnRoots, Error> {
        if let Rule::Modulus { .. } = requirement.rule()
            && (self.shape() != Shape::UnitDisc || !self.has_fixed_sample_time(budget)?)
        {
            let message = "a settling time is required of discrete loops with a sample time that is a number";
            return Err(Diagnostic::error(Code::Require, message).into());
        }
        let whole = self.without_region();
        let closed = if whole.free().is_empty() {
            let enclosed = |budget: &Budget| Ok(whole.enclosed_whole(budget)?.map(Some));
            whole.exact_or_enclosed(budget, |budget| whole.symbolic(budget), enclosed)?
        } else if whole.is_long(budget)? {
            match whole.enclosed_whole(budget)? {
                Some(p) => Some(p),
                None => whole.in_boxes(budget)?.symbolic(budget)?,
            }
        } else {
            whole.symbolic(budget)?
        };
        let found = closed.and_then(|p| OnRoots::of(requirement, &p, self.shape()));
        found.ok_or_else(|| not_decided(requirement))
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
        self.refuse_undamped(requirements, budget)?;
        budget.enter(|| {
            let stable = self.verdict(budget)?.value().verdict == Verdict::Stable;
            let is_at_cut = |r: &Requirement| r.needs_cut() && r.signals().is_none();
            let (margins, zero_loop) = match requirements.iter().any(is_at_cut) {
                true => {
                    let is_delay = requirements.iter().any(Requirement::is_delay_margin);
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
            let mut out = Vec::with_capacity(requirements.len());
            for requirement in requirements {
                if requirement.signals().is_some() {
                    let met = stable && self.is_norm_met(requirement, budget)?;
                    out.push(RequirementMet { requirement: requirement.clone(), margins: None, met });
                    continue;
                }
                let open_loop = margins.as_ref().map(|m| &m.open_loop).or(zero_loop.as_ref());
                let known = match margins.as_ref().and_then(|m| Some((m, m.stable.as_ref()?))) {
                    Some((all, stable)) => requirement.is_met_by(all, stable, budget)?,
                    None => None,
                };
                let met = match (requirement.rule(), &margins, known) {
                    _ if !stable => false,
                    (_, _, Some(met)) => met,
                    (Rule::DeadTime(least), Some(margins), _) => self.bears_with(margins, least, budget)?,
                    // A loop that is open at this point bears any dead time.
                    (Rule::DeadTime(_), None, _) => true,
                    (Rule::Sector(_) | Rule::Modulus { .. }, ..) => {
                        self.on_roots(requirement, budget)?.is_met_at(&Rational::ZERO, budget)?
                    }
                    _ => AtPoint::new(open_loop.expect("a margin is taken at a cut")).meets(requirement, budget)?,
                };
                out.push(RequirementMet { requirement: requirement.clone(), margins: margins.clone(), met });
            }
            Ok(out)
        })?
    }

    fn has_fixed_sample_time(&self, budget: &Budget) -> Result<bool, Error> {
        let step = self.algebra_over_symbols(budget)?.sample_time();
        Ok(step.is_some_and(|t| t.as_constant().is_some()))
    }
}

/// Where a requirement on margins of a rational loop may begin or cease to be met.
fn boundaries(
    requirement: &Requirement,
    family: &Family<UniPoly>,
    budget: &Budget,
) -> Result<Boundaries<UniPoly>, Error> {
    let mut found = family.boundaries(requirement, budget)?;
    found.zeros.push(family.undefined.clone());
    if found.zeros.iter().any(UniPoly::is_zero) || found.touches.is_zero() {
        return Err(not_decided(requirement));
    }
    Ok(found)
}

pub(super) fn not_decided(requirement: &Requirement) -> Error {
    let message = format!("the requirement {} is not decided for this loop", requirement.name());
    Diagnostic::error(Code::Require, message).help("a polynomial of its boundary vanishes for every value").into()
}
