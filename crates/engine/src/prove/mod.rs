//! What independent programs can check: certificates, and statements for SMT solvers.

mod cofactors;
mod emit;
mod line;
mod smt2;
mod text;

pub use emit::SCHEMA;
