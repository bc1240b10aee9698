//! A controller as it is stored and run: its coefficients rounded, its signals bounded, its code.
//!
//! | room | what it does |
//! |---|---|
//! | [`mod@format`] | number formats of processors, exact rounding |
//! | [`program`] | a realisation as a list of sums: run exactly, read as a linear system, printed as code |
//! | [`realise`] | from a transfer function to programs: direct forms, second-order sections, delta operator, state space |
//! | [`run`] | programs run as a processor runs them, in exact arithmetic |
//! | [`emit`] | programs as source code: C99, structured text, Rust |
//!
//! A rounded controller is put into the model's text in the place of the exact one. So every question, every certificate and both checkers
//! know it without knowing anything of rounding.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod emit;
pub mod format;
pub mod program;
pub mod realise;
pub mod run;
