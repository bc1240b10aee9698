//! Verdicts at a point.

use super::Answer;
use crate::error::Error;
use crate::problem::{FromNumbers, Problem, Question};
use crate::stability::boxes::Witness;
use crate::stability::{AtPoint, RootCount, Shape};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;
use std::sync::Arc;

/// The verdict on a loop whose parameters all have values.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::Verdict;
/// use jurist_engine::error::Error;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let at = |value: i32| Ok::<_, Error>(model.ask().set("K", value).verdict(&Budget::unlimited())?.value().verdict);
/// assert_eq!((at(1)?, at(2)?, at(3)?), (Verdict::Stable, Verdict::Marginal, Verdict::Unstable));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// All roots strictly inside.
    Stable,
    /// None outside, at least one on the boundary.
    Marginal,
    /// At least one root outside or at infinity.
    Unstable,
    /// An expression of the model divides by zero, a block loses its order, or the loop is not well posed.
    Undefined,
}

impl Verdict {
    /// The name used in all output.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Stable => "stable",
            Verdict::Marginal => "marginal",
            Verdict::Unstable => "unstable",
            Verdict::Undefined => "undefined",
        }
    }
}

/// The verdict at one point, with the exact root count.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let answer = model.ask().set("K", 2).verdict(&Budget::unlimited())?;
/// let verdict = answer.value(); // z^2 - z + 1
/// assert_eq!((verdict.degree, verdict.count.unwrap().on, verdict.infinite), (2, 2, 0));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PointVerdict {
    /// The verdict.
    pub verdict: Verdict,
    /// Why the loop is undefined at the point, where that is known.
    pub undefined: Option<String>,
    /// The degree of the polynomial in all parameters.
    pub degree: usize,
    /// Finite roots by place; `None` at an undefined point.
    pub count: Option<RootCount>,
    /// Roots that have left through infinity.
    pub infinite: usize,
    /// What is counted of a loop with dead time, whose roots to the left are infinitely many; `count` is `None` then.
    pub delayed: Option<DelayedRoots>,
    /// Whether an odd number of real roots lies beyond the boundary's point 1, or to the right of its point on the real axis:
    /// the loop grows without oscillation, as with positive feedback at rest.
    pub drifts: bool,
}

/// The roots of a loop with dead time on the imaginary axis and to the right of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DelayedRoots {
    /// On the axis.
    pub on: usize,
    /// To the right; `None` where infinitely many lie there or come as near to the axis as one likes.
    pub right: Option<usize>,
}

impl PointVerdict {
    /// The verdict on a loop with dead time.
    pub(super) fn with_dead_time(degree: usize, on: usize, right: Option<usize>) -> PointVerdict {
        let verdict = match (right, on) {
            (Some(0), 0) => Verdict::Stable,
            (Some(0), _) => Verdict::Marginal,
            _ => Verdict::Unstable,
        };
        let delayed = Some(DelayedRoots { on, right });
        PointVerdict { verdict, undefined: None, degree, count: None, infinite: 0, delayed, drifts: false }
    }

    /// Halves all counts of a complex loop, in which each root was counted together with its conjugate.
    pub(crate) fn without_conjugates_if(self, is_complex: bool) -> PointVerdict {
        if !is_complex {
            return self;
        }
        let half =
            |RootCount { inside, on, outside }| RootCount { inside: inside / 2, on: on / 2, outside: outside / 2 };
        let (degree, infinite) = (self.degree / 2, self.infinite / 2);
        let delayed =
            self.delayed.map(|DelayedRoots { on, right }| DelayedRoots { on: on / 2, right: right.map(|n| n / 2) });
        PointVerdict { degree, infinite, count: self.count.map(half), delayed, ..self }
    }

    /// The root count of a witness as a verdict; answers hold counted ones only.
    pub fn of_witness(witness: &Witness, problem: &Problem) -> PointVerdict {
        let algebra = problem.evaluated();
        let degree = algebra.map_or(0, |algebra| algebra.formal_degree());
        let found = PointVerdict::of(witness.at.clone().unwrap_or(AtPoint::Undefined), degree);
        found.without_conjugates_if(algebra.is_some_and(|algebra| algebra.is_complex()))
    }

    /// The verdict where the polynomial of this formal degree has these roots.
    pub(crate) fn of(at: AtPoint, degree: usize) -> PointVerdict {
        let (verdict, count, infinite) = match at {
            AtPoint::Delayed { on, right } => return PointVerdict::with_dead_time(degree, on, right),
            AtPoint::Undefined => (Verdict::Undefined, None, 0),
            AtPoint::Zero => (Verdict::Unstable, Some(RootCount::default()), degree),
            AtPoint::Defined { count, infinite } => {
                let verdict = match (count.outside + infinite, count.on) {
                    (0, 0) => Verdict::Stable,
                    (0, _) => Verdict::Marginal,
                    _ => Verdict::Unstable,
                };
                (verdict, Some(count), infinite)
            }
        };
        PointVerdict { verdict, undefined: None, degree, count, infinite, delayed: None, drifts: false }
    }
}

impl Question {
    /// The verdict with every parameter at its set or nominal value.
    ///
    /// Cost: that of [`Problem::verdict`].
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::answer::Verdict;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// let answer = Model::drive().ask().set("K_pwm", 551).verdict(&Budget::unlimited()).unwrap();
    /// assert_eq!(answer.value().verdict, Verdict::Unstable);
    /// assert_eq!(answer.value().count.unwrap().outside, 2);
    /// ```
    ///
    /// # Errors
    /// [`Error`]: refused as [`Question::problem`], or stopped.
    ///
    /// # Panics
    /// When a name is free.
    pub fn verdict(self, budget: &Budget) -> Result<Answer<PointVerdict>, Error> {
        Problem::verdict(&self.problem()?, budget)
    }
}

impl Problem {
    /// The verdict at the point that the values of all parameters are.
    ///
    /// A loop with functions, as behind holds, is decided by enclosures of its numbers, unless it is so near to the boundary that these do not tell; any
    /// other by exact algebra.
    ///
    /// Cost: that of [`Problem::algebra`], once, and of one root count
    /// ([`count_roots`](crate::stability::count_roots)); without that algebra where enclosures decide.
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn verdict(self: &Arc<Self>, budget: &Budget) -> Result<Answer<PointVerdict>, Error> {
        budget.enter(|| {
            assert!(self.free().is_empty(), "a point has no free parameters");
            let found = match self.roots_in_numbers(budget) {
                // What divides by zero is found again, and said.
                Ok(None) | Err(Error::Undefined(_)) => self.verdict_exactly(budget)?,
                Ok(Some(FromNumbers::Known { at, degree, drifts, is_complex })) => {
                    PointVerdict { drifts, ..PointVerdict::of(at, degree) }.without_conjugates_if(is_complex)
                }
                Ok(Some(FromNumbers::Open(question))) => match self.verdict_exactly(budget) {
                    Err(Error::Stopped(stopped)) if stopped.open.is_none() => {
                        return Err(Error::Stopped(stopped.with_open(&question)));
                    }
                    found => found?,
                },
                Err(failure) => return Err(failure),
            };
            Ok(Answer::new(Arc::clone(self), found))
        })?
    }

    /// The verdict by exact algebra: signs of numbers and identities between them.
    pub(crate) fn verdict_exactly(&self, budget: &Budget) -> Result<PointVerdict, Error> {
        if let Some(delayed) = self.delayed(budget)? {
            return super::dead_time::verdict(self, delayed, budget);
        }
        let mut drifts = false;
        let at = if !self.algebra_over_symbols(budget)?.symbols().is_empty() {
            budget.step("counting the roots");
            match self.symbolic(budget)? {
                None => AtPoint::Undefined,
                Some(p) => {
                    drifts = match p.has_odd_real_roots_beyond(&Rational::ZERO, self.shape(), budget) {
                        // It is no more than a remark.
                        Err(stopped) if stopped.stop.is_precision() => false,
                        found => found?,
                    };
                    p.at(&Rational::ZERO, self.shape(), budget)?
                }
            }
        } else {
            match self.parametric(budget)? {
                None => AtPoint::Undefined,
                Some(p) => {
                    budget.step("counting the roots");
                    drifts = has_odd_real_roots_beyond(&p.specialised(&Rational::ZERO), self.shape());
                    budget.enter(|| p.at(&Rational::ZERO, self.shape()))?
                }
            }
        };
        let algebra = self.algebra_over_symbols(budget)?;
        let undefined = algebra.undefined().map(str::to_owned);
        let found = PointVerdict { undefined, drifts, ..PointVerdict::of(at, algebra.formal_degree()) };
        Ok(found.without_conjugates_if(algebra.is_complex()))
    }
}

/// Whether the sign of a polynomial changes oddly often beyond the point where the real axis leaves the region to the right.
fn has_odd_real_roots_beyond(p: &UniPoly, shape: Shape) -> bool {
    let end = match shape {
        Shape::UnitDisc => Rational::ONE,
        Shape::LeftHalfPlane => Rational::ZERO,
    };
    p.leading().is_some_and(|leading| p.sign_at(&end) == leading.sign().reverse() && p.sign_at(&end).is_ne())
}
