//! How often a function turns about zero along the imaginary axis, where on some of the way it may pass zero on either side.
//!
//! Of a function `f(w; x, y)` on a box of parameters the axis is cut into pieces. On a clear piece `f` stays in an open half plane about a
//! heading, for all parameters of the box: so no root is on the axis there. On an open piece that is not seen; but its derivative by
//! `w` may stay in an open half plane about a heading. At fixed parameters `f` then moves one way along that heading, so that its
//! argument changes by less than half a turn on the whole stretch between two clear pieces, unless `f` vanishes: a root on
//! the axis. Both ends of the stretch being in known half planes, two changes are left, a whole turn from each other:
//! zero is passed on the left or on the right. Where all but one of them are known, so are all.
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
                    Some(way) => way.to(*first, slopes.is_some())?,
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
        let below = first.div_euclid(HALF) * HALF;
        let start = match slopes {
            // The real value at zero is in the half plane, hence on the nearer side.
            None => [(first + HALF / 2).div_euclid(HALF) * HALF; 2],
            // The way back from minus the frequency is the mirror image: together they are one stretch where the slope of both is within a half
            // plane about one heading, which is then imaginary. Half of its change is less than a quarter turn.
            Some(slopes) if slopes & (1 << QUARTER | 1 << (HALF + QUARTER)) != 0 => {
                [below, if below == first { below } else { below + HALF }]
            }
            Some(_) => return None,
        };
        Some(Way { start, now: first, doubts: 0 })
    }

    /// Goes on to a heading, by an open stretch or at once.
    fn to(mut self, next: i64, is_open: bool) -> Option<Way> {
        let turn = (next - self.now).rem_euclid(TURN);
        if is_open && turn != 0 {
            // One of two changes of less than a whole turn.
            self.doubts += 1;
            self.now += turn - TURN;
        } else {
            // Two half planes that have a value in common are not opposite.
            self.now += match turn {
                HALF => return None,
                turn if turn < HALF => turn,
                turn => turn - TURN,
            };
        }
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
