//! The document `jurist/body/1`.

use super::end::{Bounds, PlainEnd};
use super::map::{MapOpen, MapQuestion, Pair, RegionEnd, Regions};
use super::number::Exact;
use super::schema_name;
use super::undecided::{Answered, Undecided};
use crate::Document;
use jurist_algebra::real::Real;
use jurist_engine::answer::{self, Answer};
use jurist_engine::problem::Problem;
use jurist_engine::stability::RealInterval;
use serde::{Deserialize, Serialize};

schema_name!(BodyName, "jurist/body/1");

/// The stable region in three parameters: exact maps of the first two at values of the third.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Body {
    /// The kind of document.
    pub schema: BodyName,
    /// What was asked about the first two parameters.
    #[serde(flatten)]
    pub question: MapQuestion,
    /// The name of the third parameter.
    pub z: String,
    /// Its unit; `null` where the model names none.
    pub z_unit: Option<String>,
    /// Its nominal value in that unit; `null` where it has none.
    pub z_nominal: Option<Exact>,
    /// The open interval of its values.
    pub z_domain: Bounds<Exact>,
    /// The slices by ascending values of the third parameter.
    pub slices: Vec<BodySlice>,
    /// The least and the greatest x and y over the slices that are decided, not over all values of the third parameter; `null` where
    /// no slice has stable points, and where the budget ended before.
    pub extremes: Option<Pair<Bounds<Extreme>>>,
    /// Where slices with stable points follow each other.
    pub stretches: Vec<Stretch>,
    /// How near to each other the two values at an end of a stretch were to come.
    pub narrow: Exact,
    /// The first thing that the budget did not allow; left out where everything is decided.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub undecided: Option<Undecided>,
}

/// The map at one value of the third parameter: the keys of `jurist/map/1` beside that value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BodySlice {
    /// The value.
    pub at: Exact,
    /// How far all regions together reach; `null` without a region and without a map.
    pub extent: Option<Pair<Bounds<PlainEnd>>>,
    /// The map.
    #[serde(flatten)]
    pub map: Answered<Regions, MapOpen>,
}

/// An extreme value over the slices.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Extreme {
    /// The value, with what limits the first of these slices there; `null` where a region is unbounded.
    pub end: Option<RegionEnd>,
    /// The numbers of the slices that reach it, from 0.
    pub slices: Vec<usize>,
}

/// Slices with stable points that follow each other.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Stretch {
    /// The number of the first of them, from 0.
    pub first: usize,
    /// The number of the last of them.
    pub last: usize,
    /// Below the first.
    pub lower: StretchEnd,
    /// Above the last.
    pub upper: StretchEnd,
}

/// Where a stretch ends in the third parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum StretchEnd {
    /// With the slices that were asked for.
    Range,
    /// Beside a slice that is not decided.
    Open,
    /// Between two values, each decided by an exact map.
    Between {
        /// Here there are stable points.
        stable: Exact,
        /// Here there are none.
        none: Exact,
        /// Why the values are farther apart than `narrow`; `null` where they are not.
        stopped: Option<Undecided>,
    },
}

impl From<&answer::StretchEnd> for StretchEnd {
    fn from(end: &answer::StretchEnd) -> Self {
        match end {
            answer::StretchEnd::Range => StretchEnd::Range,
            answer::StretchEnd::Open => StretchEnd::Open,
            answer::StretchEnd::Between { stable, none, stopped } => StretchEnd::Between {
                stable: stable.into(),
                none: none.into(),
                stopped: stopped.as_ref().map(Undecided::from),
            },
        }
    }
}

impl Extreme {
    fn new(extreme: &answer::Extreme, parameter: usize, problem: &Problem, digits: usize) -> Self {
        let end = RegionEnd::new(extreme.limit.as_ref(), extreme.value.as_ref(), parameter, problem, digits);
        Extreme { end, slices: extreme.slices.clone() }
    }
}

impl Document for Answer<answer::Body> {
    type Json = Body;

    /// The document `jurist/body/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        let (problem, body) = (self.problem(), self.value());
        let third = &problem.free()[2];
        let bounds = |interval: &RealInterval| {
            let end = |value: &Option<Real>| value.clone().map(|value| PlainEnd::new(value, digits));
            Bounds { lower: end(&interval.lower), upper: end(&interval.upper) }
        };
        let slice = |slice: &answer::BodySlice| BodySlice {
            at: (&slice.value).into(),
            extent: slice.extent.as_ref().map(|[x, y]| Pair { x: bounds(x), y: bounds(y) }),
            map: Answered::of(slice.map.as_ref(), |map| Regions::new(map.value(), map.problem(), digits)),
        };
        let extremes = body.extremes.as_ref().ok().and_then(Option::as_ref).map(|extremes| {
            let of = |parameter: usize| {
                let [lower, upper] =
                    extremes.ends[parameter].each_ref().map(|e| Some(Extreme::new(e, parameter, problem, digits)));
                Bounds { lower, upper }
            };
            Pair { x: of(0), y: of(1) }
        });
        let stretch = |stretch: &answer::Stretch| Stretch {
            first: stretch.first,
            last: stretch.last,
            lower: (&stretch.ends[0]).into(),
            upper: (&stretch.ends[1]).into(),
        };
        Body {
            schema: BodyName::V1,
            question: MapQuestion::new(problem),
            z: third.name.clone(),
            z_unit: third.unit.clone(),
            z_nominal: third.nominal.as_ref().map(Exact::from),
            z_domain: (&third.domain).into(),
            slices: body.slices.iter().map(slice).collect(),
            extremes,
            stretches: body.stretches.iter().map(stretch).collect(),
            narrow: (&body.narrow).into(),
            undecided: body.stopped().map(Undecided::from),
        }
    }
}
