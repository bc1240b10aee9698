//! The search for the zeros of a function of a parameter: intervals are looked at and halved.

use super::super::forms::Forms;
use super::super::horner::Scheme;
use super::super::pieces::Look;
use super::super::scales::{exponent, octaves};
use super::{MOST_HALVINGS, MovingSymbols};
use crate::limits::{Budget, Exhausted, parallel_map};
use crate::number::Rational;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// So many intervals are looked at side by side, however many threads there are: work is counted, and what it decides is the same.
const BATCH: usize = 4;

/// After so many intervals what is left stays undecided.
const MOST_LOOKS: usize = 4000;

/// After so much work, in the units of [`checkpoint`](crate::limits::checkpoint), what is left stays undecided: some seconds.
const MOST_WORK: u64 = 100_000_000;

/// Where the range begins at 0 and the function is not known there, values smaller than the usual one by so many octaves are decided where that is seen at once.
const MOST_OCTAVES: i64 = 12;

/// An interval, and how many times it was halved.
type Interval = (Rational, Rational, i64);

/// What an interval shows, and where it is to be halved.
type Seen = (Rational, Rational, Look, Option<Rational>);

/// An interval with one zero in it, and how many halvings ago the function was monotone.
pub(super) type Bracket = (Rational, Rational, u32);

pub(super) struct Search<'s> {
    pub symbols: &'s MovingSymbols,
    pub scheme: &'s Arc<Scheme>,
    pub forms: &'s Forms,
    /// The search begins on the scale of this number.
    pub near: &'s Rational,
    /// Whether the range goes down to 0 and nothing is known of the function there.
    pub is_open: bool,
}

impl Search<'_> {
    /// Brackets of zeros between two numbers; of other intervals it is not known whether they have some.
    pub fn brackets(
        &self,
        start: Rational,
        end: Rational,
        undecided: &mut Vec<(Rational, Rational)>,
        budget: &Budget,
    ) -> Result<Vec<Bracket>, Exhausted> {
        let mut brackets = Vec::new();
        // Every octave away from the usual value waits for two halvings, so that a place where zeros crowd leaves others decided.
        let mut todo = BinaryHeap::from([Reverse((0, start, end, 0))]);
        // Counted, not timed: the same model has the same answer on every machine.
        let work = Budget::with_work(MOST_WORK);
        let mut looks = 0;
        while !todo.is_empty() {
            budget.check()?;
            let batch: Vec<Interval> =
                (0..BATCH).map_while(|_| todo.pop()).map(|Reverse((_, lo, hi, n))| (lo, hi, n)).collect();
            looks += batch.len();
            let is_last = looks > MOST_LOOKS;
            let nothing = || {
                let unknown = |(lo, hi, _): &Interval| (lo.clone(), hi.clone(), Look::Unknown, None);
                batch.iter().map(|interval| (vec![unknown(interval)], false)).collect()
            };
            let seen = || parallel_map(batch.clone(), |interval| self.seen(interval, is_last));
            let seen: Vec<_> = budget.enter(|| work.enter(seen))?.unwrap_or_else(|_| nothing());
            for ((lo, hi, halvings), (looks, goes_on)) in batch.into_iter().zip(seen) {
                let width = hi - lo;
                let mut again = |lo: Rational, hi: Rational| {
                    let shorter = width.checked_div(&(&hi - &lo)).map_or(1, |ratio| exponent(&ratio).max(1));
                    let priority = 2 * octaves(&lo, &hi, self.near) + halvings + shorter - 1;
                    todo.push(Reverse((priority, lo, hi, halvings + shorter)));
                };
                for (lo, hi, look, middle) in looks {
                    match (look, middle) {
                        (Look::None, _) => {}
                        (Look::One { halvings }, _) => brackets.push((lo, hi, halvings)),
                        (Look::Unknown, Some(middle)) => {
                            again(lo, middle.clone());
                            again(middle.clone(), hi);
                        }
                        (Look::Unknown, None) if goes_on => again(lo, hi),
                        _ => undecided.push((lo, hi)),
                    }
                }
            }
        }
        Ok(brackets)
    }

    /// What is seen of an interval, and whether its parts are looked at again.
    fn seen(&self, (lo, hi, halvings): Interval, is_last: bool) -> (Vec<Seen>, bool) {
        // Towards 0 there is no end of octaves.
        let is_far = || self.is_open && hi < *self.near && octaves(&lo, &hi, self.near) > MOST_OCTAVES;
        let looks = self.symbols.look(self.forms, &lo, &hi);
        let goes_on = !is_last && halvings < MOST_HALVINGS && !is_far();
        // What is left of an interval is looked at as it is, most of one in two parts.
        let is_most = |a: &Rational, b: &Rational| (b - a) * Rational::from(2) > &hi - &lo;
        let part = |(a, b, look): (Rational, Rational, Look)| {
            let middle = goes_on && look == Look::Unknown && is_most(&a, &b);
            let middle = middle.then(|| self.symbols.split_point(self.scheme, &a, &b, self.near));
            (a, b, look, middle)
        };
        (looks.into_iter().map(part).collect(), goes_on)
    }
}
