//! The document `jurist/ship/1`.

use crate::answer::{Part, Point, ShipAnswer};
use crate::fewest;
use crate::format::Format;
use crate::ranges;
use crate::run::Overflow;
use crate::shipped::Stored;
use jurist_algebra::number::{BinaryFormat, Integer, Rational};
use jurist_engine::answer::{Answer, ToleranceAnswer};
use jurist_engine::stability::StableSet;
use jurist_show::Document;
use jurist_show::documents::{
    Answered, Enclosure, Exact, Intervals, MarginsFound, Named, PointQuestion, RequirementFound, RootsByPlace, Stable,
    ToleranceFound, Undecided, Verdict,
};
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
    /// What is stored, in lists: `b` and `a` of a direct form by falling powers of z, or of the delta operator; `b_1`, `a_1` .. of several sections; `A`, `B`, `C`
    /// and `D` row by row.
    pub coefficients: Named<CoefficientsFound>,
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
    /// Whether every rounding holds, as the answer of a tolerance whose names are those of the coefficients with `ship_` before them; `null` where
    /// nothing is rounded, and where it was not decided.
    pub every_rounding: Option<Box<ToleranceFound>>,
    /// The fewest bits behind the point; `null` where they were not asked for, and in floating point.
    pub fewest: Option<FewestFound>,
    /// The limits of a parameter by bits; `null` where they were not asked for.
    pub limits: Option<LimitsFound>,
    /// The inner signals; empty where nothing is said of them.
    pub ranges: Vec<RangeFound>,
    /// By how much the rounding of signals moves each output at most, limit cycles included.
    pub limit_cycle: Named<LimitCycle>,
    /// The worst input, where it was asked for, else `null`.
    pub worst_input: Option<WorstInputFound>,
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

/// A list of coefficients; what is 0, 1 or -1 by the structure is among them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientsFound {
    /// Their names; `null` where a number is one by the structure and nothing is stored.
    pub names: Vec<Option<String>>,
    /// Bounds of the exact numbers, equal where they are rational.
    pub exact: Vec<Enclosure>,
    /// The stored numbers.
    pub stored: Vec<Exact>,
    /// The integers that stand for them in fixed point; `null` of floating point, and where nothing is stored.
    pub integers: Vec<Option<Exact>>,
    /// The stored bits in hexadecimal digits: two's complement, or IEEE 754; `null` where nothing is stored.
    pub hex: Vec<Option<String>>,
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
    /// The signal: `u`, the controller's input, or an inner one by its name in the code.
    pub node: String,
    /// Its magnitude is at most this, rounding of inputs and signals included; `null` without bounds of inputs.
    pub bound: Option<Exact>,
    /// Its greatest magnitude under all inputs within their bounds without rounding, between two numbers; `null` without bounds.
    pub greatest: Option<Enclosure>,
    /// What the rounding of the controller's own signals adds at most.
    pub rounding: Exact,
    /// The same with its inputs rounded to the format of signals as well.
    pub rounding_with_inputs: Exact,
    /// The greatest number of its format; `null` without one.
    pub limit: Option<Exact>,
    /// Whether it stays within; `null` where that is not decided.
    pub holds: Option<bool>,
}

/// What the rounding of signals does to an output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LimitCycle {
    /// At most so much, the rounding of the controller's own signals alone.
    pub bound: Exact,
    /// The same with its inputs rounded to the format of signals as well.
    pub with_inputs: Exact,
}

/// A worst input.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WorstInputFound {
    /// The inner signal that it is about.
    pub node: String,
    /// The name of that signal as an output of the model with the inner signals.
    pub output: String,
    /// The number of samples.
    pub samples: usize,
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
                FormatFound { words, bits: binary_bits(*format), fraction: None, scale: None, round: "even".into() }
            }
        }
    }
}

/// The stored bits in hexadecimal digits.
fn hex(stored: &Stored, format: &Format) -> Option<String> {
    let (bits, pattern) = match (format, &stored.integer) {
        (Format::Fixed(fixed), Some(integer)) => {
            let size = Integer::ONE << u64::from(fixed.bits);
            (fixed.bits, integer.div_mod_floor(&size).1)
        }
        (Format::Binary(format), _) => (binary_bits(*format), format.pattern(&stored.value)?),
        _ => return None,
    };
    let limbs = pattern.limbs().first().copied().unwrap_or(0);
    Some(format!("0x{limbs:0width$x}", width = (bits as usize).div_ceil(4)))
}

fn binary_bits(format: BinaryFormat) -> u32 {
    match format {
        BinaryFormat::Single => 32,
        BinaryFormat::Double => 64,
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
            coefficients: self.coefficients(),
            exact: self.exact.verdict.value().into(),
            rounded: self.rounded.verdict.value().into(),
            changes: self.shipped.changes(),
            margins: margins(&self.rounded, digits).map(Box::new),
            requirements: self.rounded.requirements.iter().map(|r| RequirementFound::new(r, digits)).collect(),
            every_rounding: self.every_rounding.as_ref().and_then(|part| every(part, digits)).map(Box::new),
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
            limit_cycle: ranges
                .iter()
                .flat_map(|r| &r.moved)
                .map(|moved| {
                    let found =
                        LimitCycle { bound: (&moved.by_signals).into(), with_inputs: (&moved.with_inputs).into() };
                    (moved.output.clone(), found)
                })
                .collect(),
            worst_input: self.worst_input.as_ref().map(Into::into),
            undecided: self.stopped().map(Into::into),
        }
    }

    fn coefficients(&self) -> Named<CoefficientsFound> {
        let shipped = &self.shipped;
        let one = |place: &Result<Rational, usize>, found: &mut CoefficientsFound| match place {
            Ok(value) => {
                found.names.push(None);
                found.exact.push([value.into(), value.into()]);
                found.stored.push(value.into());
                found.integers.push(None);
                found.hex.push(None);
            }
            Err(at) => {
                let stored = &shipped.coefficients[*at];
                found.names.push(Some(stored.name.clone()));
                found.exact.push([stored.exact.lower().into(), stored.exact.upper().into()]);
                found.stored.push((&stored.value).into());
                found.integers.push(stored.integer.as_ref().map(Into::into));
                found.hex.push(hex(stored, &shipped.asked.format));
            }
        };
        let list = |(name, places): (String, Vec<Result<Rational, usize>>)| {
            let mut found = CoefficientsFound::default();
            places.iter().for_each(|place| one(place, &mut found));
            (name, found)
        };
        shipped.realised.structure.lists().into_iter().map(list).collect()
    }
}

fn every(part: &Part<Answer<ToleranceAnswer>>, digits: usize) -> Option<ToleranceFound> {
    match part.as_ref().ok()?.json(digits).answer {
        Answered::Known(found) => Some(found),
        Answered::Undecided(_) => None,
    }
}

impl From<&ranges::WorstInput> for WorstInputFound {
    fn from(worst: &ranges::WorstInput) -> Self {
        let samples = worst.inputs.first().map_or(0, |(_, values)| values.len());
        WorstInputFound { node: worst.node.clone(), output: worst.output.clone(), samples }
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
            bound: node.greatest.as_ref().map(|[_, high]| (&(high + &node.with_inputs)).into()),
            greatest: node.greatest.as_ref().map(|[low, high]| [low.into(), high.into()]),
            rounding: (&node.rounding).into(),
            rounding_with_inputs: (&node.with_inputs).into(),
            limit: node.limit.as_ref().map(Into::into),
            holds: node.holds,
        }
    }
}

/// JSON Schemas of these documents: kind with version, and schema.
#[cfg(feature = "schema")]
pub fn schemas() -> Vec<(&'static str, serde_json::Value)> {
    use jurist_show::documents::schemas::schema_of;
    let name = "jurist/ship/1";
    vec![(name, schema_of::<Ship>(name))]
}

#[cfg(all(test, feature = "schema"))]
mod tests {
    #[test]
    fn the_schemas_that_are_published_are_those_of_the_types() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schema");
        jurist_show::documents::schemas::check_published(&folder, &super::schemas());
    }
}
