//! Certificates that are made with what the check sees as the judge of each box: where no exact certificate is, and of requirements.
//!
//! They say no more than the answer they are made of; what the checkers do not see stays unknown.
//!
//! ```
//! use jurist_algebra::limits::Budget;
//! use jurist_check::{Limits, check};
//! use jurist_engine::problem::Ask;
//! use jurist_model::Model;
//! use jurist_prove::certified::certify_verdict;
//! let (drive, budget) = (Model::drive(), Budget::unlimited());
//! let certificate = certify_verdict(&drive.ask().verdict(&budget)?, &budget)?;
//! assert!(check(&drive.source().text, &certificate, &Limits::default()).is_ok());
//! # Ok::<(), jurist_model::error::Error>(())
//! ```

mod boxes;
mod for_all;
mod intervals;
mod search;
mod tolerance;
#[cfg(feature = "tune")]
mod tuned;

pub use boxes::{CertifiedBoxes, certify_boxes, judge, refuse_required};
pub use for_all::{certify_requirements, certify_verdict};
pub use intervals::{CertifiedIntervals, certify_intervals, certify_required_intervals};
pub use tolerance::{CertifiedTolerance, certify_tolerance};
#[cfg(feature = "tune")]
pub use tuned::certify_tune;
