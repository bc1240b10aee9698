//! Results as text, JSON, LaTeX and code. Nothing is decided here.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

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
pub use map::{body_rows, body_sentences, for_all_text, map_boxes_text, map_text};
pub use plan::plan_text;
pub use requirements::{margin_left, required_text, required_value};
pub use response::margin_sentences;
pub use table::table_text;
pub use tolerance::tolerance_text;
pub use words::words;

use serde::Serialize;

/// What people are shown of an answer.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_show::Text;
/// let answer = Model::drive().ask().free("K_pwm").stable_set(&Budget::unlimited())?;
/// assert!(answer.text(6).contains("0.0381005 < K_pwm < 550.941"));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub trait Text {
    /// The answer in words, its numbers with so many significant digits.
    fn text(&self, digits: usize) -> String;
}

/// What programs are given of an answer.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_engine::model::Model;
/// use jurist_engine::problem::Ask;
/// use jurist_show::Document;
/// use jurist_show::documents::to_text;
/// let answer = Model::drive().ask().verdict(&Budget::unlimited())?;
/// assert!(to_text(&answer.json(12)).contains("jurist/verdict/1"));
/// # Ok::<(), jurist_engine::error::Error>(())
/// ```
pub trait Document {
    /// The type of the document.
    type Json: Serialize;

    /// The document, its decimals with so many significant digits; many documents have exact numbers and counts alone.
    fn json(&self, digits: usize) -> Self::Json;
}
