//! Gains that are good for all plants: for every value of other names in their ranges.
//!
//! Gains are proved by parts that cover the ranges; a box of gains is refuted by one plant with which none of its gains are good, so plants that showed
//! some gains to be bad are tried on later boxes.

use jurist_algebra::limits::{Budget, Exhausted, checkpoint};
use jurist_algebra::number::Rational;
use jurist_engine::response::{AllOf, OverPoints, RequirementBoxes};
use jurist_stability::boxes::corners;
use std::cell::RefCell;
use std::collections::VecDeque;

/// Sides of a box.
pub(crate) type Sides = Vec<[Rational; 2]>;

/// More plants are not remembered: each costs a look at each box.
const MOST_PLANTS: usize = 12;

/// Corners of more ranges than this are not looked at first.
const MOST_CORNERS: usize = 2;

/// More parts of a box are not looked at to prove it.
const MOST_PARTS: usize = 160;

/// So many corners of a box are looked at first: a box that is too large most often ends at one of them.
const CORNERS: usize = 16;

/// Work of a part, in units of a budget.
const WORK: u64 = 2000;

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

/// What is known of all points of a box.
pub(crate) enum Everywhere {
    /// All meet the tests.
    All,
    /// This one does not, it seems.
    NotAt(Vec<Rational>),
    Open,
}

/// Whether all points of a box meet tests, by parts that cover it.
///
/// # Errors
/// When the budget runs out.
pub(crate) fn everywhere(tests: &[&RequirementBoxes], whole: Sides, budget: &Budget) -> Result<Everywhere, Exhausted> {
    let bad = |point: &OverPoints| matches!(point, OverPoints::None | OverPoints::Open { middle: Some(false) });
    for corner in corners(&whole).take(CORNERS) {
        for test in tests {
            if bad(&test.look(&as_box(&corner), budget)?) {
                return Ok(Everywhere::NotAt(corner));
            }
        }
    }
    let mut open: VecDeque<(Sides, Vec<usize>)> = [(whole.clone(), (0..tests.len()).collect())].into();
    let mut looked = 0;
    while let Some((part, asked)) = open.pop_front() {
        checkpoint(WORK);
        looked += 1;
        let mut left = Vec::new();
        for &k in &asked {
            match tests[k].look(&part, budget)? {
                OverPoints::All => {}
                told if bad(&told) => return Ok(Everywhere::NotAt(middle(&part))),
                _ => left.push(k),
            }
        }
        if left.is_empty() {
            continue;
        }
        let share = |i: &usize| {
            (&part[*i][1] - &part[*i][0]).checked_div(&(&whole[*i][1] - &whole[*i][0])).unwrap_or(Rational::ZERO)
        };
        let axis = (0..part.len()).filter(|i| part[*i][0] < part[*i][1]).rev().max_by_key(share);
        let (Some(axis), true) = (axis, looked < MOST_PARTS) else { return Ok(Everywhere::Open) };
        let at = part[axis][0].midpoint(&part[axis][1]);
        for end in [0, 1] {
            let mut half = part.clone();
            half[axis][end] = at.clone();
            open.push_back((half, left.clone()));
        }
    }
    Ok(Everywhere::All)
}

/// The middle of a box.
pub(crate) fn middle(sides: &[[Rational; 2]]) -> Vec<Rational> {
    sides.iter().map(|[low, high]| low.midpoint(high)).collect()
}

/// A point as a box.
pub(crate) fn as_box(point: &[Rational]) -> Sides {
    point.iter().map(|x| [x.clone(), x.clone()]).collect()
}
