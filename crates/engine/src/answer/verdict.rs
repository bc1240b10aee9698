//! Verdicts at a point.

use super::Answer;
use crate::error::Error;
use crate::problem::{Problem, Question};
use crate::stability::{AtPoint, RootCount};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use std::sync::Arc;

/// The verdict on a loop whose parameters all have values.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::answer::Verdict;
/// use jurist_engine::error::Error;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
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
    pub(super) fn with_dead_time(verdict: Verdict, degree: usize, on: usize, right: Option<usize>) -> PointVerdict {
        let delayed = Some(DelayedRoots { on, right });
        PointVerdict { verdict, undefined: None, degree, count: None, infinite: 0, delayed }
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
    /// Cost: that of [`Problem::algebra`], once, and of one root count
    /// ([`count_roots`](crate::stability::count_roots)).
    ///
    /// # Errors
    /// [`Error::Stopped`] when the budget runs out.
    ///
    /// # Panics
    /// When a parameter is free.
    pub fn verdict(self: &Arc<Self>, budget: &Budget) -> Result<Answer<PointVerdict>, Error> {
        budget.enter(|| {
            assert!(self.free().is_empty(), "a point has no free parameters");
            if let Some(delayed) = self.delayed(budget)? {
                let verdict = super::dead_time::verdict(self, delayed, budget)?;
                return Ok(Answer::new(Arc::clone(self), verdict));
            }
            let at = if !self.algebra_over_symbols(budget)?.symbols().is_empty() {
                budget.step("counting the roots");
                match self.symbolic(budget)? {
                    None => AtPoint::Undefined,
                    Some(p) => p.at(&Rational::ZERO, self.shape(), budget)?,
                }
            } else {
                match self.parametric(budget)? {
                    None => AtPoint::Undefined,
                    Some(p) => {
                        budget.step("counting the roots");
                        budget.enter(|| p.at(&Rational::ZERO, self.shape()))?
                    }
                }
            };
            let algebra = self.algebra_over_symbols(budget)?;
            let degree = algebra.formal_degree();
            let (verdict, count, infinite) = match at {
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
            let undefined = algebra.undefined().map(str::to_owned);
            Ok(Answer::new(
                Arc::clone(self),
                PointVerdict { verdict, undefined, degree, count, infinite, delayed: None },
            ))
        })?
    }
}
