//! Stable intervals put together from below.

use super::Bracket;
use crate::{Causes, End, Range, StableInterval, UndecidedBracket};
use jurist_algebra::number::Rational;

/// Values for all of which the loop is stable, or for none.
pub(crate) struct Decided {
    pub lower: Rational,
    pub upper: Rational,
    pub is_stable: bool,
}

/// The stable intervals of neighbouring pieces, and what is left of the brackets between them.
#[derive(Default)]
pub(crate) struct Pieces {
    intervals: Vec<StableInterval>,
    left: Vec<Bracket>,
    /// The last number at which the loop is known to be stable: an interval that ends there goes on.
    joint: Option<Rational>,
}

impl Pieces {
    /// The next interval.
    pub fn push(&mut self, interval: StableInterval) {
        let is_at_joint =
            |end: &Option<End>| self.joint.is_some() && end.as_ref().and_then(|end| end.value.exact()) == self.joint;
        match self.intervals.last_mut() {
            Some(last) if is_at_joint(&last.upper) && is_at_joint(&interval.lower) => last.upper = interval.upper,
            _ => self.intervals.push(interval),
        }
    }

    /// A bracket, in which parts are decided.
    pub fn bracket(&mut self, bracket: &Bracket, parts: &[Decided]) {
        let mut lower = bracket.0.clone();
        // An infinite end is never reached.
        let mut is_open = true;
        for Decided { lower: lo, upper: hi, is_stable } in parts {
            if lower.as_ref() != Some(lo) {
                self.left.push((lower, Some(lo.clone())));
            }
            is_open = bracket.1.as_ref() != Some(hi);
            lower = Some(hi.clone());
            if *is_stable {
                let end = |x: &Rational| Some(End::new(x.clone(), Causes::default(), None));
                self.joint = Some(lo.clone());
                self.push(StableInterval::new(end(lo), end(hi)));
                self.joint = Some(hi.clone());
            }
        }
        if is_open {
            self.left.push((lower, bracket.1.clone()));
        }
    }

    /// The intervals of a set, before those of the next one: one that ends at `joint`, where the loop is stable, goes on.
    pub fn before(intervals: Vec<StableInterval>, joint: Option<&Rational>) -> Pieces {
        Pieces { intervals, left: Vec::new(), joint: joint.cloned() }
    }

    /// The intervals, and what stays undecided with its reason: what is left of the brackets, and what is beyond.
    pub fn ended(self, reach: &Range, beyond: Vec<UndecidedBracket>) -> (Vec<StableInterval>, Vec<UndecidedBracket>) {
        let is_zero = |x: &Option<Rational>| x.as_ref().is_some_and(Rational::is_zero);
        let named = |(lower, upper): Bracket| {
            let why = match (&lower, &upper) {
                (Some(_), Some(_)) if is_zero(&lower) && is_zero(&reach.lower) => {
                    "values this close to 0 are not decided"
                }
                (Some(_), Some(_)) => "a root on the boundary, or close to it",
                _ => "values of this size are not decided: give the domain bounds",
            };
            UndecidedBracket::new(lower, upper, why)
        };
        let mut undecided: Vec<UndecidedBracket> = self.left.into_iter().map(named).chain(beyond).collect();
        undecided.sort_by(|a, b| a.lower.cmp(&b.lower));
        (self.intervals, undecided)
    }
}
