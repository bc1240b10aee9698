//! Two parameters at once: the plane cut into open cells of constant root count.

mod curves;
mod decompose;
mod elimination;
mod glue;
mod query;
mod sturm_at;

pub use curves::{Curve, PlanePolynomial, boundary_curves};
pub use decompose::{Branch, Cell, StabilityMap, StableRegion, Strip, stability_map};
