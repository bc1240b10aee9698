//! Certificates that are made with what the check sees as the judge of each box.

mod boxes;
mod intervals;
mod search;

#[cfg(feature = "commands")]
pub(crate) use boxes::judge;
pub use boxes::{CertifiedBoxes, certify_boxes};
pub use intervals::{CertifiedIntervals, certify_intervals};
