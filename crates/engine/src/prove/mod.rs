//! What independent programs can check: certificates, and statements for SMT solvers.

mod cofactors;
pub mod emit;
mod line;
pub mod smt2;
mod text;
