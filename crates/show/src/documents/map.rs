//! The document `jurist/map/1`.

use super::Answered;
use super::end::{Bounds, FrequencyOfPair, PlainEnd};
use super::number::{Enclosure, Exact, Named, Number, enclosure};
use super::plan::Plan;
use super::question::{RegionBound, title};
use super::required_map::RequiredInPlane;
use super::schema_name;
use crate::Document;
use crate::map::wall_cause;
use crate::real::JSON_NUMBER_DIGITS;
use crate::region::{boundary_point, causes_text};
use jurist_algebra::limits::Exhausted;
use jurist_algebra::number::{self, enclosed_decimal};
use jurist_algebra::poly::{Monomial, MultiPoly};
use jurist_algebra::real::Real;
use jurist_engine::answer::{self, Answer, MapLimit, RegionExtent};
use jurist_engine::model::Time;
use jurist_engine::problem::{Free, Problem};
use jurist_engine::stability::plane::{self, StabilityMap, StableRegion};
use serde::{Deserialize, Serialize};

schema_name!(MapName, "jurist/map/1");

/// The stable region in the plane of two parameters, cut into cells of constant root count.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Map {
    /// The kind of document.
    pub schema: MapName,
    /// What was asked.
    #[serde(flatten)]
    pub question: MapQuestion,
    /// The map.
    #[serde(flatten)]
    pub answer: Answered<Regions, MapOpen>,
}

/// Of each parameter one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "PairOf{T}"))]
pub struct Pair<T> {
    /// Of the first parameter.
    pub x: T,
    /// Of the second parameter.
    pub y: T,
}

/// A question about two parameters.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MapQuestion {
    /// The model's title; empty where it has none.
    pub title: String,
    /// The kind of time.
    pub time: Time,
    /// The name of the first parameter.
    pub x: String,
    /// The name of the second parameter.
    pub y: String,
    /// The parameters' units; `null` where the model names none.
    pub unit: Pair<Option<String>>,
    /// Their nominal values in these units; `null` where they have none.
    pub nominal: Pair<Option<Exact>>,
    /// The values of all other parameters, and of constants that were replaced.
    pub set: Named<Exact>,
    /// The open intervals of values that are asked about.
    pub domain: Pair<Bounds<Exact>>,
    /// The region.
    #[serde(flatten)]
    pub region: RegionBound,
    /// How the question is decided, where that was asked for with `--explain`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Box<Plan>>,
}

/// The exact decomposition: curves, strips between critical values of x, cells between branches of the curves.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Regions {
    /// Whether the loop is stable at no point for one reason; then there are no curves, strips and regions.
    pub never_stable: bool,
    /// That reason: `undefined`, or the cause whose boundary polynomial vanishes identically. Left out where
    /// `never_stable` is false.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub never_stable_cause: Option<Option<String>>,
    /// The curves on which stability can change.
    pub curves: Vec<Curve>,
    /// What the names in the coefficients of the curves stand for; left out where these are integers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub constants: Option<Named<String>>,
    /// The open strips from left to right.
    pub strips: Vec<Strip>,
    /// The connected stable regions.
    pub regions: Vec<PlaneRegion>,
    /// Where requirements are met; left out where nothing is required.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub required: Option<RequiredInPlane>,
}

/// No map.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MapOpen {
    /// Not known.
    pub never_stable: (),
    /// Not known.
    pub curves: (),
    /// Not known.
    pub strips: (),
    /// Not known.
    pub regions: (),
}

/// The zeros of a polynomial in both parameters.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Curve {
    /// What happens on the curve: causes as in `jurist/intervals/1`.
    pub name: String,
    /// The polynomial.
    pub terms: Vec<CurveTerm>,
}

/// The powers of x and y, and what is before them.
pub type CurveTerm = (u32, u32, Coefficient);

/// An integer, or a polynomial in the document's `constants` with integer coefficients: `2*X1^2 - X1 + 1`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(transparent)]
pub struct Coefficient(String);

impl Coefficient {
    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl Curve {
    /// Of a curve whose symbols, variables from 2 on, have names in this list of all variables.
    pub(super) fn new(curve: &plane::Curve, variables: &[String]) -> Self {
        let powers = |m: &Monomial| (m.exponent(0), m.exponent(1));
        let mut all: Vec<(u32, u32)> = Vec::new();
        for (m, _) in curve.polynomial.terms() {
            if !all.contains(&powers(m)) {
                all.push(powers(m));
            }
        }
        let coefficient = |of: (u32, u32)| {
            let own = curve.polynomial.terms().iter().filter(|(m, _)| powers(m) == of);
            let constant = |m: &Monomial| m.with_exponent(0, 0).with_exponent(1, 0).exponents().to_vec();
            let number = MultiPoly::from_terms(own.map(|(m, c)| (constant(m), c.clone())));
            Coefficient(number.display(variables).to_string())
        };
        let terms = all.into_iter().map(|of| (of.0, of.1, coefficient(of))).collect();
        Curve { name: curve.causes.to_string(), terms }
    }
}

/// The names of all variables of the curves of a map.
pub(super) fn variables(problem: &Problem) -> Vec<String> {
    let polynomial = problem.evaluated().and_then(|algebra| algebra.polynomial());
    polynomial.map(|d| d.variables.clone()).unwrap_or_default()
}

/// An open strip of the domain.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Strip {
    /// Between which values of x.
    pub x: Bounds<Wall>,
    /// A value of x inside.
    pub sample: Exact,
    /// The cells from below.
    pub cells: Vec<Cell>,
}

/// A value of x at which a strip ends.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Wall {
    /// The value.
    #[serde(flatten)]
    pub number: Number,
    /// The causes of curves that contain the line, `domain`, or `critical point`: branches meet, end or run to infinity.
    pub cause: String,
    /// Always `null`: along a line the frequency varies.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
    /// Whether the line belongs to the strip.
    pub closed: bool,
}

/// An open cell of a strip.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Cell {
    /// The branch below; `null` at the domain's edge.
    pub lower: Option<Branch>,
    /// The branch above; `null` at the domain's edge.
    pub upper: Option<Branch>,
    /// The verdict at all its points.
    pub verdict: CellVerdict,
    /// Roots outside the region, the same number at all its points.
    pub outside: usize,
    /// A value of y inside, at the strip's sample.
    pub sample: Exact,
}

/// The verdict on a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum CellVerdict {
    /// All roots strictly inside the region.
    Stable,
    /// Not stable.
    Unstable,
}

/// A branch of a curve over a strip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Branch {
    /// The number of the curve, from 0.
    pub curve: usize,
    /// The number of the root of the curve's polynomial in y, from 0 from below, of the real roots inside the domain.
    pub root: usize,
}

/// A connected region of stable points.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlaneRegion {
    /// Its cells: number of the strip and number of the cell, from 0.
    pub cells: Vec<(usize, usize)>,
    /// The least and the greatest x on its boundary.
    pub x: Bounds<RegionEnd>,
    /// The least and the greatest y on its boundary.
    pub y: Bounds<RegionEnd>,
}

/// An extreme value of a region; only its place where the budget ended before what limits it was known.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum RegionEnd {
    /// With what limits it.
    Limit(RegionLimit),
    /// Only the place.
    Plain(PlainEnd),
}

/// An extreme value of a region with what limits it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RegionLimit {
    /// The value.
    #[serde(flatten)]
    pub number: Number,
    /// The causes, as in `jurist/intervals/1`.
    pub cause: String,
    /// The same with the points where the loop's own roots are; only where a smaller region is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundary: Option<String>,
    /// Where the complex pair is.
    #[serde(flatten)]
    pub frequency: FrequencyOfPair,
    /// Where the other parameter is then, one place for each cell that ends there; empty where the region ends along a
    /// line or at infinity of the other parameter.
    pub at: Vec<Place>,
    /// Whether the value belongs to the region.
    pub closed: bool,
}

/// An enclosed value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Place {
    /// With as many digits as the enclosure determines; `null` where it determines none.
    pub decimal: Option<String>,
    /// Certified bounds.
    pub enclosure: Enclosure,
}

impl Place {
    fn new(value: &number::Enclosure, digits: usize) -> Self {
        let (lo, hi) = (value.lower(), value.upper());
        let decimal = (1..=digits.min(JSON_NUMBER_DIGITS)).rev().find_map(|d| enclosed_decimal(lo, hi, d));
        Place { decimal, enclosure: enclosure(lo, hi) }
    }
}

impl MapQuestion {
    pub(super) fn new(problem: &Problem) -> Self {
        // A third free parameter is that of slices.
        let [x, y, ..] = problem.free() else { panic!("two parameters are free") };
        MapQuestion {
            title: title(problem),
            time: problem.time(),
            x: x.name.clone(),
            y: y.name.clone(),
            unit: Pair { x: x.unit.clone(), y: y.unit.clone() },
            nominal: Pair { x: x.nominal.as_ref().map(Exact::from), y: y.nominal.as_ref().map(Exact::from) },
            set: problem.set().into(),
            domain: Pair { x: (&x.domain).into(), y: (&y.domain).into() },
            region: problem.into(),
            plan: Plan::of(problem),
        }
    }
}

impl Strip {
    fn new(strip: &plane::Strip, map: &StabilityMap, x: &Free, digits: usize) -> Self {
        let wall = |side: usize| {
            let value = [&strip.x.lower, &strip.x.upper][side].as_ref()?;
            Some(Wall {
                number: Number::new(value, digits),
                cause: wall_cause(map, x, value, &strip.lines[side]),
                frequency: FrequencyOfPair::default(),
                closed: false,
            })
        };
        Strip {
            x: Bounds { lower: wall(0), upper: wall(1) },
            sample: (&strip.sample).into(),
            cells: strip.cells.iter().map(Cell::from).collect(),
        }
    }
}

impl From<&plane::Cell> for Cell {
    fn from(cell: &plane::Cell) -> Self {
        let branch = |b: plane::Branch| Branch { curve: b.curve, root: b.root };
        Cell {
            lower: cell.lower.map(branch),
            upper: cell.upper.map(branch),
            verdict: if cell.stable { CellVerdict::Stable } else { CellVerdict::Unstable },
            outside: cell.outside,
            sample: (&cell.sample).into(),
        }
    }
}

impl PlaneRegion {
    fn new(region: &StableRegion, limits: Option<&RegionExtent>, problem: &Problem, digits: usize) -> Self {
        let extents = [&region.x, &region.y].map(|interval| [&interval.lower, &interval.upper]);
        let end = |parameter: usize, side: usize| {
            let limit = limits.and_then(|l| l.ends[parameter][side].as_ref());
            RegionEnd::new(limit, extents[parameter][side].as_ref(), parameter, problem, digits)
        };
        let bounds = |parameter| Bounds { lower: end(parameter, 0), upper: end(parameter, 1) };
        PlaneRegion { cells: region.cells.clone(), x: bounds(0), y: bounds(1) }
    }
}

impl RegionEnd {
    /// The end of a parameter with its limit where that is known; `None` where there is no end.
    pub(super) fn new(
        limit: Option<&MapLimit>,
        value: Option<&Real>,
        parameter: usize,
        problem: &Problem,
        digits: usize,
    ) -> Option<Self> {
        match limit {
            Some(limit) => Some(RegionEnd::Limit(RegionLimit::new(limit, parameter, problem, digits))),
            None => value.map(|value| RegionEnd::Plain(PlainEnd::new(value.clone(), digits))),
        }
    }
}

impl RegionLimit {
    fn new(limit: &MapLimit, parameter: usize, problem: &Problem, digits: usize) -> Self {
        let place = |at: &[number::Enclosure; 2]| Place::new(&at[1 - parameter], digits);
        RegionLimit {
            number: Number::new(&limit.limit.value, digits),
            cause: limit.limit.causes.to_string(),
            boundary: boundary_point(problem).map(|_| causes_text(&limit.limit.causes, problem)),
            frequency: FrequencyOfPair::new(digits.min(JSON_NUMBER_DIGITS), |_| limit.frequency.clone()),
            at: limit.limit.at.iter().map(place).collect(),
            closed: false,
        }
    }
}

impl Regions {
    /// Of a map that is known.
    pub(super) fn new(answer: &answer::Map, problem: &Problem, digits: usize) -> Self {
        let (map, limits) = (&answer.decomposition, answer.limits());
        let region = |(k, r)| PlaneRegion::new(r, limits.get(k), problem, digits);
        Regions {
            never_stable: map.never_stable,
            never_stable_cause: map.never_stable.then(|| answer.never_stable_cause.map(str::to_owned)),
            curves: map.curves.iter().map(|curve| Curve::new(curve, &variables(problem))).collect(),
            constants: problem
                .evaluated()
                .filter(|_| map.has_symbols())
                .map(|algebra| algebra.symbols().definitions().into_iter().collect()),
            strips: map.strips.iter().map(|s| Strip::new(s, map, problem.axes()[0], digits)).collect(),
            regions: map.regions.iter().enumerate().map(region).collect(),
            required: answer.required.as_ref().map(|found| RequiredInPlane::new(found, digits)),
        }
    }
}

impl Map {
    /// The document, also of a map that the budget did not allow; decimals to so many significant digits.
    pub fn new(problem: &Problem, answer: Result<&answer::Map, &Exhausted>, digits: usize) -> Self {
        let known = |answer: &answer::Map| Regions::new(answer, problem, digits);
        Map { schema: MapName::V1, question: MapQuestion::new(problem), answer: Answered::of(answer, known) }
    }
}

impl Document for Answer<answer::Map> {
    type Json = Map;

    /// The document `jurist/map/1`, decimals to so many significant digits.
    fn json(&self, digits: usize) -> Self::Json {
        Map::new(self.problem(), Ok(self.value()), digits)
    }
}
