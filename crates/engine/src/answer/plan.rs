//! Which question an answer belongs to.

use super::{Answer, Body, Map, MapBoxes, ParametricTable, PointTable, PointVerdict, ToleranceAnswer};
use crate::coverage::Asked;
use crate::error::Error;
use crate::problem::Plan;
use crate::response::{Margins, Norm, PeakToPeak};
use crate::stability::StableSet;
use jurist_algebra::limits::Budget;

/// A value that answers a question of the table of what is answered.
///
/// ```
/// use jurist_engine::answer::{Answers, PointVerdict};
/// use jurist_engine::coverage::Asked;
/// assert_eq!(PointVerdict::ASKED, Asked::Verdict);
/// ```
pub trait Answers {
    /// The question.
    const ASKED: Asked;
}

macro_rules! answers {
    ($($answer:ty: $asked:ident,)+) => {
        $(impl Answers for $answer {
            const ASKED: Asked = Asked::$asked;
        })+
    };
}

answers! {
    PointVerdict: Verdict,
    StableSet: Intervals,
    Map: ExactMap,
    MapBoxes: BoxMap,
    Body: Slices,
    ToleranceAnswer: Tolerance,
    PointTable: Jury,
    ParametricTable: JuryInParameter,
    Margins: Margins,
    Norm: Norm,
    PeakToPeak: PeakToPeak,
}

impl<T: Answers> Answer<T> {
    /// How the question was decided: coefficient ring, symbols, order, method, and what is presupposed.
    ///
    /// ```
    /// use jurist_algebra::limits::Budget;
    /// use jurist_engine::model::Model;
    /// use jurist_engine::problem::Ask;
    /// let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited())?;
    /// assert_eq!(answer.plan(&Budget::unlimited())?.order, Some(6));
    /// # Ok::<(), jurist_engine::error::Error>(())
    /// ```
    ///
    /// Cost: nothing where the answer needed the characteristic polynomial, else that of it.
    ///
    /// # Errors
    /// As [`Problem::plan`](crate::problem::Problem::plan).
    pub fn plan(&self, budget: &Budget) -> Result<Plan, Error> {
        self.problem.plan(T::ASKED, budget)
    }
}
