//! From model text to a [`Loop`], and from a loop to exact polynomials.
//!
//! A model is a TOML text: constants, parameters, and the loop in one of four forms. Every number
//! is read by its own text and stays exact; every mistake is reported with its place, several in
//! one run.
//!
//! Expressions are evaluated with all parameters symbolic before any value is set. So the degree
//! of the characteristic polynomial, and the points where some expression divides by zero, do not
//! depend on the values.

mod builder;
mod check;
mod closed_loop;
mod definition;
mod evaluate;
pub mod examples;
mod expression;
mod free;
mod lexer;
mod linear;
mod names;
mod parser;
mod parts;
mod read;
mod read_block;
mod read_loop;
mod scalar;
mod simulation;
mod state_space;
mod symbolic;
mod text;
mod toml;
mod toml_read;
mod transfer;
mod zpoly;

pub use builder::{BlockBuilder, LoopBuilder, ParameterBuilder};
pub use closed_loop::{ClosedLoop, Evaluated, TransferFunction};
pub use definition::{
    Block, Constant, Diagram, Discretization, Dynamics, Form, Loop, Matrix, Method, Name, Output, Parameter, Ports,
    Pwm, Simulation, Time,
};
pub use expression::{Expression, Factor, Node, Sign};
pub use names::nearest_name;
pub(crate) use names::shorten;
pub use parser::{MAX_DEPTH, MAX_EXPONENT};
pub use read_loop::{DRIVE, source_from_bytes};
