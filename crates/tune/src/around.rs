//! Boxes of gains where more than a point is asked of each gain: all plants, or all gains within a tolerance.

use crate::centre::Centre;
use crate::for_all::{Sides, as_box};
use crate::parts::{Beside, Part, Parts, Seen};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_engine::error::Error;
use jurist_engine::response::{Everywhere, OverPoints, RequirementBoxes, everywhere};

/// More parts of a box are not looked at to prove it.
const MOST_PARTS: usize = 160;

impl Parts<'_, '_> {
    /// Whether all gains within a tolerance of a point meet all, as far as boxes prove it.
    pub fn is_met_around(&self, point: &[Rational], centre: &Centre, value: &Rational) -> Result<bool, Error> {
        if self.lines.budget.enter(|| centre.is_refuted(&as_box(point), value))? {
            return Ok(false);
        }
        let Some(sides) = centre.around(point, value) else { return Ok(false) };
        let tests: Vec<&RequirementBoxes> = self.tests.iter().collect();
        Ok(match everywhere(&tests, sides, MOST_PARTS, self.lines.budget)? {
            Everywhere::All => true,
            Everywhere::NotAt(bad) => {
                if self.is_proved_unmet(&bad)? {
                    centre.is_bad_at(self.nearer(bad, point)?);
                }
                false
            }
            Everywhere::Open => false,
        })
    }

    /// A bad point that is nearer to a middle, so that more boxes of middles have it within their tolerance.
    fn nearer(&self, bad: Vec<Rational>, middle: &[Rational]) -> Result<Vec<Rational>, Error> {
        /// Halvings of the way.
        const HALVINGS: usize = 6;
        let mut bad = bad;
        for i in 0..bad.len() {
            let mut other = bad.clone();
            other[i] = middle[i].clone();
            if self.is_proved_unmet(&other)? {
                bad = other;
            }
        }
        let mut good = middle.to_vec();
        for _ in 0..HALVINGS {
            let half: Vec<Rational> = bad.iter().zip(&good).map(|(a, b)| a.midpoint(b)).collect();
            if self.is_proved_unmet(&half)? { bad = half } else { good = half }
        }
        Ok(bad)
    }

    /// Whether a point is known not to meet all.
    fn is_proved_unmet(&self, point: &[Rational]) -> Result<bool, Error> {
        match self.lines.is_met_in_order(&crate::typed::named(self.lines, point), None) {
            Err(Error::Stopped(stopped)) if !stopped.stop.is_precision() => Err(Error::Stopped(stopped)),
            Err(_) => Ok(false),
            Ok(is_met) => Ok(!is_met),
        }
    }

    /// Whether a point meets all with every plant, as far as boxes of plants prove it.
    pub fn is_met_for_all(&self, point: &[Rational], scale: Option<&Rational>) -> Result<bool, Error> {
        let level = match (self.lines.asked.level(), scale) {
            (Some(level), Some(scale)) => Some(self.level(level, scale)?),
            _ => None,
        };
        let tests: Vec<&RequirementBoxes> = self.tests.iter().chain(&level).collect();
        // A plant that was bad for others is soonest bad for this one.
        for plant in self.plants.tried() {
            let sides = as_box(&[point, &plant].concat());
            for test in &tests {
                if matches!(
                    test.look(&sides, self.lines.budget)?,
                    OverPoints::None | OverPoints::Open { middle: Some(false) }
                ) {
                    self.plants.refuted_by(&plant);
                    return Ok(false);
                }
            }
        }
        let whole = as_box(point).into_iter().chain(self.plants.sides.iter().cloned()).collect();
        Ok(match everywhere(&tests, whole, MOST_PARTS, self.lines.budget)? {
            Everywhere::All => true,
            Everywhere::NotAt(bad) => {
                self.plants.refuted_by(&bad[point.len()..]);
                false
            }
            Everywhere::Open => false,
        })
    }

    /// The same with each of some plants: one of them is enough to refute a part.
    pub fn look_with_plants(&self, part: &Part, asked: Option<&Beside<'_>>) -> Result<Seen, Exhausted> {
        let budget = self.lines.budget;
        let (mut is_middle, mut is_beside) = (true, false);
        let formula = asked.filter(|asked| matches!(asked, Beside::Formula { .. }));
        match formula.map(|formula| formula.look(&part.sides, budget)).transpose()? {
            Some(OverPoints::None) => return Ok(Seen::Beside),
            Some(OverPoints::Open { middle }) => is_middle &= middle != Some(false),
            Some(OverPoints::All) | None => {}
        }
        for plant in self.plants.tried() {
            let sides: Sides = part.sides.iter().cloned().chain(as_box(&plant)).collect();
            for test in &self.tests {
                match test.look(&sides, budget)? {
                    OverPoints::None => {
                        self.plants.refuted_by(&plant);
                        return Ok(Seen::Refuted);
                    }
                    OverPoints::Open { middle } => is_middle &= middle != Some(false),
                    OverPoints::All => {}
                }
            }
            if let Some(Beside::Level(level)) = asked {
                match level.look(&sides, budget)? {
                    OverPoints::None => is_beside = true,
                    OverPoints::Open { middle } => is_middle &= middle != Some(false),
                    OverPoints::All => {}
                }
            }
        }
        Ok(if is_beside { Seen::Beside } else { Seen::Open { is_middle } })
    }
}
