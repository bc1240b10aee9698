//! Text to trees: TOML to tables with places, expressions to their structure. What the names mean is
//! decided elsewhere.

mod expression;
mod function;
mod lexer;
mod located;
pub(crate) mod names;
mod parser;
mod toml_hints;
pub(crate) mod toml_reader;
pub(crate) mod toml_value;

pub use expression::{Expression, Factor, Level, Node, Sign};
pub use function::Function;
pub(crate) use function::{PI, UNIT, hint};
pub use lexer::is_blank_letter;
pub(crate) use lexer::is_name;
pub(crate) use located::Text;
pub use names::nearest_name;
pub use parser::{MAX_DEPTH, MAX_EXPONENT};
pub(crate) use parser::{parse, parse_implied};
