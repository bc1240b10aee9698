//! The document `jurist/analyze/1`.

use super::schema_name;
use super::{Intervals, Verdict};
use crate::Document;
use jurist_engine::answer;
use serde::{Deserialize, Serialize};

schema_name!(AnalysisName, "jurist/analyze/1");

/// The verdict at the nominal point, and the stable set of each parameter, the others nominal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Analysis {
    /// The kind of document.
    pub schema: AnalysisName,
    /// The verdict; `null` where a parameter has no value.
    pub verdict: Option<Verdict>,
    /// The stable set of each parameter that is not set and whose companions all have values.
    pub parameters: Vec<Intervals>,
}

impl Document for answer::Analysis {
    type Json = Analysis;

    /// The document `jurist/analyze/1`.
    fn json(&self, digits: usize) -> Self::Json {
        let verdict = self.verdict.as_ref().map(|(problem, verdict)| Verdict::new(problem, verdict.as_ref()));
        let sets = self.sets.iter().map(|(problem, set)| Intervals::new(problem, set.as_ref(), digits));
        Analysis { schema: AnalysisName::V1, verdict, parameters: sets.collect() }
    }
}
