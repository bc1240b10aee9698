//! Code computes what the exact run computes: compiled by compilers of C and Rust, and read by an interpreter of structured text.
//!
//! `EMIT_SAMPLES=1000000` draws so many samples instead of a tenth of that.

mod cases;
mod compiled;
mod controllers;
mod drawn;
mod golden;
mod interpreter;
mod laws;
mod parser;
