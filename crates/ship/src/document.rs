//! The document `jurist/ship/1`.

use crate::answer::{Part, Point, ShipAnswer};
use crate::fewest;
use crate::format::Format;
use crate::ranges;
use crate::run::Overflow;
use crate::shipped::Stored;
use jurist_engine::answer::{Answer, ToleranceAnswer};
use jurist_engine::show::documents::{
    Answered, Enclosure, Exact, Intervals, MarginsFound, Named, PointQuestion, RequirementFound, RootsByPlace, Stable,
    Undecided, Verdict,
};
use jurist_engine::stability::StableSet;
use jurist_engine::stability::boxes::BoxDecision;
use serde::{Deserialize, Serialize};

/// `jurist/ship/1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ShipName {
    /// The first version.
    #[default]
    #[serde(rename = "jurist/ship/1")]
    V1,
}

/// A controller as it is stored and run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Ship {
    /// The kind of document.
    pub schema: ShipName,
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// The block.
    pub block: String,
    /// The realisation.
    pub realisation: String,
    /// How coefficients are stored.
    pub format: FormatFound,
    /// How signals are stored; `null` where that is not said, and in floating point.
    pub signal: Option<FormatFound>,
    /// What happens to signals that do not fit: `saturate` or `wrap`.
    pub overflow: String,
    /// What is stored.
    pub coefficients: Named<CoefficientFound>,
    /// The loop as it is written.
    pub exact: RootsByPlace,
    /// The loop as it is stored.
    pub rounded: RootsByPlace,
    /// What rounding changed in the structure, in sentences.
    pub changes: Vec<String>,
    /// The margins of the stored loop; `null` where there are none.
    pub margins: Option<Box<MarginsFound>>,
    /// The requirements, of the stored loop.
    pub requirements: Vec<RequirementFound>,
    /// Whether every rounding holds; `null` where nothing is rounded.
    pub every_rounding: Option<EveryRounding>,
    /// The fewest bits behind the point; `null` where they were not asked for, and in floating point.
    pub fewest: Option<FewestFound>,
    /// The limits of a parameter by bits; `null` where they were not asked for.
    pub limits: Option<LimitsFound>,
    /// The inner signals; empty where nothing is said of them.
    pub ranges: Vec<RangeFound>,
    /// By how much the rounding of signals moves each output at most, limit cycles included; rounded up.
    pub limit_cycle: Named<Exact>,
    /// Why something is not decided; `null` where everything is.
    pub undecided: Option<Undecided>,
}

/// A number format.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FormatFound {
    /// The format in words.
    pub words: String,
    /// All bits.
    pub bits: u32,
    /// Bits behind the point; `null` of floating point.
    pub fraction: Option<i32>,
    /// The exponent of the power of two that numbers are divided by; `null` of floating point.
    pub scale: Option<i32>,
    /// The rounding mode.
    pub round: String,
}

/// A coefficient.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientFound {
    /// Bounds of the exact number, equal where it is rational.
    pub exact: Enclosure,
    /// The stored number.
    pub stored: Exact,
    /// The integer that stands for it; `null` of floating point.
    pub integer: Option<Exact>,
}

/// What is known of every rounding.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EveryRounding {
    /// Whether the loop is stable, and all requirements are met, for all of them; `null` where neither was proved.
    pub holds: Option<bool>,
    /// Proved: the errors may be so many times as large; `null` where the exact loop does not hold itself.
    pub factor: Option<Exact>,
    /// Refuted: so many times as large is too large; `null` where no such factor was found.
    pub refuted: Option<Exact>,
    /// Coefficients at which it does not hold, within the errors or just beyond the factor; `null` where none were found.
    pub witness: Option<Named<Exact>>,
    /// The number of cells of the proof; `null` without one.
    pub cells: Option<usize>,
}

/// The fewest bits behind the point.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FewestFound {
    /// From this number on every rounding within half a unit holds; `null` where no box was proved.
    pub every_rounding: Option<i64>,
    /// The greatest number below at which some rounding does not hold; `null` where none was found.
    pub refuted: Option<i64>,
    /// The numbers below `every_rounding` at which rounding to nearest holds.
    pub nearest: Vec<i64>,
    /// The numbers below `floor_from` at which rounding down holds.
    pub floor: Vec<i64>,
    /// From this number on rounding down holds.
    pub floor_from: Option<i64>,
}

/// The stable sets of a parameter with the controller in more and more bits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LimitsFound {
    /// The parameter.
    pub parameter: String,
    /// With the controller as it is written.
    pub exact: Stable,
    /// With the stored one, by ascending bits.
    pub rows: Vec<LimitsOfBits>,
}

/// The stable set with one number of bits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LimitsOfBits {
    /// Bits behind the point; `null` of floating point.
    pub fraction: Option<i64>,
    /// The set.
    #[serde(flatten)]
    pub set: Stable,
}

/// The range of an inner signal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RangeFound {
    /// The signal.
    pub node: String,
    /// Its greatest magnitude under all inputs within their bounds, between two numbers; `null` without bounds.
    pub bound: Option<Enclosure>,
    /// What the rounding of signals adds at most.
    pub rounding: Exact,
    /// The greatest number of its format; `null` without one.
    pub limit: Option<Exact>,
    /// Whether it stays within; `null` where that is not decided.
    pub holds: Option<bool>,
}

impl From<&Format> for FormatFound {
    fn from(format: &Format) -> Self {
        let words = format.words();
        match format {
            Format::Fixed(fixed) => FormatFound {
                words,
                bits: fixed.bits,
                fraction: Some(fixed.fraction),
                scale: Some(fixed.scale),
                round: fixed.rounding.name().into(),
            },
            Format::Binary(format) => {
                let bits = if *format == jurist_algebra::number::BinaryFormat::Single { 32 } else { 64 };
                FormatFound { words, bits, fraction: None, scale: None, round: "even".into() }
            }
        }
    }
}

impl From<&Stored> for CoefficientFound {
    fn from(stored: &Stored) -> Self {
        CoefficientFound {
            exact: [stored.exact.lower().into(), stored.exact.upper().into()],
            stored: (&stored.value).into(),
            integer: stored.integer.as_ref().map(Into::into),
        }
    }
}

impl ShipAnswer {
    /// The document `jurist/ship/1`.
    pub fn json(&self, digits: usize) -> Ship {
        let asked = &self.shipped.asked;
        let signal = asked.signal.map(Format::Fixed);
        let ranges = self.ranges.as_ref().and_then(|part| part.as_ref().ok());
        Ship {
            schema: ShipName::V1,
            question: Verdict::new(&self.shipped.exact, Ok(self.exact.verdict.value())).question,
            block: asked.block.clone(),
            realisation: asked.realisation.name().into(),
            format: (&asked.format).into(),
            signal: signal.as_ref().map(Into::into),
            overflow: match asked.overflow {
                Overflow::Saturate => "saturate".into(),
                Overflow::Wrap => "wrap".into(),
            },
            coefficients: self.shipped.coefficients.iter().map(|c| (c.name.clone(), c.into())).collect(),
            exact: self.exact.verdict.value().into(),
            rounded: self.rounded.verdict.value().into(),
            changes: self.shipped.changes(),
            margins: margins(&self.rounded, digits).map(Box::new),
            requirements: self.rounded.requirements.iter().map(|r| RequirementFound::new(r, digits)).collect(),
            every_rounding: self.every_rounding.as_ref().map(|part| self.every_found(part)),
            fewest: self.fewest.as_ref().and_then(|part| part.as_ref().ok()).map(Into::into),
            limits: self.limits.as_ref().and_then(|part| part.as_ref().ok()).map(|limits| LimitsFound {
                parameter: limits.parameter.clone(),
                exact: set(&limits.exact, digits),
                rows: limits
                    .rows
                    .iter()
                    .map(|(bits, a)| LimitsOfBits { fraction: *bits, set: set(a, digits) })
                    .collect(),
            }),
            ranges: ranges.map(|ranges| ranges.nodes.iter().map(Into::into).collect()).unwrap_or_default(),
            limit_cycle: ranges.iter().flat_map(|r| &r.moved).map(|(name, most)| (name.clone(), most.into())).collect(),
            undecided: self.stopped().map(Into::into),
        }
    }

    fn every_found(&self, part: &Part<Answer<ToleranceAnswer>>) -> EveryRounding {
        let Ok(answer) = part else {
            return EveryRounding { holds: None, factor: None, refuted: None, witness: None, cells: None };
        };
        let answer = answer.value();
        let own = match &answer.decision {
            BoxDecision::NotStable { witness } => witness.as_ref(),
            _ => answer.factor.as_ref().and_then(|factor| factor.witness.as_ref()),
        };
        let named = |point: &[jurist_algebra::number::Rational]| {
            self.shipped.coefficients.iter().zip(point).map(|(c, value)| (c.name.clone(), value.into())).collect()
        };
        EveryRounding {
            holds: self.every_rounding_holds(),
            factor: answer.factor.as_ref().map(|factor| (&factor.lower).into()),
            refuted: answer.factor.as_ref().and_then(|factor| factor.upper.as_ref()).map(Into::into),
            witness: own.map(|witness| named(&witness.point)),
            cells: match &answer.decision {
                BoxDecision::Stable(proof) => Some(proof.cells()),
                _ => None,
            },
        }
    }
}

fn set(answer: &Answer<StableSet>, digits: usize) -> Stable {
    match Intervals::new(answer.problem(), Ok(answer.value()), digits).answer {
        Answered::Known(set) => set,
        Answered::Undecided(_) => Stable { stable: Vec::new(), undecided: Vec::new() },
    }
}

fn margins(point: &Point, digits: usize) -> Option<MarginsFound> {
    match point.margins.as_ref().ok()?.json(digits).answer {
        Answered::Known(found) => Some(found),
        Answered::Undecided(_) => None,
    }
}

impl From<&fewest::Fewest> for FewestFound {
    fn from(found: &fewest::Fewest) -> Self {
        FewestFound {
            every_rounding: found.every_rounding,
            refuted: found.refuted,
            nearest: found.nearest.clone(),
            floor: found.floor.clone(),
            floor_from: found.floor_from,
        }
    }
}

impl From<&ranges::NodeRange> for RangeFound {
    fn from(node: &ranges::NodeRange) -> Self {
        RangeFound {
            node: node.name.clone(),
            bound: node.greatest.as_ref().map(|[low, high]| [low.into(), high.into()]),
            rounding: (&node.rounding).into(),
            limit: node.limit.as_ref().map(Into::into),
            holds: node.holds,
        }
    }
}

/// JSON Schemas of these documents: kind with version, and schema.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, serde_json::Value)> {
    use jurist_engine::show::documents::schemas::schema_of;
    let name = "jurist/ship/1";
    vec![(name, schema_of::<Ship>(name))]
}

#[cfg(all(test, feature = "schema"))]
mod tests {
    #[test]
    fn the_schemas_that_are_published_are_those_of_the_types() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema");
        jurist_engine::show::documents::schemas::check_published(&folder, &super::schemas());
    }
}
