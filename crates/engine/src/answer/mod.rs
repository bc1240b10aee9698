//! Answers: a problem and what is exactly known of it.
//!
//! Whoever shows, proves or draws an answer reads it; nothing is decided or isolated again.

mod analysis;
mod body;
mod dead_time;
mod frequency;
mod hermitian;
mod map;
mod map_boxes;
mod map_limits;
mod plan;
mod rightmost;
mod roots;
mod roots_of_complex;
mod roots_on_boundary;
mod sensitivity;
mod sides;
mod stable;
mod stays;
mod table;
mod tolerance;
mod verdict;

pub use analysis::Analysis;
pub use body::{Body, BodySlice, Extreme, Extremes, SliceValues, Stretch, StretchEnd};
pub(crate) use dead_time::{stable_factors, stable_set_with_dead_time};
pub use frequency::Frequency;
pub use map::Map;
pub use map_boxes::{BoxRequest, MapBoxes, MapMethod, MapOrBoxes};
pub use map_limits::{MapLimit, RegionExtent};
pub use plan::Answers;
pub use roots::{BeyondRoots, ClosedLoopRoot, RIGHTMOST, Roots};
pub use sensitivity::{Sensitivities, Sensitivity};
pub(crate) use sides::Sides;
pub use table::{ParametricTable, PointTable};
pub use tolerance::{ExactFactor, LimitSide, RequiredBox, ToleranceAnswer, ToleranceLimit, ToleranceRequest, WorstEnd};
pub use tolerance::{SYMBOL_BITS, Truth};
pub use verdict::{DelayedRoots, PointVerdict, Verdict};

use crate::problem::Problem;
use std::sync::Arc;

/// An exact value and the problem that it answers.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::{Model, ParameterBuilder, Time};
/// use jurist_engine::problem::Ask;
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// let answer = model.ask().verdict(&Budget::unlimited())?;
/// assert_eq!(answer.problem().set(), [("K".to_owned(), 1.into())]);
/// assert_eq!(answer.value().count.unwrap().inside, 2);
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Answer<T> {
    problem: Arc<Problem>,
    value: T,
}

impl<T> Answer<T> {
    pub(crate) fn new(problem: Arc<Problem>, value: T) -> Self {
        Answer { problem, value }
    }

    /// The question.
    pub fn problem(&self) -> &Arc<Problem> {
        &self.problem
    }

    /// What is known.
    pub fn value(&self) -> &T {
        &self.value
    }

    /// What is known, by value.
    pub fn into_value(self) -> T {
        self.value
    }
}
