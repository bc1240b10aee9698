//! Halving a window until a given test decides enough of it.

use super::{BoxMap, BoxVerdict, PlaneBox, Window};
use jurist_algebra::limits::{Budget, Exhausted, Stop, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use std::sync::Arc;

/// A box of a window: the `at`-th of `2^halvings` equal parts on either axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Its number along each axis.
    pub at: [u64; 2],
    /// How often the window was halved along each axis.
    pub halvings: [u32; 2],
}

/// What a test shows of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// Stable at every point of the open box, or at none.
    Decided(BoxVerdict),
    /// Nothing: it is to be halved along an axis.
    Cut(usize),
}

/// A box, and what was found out of one that holds it.
type Node<K> = (Place, Option<Arc<K>>);
/// What its test found.
type Tested<K> = (Node<K>, Result<(Seen, Option<K>), Exhausted>);

/// Boxes are looked at together in groups of this size; between groups the budget is asked.
const GROUP: usize = 32;
/// No box is halved more often on one axis.
const MAX_HALVINGS: u32 = 40;
/// No more boxes are undecided at a time.
const MAX_UNDECIDED: usize = 1 << 14;

impl Place {
    /// The whole window.
    pub fn whole() -> Place {
        Place { at: [0; 2], halvings: [0; 2] }
    }

    /// The box itself.
    pub fn window(&self, whole: &Window) -> Window {
        let side = |axis: usize, [low, high]: &[Rational; 2]| {
            let length = high - low;
            let end = |k: u64| low + &(&length * &Rational::dyadic(&Integer::from(k), u64::from(self.halvings[axis])));
            [end(self.at[axis]), end(self.at[axis] + 1)]
        };
        Window { x: side(0, &whole.x), y: side(1, &whole.y) }
    }

    /// The axis along which it was halved less often.
    pub fn wider(&self) -> usize {
        usize::from(self.halvings[1] < self.halvings[0])
    }

    fn halves(&self, axis: usize) -> [Place; 2] {
        [0, 1].map(|upper| {
            let mut half = *self;
            half.halvings[axis] += 1;
            half.at[axis] = 2 * half.at[axis] + upper;
            half
        })
    }

    fn share(&self) -> Rational {
        Rational::dyadic(&Integer::ONE, u64::from(self.halvings[0] + self.halvings[1]))
    }
}

/// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1). A budget that runs out leaves
/// more of the window undecided, and so does a test that stops.
///
/// Cost: that of the tests of about `1/h` boxes of side `h` along each boundary.
pub fn subdivided(
    window: &Window,
    goal: &Rational,
    budget: &Budget,
    look: impl Fn(&Place) -> Result<Seen, Exhausted> + Sync,
) -> BoxMap {
    subdivided_with(window, goal, budget, |place, _: Option<&()>| Ok((look(place)?, None)))
}

/// The same where a test of a box is told what that of the last box that held it found out.
pub fn subdivided_with<K: Send + Sync>(
    window: &Window,
    goal: &Rational,
    budget: &Budget,
    look: impl Fn(&Place, Option<&K>) -> Result<(Seen, Option<K>), Exhausted> + Sync,
) -> BoxMap {
    budget.step("subdividing the window");
    let mut decided: Vec<PlaneBox> = Vec::new();
    let mut frontier: Vec<Node<K>> = vec![(Place::whole(), None)];
    let mut stopped = None;
    let looked = |(place, known): Node<K>| -> Tested<K> {
        let seen = budget.enter(|| look(&place, known.as_deref())).and_then(|seen| seen);
        ((place, known), seen)
    };
    loop {
        let open = frontier.iter().fold(Rational::ZERO, |sum, (place, _)| sum + place.share());
        let has_begun = !decided.is_empty() || frontier.len() > 1;
        if stopped.is_some() || frontier.is_empty() || (has_begun && open <= *goal) {
            break;
        }
        if frontier.len() > MAX_UNDECIDED || frontier.iter().any(|(p, _)| p.halvings.iter().any(|h| *h >= MAX_HALVINGS))
        {
            stopped = Some(Stop::Boxes { undecided: frontier.len() as u64, halvings: None });
            break;
        }
        // The largest first: what is left at last is about as large everywhere.
        let halvings = |(place, _): &Node<K>| place.halvings[0] + place.halvings[1];
        let fewest = frontier.iter().map(halvings).min().unwrap_or(0);
        let (largest, mut next): (Vec<Node<K>>, Vec<Node<K>>) =
            frontier.into_iter().partition(|node| halvings(node) == fewest);
        let mut rest = largest.into_iter();
        while stopped.is_none() && rest.len() > 0 {
            let group: Vec<Node<K>> = rest.by_ref().take(GROUP).collect();
            let tested: Vec<Tested<K>> = parallel_map(group, looked);
            for ((place, known), seen) in tested {
                match seen {
                    Ok((Seen::Decided(verdict), _)) => decided.push(PlaneBox { window: place.window(window), verdict }),
                    Ok((Seen::Cut(axis), known)) => {
                        let known = known.map(Arc::new);
                        next.extend(place.halves(axis).map(|half| (half, known.clone())));
                    }
                    Err(exhausted) => {
                        next.push((place, known));
                        stopped = Some(exhausted.stop);
                    }
                }
            }
            budget.advance(decided.len() as u64, (decided.len() + next.len() + rest.len()) as u64);
        }
        next.extend(rest);
        frontier = next;
    }
    let undecided = |(place, _): Node<K>| PlaneBox { window: place.window(window), verdict: BoxVerdict::Undecided };
    decided.extend(frontier.into_iter().map(undecided));
    super::subdivide::finished(window.clone(), Vec::new(), decided, stopped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Range;

    fn unit() -> Window {
        let side = Range::between(Some(0.into()), Some(1.into()));
        Window::new(&side, &side).unwrap()
    }

    /// Below the diagonal, above it, or neither.
    fn diagonal(place: &Place) -> Result<Seen, Exhausted> {
        let b = place.window(&unit());
        Ok(match (b.x[0] >= b.y[1], b.x[1] <= b.y[0]) {
            (true, _) => Seen::Decided(BoxVerdict::Stable),
            (_, true) => Seen::Decided(BoxVerdict::Unstable { outside: Some(1) }),
            _ => Seen::Cut(place.wider()),
        })
    }

    #[test]
    fn boxes_tile_the_window_until_little_enough_is_undecided() {
        let goal = Rational::dyadic(&Integer::ONE, 4);
        let map = subdivided(&unit(), &goal, &Budget::unlimited(), diagonal);
        let areas = &map.areas;
        assert_eq!((&areas.stable + &areas.unstable + &areas.undecided, &areas.stable), (1.into(), &areas.unstable));
        assert!(areas.undecided <= goal && map.stopped.is_none());
        assert_eq!(map.locate(&"9/10".parse().unwrap(), &"1/10".parse().unwrap()).unwrap().verdict, BoxVerdict::Stable);
    }

    #[test]
    fn a_test_that_stops_leaves_its_box_and_what_follows_undecided() {
        let stops = |place: &Place| match place.halvings {
            [1, 1] => Err(Exhausted::new(Stop::Cancelled, "a test")),
            _ => diagonal(place),
        };
        let map = subdivided(&unit(), &Rational::ZERO, &Budget::unlimited(), stops);
        assert_eq!((map.stopped, map.areas.undecided), (Some(Stop::Cancelled), 1.into()));
    }
}
