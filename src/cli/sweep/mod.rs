//! The same question at many points: the points, the keys of questions, the rows of answers, the file they go to.

pub(super) mod file;
pub(super) mod grid;
pub(super) mod key;
pub(super) mod rows;
