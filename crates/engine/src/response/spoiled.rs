//! Values of one parameter that a single choice of the other names spoils.
//!
//! What is to hold for all values of a range does not hold where one of them spoils it. With the other names at one point the parameter is the only
//! free name, and its set is exact: what lies beside this set is spoiled, up to its ends, and no box has to be looked at there.

use super::for_all::MapForAll;
use super::required_set::{RequiredEnd, RequiredInterval, RequiredSet};
use crate::error::Error;
use crate::problem::Question;
use crate::stability::UndecidedBracket;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;

/// Work for the sets at one point of the ranges: about a second.
const WORK: u64 = 100_000_000;

/// The part of the budget that may be spent on all of them.
const SHARE: (u32, u32) = (1, 4);

/// Digits of an end.
const DIGITS: usize = 14;

/// What is spoiled keeps away from an end by a share of the end, as a power of two: at the end itself a requirement may be met.
const BESIDE_END: u64 = 44;

/// Closed pieces of a range, each with what spoils it.
pub(super) type Pieces = Vec<([Rational; 2], &'static str)>;

/// All values of an interval are spoiled, without end where there is none.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Spoiled {
    pub lower: Option<Rational>,
    pub upper: Option<Rational>,
    /// What is not met.
    by: &'static str,
}

impl MapForAll {
    /// What the corners of the ranges spoil of the one free name of a question.
    ///
    /// A corner tells nothing where its set is empty, as where a value is to be named that spoils everything, and where the set takes long.
    ///
    /// Cost: an exact set of one parameter for each corner.
    pub(super) fn spoiled_at_corners(&self, question: &Question, budget: &Budget) -> Result<Vec<Spoiled>, Exhausted> {
        budget.step("sets at the corners of the ranges");
        let part = budget.share(SHARE.0, SHARE.1);
        let mut out = Vec::new();
        for corner in 0..1usize << self.all.len() {
            let end = |(k, all): (usize, &super::AllOf)| (all.name.clone(), all.range[corner >> k & 1].clone());
            let at_corner = question.clone().set_all(self.all.iter().enumerate().map(end));
            let own = part.clone().within_work(WORK);
            let found =
                at_corner.problem().and_then(|line| line.required_set(&self.requirements, self.at.as_deref(), &own));
            match found {
                Ok(found) => out.extend(beside(found.value())),
                Err(Error::Stopped(stopped)) => {
                    budget.check()?;
                    if !stopped.stop.is_precision() {
                        break;
                    }
                }
                Err(_) => {}
            }
        }
        Ok(out)
    }
}

/// What lies beside a set, without its ends and without what is undecided of it.
fn beside(set: &RequiredSet) -> Vec<Spoiled> {
    let mut out = Vec::new();
    if set.intervals.is_empty() || set.stopped.is_some() {
        return out;
    }
    let (mut lower, mut before) = (None, None);
    for RequiredInterval { lower: from, upper: to } in &set.intervals {
        if let Some(from) = from {
            out.extend(between([lower, Some(below(&from.value()))], [before, Some(name(from))], &set.undecided));
        }
        let Some(to) = to else { return out };
        (lower, before) = (Some(above(&to.value())), Some(name(to)));
    }
    out.extend(between([lower, None], [before, None], &set.undecided));
    out
}

/// The parts of an interval that are decided, named after the nearer end.
fn between(
    [lower, upper]: [Option<Rational>; 2],
    names: [Option<&'static str>; 2],
    undecided: &[UndecidedBracket],
) -> Vec<Spoiled> {
    let by = |side: usize| names[side].or(names[1 - side]).unwrap_or("stability");
    let mut parts = match (&lower, &upper) {
        (Some(low), Some(high)) if by(0) != by(1) => {
            let middle = low.midpoint(high);
            vec![
                Spoiled { lower: lower.clone(), upper: Some(middle.clone()), by: by(0) },
                Spoiled { lower: Some(middle), upper: upper.clone(), by: by(1) },
            ]
        }
        _ => vec![Spoiled { lower, upper, by: by(0) }],
    };
    for open in undecided {
        parts = parts.into_iter().flat_map(|part| part.without(open)).collect();
    }
    parts.retain(|part| part.lower.as_ref().zip(part.upper.as_ref()).is_none_or(|(low, high)| low < high));
    parts
}

fn name(end: &RequiredEnd) -> &'static str {
    match end {
        RequiredEnd::Stability(_) => "stability",
        RequiredEnd::Requirement { names, .. } => names.first().copied().unwrap_or("stability"),
    }
}

/// A number below an end, and one above it.
fn below(end: &Real) -> Rational {
    let low = end.refined_to_digits(DIGITS).enclosure().0;
    &low - &room(&low)
}

fn above(end: &Real) -> Rational {
    let high = end.refined_to_digits(DIGITS).enclosure().1;
    &high + &room(&high)
}

fn room(end: &Rational) -> Rational {
    &end.abs() * &Rational::dyadic(&Integer::ONE, BESIDE_END)
}

impl Spoiled {
    /// The parts below and above a bracket.
    fn without(self, open: &UndecidedBracket) -> Vec<Spoiled> {
        let is_apart = |high: &Option<Rational>, low: &Option<Rational>| {
            high.as_ref().zip(low.as_ref()).is_some_and(|(high, low)| high < low)
        };
        if is_apart(&self.upper, &open.lower) || is_apart(&open.upper, &self.lower) {
            return vec![self];
        }
        let below = open.lower.clone().map(|end| Spoiled {
            lower: self.lower.clone(),
            upper: Some(&end - &room(&end)),
            by: self.by,
        });
        let above =
            open.upper.clone().map(|end| Spoiled { lower: Some(&end + &room(&end)), upper: self.upper, by: self.by });
        below.into_iter().chain(above).collect()
    }

    /// Whether all beyond a number is spoiled, above it or below.
    pub fn is_all_beyond(&self, number: &Rational, is_above: bool) -> bool {
        match is_above {
            true => self.upper.is_none() && self.lower.as_ref().is_none_or(|lower| lower <= number),
            false => self.lower.is_none() && self.upper.as_ref().is_none_or(|upper| upper >= number),
        }
    }
}

/// The parts of a window that are not spoiled, and those that are, each with what spoils it.
pub(super) fn parted(window: &[Rational; 2], spoiled: &[Spoiled]) -> (Vec<[Rational; 2]>, Pieces) {
    let (mut left, mut bad) = (vec![window.clone()], Vec::new());
    for one in spoiled {
        let mut rest = Vec::new();
        for [low, high] in left {
            let from = one.lower.as_ref().map_or(low.clone(), |lower| lower.clone().max(low.clone()));
            let to = one.upper.as_ref().map_or(high.clone(), |upper| upper.clone().min(high.clone()));
            if from >= to {
                rest.push([low, high]);
                continue;
            }
            rest.extend([[low, from.clone()], [to.clone(), high]].into_iter().filter(|[low, high]| low < high));
            bad.push(([from, to], one.by));
        }
        left = rest;
    }
    (left, bad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::Cause;
    use crate::stability::End;

    fn q(text: &str) -> Rational {
        text.parse().unwrap()
    }

    fn set(intervals: &[[Option<&str>; 2]], undecided: &[[&str; 2]]) -> RequiredSet {
        let end = |x: &Option<&str>| x.map(|x| RequiredEnd::Stability(End::new(q(x), Cause::Domain.into(), None)));
        RequiredSet {
            intervals: intervals.iter().map(|[l, u]| RequiredInterval { lower: end(l), upper: end(u) }).collect(),
            undecided: undecided.iter().map(|[l, u]| UndecidedBracket::new(Some(q(l)), Some(q(u)), "open")).collect(),
            ..RequiredSet::default()
        }
    }

    /// Every number is in the set, in a bracket, next to an end, or spoiled, and in one of them only.
    #[test]
    fn what_is_spoiled_lies_beside_the_set_and_its_brackets() {
        let found = beside(&set(&[[Some("1"), Some("2")], [Some("4"), None]], &[["5/2", "3"]]));
        let is_spoiled = |x: &str| {
            found.iter().any(|s| {
                s.lower.as_ref().is_none_or(|low| *low <= q(x)) && s.upper.as_ref().is_none_or(|high| *high >= q(x))
            })
        };
        for (x, expected) in
            [("-9", true), ("9/10", true), ("1", false), ("3/2", false), ("2", false), ("9/4", true), ("5/2", false)]
        {
            assert_eq!(is_spoiled(x), expected, "{x}: {found:?}");
        }
        for (x, expected) in [("11/4", false), ("3", false), ("7/2", true), ("4", false), ("100", false)] {
            assert_eq!(is_spoiled(x), expected, "{x}: {found:?}");
        }
        // Where no value of the parameter is good at a corner, the search itself says so, and names the value that spoils all.
        assert!(beside(&set(&[], &[])).is_empty());
        let whole = set(&[[None, None]], &[]);
        assert!(beside(&whole).is_empty());
    }

    #[test]
    fn a_window_is_parted_into_what_is_spoiled_and_what_is_not() {
        let spoiled = beside(&set(&[[Some("1"), Some("2")], [Some("4"), Some("5")]], &[]));
        let (left, bad) = parted(&[q("0"), q("8")], &spoiled);
        let length = |[low, high]: &[Rational; 2]| high - low;
        let total = left.iter().chain(bad.iter().map(|(piece, _)| piece)).map(length);
        assert_eq!(total.fold(Rational::ZERO, |sum, x| sum + x), q("8"));
        assert_eq!((left.len(), bad.len()), (2, 3));
        assert!(left[0][0] < q("1") && left[0][0] > q("99/100") && left[0][1] > q("2"), "{left:?}");
        assert!(
            spoiled.iter().any(|s| s.is_all_beyond(&q("8"), true))
                && spoiled.iter().any(|s| s.is_all_beyond(&q("0"), false))
        );
        assert!(!spoiled.iter().any(|s| s.is_all_beyond(&q("9/2"), true)));
        assert_eq!(parted(&[q("3/2"), q("7/4")], &spoiled).1, Vec::new());
    }
}
