//! What several rooms of the tests share.

pub mod certificates;
pub mod drive;
pub mod loops;
pub mod model;
pub mod number;
pub mod plane;
pub mod polynomial;
pub mod program;
pub mod random;
