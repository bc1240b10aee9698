//! What the fuzz targets call: functions of bytes that panic when the library is wrong.

pub mod isolation;
pub mod model;

pub use isolation::isolation_against_sturm;
pub use model::model_parser;
