//! The three ways in which a question has no answer.

use super::{Diagnostic, Diagnostics};
use jurist_algebra::limits::Exhausted;
use std::fmt;

/// Why a question has no answer.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::problem::Ask;
/// use jurist_model::error::{Code, Error};
/// use jurist_model::{Model, ParameterBuilder, Time};
/// let (model, _) = Model::builder(Time::Discrete)
///     .parameter(ParameterBuilder::new("K").nominal("1"))
///     .characteristic("z^2 - z + K/2")
///     .build()?;
/// match model.ask().free("k").stable_set(&Budget::unlimited()) {
///     Err(Error::Refused(diagnostics)) => assert_eq!(diagnostics.code(), Code::UnknownParameter),
///     other => panic!("{other:?}"),
/// }
/// assert!(matches!(model.ask().verdict(&Budget::with_work(0)), Err(Error::Stopped(_))));
/// # Ok::<(), jurist_model::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The model or the question is refused: at least one diagnostic says where and what to do.
    Refused(Diagnostics),
    /// The model is undefined at the values set, whatever is left free; with the reason.
    Undefined(String),
    /// The budget ran out, or the work was cancelled.
    Stopped(Exhausted),
}

impl Error {
    /// What stopped the work, if that is why there is no answer.
    ///
    /// # Errors
    /// The error itself, where it is another one.
    pub fn stopped(self) -> Result<Exhausted, Error> {
        match self {
            Error::Stopped(exhausted) => Ok(exhausted),
            other => Err(other),
        }
    }
}

impl From<Diagnostics> for Error {
    fn from(error: Diagnostics) -> Self {
        Error::Refused(error)
    }
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        Error::Refused(diagnostic.into())
    }
}

impl From<Exhausted> for Error {
    fn from(exhausted: Exhausted) -> Self {
        Error::Stopped(exhausted)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Refused(error) => error.fmt(f),
            Error::Undefined(why) => write!(f, "the model is undefined at these values: {why}"),
            Error::Stopped(exhausted) => exhausted.fmt(f),
        }
    }
}

impl std::error::Error for Error {}
