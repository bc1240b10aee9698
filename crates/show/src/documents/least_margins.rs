//! The document `jurist/least-margins/1`.

use super::number::enclosure;
use super::{AllValues, Answered, Enclosure, Exact, Named, PointQuestion, schema_name};
use crate::Document;
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::Rational;
use jurist_engine::answer::Answer;
use jurist_engine::problem::Problem;
use jurist_engine::response::{self, AllOf, Everywhere, Level};
use serde::{Deserialize, Serialize};

schema_name!(LeastMarginsName, "jurist/least-margins/1");

/// How much of each margin a loop has for all values of some names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeastMargins {
    /// The kind of document.
    pub schema: LeastMarginsName,
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// The answer.
    #[serde(flatten)]
    pub answer: Answered<LeastMarginsFound, LeastMarginsOpen>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeastMarginsFound {
    /// The names with the ranges of their values.
    pub for_all: Vec<AllValues>,
    /// Whether the loop is stable for all values; `null` where that is not decided.
    pub stable: Option<bool>,
    /// Values for which it is not, as far as that is seen; left out where it is stable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_stable_at: Option<Named<Exact>>,
    /// The margins; none unless the loop is stable for all values.
    pub margins: Vec<LeastMargin>,
    /// The budget that ran out before all margins were looked at; left out where none did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
}

/// No answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeastMarginsOpen {
    /// Not known.
    pub stable: (),
}

/// The least value of a margin, of a peak the greatest one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeastMargin {
    /// The name of the requirement; a phase margin is in degrees, a gain margin a factor, a delay margin in units of time.
    pub name: String,
    /// All values have at least so much, of a peak at most; `null` where nothing is proved.
    pub proved: Option<Exact>,
    /// What one value has; `null` where no value that was looked at limits it.
    pub found: Option<LeastFound>,
    /// Why nothing is proved; left out where something is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// What one value has.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeastFound {
    /// Certified bounds of the margin.
    pub enclosure: Enclosure,
    /// The value of each name.
    pub at: Named<Exact>,
}

fn named(all: &[AllOf], point: &[Rational]) -> Named<Exact> {
    all.iter().zip(point).map(|(all, x)| (all.name.clone(), Exact::from(x))).collect()
}

impl LeastMargins {
    /// The document, also of an answer that the budget did not allow.
    pub fn new(problem: &Problem, found: Result<&response::LeastMargins, &Exhausted>) -> Self {
        let known = |found: &response::LeastMargins| LeastMarginsFound {
            for_all: found.all.iter().map(AllValues::from).collect(),
            stable: (found.stable != Everywhere::Open).then_some(found.stable == Everywhere::All),
            not_stable_at: match &found.stable {
                Everywhere::NotAt(point) => Some(named(&found.all, point)),
                Everywhere::All | Everywhere::Open => None,
            },
            margins: found.margins.iter().map(|margin| LeastMargin::new(margin, &found.all)).collect(),
            stopped: found.stopped.as_ref().map(ToString::to_string),
        };
        LeastMargins {
            schema: LeastMarginsName::V1,
            question: PointQuestion::new(problem),
            answer: Answered::of(found, known),
        }
    }
}

impl LeastMargin {
    fn new(margin: &response::LeastMargin, all: &[AllOf]) -> Self {
        LeastMargin {
            name: Level::name(margin.level).to_owned(),
            proved: margin.proved.as_ref().map(Exact::from),
            found: margin.found.as_ref().map(|(value, point)| LeastFound {
                enclosure: enclosure(value.lower(), value.upper()),
                at: named(all, point),
            }),
            why: margin.why.clone(),
        }
    }
}

impl Document for Answer<response::LeastMargins> {
    type Json = LeastMargins;

    /// The document `jurist/least-margins/1`.
    fn json(&self, _digits: usize) -> Self::Json {
        LeastMargins::new(self.problem(), Ok(self.value()))
    }
}
