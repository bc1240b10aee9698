//! Pictures and pages of answers, and simulation in floating point. Nothing is decided here.
//!
//! | room | what it does |
//! |---|---|
//! | [`simulate`] | responses and root loci in floating point: observations, never verdicts |
//! | [`scene`] | a drawing as data, written as SVG, PNG, PDF or in characters |
//! | [`figures`] | axes and what stands between them: maps, loci, responses, block diagrams |
//! | [`page`] | self-contained HTML pages |
//! | [`report`] | one page about one loop |
//! | [`document`] | responses and root loci as JSON |

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod document;
pub mod figures;
pub mod page;
pub mod report;
pub mod scene;
pub mod simulate;
