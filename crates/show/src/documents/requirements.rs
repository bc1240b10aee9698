//! What is required, in documents.

use super::{Bounds, End};
use crate::documents::{Intervals, ParameterQuestion};
use crate::required_value;
use jurist_engine::answer::Answer;
use jurist_engine::problem::Problem;
use jurist_engine::response::{RequiredEnd, RequiredSet, Requirement, RequirementMet};
use serde::{Deserialize, Serialize};

/// A requirement on margins.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequirementAsked {
    /// Its name, a key of `[require]`: `phase_margin`.
    pub name: String,
    /// What is required, as it was asked for.
    pub required: String,
}

/// A requirement at a point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequirementFound {
    /// What is required.
    #[serde(flatten)]
    pub asked: RequirementAsked,
    /// The margin, rounded: a factor, degrees, or a number; `null` where it has no bound, for a damping, and without stability.
    pub value: Option<String>,
    /// Whether it is met.
    pub met: bool,
}

impl From<&Requirement> for RequirementAsked {
    fn from(requirement: &Requirement) -> Self {
        RequirementAsked { name: requirement.name().to_owned(), required: requirement.required() }
    }
}

impl RequirementFound {
    /// To so many digits.
    pub fn new(found: &RequirementMet, digits: usize) -> Self {
        RequirementFound { asked: (&found.requirement).into(), value: required_value(found, digits), met: found.met }
    }
}

impl RequirementFound {
    /// A requirement that is met where all roots are in the region asked for.
    pub fn of_region(name: &str, required: &str, met: bool) -> Self {
        let asked = RequirementAsked { name: name.to_owned(), required: required.to_owned() };
        RequirementFound { asked, value: None, met }
    }
}

impl Intervals {
    /// The document `jurist/intervals/1`, with `require`, and `requirement` at ends.
    pub fn of_required(answer: &Answer<RequiredSet>, requirements: &[Requirement], digits: usize) -> Intervals {
        let problem = answer.problem();
        let for_all = answer.value().for_all.iter().map(Into::into).collect();
        let document = Intervals::of_bounds(
            ParameterQuestion::new(problem),
            bounds(answer.value(), problem, digits),
            &answer.value().undecided,
            requirements.iter().map(Into::into).collect(),
        );
        Intervals { for_all, ..document }
    }
}

/// The intervals of a set that meets requirements.
pub(super) fn bounds(set: &RequiredSet, problem: &Problem, digits: usize) -> Vec<Bounds<End>> {
    let end = |end: &Option<RequiredEnd>| match end.as_ref()? {
        RequiredEnd::Stability(end) => Some(End::new(end, problem, digits)),
        RequiredEnd::Requirement { value, names, closed } => {
            Some(End::of_requirement(value, names.join("+"), *closed, problem, digits))
        }
    };
    set.intervals.iter().map(|i| Bounds { lower: end(&i.lower), upper: end(&i.upper) }).collect()
}
