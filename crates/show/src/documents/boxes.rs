//! The document `jurist/map-boxes/1`.

use super::map::variables;
use super::requirements::RequirementAsked;
use super::schema_name;
use super::{Answered, Curve, Exact, MapQuestion};
use crate::Document;
use jurist_algebra::limits::Exhausted;
use jurist_engine::answer::{self, Answer};
use jurist_engine::problem::Problem;
use jurist_engine::response;
use jurist_engine::stability::plane::boxes;
use serde::{Deserialize, Serialize};

schema_name!(MapBoxesName, "jurist/map-boxes/1");

/// A window of two parameters cut into boxes, each proved stable, proved unstable or left undecided.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MapBoxes {
    /// The kind of document.
    pub schema: MapBoxesName,
    /// What was asked.
    #[serde(flatten)]
    pub question: MapQuestion,
    /// The boxes; none where not even the curves were found.
    #[serde(flatten)]
    pub answer: Answered<SubdividedWindow, MapBoxesOpen>,
}

/// The boxes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SubdividedWindow {
    /// The part of the domain that the boxes cover.
    pub window: Window,
    /// The share of its area that was allowed to stay undecided.
    pub goal: Exact,
    /// The curves on which stability can change.
    pub curves: Vec<Curve>,
    /// Areas in the product of the parameters' units; the last three add up to the first.
    pub areas: Areas,
    /// The boxes by lower x, then lower y.
    pub boxes: Vec<PlaneBox>,
    /// The budget that ran out before the goal was reached; `null` where none did.
    pub stopped: Option<String>,
    /// Why there is no exact map, where that was looked for first; left out where it was not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_exact_map: Option<String>,
    /// The stable boxes by whether requirements are met; left out where nothing is required.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub required: Option<RequiredInBoxes>,
    /// Other names, for all of whose values it holds what is said of the boxes; left out where there are none. For each point of a box that is
    /// not stable then there are values for which the loop is not.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub for_all: Vec<AllValues>,
}

/// A name and the closed range of its values.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AllValues {
    /// The name.
    pub name: String,
    /// The least value.
    pub lower: Exact,
    /// The greatest value.
    pub upper: Exact,
}

impl From<&response::AllOf> for AllValues {
    fn from(all: &response::AllOf) -> Self {
        let [lower, upper] = all.range.each_ref().map(Exact::from);
        AllValues { name: all.name.clone(), lower, upper }
    }
}

/// Where requirements are met: the stable boxes, cut further.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredInBoxes {
    /// Where margins are taken, as it was asked for.
    pub at: Option<String>,
    /// What is required.
    pub requirements: Vec<RequirementAsked>,
    /// Areas in the product of the parameters' units; they add up to that of the stable boxes.
    pub areas: RequiredAreas,
    /// The boxes by lower x, then lower y; together they are the stable ones.
    pub boxes: Vec<RequiredBox>,
    /// The budget that ran out before the goal was reached; `null` where none did.
    pub stopped: Option<String>,
}

/// Exact areas.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredAreas {
    /// Of the boxes in which all requirements are met.
    pub met: Exact,
    /// Of those in which one is met nowhere.
    pub unmet: Exact,
    /// Of the rest.
    pub undecided: Exact,
}

/// An open box of stable points.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredBox {
    /// Where it is.
    #[serde(flatten)]
    pub window: Window,
    /// Whether all requirements are met at all points, or not all at any; `null` where neither is proved.
    pub met: Option<bool>,
    /// The name of a requirement that is met at no point, else `null`.
    pub unmet: Option<String>,
}

impl From<&response::RequiredBoxes> for RequiredInBoxes {
    fn from(found: &response::RequiredBoxes) -> Self {
        let one = |b: &response::RequiredBox| RequiredBox {
            window: (&b.window).into(),
            met: b.met,
            unmet: b.unmet.map(|k| found.requirements[k].name().to_owned()),
        };
        RequiredInBoxes {
            at: found.at.clone(),
            requirements: found.requirements.iter().map(RequirementAsked::from).collect(),
            areas: RequiredAreas {
                met: (&found.areas.met).into(),
                unmet: (&found.areas.unmet).into(),
                undecided: (&found.areas.undecided).into(),
            },
            boxes: found.boxes.iter().map(one).collect(),
            stopped: found.stopped.as_ref().map(ToString::to_string),
        }
    }
}

/// No boxes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MapBoxesOpen {
    /// Not known.
    pub boxes: (),
}

/// A rectangle.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Window {
    /// Lower and upper x.
    pub x: [Exact; 2],
    /// Lower and upper y.
    pub y: [Exact; 2],
}

impl From<&boxes::Window> for Window {
    fn from(window: &boxes::Window) -> Self {
        Window { x: window.x.each_ref().map(Exact::from), y: window.y.each_ref().map(Exact::from) }
    }
}

/// Exact areas.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Areas {
    /// Of the window.
    pub window: Exact,
    /// Of the boxes proved stable.
    pub stable: Exact,
    /// Of the boxes proved to hold no stable point.
    pub unstable: Exact,
    /// Of the rest.
    pub undecided: Exact,
}

/// An open box.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlaneBox {
    /// Where it is.
    #[serde(flatten)]
    pub window: Window,
    /// What is proved of all its points.
    pub verdict: BoxVerdict,
    /// The number of roots outside the region, where it is known to be the same at all points, else `null`.
    pub outside: Option<usize>,
}

/// What is proved of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum BoxVerdict {
    /// Stable at every point.
    Stable,
    /// Stable at no point.
    Unstable,
    /// Nothing.
    Undecided,
}

impl From<&boxes::PlaneBox> for PlaneBox {
    fn from(b: &boxes::PlaneBox) -> Self {
        let (verdict, outside) = match b.verdict {
            boxes::BoxVerdict::Stable => (BoxVerdict::Stable, Some(0)),
            boxes::BoxVerdict::Unstable { outside } => (BoxVerdict::Unstable, outside),
            boxes::BoxVerdict::Undecided => (BoxVerdict::Undecided, None),
        };
        PlaneBox { window: (&b.window).into(), verdict, outside }
    }
}

impl MapBoxes {
    /// The document, also of an answer that the budget did not allow.
    pub fn new(problem: &Problem, answer: Result<&answer::MapBoxes, &Exhausted>) -> Self {
        let known = |answer::MapBoxes { goal, boxes: map, no_exact_map, required, for_all, .. }: &answer::MapBoxes| {
            SubdividedWindow {
                window: (&map.window).into(),
                goal: goal.into(),
                curves: map.curves.iter().map(|curve| Curve::new(curve, &variables(problem))).collect(),
                areas: Areas {
                    window: (&map.window.area()).into(),
                    stable: (&map.areas.stable).into(),
                    unstable: (&map.areas.unstable).into(),
                    undecided: (&map.areas.undecided).into(),
                },
                boxes: map.boxes.iter().map(PlaneBox::from).collect(),
                stopped: map.stopped.as_ref().map(ToString::to_string),
                no_exact_map: no_exact_map.as_ref().map(Exhausted::to_string),
                required: required.as_ref().map(RequiredInBoxes::from),
                for_all: for_all.iter().map(AllValues::from).collect(),
            }
        };
        MapBoxes { schema: MapBoxesName::V1, question: MapQuestion::new(problem), answer: Answered::of(answer, known) }
    }
}

impl Document for Answer<answer::MapBoxes> {
    type Json = MapBoxes;

    /// The document `jurist/map-boxes/1`.
    fn json(&self, _digits: usize) -> Self::Json {
        MapBoxes::new(self.problem(), Ok(self.value()))
    }
}
