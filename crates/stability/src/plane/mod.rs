//! Two parameters at once: the plane cut into open cells of constant root count.

pub mod boxes;
mod certified;
mod content;
mod curves;
mod decompose;
mod glue;
mod ground;
mod integers;
mod layers;
mod limit;
mod nodes;
mod over_symbols;
mod projection;
mod query;
mod sturm_at;
mod through;
mod touching;

pub use certified::{at_height, critical_polynomials, over};
pub use curves::{Curve, PlanePolynomial, boundary_curves, coprime_polynomials, vanishing_boundary};
pub use decompose::{Branch, Cell, StabilityMap, StableRegion, Strip, stability_map};
pub use glue::{Join, joins};
pub use layers::{Asked, layers};
pub use limit::{Limit, RegionLimits, region_limits};
