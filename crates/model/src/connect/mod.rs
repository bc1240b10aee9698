//! From the values of a model's parts to one closed loop.

mod exponential;
mod factor;
mod hold;
pub(crate) mod matrices;
mod modulators;
pub(crate) mod orbit;
mod rates;
pub(crate) mod realise;
pub(crate) mod samples;
pub(crate) mod state_space;
