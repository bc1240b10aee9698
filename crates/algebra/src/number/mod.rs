//! Exact integers and rationals, their parsing and printing, and certified enclosures.
//!
//! This is the only module that names malachite; the rest of the crate, and its users, see
//! [`Integer`] and [`Rational`]. Conversions from and to `num-bigint` and `num-rational` stand at
//! this edge.

mod binary;
mod convert;
mod decimal;
mod enclosure;
mod huge;
mod integer;
mod parse;
mod rational;
mod root;
mod rounding;
mod spaced;
#[cfg(feature = "strategies")]
pub mod strategies;

pub use binary::BinaryFormat;
pub use convert::DivisionByZero;
pub use decimal::{enclosed_decimal, to_decimal, to_scientific};
pub use enclosure::{Enclosure, to_decimal_refining};
pub use integer::Integer;
pub use parse::{
    MAX_DECIMAL_EXPONENT, MAX_LITERAL_LENGTH, ParseNumberError, ParseNumberErrorKind, parse_decimal_literal,
    parse_number, scan_decimal_literal,
};
pub use rational::Rational;
pub use spaced::evenly_spaced;

/// The sign of a number: `Less` for negative, `Equal` for zero, `Greater` for positive.
pub type Sign = std::cmp::Ordering;
