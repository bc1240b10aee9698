//! Models of control loops, and exact answers about their stability.
//!
//! | room | what it does |
//! |---|---|
//! | [`model`] | [a crate of its own](jurist_model): expressions, model files, block diagrams, discretisation; [`error`]: diagnostics with places and stable codes |
//! | [`stability`] | [a crate of its own](jurist_stability): exact root count, tables of Jury and Routh, boundary polynomials, stable sets, two parameters |
//! | [`coverage`] | which question is answered over which coefficient ring: one table |
//! | [`problem`] | a question about a model as one value, resolved once and evaluated once |
//! | [`answer`] | answers: a problem and what is exactly known of it |
//! | [`response`] | frequency response: the loop cut open, margins, peak gains |

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod answer;
pub mod coverage;
mod precisions;
pub mod problem;
pub mod response;
pub use jurist_model::{self as model, error};
pub use jurist_stability as stability;
