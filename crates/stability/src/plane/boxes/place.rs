//! Boxes of a window that come from halving it.

use super::Window;
use crate::subdivision::Halves;
use jurist_algebra::number::{Integer, Rational};

/// A box of a window: the `at`-th of `2^halvings` equal parts on either axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Its number along each axis.
    pub at: [u128; 2],
    /// How often the window was halved along each axis.
    pub halvings: [u32; 2],
}

impl Place {
    /// The whole window.
    pub fn whole() -> Place {
        Place { at: [0; 2], halvings: [0; 2] }
    }

    /// The box itself.
    pub fn window(&self, whole: &Window) -> Window {
        let side = |axis: usize, [low, high]: &[Rational; 2]| {
            let length = high - low;
            let end = |k: u128| {
                let share = Rational::dyadic(&Integer::from(k), u64::from(self.halvings[axis]));
                low + &(&length * &share)
            };
            [end(self.at[axis]), end(self.at[axis] + 1)]
        };
        Window { x: side(0, &whole.x), y: side(1, &whole.y) }
    }

    /// The place of a box; `None` where it does not come from halving the window.
    pub fn of(part: &Window, whole: &Window) -> Option<Place> {
        let side = |[low, high]: &[Rational; 2], [from, to]: &[Rational; 2]| -> Option<(u128, u32)> {
            let length = high - low;
            let parts = (to - from).checked_div(&length)?;
            let number = (low - from).checked_div(&length)?;
            let bits = parts.numerator().bit_length().checked_sub(1)?;
            let is_power = parts == Rational::from(2).pow(bits as i64)?;
            let number = number.is_integer().then(|| number.numerator())?;
            is_power.then_some((u128::try_from(number.to_i128()?).ok()?, bits as u32))
        };
        let (x, y) = (side(&part.x, &whole.x)?, side(&part.y, &whole.y)?);
        Some(Place { at: [x.0, y.0], halvings: [x.1, y.1] })
    }

    /// How often the window was halved.
    pub fn level(&self) -> u32 {
        self.halvings[0] + self.halvings[1]
    }

    /// The axis along which it was halved less often.
    pub fn wider(&self) -> usize {
        usize::from(self.halvings[1] < self.halvings[0])
    }
}

impl Halves for Place {
    fn halves(self, axis: usize) -> [Place; 2] {
        [0, 1].map(|upper| {
            let mut half = self;
            half.halvings[axis] += 1;
            half.at[axis] = 2 * half.at[axis] + upper;
            half
        })
    }
}
