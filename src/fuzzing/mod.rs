//! Harness functions shared by the fuzz targets and the tests that replay their corpora.
//!
//! Each takes arbitrary bytes and panics exactly if a promise of the crate is broken.

mod number;

pub use number::number_parser;
