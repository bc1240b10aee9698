//! A question about a model as one value: resolved once, evaluated once, shared by all answers.
//!
//! [`Question`] is what is being asked, built step by step from a model; [`Problem`] is the same question resolved: every
//! name is known, every value has its place, and the algebra is computed at most once, when it is first needed.

mod beside_dead_time;
mod block;
mod by_enclosures;
mod by_samples;
mod complex;
mod complex_function;
mod delayed;
mod delayed_family;
mod delayed_functions;
mod delayed_plane;
mod delayed_terms;
mod evaluation;
mod factors;
mod in_numbers;
mod over_symbols;
mod plan;
mod presupposed;
mod question;
mod range_text;
mod region;
mod resolved;
mod rounded;
mod substitution;

pub(crate) use beside_dead_time::Beside;
pub use block::EnclosedBlock;
pub(crate) use by_enclosures::{EnclosedParts, EnclosedQuotient, OpenedByValues, enclosed_or_exact, exact_or_enclosed};
pub(crate) use complex_function::ComplexFunction;
pub(crate) use delayed::base_delay;
pub(crate) use delayed::refused;
pub use delayed::{BaseDelay, DelayedLoop};
pub(crate) use delayed_family::OverDeadTime;
pub(crate) use delayed_functions::DelayedFunctions;
pub use evaluation::Algebra;
pub(crate) use in_numbers::FromNumbers;
pub use in_numbers::RoundedLoop;
pub(crate) use over_symbols::{fixed_symbols, moving_symbols, parametric_symbols, symbols_without};
pub use plan::Plan;
pub use question::{Ask, Question};
pub use range_text::range_text;
pub use region::{Bound, DECAY, RADIUS, Region};
pub use resolved::{Free, Problem};
pub use rounded::{RoundedSystem, RoundedWiring};
