//! The keys of `[require]`: the names of the requirements, and the numbers that they take.
//!
//! What a requirement means is no part of a model: the engine has a file for each.

/// A key of `[require]`.
///
/// ```
/// use jurist_model::requirements::{ALL, DAMPING};
/// assert_eq!(DAMPING.name, "damping");
/// assert!(ALL.iter().any(|key| key.name == "phase_margin"));
/// ```
#[derive(Debug)]
#[non_exhaustive]
pub struct RequirementKey {
    /// Its name.
    pub name: &'static str,
    /// The number that it takes, for people.
    pub about: &'static str,
}

/// Makes a constant of each key, and the list of all.
macro_rules! keys {
    ($($key:ident = $name:literal, $about:literal;)+) => {
        $(
            #[doc = concat!("`", $name, "`: ", $about, ".")]
            pub const $key: RequirementKey = RequirementKey { name: $name, about: $about };
        )+

        /// All keys, in the order in which requirements are decided and listed.
        pub const ALL: &[&RequirementKey] = &[$(&$key),+];
    };
}

keys! {
    GAIN_MARGIN = "gain_margin", "a factor both ways, or decibels: \"6 dB\"";
    PHASE_MARGIN = "phase_margin", "an angle: \"45 deg\"";
    MODULUS_MARGIN = "modulus_margin", "the least |1 + L|, the inverse of the greatest sensitivity";
    COMPLEMENTARY_PEAK = "complementary_peak", "the greatest |L/(1 + L)|, the peak of the complementary sensitivity";
    DISK_MARGIN = "disk_margin", "the least 2 |1 + L|/|1 - L|, the size of the balanced disk of gains and phases";
    DELAY_MARGIN = "delay_margin", "a dead time in units of time";
    DAMPING = "damping", "the least damping of all roots; in discrete time of ln(z)/T";
    DECAY = "decay", "all roots have Re s < -decay (continuous time)";
    RADIUS = "radius", "all roots have |z| < radius (discrete time)";
    SETTLING_TIME = "settling_time", "a decay of at least 4 over this time";
}
