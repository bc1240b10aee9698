//! What is to be best over many gains: one of them, or a level. Both are a number that is compared, and from which one goes on by a share.

use crate::asked::Objective;
use crate::lines::Lines;
use crate::one_gain::{is_without_end, scale};
use crate::parts::{Part, Parts};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::simplest_between;
use jurist_engine::error::Error;
use jurist_engine::response::Level;

/// A value of the gain, or of the level in its scale.
pub(crate) type Value = Rational;

/// What is to be best.
pub(crate) enum Target {
    Gain { gain: usize, is_greatest: bool, end: Rational, width: Rational },
    Level { level: Level, ends: [Rational; 2] },
}

/// The first distance of a level from its worst end is halved, or grows, so often.
const DOUBLINGS: usize = 40;

/// Near to zero a share is one of the bounds, halved so often.
const SMALL: u64 = 20;

/// A step is as long as it is asked for within this power of one half.
const NEAR: u64 = 5;

impl Target {
    /// Of a question that asks for something.
    pub fn of(lines: &Lines<'_>) -> Target {
        let gain = |gain: usize, is_greatest: bool| {
            let range = lines.range(gain);
            let [low, high] = [&range.lower, &range.upper].map(|end| end.clone().expect("the bounds were looked at"));
            let width = &high - &low;
            Target::Gain { gain, is_greatest, end: if is_greatest { high } else { low }, width }
        };
        match lines.asked.objective {
            Objective::Greatest(k) => gain(k, true),
            Objective::Least(k) => gain(k, false),
            Objective::Level(level) => Target::Level { level, ends: scale(lines, level) },
            Objective::Anything => unreachable!("nothing is to be best"),
        }
    }

    fn is_rising(&self) -> bool {
        match self {
            Target::Gain { is_greatest, .. } => *is_greatest,
            Target::Level { level, .. } => level.is_rising(),
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
            Target::Gain { end, .. } => {
                let goal = self.step(value, gap);
                (!self.is_better(&goal, end)).then_some(goal)
            }
            Target::Level { ends, .. } => {
                let goal = self.step(value, gap);
                (ends[0] < goal && goal < ends[1]).then_some(goal)
            }
        }
    }

    fn step(&self, value: &Value, gap: &Rational) -> Value {
        let size = match self {
            Target::Gain { width, .. } => value.abs().max(width * &Rational::dyadic(&Integer::ONE, SMALL)),
            Target::Level { ends, .. } => (value - if self.is_rising() { &ends[0] } else { &ends[1] }).abs(),
        };
        let by = size * gap;
        let (goal, near) = (self.farther(value, &by), &by * &Rational::dyadic(&Integer::ONE, NEAR));
        // Of few digits: it is gone on from there.
        simplest_between(&(&goal - &near), &(&goal + &near)).unwrap_or(goal)
    }

    /// A value of a gain that no point has since it is beyond the bound.
    pub fn beyond_end(&self) -> Value {
        match self {
            Target::Gain { end, .. } => self.step(end, &Rational::dyadic(&Integer::ONE, SMALL)),
            Target::Level { ends, .. } => ends[usize::from(self.is_rising())].clone(),
        }
    }

    /// The value as one of the level's scale.
    pub fn scale<'v>(&self, value: &'v Value) -> Option<&'v Rational> {
        matches!(self, Target::Level { .. }).then_some(value)
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

    /// A value beyond all of some parts.
    pub fn best_of(&self, parts: &[Part]) -> Option<Value> {
        let Target::Gain { gain, is_greatest, .. } = self else { return None };
        let ends = parts.iter().map(|part| &part.sides[*gain][usize::from(*is_greatest)]);
        let best = if *is_greatest { ends.max() } else { ends.min() }?;
        Some(self.step(best, &Rational::dyadic(&Integer::ONE, SMALL)))
    }

    /// A value of a point that was found to have another one at least.
    pub fn value_at(&self, point: &[Rational], least: &Value) -> Value {
        match self {
            Target::Gain { gain, .. } => point[*gain].clone(),
            Target::Level { .. } => least.clone(),
        }
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
            Target::Gain { gain, .. } => {
                let is_good = self.is_better(&point[*gain], known) && parts.is_met(point, None)?;
                Ok(is_good.then(|| point[*gain].clone()))
            }
            Target::Level { .. } => {
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
        let Target::Level { level, ends } = self else {
            let Target::Gain { gain, .. } = self else { return Ok(None) };
            return Ok(Some(point[*gain].clone()));
        };
        let worst = if level.is_rising() { &ends[0] } else { &ends[1] };
        let whole = &ends[1] - &ends[0];
        let half = Rational::dyadic(&Integer::ONE, 1);
        let mut distance = if is_without_end(*level) { Rational::ONE } else { &whole * &half };
        for _ in 0..DOUBLINGS {
            let value = self.farther(worst, &distance);
            if ends[0] < value && value < ends[1] && parts.is_met(point, Some(&value))? {
                let eighth = Rational::dyadic(&Integer::ONE, 3);
                return self.raised(parts, point, value, eighth).map(Some);
            }
            distance *= &half;
        }
        Ok(None)
    }
}
