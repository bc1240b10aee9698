//! The JSON documents as types: what a program that reads them may rely on.
//!
//! Each document says its kind and version under `schema`; a kind keeps its version while keys are only added. Exact
//! numbers are texts ([`Exact`]); JSON numbers are rounded values and counts. The JSON Schemas made of these types are in
//! the folder `schema`, named after kind and version.
//!
//! ```
//! use jurist_algebra::limits::Budget;
//! use jurist_engine::model::Model;
//! use jurist_engine::problem::Ask;
//! use jurist_show::Document;
//! use jurist_show::documents::{self, Answered, Intervals};
//! let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited()).unwrap();
//! let text = documents::to_text(&answer.json(12));
//! let read: Intervals = serde_json::from_str(&text).unwrap();
//! let Answered::Known(found) = read.answer else { panic!("no budget, no end of it") };
//! assert_eq!(found.stable[0].lower.as_ref().unwrap().number.decimal, "0.0381005333483");
//! ```

mod analyze;
mod body;
mod boxes;
mod charpoly;
mod check;
mod crossings;
mod end;
mod intervals;
mod jury;
mod least_margins;
mod list;
mod lock;
mod map;
mod margin_ranges;
mod margins;
mod norm;
mod number;
mod over;
mod plan;
mod question;
mod required_map;
mod requirements;
mod roots;
#[cfg(feature = "schema")]
pub mod schemas;
mod test;
mod tolerance;
mod undecided;
mod verdict;

pub use analyze::{Analysis, AnalysisName};
pub use body::{Body, BodyName, BodySlice, Extreme, Stretch, StretchEnd};
pub use boxes::{
    AllValues, Areas, BoxVerdict, MapBoxes, MapBoxesName, MapBoxesOpen, PlaneBox, RequiredAreas, RequiredBox,
    RequiredInBoxes, SubdividedWindow, Window,
};
pub(crate) use charpoly::report_text;
pub use charpoly::{
    Charpoly, CharpolyName, Coefficient, Coefficients, CoefficientsOpen, KnownPolynomials, LocusQuotient,
    OpenPolynomials, Polynomials, PolynomialsOrNone, QuotientOpen, RootLocusForm, RootLocusFormName, Term, Transfer,
    TransferName, TransferQuotient,
};
pub use check::{Check, CheckName, Finding, FindingPlace, FindingSeverity};
pub use crossings::{CrossingsFound, GainCrossingFound, PhaseCrossingFound};
pub use end::{Bounds, End, FrequencyOfPair, PlainEnd};
pub use intervals::{Intervals, IntervalsName, IntervalsOpen, SensitivityFound, Stable, UndecidedEnclosure};
pub use jury::{
    Condition, Holds, Jury, JuryAtPoint, JuryInParameter, JuryName, PointTable, Relation, Row, RowsOpen, Solution,
    SolvedTable, TableInParameter, TableKind, TableOpen,
};
pub use least_margins::{LeastFound, LeastMargin, LeastMargins, LeastMarginsFound, LeastMarginsName, LeastMarginsOpen};
pub use list::{NAMES, through_its_type};
pub use lock::{Lock, LockName, LockedLimits};
pub use map::{
    Branch, Cell, CellVerdict, Curve, CurveTerm, Map, MapName, MapOpen, MapQuestion, Pair, Place, PlaneRegion,
    RegionEnd, RegionLimit, Regions, Strip, Wall,
};
pub use margin_ranges::{MarginRange, MarginRanges, MarginRangesName};
pub use margins::{
    ComplementaryPeak, DelayMarginFound, DiskMarginFound, GainMargins, Margins, MarginsFound, MarginsName, MarginsOpen,
    ModulusMargin, PhaseMarginFound,
};
pub use norm::{Norm, NormFound, NormName, NormOpen, PeakFound, PeakToPeakFound};
pub use number::{Enclosure, Exact, Named, Number, NumberKind};
pub use over::{AlgebraicPlace, Over};
pub use plan::{Plan, PlannedMethod};
pub use question::{ClosedEnds, Hyperperiod, ParameterQuestion, PointQuestion, RegionBound};
pub use required_map::{RequiredCell, RequiredInPlane, RequiredRegion, RequiredSetOfRegions, RequiredStrip};
pub use requirements::{RequirementAsked, RequirementFound};
pub use roots::{RootFound, Roots, RootsFound, RootsName, RootsOpen};
pub use test::{Test, TestName, TestStatus, Tested, TestedFile};
pub use tolerance::{
    Factor, LimitRange, RequirementOverBox, Tolerance, ToleranceFound, ToleranceName, ToleranceOpen, ToleranceVerdict,
    VolumeShares, WitnessPoint, WorstPoint,
};
pub use undecided::{Answered, Open, Undecided};
pub use verdict::{RootsByPlace, Verdict, VerdictName, VerdictOpen};

use serde::Serialize;

/// The document as text, ending with a newline.
pub fn to_text(document: &impl Serialize) -> String {
    // Keys are texts and numbers finite, which always serialise.
    let mut text = serde_json::to_string_pretty(document).unwrap_or_default();
    text.push('\n');
    text
}

/// What stands under `schema` in documents of a kind.
macro_rules! schema_name {
    ($name:ident, $text:literal) => {
        #[doc = concat!("`", $text, "`.")]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum $name {
            /// The first version.
            #[default]
            #[serde(rename = $text)]
            V1,
        }
    };
}
use schema_name;
