//! From model text to a [`Model`], and from a loop to exact polynomials.
//!
//! A model is a TOML text: constants, parameters, and the loop in one of four forms. Every number
//! is read by its own text and stays exact; every mistake is reported with its place, several in
//! one run.
//!
//! Expressions are evaluated with all parameters symbolic before any value is set. So the degree
//! of the characteristic polynomial, and the points where some expression divides by zero, do not
//! depend on the values.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod between;
mod builder;
mod closed_loop;
mod complex;
mod complex_loop;
mod connect;
mod definition;
mod discretization;
pub mod error;
mod evaluate;
mod evaluated;
pub mod examples;
mod expectation;
mod free;
mod in_numbers;
mod loop_line;
mod nominal;
mod open_loop;
mod parts;
mod precisions;
mod presupposed;
#[cfg(feature = "schema")]
pub mod published;
mod read;
mod realised;
mod refusals;
pub mod requirements;
mod shipping;
mod steady;
mod symbols;
mod text;
mod tolerance;
mod tuning;
mod written;

pub use between::Between;
pub use between::no_transfer_of_several_rates;
pub use builder::{BlockBuilder, ModelBuilder, ParameterBuilder};
pub use closed_loop::{ClosedLoop, TransferFunction};
pub use complex::ComplexPolynomial;
pub use connect::samples::{Samples, SamplesPart, in_powers, rank_bound};
pub use definition::{
    Block, Constant, Diagram, Discretization, Dynamics, Form, Matrix, Model, Name, Output, Parameter, Ports, Pulses,
    Pwm, Rate, RequirementText, Simulation, Time,
};
pub use discretization::{Edges, Method};
pub use evaluated::Evaluated;
pub use expectation::{Claim, ClaimKind, Expectation};
pub use in_numbers::InNumbers;
pub use loop_line::LoopLine;
pub use nominal::Nominal;
pub use open_loop::Cut;
pub use open_loop::{MoreDeadTime, OnlyHold, Opened};
pub use presupposed::{Presupposed, Presupposition};
pub use read::{DRIVE, Reference, schema, source_from_bytes};
pub use realised::RealisedBlocks;
pub use refusals::NO_FIXED_ORDER;
pub use shipping::{NumberFormat, Shipping};
pub use symbols::{Definition, Meaning, Symbol, Symbols, value_approximate};
pub use symbols::{beside, quotient_at};
pub use text::is_blank_letter;
pub use text::names::shorten;
pub use text::{Expression, Factor, Function, Level, MAX_DEPTH, MAX_EXPONENT, Node, Sign, nearest_name};
pub use tolerance::Tolerance;
pub use tuning::Tuning;
pub use written::Written;
