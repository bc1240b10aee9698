//! What independent programs can check: certificates, statements for SMT solvers, theorems for Coq.

mod cofactors;
mod coq;
mod emit;
mod line;
mod smt2;
mod text;

pub use emit::SCHEMA;
