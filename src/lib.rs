//! Exact stability limits of control loops.
//!
//! `jurist` answers for which values of its parameters a control loop is stable, with exact
//! arithmetic from the model's text to the verdict: no tolerance and no sampling in between.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod analysis;
pub mod certificate;
pub mod cli;
pub mod error;
#[cfg(feature = "strategies")]
pub mod fuzzing;
pub mod limits;
pub mod matrix;
pub mod model;
pub mod number;
pub mod poly;
pub mod report;
pub mod simulate;
pub mod stability;
