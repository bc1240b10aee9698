//! What several rooms of the tests share.

pub mod budget;
pub mod certificates;
pub mod corpus;
pub mod drive;
pub mod folder;
pub mod loops;
pub mod model;
pub mod number;
pub mod open_loops;
pub mod plane;
pub mod polynomial;
pub mod program;
pub mod random;
pub mod required;
pub mod schema;
pub mod schur;
pub mod thorough;
