//! The crossings in `jurist/margins/1`.

use super::{Enclosure, Exact, FrequencyOfPair};
use jurist_engine::response::Direction;
use serde::{Deserialize, Serialize};

/// All crossings by ascending frequency.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CrossingsFound {
    /// Where the open loop has modulus one.
    pub gain: Vec<GainCrossingFound>,
    /// Whether it has modulus one at all frequencies; `gain` is empty then.
    pub gain_everywhere: bool,
    /// Where the open loop is real and negative.
    pub phase: Vec<PhaseCrossingFound>,
    /// Whether it is real at all frequencies; `phase` is empty then.
    pub phase_everywhere: bool,
}

/// A frequency at which the open loop has modulus one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GainCrossingFound {
    /// By how much the open loop may lag there before it is -1, within 180 degrees; negative for a lead.
    pub phase_margin_degrees: String,
    /// The lag that leads to -1 divided by the frequency, in samples or in units of time; at a negative frequency, of a loop with complex coefficients, the
    /// lead. `null` at the ends of the range, and at the frequency 0.
    pub delay: Option<String>,
    /// The same in units of time, in discrete time with a sample time: the phase margin over the angular frequency.
    pub delay_seconds: Option<String>,
    /// How the modulus goes through one as the frequency grows.
    pub direction: Direction,
    /// The frequency; all `null` in the limit of high frequencies.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}

/// A frequency at which the open loop is real and negative.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PhaseCrossingFound {
    /// The factor at the cut that makes it -1, correctly rounded.
    pub factor: String,
    /// The same where it is rational.
    pub exact: Option<Exact>,
    /// Certified bounds of it.
    pub enclosure: Enclosure,
    /// The frequency; all `null` in the limit of high frequencies.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}
