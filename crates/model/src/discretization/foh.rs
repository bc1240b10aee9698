//! The first-order hold: inputs are straight between samples (triangle hold, not causal by itself).

use super::{Inputs, Kind, Method};

pub(super) const METHOD: Method = Method {
    name: "foh",
    words: "first-order hold",
    about: "exact behind a first-order hold",
    spellings: &["first-order hold", "triangle"],
    advice: "",
    keys: &["delay"],
    keeps_states: false,
    kind: Kind::Hold { inputs: Inputs::Straight, exact: "exact for inputs that are straight between the samples." },
};
