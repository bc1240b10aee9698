//! The zero-order hold: inputs are constant between samples, and outputs exact at them.

use super::{Inputs, Kind, Method};

pub(super) const METHOD: Method = Method {
    name: "zoh",
    words: "zero-order hold",
    about: "exact behind a zero-order hold",
    spellings: &["zero-order hold", "zero-order-hold", "zero order hold", "hold"],
    advice: "",
    keys: &["delay", "frame", "advance"],
    keeps_states: true,
    kind: Kind::Hold {
        inputs: Inputs::Constant,
        exact: "exact at the samples; what happens between them is not looked at.",
    },
};
