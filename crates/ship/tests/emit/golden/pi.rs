// pi: a controller, direct form 1.
//
// Model: loop.toml, block C. Stable as stored.
// SHA-256 of the model: 0123..
//
// Signals and states are integers of 16 bits, -32768 to 32767; 1 unit = 2^-10.
// Each sum is exact, with at most 30 of 64 bits, and rounded once, to nearest, ties away from zero.
// What does not fit becomes the greatest or the least number.
// States are zero in Pi::new(); call step at each sample. Only `core` is used.

const B0: i32 = 4096; // b0 = 0.5
const B1: i32 = -4095; // b1 = -0.4999

/// A controller with its states.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pi {
    pub u_1: i16,
    pub y_1: i16,
}

#[allow(dead_code, clippy::all)] // Not every program calls reset; statements are those of other languages.
#[rustfmt::skip] // A line for each term.
impl Pi {
    /// The controller at rest: all states are zero.
    pub const fn new() -> Self {
        Self { u_1: 0, y_1: 0 }
    }

    /// Brings the controller to rest.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// One sample: the outputs from the inputs, and then the next states.
    pub fn step(&mut self, u: i16) -> i16 {
        let y_sum: i64 =
            i64::from(B0) * i64::from(u)
            + i64::from(B1) * i64::from(self.u_1)
            + i64::from(self.y_1) * 8192;
        let y: i16 = fit(round13(y_sum)) as i16;
        self.u_1 = u;
        self.y_1 = y;
        y
    }
}

/// What does not fit becomes the greatest or the least number.
#[allow(clippy::all)]
fn fit(v: i64) -> i64 {
    if v > 32767 {
        32767
    } else if v < -32768 {
        -32768
    } else {
        v
    }
}

/// Divides by 2^13 and rounds to nearest, ties away from zero.
#[allow(clippy::all)]
fn round13(v: i64) -> i64 {
    if v < 0 {
        (v - 4096) / 8192
    } else {
        (v + 4096) / 8192
    }
}
