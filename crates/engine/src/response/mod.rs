//! Frequency response and margins, exactly.
//!
//! A loop is cut at one scalar signal: with the factor `k` put in there its characteristic polynomial is `D(z; k) = D0 + k N`,
//! and `L = N/D0` is the open loop, the feedback's sign included, so that `L = -1` is the critical point. On the boundary of
//! stability the moduli, products and differences of such polynomials are polynomials in one real variable
//! ([`HalfSizePair`](crate::stability::HalfSizePair)), whose zeros are isolated; every margin is an algebraic number or a known function of one.

mod affine;
mod along_axis;
mod along_circle;
mod asked;
mod asked_functions;
mod axis_end;
mod by_gain;
mod cells;
mod complex_loop;
mod complex_poly;
mod crossings;
mod damped;
mod dead_time;
mod delay;
mod delayed_set;
mod disk;
mod enclosed;
mod extreme;
mod family;
mod for_all;
mod for_all_line;
mod for_all_open;
pub(crate) mod ground;
mod held_delay;
mod level;
mod loop_functions;
mod margin_ranges;
mod margins;
mod met;
mod norm;
mod on_axis;
mod on_circle;
mod on_roots;
mod one_sided;
mod open_loop;
mod opened;
mod over_box;
mod over_boxes;
mod over_symbols;
mod parts;
mod peak_to_peak;
mod place;
mod required_boxes;
mod required_family;
mod required_map;
mod required_set;
mod requirement;
mod requirement_boxes;
mod spiral;
mod taylor_along;
mod turning;
mod value;

pub use asked::Requirements;
pub(crate) use complex_loop::root_on_boundary;
pub use crossings::{Crossings, Direction, GainCrossing, PhaseCrossing};
pub use delay::DelayMargin;
pub use disk::DiskMargin;
pub(crate) use disk::degrees;
pub use extreme::Extreme;
pub(crate) use family::Family;
pub use for_all::{AllOf, MOST_RANGES, MapForAll};
pub use held_delay::HeldDelay;
pub use level::{Level, LevelAsked};
pub use margin_ranges::{MarginLevel, MarginRanges, USUAL_MARGINS};
pub use margins::{GainMargin, Margins, PhaseMargin, StableMargins};
pub(crate) use met::half_tangent;
pub use norm::{Norm, PeakGain};
pub use one_sided::{OneSided, Rotation};
pub use open_loop::OpenLoop;
pub use over_box::Certain;
pub use peak_to_peak::PeakToPeak;
pub use place::{Frequencies, Place};
pub use required_boxes::{RequiredAreas, RequiredBox, RequiredBoxes};
pub(crate) use required_family::RequiredFamily;
pub use required_map::{RequiredMap, RequiredRegions};
pub use required_set::{RequiredEnd, RequiredInterval, RequiredSet, RequirementMet};
pub(crate) use requirement::{Found, LIST, Rule, radius_below};
pub use requirement::{Requirement, RequirementKind, RequirementOption};
pub use requirement_boxes::{OverPoints, RequirementBoxes};
pub use turning::Turning;
pub use value::Value;
