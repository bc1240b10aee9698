//! The published limits of the built-in drive, to be compared with the map.

use jurist_engine::problem::{Problem, Region};

/// The drive's parameters: chopping period in s and amplitude in V.
const NAMES: [&str; 2] = ["T", "K_pwm"];

/// The limits by the Jury test that Gürbüz and Akpınar give: amplitude at the nominal period, and period
/// (1/2012.47 Hz) at the nominal amplitude.
const PUBLISHED: [(f64, f64); 3] = [(1e-4, 2.9853), (1e-4, 549.7), (1.0 / 2012.47, 110.0)];

/// The published limits as points of a map of the built-in drive; none where another question is asked or constants have
/// other values.
pub fn published_limits(problem: &Problem) -> Vec<(f64, f64)> {
    let names = problem.axes().map(|axis| axis.name.as_str());
    if !problem.set().is_empty() || *problem.region() != Region::of(problem.time()) {
        return Vec::new();
    }
    match names {
        _ if names == NAMES => PUBLISHED.to_vec(),
        _ if names == [NAMES[1], NAMES[0]] => PUBLISHED.iter().map(|(t, k)| (*k, *t)).collect(),
        _ => Vec::new(),
    }
}
