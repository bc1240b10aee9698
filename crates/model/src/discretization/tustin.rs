//! Tustin's rule `s = c (z - 1)/(z + 1)`; `c` is `2/T`, a factor that is given, or the one that is exact at a frequency.

use super::{Kind, Method};
use crate::connect::matrices::product;
use crate::connect::state_space::System;
use jurist_algebra::matrix::RationalMatrix;

pub(super) const METHOD: Method = Method {
    name: "tustin",
    words: "Tustin's rule",
    about: "s = c (z-1)/(z+1)",
    spellings: &["bilinear", "trapezoidal", "prewarp"],
    advice: "; prewarp = \"w\" is a key beside it",
    keys: &["c", "prewarp"],
    keeps_states: false,
    // With W = (c I - A)^-1: W (c I + A), W B, 2 c C W, D + C W B.
    kind: Kind::Rule(|s, factor, inverse| {
        let scaled = RationalMatrix::identity(s.a.rows()).scaled(factor);
        let inverse = inverse(&(&scaled - &s.a))?;
        let through = product(&inverse, &s.b);
        Ok(System {
            a: product(&inverse, &(&scaled + &s.a)),
            d: &s.d + &product(&s.c, &through),
            c: product(&s.c, &inverse).scaled(&(factor + factor)),
            b: through,
        })
    }),
};
