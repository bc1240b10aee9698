//! Halving a window until the looks at its boxes decide enough of it.

use super::place::Place;
use super::{BoxMap, BoxVerdict, PlaneBox, Window};
use crate::subdivision::{Halves, Look};
use jurist_algebra::limits::{Budget, Exhausted, Stop, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use std::collections::BTreeMap;
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

/// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1). `look` is told what the look at the box that
/// was halved noted.
pub(crate) fn subdivided<T: Send + Sync>(
    window: &Window,
    goal: &Rational,
    budget: &Budget,
    look: impl Fn(&Place, Option<&T>) -> Result<(Seen, Option<T>), Exhausted> + Sync,
) -> BoxMap {
    boxes_of(window, goal, None, budget, |place, note: &mut Option<Arc<T>>| {
        let (seen, noted) = look(place, note.as_deref())?;
        *note = noted.map(Arc::new);
        Ok(seen)
    })
}

/// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1). `look` has what the look at the box that was
/// halved left of what it was told itself, at first `known`.
///
/// Cost: that of the looks at about `1/h` boxes of side `h` along each boundary.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_stability::plane::boxes::{BoxVerdict, Seen, Window, boxes_of};
/// // The unit square, stable below 1/4 and not above.
/// let [zero, quarter, one]: [jurist_algebra::number::Rational; 3] = ["0", "1/4", "1"].map(|x| x.parse().unwrap());
/// let whole = Window { x: [zero.clone(), one.clone()], y: [zero, one] };
/// let map = boxes_of(&whole, &"1/8".parse().unwrap(), (), &Budget::unlimited(), |place, ()| {
///     let b = place.window(&whole);
///     Ok(match (b.y[1] <= quarter, b.y[0] >= quarter) {
///         (true, _) => Seen::Decided(BoxVerdict::Stable),
///         (_, true) => Seen::Decided(BoxVerdict::Unstable { outside: None }),
///         _ => Seen::Cut(1),
///     })
/// });
/// assert_eq!(map.areas.stable, quarter);
/// ```
pub fn boxes_of<K: Clone + Send + Sync>(
    window: &Window,
    goal: &Rational,
    known: K,
    budget: &Budget,
    look: impl Fn(&Place, &mut K) -> Result<Seen, Exhausted> + Sync,
) -> BoxMap {
    budget.step("subdividing the window");
    let whole = vec![(Place::whole(), Kept(known))];
    by_levels(whole, goal, MOST_UNDECIDED, budget, |place, known| look(place, &mut known.0)).into_map(window)
}

/// No more boxes are undecided at a time.
const MOST_UNDECIDED: usize = 1 << 13;

/// What is known of parts of a window.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Refined<V> {
    /// The parts that are decided, each with what is known of it.
    pub decided: Vec<(Window, V)>,
    /// The parts that are not.
    pub undecided: Vec<Window>,
    /// Why the subdivision stopped before so little was undecided as was asked for: `None` when it did not.
    pub stopped: Option<Stop>,
}

/// Cuts some boxes of a window further, until what is undecided of them is at most a share `goal` (0 to 1) of the whole window. The boxes come
/// from halving the window. `look` has what the look at the box that was halved left of what it was told itself, at first `known`.
///
/// Cost: that of the looks at about `1/h` boxes of side `h` along each boundary.
///
/// # Panics
/// When a box does not come from halving the window.
///
/// ```
/// use jurist_algebra::limits::Budget;
/// use jurist_stability::Range;
/// use jurist_stability::plane::boxes::{Window, refined};
/// use jurist_stability::subdivision::Look;
/// // The half of the unit square in which x < 1/2, by whether y < 1/3.
/// let [zero, half, one]: [jurist_algebra::number::Rational; 3] = ["0", "1/2", "1"].map(|x| x.parse().unwrap());
/// let whole = Window { x: [zero.clone(), one.clone()], y: [zero.clone(), one.clone()] };
/// let left = Window { x: [zero, half], ..whole.clone() };
/// let third = "1/3".parse().unwrap();
/// let found = refined(&whole, &[left], (), &"1/16".parse().unwrap(), &Budget::unlimited(), |place, ()| {
///     let b = place.window(&whole);
///     Ok(match (b.y[1] <= third, b.y[0] >= third) {
///         (true, _) => Look::Decided("below"),
///         (_, true) => Look::Decided("above"),
///         _ => Look::Cut(1),
///     })
/// });
/// // y from 1/4 to 3/8 is left: a sixteenth of the whole.
/// assert_eq!((found.decided.len(), found.undecided.len()), (3, 1));
/// ```
pub fn refined<K: Clone + Send + Sync, V: Send>(
    whole: &Window,
    boxes: &[Window],
    known: K,
    goal: &Rational,
    budget: &Budget,
    look: impl Fn(&Place, &mut K) -> Result<Look<V, Infallible>, Exhausted> + Sync,
) -> Refined<V> {
    let start = |b: &Window| (Place::of(b, whole).expect("a box of the window"), Kept(known.clone()));
    let starts = boxes.iter().map(start).collect();
    let seen = |place: &Place, known: &mut Kept<K>| look(place, &mut known.0);
    by_levels(starts, goal, MOST_UNDECIDED, budget, seen).windows(whole)
}

/// What both halves of a box know of it.
struct Kept<K>(K);

impl<K: Clone> Halves for Kept<K> {
    fn halves(self, _axis: usize) -> [Kept<K>; 2] {
        [Kept(self.0.clone()), self]
    }
}

/// Parts of a window with what is known of them, by their places.
pub(super) struct Levels<V> {
    decided: Vec<(Place, V)>,
    undecided: Vec<Place>,
    stopped: Option<Stop>,
}

impl<V> Levels<V> {
    fn windows(self, whole: &Window) -> Refined<V> {
        Refined {
            decided: self.decided.into_iter().map(|(place, verdict)| (place.window(whole), verdict)).collect(),
            undecided: self.undecided.iter().map(|place| place.window(whole)).collect(),
            stopped: self.stopped,
        }
    }
}

impl Levels<BoxVerdict> {
    /// The boxes of the whole window.
    pub fn into_map(self, window: &Window) -> BoxMap {
        let Refined { decided, undecided, stopped } = self.windows(window);
        let open = undecided.into_iter().map(|window| (window, BoxVerdict::Undecided));
        let boxes = decided.into_iter().chain(open).map(|(window, verdict)| PlaneBox { window, verdict }).collect();
        BoxMap::new(window.clone(), Vec::new(), boxes, stopped)
    }
}

/// Halves all boxes of one size before the next, so that the answer does not depend on the number of threads, until what is undecided is at
/// most a share `goal` (0 to 1) of the window or more boxes than `most` are undecided. Boxes to start with have their turn with those of
/// their size. A budget that runs out leaves more undecided, and so does a look that stops.
///
/// Cost: that of the looks at about `1/h` boxes of side `h` along each boundary.
pub(super) fn by_levels<K: Halves + Send, V: Send>(
    starts: Vec<(Place, K)>,
    goal: &Rational,
    most: usize,
    budget: &Budget,
    look: impl Fn(&Place, &mut K) -> Result<Look<V, Infallible>, Exhausted> + Sync,
) -> Levels<V> {
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
    let mut undecided: Vec<Undecided<K>> = Vec::new();
    let mut later = starts;
    for level in 0..=MOST_HALVINGS {
        let (now, rest): (Vec<_>, Vec<_>) = later.into_iter().partition(|(place, _)| place.level() <= level);
        later = rest;
        let mut rest = std::mem::take(&mut undecided)
            .into_iter()
            .chain(now.into_iter().map(|cell| (cell, None)))
            .collect::<Vec<_>>()
            .into_iter();
        while stopped.is_none() && rest.len() > 0 {
            let group: Vec<Undecided<K>> = rest.by_ref().take(GROUP).collect();
            let tested: Vec<Vec<_>> = parallel_map(group, turn);
            for ((cell, axis), seen) in tested.into_iter().flatten() {
                match seen {
                    Ok(Look::Decided(verdict)) => decided.push((cell.0, verdict)),
                    Ok(Look::Cut(axis)) => undecided.push((cell, Some(axis))),
                    Ok(Look::Open(never)) => match never {},
                    Err(exhausted) => {
                        undecided.push((cell, axis));
                        stopped = Some(exhausted.stop);
                    }
                }
            }
            let open = undecided.len() + rest.len() + later.len();
            budget.advance(decided.len() as u64, (decided.len() + open) as u64);
        }
        undecided.extend(rest);
        let open = undecided.iter().map(|((place, _), _)| place).chain(later.iter().map(|(place, _)| place));
        if stopped.is_some() || area(open) <= *goal {
            break;
        }
        if undecided.len() > most || level == MOST_HALVINGS {
            stopped = Some(Stop::Boxes { undecided: (undecided.len() + later.len()) as u64, halvings: level });
            break;
        }
    }
    let undecided = undecided.into_iter().map(|(cell, _)| cell).chain(later).map(|(place, _)| place).collect();
    Levels { decided, undecided, stopped }
}

/// The area of boxes as a share of the window's.
fn area<'p>(places: impl Iterator<Item = &'p Place>) -> Rational {
    let mut at_level: BTreeMap<u32, u64> = BTreeMap::new();
    places.for_each(|place| *at_level.entry(place.level()).or_default() += 1);
    let share = |(level, count): (u32, u64)| Rational::dyadic(&Integer::from(count), u64::from(level));
    at_level.into_iter().map(share).fold(Rational::ZERO, |sum, share| sum + share)
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
