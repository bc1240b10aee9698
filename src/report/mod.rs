//! Results as text, JSON, LaTeX and code. Nothing is decided here.

pub mod margins;
pub mod notation;
mod real;
