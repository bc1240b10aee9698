//! The backward rule `s = (z - 1)/(T z)`.

use super::{Kind, Method};
use crate::connect::matrices::product;
use crate::connect::state_space::System;
use jurist_algebra::matrix::RationalMatrix;

pub(super) const METHOD: Method = Method {
    name: "backward",
    words: "backward rule",
    about: "s = (z-1)/(T z)",
    spellings: &["euler"],
    advice: "",
    keys: &[],
    keeps_states: false,
    // With M = (I - T A)^-1: M, T M B, C M, D + T C M B.
    kind: Kind::Rule(|s, time, inverse| {
        let inverse = inverse(&(&RationalMatrix::identity(s.a.rows()) - &s.a.scaled(time)))?;
        let through = product(&inverse, &s.b);
        Ok(System {
            d: &s.d + &product(&s.c, &through).scaled(time),
            c: product(&s.c, &inverse),
            b: through.scaled(time),
            a: inverse,
        })
    }),
};
