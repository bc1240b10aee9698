//! What an engine answered, as far as it says it.

use jurist_algebra::number::Rational;
use jurist_algebra::poly::UniPoly;

/// An answer of any engine.
#[derive(Debug)]
pub enum Found {
    /// Lower and upper ends of the stable intervals, ascending; `None` is infinite.
    Stable(Vec<[Option<FoundEnd>; 2]>),
    Verdict {
        verdict: String,
        /// Inside, on, outside, at infinity.
        roots: [u64; 4],
    },
}

/// An end of an interval: exactly one root of `polynomial` lies in the enclosure; zero for an end that is not algebraic.
#[derive(Debug)]
pub struct FoundEnd {
    pub exact: Option<Rational>,
    pub enclosure: [Rational; 2],
    pub polynomial: UniPoly,
    /// `None` where the engine does not speak of causes.
    pub causes: Option<String>,
    /// Lower and upper bound in `Hz`, `rad/s` and `rad`, as far as the engine speaks of frequencies.
    pub frequencies: Option<Vec<(&'static str, [Rational; 2])>>,
}
