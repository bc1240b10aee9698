//! From the values of a model's parts to one closed loop.

pub(in crate::model) mod state_space;
