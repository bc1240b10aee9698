//! What is to be best over many gains: one of them, an expression, or a level. Each is a number that is compared, and from which one goes on by a share.

use crate::asked::Objective;
use crate::centre::Centre;
use crate::formula::Formula;
use crate::level_of_one::{is_without_end, scale};
use crate::lines::Lines;
use crate::parts::{Beside, Part, Parts};
use jurist_algebra::number::{Integer, Rational};
use jurist_engine::error::Error;
use jurist_engine::response::Level;
use std::rc::Rc;

/// A value of the gain, or of the level in its scale.
pub(crate) type Value = Rational;

/// What is to be best.
pub(crate) enum Target<'l> {
    Gain {
        gain: usize,
        is_greatest: bool,
        end: Rational,
        width: Rational,
    },
    /// No gains have a better value than the end.
    Formula {
        formula: &'l Formula,
        is_greatest: bool,
        end: Rational,
        width: Rational,
    },
    Level {
        level: Level,
        ends: [Rational; 2],
    },
    Centre(Rc<Centre>),
}

/// The first distance of a level from its worst end is halved, or grows, so often.
const DOUBLINGS: usize = 40;

/// Near to zero a share is one of the bounds, halved so often.
const SMALL: u64 = 20;

/// A step is as long as it is asked for within this power of one half.
const NEAR: u64 = 5;

impl<'l> Target<'l> {
    /// Of a question; `None` where nothing is to be best.
    ///
    /// # Errors
    /// `E-tune-objective` for an expression that divides by zero within the bounds.
    pub fn of(lines: &'l Lines<'_>, whole: &[[Rational; 2]]) -> Result<Option<Target<'l>>, Error> {
        let gain = |gain: usize, is_greatest: bool| {
            let range = lines.range(gain);
            let [low, high] = [&range.lower, &range.upper].map(|end| end.clone().expect("the bounds were looked at"));
            let width = &high - &low;
            Target::Gain { gain, is_greatest, end: if is_greatest { high } else { low }, width }
        };
        Ok(Some(match (&lines.asked.objective, &lines.formula) {
            (Objective::Greatest(k), _) => gain(*k, true),
            (Objective::Least(k), _) => gain(*k, false),
            (Objective::Level(level) | Objective::SettlingTime(level), _) => {
                Target::Level { level: *level, ends: scale(lines, *level) }
            }
            (Objective::Norm(_), _) => Target::Level { level: Level::Norm, ends: scale(lines, Level::Norm) },
            (Objective::Formula { is_greatest, .. }, Some(formula)) => {
                let [low, high] = formula.range_in_parts(whole, &lines.asked.gains)?;
                let width = &high - &low;
                let (is_greatest, end) = (*is_greatest, if *is_greatest { high } else { low });
                Target::Formula { formula, is_greatest, end, width }
            }
            (Objective::Tolerance(measure), _) => Target::Centre(Rc::new(Centre::new(*measure, &whole.to_vec()))),
            (Objective::Formula { .. } | Objective::Anything, _) => return Ok(None),
        }))
    }

    /// What asks boxes for a value, or for any.
    ///
    /// # Errors
    /// As [`Parts::level`].
    pub fn beside(&self, parts: &Parts<'_, '_>, goal: Option<&Value>) -> Result<Option<Beside<'l>>, Error> {
        Ok(match (self, goal) {
            (Target::Level { level, .. }, Some(scale)) => Some(Beside::Level(Box::new(parts.level(*level, scale)?))),
            (Target::Formula { formula, is_greatest, .. }, goal) => {
                Some(Beside::Formula { formula, goal: goal.cloned(), is_greatest: *is_greatest })
            }
            (Target::Centre(centre), Some(goal)) => {
                Some(Beside::Centre { centre: Rc::clone(centre), goal: goal.clone() })
            }
            (Target::Gain { .. }, _) | (Target::Level { .. } | Target::Centre(_), None) => None,
        })
    }

    fn is_rising(&self) -> bool {
        match self {
            Target::Gain { is_greatest, .. } | Target::Formula { is_greatest, .. } => *is_greatest,
            Target::Level { level, .. } => level.is_rising(),
            Target::Centre(_) => true,
        }
    }

    /// The value from which shares of a level, or of a tolerance, are counted.
    fn worst(&self) -> Rational {
        match self {
            Target::Level { level, ends } => if level.is_rising() { &ends[0] } else { &ends[1] }.clone(),
            Target::Centre(centre) => centre.measure.least(),
            Target::Gain { .. } | Target::Formula { .. } => Rational::ZERO,
        }
    }

    pub fn is_better(&self, a: &Value, b: &Value) -> bool {
        if self.is_rising() { a > b } else { a < b }
    }

    /// A value that is farther by a distance.
    fn farther(&self, value: &Value, by: &Rational) -> Value {
        if self.is_rising() { value + by } else { value - by }
    }

    /// A value that is better by a share; `None` where no point can have it.
    pub fn beyond(&self, value: &Value, gap: &Rational) -> Option<Value> {
        match self {
            Target::Gain { end, .. } | Target::Formula { end, .. } => {
                let goal = self.step(value, gap);
                (!self.is_better(&goal, end)).then_some(goal)
            }
            Target::Level { ends, .. } => {
                let goal = self.step(value, gap);
                (ends[0] < goal && goal < ends[1]).then_some(goal)
            }
            Target::Centre(_) => Some(self.step(value, gap)),
        }
    }

    fn step(&self, value: &Value, gap: &Rational) -> Value {
        let size = match self {
            Target::Gain { width, .. } | Target::Formula { width, .. } => {
                value.abs().max(width * &Rational::dyadic(&Integer::ONE, SMALL))
            }
            Target::Level { .. } | Target::Centre(_) => (value - self.worst()).abs(),
        };
        let by = size * gap;
        let (goal, near) = (self.farther(value, &by), &by * &Rational::dyadic(&Integer::ONE, NEAR));
        odd_near(&goal, &near)
    }

    /// A value that no point has since it is beyond the bound.
    pub fn beyond_end(&self) -> Value {
        match self {
            Target::Gain { end, .. } | Target::Formula { end, .. } => {
                self.step(end, &Rational::dyadic(&Integer::ONE, SMALL))
            }
            Target::Level { ends, .. } => ends[usize::from(self.is_rising())].clone(),
            Target::Centre(centre) => centre.measure.least(),
        }
    }

    /// The value as one of the level's scale.
    pub fn scale<'v>(&self, value: &'v Value) -> Option<&'v Rational> {
        matches!(self, Target::Level { .. } | Target::Centre(_)).then_some(value)
    }

    /// What of the parts has at least a value, and what has less.
    pub fn split(&self, parts: Vec<Part>, value: &Value) -> (Vec<Part>, Vec<Part>) {
        let Target::Gain { gain, is_greatest, .. } = self else { return (parts, Vec::new()) };
        let (mut beyond, mut below) = (Vec::new(), Vec::new());
        for part in parts {
            below.extend(part.clone().beyond(*gain, !*is_greatest, value));
            beyond.extend(part.beyond(*gain, *is_greatest, value));
        }
        (beyond, below)
    }

    /// A value beyond all of some parts; `None` of a level.
    pub fn best_of(&self, parts: &[Part]) -> Option<Value> {
        let ends: Vec<Rational> = match self {
            Target::Gain { gain, is_greatest, .. } => {
                parts.iter().map(|part| part.sides[*gain][usize::from(*is_greatest)].clone()).collect()
            }
            Target::Formula { formula, is_greatest, .. } => {
                let end = |part: &Part| Some(formula.range(&part.sides)?[usize::from(*is_greatest)].clone());
                parts.iter().map(end).collect::<Option<_>>()?
            }
            Target::Level { .. } | Target::Centre(_) => return None,
        };
        let best = if self.is_rising() { ends.iter().max() } else { ends.iter().min() }?;
        Some(self.step(best, &Rational::dyadic(&Integer::ONE, SMALL)))
    }

    /// The same, and no value beyond the bounds.
    pub fn best_within(&self, parts: &[Part]) -> Option<Value> {
        let best = self.best_of(parts)?;
        match self {
            Target::Gain { end, .. } | Target::Formula { end, .. } if self.is_better(&best, end) => Some(end.clone()),
            _ => Some(best),
        }
    }

    /// The value of a point; `None` of a level, and where there is none.
    fn own_value(&self, point: &[Rational]) -> Option<Value> {
        match self {
            Target::Gain { gain, .. } => Some(point[*gain].clone()),
            Target::Formula { formula, .. } => formula.at(point),
            Target::Level { .. } | Target::Centre(_) => None,
        }
    }

    /// A value of a point that was found to have another one at least.
    pub fn value_at(&self, point: &[Rational], least: &Value) -> Value {
        self.own_value(point).unwrap_or_else(|| least.clone())
    }

    /// A value that a point has, if it meets all and is better than another one.
    ///
    /// # Errors
    /// When the budget runs out.
    pub fn better_at(
        &self,
        parts: &Parts<'_, '_>,
        point: &[Rational],
        known: &Value,
        gap: &Rational,
    ) -> Result<Option<Value>, Error> {
        match self {
            Target::Gain { .. } | Target::Formula { .. } => {
                let Some(own) = self.own_value(point) else { return Ok(None) };
                let is_good = self.is_better(&own, known) && parts.is_met(point, None)?;
                Ok(is_good.then_some(own))
            }
            Target::Level { .. } | Target::Centre(_) => {
                let quarter = gap * &Rational::dyadic(&Integer::ONE, 2);
                let Some(next) = self.beyond(known, &quarter) else { return Ok(None) };
                if !parts.is_met(point, Some(&next))? {
                    return Ok(None);
                }
                self.raised(parts, point, next, quarter).map(Some)
            }
        }
    }

    /// A value of a level that a point has, from one that it has: a share is added that grows as long as the point has it.
    fn raised(&self, parts: &Parts<'_, '_>, point: &[Rational], value: Value, share: Rational) -> Result<Value, Error> {
        let (mut value, mut share) = (value, share);
        for _ in 0..DOUBLINGS {
            let Some(next) = self.beyond(&value, &share) else { break };
            if !parts.is_met(point, Some(&next))? {
                break;
            }
            value = next;
            share = &share + &share;
        }
        Ok(value)
    }

    /// A value that a point has that meets all; `None` where no value of the level is found.
    ///
    /// # Errors
    /// When the budget runs out.
    pub fn first_value(&self, parts: &Parts<'_, '_>, point: &[Rational]) -> Result<Option<Value>, Error> {
        let half = Rational::dyadic(&Integer::ONE, 1);
        let (mut distance, ends) = match self {
            Target::Gain { .. } | Target::Formula { .. } => return Ok(self.own_value(point)),
            Target::Level { level, ends } if !is_without_end(*level) => ((&ends[1] - &ends[0]) * &half, Some(ends)),
            Target::Level { ends, .. } => (Rational::ONE, Some(ends)),
            Target::Centre(_) => (Rational::ONE, None),
        };
        for _ in 0..DOUBLINGS {
            let value = self.farther(&self.worst(), &distance);
            let is_inside = ends.is_none_or(|ends| ends[0] < value && value < ends[1]);
            if is_inside && parts.is_met(point, Some(&value))? {
                let eighth = Rational::dyadic(&Integer::ONE, 3);
                return self.raised(parts, point, value, eighth).map(Some);
            }
            distance *= &half;
        }
        Ok(None)
    }
}

/// A number of few digits near to another one: an odd multiple of a power of two.
///
/// Short numbers are avoided: a best value is often one, and no box that holds its gains shows that they have not just this value.
fn odd_near(x: &Rational, distance: &Rational) -> Rational {
    let (two, half) = (Rational::from(2), Rational::dyadic(&Integer::ONE, 1));
    let mut unit = Rational::ONE;
    if !distance.sign().is_gt() {
        return x.clone();
    }
    while unit > *distance {
        unit = &unit * &half;
    }
    while &unit * &two <= *distance {
        unit = &unit * &two;
    }
    let steps = Rational::from(x.checked_div(&unit).expect("a power is not zero").floor());
    (steps + half) * unit
}
