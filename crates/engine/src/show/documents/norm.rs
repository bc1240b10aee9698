//! The document `jurist/norm/1`.

use super::schema_name;
use super::{Answered, FrequencyOfPair, Number, PointQuestion, RootsByPlace};
use crate::answer::{self, Answer};
use crate::problem::Problem;
use crate::response::{self, Extreme};
use jurist_algebra::limits::Exhausted;
use serde::{Deserialize, Serialize};

schema_name!(NormName, "jurist/norm/1");

/// The peak gain of a closed-loop transfer function.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Norm {
    /// The kind of document.
    pub schema: NormName,
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// The norm.
    #[serde(flatten)]
    pub answer: Answered<NormFound, NormOpen>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NormFound {
    /// The input.
    pub input: String,
    /// The output.
    pub output: String,
    /// Whether the closed loop is stable.
    pub stable: bool,
    /// The verdict on the closed loop, and where its roots are.
    #[serde(flatten)]
    pub roots: RootsByPlace,
    /// The peak; `null` unless the loop is stable.
    pub norm: Option<PeakFound>,
}

/// The greatest modulus over all frequencies.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PeakFound {
    /// The value.
    pub value: Number,
    /// Whether it is attained; if not, it is approached as the frequency grows without end.
    pub attained: bool,
    /// The lowest frequency at which it is; all `null` where it is not attained, and where it is the same at all frequencies.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}

/// No answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NormOpen {
    /// Not known.
    pub norm: (),
}

impl Norm {
    /// The document, also of a norm that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, norm: Result<&response::Norm, &Exhausted>, digits: usize) -> Self {
        let found = |norm: &response::Norm| NormFound {
            input: norm.input.clone(),
            output: norm.output.clone(),
            stable: norm.verdict.verdict == answer::Verdict::Stable,
            roots: RootsByPlace::from(&norm.verdict),
            norm: norm.peak.as_ref().map(|peak| PeakFound {
                value: Number::new(&peak.value, digits),
                attained: !matches!(peak.extreme, Extreme::At { attained: false, .. }),
                frequency: FrequencyOfPair::new(digits, |bits| norm.frequency(problem.shape(), bits)),
            }),
        };
        Norm { schema: NormName::V1, question: PointQuestion::new(problem), answer: Answered::of(norm, found) }
    }
}

impl Answer<response::Norm> {
    /// The document `jurist/norm/1`, decimals to so many significant digits.
    pub fn json(&self, digits: usize) -> Norm {
        Norm::new(self.problem(), Ok(self.value()), digits)
    }
}
