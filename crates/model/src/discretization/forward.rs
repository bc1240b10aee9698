//! The forward rule `s = (z - 1)/T`.

use super::{Kind, Method};
use crate::connect::state_space::System;
use jurist_algebra::matrix::RationalMatrix;

pub(super) const METHOD: Method = Method {
    name: "forward",
    words: "forward rule",
    about: "s = (z-1)/T",
    spellings: &["euler"],
    advice: "",
    keys: &[],
    keeps_states: true,
    kind: Kind::Rule(|s, time, _| {
        let identity = RationalMatrix::identity(s.a.rows());
        Ok(System { a: &identity + &s.a.scaled(time), b: s.b.scaled(time), ..s })
    }),
};
