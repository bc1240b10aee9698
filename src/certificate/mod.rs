#![doc = include_str!("grammar.md")]

pub mod check;
pub mod format;

#[doc = include_str!("proved.md")]
pub mod proved {}
