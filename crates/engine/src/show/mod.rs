//! Results as text, JSON, LaTeX and code. Nothing is decided here.

mod analysis;
pub mod bounded;
pub mod diagnostics;
pub mod documents;
pub mod intervals;
pub mod layout;
mod least_margins;
pub mod map;
pub mod margins;
pub mod notation;
mod plan;
mod point_table;
pub mod real;
pub mod region;
mod requirements;
mod response;
mod roots;
mod sensitivity;
mod table;
mod tolerance;
pub mod verdict;
mod words;

pub use intervals::intervals_text;
pub use map::{for_all_text, map_boxes_text, map_text};
pub use plan::plan_text;
pub use table::table_text;
pub use tolerance::tolerance_text;
pub use words::words;
