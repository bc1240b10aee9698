//! From the values of a model's parts to one closed loop.

mod exponential;
mod factor;
mod hold;
pub(in crate::model) mod matrices;
mod modulators;
pub(in crate::model) mod orbit;
mod rates;
pub(in crate::model) mod realise;
pub(in crate::model) mod samples;
pub(in crate::model) mod state_space;
