//! Halving a window until the looks at its boxes decide enough of it.

use super::place::Place;
use super::{BoxMap, BoxVerdict, PlaneBox, Window};
use crate::subdivision::{Halves, Look};
use jurist_algebra::limits::{Budget, Exhausted, Stop, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use std::convert::Infallible;
use std::sync::Arc;

/// What a look at a box of a window shows: all boxes that it leaves undecided are halved.
pub type Seen = Look<BoxVerdict, Infallible>;

/// Boxes are looked at together in groups of this size; between groups the budget is asked.
const GROUP: usize = 32;

/// No box is halved more often.
const MOST_HALVINGS: u32 = 80;

/// A box that is not decided with what is known of it, and the axis along which it is to be halved; none before it was looked at.
type Undecided<K> = ((Place, K), Option<usize>);

/// What a look at a box notes for its halves.
struct Note<T>(Option<Arc<T>>);

impl<T> Halves for Note<T> {
    fn halves(self, _axis: usize) -> [Note<T>; 2] {
        [Note(self.0.clone()), self]
    }
}

/// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1). `look` is told what the look at the box that
/// was halved noted.
pub(crate) fn subdivided<T: Send + Sync>(
    window: &Window,
    goal: &Rational,
    budget: &Budget,
    look: impl Fn(&Place, Option<&T>) -> Result<(Seen, Option<T>), Exhausted> + Sync,
) -> BoxMap {
    /// No more boxes are undecided at a time.
    const MOST_UNDECIDED: usize = 1 << 13;
    budget.step("subdividing the window");
    by_levels(window, goal, (Note(None), MOST_UNDECIDED), budget, |place, note: &mut Note<T>| {
        let (seen, noted) = look(place, note.0.as_deref())?;
        note.0 = noted.map(Arc::new);
        Ok(seen)
    })
}

/// Halves all boxes of one size before the next, so that the answer does not depend on the number of threads, until the share of the
/// undecided area is at most `goal` (0 to 1) or more boxes than `most` are undecided. A budget that runs out leaves more of the window
/// undecided, and so does a look that stops.
///
/// Cost: that of the looks at about `1/h` boxes of side `h` along each boundary.
pub(super) fn by_levels<K: Halves + Send>(
    window: &Window,
    goal: &Rational,
    (known, most): (K, usize),
    budget: &Budget,
    look: impl Fn(&Place, &mut K) -> Result<Seen, Exhausted> + Sync,
) -> BoxMap {
    let looked = |(place, mut known): (Place, K)| {
        let seen = budget.enter(|| look(&place, &mut known)).and_then(|seen| seen);
        (((place, known), None), seen)
    };
    let turn = |(cell, axis): Undecided<K>| match (axis, budget.check()) {
        (None, _) => vec![looked(cell)],
        (Some(axis), Ok(())) => cell.halves(axis).map(looked).into(),
        // A box whose turn comes too late stays as it is.
        (Some(_), Err(exhausted)) => vec![((cell, axis), Err(exhausted))],
    };
    let (mut decided, mut stopped) = (Vec::new(), None);
    let mut undecided = vec![((Place::whole(), known), None)];
    for halvings in 0..=MOST_HALVINGS {
        let mut rest = std::mem::take(&mut undecided).into_iter();
        while stopped.is_none() && rest.len() > 0 {
            let group: Vec<Undecided<K>> = rest.by_ref().take(GROUP).collect();
            let tested: Vec<Vec<_>> = parallel_map(group, turn);
            for ((cell, axis), seen) in tested.into_iter().flatten() {
                match seen {
                    Ok(Look::Decided(verdict)) => decided.push(PlaneBox { window: cell.0.window(window), verdict }),
                    Ok(Look::Cut(axis)) => undecided.push((cell, Some(axis))),
                    Ok(Look::Open(never)) => match never {},
                    Err(exhausted) => {
                        undecided.push((cell, axis));
                        stopped = Some(exhausted.stop);
                    }
                }
            }
            budget.advance(decided.len() as u64, (decided.len() + undecided.len() + rest.len()) as u64);
        }
        undecided.extend(rest);
        let is_enough = Rational::dyadic(&Integer::from(undecided.len() as u64), u64::from(halvings)) <= *goal;
        if stopped.is_some() || is_enough {
            break;
        }
        if undecided.len() > most || halvings == MOST_HALVINGS {
            stopped = Some(Stop::Boxes { undecided: undecided.len() as u64, halvings });
            break;
        }
    }
    let verdict = BoxVerdict::Undecided;
    decided.extend(undecided.iter().map(|((place, _), _)| PlaneBox { window: place.window(window), verdict }));
    BoxMap::new(window.clone(), Vec::new(), decided, stopped)
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
    fn diagonal(place: &Place, _: Option<&()>) -> Result<(Seen, Option<()>), Exhausted> {
        let b = place.window(&unit());
        let seen = match (b.x[0] >= b.y[1], b.x[1] <= b.y[0]) {
            (true, _) => Seen::Decided(BoxVerdict::Stable),
            (_, true) => Seen::Decided(BoxVerdict::Unstable { outside: Some(1) }),
            _ => Seen::Cut(place.wider()),
        };
        Ok((seen, None))
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
    fn a_look_that_stops_leaves_its_box_and_what_follows_undecided() {
        let stops = |place: &Place, note: Option<&()>| match place.halvings {
            [1, 1] => Err(Exhausted::new(Stop::Cancelled, "a look")),
            _ => diagonal(place, note),
        };
        let map = subdivided(&unit(), &Rational::ZERO, &Budget::unlimited(), stops);
        assert_eq!((map.stopped, map.areas.undecided), (Some(Stop::Cancelled), 1.into()));
    }
    /// What a look notes is told of both halves and of no other box, and no undecided box is listed as halves that nobody looked at.
    #[test]
    fn halves_know_what_was_noted_of_their_box() {
        let look = |place: &Place, note: Option<&Place>| {
            let [low, high] = note.map_or([Place::whole(); 2], |whole| whole.halves(whole.wider()));
            assert!(*place == low || *place == high);
            Ok((Seen::Cut(place.wider()), Some(*place)))
        };
        let map = subdivided(&unit(), &Rational::ZERO, &Budget::unlimited(), look);
        assert_eq!(map.stopped, Some(Stop::Boxes { undecided: 1 << 14, halvings: 14 }));
        assert_eq!((map.boxes.len(), map.areas.undecided), (1 << 14, 1.into()));
    }
}
