//! The document `jurist/main/1`.

use jurist_show::documents::{Answered, Exact, Intervals, JuryInParameter};
use serde::{Deserialize, Serialize};

/// `jurist/main/1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum MainName {
    /// The first version.
    #[default]
    #[serde(rename = "jurist/main/1")]
    V1,
}

/// The paper's drive, each limit beside the paper's.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Main {
    /// The kind of document.
    pub schema: MainName,
    /// The limits.
    #[serde(flatten)]
    pub answer: Answered<MainAnswer, MainOpen>,
}

/// The limits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MainAnswer {
    /// The model's title.
    pub title: String,
    /// Jury's test in the amplitude of the PWM wave, and in the chopping period.
    pub jury: [JuryInParameter; 2],
    /// The reciprocal of the longest stable chopping period in hertz, correctly rounded to the digits asked for.
    pub frequency_limit_hz: Option<String>,
    /// The limits as the paper prints them.
    pub paper: PaperLimits,
    /// What the paper's rounding of Eq. 23 does.
    pub rounding: Rounding,
}

/// No limits.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MainOpen {
    /// Not known.
    pub jury: (),
}

/// The limits as the paper prints them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PaperLimits {
    /// Of the amplitude, from below.
    pub lower: PaperLimit,
    /// Of the amplitude, from above.
    pub upper: PaperLimit,
    /// Of the chopping frequency, from below.
    pub period: PaperLimit,
}

/// A limit as the paper prints it; empty where it prints none.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PaperLimit {
    /// Read off the root locus.
    pub root_locus: String,
    /// By Jury's test.
    pub jury: String,
}

/// What the paper's rounding of Eq. 23 does.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Rounding {
    /// The characteristic polynomial at z = 1 with exact coefficients, an expression in the amplitude.
    pub exact_value_at_one: String,
    /// The same with the coefficients as printed.
    pub printed_value_at_one: String,
    /// Where that vanishes.
    pub printed_zero: Option<Exact>,
    /// The stable set of the polynomial as printed.
    pub printed_polynomial: Intervals,
}

/// JSON Schemas of these documents: kind with version, and schema.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, serde_json::Value)> {
    let name = "jurist/main/1";
    vec![(name, jurist_show::documents::schemas::schema_of::<Main>(name))]
}

#[cfg(all(test, feature = "schema"))]
mod tests {
    #[test]
    fn the_schemas_that_are_published_are_those_of_the_types() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema");
        jurist_show::documents::schemas::check_published(&folder, &super::schemas());
    }
}
