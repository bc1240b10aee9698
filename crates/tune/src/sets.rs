//! Sets of gains: their widest part, points in it, and what holds at an end.

use crate::decimals::shortest;
use crate::near::toward;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::simplest_between;
use jurist_algebra::real::Real;
use jurist_engine::response::{RequiredEnd, RequiredInterval, RequiredSet};
use std::cmp::Ordering;

/// The interval of the greatest width.
pub(crate) fn widest(set: &RequiredSet) -> Option<&RequiredInterval> {
    let width = |interval: &&RequiredInterval| match outer(interval) {
        (Some(low), Some(high)) => Some(high - low),
        _ => None,
    };
    set.intervals.iter().max_by(|a, b| match (width(a), width(b)) {
        (None, None) => Ordering::Equal,
        (None, Some(_)) => Ordering::Greater,
        (Some(_), None) => Ordering::Less,
        (Some(a), Some(b)) => a.cmp(&b),
    })
}

/// Rational numbers outside of both ends.
pub(crate) fn outer(interval: &RequiredInterval) -> (Option<Rational>, Option<Rational>) {
    /// Digits of the ends.
    const DIGITS: usize = 24;
    let end = |end: &Option<RequiredEnd>| end.as_ref().map(|end| end.value().refined_to_digits(DIGITS).enclosure());
    (end(&interval.lower).map(|(low, _)| low), end(&interval.upper).map(|(_, high)| high))
}

/// The shortest decimal in the inner half, or the simplest rational number.
pub(crate) fn point_inside(interval: &RequiredInterval) -> Rational {
    let quarter = Rational::new(1.into(), 4.into());
    match inner(interval) {
        (Some(low), Some(high)) => {
            let step = (&high - &low) * quarter;
            let (from, to) = (&low + &step, &high - &step);
            shortest(&from, &to, &from).or_else(|| simplest_between(&from, &to)).unwrap_or(low)
        }
        (Some(low), None) => Rational::from(low.floor()) + Rational::from(2),
        (None, Some(high)) => Rational::from(high.floor()) - Rational::ONE,
        (None, None) => Rational::ZERO,
    }
}

/// Rational numbers inside of both ends, or on them.
pub(crate) fn inner(interval: &RequiredInterval) -> (Option<Rational>, Option<Rational>) {
    for digits in [12, 24, 48, 96] {
        let end = |end: &Option<RequiredEnd>| end.as_ref().map(|end| end.value().refined_to_digits(digits).enclosure());
        let ends = (end(&interval.lower).map(|(_, high)| high), end(&interval.upper).map(|(low, _)| low));
        match &ends {
            (Some(low), Some(high)) if low >= high => {}
            _ => return ends,
        }
    }
    let exact = |end: &Option<RequiredEnd>| end.as_ref().map(|end| end.value().enclosure().0);
    (exact(&interval.lower), exact(&interval.upper))
}

/// A rational number in the interval near to one of its ends.
pub(crate) fn near_end(interval: &RequiredInterval, is_upper: bool) -> Rational {
    let inside = point_inside(interval);
    match if is_upper { &interval.upper } else { &interval.lower } {
        Some(end) => toward(&end.value(), &inside, 6),
        None => inside,
    }
}

/// Whether the end itself is in the set.
pub(crate) fn is_closed(end: &RequiredEnd) -> bool {
    match end {
        RequiredEnd::Stability(end) => end.closed,
        RequiredEnd::Requirement { closed, .. } => *closed,
    }
}

/// What binds at an end.
pub(crate) fn names(end: &RequiredEnd) -> Vec<String> {
    match end {
        RequiredEnd::Stability(end) => end.causes.iter().map(|cause| cause.name().to_owned()).collect(),
        RequiredEnd::Requirement { names, .. } => names.iter().map(|name| (*name).to_owned()).collect(),
    }
}

/// What binds where a gain is on a bound.
pub(crate) fn bound_of(gain: &str) -> String {
    format!("bound of {gain}")
}

/// The best gain, where it is the bound that binds: a gain at which a requirement is met just so is not seen to be good by the checkers.
pub(crate) fn on_bound(gain: &Real, binding: &[String], attained: Option<bool>) -> Option<Rational> {
    let is_bound =
        attained == Some(true) && !binding.is_empty() && binding.iter().all(|name| name.starts_with(&bound_of("")));
    gain.exact().filter(|_| is_bound)
}
