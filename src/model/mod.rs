//! From model text to a loop.

mod expression;
mod lexer;
mod literal;
mod names;
mod parser;
mod text;
mod toml;
mod toml_read;

pub use expression::{Expression, Factor, Node, Sign};
pub use names::nearest_name;
pub use parser::{MAX_DEPTH, MAX_EXPONENT};
