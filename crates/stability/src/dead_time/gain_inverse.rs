//! A parameter by its reciprocal: `A + K B` has the roots of `B + A/K`.

use super::gain::{GainCells, GainLoop, NotSolved, direct_cells};
use super::gain_points::{GainPoint, Happening};
use super::windows::Never;
use crate::Range;
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::Rational;
use jurist_algebra::poly::{RealAlgebraic, SquareFree};
use jurist_algebra::real::Real;

/// The cells of a range by the reciprocal of the parameter, on either side of zero, where the highest power of `s` is lost
/// or the reciprocal has no end.
///
/// # Errors
/// [`NotSolved`], for the reciprocal.
pub(super) fn inverse_cells(
    gain: &GainLoop,
    range: &Range,
    budget: &Budget,
) -> Result<Result<GainCells, Never>, NotSolved> {
    let swapped = GainLoop { a: gain.b.clone(), b: gain.a.clone(), tau: gain.tau.clone() };
    let zero = Rational::ZERO;
    let upper = range.upper.clone().map_or(zero.clone(), |u| u.min(zero.clone()));
    let lower = range.lower.clone().map_or(zero.clone(), |l| l.max(zero.clone()));
    let negative = Range { lower: range.lower.clone(), upper: Some(upper) };
    let positive = Range { lower: Some(lower), upper: range.upper.clone() };
    let mut whole: Option<GainCells> = None;
    for side in [negative, positive] {
        if side.is_empty() {
            continue;
        }
        let mut cells = match direct_cells(&swapped, &inverted(&side), budget)? {
            Ok(cells) => cells,
            Err(never) => return Ok(Err(never)),
        };
        cells.points.reverse();
        cells.right.reverse();
        for point in &mut cells.points {
            point.value = reciprocal(&point.value, budget)?;
            point.change = point.change.map(|change| -change);
        }
        whole = Some(match whole {
            None => cells,
            Some(mut below) => {
                let value = Real::from(Rational::ZERO);
                below.points.push(GainPoint::counted(value, Happening::DegreeLost));
                below.points.extend(cells.points);
                below.right.extend(cells.right);
                below
            }
        });
    }
    Ok(Ok(whole.unwrap_or(GainCells { points: Vec::new(), right: vec![None] })))
}

/// The reciprocals of a range on one side of zero.
fn inverted(side: &Range) -> Range {
    let end = |x: &Option<Rational>| match x {
        None => Some(Rational::ZERO),
        Some(x) => x.recip(),
    };
    Range { lower: end(&side.upper), upper: end(&side.lower) }
}

/// The reciprocal of a number that is not zero.
pub(super) fn reciprocal(value: &Real, budget: &Budget) -> Result<Real, Exhausted> {
    let x = match value {
        Real::Algebraic(x) => x,
        Real::Transcendental(_) => return Ok(value.recip()),
    };
    if let Some(exact) = x.exact() {
        return Ok(exact.recip().expect("a value other than zero").into());
    }
    let digits = x.refined_to_digits(1);
    let (lo, hi) = digits.enclosure();
    let p = x.polynomial();
    let reversed = SquareFree::part_of(&p.reversed(p.degree().unwrap_or(0))).expect("not zero");
    let (a, b) = (hi.recip().expect("not zero"), lo.recip().expect("not zero"));
    let found = RealAlgebraic::in_interval(&reversed, &a, &b, budget)?;
    Ok(found.expect("the reciprocal alone is there").into())
}
