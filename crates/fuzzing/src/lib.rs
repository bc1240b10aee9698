//! Harness functions shared by the fuzz targets and the tests that replay their corpora.
//!
//! Each takes arbitrary bytes and panics exactly if a promise of the crate is broken.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod certificate;
pub mod endless;
mod isolation;
mod model;
mod number;
mod sampled;
mod stability;

pub use certificate::certificate_check;
pub use isolation::isolation_against_sturm;
pub use model::model_parser;
pub use number::number_parser;
pub use sampled::sampled_against_float_roots;
pub use stability::{interval_answer, jury_against_count};
