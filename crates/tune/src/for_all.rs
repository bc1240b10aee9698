//! Gains that are good for all plants: for every value of other names in their ranges.
//!
//! Gains are proved by parts that cover the ranges; a box of gains is refuted by one plant with which none of its gains are good, so plants that showed
//! some gains to be bad are tried on later boxes.

use jurist_algebra::number::Rational;
use jurist_engine::response::AllOf;
use std::cell::RefCell;

/// Sides of a box.
pub(crate) type Sides = Vec<[Rational; 2]>;

/// More plants are not remembered: each costs a look at each box.
const MOST_PLANTS: usize = 12;

/// Corners of more ranges than this are not looked at first.
const MOST_CORNERS: usize = 2;

/// The ranges of a plant's names, and plants that refuted gains, the last one first.
pub(crate) struct Plants {
    pub sides: Sides,
    witnesses: RefCell<Vec<Vec<Rational>>>,
}

impl Plants {
    pub fn new(all: &[AllOf]) -> Plants {
        let sides: Sides = all.iter().map(|all| all.range.clone()).collect();
        let mut first: Vec<Vec<Rational>> = vec![middle(&sides)];
        if sides.len() <= MOST_CORNERS {
            let corner = |bits: usize| (0..sides.len()).map(|i| sides[i][bits >> i & 1].clone()).collect();
            first.extend((0..1 << sides.len()).map(corner));
        }
        Plants { sides, witnesses: RefCell::new(first) }
    }

    /// Whether there is one plant alone.
    pub fn is_one(&self) -> bool {
        self.sides.is_empty()
    }

    /// Plants that a box is tried with.
    pub fn tried(&self) -> Vec<Vec<Rational>> {
        self.witnesses.borrow().clone()
    }

    /// A plant with which some gains are bad is tried first from now on.
    pub fn refuted_by(&self, plant: &[Rational]) {
        let mut all = self.witnesses.borrow_mut();
        all.retain(|known| known != plant);
        all.insert(0, plant.to_vec());
        all.truncate(MOST_PLANTS);
    }
}

/// The middle of a box.
pub(crate) fn middle(sides: &[[Rational; 2]]) -> Vec<Rational> {
    sides.iter().map(|[low, high]| low.midpoint(high)).collect()
}

/// A point as a box.
pub(crate) fn as_box(point: &[Rational]) -> Sides {
    point.iter().map(|x| [x.clone(), x.clone()]).collect()
}
