//! What the paper says in numbers besides its equations, each with its place. The motor's and the
//! controllers' constants are those of the drive's model file.

use jurist_engine::model::Model;

/// Reference speed in rad/s (Section 3, list of parameters); the load torque is 0.
pub(super) const SPEED_REFERENCE: f64 = 80.0;

/// Sampling and chopping period in s (Section 3).
pub(super) const PERIOD: f64 = 1e-4;

/// Amplitude of the PWM signal in V (Section 3).
pub(super) const AMPLITUDE: f64 = 110.0;

/// The limits that the paper states, as printed: lower and upper limit of the amplitude in V, lower
/// limit of the frequency in Hz; the displayed intervals of Sections 3.1 and 3.2.
pub(super) const PUBLISHED_LIMITS: [(&str, [&str; 3]); 2] =
    [("paper, root locus", ["3.0", "550", ""]), ("paper, Jury test", ["2.9853", "549.7", "2012.47"])];

/// A point at which the paper shows responses.
pub(super) struct TestPoint {
    /// The point as a heading.
    pub heading: &'static str,
    /// Amplitude in V.
    pub amplitude: i64,
    /// Chopping frequency in Hz.
    pub frequency: i64,
    /// Number of the figure with the speed.
    pub speed: usize,
    /// Number of the figure with the current.
    pub current: usize,
    /// Seconds that the circuit is simulated for.
    pub duration: f64,
}

/// Figs. 7 to 14.
pub(super) const TEST_POINTS: [TestPoint; 4] = [
    TestPoint { heading: "K_pwm = 545 V", amplitude: 545, frequency: 10_000, speed: 7, current: 8, duration: 1.0 },
    TestPoint { heading: "K_pwm = 555 V", amplitude: 555, frequency: 10_000, speed: 9, current: 10, duration: 1.0 },
    TestPoint { heading: "f = 2010 Hz", amplitude: 110, frequency: 2010, speed: 11, current: 12, duration: 3.0 },
    TestPoint { heading: "f = 2020 Hz", amplitude: 110, frequency: 2020, speed: 13, current: 14, duration: 3.0 },
];

/// A constant of the drive, rounded; NaN for a name that it does not have.
pub(super) fn constant(model: &Model, name: &str) -> f64 {
    model.constant(name).and_then(|c| c.number.as_ref()).map_or(f64::NAN, |n| n.to_f64_approximate())
}

#[cfg(test)]
mod tests {
    use super::*;
    use jurist_algebra::number::to_decimal;

    #[test]
    fn the_models_nominal_values_and_gains_are_the_papers() {
        let drive = Model::drive();
        for (name, value) in [("T", PERIOD), ("K_pwm", AMPLITUDE)] {
            let nominal = drive.parameter(name).and_then(|p| p.nominal.clone()).unwrap();
            assert_eq!(to_decimal(&nominal, 6).parse::<f64>().unwrap(), value, "{name}");
        }
        for (name, value) in [("K_pi", 10.0), ("K_ii", 500.0), ("E_sw", 12.0)] {
            assert_eq!(constant(&drive, name), value, "{name}");
        }
        assert!(constant(&drive, "no such constant").is_nan());
    }
}
