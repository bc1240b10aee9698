//! The document `jurist/margin-ranges/1`.

use super::{
    Answered, Bounds, End, IntervalsOpen, ParameterQuestion, RequirementAsked, Stable, UndecidedEnclosure, schema_name,
};
use crate::Document;
use jurist_algebra::limits::Exhausted;
use jurist_engine::answer::Answer;
use jurist_engine::problem::Problem;
use jurist_engine::response::{self, MarginLevel};
use serde::{Deserialize, Serialize};

schema_name!(MarginRangesName, "jurist/margin-ranges/1");

/// How much of each margin a loop has, by the value of one parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MarginRanges {
    /// The kind of document.
    pub schema: MarginRangesName,
    /// What was asked.
    #[serde(flatten)]
    pub question: ParameterQuestion,
    /// Where the loop is stable.
    #[serde(flatten)]
    pub answer: Answered<Stable, IntervalsOpen>,
    /// The margins; empty where the stable set is not known.
    pub margins: Vec<MarginRange>,
}

/// The values for which a loop has a margin of at least some size.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MarginRange {
    /// Which margin, and how much of it.
    #[serde(flatten)]
    pub asked: RequirementAsked,
    /// The intervals, ascending; `null` where this margin is not decided for such a loop.
    pub intervals: Option<Vec<Bounds<End>>>,
    /// Where nothing is known, in ascending order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub undecided: Vec<UndecidedEnclosure>,
    /// Why it is not decided.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl MarginRange {
    fn new(level: &MarginLevel, problem: &Problem, digits: usize) -> Self {
        let asked = (&level.requirement).into();
        match &level.found {
            Ok(set) => MarginRange {
                asked,
                intervals: Some(super::requirements::bounds(set, problem, digits)),
                undecided: set.undecided.iter().map(Into::into).collect(),
                why: None,
            },
            Err(why) => MarginRange { asked, intervals: None, undecided: Vec::new(), why: Some(why.clone()) },
        }
    }
}

impl MarginRanges {
    /// The document, also of an answer that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, found: Result<&response::MarginRanges, &Exhausted>, digits: usize) -> Self {
        let levels = found.iter().flat_map(|found| &found.levels);
        MarginRanges {
            schema: MarginRangesName::V1,
            question: ParameterQuestion::new(problem),
            margins: levels.map(|level| MarginRange::new(level, problem, digits)).collect(),
            answer: Answered::of(found, |found| Stable {
                stable: End::intervals(&found.stable, problem, digits),
                undecided: found.stable.undecided().iter().map(Into::into).collect(),
            }),
        }
    }
}

impl Document for Answer<response::MarginRanges> {
    type Json = MarginRanges;

    /// The document `jurist/margin-ranges/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        MarginRanges::new(self.problem(), Ok(self.value()), digits)
    }
}
