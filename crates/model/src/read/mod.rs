//! From the tables of a model file to a checked [`Model`](super::Model): what every key means, and whether names and
//! values make sense. Nothing below imports this.

mod blocks;
mod check_holds;
mod check_names;
mod check_rules;
mod check_values;
mod discretize;
mod domain;
mod dynamics;
mod expect;
mod keys;
mod loop_forms;
mod model_file;
mod nominal;
mod pulses;
mod rates;
mod reader;
mod references;
mod require;
mod schema;
mod ship;
mod simulation;
mod tolerance;
mod tune;

pub use model_file::{DRIVE, source_from_bytes};
pub use references::Reference;
pub use schema::schema;
