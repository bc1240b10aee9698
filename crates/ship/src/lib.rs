//! A controller as it is stored and run: its coefficients rounded, its signals bounded, its code.
//!
//! | room | what it does |
//! |---|---|
//! | [`answer`] | everything together, for people and programs |
//! | [`asked`] | what `[ship]` and options ask for |
//! | [`shipped`] | the stored coefficients, put into the loop; every rounding |
//! | [`fewest`] | how many bits behind the point are enough |
//! | [`limits`] | how a limit moves with the number of bits |
//! | [`ranges`] | how large signals become, and what their rounding adds |
//! | [`document`] | the answer as JSON |
//! | [`dsverifier`] | loops of DSVerifier as models |
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

pub mod answer;
pub mod asked;
pub mod document;
pub mod dsverifier;
pub mod emit;
mod every;
pub mod fewest;
pub mod format;
pub mod limits;
pub mod program;
pub mod ranges;
pub mod realise;
pub mod run;
pub mod shipped;
mod text;
