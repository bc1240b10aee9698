//! The document that holds a model's limits fast: `jurist/lock/1`.

use super::end::{Bounds, End};
use super::number::{Exact, Named};
use super::schema_name;
use jurist_engine::answer::Answer;
use jurist_engine::stability::StableSet;
use serde::{Deserialize, Serialize};

schema_name!(LockName, "jurist/lock/1");

/// The limits of a model, and every number that they were computed from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Lock {
    /// The kind of document.
    pub schema: LockName,
    /// The model file.
    pub model: String,
    /// By which share of itself a limit may move.
    pub within: Exact,
    /// The constants and the nominal values of parameters, as they are written; those of other files as numbers.
    pub values: Named<String>,
    /// The limits.
    pub limits: Vec<LockedLimits>,
}

/// The stable set of one parameter, the others having their nominal values.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LockedLimits {
    /// The parameter.
    pub parameter: String,
    /// Its stable intervals, in ascending order.
    pub stable: Vec<Bounds<End>>,
}

impl Lock {
    /// Without limits yet.
    pub fn new(model: String, within: Exact, values: Named<String>) -> Lock {
        Lock { schema: LockName::V1, model, within, values, limits: Vec::new() }
    }
}

impl LockedLimits {
    /// Of an answer, with so many digits.
    pub fn new(answer: &Answer<StableSet>, digits: usize) -> LockedLimits {
        let problem = answer.problem();
        let stable = End::intervals(answer.value(), problem, digits);
        LockedLimits { parameter: problem.parameter().name.clone(), stable }
    }
}
