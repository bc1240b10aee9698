//! Pictures and pages of answers, and simulation in floating point. Nothing is decided here.
//!
//! | room | what it does |
//! |---|---|
//! | [`simulate`] | responses and root loci in floating point: observations, never verdicts |
//! | [`figures`] | drawings as SVG, PNG and on a terminal |
//! | [`page`] | self-contained HTML pages |
//! | [`document`] | responses and root loci as JSON |

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod document;
pub mod figures;
pub mod page;
pub mod simulate;
