//! Boxes of a window of two parameters, each proved stable, proved not stable, or left undecided.

mod by_curves;
mod levels;
mod patch;
mod place;

use super::curves::Curve;
use crate::Range;
use jurist_algebra::limits::Stop;
use jurist_algebra::number::Rational;

pub use by_curves::stability_boxes;
pub(crate) use levels::subdivided;
pub use levels::{Refined, Seen, boxes_of, refined};
pub use place::Place;

/// A bounded rectangle of two parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Window {
    /// The ends in `x`.
    pub x: [Rational; 2],
    /// The ends in `y`.
    pub y: [Rational; 2],
}

impl Window {
    /// The rectangle of two ranges; `None` when one is empty or has no end on a side.
    pub fn new(x: &Range, y: &Range) -> Option<Window> {
        let side = |r: &Range| match (&r.lower, &r.upper) {
            (Some(low), Some(high)) if low < high => Some([low.clone(), high.clone()]),
            _ => None,
        };
        Some(Window { x: side(x)?, y: side(y)? })
    }

    /// The product of the sides.
    pub fn area(&self) -> Rational {
        (&self.x[1] - &self.x[0]) * (&self.y[1] - &self.y[0])
    }
}

/// What is proved of all points of an open box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BoxVerdict {
    /// All roots strictly inside, at every point.
    Stable,
    /// Stable at no point.
    Unstable {
        /// The number of roots outside, where it is known to be the same at every point.
        outside: Option<usize>,
    },
    /// Nothing.
    Undecided,
}

impl BoxVerdict {
    /// The name used in all output.
    pub fn name(self) -> &'static str {
        match self {
            BoxVerdict::Stable => "stable",
            BoxVerdict::Unstable { .. } => "unstable",
            BoxVerdict::Undecided => "undecided",
        }
    }
}

/// An open box of parameters with what is proved of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlaneBox {
    /// The box; its edges do not belong to it.
    pub window: Window,
    /// What is proved.
    pub verdict: BoxVerdict,
}

/// A window cut into boxes.
#[derive(Clone, Debug)]
pub struct BoxMap {
    /// The window; its points on edges of boxes have no verdict.
    pub window: Window,
    /// The boundary curves; empty when one of them vanishes identically.
    pub curves: Vec<Curve>,
    /// The boxes, which tile the window; by lower `x`, then by lower `y`.
    pub boxes: Vec<PlaneBox>,
    /// Areas of the stable, the unstable and the undecided boxes: their sum is the window's.
    pub areas: Areas,
    /// Why the subdivision stopped before so little was undecided as was asked for: `None` when it did not.
    pub stopped: Option<Stop>,
}

/// Exact areas by verdict, in the product of the parameters' units.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Areas {
    /// Of the boxes proved stable.
    pub stable: Rational,
    /// Of the boxes proved to hold no stable point.
    pub unstable: Rational,
    /// Of the rest.
    pub undecided: Rational,
}

impl BoxMap {
    /// One box that holds no stable point.
    ///
    /// ```
    /// use jurist_stability::plane::boxes::{BoxMap, Window};
    /// let side = [0, 1].map(jurist_algebra::number::Rational::from);
    /// let map = BoxMap::nowhere_stable(&Window { x: side.clone(), y: side });
    /// assert!(map.areas.stable.is_zero() && map.areas.undecided.is_zero());
    /// ```
    pub fn nowhere_stable(window: &Window) -> BoxMap {
        let whole = PlaneBox { window: window.clone(), verdict: BoxVerdict::Unstable { outside: None } };
        BoxMap::new(window.clone(), Vec::new(), vec![whole], None)
    }

    /// The boxes of parts that tile a window, without curves.
    ///
    /// ```
    /// use jurist_stability::plane::boxes::{BoxMap, Window};
    /// let side = |from: i64| [from, from + 1].map(jurist_algebra::number::Rational::from);
    /// let parts = [0, 1].map(|from| BoxMap::nowhere_stable(&Window { x: side(from), y: side(0) }));
    /// let whole = Window { x: [0, 2].map(jurist_algebra::number::Rational::from), y: side(0) };
    /// assert_eq!(BoxMap::joined(whole, parts.into()).areas.unstable, 2.into());
    /// ```
    pub fn joined(window: Window, parts: Vec<BoxMap>) -> BoxMap {
        let stopped = parts.iter().find_map(|part| part.stopped.clone());
        BoxMap::new(window, Vec::new(), parts.into_iter().flat_map(|part| part.boxes).collect(), stopped)
    }

    /// Boxes that tile a window, in any order.
    fn new(window: Window, curves: Vec<Curve>, mut boxes: Vec<PlaneBox>, stopped: Option<Stop>) -> BoxMap {
        boxes.sort_by_cached_key(|b| (b.window.x[0].clone(), b.window.y[0].clone()));
        let mut areas = Areas { stable: Rational::ZERO, unstable: Rational::ZERO, undecided: Rational::ZERO };
        for b in &boxes {
            let sum = match b.verdict {
                BoxVerdict::Stable => &mut areas.stable,
                BoxVerdict::Unstable { .. } => &mut areas.unstable,
                BoxVerdict::Undecided => &mut areas.undecided,
            };
            *sum += &b.window.area();
        }
        BoxMap { window, curves, boxes, areas, stopped }
    }

    /// The box that holds a point; `None` outside the window and on edges. `O(n)`.
    pub fn locate(&self, x: &Rational, y: &Rational) -> Option<&PlaneBox> {
        let within = |[low, high]: &[Rational; 2], v: &Rational| low < v && v < high;
        self.boxes.iter().find(|b| within(&b.window.x, x) && within(&b.window.y, y))
    }
}
