//! How often a function turns about zero along the imaginary axis, where on some of the way it may pass zero on either side.
//!
//! Of a function `f(w; x, y)` on a box of parameters the axis is cut into pieces. On a clear piece `f` stays in an open half plane about a
//! heading, for all parameters of the box: so no root is on the axis there. On an open piece that is not seen; but its derivative by
//! `w` may stay in an open half plane about a heading. At fixed parameters `f` then moves one way along that heading on the whole stretch
//! between two clear pieces, so that it stays on one side of the line across it through zero, or passes that line once: on the
//! left of zero or on the right, unless `f` vanishes, a root on the axis. Both ends of the stretch being in known half planes, few changes of
//! the heading are left, whole turns from each other; each heading about which the derivative stays leaves its own, and only
//! those count that all of them leave.
//!
//! So the number of roots to the right of the axis is known up to a pair for each such stretch, for all parameters of the box
//! that have no root on the axis. Where its lower bound is positive, every point of the box has a root to the right of the axis or on it,
//! whatever curves of further roots pass through the box.

use super::dyadic::{Dyadic, Step};

/// Headings are numbered by sixteenths of a turn, which need not be equal: what counts is their order, and that the one eight further
/// is opposite.
pub(super) const TURN: i64 = 16;
const QUARTER: i64 = TURN / 4;
const HALF: i64 = TURN / 2;

/// Headings in the first quarter, of moduli that are at most [`LENGTH`].
const FIRST: [[i128; 2]; QUARTER as usize] = [[13, 0], [12, 5], [9, 9], [5, 12]];
/// No heading is longer.
pub(super) const LENGTH: i128 = 13;
/// Nor is the sum of the moduli of its parts greater.
pub(super) const SPAN: i128 = 18;

/// The direction of a heading as real and imaginary part.
pub(super) fn heading(k: i64) -> [i128; 2] {
    let [re, im] = FIRST[k.rem_euclid(QUARTER) as usize];
    match k.rem_euclid(TURN) / QUARTER {
        0 => [re, im],
        1 => [-im, re],
        2 => [-re, -im],
        _ => [im, -re],
    }
}

/// Headings, each a bit.
pub(super) type Headings = u16;

/// A piece of the way.
#[derive(Clone, Debug)]
pub(super) enum Piece {
    /// The function has no zero on it: it goes from one heading to another, without the whole turns before.
    Clear { first: i64, last: i64 },
    /// It may have one.
    Open {
        at: Dyadic,
        to: Dyadic,
        /// The step that comes next.
        step: Step,
        /// The headings about which its derivative stays in a half plane.
        slopes: Headings,
    },
}

/// Bounds of how many roots are to the right of the axis at points that have none on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Right {
    pub least: i64,
    pub most: i64,
}

/// The roots to the right of a function of a degree that ends in the half plane about the highest power, whose sign is given; `None`
/// where the way says nothing.
pub(super) fn roots_right(pieces: &[Piece], degree: usize, is_negative: bool) -> Option<Right> {
    let full = QUARTER * degree as i64;
    let end = (full + if is_negative { HALF } else { 0 }).rem_euclid(TURN);
    let mut way: Option<Way> = None;
    let mut slopes: Option<Headings> = None;
    for piece in pieces.iter().chain([&Piece::Clear { first: end, last: end }]) {
        match piece {
            Piece::Open { slopes: own, .. } => {
                slopes = Some(slopes.unwrap_or(Headings::MAX) & own).filter(|s| *s != 0);
                slopes?;
            }
            Piece::Clear { first, last } => {
                way = Some(match way {
                    None => Way::begun(*first, slopes)?,
                    Some(way) => way.to(*first, slopes)?,
                });
                slopes = None;
                way.as_mut()?.now += last - first;
            }
        }
    }
    let way = way?;
    // The argument grows by a quarter turn for each root to the left, and falls by one for each to the right.
    let right = |turned: i64| (full - turned).div_euclid(HALF);
    let least = right(way.now + TURN * way.doubts - way.start[0]);
    Some(Right { least, most: right(way.now - way.start[1]) })
}

/// The least and the greatest change of the heading on an open stretch, from one heading to another; `None` where there is none, so that
/// at all parameters a root is on the axis.
fn change(from: i64, to: i64, slopes: Headings) -> Option<[i64; 2]> {
    let mut common: Option<Vec<i64>> = None;
    for k in (0..TURN).filter(|k| slopes & (1 << k) != 0) {
        // With the way's heading as 0: behind the line are the values from 4 to 12, before it those from -4 to 4. A heading less than a quarter
        // from one behind is between 0 and 16, from one before between -8 and 8.
        let behind = |h: i64| Some((h - k).rem_euclid(TURN)).filter(|h| *h != 0);
        let before = |h: i64| Some((h - k + HALF).rem_euclid(TURN)).filter(|h| *h != 0).map(|h| h - HALF);
        let mut own: Vec<i64> = Vec::new();
        let stays = [(behind(from), behind(to)), (before(from), before(to))];
        own.extend(stays.into_iter().filter_map(|(from, to)| Some(to? - from?)));
        if let (Some(from), Some(to)) = (behind(from), before(to)) {
            own.extend([to - from, to - from + TURN]);
        }
        common = Some(match common {
            None => own,
            Some(known) => known.into_iter().filter(|change| own.contains(change)).collect(),
        });
    }
    let common = common?;
    Some([*common.iter().min()?, *common.iter().max()?])
}

/// The headings that are also those of the mirror image of a way, gone in the other direction.
fn symmetric(slopes: Headings) -> Headings {
    let has = |k: i64| slopes & (1 << k.rem_euclid(TURN)) != 0;
    (0..TURN).filter(|&k| has(k) && has(HALF - k)).fold(0, |all, k| all | 1 << k)
}

/// The way so far, in headings without the whole turns taken off.
struct Way {
    /// The headings of the value at zero, which is real: both where its sign is not known.
    start: [i64; 2],
    /// The least heading that is possible now; the others are whole turns from it.
    now: i64,
    /// How many whole turns are in doubt.
    doubts: i64,
}

impl Way {
    /// The first clear piece, after an open one where slopes are given.
    fn begun(first: i64, slopes: Option<Headings>) -> Option<Way> {
        let start = match slopes {
            // The real value at zero is in the half plane, hence on the nearer side.
            None => [(first + HALF / 2).div_euclid(HALF) * HALF; 2],
            // The way from minus the frequency is the mirror image: together they are one stretch, half of whose change is that from zero on.
            Some(slopes) => {
                let [least, most] = change(-first, first, symmetric(slopes))?;
                [first - most / 2, first - least / 2]
            }
        };
        Some(Way { start, now: first, doubts: 0 })
    }

    /// Goes on to a heading, by an open stretch where slopes are given.
    fn to(mut self, next: i64, slopes: Option<Headings>) -> Option<Way> {
        if let Some(slopes) = slopes {
            let [least, most] = change(self.now, next, slopes)?;
            self.now += least;
            self.doubts += (most - least) / TURN;
            return Some(self);
        }
        // Two half planes that have a value in common are not opposite.
        self.now += match (next - self.now).rem_euclid(TURN) {
            HALF => return None,
            turn if turn < HALF => turn,
            turn => turn - TURN,
        };
        Some(self)
    }
}

/// Clear pieces that follow each other as one.
pub(super) fn joined(pieces: Vec<Piece>) -> Vec<Piece> {
    let mut out: Vec<Piece> = Vec::new();
    for piece in pieces {
        match (out.last_mut(), &piece) {
            (Some(Piece::Clear { last, .. }), Piece::Clear { first, last: next }) => {
                let turn = (first - *last + HALF).rem_euclid(TURN) - HALF;
                *last += turn + next - first;
            }
            _ => out.push(piece),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// By how much the heading of a way about zero changes, in parts of a turn, and the headings at its ends: the angles of the
    /// points are followed by steps of less than half a turn.
    fn angles(way: &[[i64; 2]]) -> Option<[f64; 2]> {
        let angle = |[x, y]: [i64; 2]| (y as f64).atan2(x as f64) / std::f64::consts::TAU;
        let mut now = angle(way[0]);
        for pair in way.windows(2) {
            let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
            // A straight step does not pass zero, and turns by less than half a turn to the side of the cross product.
            let (cross, dot) = (ax * by - ay * bx, ax * bx + ay * by);
            if cross == 0 && dot <= 0 {
                return None;
            }
            now += (cross as f64).atan2(dot as f64) / std::f64::consts::TAU;
        }
        Some([angle(way[0]), now])
    }

    /// The headings less than a quarter turn from an angle, with their whole turns.
    fn near(at: f64) -> Vec<i64> {
        let of = |k: i64| {
            let [re, im] = heading(k);
            (im as f64).atan2(re as f64) / std::f64::consts::TAU + (k.div_euclid(TURN) as f64)
        };
        let lifted = |k: i64| if of(k) < (k as f64) / TURN as f64 - 0.5 { of(k) + 1.0 } else { of(k) };
        (-40..40).filter(|&k| (lifted(k) - at).abs() < 0.249).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

        /// Ways that go one way along a heading, and anyhow across it: their change of heading is one of those that are left.
        #[test]
        fn ways_change_as_they_may(
            turned in 0i64..16, steps in prop::collection::vec((1i64..9, -40i64..=40), 1..7), start in (-20i64..=0, -40i64..=40),
        ) {
            let [c, s] = heading(turned).map(|x| x as i64);
            let mut point = [start.0, start.1];
            let mut way = vec![point];
            for (along, across) in &steps {
                point = [point[0] + along, point[1] + across];
                way.push(point);
            }
            let way: Vec<[i64; 2]> = way.iter().map(|[x, y]| [c * x - s * y, s * x + c * y]).collect();
            prop_assume!(way.iter().all(|p| *p != [0, 0]));
            let Some([from, to]) = angles(&way) else { return Ok(()) };
            let is_along = |k: &i64| {
                let [c, s] = heading(*k).map(|x| x as i64);
                way.windows(2).all(|w| c * (w[1][0] - w[0][0]) + s * (w[1][1] - w[0][1]) > 0)
            };
            let slopes = (0..TURN).filter(is_along).fold(0, |all, k| all | 1 << k);
            prop_assert!(slopes & (1 << turned) != 0);
            for some in [slopes, 1 << turned] {
                for a in near(from) {
                    for b in near(to) {
                        let [least, most] = change(a, b, some).expect("this one");
                        prop_assert!(least <= b - a && b - a <= most, "{} in {} to {}: {:?}", b - a, least, most, way);
                    }
                }
            }
        }
    }

    /// Down and up again while it goes on slowly: the way of a whole turn but little that a single heading leaves.
    #[test]
    fn a_way_about_zero_may_be_almost_a_turn() {
        assert_eq!(change(12, 12, 1), Some([-16, 0]));
        assert_eq!(change(4, 4, 1), Some([0, 16]));
        assert_eq!(change(8, 0, 1), Some([-8, 8]));
        // Less is left by several, which hold the way to its direction.
        assert_eq!((change(4, 4, 1 << 4), change(4, 4, 1 << 4 | 1)), (Some([0, 0]), Some([0, 0])));
        assert_eq!((change(2, 4, 1 << 2), change(2, 4, 1 | 1 << 2)), (Some([2, 2]), Some([2, 2])));
        assert_eq!(change(0, 8, 1), None);
    }

    /// A real value at zero that is not known, and a derivative towards the imaginary axis.
    #[test]
    fn ways_begin_on_either_side_of_zero() {
        let start = |first, slopes| Way::begun(first, Some(slopes)).map(|way| way.start);
        assert_eq!(start(2, 1 << 4), Some([0, 8]));
        assert_eq!(start(10, 1 << 4), Some([0, 8]));
        assert_eq!(start(10, 1 << 12), Some([8, 16]));
        assert_eq!(start(4, 0b111 << 3), Some([0, 8]));
        assert_eq!(start(0, 0b111 << 3), Some([0, 8]));
        assert_eq!(start(2, 1 << 3), None);
    }

    #[test]
    fn clear_pieces_that_are_joined_keep_their_turns() {
        let clear = |first, last| Piece::Clear { first, last };
        let one = joined(vec![clear(14, 19), clear(4, 9), clear(8, 3)]);
        assert!(matches!(one.as_slice(), [Piece::Clear { first: 14, last: 19 }]), "{one:?}");
    }

    /// What one step leaves of an open stretch the next one does not leave: no heading is common to both, so nothing is known.
    #[test]
    fn a_stretch_keeps_to_a_heading_as_a_whole() {
        let open = |slopes| Piece::Open { at: Dyadic::zero(), to: Dyadic::zero(), step: Step(0), slopes };
        let clear = |first, last| Piece::Clear { first, last };
        let right = |slopes: [Headings; 2]| {
            let [a, b] = slopes.map(open);
            roots_right(&[clear(0, 0), a, b, clear(4, 4)], 1, false)
        };
        assert_eq!(right([1 | 1 << 4, 1 << 4]), Some(Right { least: 0, most: 2 }));
        assert_eq!(right([1 | 1 << 4, 1 | 1 << 4]), Some(Right { least: 0, most: 0 }));
        assert_eq!(right([1, 1 << 4]), None);
        assert_eq!(right([1 | 1 << 4, 0]), None);
    }
}
