//! Exit statuses, and why a command ends without an answer.

use crate::error::{Diagnostic, Error};
use crate::limits::Exhausted;

/// What the program tells its caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Status {
    /// Answered, or it holds.
    Holds = 0,
    /// Answered, and it does not hold.
    DoesNotHold = 1,
    /// Bad usage or a bad model.
    BadInput = 2,
    /// Undecided within the budget.
    Undecided = 3,
}

/// Why a command ends without an answer.
#[derive(Debug)]
pub(super) enum Failure {
    /// The input was refused.
    Refused(Error),
    /// A budget ran out.
    Undecided(Exhausted),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Refused(error)
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Failure::Refused(Error::from(diagnostic))
    }
}

impl From<Exhausted> for Failure {
    fn from(exhausted: Exhausted) -> Self {
        Failure::Undecided(exhausted)
    }
}

/// How a command ends.
pub(super) type Outcome = Result<Status, Failure>;
