//! What the fuzz targets call: functions of bytes that panic when the library is wrong.

pub mod isolation;

pub use isolation::isolation_against_sturm;
