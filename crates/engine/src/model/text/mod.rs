//! Text to trees: TOML to tables with places, expressions to their structure. What the names mean is
//! decided elsewhere.

mod expression;
mod function;
mod lexer;
mod located;
pub(in crate::model) mod names;
mod parser;
mod toml_hints;
pub(in crate::model) mod toml_reader;
pub(in crate::model) mod toml_value;

pub use expression::{Expression, Factor, Node, Sign};
pub use function::Function;
pub(in crate::model) use function::{PI, UNIT, hint};
pub(crate) use lexer::is_blank_letter;
pub(in crate::model) use lexer::is_name;
pub(in crate::model) use located::Text;
pub use names::nearest_name;
pub use parser::{MAX_DEPTH, MAX_EXPONENT};
pub(in crate::model) use parser::{parse, parse_implied};
