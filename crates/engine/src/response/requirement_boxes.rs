//! Whether a loop is stable, or meets a requirement, at all points of a box of its free parameters at once.

use super::delay_boxes::{DelayAsked, DelayBoxes};
use super::over_box::{Certain, OverBox};
use super::requirement::{Requirement, Rule};
use crate::answer::Verdict;
use crate::error::Error;
use crate::problem::{Ask, Bound, Problem, Question, Region};
use crate::stability::boxes::{BoxPolynomial, DelayedFunction, MovingLooks, MovingPolynomial, same_count};
use crate::stability::{AtPoint, RootCount, Shape, count_roots};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::matrix::CharacteristicPolynomial;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{Poly, UniPoly};
use jurist_algebra::real::Real;
use std::sync::Arc;

/// A requirement, or stability itself, over boxes of any number of free parameters.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_algebra::number::Rational;
/// use jurist_engine::error::Source;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_engine::response::{OverPoints, RequirementBoxes};
/// // s^3 + a s^2 + b s + c is stable where a, c > 0 and a b > c.
/// let text = "time = 'continuous'\nparameters = { a = 2, b = 2, c = 1 }\nloop.characteristic = 's^3 + a*s^2 + b*s + c'\n";
/// let (model, _) = Model::from_toml(&Source::new("loop.toml", text))?;
/// let problem = model.ask().free("a").free("b").free("c").problem()?;
/// let budget = Budget::unlimited();
/// let box_of = |sides: [[i64; 2]; 3]| sides.map(|side| side.map(Rational::from));
/// let near = [2, 2, 1].map(Rational::from);
/// let stable = RequirementBoxes::of_stability(&problem, &near, &budget)?.unwrap();
/// assert_eq!(stable.look(&box_of([[3, 3], [3, 4], [1, 2]]), &budget)?, OverPoints::All);
/// assert_eq!(stable.look(&box_of([[1, 1], [1, 2], [8, 9]]), &budget)?, OverPoints::None);
/// // Some points of this box are stable, others are not.
/// assert_eq!(stable.look(&box_of([[1, 2], [1, 2], [1, 9]]), &budget)?, OverPoints::Open { middle: Some(false) });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RequirementBoxes {
    problem: Arc<Problem>,
    /// `None` where stability of a loop with dead time is asked, or a delay margin.
    over: Option<OverBox>,
    /// Where a delay margin is asked.
    delay: Option<DelayBoxes>,
    asked: Asked,
}

/// What a look at a box says of its points.
///
/// ```
/// use jurist_engine::response::OverPoints;
/// assert_ne!(OverPoints::All, OverPoints::Open { middle: Some(true) });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OverPoints {
    /// All stable points meet the requirement; of stability, all points are stable.
    All,
    /// No point does.
    None,
    /// Neither is proved.
    Open {
        /// Of stability, whether the middle of the box is stable, where that is known.
        middle: Option<bool>,
    },
}

impl OverPoints {
    /// Of what is the same for all points, where that is known.
    pub(super) fn of(is_met: Option<bool>) -> OverPoints {
        match is_met {
            Some(true) => OverPoints::All,
            Some(false) => OverPoints::None,
            None => OverPoints::Open { middle: None },
        }
    }
}

/// What is asked.
enum Asked {
    Stability(LoopFamily),
    Requirement { one: Box<Requirement>, at: Option<String> },
}

impl Asked {
    fn of(requirement: &Requirement, at: Option<&str>) -> Asked {
        Asked::Requirement { one: Box::new(requirement.clone()), at: at.map(str::to_owned) }
    }
}

/// A loop as the family that proves boxes of it.
enum LoopFamily {
    Rational(Box<BoxPolynomial>),
    Moving(Box<MovingLooks<Box<MovingPolynomial>>>),
    Delayed(Box<DelayedFunction>),
    /// A loop with constants that are not rational.
    Constants,
}

/// So often 1 is halved, or the loop's own frequency: regions that are wider by this are asked where the region of stability itself tells nothing.
const HALVINGS: [u32; 6] = [0, 2, 4, 6, 8, 10];

/// Work for the least distance to a circle at one point of a loop with dead time: a few of the usual ones.
const DISTANCE_WORK: u64 = 3_000_000;

/// In so many places between the region of stability and a root it is asked whether the count of roots beyond is the same in a box.
const OTHERS: u64 = 3;

/// Cells of frequency and parameters after which a box is rather halved.
const CELLS: usize = 96;

impl RequirementBoxes {
    /// Of a requirement, margins being taken at a cut; `near` is a point that tells how fast the loop is. `None` for a requirement that is not asked of
    /// boxes.
    ///
    /// Cost: the open loop in the free parameters; of a delay margin with one dead time more.
    ///
    /// # Errors
    /// As [`OpenLoop::of`](super::OpenLoop::of); [`Error::Refused`] for a loop with dead time.
    pub fn of(
        problem: &Arc<Problem>,
        requirement: &Requirement,
        at: Option<&str>,
        near: &[Rational],
        budget: &Budget,
    ) -> Result<Option<RequirementBoxes>, Error> {
        let asked = Asked::of(requirement, at);
        let (over, delay) = match requirement.rule() {
            Rule::DeadTime(least) => {
                let cut = requirement.cut(problem, at)?;
                let asked = DelayAsked { problem: &problem.without_region(), least, cut: &cut, near };
                (None, DelayBoxes::of(asked, budget)?)
            }
            _ => (OverBox::of(problem, requirement, at, near, budget)?, None),
        };
        let is_known = over.is_some() || delay.is_some();
        Ok(is_known.then(|| RequirementBoxes { problem: Arc::clone(problem), over, delay, asked }))
    }

    /// Of stability, in the region of the problem. `None` for a loop that is undefined everywhere.
    ///
    /// Cost: that of [`Problem::algebra_over_symbols`].
    ///
    /// # Errors
    /// As [`Problem::algebra_over_symbols`]; `E-dead-time` for dead times that boxes do not treat.
    pub fn of_stability(
        problem: &Arc<Problem>,
        near: &[Rational],
        budget: &Budget,
    ) -> Result<Option<RequirementBoxes>, Error> {
        let problem = &problem.in_boxes(budget)?;
        let algebra = problem.algebra_over_symbols(budget)?;
        let Some(d) = algebra.polynomial() else { return Ok(None) };
        let over = OverBox::of_stability(problem, near, budget)?;
        let family = if over.is_none() {
            let Some(family) = problem.delayed_family(near, budget)? else { return Ok(None) };
            LoopFamily::Delayed(Box::new(family))
        } else if algebra.symbols().is_empty() {
            // Where a sample time is not positive the model has no meaning.
            let poles = d.poles.iter().cloned().chain(problem.positive()).collect();
            let d = CharacteristicPolynomial { poles, ..d.clone() };
            let family = budget.enter(|| BoxPolynomial::over(&d, near.len(), problem.shape()))?;
            LoopFamily::Rational(Box::new(family))
        } else {
            let family = problem.moving_family(budget)?;
            let looks = |family| LoopFamily::Moving(Box::new(MovingLooks::of(Box::new(family))));
            family.map_or(LoopFamily::Constants, looks)
        };
        Ok(Some(RequirementBoxes { problem: Arc::clone(problem), over, delay: None, asked: Asked::Stability(family) }))
    }

    /// What is known of all points of a closed box without a look at any point; `None` where nothing is.
    ///
    /// Cost: Taylor models of the coefficients, and values on some hundred pieces of the circle.
    pub fn certain(&self, sides: &[[Rational; 2]]) -> Option<Certain> {
        self.over.as_ref()?.certain(sides)
    }

    /// Whether all stable points of a closed box meet the requirement, or no stable point does; of stability, whether all points are stable, or none is.
    ///
    /// Cost: that of [`RequirementBoxes::certain`], and at most one exact decision in the middle of the box; of stability up to four of them.
    ///
    /// # Errors
    /// When the budget runs out.
    pub fn look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<OverPoints, Exhausted> {
        if let Some(delay) = &self.delay {
            return delay.look(sides, budget);
        }
        let middle = || middle(sides);
        let known = match (self.by_family(sides, budget)?, &self.asked) {
            (Some(OverPoints::Open { .. }), Asked::Stability(LoopFamily::Delayed(_))) => {
                return Ok(OverPoints::Open { middle: self.is_stable(&middle(), None, budget)? });
            }
            (Some(OverPoints::Open { .. }), _) => None,
            (Some(told), _) => return Ok(told),
            (None, _) => budget.enter(|| self.certain(sides))?,
        };
        Ok(match (known, &self.asked) {
            (Some(Certain::Met), _) => OverPoints::All,
            (Some(Certain::Unmet), _) => OverPoints::None,
            (Some(Certain::Same), Asked::Stability(_)) => match self.is_stable(&middle(), None, budget)? {
                // No root crosses; that the loop is defined at all points is more.
                Some(true) if !budget.enter(|| self.is_defined(sides))? => OverPoints::Open { middle: Some(true) },
                told => OverPoints::of(told),
            },
            (Some(Certain::Same), Asked::Requirement { one, at }) => {
                // A point that is undefined tells nothing of its neighbours.
                match self.is_stable(&middle(), None, budget)? {
                    Some(true) => OverPoints::of(self.is_met(&middle(), one, at.as_deref(), budget)?),
                    other => OverPoints::of(other),
                }
            }
            (None, Asked::Requirement { .. }) => OverPoints::Open { middle: None },
            (None, Asked::Stability(_)) => match self.is_stable(&middle(), None, budget)? {
                Some(false) if self.has_root_beyond(sides, &middle(), budget)? => OverPoints::None,
                middle => OverPoints::Open { middle },
            },
        })
    }

    fn is_defined(&self, sides: &[[Rational; 2]]) -> bool {
        self.over.as_ref().is_some_and(|over| over.is_defined(sides))
    }

    /// The same with less work: an open box is not asked for more.
    ///
    /// # Errors
    /// When the budget runs out.
    pub(crate) fn short_look(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<OverPoints, Exhausted> {
        match self.by_family(sides, budget)? {
            Some(told) => Ok(told),
            None => self.look(sides, budget),
        }
    }

    /// What the family of loops proves of the stability of a box; `None` where there is none, or a requirement is asked.
    fn by_family(&self, sides: &[[Rational; 2]], budget: &Budget) -> Result<Option<OverPoints>, Exhausted> {
        let Asked::Stability(family) = &self.asked else { return Ok(None) };
        let is_unstable_by_signs = || match (family, &self.over) {
            (LoopFamily::Rational(family), _) => family.is_unstable_by_signs(sides),
            (_, over) => over.as_ref().is_some_and(|over| over.is_unstable_by_signs(sides)),
        };
        if let LoopFamily::Moving(looks) = family {
            // Its looks remember functions. Signs show that no point is stable, so they are not asked where one is.
            let is_unstable = || looks.is_stable_at(&middle(sides)) != Some(true) && is_unstable_by_signs();
            return Ok(Some(OverPoints::of(match looks.same_stability(sides, budget)? {
                None => budget.enter(is_unstable)?.then_some(false),
                told => told,
            })));
        }
        if budget.enter(is_unstable_by_signs)? {
            return Ok(Some(OverPoints::None));
        }
        let is_stable = |middle: &[Rational]| self.is_stable(middle, None, budget);
        Ok(Some(OverPoints::of(match family {
            LoopFamily::Rational(family) => same_count(family.as_ref(), sides, (CELLS, budget), is_stable)?,
            LoopFamily::Delayed(family) => same_count(family.as_ref(), sides, (CELLS, budget), is_stable)?,
            LoopFamily::Moving(_) | LoopFamily::Constants => return Ok(None),
        })))
    }

    /// Whether a stable point meets what is asked, by the look where that tells, else by the exact decision; `None` where that is not told.
    pub(crate) fn meets(&self, point: &[Rational], budget: &Budget) -> Result<Option<bool>, Exhausted> {
        let sides: Vec<[Rational; 2]> = point.iter().map(|x| [x.clone(), x.clone()]).collect();
        match (self.look(&sides, budget)?, &self.asked) {
            (OverPoints::All, _) => Ok(Some(true)),
            (OverPoints::None, _) => Ok(Some(false)),
            (OverPoints::Open { middle }, Asked::Stability(_)) => Ok(middle),
            (OverPoints::Open { .. }, Asked::Requirement { one, at }) if self.is_distance_with_dead_time() => {
                // Near to a touch it takes long, and may not be told.
                let part = budget.clone().within_work(DISTANCE_WORK);
                match self.is_met(point, one, at.as_deref(), &part) {
                    Err(_) if budget.check().is_ok() => Ok(None),
                    told => told,
                }
            }
            (OverPoints::Open { .. }, Asked::Requirement { one, at }) => self.is_met(point, one, at.as_deref(), budget),
        }
    }

    /// Of a requirement on a loop with dead time and one parameter, the only value in a short interval at which it begins or ceases to be met, or that
    /// there is none; `None` where neither is seen.
    pub(crate) fn only_end(&self, side: &[Rational; 2]) -> Option<Option<Real>> {
        self.over.as_ref()?.only_end(side)
    }

    fn is_distance_with_dead_time(&self) -> bool {
        self.over.as_ref().is_some_and(OverBox::is_distance_with_dead_time)
    }

    /// Whether each point of a box, the middle of which is not stable, has a root outside of a region that is wider than that of stability.
    fn has_root_beyond(
        &self,
        sides: &[[Rational; 2]],
        middle: &[Rational],
        budget: &Budget,
    ) -> Result<bool, Exhausted> {
        // The widest region that does not hold all roots of the middle.
        let (mut first, mut last) = (0, HALVINGS.len());
        while first < last {
            let k = (first + last) / 2;
            match self.is_stable(middle, Some(HALVINGS[k]), budget)? {
                Some(false) => last = k,
                _ => first = k + 1,
            }
        }
        let Some(halvings) = HALVINGS.get(last) else { return Ok(false) };
        // Between the region and the root. Another root may lie just there: halves of the box are asked somewhere else.
        let bits: u64 = sides.iter().map(|[low, high]| (high - low).denominator().bit_length()).sum();
        let halvings = halvings + 1 + (bits % OTHERS) as u32;
        let certain = || self.over.as_ref()?.certain_beyond(sides, Some(halvings));
        Ok(budget.enter(certain)? == Some(Certain::Same))
    }

    fn wider(&self, halvings: u32) -> Option<Region> {
        let by = self.over.as_ref()?.wider(halvings);
        match self.problem.region() {
            Region::HalfPlane(Bound::Number(decay)) => Some(Region::half_plane(decay - &by)),
            Region::Disc(Bound::Number(radius)) => Region::disc(radius + &(radius * &by)).ok(),
            Region::HalfPlane(Bound::Free) | Region::Disc(Bound::Free) => None,
        }
    }

    /// The question at a point.
    fn at(&self, point: &[Rational]) -> Question {
        let names = self.problem.free().iter().map(|free| free.name.clone());
        let question = self.problem.model().ask().set_all(self.problem.set().to_vec());
        question.set_all(names.zip(point.iter().cloned()))
    }

    /// Whether all roots of a point lie in the region of stability, or in one that is wider; `None` where that is not told.
    fn is_stable(&self, point: &[Rational], wider: Option<u32>, budget: &Budget) -> Result<Option<bool>, Exhausted> {
        if let Asked::Stability(LoopFamily::Rational(polynomial)) = &self.asked {
            return budget.enter(|| self.is_stable_there(polynomial, point, wider));
        }
        let region = match (&self.asked, wider) {
            (Asked::Requirement { .. }, _) => Some(Region::of(self.problem.time())),
            (Asked::Stability(_), None) => Some(self.problem.region().clone()),
            (Asked::Stability(_), Some(halvings)) => self.wider(halvings),
        };
        let Some(region) = region else { return Ok(None) };
        let found = self.at(point).within(region).problem().and_then(|problem| problem.verdict(budget));
        Ok(told(found)?.and_then(|answer| match answer.value().verdict {
            Verdict::Stable => Some(true),
            Verdict::Unstable => Some(false),
            Verdict::Marginal | Verdict::Undefined => None,
        }))
    }

    /// The same of a rational loop; `None` where it is undefined, loses its order or has a root on the boundary.
    fn is_stable_there(&self, polynomial: &BoxPolynomial, point: &[Rational], wider: Option<u32>) -> Option<bool> {
        if self.problem.positive().iter().any(|p| !p.eval(point).sign().is_gt()) {
            return Some(false);
        }
        let shape = self.problem.shape();
        let AtPoint::Defined { count, infinite: 0 } = polynomial.at(point) else { return None };
        let Some(halvings) = wider else { return told_by(&count) };
        let by = self.over.as_ref()?.wider(halvings);
        let p = Poly::new(polynomial.coefficients_in_region().iter().map(|c| c.eval(point)).collect());
        let moved = match shape {
            Shape::LeftHalfPlane => p.taylor_shift(&by),
            Shape::UnitDisc => p.compose(&Poly::new(vec![Rational::ZERO, Rational::ONE + by])),
        };
        told_by(&count_roots(&UniPoly::from_rational_poly(&moved).1, shape))
    }

    /// Whether a point meets a requirement; `None` where that is not told.
    fn is_met(
        &self,
        point: &[Rational],
        one: &Requirement,
        at: Option<&str>,
        budget: &Budget,
    ) -> Result<Option<bool>, Exhausted> {
        told(self.at(point).problem().and_then(|problem| problem.meets(one, at, budget)))
    }
}

fn middle(sides: &[[Rational; 2]]) -> Vec<Rational> {
    sides.iter().map(|[low, high]| low.midpoint(high)).collect()
}

fn told_by(count: &RootCount) -> Option<bool> {
    match (count.outside, count.on) {
        (0, 0) => Some(true),
        (0, _) => None,
        _ => Some(false),
    }
}

/// What was found, if it was; an end of the work is passed on.
fn told<T>(found: Result<T, Error>) -> Result<Option<T>, Exhausted> {
    match found {
        Ok(found) => Ok(Some(found)),
        Err(Error::Stopped(stopped)) if !stopped.stop.is_precision() => Err(stopped),
        Err(_) => Ok(None),
    }
}
