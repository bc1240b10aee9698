//! The document `jurist/norm/1`.

use super::number::enclosure;
use super::schema_name;
use super::{Answered, Enclosure, Exact, FrequencyOfPair, Number, PointQuestion, RootsByPlace};
use crate::Document;
use crate::response::gain_decimal;
use jurist_algebra::limits::Exhausted;
use jurist_engine::answer::{self, Answer};
use jurist_engine::problem::Problem;
use jurist_engine::response::{self, Extreme};
use jurist_engine::stability::AbsoluteSum;
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
    /// The peak; `null` unless the loop is stable, and where the l1 norm was asked for instead.
    pub norm: Option<PeakFound>,
    /// The peak-to-peak gain (l1 norm); left out where it was not asked for, and unless the loop is stable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub l1: Option<PeakToPeakFound>,
}

/// The sum (in continuous time the integral) of the absolute values of the impulse response: from rest `max |output| <= l1 max |input|`, and no smaller number does.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PeakToPeakFound {
    /// Correctly rounded to the digits asked for; next to a tie either neighbour.
    pub decimal: String,
    /// The gain itself where it is proved to be this rational number, else `null`; a gain that is rational may have `null`.
    pub exact: Option<Exact>,
    /// Lower and upper bound; equal where `exact` is not `null`.
    pub enclosure: Enclosure,
    /// How many samples of the impulse response were computed; in continuous time how many steps.
    pub terms: usize,
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
                frequency: FrequencyOfPair::new(digits, |bits| norm.frequency(bits)),
            }),
            l1: None,
        };
        Norm { schema: NormName::V1, question: PointQuestion::new(problem), answer: Answered::of(norm, found) }
    }
}

impl PeakToPeakFound {
    fn new(gain: &AbsoluteSum, digits: usize) -> Self {
        PeakToPeakFound {
            decimal: gain_decimal(gain, digits),
            exact: gain.exact.as_ref().map(Exact::from),
            enclosure: enclosure(&gain.lower, &gain.upper),
            terms: gain.terms,
        }
    }
}

impl Norm {
    /// The document of a peak-to-peak gain, also of one that the budget did not allow.
    pub fn of_peak_to_peak(problem: &Problem, found: Result<&response::PeakToPeak, &Exhausted>, digits: usize) -> Self {
        let found_as = |found: &response::PeakToPeak| NormFound {
            input: found.input.clone(),
            output: found.output.clone(),
            stable: found.verdict.verdict == answer::Verdict::Stable,
            roots: RootsByPlace::from(&found.verdict),
            norm: None,
            l1: found.gain.as_ref().map(|gain| PeakToPeakFound::new(gain, digits)),
        };
        Norm { schema: NormName::V1, question: PointQuestion::new(problem), answer: Answered::of(found, found_as) }
    }
}

impl Document for Answer<response::PeakToPeak> {
    type Json = Norm;

    /// The document `jurist/norm/1` with the key `l1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        Norm::of_peak_to_peak(self.problem(), Ok(self.value()), digits)
    }
}

impl Document for Answer<response::Norm> {
    type Json = Norm;

    /// The document `jurist/norm/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        Norm::new(self.problem(), Ok(self.value()), digits)
    }
}
