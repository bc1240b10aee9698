//! The best value over a box of many gains, between one that some gains have and one that none have.

use crate::answer::{Best, Optimum, Outcome, Place};
use crate::climb::climb;
use crate::level_of_one::{bracketed, is_unbounded_at, not_found};
use crate::lines::Lines;
use crate::one_gain::{GAIN, nothing};
use crate::parts::{Part, Parts, Sweep};
use crate::target::{Target, Value};
use jurist_algebra::limits::{Exhausted, apart};
use jurist_algebra::number::Rational;
use jurist_engine::error::Error;
use jurist_engine::response::Level;
use std::rc::Rc;

/// More parts are not looked at.
const MOST_PARTS: usize = 1 << 20;

/// The first gap, and what each is of the one before.
const FIRST_GAP: (i64, i64) = (1, 2);
const FINER: (i64, i64) = (1, 8);

/// Dead times as powers of a half: a gain that bears one of them is looked for where the first one bears none.
const SHORT_DELAYS: [u64; 2] = [10, 30];

/// The best of what is asked over many gains.
///
/// # Errors
/// As `Parts::new`.
pub(crate) fn best(lines: &Lines<'_>) -> Result<Outcome, Error> {
    let mut parts = Parts::new(lines, MOST_PARTS)?;
    lines.budget.step("gains that meet all requirements");
    let whole = vec![parts.all()];
    let target = Target::of(lines, &parts.whole)?;
    if let Some(Target::Centre(centre)) = &target {
        parts.centre = Some(Rc::clone(centre));
    }
    let asked = target.as_ref().map(|target| target.beside(&parts, None)).transpose()?.flatten();
    let (point, rest) = match parts.sweep(whole, None, asked.as_ref())? {
        Sweep::Refuted(_) => {
            return Ok(Outcome::Infeasible { conflict: Vec::new(), cells: Some(parts.cells) });
        }
        Sweep::Stopped(stopped, rest) => {
            if !stopped.stop.is_budget()
                && let Some(nothing) = never_stable(lines)?
            {
                return Ok(nothing);
            }
            let proved = apart(|| target.as_ref().and_then(|target| target.best_within(&rest)));
            return Ok(Outcome::Open { stopped, proved });
        }
        Sweep::Found(point, rest) => (point, rest),
    };
    let Some(target) = target else { return Ok(Optimum::some(point).into()) };
    let mut search = Search { parts, target, point, value: None, proved: None, is_unbounded: false };
    let stopped = match lines.part(|| search.narrow(rest)) {
        Ok(stopped) => stopped,
        Err(Error::Stopped(stopped)) => Some(stopped),
        Err(error) => return Err(error),
    };
    Ok(apart(|| search.outcome(stopped)).into())
}

/// That one gain is stable nowhere, which boxes do not tell where a bound is marginal.
fn never_stable(lines: &Lines<'_>) -> Result<Option<Outcome>, Error> {
    let asked = lines.asked;
    // What is required may be met with equality, on a bound alone.
    if asked.gains.len() != 1 || !asked.for_all.is_empty() || !asked.requirements.list.is_empty() {
        return Ok(None);
    }
    let set = lines.set(GAIN, None, None)?.into_value();
    Ok(nothing(&set).filter(|nothing| matches!(nothing, Outcome::Infeasible { .. })))
}

/// Whether no gains meet all; `None` where so many parts do not tell.
///
/// # Errors
/// As [`best`].
pub(crate) fn is_infeasible(lines: &Lines<'_>, most: usize) -> Result<bool, Error> {
    let mut parts = Parts::new(lines, most)?;
    let whole = vec![parts.all()];
    match parts.sweep(whole, None, None)? {
        Sweep::Refuted(_) => Ok(true),
        Sweep::Stopped(stopped, _) if stopped.stop.is_budget() => Err(stopped.into()),
        Sweep::Stopped(..) | Sweep::Found(..) => Ok(false),
    }
}

/// A search for the best value.
struct Search<'l, 'a> {
    parts: Parts<'l, 'a>,
    target: Target<'l>,
    /// The best point that is known, and a value that it has at least.
    point: Vec<Rational>,
    value: Option<Value>,
    /// No point has this value.
    proved: Option<Value>,
    /// Whether the best point has every value.
    is_unbounded: bool,
}

impl Search<'_, '_> {
    /// Narrows the bracket, from a wide gap to the one that is asked for.
    fn narrow(&mut self, rest: Vec<Part>) -> Result<Option<Exhausted>, Error> {
        let budget = self.parts.lines.budget;
        budget.step("better gains");
        let first = self.point.clone();
        self.value = self.target.first_value(&self.parts, &first)?;
        if self.value.is_none() {
            // Near to gains that bear none no box is refuted: there is no bracket.
            if self.finds_some_delay()? {
                self.improve()?;
            }
            return Ok(if self.has_every_value()? { None } else { Some(not_found()) });
        }
        self.improve()?;
        if self.has_every_value()? {
            return Ok(None);
        }
        let share = |(a, b): (i64, i64)| Rational::new(a.into(), b.into());
        let (mut gap, least) = (share(FIRST_GAP), self.parts.lines.asked.gap.clone());
        let mut open = rest;
        loop {
            gap = gap.max(least.clone());
            budget.step(&format!("that no gains are better by {}", jurist_algebra::number::to_decimal(&gap, 2)));
            match self.prove(open, &gap)? {
                Ok(next) => open = next,
                Err(stopped) => return Ok(Some(stopped)),
            }
            if gap <= least || self.is_unbounded {
                return Ok(None);
            }
            gap *= share(FINER);
        }
    }

    /// Looks for a point that bears some delay, where the first one bears none: the modulus of its open loop is one or more at high frequencies. False
    /// where no point is found.
    fn finds_some_delay(&mut self) -> Result<bool, Error> {
        if self.parts.lines.asked.level() != Some(Level::DelayMargin) {
            return Ok(false);
        }
        for bits in SHORT_DELAYS {
            let short: Value = Rational::dyadic(&1.into(), bits);
            let beside = self.target.beside(&self.parts, Some(&short))?;
            let whole = vec![self.parts.all()];
            if let Sweep::Found(point, _) = self.parts.sweep(whole, self.target.scale(&short), beside.as_ref())? {
                self.value = self.target.first_value(&self.parts, &point)?;
                self.point = point;
                return Ok(self.value.is_some());
            }
        }
        Ok(false)
    }

    /// Whether the best point has every value of a margin; it is not looked for beside other plants.
    fn has_every_value(&mut self) -> Result<bool, Error> {
        let lines = self.parts.lines;
        if let Some(level) = lines.asked.level().filter(|_| self.parts.plants.is_one()) {
            self.is_unbounded = is_unbounded_at(lines, level, &self.point)?;
        }
        Ok(self.is_unbounded)
    }

    /// Proves that no gains are better by a gap, finding better ones where there are some. Returns the parts in which better ones by less may be, or what
    /// ended the work.
    fn prove(&mut self, open: Vec<Part>, gap: &Rational) -> Result<Result<Vec<Part>, Exhausted>, Error> {
        let mut aside = Vec::new();
        let mut open = open;
        loop {
            let value = self.value.clone().expect("a value was found");
            let Some(goal) = self.target.beyond(&value, gap) else {
                // Beyond the bounds there is nothing to refute.
                open.extend(aside);
                return Ok(Ok(open));
            };
            let (asked, below) = self.target.split(open, &goal);
            aside.extend(below);
            let beside = self.target.beside(&self.parts, Some(&goal))?;
            match self.parts.sweep(asked, self.target.scale(&goal), beside.as_ref())? {
                Sweep::Refuted(beside) => {
                    self.proved = Some(goal);
                    aside.extend(beside);
                    return Ok(Ok(aside));
                }
                Sweep::Found(point, rest) => {
                    self.value = Some(self.target.value_at(&point, &goal));
                    self.point = point;
                    self.improve()?;
                    open = rest;
                    open.append(&mut aside);
                    if self.has_every_value()? {
                        return Ok(Ok(open));
                    }
                }
                Sweep::Stopped(stopped, rest) => {
                    apart(|| self.seen_so_far(&rest, &goal));
                    return Ok(Err(stopped));
                }
            }
        }
    }

    /// Where a gain or an expression is to be best, no better value than that of the best part that is left; other parts have none beyond the goal.
    fn seen_so_far(&mut self, rest: &[Part], goal: &Value) {
        let best = self.target.best_of(rest);
        let best = best.map(|value| if self.target.is_better(&value, goal) { value } else { goal.clone() });
        if let Some(value) = best
            && self.proved.as_ref().is_none_or(|known| self.target.is_better(known, &value))
        {
            self.proved = Some(value);
        }
    }

    /// Better points near to the best one, and a value that is near to what the last of them has.
    fn improve(&mut self) -> Result<(), Error> {
        let (parts, target) = (&self.parts, &self.target);
        let (point, value) = (&mut self.point, &mut self.value);
        let start = point.clone();
        let gap = &parts.lines.asked.gap;
        climb(parts, start, &mut |there| {
            let known = value.clone().expect("a value was found");
            let Some(better) = target.better_at(parts, there, &known, gap)? else { return Ok(false) };
            *value = Some(better);
            *point = there.to_vec();
            Ok(true)
        })
    }

    fn outcome(self, stopped: Option<Exhausted>) -> Optimum {
        let Search { parts, target, point, value, proved, is_unbounded } = self;
        let cells = Some(parts.cells);
        let Some(found) = value else {
            return Optimum { stopped, cells, ..Optimum::some(point) };
        };
        let places = || point.iter().map(|x| Place::Exact(x.clone().into())).collect();
        let on_bounds = on_bounds(&parts, &point);
        let (best, stopped, attained) = match &target {
            Target::Level { .. } if is_unbounded => (Best::Unbounded, None, None),
            Target::Level { level, .. } => {
                let (best, stopped) = bracketed(*level, &found, proved, stopped);
                (best, stopped, None)
            }
            Target::Centre(_) => match proved {
                Some(proved) => (Best::Between([found.clone(), proved]), stopped, None),
                None => (Best::Nothing, stopped.or_else(|| Some(not_found())), None),
            },
            Target::Gain { end, .. } | Target::Formula { end, .. } if found == *end => {
                (Best::Exact(end.clone().into()), None, Some(true))
            }
            Target::Gain { .. } | Target::Formula { .. } => {
                let proved = proved.unwrap_or_else(|| target.beyond_end());
                (Best::Between([found.clone(), proved]), stopped, None)
            }
        };
        let binding = match &target {
            Target::Level { .. } if is_unbounded => Vec::new(),
            Target::Level { level, .. } => on_bounds.into_iter().chain([level.name().to_owned()]).collect(),
            // Other gains may be on their bounds by chance.
            Target::Gain { gain, .. } if attained.is_some() => vec![bound_of(&parts, *gain)],
            Target::Gain { .. } | Target::Formula { .. } | Target::Centre(_) => on_bounds,
        };
        // Where nothing limits it, no number is what the gains have.
        let has = Some(found).filter(|_| !is_unbounded);
        Optimum { attained, binding, stopped, cells, ..Optimum::new(best, places(), point.clone(), has) }
    }
}

/// The gains of a point that are on their bounds.
fn on_bounds(parts: &Parts<'_, '_>, point: &[Rational]) -> Vec<String> {
    let all = point.iter().zip(&parts.whole).enumerate();
    all.filter(|(_, (x, sides))| sides.contains(x)).map(|(gain, _)| bound_of(parts, gain)).collect()
}

fn bound_of(parts: &Parts<'_, '_>, gain: usize) -> String {
    crate::sets::bound_of(&parts.lines.asked.gains[gain].name)
}
