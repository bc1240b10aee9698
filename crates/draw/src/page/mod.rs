//! HTML pages that need nothing from outside.

mod body;
mod boxes;
mod map;
mod parts;
mod shell;
pub mod words;

pub use body::body_page;
pub use boxes::map_boxes_page;
pub use map::map_page;
pub use parts::{Section, Table, figure, math, matrix, paragraph, report_page};
pub use shell::{document, escaped};
