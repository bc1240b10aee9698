//! Whether any gains of a box meet what is asked: the box is cut into parts until no point of any part meets it, or a point is found that does.

use crate::centre::Centre;
use crate::for_all::{Plants, as_box, middle};
use crate::formula::Formula;
use crate::lines::Lines;
use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::Rational;
use jurist_engine::coverage::CoefficientRing;
use jurist_engine::error::{Code, Diagnostic, Error};
use jurist_engine::problem::Problem;
use jurist_engine::response::{Certain, Level, LevelAsked, OverPoints, Requirement, RequirementBoxes};
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

/// A side is not halved more often.
const MOST_HALVINGS: u32 = 40;

/// Work of a part, in units of a budget.
const WORK: u64 = 2000;

/// A closed box of gains.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub sides: Vec<[Rational; 2]>,
    /// The numbers of what is not known to be met at all points.
    open: Vec<usize>,
    halvings: Vec<u32>,
}

impl Part {
    fn middle(&self) -> Vec<Rational> {
        middle(&self.sides)
    }

    /// What is left of it where a gain has at least a value, or at most one; `None` where nothing is.
    pub fn beyond(mut self, gain: usize, is_greatest: bool, value: &Rational) -> Option<Part> {
        let [low, high] = &mut self.sides[gain];
        if is_greatest {
            *low = low.clone().max(value.clone());
        } else {
            *high = high.clone().min(value.clone());
        }
        (*low <= *high).then_some(self)
    }
}

/// What a sweep over parts came to.
pub(crate) enum Sweep {
    /// A point that meets all, and the parts that were not refuted.
    Found(Vec<Rational>, Vec<Part>),
    /// No point of any part meets all: the parts that fail only what was asked beside the requirements.
    Refuted(Vec<Part>),
    /// The work ended; the parts that were not refuted.
    Stopped(Exhausted, Vec<Part>),
}

/// The parts that are left.
struct Queue {
    /// Halves of one with a stable middle.
    near: VecDeque<Part>,
    far: VecDeque<Part>,
    turn: usize,
}

impl Queue {
    /// Of three parts two are near to stable points, if there are any.
    fn next(&mut self) -> Option<Part> {
        self.turn += 1;
        let [first, second] = match self.turn % 3 {
            0 => [&mut self.far, &mut self.near],
            _ => [&mut self.near, &mut self.far],
        };
        first.pop_front().or_else(|| second.pop_front())
    }
}

/// How a part is seen.
pub(crate) enum Seen {
    Refuted,
    /// Only by what is asked beside the requirements.
    Beside,
    /// Whether its middle may meet all.
    Open {
        is_middle: bool,
    },
}

/// What is asked beside the requirements.
pub(crate) enum Beside<'l> {
    /// A number of the loop.
    Level(Box<RequirementBoxes>),
    /// At least a value of an expression, or at most one; any value where there is none.
    Formula { formula: &'l Formula, goal: Option<Rational>, is_greatest: bool },
    /// A tolerance of all gains.
    Centre { centre: Rc<Centre>, goal: Rational },
}

impl Beside<'_> {
    pub fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<OverPoints, Exhausted> {
        let (formula, goal, is_greatest) = match self {
            Beside::Level(boxes) => return boxes.look(sides, budget),
            Beside::Centre { centre, goal } => {
                let is_refuted = budget.enter(|| centre.is_refuted(sides, goal))?;
                return Ok(if is_refuted { OverPoints::None } else { OverPoints::Open { middle: None } });
            }
            Beside::Formula { formula, goal, is_greatest } => (formula, goal, *is_greatest),
        };
        let value = formula.at(&middle(sides));
        let Some(goal) = goal else { return Ok(OverPoints::Open { middle: Some(value.is_some()) }) };
        Ok(match budget.enter(|| formula.is_above(sides, goal))? {
            Some(is_above) if is_above == is_greatest => OverPoints::All,
            Some(_) => OverPoints::None,
            None => OverPoints::Open { middle: value.map(|x| if is_greatest { x >= *goal } else { x <= *goal }) },
        })
    }
}

/// Stability and the requirements of a question over boxes of its gains.
pub(crate) struct Parts<'l, 'a> {
    pub lines: &'l Lines<'a>,
    pub whole: Vec<[Rational; 2]>,
    pub plants: Plants,
    /// Where a tolerance is to be best.
    pub centre: Option<Rc<Centre>>,
    near: Vec<Rational>,
    has_dead_time: bool,
    pub tests: Vec<RequirementBoxes>,
    /// So many parts were looked at.
    pub looked: usize,
    /// So many parts are refuted.
    pub cells: usize,
    /// More parts are not looked at.
    pub most: usize,
}

impl<'l, 'a> Parts<'l, 'a> {
    /// Over the bounds of all gains.
    ///
    /// # Errors
    /// `E-tune-bounds` where a gain has no bounds, `E-require` for a requirement that is not asked of boxes.
    pub fn new(lines: &'l Lines<'a>, most: usize) -> Result<Parts<'l, 'a>, Error> {
        let whole = sides(lines)?;
        let plants = Plants::new(&lines.asked.for_all);
        let near: Vec<Rational> = middle(&whole).into_iter().chain(middle(&plants.sides)).collect();
        let problem = lines.problem()?;
        let has_dead_time = problem.coefficient_ring(lines.budget)? == CoefficientRing::DeadTime;
        let (tests, centre) = (Vec::new(), None);
        let mut parts = Parts { lines, whole, plants, centre, near, has_dead_time, tests, looked: 0, cells: 0, most };
        let stability = RequirementBoxes::of_stability(&problem, &parts.near, lines.budget)?;
        parts.tests.push(stability.ok_or_else(|| not_in_boxes("stability"))?);
        for requirement in &lines.asked.requirements.list {
            let test = parts.test(&problem, requirement)?;
            parts.tests.push(test);
        }
        Ok(parts)
    }

    fn test(&self, problem: &Arc<Problem>, requirement: &Requirement) -> Result<RequirementBoxes, Error> {
        let (at, budget) = (self.lines.at(), self.lines.budget);
        let test = RequirementBoxes::of(problem, requirement, at, &self.near, budget)?;
        test.ok_or_else(|| not_in_boxes(requirement.name()))
    }

    /// What asks for a level over boxes.
    pub fn level(&self, level: Level, scale: &Rational) -> Result<RequirementBoxes, Error> {
        let problem = self.lines.problem()?;
        Ok(match level.asked_between(scale, self.lines.asked.between())? {
            LevelAsked::Requirement(requirement) => self.test(&problem, &requirement)?,
            LevelAsked::Region(region) => {
                let problem = self.lines.problem_within(region)?;
                let test = RequirementBoxes::of_stability(&problem, &self.near, self.lines.budget)?;
                test.ok_or_else(|| not_in_boxes(level.name()))?
            }
        })
    }

    /// All gains within their bounds.
    pub fn all(&self) -> Part {
        let (open, halvings) = ((0..self.tests.len()).collect(), vec![0; self.whole.len()]);
        Part { sides: self.whole.clone(), open, halvings }
    }

    /// Whether a point meets all, with a value of the level; a point that is refused or undefined does not.
    ///
    /// # Errors
    /// When the budget runs out.
    pub fn is_met(&self, point: &[Rational], scale: Option<&Rational>) -> Result<bool, Error> {
        if let (Some(centre), Some(value)) = (&self.centre, scale) {
            return self.is_met_around(point, centre, value);
        }
        if !self.plants.is_one() {
            return self.is_met_for_all(point, scale);
        }
        let sides = as_box(point);
        // Margins at a point take longer than a look at a box that is one point.
        let is_unmet = |test: &RequirementBoxes| test.certain(&sides) == Some(Certain::Unmet);
        if self.lines.budget.enter(|| self.tests[1..].iter().any(is_unmet))? {
            return Ok(false);
        }
        // So does a delay margin beside dead time: all margins come with it.
        if let (Some(Level::DelayMargin), Some(asked), true) = (self.lines.asked.level(), scale, self.has_dead_time) {
            match self.level(Level::DelayMargin, asked)?.look(&sides, self.lines.budget)? {
                OverPoints::All => return self.is_met(point, None),
                OverPoints::None => return Ok(false),
                OverPoints::Open { .. } => {}
            }
        }
        let named = crate::typed::named(self.lines, point);
        match self.lines.is_met_in_order(&named, scale) {
            Err(Error::Stopped(stopped)) if !stopped.stop.is_precision() => Err(Error::Stopped(stopped)),
            Err(_) => Ok(false),
            found => found,
        }
    }

    /// Looks at parts, the widest ones first, and sooner at those with a stable point in the middle, until each is refuted or a point is found that meets all.
    ///
    /// # Errors
    /// Those of the question that are no end of the work.
    pub fn sweep(
        &mut self,
        parts: Vec<Part>,
        scale: Option<&Rational>,
        asked: Option<&Beside<'_>>,
    ) -> Result<Sweep, Error> {
        let mut queue = Queue { near: VecDeque::new(), far: parts.into(), turn: 0 };
        let mut beside = Vec::new();
        let rest = |beside: Vec<Part>, part: Part, queue: Queue| -> Vec<Part> {
            beside.into_iter().chain([part]).chain(queue.near).chain(queue.far).collect()
        };
        while let Some(mut part) = queue.next() {
            checkpoint(WORK);
            if self.looked >= self.most {
                let stopped = Exhausted::by_method(
                    format!("{} parts", self.most),
                    "a search with gains left that were not decided",
                );
                return Ok(Sweep::Stopped(stopped, rest(beside, part, queue)));
            }
            self.looked += 1;
            self.lines.budget.advance(self.cells as u64, (self.cells + queue.near.len() + queue.far.len()) as u64);
            let seen = match self.look(&mut part, asked) {
                Ok(seen) => seen,
                Err(stopped) => return Ok(Sweep::Stopped(stopped, rest(beside, part, queue))),
            };
            match seen {
                Seen::Refuted => self.cells += 1,
                Seen::Beside => {
                    self.cells += 1;
                    beside.push(part);
                }
                Seen::Open { is_middle } => {
                    let middle = part.middle();
                    let is_met = if is_middle { self.is_met(&middle, scale) } else { Ok(false) };
                    match is_met {
                        Ok(true) => return Ok(Sweep::Found(middle, rest(beside, part, queue))),
                        Ok(false) => {}
                        Err(Error::Stopped(stopped)) => {
                            return Ok(Sweep::Stopped(stopped, rest(beside, part, queue)));
                        }
                        Err(error) => return Err(error),
                    }
                    match self.halves(part) {
                        Ok(halves) if is_middle => queue.near.extend(halves),
                        Ok(halves) => queue.far.extend(halves),
                        Err(part) => {
                            let why = "a box of gains that is as small as boxes get";
                            let stopped = Exhausted::by_method(why, "a search with gains left that were not decided");
                            return Ok(Sweep::Stopped(stopped, rest(beside, *part, queue)));
                        }
                    }
                }
            }
        }
        Ok(Sweep::Refuted(beside))
    }

    /// What is met everywhere leaves the list of the part.
    fn look(&self, part: &mut Part, asked: Option<&Beside<'_>>) -> Result<Seen, Exhausted> {
        self.lines.budget.check()?;
        if !self.plants.is_one() {
            return self.look_with_plants(part, asked);
        }
        let (mut open, mut is_middle) = (Vec::new(), true);
        for &k in &part.open {
            match self.tests[k].look(&part.sides, self.lines.budget)? {
                OverPoints::All => {}
                OverPoints::None => return Ok(Seen::Refuted),
                OverPoints::Open { middle } => {
                    is_middle &= middle != Some(false);
                    open.push(k);
                }
            }
        }
        part.open = open;
        if let Some(asked) = asked {
            match asked.look(&part.sides, self.lines.budget)? {
                OverPoints::None => return Ok(Seen::Beside),
                OverPoints::All => {}
                OverPoints::Open { middle } => is_middle &= middle != Some(false),
            }
        }
        Ok(Seen::Open { is_middle })
    }

    /// Both halves of a part along the side that is the widest one as a share of the bounds.
    fn halves(&self, part: Part) -> Result<[Part; 2], Box<Part>> {
        let share = |i: usize| {
            let [low, high] = &part.sides[i];
            let [least, greatest] = &self.whole[i];
            (high - low).checked_div(&(greatest - least)).unwrap_or(Rational::ZERO)
        };
        let is_wide = |i: &usize| part.sides[*i][0] < part.sides[*i][1] && part.halvings[*i] < MOST_HALVINGS;
        // Of sides that are as wide as each other the first one.
        let axis = (0..part.sides.len()).filter(is_wide).rev().max_by_key(|i| share(*i));
        let Some(axis) = axis else { return Err(Box::new(part)) };
        let middle = part.sides[axis][0].midpoint(&part.sides[axis][1]);
        let half = |end: usize| {
            let mut half = part.clone();
            half.sides[axis][end] = middle.clone();
            half.halvings[axis] += 1;
            half
        };
        Ok([half(1), half(0)])
    }
}

/// The bounds of all gains.
fn sides(lines: &Lines<'_>) -> Result<Vec<[Rational; 2]>, Error> {
    let mut out = Vec::new();
    for (i, gain) in lines.asked.gains.iter().enumerate() {
        let range = lines.range(i);
        let (Some(low), Some(high)) = (&range.lower, &range.upper) else {
            let message = format!("'{}' has no bounds at both ends: a box of gains is searched", gain.name);
            let help = format!("give it bounds: --bound {}=LO..HI", gain.name);
            return Err(Diagnostic::error(Code::TuneBounds, message).help(help).into());
        };
        out.push([low.clone(), high.clone()]);
    }
    Ok(out)
}

fn not_in_boxes(name: &str) -> Error {
    let message = format!("{name} is not decided over boxes of gains");
    let help = "leave it out, or free one gain or two and fix the others: --set NAME=VALUE";
    Diagnostic::error(Code::Require, message).help(help).into()
}
