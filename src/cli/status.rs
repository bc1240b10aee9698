//! Exit statuses.

pub(super) use jurist_engine::error::Failure;

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
    /// A certificate was rejected.
    Rejected = 4,
}

/// How a command ends.
pub(super) type Outcome = Result<Status, Failure>;
