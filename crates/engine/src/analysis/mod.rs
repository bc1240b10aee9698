//! The questions asked of a loop, and their answers as plain values.
//!
//! A [`Loop`](crate::model::Loop) says what the system is, [`stability`](crate::stability) decides polynomials;
//! this room brings the two together: which parameters are kept, what the others are set to, which
//! region counts as stable.

mod answers;
mod frequency;
mod map;
mod map_boxes;
mod map_limits;
mod prepare;
mod question;
mod region;
mod table;

pub use answers::{Analysis, Decision, Intervals, PointVerdict, Verdict, analyze, intervals, verdict};
pub use frequency::{Frequency, frequency};
pub use map::{Axis, Map, map};
pub use map_boxes::{BoxRequest, MapAnswer, MapBoxes, MapMethod, map_by};
pub use map_limits::{MapLimit, RegionExtent};
pub use question::{DECAY, OneParameter, Point, RADIUS, Settings, asked, one_parameter};
pub use table::{PointTable, TableAnswer, parametric_table, point_table};

use crate::error::Error;
use jurist_algebra::limits::Exhausted;

/// Why a question has no answer.
#[derive(Debug)]
pub enum Failure {
    /// The question or the model was refused.
    Refused(Error),
    /// A budget ran out.
    Undecided(Exhausted),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Refused(error)
    }
}

impl From<crate::error::Diagnostic> for Failure {
    fn from(diagnostic: crate::error::Diagnostic) -> Self {
        Failure::Refused(diagnostic.into())
    }
}

impl From<Exhausted> for Failure {
    fn from(exhausted: Exhausted) -> Self {
        Failure::Undecided(exhausted)
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Failure::Refused(error) => error.fmt(f),
            Failure::Undecided(exhausted) => exhausted.fmt(f),
        }
    }
}

impl std::error::Error for Failure {}
