//! Results as text, JSON, LaTeX and code. Nothing is decided here.

pub mod diagnostics;
pub mod notation;
