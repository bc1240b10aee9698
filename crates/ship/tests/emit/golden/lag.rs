// lag: a controller, direct form 2 transposed.
//
// Signals and states are numbers of 32 bits of IEEE 754, not scaled: 1 is 1.
// Each product and each sum is rounded, to nearest with ties to even, in the order that is written.
// States are zero in Lag::new(); call step at each sample. Only `core` is used.
// Constants are made of their bits, which takes Rust 1.83 or later.

const B1: f32 = f32::from_bits(0x3eaaaaab); // b1 = 1/3
const A1: f32 = f32::from_bits(0xbf2aaaab); // a1 = -2/3

/// A controller with its states.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lag {
    pub s_1: f32,
}

#[allow(dead_code, clippy::all)] // Not every program calls reset; statements are those of other languages.
#[rustfmt::skip] // A line for each term.
impl Lag {
    /// The controller at rest: all states are zero.
    pub const fn new() -> Self {
        Self { s_1: 0.0 }
    }

    /// Brings the controller to rest.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// One sample: the outputs from the inputs, and then the next states.
    pub fn step(&mut self, u: f32) -> f32 {
        let y: f32 = self.s_1;
        let next_1: f32 =
            B1 * u
            - A1 * y;
        self.s_1 = next_1;
        y
    }
}
