//! What tests of cells share: every cell is counted once more by another way.

use super::{DelayCount, GainCells};
use crate::Range;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Rational, parse_number};
use jurist_algebra::real::{Real, rational_between};

pub(super) fn range(lower: Option<&str>, upper: Option<&str>) -> Range {
    let end = |x: Option<&str>| x.map(|x| parse_number(x).unwrap());
    Range::between(end(lower), end(upper))
}

pub(super) fn interval(lower: &str, upper: &str) -> [Option<String>; 2] {
    [Some(lower.to_owned()), Some(upper.to_owned())]
}

/// The stable intervals as decimals, after a sample of every cell has been counted once more.
pub(super) fn stable(
    cells: &GainCells,
    range: &Range,
    digits: usize,
    count: impl Fn(&Rational) -> DelayCount,
) -> Vec<[Option<String>; 2]> {
    let budget = Budget::unlimited();
    assert_eq!(cells.right.len(), cells.points.len() + 1);
    let ends: Vec<Option<Real>> = std::iter::once(range.lower.clone().map(Real::from))
        .chain(cells.points.iter().map(|p| Some(p.value.clone())))
        .chain(std::iter::once(range.upper.clone().map(Real::from)))
        .collect();
    let mut out = Vec::new();
    for (i, pair) in ends.windows(2).enumerate() {
        let sample = match (&pair[0], &pair[1]) {
            (Some(l), Some(u)) => rational_between(l, u, &budget).unwrap().unwrap(),
            (Some(l), None) => l.rational_above(),
            (None, Some(u)) => u.rational_below(),
            (None, None) => Rational::ZERO,
        };
        let count = count(&sample);
        match cells.right[i] {
            Some(right) => assert_eq!((count.on, count.right), (0, Some(right)), "cell {i} at {sample}"),
            None => assert!(!count.is_stable(), "cell {i} at {sample}"),
        }
        if cells.right[i] == Some(0) {
            let decimal = |end: &Option<Real>| end.as_ref().map(|x| x.decimal(digits));
            out.push([decimal(&pair[0]), decimal(&pair[1])]);
        }
    }
    out
}
