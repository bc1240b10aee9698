//! For which values of one parameter a loop meets requirements on margins that are asked of boxes: with dead time, and on a delay margin.

use super::cells::{beyond, inside_of, outward, parts_beside, required_parts};
use super::over_symbols::{left_open, where_changed};
use super::required_set::not_decided;
use super::requirement::{Requirement, Rule};
use super::requirement_boxes::{OverPoints, RequirementBoxes};
use super::{RequiredEnd, RequiredSet};
use crate::error::Error;
use crate::problem::{Ask, Problem};
use crate::stability::subdivision::{BoxPart, Look, Octaves, Order, Tally, subdivide};
use crate::stability::{StableInterval, StableSet, UndecidedBracket};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::real::Real;
use std::sync::Arc;

/// Looks at parts of a stable interval at most.
const MOST_PIECES: usize = 300;

/// A part is halved so often at most.
const MOST_HALVINGS: u32 = 48;

/// A part that was halved so often is asked for its only end.
const FIRST_END: u32 = 8;

/// A part of an interval that is not told as a whole, and the only value in it at which something changes, where that is known.
struct OpenPart {
    lower: Rational,
    upper: Rational,
    end: Option<NamedEnd>,
}

/// A value at which a requirement begins or ceases to be met, and its name.
type NamedEnd = (Real, &'static str);

/// The requirements over intervals of the parameter.
struct DelayedSet<'a> {
    problem: &'a Arc<Problem>,
    requirements: &'a [Requirement],
    at: Option<&'a str>,
    boxes: Vec<RequirementBoxes>,
    budget: &'a Budget,
}

impl Problem {
    /// The parts of the stable set in which requirements on margins are met: short intervals are decided as a whole, and
    /// what is left has one end each, or stays open.
    pub(super) fn required_in_boxes(
        self: &Arc<Self>,
        requirements: &[Requirement],
        stable: &StableSet,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<RequiredSet, Error> {
        let parameter = &self.free()[0];
        let first = stable.intervals().first().map(|interval| interval.bare().sample(budget)).transpose()?;
        let near = parameter.nominal.clone().or(first).unwrap_or(Rational::ONE);
        let of = |r: &Requirement| {
            RequirementBoxes::of(self, r, at, std::slice::from_ref(&near), budget)?.ok_or_else(|| not_decided(r))
        };
        let boxes = requirements.iter().map(of).collect::<Result<Vec<_>, Error>>()?;
        let set = DelayedSet { problem: self, requirements, at, boxes, budget };
        let mut found = RequiredSet { undecided: stable.undecided().to_vec(), ..RequiredSet::default() };
        for interval in stable.intervals() {
            set.within(interval, &mut found)?;
        }
        found.sort();
        Ok(found)
    }
}

impl DelayedSet<'_> {
    /// The parts of a stable interval in which all requirements are met.
    fn within(&self, interval: &StableInterval, found: &mut RequiredSet) -> Result<(), Error> {
        let nominal = self.problem.free()[0].nominal.as_ref();
        let (lower, upper) = (outward(&interval.lower, true), outward(&interval.upper, false));
        let ends = [
            lower.clone().or_else(|| beyond(upper.as_ref(), nominal).map(|x| -x)),
            upper.clone().or_else(|| beyond(lower.as_ref(), nominal)),
        ];
        let [Some(from), Some(to)] = ends else {
            found.undecided.push(left_open(interval, self.requirements));
            return Ok(());
        };
        let mut brackets: Vec<UndecidedBracket> = Vec::new();
        let (mut ends, mut names): (Vec<Real>, Vec<&'static str>) = (Vec::new(), Vec::new());
        for part in self.open_parts(&from, &to)? {
            match part.end {
                Some((end, name)) => {
                    ends.push(end);
                    names.push(name);
                }
                None => brackets.push(self.bracket(Some(part.lower), Some(part.upper))),
            }
        }
        // What is beyond all that was looked at.
        if lower.is_none() {
            brackets.insert(0, self.bracket(None, Some(from)));
        }
        if upper.is_none() {
            brackets.push(self.bracket(Some(to), None));
        }
        parts_beside(interval, brackets, found, |part| {
            let inside = inside_of(part, &ends, self.budget)?;
            let is_closed = |_: usize, names: &[&'static str]| Ok(self.is_closed(names));
            let mut parts = required_parts(part, &inside, |value| self.unmet(value), is_closed, self.budget)?;
            // Farther away more may not be met.
            for end in parts.iter_mut().flat_map(|part| [&mut part.lower, &mut part.upper]).flatten() {
                if let RequiredEnd::Requirement { value, names: unmet, closed } = end
                    && let Some(k) = ends.iter().position(|known| known.is_same(value))
                {
                    *unmet = vec![names[k]];
                    *closed = self.is_closed(unmet);
                }
            }
            Ok(parts)
        })
    }

    /// A part in which it is not told where a requirement begins or ceases to be met.
    fn bracket(&self, lower: Option<Rational>, upper: Option<Rational>) -> UndecidedBracket {
        UndecidedBracket::new(lower, upper, where_changed(self.requirements))
    }

    /// Whether all requirements are met by all values of a closed interval, or not all by any.
    fn certain(&self, lower: &Rational, upper: &Rational) -> Result<Option<bool>, Exhausted> {
        let side = [[lower.clone(), upper.clone()]];
        let mut all = true;
        for boxes in &self.boxes {
            match boxes.look(&side, self.budget)? {
                OverPoints::None => return Ok(Some(false)),
                OverPoints::All => {}
                OverPoints::Open { .. } => all = false,
            }
        }
        Ok(all.then_some(true))
    }

    /// The parts of an interval that are not told as a whole, ascending and not touching.
    fn open_parts(&self, from: &Rational, to: &Rational) -> Result<Vec<OpenPart>, Error> {
        let budget = self.budget;
        budget.step("requirements for intervals of the parameter");
        let mut open: Vec<OpenPart> = Vec::new();
        let look = |Octaves(part): &mut Octaves, tally: Tally| {
            budget.advance(tally.looks().min(MOST_PIECES) as u64, MOST_PIECES as u64);
            let [lower, upper] = &part.sides[0];
            if tally.looks() >= MOST_PIECES {
                open.push(OpenPart { lower: lower.clone(), upper: upper.clone(), end: None });
                return Ok(Look::Decided(()));
            }
            let told = self.certain(lower, upper)?;
            if told.is_some() {
                return Ok(Look::<(), ()>::Decided(()));
            }
            let end = match part.halvings[0] {
                ..FIRST_END => None,
                _ => match self.only_end(lower, upper)? {
                    Some(None) => return Ok(Look::Decided(())),
                    found => found.flatten(),
                },
            };
            if end.is_none() && part.halvings[0] < MOST_HALVINGS {
                return Ok(Look::Cut(0));
            }
            open.push(OpenPart { lower: lower.clone(), upper: upper.clone(), end });
            Ok(Look::Decided(()))
        };
        let whole = Octaves(BoxPart::whole([[from.clone(), to.clone()]]));
        subdivide([whole], Order::Breadth, budget, look)?.ok();
        open.sort_by(|a, b| a.lower.cmp(&b.lower));
        let mut out: Vec<OpenPart> = Vec::new();
        for part in open {
            match out.last_mut().filter(|last| last.upper == part.lower) {
                // An end between two parts is in both, or in none.
                Some(last) => *last = OpenPart { lower: last.lower.clone(), upper: part.upper, end: None },
                None => out.push(part),
            }
        }
        let mut found = Vec::with_capacity(out.len());
        for mut part in out {
            if part.end.is_none() {
                match self.only_end(&part.lower, &part.upper)? {
                    Some(None) => continue,
                    end => part.end = end.flatten(),
                }
            }
            found.push(part);
        }
        Ok(found)
    }

    /// The only value in a short interval at which one of the requirements begins or ceases to be met, where it is the only one that is not told, or that
    /// there is none; `None` where neither is seen.
    fn only_end(&self, lower: &Rational, upper: &Rational) -> Result<Option<Option<NamedEnd>>, Exhausted> {
        let side = [lower.clone(), upper.clone()];
        let mut open = Vec::new();
        for (boxes, requirement) in self.boxes.iter().zip(self.requirements) {
            if let OverPoints::Open { .. } = boxes.look(std::slice::from_ref(&side), self.budget)? {
                open.push((boxes, requirement.name()));
            }
        }
        let [(one, name)] = open[..] else { return Ok(None) };
        let found = self.budget.enter(|| one.only_end(&side))?;
        Ok(found.map(|end| end.map(|end| (end, name))))
    }

    /// The names of what is not met at a stable value.
    fn unmet(&self, value: &Rational) -> Result<Vec<&'static str>, Error> {
        let side = [[value.clone(), value.clone()]];
        let mut unmet = Vec::new();
        for (boxes, requirement) in self.boxes.iter().zip(self.requirements) {
            let is_met = match boxes.look(&side, self.budget)? {
                OverPoints::All => true,
                OverPoints::None => false,
                OverPoints::Open { .. } => {
                    let name = self.problem.free()[0].name.clone();
                    let question = self.problem.model().ask().set_all(self.problem.set().to_vec());
                    question.set(name, value.clone()).problem()?.meets(requirement, self.at, self.budget)?
                }
            };
            if !is_met {
                unmet.push(requirement.name());
            }
        }
        Ok(unmet)
    }

    /// Whether at an end beyond which these are not met they are met yet: a gain margin asks for stability at its own ends too.
    fn is_closed(&self, names: &[&'static str]) -> bool {
        let is_open = |r: &&Requirement| names.contains(&r.name()) && matches!(r.rule(), Rule::Factors(_));
        !self.requirements.iter().any(|r| is_open(&r))
    }
}
