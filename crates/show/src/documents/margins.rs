//! The document `jurist/margins/1`.

use super::schema_name;
use super::{
    Answered, Bounds, CrossingsFound, Enclosure, End, Exact, FrequencyOfPair, GainCrossingFound, Number,
    PhaseCrossingFound, PointQuestion, RootsByPlace,
};
use crate::{Document, real};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{self, Rational};
use jurist_algebra::real::Real;
use jurist_engine::answer::{self, Answer};
use jurist_engine::problem::Problem;
use jurist_engine::response::{
    self, Crossings, DelayMargin, Extreme, PhaseMargin, Place, Rotation, StableMargins, Value,
};
use jurist_engine::stability::{Shape, StableInterval};
use serde::{Deserialize, Serialize};

schema_name!(MarginsName, "jurist/margins/1");

/// The margins of the loop cut at one signal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Margins {
    /// The kind of document.
    pub schema: MarginsName,
    /// What was asked.
    #[serde(flatten)]
    pub question: PointQuestion,
    /// The margins.
    #[serde(flatten)]
    pub answer: Answered<MarginsFound, MarginsOpen>,
}

/// The answer. The margins are `null` unless the loop is stable; the crossings are given all the same.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MarginsFound {
    /// Where the loop is cut: a signal, a block (at its input), or a parameter (the loop's gain).
    pub at: String,
    /// Whether the closed loop is stable.
    pub stable: bool,
    /// The verdict on the closed loop, and where its roots are.
    #[serde(flatten)]
    pub roots: RootsByPlace,
    /// The gain margins.
    pub gain: Option<GainMargins>,
    /// The phase margin.
    pub phase: Option<PhaseMarginFound>,
    /// The delay margin.
    pub delay: Option<DelayMarginFound>,
    /// The modulus margin.
    pub modulus: Option<ModulusMargin>,
    /// The peak of the complementary sensitivity.
    pub complementary: Option<ComplementaryPeak>,
    /// The disk margin.
    pub disk: Option<DiskMarginFound>,
    /// Where the open loop has modulus one, and where it is real and negative.
    pub crossings: CrossingsFound,
}

/// No answer.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MarginsOpen {
    /// Not known.
    pub stable: (),
}

/// The factors at the cut for which the loop is stable, 1 being nominal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GainMargins {
    /// All stable factors, the negative ones too.
    pub stable: Vec<Bounds<End>>,
    /// The least factor above 1 at which the loop is not stable; `null` if there is none.
    pub upper: Option<End>,
    /// The greatest factor below 1, not below 0, at which it is not; `null` if there is none.
    pub lower: Option<End>,
    /// `upper` in decibels, rounded.
    pub upper_db: Option<serde_json::Number>,
    /// `lower` in decibels, rounded; `null` also for the factor 0.
    pub lower_db: Option<serde_json::Number>,
}

/// By how much the open loop may be turned around 0, either way.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PhaseMarginFound {
    /// Correctly rounded; `null` where any angle is borne.
    pub degrees: Option<String>,
    /// `tan(phi/2)`; `null` also for 180 degrees.
    pub tangent: Option<Number>,
    /// Of a loop with complex coefficients: the smallest rotation in the sense of a delay that brings it to the boundary, in degrees, correctly rounded.
    /// `degrees` is the smaller of this and `lead`. Absent where any angle is borne.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lag: Option<String>,
    /// The same in the other sense.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lead: Option<String>,
    /// Where it binds; all `null` where the modulus is one at all frequencies.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}

/// How much delay at the cut is borne.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DelayMarginFound {
    /// Whether any delay is borne; in discrete time any number of whole samples, beside which `seconds` may bound the dead time at the input of a plant
    /// behind a hold. The other keys are `null` then.
    pub unbounded: bool,
    /// The dead time that is not borne any more, in units of time, correctly rounded: in continuous time, and at the input of
    /// a plant behind a hold.
    pub seconds: Option<String>,
    /// The block behind a hold at whose input this dead time is.
    pub behind_hold: Option<String>,
    /// Certified bounds of it.
    pub enclosure: Option<Enclosure>,
    /// Discrete time: the greatest number of whole samples that is borne, with all smaller ones.
    pub samples: Option<u64>,
    /// Whether `samples` is only known to be borne: the modulus of the open loop only touches one.
    pub at_least: bool,
    /// The crossing that binds, in continuous time; the pair on the unit circle with the dead time behind a hold.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}

/// The least distance of the open loop from -1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ModulusMargin {
    /// The least value of `|1 + L|`.
    pub value: Number,
    /// Its inverse: the greatest value of the sensitivity `|1/(1 + L)|`.
    pub peak_sensitivity: Number,
    /// Whether the value is attained; if not, it is approached as the frequency grows without end.
    pub attained: bool,
    /// Where; all `null` where it is not attained, and where it is the same at all frequencies.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}

/// The greatest value of the complementary sensitivity `|L/(1 + L)|`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComplementaryPeak {
    /// The value.
    pub peak: Number,
    /// Whether it is attained; if not, it is approached as the frequency grows without end.
    pub attained: bool,
    /// Where; all `null` where it is not attained, and where it is the same at all frequencies.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}

/// The disk margin.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DiskMarginFound {
    /// The skew of the disk, 0 for the balanced one.
    pub skew: Exact,
    /// The size of the disk; `null` where no such disk makes the loop unstable.
    pub alpha: Option<Number>,
    /// The factors of the disk, correctly rounded; the second is `null` where there is no greatest.
    pub gain: [Option<String>; 2],
    /// The phase in degrees that the disk allows for, correctly rounded.
    pub phase_degrees: String,
    /// Where it binds.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
}

/// Writes numbers and frequencies of one answer.
struct Writer<'a> {
    margins: &'a response::Margins,
    digits: usize,
}

impl Writer<'_> {
    fn shape(&self) -> Shape {
        self.margins.open_loop.shape()
    }

    fn number(&self, value: &Real) -> Number {
        Number::new(value, self.digits)
    }

    fn decimal(&self, enclose: impl FnMut(u64) -> Option<number::Enclosure>) -> Option<String> {
        real::enclosed(self.digits, enclose)
    }

    fn at(&self, place: Option<&Place>) -> FrequencyOfPair {
        FrequencyOfPair::new(self.digits, |bits| self.margins.frequency(place?, bits))
    }

    fn end(&self, end: &jurist_engine::stability::End) -> End {
        End::of_factor(end, self.digits, |bits| self.margins.frequency_of(end, bits))
    }

    fn bounds(&self, interval: &StableInterval) -> Bounds<End> {
        let end = |end: &Option<jurist_engine::stability::End>| end.as_ref().map(|end| self.end(end));
        Bounds { lower: end(&interval.lower), upper: end(&interval.upper) }
    }

    fn gain(&self, gain: &response::GainMargin) -> GainMargins {
        let (upper, lower) = (gain.upper.as_ref().map(|e| self.end(e)), gain.lower.as_ref().map(|e| self.end(e)));
        GainMargins {
            stable: gain.set.intervals().iter().map(|i| self.bounds(i)).collect(),
            upper_db: upper.as_ref().and_then(|e| e.margin_db.clone()),
            lower_db: lower.as_ref().and_then(|e| e.margin_db.clone()),
            upper,
            lower,
        }
    }

    fn phase(&self, margins: &StableMargins) -> PhaseMarginFound {
        let StableMargins { phase, one_sided, .. } = margins;
        let side = |rotation: &Option<Rotation>| {
            let rotation = rotation.as_ref()?;
            self.decimal(|bits| Some(rotation.degrees(bits)))
        };
        let (tangent, place) = match phase {
            PhaseMargin::Unbounded => (None, None),
            PhaseMargin::Angle { tangent, place } => (tangent.as_deref(), place.as_ref()),
        };
        PhaseMarginFound {
            degrees: self.decimal(|bits| phase.degrees(bits)),
            tangent: tangent.map(|t| self.number(t)),
            lag: one_sided.as_ref().and_then(|both| side(&both.lag)),
            lead: one_sided.as_ref().and_then(|both| side(&both.lead)),
            frequency: self.at(place),
        }
    }

    fn delay(&self, delay: &DelayMargin) -> DelayMarginFound {
        let none = DelayMarginFound {
            unbounded: false,
            seconds: None,
            behind_hold: None,
            enclosure: None,
            samples: None,
            at_least: false,
            frequency: FrequencyOfPair::default(),
        };
        let zero = Exact::from(&Rational::ZERO);
        match delay {
            DelayMargin::Zero => {
                DelayMarginFound { seconds: Some("0".into()), enclosure: Some([zero.clone(), zero]), ..none }
            }
            DelayMargin::Unbounded => self.held_delay(DelayMarginFound { unbounded: true, ..none }),
            DelayMargin::Samples(m) => self.held_delay(DelayMarginFound { samples: Some(*m), ..none }),
            DelayMargin::SamplesAtLeast(m) => {
                self.held_delay(DelayMarginFound { samples: Some(*m), at_least: true, ..none })
            }
            DelayMargin::DeadTime(i) => {
                let crossing = &self.margins.crossings.gain[*i];
                let narrow = crossing.delay(self.margins.open_loop.frequencies(), real::bits_for(self.digits));
                DelayMarginFound {
                    seconds: self.decimal(|bits| crossing.delay(self.margins.open_loop.frequencies(), bits)),
                    enclosure: narrow.map(|e| super::number::enclosure(e.lower(), e.upper())),
                    frequency: self.at(Some(&crossing.place)),
                    ..none
                }
            }
        }
    }

    /// With the dead time at the input of a plant behind a hold.
    fn held_delay(&self, whole: DelayMarginFound) -> DelayMarginFound {
        let Some(held) = self.margins.held_delay.as_ref().filter(|held| held.samples.is_some()) else { return whole };
        let narrow = held.seconds(real::bits_for(self.digits));
        DelayMarginFound {
            seconds: self.decimal(|bits| held.seconds(bits)),
            behind_hold: Some(held.block.clone()),
            enclosure: narrow.map(|e| super::number::enclosure(e.lower(), e.upper())),
            frequency: FrequencyOfPair::new(self.digits, |bits| held.frequency(bits)),
            ..whole
        }
    }

    fn modulus(&self, margins: &StableMargins) -> ModulusMargin {
        let attained = !matches!(margins.modulus_at, Extreme::At { attained: false, .. });
        ModulusMargin {
            value: self.number(&margins.modulus),
            peak_sensitivity: self.number(&margins.peak_sensitivity),
            attained,
            frequency: self.at(margins.modulus_at.place()),
        }
    }

    fn complementary(&self, margins: &StableMargins) -> ComplementaryPeak {
        ComplementaryPeak {
            peak: self.number(&margins.peak_complementary),
            attained: !matches!(margins.complementary_at, Extreme::At { attained: false, .. }),
            frequency: self.at(margins.complementary_at.place()),
        }
    }

    fn disk(&self, disk: &response::DiskMargin) -> DiskMarginFound {
        let gains = |bits| disk.gains(bits);
        DiskMarginFound {
            skew: Exact::from(&disk.skew),
            alpha: disk.alpha.as_ref().map(|a| self.number(a)),
            gain: [self.decimal(|bits| Some(gains(bits).0)), self.decimal(|bits| gains(bits).1)],
            phase_degrees: self.decimal(|bits| Some(disk.degrees(bits))).unwrap_or_default(),
            frequency: self.at(disk.extreme.as_ref().and_then(Extreme::place)),
        }
    }

    fn crossings(&self, crossings: &Crossings) -> CrossingsFound {
        let gain = crossings.gain.iter().map(|c| GainCrossingFound {
            phase_margin_degrees: self
                .decimal(|bits| Some(response::degrees(&c.phase(bits + 16), bits)))
                .unwrap_or_default(),
            delay: self.decimal(|bits| c.delay(self.margins.open_loop.frequencies(), bits)),
            delay_seconds: self.decimal(|bits| {
                let period = self.margins.open_loop.sample_time().filter(|_| self.shape() == Shape::UnitDisc)?;
                let period = number::Enclosure::from_rational(period.clone());
                Some(c.delay(self.margins.open_loop.frequencies(), bits + 16)?.mul(&period, bits))
            }),
            direction: c.direction,
            frequency: self.at(Some(&c.place)),
        });
        let phase = crossings.phase.iter().map(|c| {
            let narrow = c.factor.enclosure(real::bits_for(self.digits));
            PhaseCrossingFound {
                factor: self.decimal(|bits| Some(c.factor.enclosure(bits))).unwrap_or_default(),
                exact: match &c.factor {
                    Value::Number(x) => x.exact().as_ref().map(Exact::from),
                    Value::Quotient { .. } => None,
                },
                enclosure: super::number::enclosure(narrow.lower(), narrow.upper()),
                frequency: self.at(Some(&c.place)),
            }
        });
        CrossingsFound {
            gain: gain.collect(),
            gain_everywhere: crossings.gain_everywhere,
            phase: phase.collect(),
            phase_everywhere: crossings.phase_everywhere,
        }
    }
}

impl Margins {
    /// The document, also of margins that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, margins: Result<&response::Margins, &Exhausted>, digits: usize) -> Self {
        let found = |margins: &response::Margins| {
            let writer = Writer { margins, digits };
            let stable = margins.stable.as_ref();
            MarginsFound {
                at: margins.open_loop.cut().name().to_owned(),
                stable: margins.verdict.verdict == answer::Verdict::Stable,
                roots: RootsByPlace::from(&margins.verdict),
                gain: stable.map(|m| writer.gain(&m.gain)),
                phase: stable.map(|m| writer.phase(m)),
                delay: stable.map(|m| writer.delay(&m.delay)),
                modulus: stable.map(|m| writer.modulus(m)),
                complementary: stable.map(|m| writer.complementary(m)),
                disk: stable.map(|m| writer.disk(&m.disk)),
                crossings: writer.crossings(&margins.crossings),
            }
        };
        Margins { schema: MarginsName::V1, question: PointQuestion::new(problem), answer: Answered::of(margins, found) }
    }
}

impl Document for Answer<response::Margins> {
    type Json = Margins;

    /// The document `jurist/margins/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        Margins::new(self.problem(), Ok(self.value()), digits)
    }
}
