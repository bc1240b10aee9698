//! HTML pages that need nothing from outside.

mod boxes;
mod map;
mod shell;

pub use boxes::map_boxes_page;
pub use map::map_page;
pub use shell::{document, escaped};
