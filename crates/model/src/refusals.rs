//! Refusals that the model itself gives.

use crate::error::{Code, Refusal};

/// The dead time of a plant behind a hold varies against the sample time. The table of what is answered has it, too.
pub static NO_FIXED_ORDER: Refusal = Refusal::new(
    Code::Function,
    "the dead time of '{name}' is no fixed number of samples",
    "give it as a multiple of the sample time (delay = \"1.5*T\"), or set all that it depends on",
);
