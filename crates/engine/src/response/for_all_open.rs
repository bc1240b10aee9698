//! Why many pieces of a parameter stay open for all values of other names: one value of these that spoils all pieces.

use super::for_all::{AllOf, OpenPart};
use super::for_all_line::Piece;
use crate::answer::Verdict;
use crate::problem::{Ask, Problem};
use jurist_algebra::limits::Budget;
use jurist_algebra::number::Rational;
use jurist_algebra::poly::simplest_between;

/// Values are named where they fill a part of their range that is so much shorter, as a power of two.
const NARROW_BITS: u64 = 4;

/// What is wrong at values of the ranges that leave all pieces open, where few values do.
pub(super) fn why_open(all: &[AllOf], pieces: &[Piece], line: &Problem, budget: &Budget) -> Option<String> {
    // Two of them: at the ends of the open pieces there may be other reasons.
    let two = [pieces.len() / 3, pieces.len() / 3 * 2].map(|k| &pieces[k]);
    let sides = two.iter().flat_map(|piece| &piece.open).map(OpenPart::sides);
    let hull = sides.map(<[_]>::to_vec).reduce(|hull, sides| hull.iter().zip(&sides).map(joined).collect())?;
    let is_narrow = |(all, [low, high]): &(&AllOf, &[Rational; 2])| {
        high - low <= &(&all.range[1] - &all.range[0]) * &Rational::dyadic(&1.into(), NARROW_BITS)
    };
    let value = |(all, side): (&AllOf, &[Rational; 2])| (all.name.clone(), simplest_of(side));
    let values: Vec<(String, Rational)> = all.iter().zip(&hull).filter(is_narrow).map(value).collect();
    let named = values.iter().map(|(name, value)| format!("{name} = {value}"));
    let named = named.reduce(|list, one| list + ", " + &one)?;
    let verdict = |piece: &Piece| {
        let middle = piece.between[0].midpoint(&piece.between[1]);
        let question = line.model().ask().set_all(line.set().to_vec()).set(&line.parameter().name, middle);
        let problem = question.set_all(values.clone()).problem().ok()?;
        Some(problem.verdict(budget).ok()?.value().verdict)
    };
    let [first, second] = two.map(verdict);
    match first.filter(|first| second.as_ref() == Some(first))? {
        Verdict::Undefined => Some(format!("the loop is undefined at {named}: leave this value out of the range")),
        Verdict::Marginal => {
            Some(format!("the loop has roots on the boundary at {named}: leave this value out of the range"))
        }
        Verdict::Stable | Verdict::Unstable => None,
    }
}

fn joined((a, b): (&[Rational; 2], &[Rational; 2])) -> [Rational; 2] {
    [a[0].clone().min(b[0].clone()), a[1].clone().max(b[1].clone())]
}

/// The simplest number of a closed interval.
fn simplest_of([low, high]: &[Rational; 2]) -> Rational {
    if low.is_zero() || high.is_zero() {
        return Rational::ZERO;
    }
    simplest_between(low, high).unwrap_or_else(|| low.clone())
}
