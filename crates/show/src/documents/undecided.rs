//! Answers that the budget did not allow.

use jurist_algebra::limits::Exhausted;
use serde::{Deserialize, Serialize};

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Undecided {
    /// The budget that ran out, such as `time (2 s)`.
    pub budget: String,
    /// The last step that began and, where known, how much of it was done.
    pub reached: String,
}

impl From<&Exhausted> for Undecided {
    fn from(stopped: &Exhausted) -> Self {
        Undecided { budget: stopped.stop.to_string(), reached: stopped.reached() }
    }
}

/// What is known, or that nothing is: then the keys of the answer that come first are `null`, and `undecided` says why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Answered<T, N> {
    /// The answer.
    Known(T),
    /// None, with exit status 3.
    Undecided(Open<N>),
}

/// The keys that are `null`, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "{N}Undecided"))]
pub struct Open<N> {
    /// Keys of the answer, all `null`.
    #[serde(flatten)]
    pub keys: N,
    /// Why there is no answer.
    pub undecided: Undecided,
}

impl<N: Default> From<&Exhausted> for Open<N> {
    fn from(stopped: &Exhausted) -> Self {
        Open { keys: N::default(), undecided: stopped.into() }
    }
}

impl<T, N: Default> Answered<T, N> {
    /// The answer as it is written by `known`, or why there is none.
    pub(super) fn of<A>(answer: Result<A, &Exhausted>, known: impl FnOnce(A) -> T) -> Self {
        match answer {
            Ok(answer) => Answered::Known(known(answer)),
            Err(stopped) => Answered::Undecided(stopped.into()),
        }
    }
}
