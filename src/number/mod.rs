//! Exact integers and rationals, their parsing and printing, and certified enclosures.
//!
//! This is the only module that names malachite; the rest of the crate, and its users, see
//! [`Integer`] and [`Rational`]. Conversions from and to `num-bigint` and `num-rational` stand at
//! this edge.

mod integer;
mod rational;

pub use integer::Integer;
pub use rational::Rational;

/// The sign of a number: `Less` for negative, `Equal` for zero, `Greater` for positive.
pub type Sign = std::cmp::Ordering;
