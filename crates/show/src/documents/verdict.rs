//! The document `jurist/verdict/1`.

use super::schema_name;
use super::{Answered, PointQuestion, RequirementFound};
use crate::Document;
use jurist_algebra::limits::Exhausted;
use jurist_engine::answer::{self, Answer, PointVerdict};
use jurist_engine::problem::Problem;
use serde::{Deserialize, Serialize};

schema_name!(VerdictName, "jurist/verdict/1");

/// The verdict at a point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Verdict {
    /// The kind of document.
    pub schema: VerdictName,
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// The verdict.
    #[serde(flatten)]
    pub answer: Answered<RootsByPlace, VerdictOpen>,
    /// The requirements and whether they are met; left out where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub requirements: Vec<RequirementFound>,
}

/// The verdict, and where the roots are; counts with multiplicity, `null` where the loop is undefined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RootsByPlace {
    /// In one word.
    pub verdict: answer::Verdict,
    /// The degree of the characteristic polynomial in all parameters.
    pub degree: usize,
    /// Roots strictly inside the region.
    pub inside: Option<usize>,
    /// Roots on its boundary.
    pub on: Option<usize>,
    /// Finite roots outside.
    pub outside: Option<usize>,
    /// Roots at infinity: by how much the degree drops at this point.
    pub infinite: Option<usize>,
}

/// No answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VerdictOpen {
    /// Not known.
    pub verdict: (),
}

impl From<&PointVerdict> for RootsByPlace {
    fn from(answer: &PointVerdict) -> Self {
        let count = answer.count;
        RootsByPlace {
            verdict: answer.verdict,
            degree: answer.degree,
            inside: count.map(|c| c.inside),
            on: count.map(|c| c.on).or(answer.delayed.map(|d| d.on)),
            outside: count.map(|c| c.outside).or(answer.delayed.and_then(|d| d.right)),
            infinite: count.map(|_| answer.infinite),
        }
    }
}

impl Verdict {
    /// The document, also of a verdict that the budget did not allow.
    pub fn new(problem: &Problem, verdict: Result<&PointVerdict, &Exhausted>) -> Self {
        Verdict {
            schema: VerdictName::V1,
            question: PointQuestion::new(problem),
            answer: Answered::of(verdict, RootsByPlace::from),
            requirements: Vec::new(),
        }
    }
}

impl Document for Answer<PointVerdict> {
    type Json = Verdict;

    /// The document `jurist/verdict/1`.
    fn json(&self, _digits: usize) -> Self::Json {
        Verdict::new(self.problem(), Ok(self.value()))
    }
}
