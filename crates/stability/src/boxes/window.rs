//! Boxes of a window of two parameters of which at least one is inside of functions.

use super::family::Family;
use super::moving::MovingPolynomial;
use super::moving_look::{CELLS, Everywhere, MovingLooks};
use crate::plane::boxes::{BoxMap, BoxVerdict, Place, Seen, Window, subdivided};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;

impl MovingPolynomial {
    /// Whether both of two parameters are inside of functions.
    pub fn is_inside_of_both(&self) -> bool {
        self.inside.len() == 2
    }

    /// Cuts a window of its two parameters into boxes until the share of the undecided area is at most `goal` (0 to 1).
    ///
    /// `otherwise` is asked about a box that stays open.
    ///
    /// Cost: Taylor models of every function for each side of boxes in a parameter that is inside of functions, and up to some hundred
    /// cells of tensors for each box.
    ///
    /// # Panics
    /// Unless there are two parameters.
    pub fn boxes(
        &self,
        window: &Window,
        goal: &Rational,
        budget: &Budget,
        otherwise: impl Fn(&Place) -> Option<Seen> + Sync,
    ) -> BoxMap {
        assert_eq!(self.parameters(), 2, "a window has two sides");
        if self.functions[self.formal_degree() + 1..].iter().any(Vec::is_empty) {
            // Undefined, a root on the boundary, or degree lost, for all values of both.
            return BoxMap::nowhere_stable(window);
        }
        let known = MovingLooks::of(self);
        subdivided(window, goal, budget, |place, _: Option<&()>| {
            let Window { x, y } = place.window(window);
            let seen = match known.everywhere(&[x, y], CELLS, budget)? {
                Some(Everywhere::Outside(0)) => Seen::Decided(BoxVerdict::Stable),
                Some(Everywhere::Outside(outside)) => Seen::Decided(BoxVerdict::Unstable { outside: Some(outside) }),
                Some(Everywhere::Meaningless) => Seen::Decided(BoxVerdict::Unstable { outside: None }),
                None => otherwise(place).unwrap_or(Seen::Cut(place.wider())),
            };
            Ok((seen, None))
        })
    }
}
