//! Results as text, JSON, LaTeX and code. Nothing is decided here.

mod analysis;
pub mod diagnostics;
pub mod figures;
mod intervals;
pub mod json;
mod layout;
mod main_job;
mod map;
pub mod margins;
pub mod notation;
pub mod paper;
mod real;
mod region;
mod simulation;
mod table;
mod verdict;

pub use analysis::{analysis_json, analysis_text};
pub use intervals::{intervals_json, intervals_text};
pub use main_job::{MainJob, main_job_json, main_job_text};
pub use map::{map_boxes_json, map_boxes_page, map_boxes_text, map_json, map_page, map_text, published_limits};
pub use simulation::{CircuitAnswer, SimulationAnswer, locus_json, simulation_json, time_unit};
pub use table::{point_table_json, point_table_text, table_json, table_text};
pub use verdict::{verdict_json, verdict_text};
