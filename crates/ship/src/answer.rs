//! All that is asked of a controller as it is stored, together.

use crate::asked::Asked;
use crate::fewest::Fewest;
use crate::format::{Fixed, Format, Rounding};
use crate::limits::LimitsByBits;
use crate::ranges::{Ranges, WorstInput};
use crate::shipped::{Shipped, of_stored_loop};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_engine::answer::{Answer, PointVerdict, ToleranceAnswer, Verdict};
use jurist_engine::error::Error;
use jurist_engine::problem::Problem;
use jurist_engine::response::{Margins, RequirementMet, Requirements};
use jurist_engine::stability::Range;
use std::sync::Arc;

/// An answer, or why there is none: refused in words, or stopped.
pub type Part<T> = Result<T, Error>;

/// A part, stopped where its work ends anywhere in it: the others stand.
fn part<T>(work: impl FnOnce() -> Part<T>, budget: &Budget) -> Part<T> {
    budget.enter(work).unwrap_or_else(|stopped| Err(stopped.into()))
}

/// What is known of one of both loops.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Point {
    /// The verdict.
    pub verdict: Answer<PointVerdict>,
    /// The margins at the controller's output, or where the requirements take them.
    pub margins: Part<Answer<Margins>>,
    /// The requirements.
    pub requirements: Vec<RequirementMet>,
}

/// What is known of a controller as it is stored.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ShipAnswer {
    /// Both loops.
    pub shipped: Shipped,
    /// The loop as it is written.
    pub exact: Point,
    /// The loop as it is stored.
    pub rounded: Point,
    /// Whether every rounding holds; `None` where nothing is rounded.
    pub every_rounding: Option<Part<Answer<ToleranceAnswer>>>,
    /// The fewest bits, where they were asked for.
    pub fewest: Option<Part<Fewest>>,
    /// The limits of a parameter by bits, where they were asked for.
    pub limits: Option<Part<LimitsByBits>>,
    /// The worst input, where it was asked for.
    pub worst_input: Option<WorstInput>,
    /// The ranges of signals; `None` where the stored loop is not stable, and where nothing is said of signals.
    pub ranges: Option<Part<Ranges>>,
}

/// What is asked for beside the stored loop.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Beside {
    /// The fewest bits.
    pub fewest: bool,
    /// The parameter whose limits are asked for with more and more bits, and its domain where it is not the model's.
    pub limits_of: Option<(String, Option<Range>)>,
    /// The worst input.
    pub worst_input: bool,
}

/// Whether the controller does what it is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// The stored loop is stable, meets its requirements, and its signals stay in their ranges.
    Yes,
    /// Not so.
    No,
    /// Not decided.
    Open,
}

impl ShipAnswer {
    /// Everything about a controller. The question's region is that of the problem.
    ///
    /// Cost: two verdicts, margins and requirements each; a proof over a box; [`Shipped::ranges`]; what is asked for [beside](Beside).
    ///
    /// # Errors
    /// As [`Shipped::new`] and [`Problem::verdict`].
    ///
    /// # Panics
    /// When a name is free.
    pub fn of(
        problem: &Arc<Problem>,
        asked: Asked,
        requirements: &Requirements,
        beside: &Beside,
        budget: &Budget,
    ) -> Result<ShipAnswer, Error> {
        budget.step("the stored controller");
        let shipped = Shipped::new(problem, asked, budget)?;
        let at = requirements.at.clone().or_else(|| shipped.asked.outputs.first().cloned());
        let point = |problem: &Arc<Problem>| -> Result<Point, Error> {
            let verdict = problem.verdict(budget)?;
            let margins = problem.margins(at.as_deref(), &Rational::ZERO, budget);
            let requirements = problem.requirements_met(&requirements.list, requirements.at.as_deref(), budget)?;
            Ok(Point { verdict, margins, requirements })
        };
        budget.step("both loops");
        let (exact, rounded) = (point(&shipped.exact)?, point(&shipped.rounded).map_err(of_stored_loop)?);
        budget.step("every rounding");
        let list = &requirements.list;
        let every_rounding =
            part(|| shipped.every_rounding(list, requirements.at.as_deref(), budget), budget).transpose();
        let fewest = beside.fewest.then(|| shipped.fewest_of(every_rounding.as_ref(), requirements, budget)).flatten();
        let limits_of = beside.limits_of.as_ref();
        let limits = limits_of.map(|(name, domain)| shipped.limits_by_bits(name, domain.as_ref(), budget));
        // What was asked for by its name is refused, and not left out.
        if let Some(Err(error @ Error::Refused(_))) = &limits {
            return Err(error.clone());
        }
        budget.step("ranges of signals");
        let is_about_signals = shipped.asked.signal.is_some() || !shipped.asked.inputs.is_empty();
        let is_stable = rounded.verdict.value().verdict == Verdict::Stable;
        let ranges =
            (is_about_signals && is_stable).then(|| part(|| shipped.ranges(budget), budget).transpose()).flatten();
        let worst_input = match &ranges {
            Some(Ok(ranges)) if beside.worst_input => ranges.worst_input(&shipped.asked.inputs, budget)?,
            _ => None,
        };
        Ok(ShipAnswer { worst_input, shipped, exact, rounded, every_rounding, fewest, limits, ranges })
    }

    /// Whether the controller does what it is to do.
    pub fn holds(&self) -> Holds {
        let is_stable = self.rounded.verdict.value().verdict == Verdict::Stable;
        if !is_stable || !self.rounded.requirements.iter().all(|found| found.met) {
            return Holds::No;
        }
        match &self.ranges {
            None => Holds::Yes,
            Some(Err(Error::Stopped(_))) => Holds::Open,
            // Where ranges are refused nothing was asked that could not hold.
            Some(Err(_)) => Holds::Yes,
            Some(Ok(ranges)) => {
                let held = ranges.nodes.iter().filter(|node| node.limit.is_some() && node.greatest.is_some());
                let states: Vec<Option<bool>> = held.map(|node| node.holds).collect();
                match states {
                    states if states.contains(&Some(false)) => Holds::No,
                    states if states.contains(&None) => Holds::Open,
                    _ => Holds::Yes,
                }
            }
        }
    }

    /// The work that was stopped first, if some was.
    pub fn stopped(&self) -> Option<&Exhausted> {
        let of = |error: &'_ Error| matches!(error, Error::Stopped(_));
        let parts = [
            self.exact.margins.as_ref().err(),
            self.rounded.margins.as_ref().err(),
            self.every_rounding.as_ref().and_then(|part| part.as_ref().err()),
            self.fewest.as_ref().and_then(|part| part.as_ref().err()),
            self.limits.as_ref().and_then(|part| part.as_ref().err()),
            self.ranges.as_ref().and_then(|part| part.as_ref().err()),
        ];
        parts.into_iter().flatten().filter(|error| of(error)).find_map(|error| match error {
            Error::Stopped(stopped) => Some(stopped),
            _ => None,
        })
    }
}

impl Shipped {
    /// The fewest bits; the box is that of rounding to nearest, whatever the mode is.
    fn fewest_of(
        &self,
        every: Option<&Part<Answer<ToleranceAnswer>>>,
        requirements: &Requirements,
        budget: &Budget,
    ) -> Option<Part<Fewest>> {
        let Format::Fixed(fixed) = self.asked.format else { return None };
        budget.step("fewest bits");
        let at = requirements.at.as_deref();
        let with_nearest = || -> Result<Option<Fewest>, Error> {
            let asked =
                Asked { format: Format::Fixed(Fixed { rounding: Rounding::Nearest, ..fixed }), ..self.asked.clone() };
            let shipped = Shipped { asked, ..self.clone() };
            let own = match every {
                Some(Ok(answer)) if fixed.rounding.error_in_halves() == (-1, 1) => Some(answer.clone()),
                _ => shipped.every_rounding(&requirements.list, at, budget)?,
            };
            own.map_or(Ok(None), |answer| shipped.fewest(answer.value(), &requirements.list, at, budget))
        };
        with_nearest().transpose()
    }
}
