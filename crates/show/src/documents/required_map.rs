//! Where requirements are met in the plane of two parameters, in the document `jurist/map/1`.

use super::end::{Bounds, PlainEnd};
use super::map::{Branch, Curve};
use super::number::Exact;
use super::requirements::RequirementAsked;
use jurist_engine::response::{RequiredMap, RequiredRegions};
use jurist_engine::stability::RealInterval;
use jurist_engine::stability::plane::{self, StableRegion};
use serde::{Deserialize, Serialize};

/// Where requirements are met: the plane cut by their curves and those of stability together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredInPlane {
    /// Where margins are taken, as it was asked for.
    pub at: Option<String>,
    /// What is required.
    pub requirements: Vec<RequirementAsked>,
    /// The curves on which stability can change, and, with an empty name, those on which only requirements can.
    pub curves: Vec<Curve>,
    /// The open strips from left to right.
    pub strips: Vec<RequiredStrip>,
    /// The regions of each requirement alone, then, of two and more, those of all together.
    pub sets: Vec<RequiredSetOfRegions>,
}

/// An open strip of the domain.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredStrip {
    /// Between which values of x.
    pub x: Bounds<PlainEnd>,
    /// A value of x inside.
    pub sample: Exact,
    /// The cells from below.
    pub cells: Vec<RequiredCell>,
}

/// An open cell of a strip.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredCell {
    /// The branch below; `null` at the domain's edge.
    pub lower: Option<Branch>,
    /// The branch above; `null` at the domain's edge.
    pub upper: Option<Branch>,
    /// Roots outside the region, the same number at all its points.
    pub outside: usize,
    /// The numbers of the requirements that are met at all its points, from 0; none where the loop is not stable.
    pub met: Vec<usize>,
    /// A value of y inside, at the strip's sample.
    pub sample: Exact,
}

/// The regions in which some requirements are met.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredSetOfRegions {
    /// The numbers of the requirements, from 0.
    pub requirements: Vec<usize>,
    /// The connected regions; the points on curves inside a region are not decided.
    pub regions: Vec<RequiredRegion>,
}

/// A connected region.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RequiredRegion {
    /// Its cells: number of the strip and number of the cell, from 0.
    pub cells: Vec<(usize, usize)>,
    /// The least and the greatest x on its boundary.
    pub x: Bounds<PlainEnd>,
    /// The least and the greatest y on its boundary.
    pub y: Bounds<PlainEnd>,
}

fn bounds(interval: &RealInterval, digits: usize) -> Bounds<PlainEnd> {
    let [lower, upper] =
        [&interval.lower, &interval.upper].map(|end| end.as_ref().map(|value| PlainEnd::new(value.clone(), digits)));
    Bounds { lower, upper }
}

impl RequiredSetOfRegions {
    fn new(found: &RequiredRegions, digits: usize) -> Self {
        let region = |r: &StableRegion| RequiredRegion {
            cells: r.cells.clone(),
            x: bounds(&r.x, digits),
            y: bounds(&r.y, digits),
        };
        RequiredSetOfRegions {
            requirements: found.requirements.clone(),
            regions: found.map.regions.iter().map(region).collect(),
        }
    }
}

impl RequiredInPlane {
    /// To so many digits.
    pub fn new(found: &RequiredMap, digits: usize) -> Self {
        let all = &found.all().map;
        let branch = |b: plane::Branch| Branch { curve: b.curve, root: b.root };
        let strip = |(s, strip): (usize, &plane::Strip)| RequiredStrip {
            x: bounds(&strip.x, digits),
            sample: (&strip.sample).into(),
            cells: strip
                .cells
                .iter()
                .enumerate()
                .map(|(c, cell)| RequiredCell {
                    lower: cell.lower.map(branch),
                    upper: cell.upper.map(branch),
                    outside: cell.outside,
                    met: found.met((s, c)),
                    sample: (&cell.sample).into(),
                })
                .collect(),
        };
        RequiredInPlane {
            at: found.at.clone(),
            requirements: found.requirements.iter().map(Into::into).collect(),
            curves: all.curves.iter().map(|curve| Curve::new(curve, &[])).collect(),
            strips: all.strips.iter().enumerate().map(strip).collect(),
            sets: found.regions.iter().map(|r| RequiredSetOfRegions::new(r, digits)).collect(),
        }
    }
}
