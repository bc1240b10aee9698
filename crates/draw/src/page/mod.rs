//! HTML pages that need nothing from outside.

mod boxes;
mod map;

pub use boxes::map_boxes_page;
pub use map::map_page;
