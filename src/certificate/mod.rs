#![doc = include_str!("grammar.md")]

pub mod check;
mod cofactors;
pub mod emit;
pub mod format;
mod line;
pub mod smt2;

#[doc = include_str!("proved.md")]
pub mod proved {}
