//! Results as text, JSON, LaTeX and code. Nothing is decided here.

mod analysis;
pub mod diagnostics;
pub mod intervals;
pub mod json;
pub mod layout;
pub mod map;
pub mod margins;
pub mod notation;
pub mod real;
pub mod region;
mod table;
mod verdict;

pub use intervals::{intervals_json, intervals_text};
pub use map::{map_boxes_json, map_boxes_text, map_json, map_text};
pub use table::{point_table_json, table_json, table_text};
pub use verdict::verdict_json;
