//! Results as text, JSON and LaTeX.
