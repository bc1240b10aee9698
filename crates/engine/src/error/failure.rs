//! The three ways in which a question has no answer.

use super::{Diagnostic, Error};
use jurist_algebra::limits::Exhausted;
use std::fmt;

/// Why a question has no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Failure {
    /// The model or the question is refused: at least one diagnostic says where and what to do.
    Refused(Error),
    /// The model is undefined at the values set, whatever is left free; with the reason.
    Undefined(String),
    /// The budget ran out, or the work was cancelled.
    Stopped(Exhausted),
}

impl Failure {
    /// What stopped the work, if that is why there is no answer.
    pub fn stopped(self) -> Result<Exhausted, Failure> {
        match self {
            Failure::Stopped(exhausted) => Ok(exhausted),
            other => Err(other),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Refused(error)
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Failure::Refused(diagnostic.into())
    }
}

impl From<Exhausted> for Failure {
    fn from(exhausted: Exhausted) -> Self {
        Failure::Stopped(exhausted)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Refused(error) => error.fmt(f),
            Failure::Undefined(why) => write!(f, "the model is undefined at these values: {why}"),
            Failure::Stopped(exhausted) => exhausted.fmt(f),
        }
    }
}

impl std::error::Error for Failure {}
